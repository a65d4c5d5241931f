// Literals, constants, conversions and simple expressions.
#include "translator_class.hpp"

namespace glslgen {

std::string translator::spelling(SourceLocation where) {
    SmallVector<char, 32> buffer;
    return Lexer::getSpelling(sources_.getSpellingLoc(where), buffer, sources_,
                              context_.getLangOpts())
        .str();
}

std::string translator::float_spelling(const FloatingLiteral* literal) {
    std::string text = spelling(literal->getLocation());
    text.erase(std::remove(text.begin(), text.end(), '\''), text.end());
    while (!text.empty() && std::string_view("fFlL").find(text.back()) != std::string_view::npos &&
           text.find_first_of("xX") == std::string::npos) {
        text.pop_back();
    }
    llvm::APFloat value = literal->getValue();
    bool loses = false;
    value.convert(llvm::APFloat::IEEEsingle(), llvm::APFloat::rmNearestTiesToEven, &loses);
    // hexadecimal floats do not exist in GLSL, and a decimal one may round twice in C++
    if (text.find_first_of("xX") != std::string::npos ||
        std::strtof(text.c_str(), nullptr) != value.convertToFloat()) {
        return float_text(literal->getValue(), literal->getLocation());
    }
    if (text.find_first_of(".eE") == std::string::npos) {
        text += ".0";
    } else if (text.back() == '.') {
        text += "0";
    } else if (text.front() == '.') {
        text = "0" + text;
    }
    return text;
}

std::string translator::integer_spelling(const IntegerLiteral* literal, char kind) {
    std::string text = spelling(literal->getLocation());
    text.erase(std::remove(text.begin(), text.end(), '\''), text.end());
    while (!text.empty() &&
           std::string_view("uUlLzZ").find(text.back()) != std::string_view::npos) {
        text.pop_back();
    }
    if (text.size() > 1 && (text[1] == 'b' || text[1] == 'B')) {
        text = std::to_string(literal->getValue().getZExtValue());
    }
    if (!literal->getValue().isIntN(32)) {
        refuse(literal->getLocation(), "this number needs more than 32 bits");
    }
    if (kind == 'f') {
        const bool decimal = text == "0" || text[0] != '0';
        return (decimal ? text : std::to_string(literal->getValue().getZExtValue())) + ".0";
    }
    return kind == 'u' ? text + "u" : text;
}

std::optional<code> translator::literal_as(const Expr* e, char kind) {
    while (true) {
        e = e->IgnoreParens();
        const auto* implicit = dyn_cast<ImplicitCastExpr>(e);
        if (implicit == nullptr || implicit->getCastKind() == CK_FloatingToIntegral ||
            implicit->getCastKind() == CK_IntegralToBoolean ||
            implicit->getCastKind() == CK_FloatingToBoolean) {
            break;
        }
        e = implicit->getSubExpr();
    }
    if (const auto* op = dyn_cast<UnaryOperator>(e);
        op != nullptr && op->getOpcode() == UO_Minus && kind != 'u') {
        if (auto inner = literal_as(op->getSubExpr(), kind); inner && inner->level == primary) {
            return code{"-" + inner->text, unary};
        }
        return std::nullopt;
    }
    if (const auto* integer = dyn_cast<IntegerLiteral>(e)) {
        if (kind == 'b') {
            return std::nullopt;
        }
        if (kind == 'f') {
            // exact in float, or the text would be rounded
            const double value = static_cast<double>(integer->getValue().getZExtValue());
            if (static_cast<double>(static_cast<float>(value)) != value) {
                return code{float_literal(static_cast<float>(value))};
            }
        }
        return code{integer_spelling(integer, kind)};
    }
    if (const auto* real = dyn_cast<FloatingLiteral>(e)) {
        if (kind == 'f') {
            return code{float_spelling(real)};
        }
        return std::nullopt;
    }
    if (const auto* substituted = dyn_cast<SubstNonTypeTemplateParmExpr>(e)) {
        Expr::EvalResult value;
        if (kind != 'b' && substituted->EvaluateAsInt(value, context_)) {
            const auto number = value.Val.getInt().getExtValue();
            if (kind == 'u' && number < 0) {
                return std::nullopt;
            }
            return code{std::to_string(number) + (kind == 'f'   ? ".0"
                                                  : kind == 'u' ? "u"
                                                                : ""),
                        number < 0 ? unary : primary};
        }
        return std::nullopt;
    }
    if (const auto* constant = dyn_cast<ConstantExpr>(e)) {
        return literal_as(constant->getSubExpr(), kind);
    }
    return std::nullopt;
}

std::optional<code> translator::constant_value(const Expr* e, SourceLocation where) {
    Expr::EvalResult value;
    if (e->isValueDependent() || !e->EvaluateAsRValue(value, context_) || value.HasSideEffects ||
        !(value.Val.isInt() || value.Val.isFloat())) {
        return std::nullopt;
    }
    const std::string text = value_text(value.Val, e->getType(), where);
    return code{text, text.front() == '-' ? unary : primary};
}

code translator::convert(const Expr* from, QualType to_type, SourceLocation where) {
    const char to = scalar(to_type);
    char source = scalar(from->getType());
    if (const auto literal = literal_as(from, to)) {
        return *literal;
    }
    if (source == to && to != 'd' && to != 'l') {
        return expression(from);
    }
    if (to == 'd') {
        refuse(where, "arithmetic in double cannot be shared: write T(...) around the constants");
        return expression(from);
    }
    if (to == 'l') {
        refuse(where, "'" + to_type.getCanonicalType().getAsString() +
                          "' cannot be shared but as an index: GLSL has int and uint of 32 "
                          "bits alone");
        return {"0"};
    }
    if (source == 'd' || source == 'l') {
        // double and 64-bit arithmetic on constants is done here, once
        Expr::EvalResult value;
        if (from->EvaluateAsRValue(value, context_) && !value.HasSideEffects) {
            if (value.Val.isFloat() && to == 'f') {
                const std::string text = float_text(value.Val.getFloat(), where);
                return {text, text.front() == '-' ? unary : primary};
            }
            if (value.Val.isInt() && (to == 'i' || to == 'u')) {
                const std::string text = integer_text(value.Val.getInt(), to);
                return {text, text.front() == '-' ? unary : primary};
            }
            if (value.Val.isInt() && to == 'f') {
                return {float_literal(static_cast<float>(value.Val.getInt().getExtValue()))};
            }
        }
        if (source == 'l') {
            // int -> std::size_t -> int, as an index is written
            if (const Expr* narrow = without_wide_casts(from)) {
                return convert(narrow, to_type, where);
            }
            refuse(where, "'" + from->getType().getCanonicalType().getAsString() +
                              "' cannot be shared: GLSL has int and uint of 32 bits alone");
        } else {
            refuse(where,
                   "arithmetic in double cannot be shared: write T(...) around the constants");
        }
        return {"0"};
    }
    return {scalar_name(to) + "(" + expression(from->IgnoreParens()).text + ")"};
}

const Expr* translator::without_wide_casts(const Expr* e) {
    while (scalar(e->getType()) == 'l') {
        e = e->IgnoreParens();
        if (const auto* cast = dyn_cast<CastExpr>(e)) {
            e = cast->getSubExpr();
        } else {
            return nullptr;
        }
    }
    const char kind = scalar(e->getType());
    return kind == 'i' || kind == 'u' ? e : nullptr;
}

code translator::index(const Expr* e) {
    if (scalar(e->getType()) == 'l') {
        Expr::EvalResult value;
        if (e->EvaluateAsInt(value, context_)) {
            return {decimal(value.Val.getInt())};
        }
        if (const Expr* narrow = without_wide_casts(e)) {
            return expression(narrow);
        }
        refuse(e->getBeginLoc(),
               "arithmetic on 64 bits cannot be shared: compute the index as int");
        return {"0"};
    }
    return expression(e);
}

std::string translator::zero_value(QualType type, SourceLocation where) {
    type = type.getCanonicalType();
    if (const char kind = scalar(type)) {
        return kind == 'f' ? "0.0" : kind == 'b' ? "false" : kind == 'u' ? "0u" : "0";
    }
    const glsl_type glsl = type_of(type, where);
    if (const auto glm = as_glm(type)) {
        const char kind = scalar(glm->element);
        return glsl.base + "(" +
               (kind == 'f'   ? "0.0"
                : kind == 'b' ? "false"
                : kind == 'u' ? "0u"
                              : "0") +
               ")";
    }
    if (const auto array = as_array(type)) {
        std::string result = glsl.in_front() + "(";
        const std::string element = default_value(array->element, where);
        for (int i = 0; i < array->size; ++i) {
            result += (i > 0 ? ", " : "") + element;
        }
        return result + ")";
    }
    return default_value(type, where);
}

bool translator::has_member_values(QualType type) {
    type = type.getCanonicalType();
    if (const auto array = as_array(type)) {
        return has_member_values(array->element);
    }
    const CXXRecordDecl* record = type->getAsCXXRecordDecl();
    if (record == nullptr || as_glm(type) || in_namespace(record, "std")) {
        return false;
    }
    for (const FieldDecl* field : record->fields()) {
        if (field->hasInClassInitializer() || has_member_values(field->getType())) {
            return true;
        }
    }
    return false;
}

std::string translator::default_value(QualType type, SourceLocation where) {
    type = type.getCanonicalType();
    const CXXRecordDecl* record = type->getAsCXXRecordDecl();
    if (record == nullptr || as_glm(type) || as_array(type)) {
        return zero_value(type, where);
    }
    std::string result = require_structure(record, where) + "(";
    bool first = true;
    for (const FieldDecl* field : record->fields()) {
        result += first ? "" : ", ";
        first = false;
        const Expr* value = field->getInClassInitializer();
        if (value == nullptr && field->hasInClassInitializer()) {
            refuse(where, "the initial value of '" + field->getName().str() +
                              "' is not known here; write it out");
        }
        result +=
            value != nullptr ? expression(value).text : default_value(field->getType(), where);
    }
    if (first) {
        result += "0";
    }
    return result + ")";
}

code translator::expression(const Expr* e) {
    if (const auto* x = dyn_cast<ExprWithCleanups>(e)) {
        return expression(x->getSubExpr());
    }
    if (const auto* x = dyn_cast<ConstantExpr>(e)) {
        return expression(x->getSubExpr());
    }
    if (const auto* x = dyn_cast<MaterializeTemporaryExpr>(e)) {
        return expression(x->getSubExpr());
    }
    if (const auto* x = dyn_cast<CXXBindTemporaryExpr>(e)) {
        return expression(x->getSubExpr());
    }
    if (const auto* x = dyn_cast<SubstNonTypeTemplateParmExpr>(e)) {
        if (const auto value = constant_value(x, x->getBeginLoc())) {
            return *value;
        }
        return expression(x->getReplacement());
    }
    if (const auto* x = dyn_cast<CXXDefaultArgExpr>(e)) {
        return expression(x->getExpr());
    }
    if (const auto* x = dyn_cast<CXXDefaultInitExpr>(e)) {
        return expression(x->getExpr());
    }
    if (const auto* x = dyn_cast<ParenExpr>(e)) {
        const code inner = expression(x->getSubExpr());
        return inner.level == primary ? inner : code{"(" + inner.text + ")"};
    }
    if (const auto* x = dyn_cast<IntegerLiteral>(e)) {
        const char kind = scalar(x->getType());
        if (kind == 'l') {
            refuse(x->getLocation(), "this number has a type of more than 32 bits");
        }
        return {integer_spelling(x, kind)};
    }
    if (const auto* x = dyn_cast<FloatingLiteral>(e)) {
        if (scalar(x->getType()) == 'd') {
            refuse(x->getLocation(),
                   "arithmetic in double cannot be shared: write T(...) around the constants");
        }
        return {float_spelling(x)};
    }
    if (const auto* x = dyn_cast<CXXBoolLiteralExpr>(e)) {
        return {x->getValue() ? "true" : "false"};
    }
    if (const auto* x = dyn_cast<CastExpr>(e)) {
        return cast(x);
    }
    if (const auto* x = dyn_cast<DeclRefExpr>(e)) {
        return reference(x);
    }
    if (const auto* x = dyn_cast<MemberExpr>(e)) {
        return member(x);
    }
    if (const auto* x = dyn_cast<ArraySubscriptExpr>(e)) {
        return subscript(x->getBase(), x->getIdx());
    }
    if (const auto* x = dyn_cast<UnaryOperator>(e)) {
        return unary_operator(x);
    }
    if (const auto* x = dyn_cast<BinaryOperator>(e)) {
        return binary_operator(x);
    }
    if (const auto* x = dyn_cast<ConditionalOperator>(e)) {
        const glsl_type type = type_of(x->getType(), x->getBeginLoc());
        if (type.array > 0 || type.opaque) {
            refuse(x->getBeginLoc(), "?: cannot choose between arrays or device objects");
        }
        return {at_least(expression(x->getCond()), logical_or) + " ? " +
                    at_least(expression(x->getTrueExpr()), conditional) + " : " +
                    at_least(expression(x->getFalseExpr()), conditional),
                conditional};
    }
    if (const auto* x = dyn_cast<CXXOperatorCallExpr>(e)) {
        return operator_call(x);
    }
    if (const auto* x = dyn_cast<CXXMemberCallExpr>(e)) {
        return method_call(x);
    }
    if (const auto* x = dyn_cast<CallExpr>(e)) {
        return call(x);
    }
    if (const auto* x = dyn_cast<CXXConstructExpr>(e)) {
        return construct(x);
    }
    if (const auto* x = dyn_cast<InitListExpr>(e)) {
        return init_list(x);
    }
    if (isa<CXXScalarValueInitExpr>(e) || isa<ImplicitValueInitExpr>(e)) {
        return {zero_value(e->getType(), e->getBeginLoc())};
    }
    if (isa<CXXThisExpr>(e)) {
        return {"self"};
    }
    if (isa<UnaryExprOrTypeTraitExpr>(e) || isa<TypeTraitExpr>(e) || isa<SizeOfPackExpr>(e)) {
        if (const auto value = constant_value(e, e->getBeginLoc())) {
            return *value;
        }
    }
    if (isa<LambdaExpr>(e)) {
        refuse(e->getBeginLoc(), "a lambda cannot be shared: write a function, or a struct "
                                 "with a call operator");
    } else if (isa<CXXThrowExpr>(e)) {
        refuse(e->getBeginLoc(), "exceptions cannot be shared");
    } else if (isa<CXXNewExpr>(e) || isa<CXXDeleteExpr>(e)) {
        refuse(e->getBeginLoc(), "pointers cannot be shared: GLSL has none");
    } else if (isa<clang::StringLiteral>(e) || isa<CharacterLiteral>(e)) {
        refuse(e->getBeginLoc(), "text cannot be shared");
    } else {
        refuse(e->getBeginLoc(),
               std::string("this expression cannot be shared (") + e->getStmtClassName() + ")");
    }
    return {"0"};
}

code translator::cast(const CastExpr* e) {
    const Expr* inner = e->getSubExpr();
    switch (e->getCastKind()) {
    case CK_LValueToRValue:
    case CK_NoOp:
    case CK_FunctionToPointerDecay:
    case CK_ConstructorConversion:
    case CK_ArrayToPointerDecay:
        if (e->getCastKind() == CK_ArrayToPointerDecay) {
            refuse(e->getBeginLoc(), "pointers cannot be shared: GLSL has none");
        }
        return expression(inner);
    case CK_IntegralCast:
    case CK_IntegralToFloating:
    case CK_FloatingToIntegral:
    case CK_FloatingCast:
    case CK_IntegralToBoolean:
    case CK_FloatingToBoolean:
    case CK_BooleanToSignedIntegral: {
        const QualType to = e->getType();
        if (const auto* enumeration = to->getAs<EnumType>()) {
            require_enumeration(enumeration->getDecl(), e->getBeginLoc());
        }
        return convert(inner, to, e->getBeginLoc());
    }
    case CK_UserDefinedConversion:
        refuse(e->getBeginLoc(), "a conversion operator cannot be shared: call a function");
        return {"0"};
    case CK_ToVoid:
        refuse(e->getBeginLoc(), "a cast to void is a statement of its own or nothing");
        return {"0"};
    case CK_BitCast:
    case CK_NullToPointer:
    case CK_PointerToIntegral:
    case CK_IntegralToPointer:
        refuse(e->getBeginLoc(), "pointers cannot be shared: GLSL has none");
        return {"0"};
    default:
        refuse(e->getBeginLoc(),
               std::string("this conversion cannot be shared (") + e->getCastKindName() + ")");
        return {"0"};
    }
}

code translator::reference(const DeclRefExpr* e) {
    const ValueDecl* declaration = e->getDecl();
    if (const auto* constant = dyn_cast<EnumConstantDecl>(declaration)) {
        const auto* parent = cast_or_null<EnumDecl>(constant->getDeclContext());
        if (scalar(e->getType()) == 'l' || in_namespace(parent, "std")) {
            if (const auto value = constant_value(e, e->getBeginLoc())) {
                return *value;
            }
        }
        require_enumeration(parent, e->getBeginLoc());
        const auto found = known_.find(parent->getDefinition()->getCanonicalDecl());
        return {(found != known_.end() ? entities_[found->second].name : std::string("ws_")) + "_" +
                constant->getName().str()};
    }
    if (const auto* variable = dyn_cast<VarDecl>(declaration)) {
        if (variable->isLocalVarDeclOrParm()) {
            return {local_name(variable)};
        }
        if (in_namespace(variable, "std") || in_namespace(variable, "glm")) {
            if (const auto value = constant_value(e, e->getBeginLoc())) {
                return *value;
            }
        }
        return {require_constant(variable, e->getBeginLoc())};
    }
    if (isa<FunctionDecl>(declaration)) {
        refuse(e->getBeginLoc(), "a function as a value cannot be shared");
    } else if (isa<BindingDecl>(declaration)) {
        refuse(e->getBeginLoc(), "structured bindings cannot be shared");
    } else {
        refuse(e->getBeginLoc(), "this name cannot be shared");
    }
    return {"0"};
}

code translator::member(const MemberExpr* e) {
    const ValueDecl* declaration = e->getMemberDecl();
    if (const auto* variable = dyn_cast<VarDecl>(declaration)) {
        return {require_constant(variable, e->getMemberLoc())};
    }
    if (const auto* constant = dyn_cast<EnumConstantDecl>(declaration)) {
        if (const auto value = constant_value(e, e->getBeginLoc())) {
            static_cast<void>(constant);
            return *value;
        }
    }
    const auto* field = dyn_cast<FieldDecl>(declaration);
    if (field == nullptr) {
        refuse(e->getMemberLoc(), "this member cannot be shared");
        return {"0"};
    }
    if (field->isAnonymousStructOrUnion() || field->getName().empty()) {
        return expression(e->getBase());
    }
    const Expr* base = e->getBase();
    if (e->isArrow() && !isa<CXXThisExpr>(base->IgnoreParenImpCasts())) {
        refuse(e->getOperatorLoc(), "pointers cannot be shared: GLSL has none");
        return {"0"};
    }
    QualType type = base->getType();
    if (type->isPointerType()) {
        type = type->getPointeeType();
    }
    if (const CXXRecordDecl* record = type->getAsCXXRecordDecl();
        record != nullptr && annotation(record, "glsl_type:")) {
        refuse(e->getMemberLoc(), "a member of a device object cannot be shared: use a "
                                  "function with WS_GLSL_CALL");
    }
    if (!isa<CXXThisExpr>(base->IgnoreParenImpCasts())) {
        // registers the struct that the member belongs to
        type_of(type.getUnqualifiedType()->getAsCXXRecordDecl() != nullptr &&
                        type->getAsCXXRecordDecl()->getName().empty()
                    ? context_.IntTy
                    : type,
                e->getMemberLoc());
    }
    return {at_least(expression(base), primary) + "." + field->getName().str()};
}

code translator::subscript(const Expr* base, const Expr* at) {
    base = base->IgnoreParens();
    if (const auto* decay = dyn_cast<ImplicitCastExpr>(base)) {
        if (decay->getCastKind() == CK_ArrayToPointerDecay) {
            base = decay->getSubExpr();
        } else if (decay->getType()->isPointerType()) {
            refuse(base->getBeginLoc(), "pointers cannot be shared: GLSL has none");
            return {"0"};
        }
    }
    return {at_least(expression(base), primary) + "[" + index(at).text + "]"};
}

} // namespace glslgen
