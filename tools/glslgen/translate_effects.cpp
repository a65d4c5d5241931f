// Side effects: what an expression writes, and what may not be written twice.
#include "translator_class.hpp"

namespace glslgen {

access translator::access_of(const Expr* e) {
    e = e->IgnoreParenImpCasts();
    if (const auto* reference = dyn_cast<DeclRefExpr>(e)) {
        return {reference->getDecl(), false, {}};
    }
    if (isa<CXXThisExpr>(e)) {
        return {nullptr, true, {}};
    }
    if (const auto* op = dyn_cast<UnaryOperator>(e); op != nullptr && op->getOpcode() == UO_Deref) {
        return access_of(op->getSubExpr());
    }
    if (const auto* member = dyn_cast<MemberExpr>(e)) {
        access path = access_of(member->getBase());
        const auto* field = dyn_cast<FieldDecl>(member->getMemberDecl());
        if (field == nullptr || !field->isAnonymousStructOrUnion()) {
            if (member->getMemberDecl()->getIdentifier() != nullptr) {
                path.steps.push_back(
                    component(member->getMemberDecl()->getName().str(), member->getBase()));
            }
        }
        return path;
    }
    const Expr* array = nullptr;
    const Expr* index = nullptr;
    if (const auto* subscript = dyn_cast<ArraySubscriptExpr>(e)) {
        array = subscript->getBase();
        index = subscript->getIdx();
    } else if (const auto* op = dyn_cast<CXXOperatorCallExpr>(e);
               op != nullptr && op->getOperator() == OO_Subscript && op->getNumArgs() == 2) {
        array = op->getArg(0);
        index = op->getArg(1);
    }
    if (array != nullptr) {
        access path = access_of(array);
        Expr::EvalResult value;
        path.steps.push_back(
            index->EvaluateAsInt(value, context_) ? "[" + decimal(value.Val.getInt()) + "]" : "[]");
        return path;
    }
    return {};
}

std::string translator::component(const std::string& name, const Expr* base) {
    QualType type = base->getType();
    if (type->isPointerType()) {
        type = type->getPointeeType();
    }
    static const std::string sets[3] = {"xyzw", "rgba", "stpq"};
    const bool anonymous =
        type->getAsCXXRecordDecl() != nullptr && type->getAsCXXRecordDecl()->getName().empty();
    if (name.size() == 1 && (as_glm(type) || anonymous)) {
        for (const std::string& set : sets) {
            const auto at = set.find(name);
            if (at != std::string::npos) {
                return "[" + std::to_string(at) + "]";
            }
        }
    }
    return name;
}

bool translator::overlap(const access& a, const access& b) {
    if (a.base != b.base || a.is_this != b.is_this || (a.base == nullptr && !a.is_this)) {
        return false;
    }
    for (std::size_t i = 0; i < a.steps.size() && i < b.steps.size(); ++i) {
        if (a.steps[i] != b.steps[i] && a.steps[i] != "[]" && b.steps[i] != "[]") {
            return false;
        }
    }
    return true;
}

bool translator::is_assignment(const Expr* e) {
    if (const auto* op = dyn_cast<UnaryOperator>(e)) {
        return op->isIncrementDecrementOp();
    }
    if (const auto* op = dyn_cast<BinaryOperator>(e)) {
        return op->isAssignmentOp();
    }
    if (const auto* op = dyn_cast<CXXOperatorCallExpr>(e)) {
        return op->isAssignmentOp() || op->getOperator() == OO_PlusPlus ||
               op->getOperator() == OO_MinusMinus;
    }
    return false;
}

std::vector<access> translator::written_by(const CallExpr* call) {
    std::vector<access> result;
    const FunctionDecl* callee = call->getDirectCallee();
    if (callee == nullptr || in_namespace(callee, "glm") || in_namespace(callee, "std")) {
        return result;
    }
    const auto* method = dyn_cast<CXXMethodDecl>(callee);
    const bool is_operator_method = method != nullptr && isa<CXXOperatorCallExpr>(call);
    if (method != nullptr && !method->isConst() && !method->isStatic()) {
        if (const auto* member = dyn_cast<CXXMemberCallExpr>(call)) {
            result.push_back(access_of(member->getImplicitObjectArgument()));
        } else if (is_operator_method) {
            result.push_back(access_of(call->getArg(0)));
        }
    }
    const unsigned skip = is_operator_method ? 1 : 0;
    for (unsigned i = skip; i < call->getNumArgs() && i - skip < callee->getNumParams(); ++i) {
        if (is_written(callee->getParamDecl(i - skip))) {
            result.push_back(access_of(call->getArg(i)));
        }
    }
    return result;
}

void translator::collect(const Stmt* s, std::vector<const Expr*>& effects,
                         std::multiset<const ValueDecl*>& mentioned) {
    if (s == nullptr) {
        return;
    }
    if (const auto* e = dyn_cast<Expr>(s)) {
        if (is_assignment(e)) {
            effects.push_back(e);
        } else if (const auto* call = dyn_cast<CallExpr>(e);
                   call != nullptr && !written_by(call).empty()) {
            effects.push_back(e);
        }
        if (const auto* reference = dyn_cast<DeclRefExpr>(e)) {
            mentioned.insert(reference->getDecl());
        }
        if (isa<CXXDefaultArgExpr>(e)) {
            return;
        }
    }
    for (const Stmt* child : s->children()) {
        collect(child, effects, mentioned);
    }
}

code translator::full_expression(const Expr* e, bool is_statement) {
    const Expr* root = e;
    while (true) {
        if (const auto* cleanups = dyn_cast<ExprWithCleanups>(root)) {
            root = cleanups->getSubExpr();
        } else if (root->IgnoreParenImpCasts() != root) {
            root = root->IgnoreParenImpCasts();
        } else {
            break;
        }
    }
    std::vector<const Expr*> effects;
    std::multiset<const ValueDecl*> mentioned;
    collect(root, effects, mentioned);
    if (is_statement && effects.empty() && !isa<CallExpr>(root) && !isa<CXXThrowExpr>(root)) {
        refuse(e->getBeginLoc(), "this statement has no effect");
    }
    std::size_t calls = 0;
    for (const Expr* each : effects) {
        if (each == root && is_statement) {
            continue;
        }
        const auto* call = dyn_cast<CallExpr>(each);
        if (call == nullptr || is_assignment(each)) {
            refuse(each->getExprLoc(), "a side effect inside an expression cannot be shared: "
                                       "make it a statement of its own");
            continue;
        }
        ++calls;
        for (const access& written : written_by(call)) {
            const auto own =
                std::count_if(call->arg_begin(), call->arg_end(), [&](const Expr* argument) {
                    return access_of(argument).base == written.base;
                });
            if (written.base != nullptr &&
                mentioned.count(written.base) > static_cast<std::size_t>(own)) {
                refuse(each->getExprLoc(),
                       "this call writes to '" + written.base->getName().str() +
                           "', which the same expression uses elsewhere: GLSL does not order "
                           "the two; make it a statement of its own");
            }
        }
    }
    if (calls > 1) {
        refuse(root->getExprLoc(), "two calls in one expression write to their arguments: "
                                   "make each a statement of its own");
    }
    return expression(e);
}

void translator::check_aliasing(const CallExpr* call) {
    const FunctionDecl* callee = call->getDirectCallee();
    const std::vector<access> written = written_by(call);
    if (callee == nullptr || written.empty()) {
        return;
    }
    const auto* method = dyn_cast<CXXMethodDecl>(callee);
    const unsigned skip = method != nullptr && isa<CXXOperatorCallExpr>(call) ? 1 : 0;
    std::vector<std::pair<access, const Expr*>> by_reference;
    if (const auto* member = dyn_cast<CXXMemberCallExpr>(call)) {
        const Expr* object = member->getImplicitObjectArgument();
        by_reference.emplace_back(access_of(object), object);
    }
    for (unsigned i = 0; i < call->getNumArgs(); ++i) {
        const bool reference =
            i < skip || (i - skip < callee->getNumParams() &&
                         callee->getParamDecl(i - skip)->getType()->isReferenceType());
        if (reference) {
            by_reference.emplace_back(access_of(call->getArg(i)), call->getArg(i));
        }
    }
    for (const access& target : written) {
        std::size_t hits = 0;
        const Expr* second = nullptr;
        for (const auto& [path, argument] : by_reference) {
            if (overlap(path, target)) {
                ++hits;
                second = argument;
            }
        }
        if (hits > 1) {
            refuse(second->getBeginLoc(),
                   "aliasing arguments cannot be shared: the call writes to what another "
                   "argument refers to, and GLSL copies in and out");
        }
    }
}

} // namespace glslgen
