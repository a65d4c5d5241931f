// Types and names, from C++ to GLSL.
#include "translator_class.hpp"

namespace glslgen {

char translator::scalar(QualType type) {
    type = type.getCanonicalType().getUnqualifiedType();
    if (const auto* e = type->getAs<EnumType>()) {
        const QualType underlying = e->getDecl()->getIntegerType();
        return underlying.isNull() ? 'l' : scalar(underlying);
    }
    const auto* builtin_type = type->getAs<BuiltinType>();
    if (builtin_type == nullptr) {
        return 0;
    }
    switch (builtin_type->getKind()) {
    case BuiltinType::Float:
        return 'f';
    case BuiltinType::Int:
        return 'i';
    case BuiltinType::UInt:
        return 'u';
    case BuiltinType::Bool:
        return 'b';
    case BuiltinType::Double:
    case BuiltinType::LongDouble:
        return 'd';
    default:
        return builtin_type->isInteger() ? 'l' : '\0';
    }
}

std::string translator::scalar_name(char kind) {
    return kind == 'f' ? "float" : kind == 'i' ? "int" : kind == 'u' ? "uint" : "bool";
}

std::optional<glm_type> translator::as_glm(QualType type) {
    const auto* record = dyn_cast_or_null<ClassTemplateSpecializationDecl>(
        type.getCanonicalType()->getAsCXXRecordDecl());
    if (record == nullptr || !in_namespace(record, "glm")) {
        return std::nullopt;
    }
    const TemplateArgumentList& arguments = record->getTemplateArgs();
    if (record->getName() == "vec" && arguments.size() >= 2) {
        return glm_type{1, static_cast<int>(arguments[0].getAsIntegral().getExtValue()),
                        arguments[1].getAsType()};
    }
    if (record->getName() == "mat" && arguments.size() >= 3) {
        return glm_type{static_cast<int>(arguments[0].getAsIntegral().getExtValue()),
                        static_cast<int>(arguments[1].getAsIntegral().getExtValue()),
                        arguments[2].getAsType()};
    }
    return std::nullopt;
}

std::optional<translator::array_type> translator::as_array(QualType type) {
    type = type.getCanonicalType();
    if (const ConstantArrayType* array = context_.getAsConstantArrayType(type)) {
        return array_type{array->getElementType(),
                          static_cast<int>(array->getSize().getZExtValue())};
    }
    const auto* record =
        dyn_cast_or_null<ClassTemplateSpecializationDecl>(type->getAsCXXRecordDecl());
    if (record != nullptr && record->getName() == "array" && in_namespace(record, "std")) {
        return array_type{
            record->getTemplateArgs()[0].getAsType(),
            static_cast<int>(record->getTemplateArgs()[1].getAsIntegral().getZExtValue())};
    }
    return std::nullopt;
}

std::optional<std::string> translator::annotation(const Decl* declaration, StringRef key) {
    std::vector<const Decl*> places{declaration};
    if (const auto* function = dyn_cast<FunctionDecl>(declaration)) {
        places.push_back(pattern_of(function));
    } else if (const auto* record = dyn_cast<CXXRecordDecl>(declaration)) {
        if (const CXXRecordDecl* pattern = record->getTemplateInstantiationPattern()) {
            places.push_back(pattern);
        }
        if (const auto* special = dyn_cast<ClassTemplateSpecializationDecl>(record)) {
            places.push_back(special->getSpecializedTemplate()->getTemplatedDecl());
        }
    }
    for (const Decl* place : places) {
        for (const Decl* each : place->redecls()) {
            for (const auto* attribute : each->specific_attrs<AnnotateAttr>()) {
                StringRef text = attribute->getAnnotation();
                if (text.consume_front(key)) {
                    return text.str();
                }
            }
        }
    }
    return std::nullopt;
}

glsl_type translator::type_of(QualType type, SourceLocation where) {
    type = type.getNonReferenceType().getCanonicalType().getUnqualifiedType();
    if (type->isVoidType()) {
        return {"void"};
    }
    if (type->isPointerType() || type->isMemberPointerType() || type->isNullPtrType()) {
        refuse(where, "pointers cannot be shared: GLSL has none");
        return {"int"};
    }
    if (const char kind = scalar(type)) {
        if (kind == 'd') {
            refuse(where, "double cannot be shared: GLSL 330 and ES have none; write T");
        } else if (kind == 'l') {
            refuse(where, "'" + type.getAsString() +
                              "' cannot be shared: GLSL has int and uint of 32 bits alone");
        } else if (const auto* e = type->getAs<EnumType>()) {
            require_enumeration(e->getDecl(), where);
        }
        return {scalar_name(kind)};
    }
    if (const auto glm = as_glm(type)) {
        const char kind = scalar(glm->element);
        if (kind == 'd' || kind == 'l' || kind == 0 || (glm->columns > 1 && kind != 'f')) {
            refuse(where, kind == 'd' ? "double cannot be shared: GLSL 330 and ES have none; "
                                        "write T"
                                      : "GLSL has no such vector or matrix");
            return {"vec4"};
        }
        if (glm->columns == 1) {
            if (glm->rows == 1) {
                return {scalar_name(kind)};
            }
            const std::string letter = kind == 'f' ? "" : std::string(1, kind);
            return {letter + "vec" + std::to_string(glm->rows)};
        }
        std::string name = "mat" + std::to_string(glm->columns);
        if (glm->columns != glm->rows) {
            name += "x" + std::to_string(glm->rows);
        }
        return {name};
    }
    if (const auto array = as_array(type)) {
        glsl_type element = type_of(array->element, where);
        if (element.array > 0) {
            refuse(where, "arrays of arrays cannot be shared: GLSL 330 has none; use a struct "
                          "for the inner array");
        }
        if (element.opaque) {
            refuse(where, "an array of device objects cannot be shared");
        }
        element.array = array->size;
        return element;
    }
    if (type->isArrayType()) {
        refuse(where, "an array without a constant size cannot be shared");
        return {"int"};
    }
    if (const CXXRecordDecl* record = type->getAsCXXRecordDecl()) {
        if (const auto text = annotation(record, "glsl_type:")) {
            return {*text, 0, true};
        }
        if (record->isLambda()) {
            refuse(where, "a lambda cannot be shared: write a function, or a struct with a "
                          "call operator");
            return {"int"};
        }
        if (in_namespace(record, "std")) {
            refuse(where, "'" + record->getQualifiedNameAsString() +
                              "' cannot be shared: GLSL has no containers; use an array of "
                              "constant size");
            return {"int"};
        }
        return {require_structure(record, where)};
    }
    refuse(where, "the type '" + type.getAsString() + "' cannot be shared");
    return {"int"};
}

std::string translator::cpp_type(QualType type, const std::string& scalar_text) {
    type = type.getNonReferenceType().getCanonicalType().getUnqualifiedType();
    if (const auto* e = type->getAs<EnumType>()) {
        return e->getDecl()->getQualifiedNameAsString();
    }
    if (const char kind = scalar(type)) {
        return kind == 'f'   ? scalar_text
               : kind == 'u' ? "unsigned"
               : kind == 'i' ? "int"
               : kind == 'b' ? "bool"
                             : "";
    }
    if (type->isVoidType()) {
        return "void";
    }
    if (const auto glm = as_glm(type)) {
        const std::string element = cpp_type(glm->element, scalar_text);
        if (glm->columns == 1) {
            return "glm::vec<" + std::to_string(glm->rows) + ", " + element + ">";
        }
        return "glm::mat<" + std::to_string(glm->columns) + ", " + std::to_string(glm->rows) +
               ", " + element + ">";
    }
    if (const auto array = as_array(type)) {
        const std::string element = cpp_type(array->element, scalar_text);
        return type->isArrayType()
                   ? element + "[" + std::to_string(array->size) + "]"
                   : "std::array<" + element + ", " + std::to_string(array->size) + ">";
    }
    if (const CXXRecordDecl* record = type->getAsCXXRecordDecl()) {
        std::string name = record->getQualifiedNameAsString();
        if (const auto* special = dyn_cast<ClassTemplateSpecializationDecl>(record)) {
            name += template_arguments(special->getTemplateArgs(), scalar_text);
        }
        return name;
    }
    return "";
}

std::string translator::template_arguments(const TemplateArgumentList& list,
                                           const std::string& scalar_text) {
    std::string result;
    for (const TemplateArgument& each : list.asArray()) {
        result += result.empty() ? "<" : ", ";
        if (each.getKind() == TemplateArgument::Type) {
            result += cpp_type(each.getAsType(), scalar_text);
        } else if (each.getKind() == TemplateArgument::Integral) {
            if (each.getIntegralType()->isEnumeralType() ||
                each.getIntegralType()->isBooleanType()) {
                result += "static_cast<" + each.getIntegralType().getAsString() + ">(" +
                          decimal(each.getAsIntegral()) + ")";
            } else {
                result += decimal(each.getAsIntegral());
            }
        }
    }
    return result + ">";
}

void translator::check_name(const std::string& name, SourceLocation where, bool has_prefix) {
    if (!has_prefix && is_reserved_word(name)) {
        refuse(where, "'" + name + "' is a reserved word of GLSL");
    } else if (name.find("__") != std::string::npos) {
        refuse(where, "'" + name + "' has a double underscore, which GLSL reserves");
    } else if (name.rfind("gl_", 0) == 0 || name.rfind("ws_", 0) == 0 ||
               name.rfind("WS_", 0) == 0) {
        refuse(where, "'" + name + "' begins like a name of GLSL or of the emitted code");
    }
}

std::string translator::global_name(const NamedDecl* declaration, const std::string& own) {
    std::string name = own;
    std::vector<std::string> spaces;
    const DeclContext* context = declaration->getDeclContext();
    for (; context != nullptr && !context->isTranslationUnit(); context = context->getParent()) {
        if (const auto* space = dyn_cast<NamespaceDecl>(context)) {
            if (space->isAnonymousNamespace() || space->isInline()) {
                continue;
            }
            spaces.push_back(space->getName().str());
        } else if (const auto* record = dyn_cast<CXXRecordDecl>(context)) {
            name = record->getName().str() + "_" + name;
        }
    }
    for (std::size_t i = 0; i + 1 < spaces.size(); ++i) {
        if (spaces[i] != "detail") {
            name = spaces[i] + "_" + name;
        }
    }
    check_name(own, declaration->getLocation(), true);
    return squeeze("ws_" + name);
}

std::string translator::name_suffix(const TemplateArgumentList& list) {
    std::string suffix;
    for (const TemplateArgument& each : list.asArray()) {
        if (each.getKind() == TemplateArgument::Integral) {
            const auto& value = each.getAsIntegral();
            suffix += "_" + (value.isNegative() ? "m" + decimal(value).substr(1) : decimal(value));
        } else if (each.getKind() == TemplateArgument::Type) {
            const QualType type = each.getAsType();
            const CXXRecordDecl* record = type->getAsCXXRecordDecl();
            if (record != nullptr && !as_glm(type) && !in_namespace(record, "std") &&
                !annotation(record, "glsl_type:")) {
                suffix += "_" + record->getName().str();
                if (const auto* special = dyn_cast<ClassTemplateSpecializationDecl>(record)) {
                    suffix += name_suffix(special->getTemplateArgs());
                }
            } else if (scalar(type) != 'f' && scalar(type) != 0) {
                suffix += "_" + scalar_name(scalar(type));
            }
        }
    }
    return suffix;
}

std::string translator::topic_of(const NamedDecl* declaration) {
    const SourceLocation where = sources_.getExpansionLoc(begin_of_declaration(declaration));
    StringRef path = sources_.getFilename(where);
    const auto slash = path.find_last_of("/\\");
    StringRef name = slash == StringRef::npos ? path : path.drop_front(slash + 1);
    return name.substr(0, name.find_last_of('.')).str();
}

std::string translator::local_name(const ValueDecl* declaration) {
    frame& current = frames_.back();
    const auto found = current.names.find(declaration);
    if (found != current.names.end()) {
        return found->second;
    }
    std::string name = declaration->getName().str();
    check_name(name, declaration->getLocation());
    if (is_builtin_name(name) || name == "self") {
        name += "_";
        if (current.used_names.count(name) != 0) {
            refuse(declaration->getLocation(), "'" + name + "' is taken");
        }
    }
    current.used_names.insert(name);
    current.names[declaration] = name;
    return name;
}

} // namespace glslgen
