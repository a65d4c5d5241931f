// Operators, calls and constructors.
#include "translator_class.hpp"

namespace glslgen {

code translator::unary_operator(const UnaryOperator* e) {
    const char kind = scalar(e->getType());
    const bool narrow = kind == 'f' || kind == 'i' || kind == 'u' || kind == 'b';
    switch (e->getOpcode()) {
    case UO_Minus:
        if (kind == 'd') {
            break;
        }
        {
            const code operand = expression(e->getSubExpr());
            const std::string text = at_least(operand, unary);
            // --x is another thing
            return {text.front() == '-' ? "-(" + text + ")" : "-" + text, unary};
        }
    case UO_Plus:
        return expression(e->getSubExpr());
    case UO_Not:
        return {"~" + at_least(expression(e->getSubExpr()), unary), unary};
    case UO_LNot:
        return {"!" + at_least(expression(e->getSubExpr()), unary), unary};
    case UO_PreInc:
    case UO_PreDec:
        if (narrow) {
            return {(e->isIncrementOp() ? "++" : "--") +
                        at_least(expression(e->getSubExpr()), primary),
                    unary};
        }
        break;
    case UO_PostInc:
    case UO_PostDec:
        if (narrow) {
            return {at_least(expression(e->getSubExpr()), primary) +
                        (e->isIncrementOp() ? "++" : "--"),
                    primary};
        }
        break;
    case UO_Deref:
        if (isa<CXXThisExpr>(e->getSubExpr()->IgnoreParenImpCasts())) {
            return {"self"};
        }
        refuse(e->getOperatorLoc(), "pointers cannot be shared: GLSL has none");
        return {"0"};
    case UO_AddrOf:
        refuse(e->getOperatorLoc(), "pointers cannot be shared: GLSL has none");
        return {"0"};
    default:
        break;
    }
    refuse(e->getOperatorLoc(), kind == 'd' ? "arithmetic in double cannot be shared: write "
                                              "T(...) around the constants"
                                            : "this operator cannot be shared");
    return {"0"};
}

std::optional<int> translator::level_of(BinaryOperatorKind kind) {
    switch (kind) {
    case BO_Mul:
    case BO_Div:
    case BO_Rem:
        return multiplicative;
    case BO_Add:
    case BO_Sub:
        return additive;
    case BO_Shl:
    case BO_Shr:
        return shift;
    case BO_LT:
    case BO_GT:
    case BO_LE:
    case BO_GE:
        return relational;
    case BO_EQ:
    case BO_NE:
        return equality;
    case BO_And:
        return bit_and;
    case BO_Xor:
        return bit_xor;
    case BO_Or:
        return bit_or;
    case BO_LAnd:
        return logical_and;
    case BO_LOr:
        return logical_or;
    default:
        return std::nullopt;
    }
}

code translator::infix(const code& left, const std::string& op, const code& right, int level) {
    return {at_least(left, level) + " " + op + " " + at_least(right, level + 1), level};
}

void translator::check_nan_test(const Expr* left, const Expr* right, SourceLocation where) {
    if (scalar(left->getType()) != 'f') {
        return;
    }
    const access a = access_of(left);
    const access b = access_of(right);
    if (a.base != nullptr && a.base == b.base && a.steps == b.steps &&
        std::find(a.steps.begin(), a.steps.end(), "[]") == a.steps.end()) {
        refuse(where, "comparing a value with itself tests for NaN, which GLSL need not "
                      "honour");
    }
}

bool translator::is_non_negative(const Expr* e, std::set<const VarDecl*>& assumed) {
    e = e->IgnoreParenImpCasts();
    if (scalar(e->getType()) == 'u' || scalar(e->getType()) == 'b') {
        return true;
    }
    Expr::EvalResult value;
    if (!e->isValueDependent() && e->EvaluateAsInt(value, context_)) {
        return !value.Val.getInt().isNegative();
    }
    if (const auto* cast_to = dyn_cast<ExplicitCastExpr>(e)) {
        const Expr* from = cast_to->getSubExpr();
        if (const auto* implicit = dyn_cast<ImplicitCastExpr>(from)) {
            from = implicit->getSubExpr();
        }
        return scalar(from->getType()) == 'b' ||
               (scalar(from->getType()) == 'i' && is_non_negative(from, assumed));
    }
    if (const auto* op = dyn_cast<BinaryOperator>(e)) {
        switch (op->getOpcode()) {
        case BO_Add:
        case BO_Mul:
        case BO_Div:
        case BO_Rem:
        case BO_Shr:
            return is_non_negative(op->getLHS(), assumed) && is_non_negative(op->getRHS(), assumed);
        case BO_And:
            return is_non_negative(op->getLHS(), assumed) || is_non_negative(op->getRHS(), assumed);
        default:
            return false;
        }
    }
    if (const auto* choice = dyn_cast<ConditionalOperator>(e)) {
        return is_non_negative(choice->getTrueExpr(), assumed) &&
               is_non_negative(choice->getFalseExpr(), assumed);
    }
    if (const auto* function_call = dyn_cast<CallExpr>(e)) {
        const FunctionDecl* callee = function_call->getDirectCallee();
        if (callee == nullptr || callee->getIdentifier() == nullptr ||
            !(in_namespace(callee, "glm") || in_namespace(callee, "std"))) {
            return false;
        }
        const StringRef name = callee->getName();
        if (name == "abs") {
            return true;
        }
        if (name == "max" && function_call->getNumArgs() == 2) {
            return is_non_negative(function_call->getArg(0), assumed) ||
                   is_non_negative(function_call->getArg(1), assumed);
        }
        if (name == "min" && function_call->getNumArgs() == 2) {
            return is_non_negative(function_call->getArg(0), assumed) &&
                   is_non_negative(function_call->getArg(1), assumed);
        }
        if (name == "clamp" && function_call->getNumArgs() == 3) {
            return is_non_negative(function_call->getArg(1), assumed) &&
                   is_non_negative(function_call->getArg(2), assumed);
        }
        return false;
    }
    if (const auto* name = dyn_cast<DeclRefExpr>(e)) {
        const auto* variable = dyn_cast<VarDecl>(name->getDecl());
        if (variable == nullptr || isa<ParmVarDecl>(variable) || !variable->isLocalVarDecl() ||
            variable->getInit() == nullptr || frames_.back().function == nullptr) {
            return false;
        }
        if (!assumed.insert(variable).second) {
            return true; // by induction over the assignments
        }
        return is_non_negative(variable->getInit(), assumed) &&
               stays_non_negative(frames_.back().function->getBody(), variable, assumed);
    }
    return false;
}

bool translator::stays_non_negative(const Stmt* s, const VarDecl* variable,
                                    std::set<const VarDecl*>& assumed) {
    if (s == nullptr) {
        return true;
    }
    const auto is_it = [&](const Expr* e) { return access_of(e).base == variable; };
    if (const auto* op = dyn_cast<BinaryOperator>(s);
        op != nullptr && op->isAssignmentOp() && is_it(op->getLHS())) {
        const bool keeps = op->getOpcode() == BO_Assign || op->getOpcode() == BO_AddAssign ||
                           op->getOpcode() == BO_MulAssign || op->getOpcode() == BO_DivAssign ||
                           op->getOpcode() == BO_ShrAssign;
        return keeps && is_non_negative(op->getRHS(), assumed);
    }
    if (const auto* op = dyn_cast<UnaryOperator>(s);
        op != nullptr && op->isDecrementOp() && is_it(op->getSubExpr())) {
        return false;
    }
    if (const auto* function_call = dyn_cast<CallExpr>(s)) {
        for (const access& written : written_by(function_call)) {
            if (written.base == variable) {
                return false;
            }
        }
    }
    return std::all_of(s->children().begin(), s->children().end(), [&](const Stmt* child) {
        return stays_non_negative(child, variable, assumed);
    });
}

void translator::check_division(const Expr* left, const Expr* right, bool remainder,
                                SourceLocation where) {
    if (scalar(left->getType()) != 'i') {
        return;
    }
    std::set<const VarDecl*> assumed;
    if (remainder) {
        if (!is_non_negative(left, assumed) || !is_non_negative(right, assumed)) {
            refuse(where, "% of an int that may be negative is undefined in GLSL: use "
                          "unsigned numbers, or glm::max(x, 0)");
        }
        return;
    }
    const auto surely_negative = [&](const Expr* e) {
        Expr::EvalResult value;
        return e->EvaluateAsInt(value, context_) && value.Val.getInt().isNegative();
    };
    if (surely_negative(left) || surely_negative(right)) {
        refuse(where, "a negative int is divided here: GLSL leaves the rounding open");
    }
}

code translator::binary_operator(const BinaryOperator* e) {
    const BinaryOperatorKind kind = e->getOpcode();
    const Expr* left = e->getLHS();
    const Expr* right = e->getRHS();
    if (kind == BO_Comma) {
        refuse(e->getOperatorLoc(), "the comma operator cannot be shared");
        return {"0"};
    }
    if (kind == BO_Assign) {
        const code target = expression(left);
        return {target.text + " = " + expression(right).text, assignment};
    }
    if (const auto* compound = dyn_cast<CompoundAssignOperator>(e)) {
        const char kind_of_left = scalar(left->getType());
        if (kind_of_left != scalar(compound->getComputationResultType()) || kind_of_left == 'b') {
            refuse(e->getOperatorLoc(), "this assignment computes in another type than it "
                                        "stores: convert the right-hand side");
        }
        if (kind == BO_RemAssign || kind == BO_DivAssign) {
            check_division(left, right, kind == BO_RemAssign, e->getOperatorLoc());
        }
        return {expression(left).text + " " + e->getOpcodeStr().str() + " " +
                    expression(right).text,
                assignment};
    }
    const auto level = level_of(kind);
    if (!level) {
        refuse(e->getOperatorLoc(), "this operator cannot be shared");
        return {"0"};
    }
    const char type = scalar(left->getType());
    if (left->getType()->isPointerType() || right->getType()->isPointerType()) {
        refuse(e->getOperatorLoc(), "pointers cannot be shared: GLSL has none");
        return {"0"};
    }
    if (type == 'd' || scalar(right->getType()) == 'd') {
        refuse(e->getOperatorLoc(),
               "arithmetic in double cannot be shared: write T(...) around the constants");
        return {"0"};
    }
    if (type == 'l') {
        refuse(e->getOperatorLoc(), "arithmetic on 64 bits cannot be shared");
        return {"0"};
    }
    if (kind == BO_EQ || kind == BO_NE || *level == relational) {
        check_nan_test(left, right, e->getOperatorLoc());
    }
    if (type == 'b' && *level == relational) {
        refuse(e->getOperatorLoc(), "GLSL does not order bool");
    }
    if (kind == BO_Rem || kind == BO_Div) {
        check_division(left, right, kind == BO_Rem, e->getOperatorLoc());
    }
    const Expr* left_bool = promoted_bool(left);
    const Expr* right_bool = promoted_bool(right);
    if (*level == equality && left_bool != nullptr && right_bool != nullptr) {
        left = left_bool;
        right = right_bool;
    }
    return infix(expression(left), e->getOpcodeStr().str(), expression(right), *level);
}

const Expr* translator::promoted_bool(const Expr* e) {
    const auto* cast_to = dyn_cast<ImplicitCastExpr>(e);
    return cast_to != nullptr && scalar(cast_to->getSubExpr()->getType()) == 'b'
               ? cast_to->getSubExpr()
               : nullptr;
}

bool translator::is_bit_operator(const FunctionDecl* function) {
    BinaryOperatorKind kind = BO_And;
    bool assigns = false;
    switch (function->getOverloadedOperator()) {
    case OO_Pipe:
        kind = BO_Or;
        break;
    case OO_Amp:
        kind = BO_And;
        break;
    case OO_Caret:
        kind = BO_Xor;
        break;
    case OO_PipeEqual:
        kind = BO_Or;
        assigns = true;
        break;
    case OO_AmpEqual:
        kind = BO_And;
        assigns = true;
        break;
    case OO_CaretEqual:
        kind = BO_Xor;
        assigns = true;
        break;
    case OO_Tilde:
        break;
    default:
        return false;
    }
    for (const ParmVarDecl* each : function->parameters()) {
        if (!each->getType().getNonReferenceType()->isEnumeralType()) {
            return false;
        }
    }
    const FunctionDecl* definition = nullptr;
    if (!function->hasBody(definition)) {
        return false;
    }
    const auto* body = dyn_cast_or_null<CompoundStmt>(definition->getBody());
    if (body == nullptr || body->body_empty()) {
        return false;
    }
    const auto strip = [](const Expr* e) {
        while (true) {
            e = e->IgnoreParenImpCasts();
            const auto* cast_to = dyn_cast<ExplicitCastExpr>(e);
            if (cast_to == nullptr) {
                return e;
            }
            e = cast_to->getSubExpr();
        }
    };
    const auto is_parameter = [&](const Expr* e, unsigned number) {
        const auto* name = dyn_cast<DeclRefExpr>(strip(e));
        return name != nullptr && name->getDecl() == definition->getParamDecl(number);
    };
    const auto is_operation = [&](const Expr* e) {
        e = strip(e);
        if (function->getOverloadedOperator() == OO_Tilde) {
            const auto* op = dyn_cast<UnaryOperator>(e);
            return op != nullptr && op->getOpcode() == UO_Not && is_parameter(op->getSubExpr(), 0);
        }
        if (const auto* op = dyn_cast<BinaryOperator>(e)) {
            return op->getOpcode() == kind && is_parameter(op->getLHS(), 0) &&
                   is_parameter(op->getRHS(), 1);
        }
        if (const auto* op = dyn_cast<CXXOperatorCallExpr>(e)) {
            const FunctionDecl* callee = op->getDirectCallee();
            const OverloadedOperatorKind plain = kind == BO_Or    ? OO_Pipe
                                                 : kind == BO_And ? OO_Amp
                                                                  : OO_Caret;
            return callee != nullptr && op->getOperator() == plain && assigns &&
                   op->getNumArgs() == 2 && is_parameter(op->getArg(0), 0) &&
                   is_parameter(op->getArg(1), 1) && is_bit_operator(callee);
        }
        return false;
    };
    if (!assigns) {
        const auto* back = dyn_cast<ReturnStmt>(*body->body_begin());
        return body->size() == 1 && back != nullptr && is_operation(back->getRetValue());
    }
    const auto stores = [&](const Expr* e) {
        const auto* op = dyn_cast<BinaryOperator>(strip(e));
        return op != nullptr && op->getOpcode() == BO_Assign && is_parameter(op->getLHS(), 0) &&
               is_operation(op->getRHS());
    };
    const auto* first = *body->body_begin();
    if (body->size() == 1) {
        const auto* back = dyn_cast<ReturnStmt>(first);
        return back != nullptr && stores(back->getRetValue());
    }
    const auto* second = dyn_cast<ReturnStmt>(*std::next(body->body_begin()));
    return body->size() == 2 && isa<Expr>(first) && stores(clang::cast<Expr>(first)) &&
           second != nullptr && is_parameter(second->getRetValue(), 0);
}

code translator::operator_call(const CXXOperatorCallExpr* e) {
    const FunctionDecl* callee = e->getDirectCallee();
    const OverloadedOperatorKind kind = e->getOperator();
    if (callee == nullptr) {
        refuse(e->getBeginLoc(), "this call cannot be shared");
        return {"0"};
    }
    const bool of_glm = in_namespace(callee, "glm");
    const bool of_std = in_namespace(callee, "std");
    const std::string spelled = getOperatorSpelling(kind);
    if (kind == OO_Equal) {
        const auto* method = dyn_cast<CXXMethodDecl>(callee);
        if (of_glm || of_std || (method != nullptr && !method->isUserProvided())) {
            return {expression(e->getArg(0)).text + " = " + expression(e->getArg(1)).text,
                    assignment};
        }
        refuse(e->getOperatorLoc(), "this assignment operator cannot be shared");
        return {"0"};
    }
    if (kind == OO_Subscript && (of_glm || (of_std && as_array(e->getArg(0)->getType())))) {
        return subscript(e->getArg(0), e->getArg(1));
    }
    if (of_glm) {
        return glm_operator(e, kind, spelled);
    }
    if (of_std) {
        refuse(e->getOperatorLoc(), "this operator of std cannot be shared");
        return {"0"};
    }
    if (const auto* method = dyn_cast<CXXMethodDecl>(callee);
        method != nullptr && method->getParent()->isLambda()) {
        refuse(e->getBeginLoc(), "a lambda cannot be shared: write a function, or a struct "
                                 "with a call operator");
        return {"0"};
    }
    if (is_bit_operator(callee)) {
        if (kind == OO_Tilde) {
            return {"~" + at_least(expression(e->getArg(0)), unary), unary};
        }
        const BinaryOperatorKind opcode = BinaryOperator::getOverloadedOpcode(kind);
        if (e->isAssignmentOp()) {
            return {expression(e->getArg(0)).text + " " + spelled + " " +
                        expression(e->getArg(1)).text,
                    assignment};
        }
        return infix(expression(e->getArg(0)), spelled, expression(e->getArg(1)),
                     *level_of(opcode));
    }
    check_aliasing(e);
    std::string text = require_function(callee, e->getOperatorLoc()) + "(";
    for (unsigned i = 0; i < e->getNumArgs(); ++i) {
        text += (i > 0 ? ", " : "") + expression(e->getArg(i)).text;
    }
    return {text + ")"};
}

code translator::glm_operator(const CXXOperatorCallExpr* e, OverloadedOperatorKind kind,
                              const std::string& spelled) {
    const auto left_glm = as_glm(e->getArg(0)->getType());
    if (e->getNumArgs() == 1 || kind == OO_PlusPlus || kind == OO_MinusMinus) {
        const code operand = expression(e->getArg(0));
        if (kind == OO_Minus) {
            const std::string text = at_least(operand, unary);
            return {text.front() == '-' ? "-(" + text + ")" : "-" + text, unary};
        }
        if (kind == OO_Plus) {
            return operand;
        }
        if (kind == OO_Tilde) {
            return {"~" + at_least(operand, unary), unary};
        }
        if (kind == OO_PlusPlus || kind == OO_MinusMinus) {
            return {spelled + at_least(operand, primary), unary};
        }
        refuse(e->getOperatorLoc(), "this operator cannot be shared");
        return {"0"};
    }
    const auto right_glm = as_glm(e->getArg(1)->getType());
    const bool divides = kind == OO_Slash || kind == OO_SlashEqual;
    if (divides && right_glm && right_glm->columns > 1) {
        refuse(e->getOperatorLoc(), "division by a matrix differs between GLM (inverse) and "
                                    "GLSL (by component)");
    }
    if ((kind == OO_Percent || kind == OO_PercentEqual) && left_glm &&
        scalar(left_glm->element) == 'i') {
        refuse(e->getOperatorLoc(), "% of an int that may be negative is undefined in GLSL: "
                                    "use unsigned numbers");
    }
    if (e->isAssignmentOp()) {
        code right = expression(e->getArg(1));
        if (left_glm && !right_glm &&
            scalar(left_glm->element) != scalar(e->getArg(1)->getType())) {
            right = convert(e->getArg(1), left_glm->element, e->getArg(1)->getBeginLoc());
        } else if (left_glm && right_glm &&
                   scalar(left_glm->element) != scalar(right_glm->element)) {
            refuse(e->getOperatorLoc(), "vectors of different types meet here: convert one");
        }
        return {expression(e->getArg(0)).text + " " + spelled + " " + right.text, assignment};
    }
    const BinaryOperatorKind opcode = BinaryOperator::getOverloadedOpcode(kind);
    const auto level = level_of(opcode);
    if (!level || *level == relational || *level == logical_and || *level == logical_or) {
        refuse(e->getOperatorLoc(), "this operator cannot be shared");
        return {"0"};
    }
    if (*level == equality) {
        const access a = access_of(e->getArg(0));
        const access b = access_of(e->getArg(1));
        if (a.base != nullptr && a.base == b.base && a.steps == b.steps) {
            refuse(e->getOperatorLoc(), "comparing a value with itself tests for NaN, which "
                                        "GLSL need not honour");
        }
    }
    return infix(expression(e->getArg(0)), spelled, expression(e->getArg(1)), *level);
}

code translator::method_call(const CXXMemberCallExpr* e) {
    const CXXMethodDecl* method = e->getMethodDecl();
    const Expr* object = e->getImplicitObjectArgument();
    if (method == nullptr) {
        refuse(e->getBeginLoc(), "a pointer to a member cannot be shared");
        return {"0"};
    }
    QualType type = object->getType();
    if (type->isPointerType()) {
        type = type->getPointeeType();
    }
    if (in_namespace(method, "std") || in_namespace(method, "glm")) {
        if (as_array(type) && method->getIdentifier() != nullptr && method->getName() == "size") {
            return {std::to_string(as_array(type)->size)};
        }
        refuse(e->getExprLoc(),
               "a call of " + method->getQualifiedNameAsString() + " has no counterpart in GLSL");
        return {"0"};
    }
    if (auto snippet = annotation(method, "glsl:")) {
        std::vector<const Expr*> arguments{object};
        arguments.insert(arguments.end(), e->arg_begin(), e->arg_end());
        return expand(*snippet, arguments, e->getExprLoc());
    }
    if (const auto* from = dyn_cast<MemberExpr>(e->getCallee()->IgnoreParens());
        from != nullptr && from->isArrow() && !isa<CXXThisExpr>(object->IgnoreParenImpCasts())) {
        refuse(e->getExprLoc(), "pointers cannot be shared: GLSL has none");
        return {"0"};
    }
    check_aliasing(e);
    std::string text = require_function(method, e->getExprLoc()) + "(";
    text += expression(object).text;
    for (const Expr* each : e->arguments()) {
        text += ", " + expression(each).text;
    }
    return {text + ")"};
}

code translator::expand(const std::string& snippet, const std::vector<const Expr*>& arguments,
                        SourceLocation where) {
    std::string text;
    for (std::size_t i = 0; i < snippet.size(); ++i) {
        if (snippet[i] != '$' || i + 1 >= snippet.size() || snippet[i + 1] < '0' ||
            snippet[i + 1] > '9') {
            text += snippet[i];
            continue;
        }
        const std::size_t number = static_cast<std::size_t>(snippet[i + 1] - '0');
        if (number >= arguments.size()) {
            refuse(where, "the GLSL of this function names an argument that it has not");
            return {"0"};
        }
        const code argument = expression(arguments[number]);
        std::size_t before = i;
        while (before > 0 && snippet[before - 1] == ' ') {
            --before;
        }
        std::size_t after = i + 2;
        while (after < snippet.size() && snippet[after] == ' ') {
            ++after;
        }
        const bool delimited =
            before > 0 && (snippet[before - 1] == '(' || snippet[before - 1] == ',') &&
            after < snippet.size() && (snippet[after] == ')' || snippet[after] == ',');
        text += delimited ? argument.text : at_least(argument, primary);
        ++i;
    }
    int depth = 0;
    bool open = false; // something outside brackets that binds less than a call
    for (const char c : text) {
        depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
        open = open || (depth == 0 && c == ' ');
    }
    return {text, open ? assignment : primary};
}

code translator::call(const CallExpr* e) {
    const FunctionDecl* callee = e->getDirectCallee();
    if (callee == nullptr) {
        refuse(e->getBeginLoc(), "a call through a pointer cannot be shared");
        return {"0"};
    }
    if (const auto snippet = annotation(callee, "glsl:")) {
        return expand(*snippet, {e->arg_begin(), e->arg_end()}, e->getBeginLoc());
    }
    const bool of_glm = in_namespace(callee, "glm");
    const bool of_std = in_namespace(callee, "std");
    const bool of_c = callee->isExternC() || callee->getBuiltinID() != 0;
    if (of_glm || of_std || of_c) {
        return library_call(e, callee, of_glm);
    }
    check_aliasing(e);
    std::string text = require_function(callee, e->getBeginLoc()) + "(";
    for (unsigned i = 0; i < e->getNumArgs(); ++i) {
        text += (i > 0 ? ", " : "") + expression(e->getArg(i)).text;
    }
    return {text + ")"};
}

code translator::library_call(const CallExpr* e, const FunctionDecl* callee, bool of_glm) {
    const std::string qualified = callee->getQualifiedNameAsString();
    const std::string name =
        callee->getIdentifier() != nullptr ? callee->getName().str() : std::string();
    if (const auto reason = why_refused(name)) {
        refuse(e->getBeginLoc(), "a call of " + qualified + ": " + std::string(*reason));
        return {"0"};
    }
    // std::numeric_limits<T>::max(), glm::pi<T>(), and the like
    if (e->getNumArgs() == 0) {
        if (const auto value = constant_value(e, e->getBeginLoc())) {
            return *value;
        }
    }
    const auto known = find_builtin(name);
    bool fits = known.has_value() && e->getNumArgs() >= known->fewest_arguments &&
                e->getNumArgs() <= known->most_arguments;
    // std::atan2 is atan; glm::length of a scalar and so on mean the same
    if (fits && !of_glm &&
        (name == "length" || name == "distance" || name == "mod" || name == "any" ||
         name == "all" || name == "equal")) {
        fits = false;
    }
    for (unsigned i = 0; fits && i < e->getNumArgs(); ++i) {
        const QualType type = e->getArg(i)->getType();
        const char kind = as_glm(type) ? scalar(as_glm(type)->element) : scalar(type);
        fits = kind == 'f' || kind == 'i' || kind == 'u' || kind == 'b';
        if (kind == 'd') {
            refuse(e->getArg(i)->getBeginLoc(),
                   "arithmetic in double cannot be shared: write T(...) around the constants");
            return {"0"};
        }
        if (name == "mix" && kind != 'f' && i < 2) {
            refuse(e->getBeginLoc(), "mix of integers needs GLSL 450; use ?:");
            return {"0"};
        }
    }
    if (!fits) {
        refuse(e->getBeginLoc(),
               "a call of " + qualified + " has no counterpart in all versions of GLSL");
        return {"0"};
    }
    std::string text = std::string(known->glsl) + "(";
    for (unsigned i = 0; i < e->getNumArgs(); ++i) {
        text += (i > 0 ? ", " : "") + expression(e->getArg(i)).text;
    }
    return {text + ")"};
}

code translator::construct(const CXXConstructExpr* e) {
    const QualType type = e->getType();
    const CXXConstructorDecl* constructor = e->getConstructor();
    if (const auto array = as_array(type); array && e->getNumArgs() == 0) {
        return {zero_value(type, e->getBeginLoc())};
    }
    if (as_glm(type)) {
        const glsl_type glsl = type_of(type, e->getBeginLoc());
        if (e->getNumArgs() == 0) {
            return {zero_value(type, e->getBeginLoc())};
        }
        if (constructor->isCopyOrMoveConstructor()) {
            return expression(e->getArg(0));
        }
        std::string text = glsl.base + "(";
        unsigned written = 0;
        for (unsigned i = 0; i < e->getNumArgs(); ++i) {
            const Expr* argument = e->getArg(i);
            if (isa<CXXDefaultArgExpr>(argument)) {
                continue;
            }
            const char kind = scalar(argument->getType());
            text += written++ > 0 ? ", " : "";
            if (kind == 'd' || kind == 'l') {
                text += convert(argument, as_glm(type)->element, argument->getBeginLoc()).text;
            } else {
                text += expression(argument).text;
            }
        }
        if (written == 1) {
            const auto from = as_glm(e->getArg(0)->getType());
            // a vector of the same type
            if (from && from->columns == as_glm(type)->columns &&
                from->rows == as_glm(type)->rows &&
                scalar(from->element) == scalar(as_glm(type)->element)) {
                return expression(e->getArg(0));
            }
        }
        return {text + ")"};
    }
    if (constructor->isCopyOrMoveConstructor() && !constructor->isUserProvided() &&
        e->getNumArgs() == 1) {
        return expression(e->getArg(0));
    }
    if (constructor->isDefaultConstructor() && !constructor->isUserProvided()) {
        return {default_value(type, e->getBeginLoc())};
    }
    refuse(e->getBeginLoc(), "this constructor cannot be shared");
    return {"0"};
}

code translator::init_list(const InitListExpr* e) {
    if (e->isSemanticForm() == false && e->getSemanticForm() != nullptr) {
        e = e->getSemanticForm();
    }
    const QualType type = e->getType();
    if (scalar(type) != 0 || as_glm(type)) {
        if (e->getNumInits() == 1) {
            return expression(e->getInit(0));
        }
        if (e->getNumInits() == 0) {
            return {zero_value(type, e->getBeginLoc())};
        }
    }
    if (const auto array = as_array(type)) {
        if (!type.getCanonicalType()->isArrayType()) {
            // std::array holds one C array
            return e->getNumInits() == 1 ? expression(e->getInit(0))
                                         : code{zero_value(type, e->getBeginLoc())};
        }
        const glsl_type glsl = type_of(type, e->getBeginLoc());
        std::string text = glsl.in_front() + "(";
        for (int i = 0; i < array->size; ++i) {
            const unsigned at = static_cast<unsigned>(i);
            text += i > 0 ? ", " : "";
            if (at < e->getNumInits()) {
                text += expression(e->getInit(at)).text;
            } else if (e->hasArrayFiller() && !isa<ImplicitValueInitExpr>(e->getArrayFiller())) {
                text += expression(e->getArrayFiller()).text;
            } else {
                text += default_value(array->element, e->getBeginLoc());
            }
        }
        return {text + ")"};
    }
    if (const CXXRecordDecl* record = type->getAsCXXRecordDecl()) {
        if (e->getNumInits() == 1 && e->isTransparent()) {
            return expression(e->getInit(0));
        }
        const glsl_type glsl = type_of(type, e->getBeginLoc());
        if (glsl.opaque) {
            refuse(e->getBeginLoc(), "a device object cannot be made in shared code");
            return {"0"};
        }
        std::string text = glsl.base + "(";
        for (unsigned i = 0; i < e->getNumInits(); ++i) {
            text += (i > 0 ? ", " : "") + expression(e->getInit(i)).text;
        }
        if (record->field_empty()) {
            text += "0";
        }
        return {text + ")"};
    }
    refuse(e->getBeginLoc(), "this list cannot be shared");
    return {"0"};
}

} // namespace glslgen
