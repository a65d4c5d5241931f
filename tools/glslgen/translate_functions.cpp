// Functions, and whether every out parameter is assigned.
#include "translator_class.hpp"

namespace glslgen {

std::string translator::operator_name(OverloadedOperatorKind kind, std::size_t arguments) {
    switch (kind) {
    case OO_Call:
        return "eval";
    case OO_Plus:
        return "add";
    case OO_Minus:
        return arguments == 1 ? "negate" : "subtract";
    case OO_Star:
        return "multiply";
    case OO_Slash:
        return "divide";
    case OO_EqualEqual:
        return "equals";
    case OO_ExclaimEqual:
        return "differs";
    case OO_Less:
        return "less";
    case OO_PlusEqual:
        return "add_to";
    case OO_MinusEqual:
        return "subtract_from";
    case OO_StarEqual:
        return "multiply_by";
    case OO_SlashEqual:
        return "divide_by";
    case OO_Subscript:
        return "at";
    default:
        return "";
    }
}

std::string translator::display_name(const FunctionDecl* function) {
    std::string text;
    llvm::raw_string_ostream stream(text);
    function->getNameForDiagnostic(stream, context_.getPrintingPolicy(), true);
    return stream.str();
}

std::string translator::require_function(const FunctionDecl* function, SourceLocation where) {
    const FunctionDecl* definition = nullptr;
    const Decl* key = function->getCanonicalDecl();
    if (const auto found = known_.find(key); found != known_.end()) {
        depend(found->second);
        return entities_[found->second].name;
    }
    const auto* method = dyn_cast<CXXMethodDecl>(function);
    std::string own;
    if (function->isOverloadedOperator()) {
        own = operator_name(function->getOverloadedOperator(),
                            function->getNumParams() + (method != nullptr ? 1 : 0));
        if (own.empty()) {
            refuse(where, std::string("operator") +
                              getOperatorSpelling(function->getOverloadedOperator()) +
                              " cannot be shared");
            return "ws_operator";
        }
    } else if (function->getIdentifier() == nullptr) {
        refuse(where, "'" + function->getQualifiedNameAsString() + "' cannot be shared");
        return "ws_function";
    } else {
        own = function->getName().str();
    }
    std::string name;
    if (method != nullptr) {
        check_name(own, function->getLocation(), true);
        // the prefix, and the numbers of a template, come with the struct's name
        frames_.push_back({display_name(function), where, {}, nullptr, {}, {}});
        name = require_structure(method->getParent(), where) + "_" + own;
        frames_.pop_back();
    } else {
        name = global_name(function, own);
    }
    if (const TemplateArgumentList* list = function->getTemplateSpecializationArgs()) {
        for (const TemplateArgument& each : list->asArray()) {
            if (each.getKind() == TemplateArgument::Integral) {
                name += "_" + decimal(each.getAsIntegral());
            }
        }
    }
    if (active_.count(key) != 0) {
        refuse(where, "recursion cannot be shared: '" + display_name(function) +
                          "' calls itself, directly or through others");
        return name;
    }
    if (!function->hasBody(definition) || definition == nullptr) {
        refuse(where, "'" + function->getQualifiedNameAsString() +
                          "' has no definition here, and no counterpart in GLSL");
        return name;
    }
    active_.insert(key);
    frames_.push_back({display_name(function), where, {}, definition, {}, {}});
    statement_writer saved = std::move(out_);
    out_ = statement_writer();
    entity made = translate_function(definition, name);
    out_ = std::move(saved);
    const std::size_t index = keep(key, std::move(made));
    frames_.pop_back();
    active_.erase(key);
    depend(index);
    return name;
}

entity translator::translate_function(const FunctionDecl* function, const std::string& name) {
    entity made = new_entity(entity_kind::function, pattern_of(function));
    made.name = name;
    const auto* method = dyn_cast<CXXMethodDecl>(function);
    made.is_method = method != nullptr && !method->isStatic();
    made.is_template = function->isTemplateInstantiation();
    const std::string scalar_text = made.is_template ? "T" : "float";
    made.cpp_call = made.cpp_name;
    if (const TemplateArgumentList* list = function->getTemplateSpecializationArgs()) {
        made.cpp_call += template_arguments(*list, scalar_text);
    }
    if (function->isVariadic()) {
        refuse(function->getLocation(), "variadic functions cannot be shared");
    }
    if (method != nullptr && method->isVirtual()) {
        refuse(function->getLocation(), "virtual functions cannot be shared");
    }
    if (isa<CXXConstructorDecl>(function) || isa<CXXConversionDecl>(function)) {
        refuse(function->getLocation(), "constructors and conversions cannot be shared");
    }
    if (function->getReturnType()->isReferenceType()) {
        refuse(function->getLocation(), "a reference cannot be returned");
    }
    const glsl_type result = type_of(function->getReturnType(), function->getLocation());
    if (result.opaque) {
        refuse(function->getLocation(), "a device object cannot be returned");
    }
    made.result = result.in_front();
    made.cpp_result = cpp_type(function->getReturnType(), scalar_text);

    std::string head = result.in_front() + " " + name + "(";
    bool first = true;
    if (made.is_method) {
        const std::string type = require_structure(method->getParent(), function->getLocation());
        const std::string direction = method->isConst() ? "" : "inout ";
        head += direction + type + " self";
        made.variables.push_back({"self", type, 0, method->isConst() ? "" : "inout", ""});
        first = false;
    }
    bool seen_reference = false;
    std::vector<const ParmVarDecl*> outs;
    const FunctionDecl* pattern = pattern_of(function);
    for (const ParmVarDecl* parameter : function->parameters()) {
        const QualType type = parameter->getType();
        const glsl_type glsl = type_of(parameter_type(parameter), parameter->getLocation());
        std::string direction;
        if (type->isRValueReferenceType()) {
            refuse(parameter->getLocation(), "an rvalue reference cannot be shared");
        } else if (type->isLValueReferenceType() && !type->getPointeeType().isConstQualified()) {
            if (glsl.opaque) {
                refuse(parameter->getLocation(), "a device object cannot be written to");
            }
            const std::string written =
                pattern->getParamDecl(parameter->getFunctionScopeIndex())->getName().str();
            direction = documented_direction(function, written).value_or("inout");
            seen_reference = true;
            if (direction == "out") {
                outs.push_back(parameter);
            }
        } else if (seen_reference) {
            refuse(parameter->getLocation(),
                   "parameters that are written to come last: this one follows a reference");
        }
        const std::string local =
            parameter->getName().empty() ? std::string() : local_name(parameter);
        if (local != parameter->getName()) {
            rename_parameter(made.doc, parameter->getName().str(), local);
        }
        head += (first ? "" : ", ") + (direction.empty() ? "" : direction + " ") +
                (local.empty() ? glsl.in_front() : glsl.declare(local));
        made.variables.push_back({local, glsl.base, glsl.array, direction,
                                  cpp_type(parameter_type(parameter), scalar_text)});
        first = false;
    }
    head += ")";
    std::vector<std::string> lines;
    append_wrapped(lines, head);

    const auto* body = dyn_cast_or_null<CompoundStmt>(function->getBody());
    if (body == nullptr) {
        refuse(function->getLocation(), "the body of this function cannot be shared");
        return made;
    }
    const SourceLocation open = sources_.getExpansionLoc(body->getLBracLoc());
    out_.comments = &comments_of(sources_.getFileID(open));
    out_.next_comment = first_comment_after(offset(open));
    lines.push_back("{");
    out_.lines = std::move(lines);
    out_.last_line = line(open);
    block(body, 1);
    out_.lines.push_back("}");
    made.text = joined(out_.lines);
    for (const ParmVarDecl* parameter : outs) {
        check_assigned(body, parameter);
    }
    return made;
}

void translator::rename_parameter(std::string& doc, const std::string& from,
                                  const std::string& to) {
    std::size_t at = 0;
    while ((at = doc.find("@param", at)) != std::string::npos) {
        const std::size_t end = doc.find('\n', at);
        const std::size_t name = doc.find(from, at);
        at += 6;
        if (name == std::string::npos || name > end) {
            continue;
        }
        const std::size_t after = name + from.size();
        if (doc[name - 1] == ' ' &&
            (after >= doc.size() || doc[after] == ' ' || doc[after] == '\n')) {
            // the blanks that align the texts make room
            const bool room = doc.compare(after, 2, "  ") == 0;
            doc.replace(name, from.size() + (room ? 1 : 0), to);
            return;
        }
    }
}

QualType translator::parameter_type(const ParmVarDecl* parameter) {
    const QualType type = parameter->getType();
    return type->isReferenceType() ? type->getPointeeType() : type;
}

assigned translator::merge(const assigned& a, const assigned& b) {
    if (a.unreachable) {
        return b;
    }
    if (b.unreachable) {
        return a;
    }
    assigned result;
    result.whole = a.whole && b.whole;
    for (const std::string& part : a.parts) {
        if (b.whole || b.parts.count(part) != 0) {
            result.parts.insert(part);
        }
    }
    for (const std::string& part : b.parts) {
        if (a.whole) {
            result.parts.insert(part);
        }
    }
    return result;
}

std::size_t translator::part_count(QualType type) {
    type = type.getNonReferenceType().getCanonicalType();
    if (const auto glm = as_glm(type)) {
        return glm->columns == 1 ? static_cast<std::size_t>(glm->rows)
                                 : static_cast<std::size_t>(glm->columns);
    }
    if (const auto array = as_array(type)) {
        return static_cast<std::size_t>(array->size);
    }
    if (const CXXRecordDecl* record = type->getAsCXXRecordDecl()) {
        return static_cast<std::size_t>(std::distance(record->field_begin(), record->field_end()));
    }
    return 1;
}

void translator::check_assigned(const Stmt* body, const ParmVarDecl* parameter) {
    assigned state;
    flow(body, parameter, state);
    require_assigned(body, parameter, state, end_of(body));
}

void translator::require_assigned(const Stmt*, const ParmVarDecl* parameter, const assigned& state,
                                  SourceLocation where) {
    if (!state.unreachable && !state.whole &&
        state.parts.size() < part_count(parameter->getType())) {
        refuse(where, "'" + parameter->getName().str() +
                          "' is documented as @param[out] and not written on every way to "
                          "here; GLSL leaves it undefined then. Write it, or document it as "
                          "@param[in,out]");
    }
}

void translator::flow(const Stmt* s, const ParmVarDecl* p, assigned& state) {
    if (s == nullptr || state.unreachable) {
        return;
    }
    if (const auto* compound = dyn_cast<CompoundStmt>(s)) {
        for (const Stmt* each : compound->body()) {
            flow(each, p, state);
        }
    } else if (const auto* choice = dyn_cast<IfStmt>(s)) {
        if (choice->isConstexpr()) {
            if (auto taken = choice->getNondiscardedCase(context_)) {
                flow(*taken, p, state);
            }
            return;
        }
        flow(choice->getCond(), p, state);
        assigned then = state;
        assigned otherwise = state;
        flow(choice->getThen(), p, then);
        flow(choice->getElse(), p, otherwise);
        state = merge(then, otherwise);
        if (then.unreachable && otherwise.unreachable) {
            state.unreachable = true;
        }
    } else if (const auto* loop = dyn_cast<ForStmt>(s)) {
        flow(loop->getInit(), p, state);
        flow(loop->getCond(), p, state);
        assigned inside = state;
        flow(loop->getBody(), p, inside);
        flow(loop->getInc(), p, inside);
    } else if (const auto* repeated = dyn_cast<WhileStmt>(s)) {
        flow(repeated->getCond(), p, state);
        assigned inside = state;
        flow(repeated->getBody(), p, inside);
    } else if (const auto* done_once = dyn_cast<DoStmt>(s)) {
        assigned inside = state;
        flow(done_once->getBody(), p, inside);
        if (!inside.unreachable && !contains_jump(done_once->getBody())) {
            state = inside;
        }
    } else if (const auto* chosen = dyn_cast<SwitchStmt>(s)) {
        flow(chosen->getCond(), p, state);
        // each label starts from the state before; good when every group ends the function
        // or writes, and there is a default
        assigned all = state;
        all.unreachable = true;
        assigned group = state;
        group.unreachable = true;
        bool has_default = false;
        if (const auto* body = dyn_cast<CompoundStmt>(chosen->getBody())) {
            for (const Stmt* each : body->body()) {
                while (const auto* label = dyn_cast<SwitchCase>(each)) {
                    has_default = has_default || isa<DefaultStmt>(label);
                    assigned entered = state;
                    group = merge(group, entered);
                    each = label->getSubStmt();
                }
                if (isa<BreakStmt>(each)) {
                    all = merge(all, group);
                    group.unreachable = true;
                } else {
                    flow(each, p, group);
                }
            }
        }
        all = merge(all, group);
        state = has_default ? all : merge(all, state);
    } else if (const auto* back = dyn_cast<ReturnStmt>(s)) {
        flow(back->getRetValue(), p, state);
        require_assigned(s, p, state, begin_of(s));
        state.unreachable = true;
    } else if (isa<BreakStmt>(s) || isa<ContinueStmt>(s)) {
        state.unreachable = true; // of the rest of the loop's body alone
    } else if (const auto* declaration = dyn_cast<DeclStmt>(s)) {
        for (const Decl* each : declaration->decls()) {
            if (const auto* variable = dyn_cast<VarDecl>(each)) {
                flow(variable->getInit(), p, state);
            }
        }
    } else if (const auto* e = dyn_cast<Expr>(s)) {
        flow_expression(e, p, state);
    } else {
        for (const Stmt* child : s->children()) {
            flow(child, p, state);
        }
    }
}

bool translator::contains_jump(const Stmt* s) {
    if (s == nullptr) {
        return false;
    }
    if (isa<BreakStmt>(s) || isa<ContinueStmt>(s)) {
        return true;
    }
    return std::any_of(s->children().begin(), s->children().end(), contains_jump);
}

void translator::flow_expression(const Expr* e, const ParmVarDecl* p, assigned& state) {
    e = e->IgnoreParenImpCasts();
    const Expr* target = nullptr;
    if (const auto* binary = dyn_cast<BinaryOperator>(e);
        binary != nullptr && binary->getOpcode() == BO_Assign) {
        flow_expression(binary->getRHS(), p, state);
        target = binary->getLHS();
    } else if (const auto* op = dyn_cast<CXXOperatorCallExpr>(e);
               op != nullptr && op->getOperator() == OO_Equal) {
        flow_expression(op->getArg(1), p, state);
        target = op->getArg(0);
    }
    if (target != nullptr) {
        const access path = access_of(target);
        if (path.base == p) {
            if (path.steps.empty()) {
                state.whole = true;
            } else if (path.steps.size() == 1) {
                state.parts.insert(path.steps.front());
            } else {
                note_part(path, p, state);
            }
        } else {
            flow_expression(target, p, state);
        }
        return;
    }
    if (const auto* call = dyn_cast<CallExpr>(e)) {
        const FunctionDecl* callee = call->getDirectCallee();
        const unsigned skip =
            isa<CXXOperatorCallExpr>(call) && callee != nullptr && isa<CXXMethodDecl>(callee) ? 1
                                                                                              : 0;
        std::vector<const Expr*> written;
        for (unsigned i = 0; i < call->getNumArgs(); ++i) {
            const bool is_out =
                callee != nullptr && i >= skip && i - skip < callee->getNumParams() &&
                is_written(callee->getParamDecl(i - skip)) &&
                documented_direction(
                    callee, pattern_of(callee)->getParamDecl(i - skip)->getName().str()) == "out";
            if (is_out) {
                written.push_back(call->getArg(i));
            } else {
                flow_expression(call->getArg(i), p, state);
            }
        }
        for (const Expr* each : written) {
            const access path = access_of(each);
            if (path.base == p) {
                if (path.steps.empty()) {
                    state.whole = true;
                } else {
                    note_part(path, p, state);
                }
            }
        }
        if (const auto* member = dyn_cast<CXXMemberCallExpr>(e)) {
            flow_expression(member->getImplicitObjectArgument(), p, state);
        }
        return;
    }
    if (isa<DeclRefExpr>(e) || isa<MemberExpr>(e) || isa<ArraySubscriptExpr>(e)) {
        const access path = access_of(e);
        if (path.base == p) {
            const bool written =
                state.whole || (path.steps.empty() ? state.parts.size() >= part_count(p->getType())
                                                   : state.parts.count(path.steps.front()) != 0);
            if (!written) {
                refuse(e->getBeginLoc(),
                       "'" + p->getName().str() +
                           "' is documented as @param[out] and read before it is written; "
                           "GLSL leaves it undefined. Document it as @param[in,out]");
            }
            return;
        }
    }
    for (const Stmt* child : e->children()) {
        if (const auto* part = dyn_cast_or_null<Expr>(child)) {
            flow_expression(part, p, state);
        }
    }
}

bool translator::is_written(const ParmVarDecl* parameter) {
    const QualType type = parameter->getType();
    return type->isLValueReferenceType() && !type->getPointeeType().isConstQualified();
}

void translator::note_part(const access& path, const ParmVarDecl* p, assigned& state) {
    std::string joined_path;
    for (const std::string& step : path.steps) {
        joined_path += (joined_path.empty() ? "" : ".") + step;
    }
    state.parts.insert(joined_path);
    // is the outermost member complete?
    QualType type = p->getType().getNonReferenceType();
    std::string prefix;
    std::vector<std::pair<std::string, QualType>> levels;
    for (std::size_t i = 0; i + 1 < path.steps.size(); ++i) {
        const CXXRecordDecl* record = type->getAsCXXRecordDecl();
        QualType next;
        if (record != nullptr && !as_glm(type) && !as_array(type)) {
            for (const FieldDecl* field : record->fields()) {
                if (field->getName() == path.steps[i]) {
                    next = field->getType();
                }
            }
        }
        if (next.isNull()) {
            return;
        }
        prefix += (prefix.empty() ? "" : ".") + path.steps[i];
        levels.emplace_back(prefix, next);
        type = next;
    }
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
        const std::string start = level->first + ".";
        const std::size_t count = static_cast<std::size_t>(
            std::count_if(state.parts.begin(), state.parts.end(), [&](const std::string& part) {
                return part.rfind(start, 0) == 0 &&
                       part.find('.', start.size()) == std::string::npos;
            }));
        if (count < part_count(level->second)) {
            return;
        }
        for (auto part = state.parts.begin(); part != state.parts.end();) {
            part = part->rfind(start, 0) == 0 ? state.parts.erase(part) : std::next(part);
        }
        state.parts.insert(level->first);
    }
}

} // namespace glslgen
