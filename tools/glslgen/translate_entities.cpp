// Structs, enumerations and constants.
#include "translator_class.hpp"

namespace glslgen {

void translator::depend(std::size_t index) {
    if (!frames_.empty()) {
        frames_.back().dependencies.insert(index);
    }
}

entity translator::new_entity(entity_kind kind, const NamedDecl* declaration) {
    entity result;
    result.kind = kind;
    result.cpp_name = declaration->getQualifiedNameAsString();
    result.topic = topic_of(declaration);
    const SourceLocation begin = begin_of_declaration(declaration);
    std::vector<std::string> doc;
    for (const std::string& each : doc_lines(begin)) {
        append_wrapped(doc, each);
    }
    result.doc = joined(doc);
    result.source = result.doc + source_between(begin, end_of_declaration(declaration));
    result.offset = offset(sources_.getExpansionLoc(begin));
    return result;
}

std::size_t translator::keep(const Decl* declaration, entity made) {
    made.dependencies.assign(frames_.back().dependencies.begin(),
                             frames_.back().dependencies.end());
    const std::size_t index = entities_.size();
    entities_.push_back(std::move(made));
    known_[declaration] = index;
    return index;
}

std::string translator::require_structure(const CXXRecordDecl* record, SourceLocation where) {
    record = record->getDefinition() != nullptr ? record->getDefinition() : record;
    const Decl* key = record->getCanonicalDecl();
    if (const auto found = known_.find(key); found != known_.end()) {
        depend(found->second);
        return entities_[found->second].name;
    }
    std::string name = record->getName().str();
    if (const auto* special = dyn_cast<ClassTemplateSpecializationDecl>(record)) {
        name += name_suffix(special->getTemplateArgs());
    }
    name = global_name(record, name);
    frames_.push_back({record->getQualifiedNameAsString(), where, {}, nullptr, {}, {}});
    if (!record->hasDefinition() || record->isUnion() || record->getName().empty()) {
        refuse(where, "the type '" + record->getQualifiedNameAsString() +
                          "' cannot be shared: only structs with a definition can");
        frames_.pop_back();
        return name;
    }
    if (record->getNumBases() > 0) {
        refuse(record->bases_begin()->getBeginLoc(),
               "inheritance cannot be shared: make the base a member");
    } else if (record->isPolymorphic()) {
        refuse(record->getLocation(), "virtual functions cannot be shared");
    } else if (record->hasUserDeclaredConstructor() || record->hasUserDeclaredDestructor() ||
               record->hasUserDeclaredCopyAssignment() ||
               record->hasUserDeclaredCopyConstructor()) {
        refuse(record->getLocation(),
               "a struct with constructors, a destructor or its own copying cannot be shared: "
               "use a plain struct and a function that fills it");
    }
    if (record->isLocalClass() != nullptr) {
        refuse(record->getLocation(), "a struct inside a function cannot be shared");
    }
    entity made = new_entity(entity_kind::structure, record);
    made.name = name;
    std::string scalar_text = "float";
    made.is_template = isa<ClassTemplateSpecializationDecl>(record);
    if (made.is_template) {
        scalar_text = "T";
    }
    made.cpp_call = cpp_type(context_.getRecordType(record), scalar_text);
    std::vector<std::string> lines{"struct " + name + " {"};
    const CXXRecordDecl* pattern = record->getTemplateInstantiationPattern();
    const CXXRecordDecl* written = pattern != nullptr ? pattern : record;
    const FileID file = sources_.getFileID(sources_.getExpansionLoc(written->getBeginLoc()));
    unsigned previous = line(written->getBraceRange().getBegin());
    const FieldDecl* last = nullptr;
    for (const FieldDecl* field : record->fields()) {
        const glsl_type type = type_of(field->getType(), field->getLocation());
        if (field->getType()->isReferenceType()) {
            refuse(field->getLocation(), "a reference cannot be a member");
        }
        if (type.opaque) {
            refuse(field->getLocation(), "a device object cannot be a member");
        }
        if (field->isBitField()) {
            refuse(field->getLocation(), "bit fields cannot be shared");
        }
        if (field->isAnonymousStructOrUnion() || field->getName().empty()) {
            refuse(field->getLocation(), "a member without a name cannot be shared");
        }
        const std::string member = field->getName().str();
        check_name(member, field->getLocation());
        made.variables.push_back(
            {member, type.base, type.array, "", cpp_type(field->getType(), scalar_text)});
        // several members of one declaration keep their line
        const bool joins =
            last != nullptr && type.array == 0 && last->getBeginLoc() == field->getBeginLoc();
        for (const comment& each : comments_of(file)) {
            if (each.own_line && each.line > previous &&
                each.last_line < line(field->getLocation()) &&
                each.begin > offset(sources_.getExpansionLoc(written->getBeginLoc())) &&
                is_last_run(file, each, field)) {
                for (const std::string& text : comment_lines(each.text)) {
                    lines.push_back("    " + text);
                }
            }
        }
        if (joins) {
            std::string& open = lines.back();
            open.erase(open.find(';'));
            open += ", " + member + ";";
        } else {
            lines.push_back("    " + type.declare(member) + ";");
        }
        previous = line(field->getEndLoc());
        unsigned last_line = previous;
        const std::string tail = comment_on(file, field->getEndLoc(), last_line);
        previous = last_line;
        if (!tail.empty() && lines.back().find("//") == std::string::npos) {
            const std::string member_line = lines.back();
            lines.pop_back();
            append_with_comment(lines, member_line, tail);
        }
        last = field;
    }
    if (record->field_empty()) {
        lines.push_back("    int unused; // GLSL has no empty struct");
        made.variables.push_back({"unused", "int", 0, "", ""});
    }
    lines.push_back("};");
    align_comments(lines);
    made.text = joined(lines);
    const std::size_t index = keep(key, std::move(made));
    frames_.pop_back();
    depend(index);
    return name;
}

bool translator::is_last_run(FileID file, const comment& each, const FieldDecl* field) {
    const StringRef buffer = sources_.getBufferData(file);
    const unsigned begin = offset(sources_.getExpansionLoc(field->getBeginLoc()));
    if (each.end >= begin || each.text.rfind("///<", 0) == 0) {
        return false;
    }
    StringRef between = buffer.slice(each.end, begin);
    // only comments and white space up to the member
    while (true) {
        between = between.ltrim();
        if (between.take_front(2) != "//") {
            break;
        }
        const auto newline = between.find('\n');
        between = newline == StringRef::npos ? StringRef() : between.drop_front(newline);
    }
    return between.empty();
}

void translator::require_enumeration(const EnumDecl* declaration, SourceLocation where) {
    declaration =
        declaration->getDefinition() != nullptr ? declaration->getDefinition() : declaration;
    const Decl* key = declaration->getCanonicalDecl();
    if (const auto found = known_.find(key); found != known_.end()) {
        depend(found->second);
        return;
    }
    frames_.push_back({declaration->getQualifiedNameAsString(), where, {}, nullptr, {}, {}});
    entity made = new_entity(entity_kind::enumeration, declaration);
    made.name = global_name(declaration, declaration->getName().str());
    const char kind = scalar(context_.getTypeDeclType(declaration));
    if (kind != 'u' && kind != 'i') {
        refuse(declaration->getLocation(),
               "an enumeration that is shared has int or unsigned int beneath");
    }
    const FileID file = sources_.getFileID(sources_.getExpansionLoc(declaration->getBeginLoc()));
    std::vector<std::string> lines;
    for (const EnumConstantDecl* each : declaration->enumerators()) {
        check_name(each->getName().str(), each->getLocation(), true);
        std::string text = "const " + scalar_name(kind) + " " + made.name + "_" +
                           each->getName().str() + " = " + integer_text(each->getInitVal(), kind) +
                           ";";
        unsigned last_line = 0;
        const std::string tail = comment_on(file, each->getEndLoc(), last_line);
        append_with_comment(lines, text, tail);
    }
    align_comments(lines);
    made.text = joined(lines);
    const std::size_t index = keep(key, std::move(made));
    frames_.pop_back();
    depend(index);
}

std::string translator::require_constant(const VarDecl* variable, SourceLocation where) {
    const VarDecl* definition = variable->getDefinition();
    variable = definition != nullptr ? definition : variable;
    const Decl* key = variable->getCanonicalDecl();
    if (const auto found = known_.find(key); found != known_.end()) {
        depend(found->second);
        return entities_[found->second].name;
    }
    std::string own = variable->getName().str();
    if (const auto* special = dyn_cast<VarTemplateSpecializationDecl>(variable)) {
        own += name_suffix(special->getTemplateArgs());
    }
    const std::string name = global_name(variable, own);
    frames_.push_back({variable->getQualifiedNameAsString(), where, {}, nullptr, {}, {}});
    if (!variable->isConstexpr()) {
        refuse(where, "'" + variable->getName().str() +
                          "' is a variable at namespace scope: only constexpr ones can be "
                          "shared");
    } else {
        entity made = new_entity(entity_kind::constant, variable);
        made.name = name;
        made.is_template = isa<VarTemplateSpecializationDecl>(variable);
        const glsl_type type = type_of(variable->getType(), variable->getLocation());
        made.result = type.base;
        const Expr* init = variable->getAnyInitializer();
        std::string value;
        if (init != nullptr && is_plain_constant(init)) {
            value = expression(init).text;
        } else if (const APValue* computed = variable->evaluateValue()) {
            value = value_text(*computed, variable->getType(), variable->getLocation());
        }
        std::vector<std::string> lines;
        append_wrapped(lines, "const " + type.declare(name) + " = " + value + ";");
        made.text = joined(lines);
        keep(key, std::move(made));
    }
    frames_.pop_back();
    if (const auto found = known_.find(key); found != known_.end()) {
        depend(found->second);
    }
    return name;
}

bool translator::is_plain_constant(const Expr* e) {
    if (const auto* call = dyn_cast<CallExpr>(e)) {
        const FunctionDecl* callee = call->getDirectCallee();
        if (callee == nullptr || !(isa<CXXOperatorCallExpr>(call) ? in_namespace(callee, "glm")
                                                                  : call->getNumArgs() == 0)) {
            return false;
        }
        if (call->getNumArgs() == 0) {
            return true;
        }
    }
    for (const Stmt* child : e->children()) {
        if (const auto* part = dyn_cast_or_null<Expr>(child)) {
            if (!is_plain_constant(part)) {
                return false;
            }
        }
    }
    return true;
}

std::string translator::integer_text(const llvm::APSInt& value, char kind) {
    const std::string text = decimal(value);
    if (kind == 'u') {
        return std::to_string(value.extOrTrunc(32).getZExtValue()) + "u";
    }
    return text == "-2147483648" ? "int(0x80000000u)" : text; // 2147483648 is no int
}

std::string translator::float_text(const llvm::APFloat& value, SourceLocation where) {
    llvm::APFloat rounded = value;
    bool loses = false;
    rounded.convert(llvm::APFloat::IEEEsingle(), llvm::APFloat::rmNearestTiesToEven, &loses);
    if (!rounded.isFinite()) {
        refuse(where, "infinity and NaN have no spelling in GLSL");
        return "0.0";
    }
    return float_literal(rounded.convertToFloat());
}

std::string translator::value_text(const APValue& value, QualType type, SourceLocation where) {
    type = type.getCanonicalType();
    if (const auto array = as_array(type)) {
        const APValue* list = &value;
        if (list->isStruct()) {
            list = &list->getStructField(0); // std::array
        }
        const glsl_type glsl = type_of(type, where);
        std::string result = glsl.in_front() + "(";
        for (int i = 0; i < array->size; ++i) {
            const unsigned at = static_cast<unsigned>(i);
            const APValue& each = at < list->getArrayInitializedElts()
                                      ? list->getArrayInitializedElt(at)
                                      : list->getArrayFiller();
            result += (i > 0 ? ", " : "") + value_text(each, array->element, where);
        }
        return result + ")";
    }
    if (value.isInt()) {
        const char kind = scalar(type);
        if (kind == 'b') {
            return value.getInt() == 0 ? "false" : "true";
        }
        return integer_text(value.getInt(), kind);
    }
    if (value.isFloat()) {
        return float_text(value.getFloat(), where);
    }
    if (value.isStruct() && !as_glm(type)) {
        const CXXRecordDecl* record = type->getAsCXXRecordDecl();
        std::string result = require_structure(record, where) + "(";
        unsigned i = 0;
        for (const FieldDecl* field : record->fields()) {
            result +=
                (i > 0 ? ", " : "") + value_text(value.getStructField(i), field->getType(), where);
            ++i;
        }
        return result + ")";
    }
    refuse(where, "the value of this constant has no spelling in GLSL");
    return "0";
}

} // namespace glslgen
