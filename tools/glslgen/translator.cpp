// The translator proper. Each construct is either known here, with the same meaning in C++ and
// GLSL, or refused by a diagnostic at the place where it stands: nothing is guessed.
#include "translator.hpp"

#include "text.hpp"
#include "vocabulary.hpp"

#include <clang/AST/ASTConsumer.h>
#include <clang/AST/ASTContext.h>
#include <clang/AST/Attr.h>
#include <clang/AST/DeclTemplate.h>
#include <clang/AST/ExprCXX.h>
#include <clang/AST/RecordLayout.h>
#include <clang/AST/StmtCXX.h>
#include <clang/Basic/Diagnostic.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Frontend/CompilerInstance.h>
#include <clang/Frontend/FrontendAction.h>
#include <clang/Lex/Lexer.h>
#include <clang/Tooling/Tooling.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace glslgen {
namespace {

using namespace clang;

// Precedence of GLSL expressions; C++ orders the same operators the same way.
enum precedence {
    assignment,
    conditional,
    logical_or,
    logical_and,
    bit_or,
    bit_xor,
    bit_and,
    equality,
    relational,
    shift,
    additive,
    multiplicative,
    unary,
    primary
};

struct code {
    std::string text;
    int level = primary;
};

std::string at_least(const code& part, int level) {
    return part.level >= level ? part.text : "(" + part.text + ")";
}

struct comment {
    unsigned begin;
    unsigned end;
    unsigned line;
    unsigned last_line;
    bool own_line; // nothing but blanks before it
    std::string text;
};

// A GLSL type; `array` elements of it, or none.
struct glsl_type {
    std::string base;
    int array = 0;
    bool opaque = false;

    [[nodiscard]] std::string in_front() const {
        return array > 0 ? base + "[" + std::to_string(array) + "]" : base;
    }
    [[nodiscard]] std::string declare(const std::string& name) const {
        return array > 0 ? base + " " + name + "[" + std::to_string(array) + "]"
                         : base + " " + name;
    }
};

// A vector or matrix of GLM.
struct glm_type {
    int columns; // 1 for a vector
    int rows;
    QualType element;
};

std::string squeeze(std::string name) {
    std::size_t at = 0;
    while ((at = name.find("__", at)) != std::string::npos) {
        name.erase(at, 1);
    }
    return name;
}

bool in_namespace(const Decl* decl, StringRef name) {
    const DeclContext* context = decl->getDeclContext();
    while (context != nullptr && !context->isTranslationUnit()) {
        if (const auto* space = dyn_cast<NamespaceDecl>(context)) {
            const DeclContext* parent = space->getParent();
            while (parent->isInlineNamespace()) {
                parent = parent->getParent();
            }
            if (space->getName() == name && parent->getRedeclContext()->isTranslationUnit()) {
                return true;
            }
        }
        context = context->getParent();
    }
    return false;
}

const FunctionDecl* pattern_of(const FunctionDecl* function) {
    const FunctionDecl* pattern = function->getTemplateInstantiationPattern();
    return pattern != nullptr ? pattern : function;
}

// An lvalue: the variable it belongs to and the way to the part.
struct access {
    const ValueDecl* base = nullptr;
    bool is_this = false;
    std::vector<std::string> steps; // member names; [3] for a constant index, [] for any other
};

// What is surely written of an `out` parameter, which is undefined in GLSL until then.
struct assigned {
    bool whole = false;
    std::set<std::string> parts; // paths of members
    bool unreachable = false;
};

// A number as it is: an unsigned one may not fit std::int64_t.
std::string decimal(const llvm::APSInt& value) {
    return value.isSigned() ? std::to_string(value.getSExtValue())
                            : std::to_string(value.getZExtValue());
}

class translator {
  public:
    translator(ASTContext& context, const translation_options& options)
        : context_(context), sources_(context.getSourceManager()), options_(options) {}

    bool run(translation& result);

  private:
    // What is being translated: for the notes of diagnostics, and to find recursion.
    struct frame {
        std::string display;
        SourceLocation requested;
        std::set<std::size_t> dependencies;
        const FunctionDecl* function = nullptr;
        std::map<const ValueDecl*, std::string> names;
        std::set<std::string> used_names;
    };

    struct statement_writer {
        std::vector<std::string> lines;
        const std::vector<comment>* comments = nullptr;
        std::size_t next_comment = 0;
        unsigned last_line = 0;     // line of the source that was written last
        bool at_block_start = true; // no blank line after an opening brace
    };

    ASTContext& context_;
    SourceManager& sources_;
    const translation_options& options_;
    bool failed_ = false;
    std::set<std::pair<unsigned, std::string>> reported_;

    std::vector<entity> entities_;
    std::map<const Decl*, std::size_t> known_;
    std::set<const Decl*> active_;
    std::vector<frame> frames_;
    std::map<FileID, std::vector<comment>> comments_;
    statement_writer out_;

    // Diagnostics ---------------------------------------------------------------------------------

    void refuse(SourceLocation where, const std::string& message) {
        failed_ = true;
        where = sources_.getExpansionLoc(where);
        if (!reported_.emplace(where.getRawEncoding(), message).second) {
            return;
        }
        DiagnosticsEngine& engine = context_.getDiagnostics();
        engine.Report(where, engine.getCustomDiagID(DiagnosticsEngine::Error, "%0")) << message;
        bool innermost = true;
        for (auto each = frames_.rbegin(); each != frames_.rend(); ++each) {
            const bool root = std::next(each) == frames_.rend();
            const std::string text = (innermost ? "in '" : "needed by '") + each->display +
                                     (root        ? "', shared here"
                                      : innermost ? "', used here"
                                                  : "', used here");
            engine.Report(each->requested, engine.getCustomDiagID(DiagnosticsEngine::Note, "%0"))
                << text;
            innermost = false;
        }
    }

    // Places and comments ------------------------------------------------------------------------

    SourceLocation begin_of(const Stmt* s) { return sources_.getExpansionLoc(s->getBeginLoc()); }
    SourceLocation end_of(const Stmt* s) {
        const auto range = sources_.getExpansionRange(s->getSourceRange());
        return Lexer::getLocForEndOfToken(range.getEnd(), 0, sources_, context_.getLangOpts());
    }
    unsigned offset(SourceLocation where) { return sources_.getFileOffset(where); }
    unsigned line(SourceLocation where) { return sources_.getExpansionLineNumber(where); }

    const std::vector<comment>& comments_of(FileID file) {
        const auto found = comments_.find(file);
        if (found != comments_.end()) {
            return found->second;
        }
        std::vector<comment>& result = comments_[file];
        bool invalid = false;
        const StringRef buffer = sources_.getBufferData(file, &invalid);
        if (invalid) {
            return result;
        }
        const SourceLocation start = sources_.getLocForStartOfFile(file);
        Lexer lexer(start, context_.getLangOpts(), buffer.begin(), buffer.begin(), buffer.end());
        lexer.SetCommentRetentionState(true);
        Token token;
        do {
            lexer.LexFromRawLexer(token);
            if (token.is(tok::comment)) {
                comment each;
                each.begin = offset(token.getLocation());
                each.end = each.begin + token.getLength();
                each.line = line(token.getLocation());
                each.text = buffer.substr(each.begin, token.getLength()).rtrim().str();
                each.last_line =
                    each.line +
                    static_cast<unsigned>(std::count(each.text.begin(), each.text.end(), '\n'));
                const StringRef before = buffer.substr(0, each.begin);
                const auto newline = before.rfind('\n');
                each.own_line =
                    before.substr(newline == StringRef::npos ? 0 : newline + 1).trim().empty();
                result.push_back(std::move(each));
            }
        } while (token.isNot(tok::eof));
        return result;
    }

    // A block comment as `//` lines; a line comment as it is.
    static std::vector<std::string> comment_lines(const std::string& text) {
        std::vector<std::string> lines;
        if (text.rfind("//", 0) == 0) {
            lines.push_back(to_ascii(text));
            return lines;
        }
        const bool is_doc = text.rfind("/**", 0) == 0 || text.rfind("/*!", 0) == 0;
        StringRef body = StringRef(text).drop_front(is_doc ? 3 : 2).drop_back(2);
        SmallVector<StringRef, 8> parts;
        body.split(parts, '\n');
        for (StringRef part : parts) {
            part = part.trim();
            if (part.consume_front("*")) {
                part = part.trim();
            }
            if (!part.empty()) {
                lines.push_back((is_doc ? "/// " : "// ") + to_ascii(part.str()));
            }
        }
        return lines;
    }

    // The doc comment directly above a declaration.
    std::vector<std::string> doc_lines(SourceLocation declaration) {
        std::vector<std::string> lines;
        const SourceLocation where = sources_.getExpansionLoc(declaration);
        const std::vector<comment>& all = comments_of(sources_.getFileID(where));
        const unsigned begin = offset(where);
        unsigned expected = line(where);
        auto each = std::lower_bound(all.begin(), all.end(), begin,
                                     [](const comment& c, unsigned at) { return c.begin < at; });
        std::vector<const comment*> run;
        while (each != all.begin()) {
            --each;
            if (each->last_line + 1 != expected || !each->own_line ||
                (each->text.rfind("///", 0) != 0 && each->text.rfind("/**", 0) != 0 &&
                 each->text.rfind("/*!", 0) != 0) ||
                each->text.rfind("///<", 0) == 0) {
                break;
            }
            run.push_back(&*each);
            expected = each->line;
        }
        bool skipping = false;
        for (auto c = run.rbegin(); c != run.rend(); ++c) {
            for (std::string& text : comment_lines((*c)->text)) {
                // template parameters do not exist in GLSL
                StringRef words = StringRef(text).drop_front(3).trim();
                if (words.consume_front("@") || words.consume_front("\\")) {
                    skipping = words.take_front(6) == "tparam";
                } else if (words.empty()) {
                    skipping = false;
                }
                if (!skipping) {
                    lines.push_back(std::move(text));
                }
            }
        }
        while (!lines.empty() && lines.back() == "///") {
            lines.pop_back();
        }
        return lines;
    }

    // The comment behind a member or an enumerator, with what it says on further lines.
    std::string comment_on(FileID file, SourceLocation end, unsigned& last_line) {
        const unsigned at = line(end);
        std::string tail;
        for (const comment& each : comments_of(file)) {
            if (tail.empty()) {
                if (!each.own_line && each.line == at &&
                    each.begin > offset(sources_.getExpansionLoc(end))) {
                    tail = comment_lines(each.text).front();
                    last_line = each.line;
                }
            } else if (each.own_line && each.line == last_line + 1 &&
                       each.text.rfind("///<", 0) == 0) {
                tail +=
                    " " + StringRef(comment_lines(each.text).front()).drop_front(4).trim().str();
                last_line = each.line;
            }
        }
        return tail;
    }

    // Comments behind the code of neighbouring lines begin in one column.
    static void align_comments(std::vector<std::string>& lines) {
        const auto code_width = [](const std::string& text) {
            const auto at = text.find(" //");
            return at == std::string::npos || text.find_first_not_of(' ') == at + 1 ? std::size_t(0)
                                                                                    : at;
        };
        for (std::size_t first = 0; first < lines.size();) {
            std::size_t end = first;
            std::size_t code_end = 0;
            std::size_t tail = 0;
            while (end < lines.size() && code_width(lines[end]) != 0) {
                code_end = std::max(code_end, code_width(lines[end]));
                tail = std::max(tail, lines[end].size() - code_width(lines[end]));
                ++end;
            }
            for (std::size_t i = first; i < end && code_end + tail <= column_limit; ++i) {
                lines[i].insert(code_width(lines[i]), code_end - code_width(lines[i]), ' ');
            }
            first = end + 1;
        }
    }

    // A line of code and the comment on it, which goes above where there is no room.
    static void append_with_comment(std::vector<std::string>& lines, const std::string& text,
                                    const std::string& tail) {
        if (tail.empty() || text.size() + 1 + tail.size() <= column_limit) {
            lines.push_back(tail.empty() ? text : text + " " + tail);
            return;
        }
        StringRef words = tail;
        const bool is_doc = words.consume_front("///<");
        if (!is_doc) {
            words.consume_front("//");
        }
        const std::string indentation(text.find_first_not_of(' '), ' ');
        append_wrapped(lines, indentation + (is_doc ? "/// " : "// ") + words.trim().str());
        lines.push_back(text);
    }

    static std::string joined(const std::vector<std::string>& lines) {
        std::string result;
        for (const std::string& each : lines) {
            result += each + "\n";
        }
        return result;
    }

    // `@param[out]` and `@param[in,out]` of a function's doc comment.
    std::optional<std::string> documented_direction(const FunctionDecl* function,
                                                    const std::string& parameter) {
        for (const std::string& text : doc_lines(begin_of_declaration(function))) {
            const StringRef words = StringRef(text).drop_front(3).trim();
            for (const auto& [tag, direction] :
                 {std::pair("param[out]", "out"), std::pair("param[in,out]", "inout"),
                  std::pair("param[in, out]", "inout")}) {
                StringRef rest = words;
                if (!(rest.consume_front("@") || rest.consume_front("\\")) ||
                    !rest.consume_front(tag)) {
                    continue;
                }
                // one tag may name several parameters: @param[out] a, b text
                SmallVector<StringRef, 4> names;
                rest.trim().split(names, ',');
                for (StringRef name : names) {
                    const StringRef first = name.trim().split(' ').first;
                    if (first == parameter) {
                        return direction;
                    }
                    if (name.trim().contains(' ')) {
                        break;
                    }
                }
            }
        }
        return std::nullopt;
    }

    // Where the text of a declaration begins, `template <…>` included.
    SourceLocation begin_of_declaration(const NamedDecl* declaration) {
        if (const auto* function = dyn_cast<FunctionDecl>(declaration)) {
            const FunctionDecl* pattern = pattern_of(function);
            if (const FunctionTemplateDecl* t = pattern->getDescribedFunctionTemplate()) {
                return t->getBeginLoc();
            }
            return pattern->getBeginLoc();
        }
        if (const auto* record = dyn_cast<CXXRecordDecl>(declaration)) {
            const CXXRecordDecl* pattern = record->getTemplateInstantiationPattern();
            pattern = pattern != nullptr ? pattern : record;
            if (const ClassTemplateDecl* t = pattern->getDescribedClassTemplate()) {
                return t->getBeginLoc();
            }
            return pattern->getBeginLoc();
        }
        if (const auto* variable = dyn_cast<VarDecl>(declaration)) {
            const VarDecl* pattern = variable->getTemplateInstantiationPattern();
            pattern = pattern != nullptr ? pattern : variable;
            if (const VarTemplateDecl* t = pattern->getDescribedVarTemplate()) {
                return t->getBeginLoc();
            }
            return pattern->getBeginLoc();
        }
        return declaration->getBeginLoc();
    }

    SourceLocation end_of_declaration(const NamedDecl* declaration) {
        if (const auto* function = dyn_cast<FunctionDecl>(declaration)) {
            return pattern_of(function)->getEndLoc();
        }
        if (const auto* record = dyn_cast<CXXRecordDecl>(declaration)) {
            const CXXRecordDecl* pattern = record->getTemplateInstantiationPattern();
            return (pattern != nullptr ? pattern : record)->getEndLoc();
        }
        if (const auto* variable = dyn_cast<VarDecl>(declaration)) {
            const VarDecl* pattern = variable->getTemplateInstantiationPattern();
            return (pattern != nullptr ? pattern : variable)->getEndLoc();
        }
        return declaration->getEndLoc();
    }

    std::string source_between(SourceLocation begin, SourceLocation end) {
        return Lexer::getSourceText(CharSourceRange::getTokenRange(sources_.getExpansionLoc(begin),
                                                                   sources_.getExpansionLoc(end)),
                                    sources_, context_.getLangOpts())
            .str();
    }

    // Types --------------------------------------------------------------------------------------

    // f float, i int, u uint, b bool, d double, l other integers, 0 not a scalar.
    char scalar(QualType type) {
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

    static std::string scalar_name(char kind) {
        return kind == 'f' ? "float" : kind == 'i' ? "int" : kind == 'u' ? "uint" : "bool";
    }

    std::optional<glm_type> as_glm(QualType type) {
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

    struct array_type {
        QualType element;
        int size;
    };

    // A C array or a std::array.
    std::optional<array_type> as_array(QualType type) {
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

    // The text of an annotation that begins with `key`, on a declaration or its template.
    std::optional<std::string> annotation(const Decl* declaration, StringRef key) {
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

    glsl_type type_of(QualType type, SourceLocation where) {
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

    // The C++ type with float written T, for the parity tests; empty where it has no plain form.
    std::string cpp_type(QualType type, const std::string& scalar_text) {
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

    std::string template_arguments(const TemplateArgumentList& list,
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

    // Names --------------------------------------------------------------------------------------

    // Names at namespace scope get a prefix and may be reserved words.
    void check_name(const std::string& name, SourceLocation where, bool has_prefix = false) {
        if (!has_prefix && is_reserved_word(name)) {
            refuse(where, "'" + name + "' is a reserved word of GLSL");
        } else if (name.find("__") != std::string::npos) {
            refuse(where, "'" + name + "' has a double underscore, which GLSL reserves");
        } else if (name.rfind("gl_", 0) == 0 || name.rfind("ws_", 0) == 0 ||
                   name.rfind("WS_", 0) == 0) {
            refuse(where, "'" + name + "' begins like a name of GLSL or of the emitted code");
        }
    }

    // Name without the outermost namespace; further namespaces but `detail` become part of it.
    std::string global_name(const NamedDecl* declaration, const std::string& own) {
        std::string name = own;
        std::vector<std::string> spaces;
        const DeclContext* context = declaration->getDeclContext();
        for (; context != nullptr && !context->isTranslationUnit();
             context = context->getParent()) {
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

    // Template arguments that tell specialisations of one struct apart: numbers and other structs.
    std::string name_suffix(const TemplateArgumentList& list) {
        std::string suffix;
        for (const TemplateArgument& each : list.asArray()) {
            if (each.getKind() == TemplateArgument::Integral) {
                const auto& value = each.getAsIntegral();
                suffix +=
                    "_" + (value.isNegative() ? "m" + decimal(value).substr(1) : decimal(value));
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

    std::string topic_of(const NamedDecl* declaration) {
        const SourceLocation where = sources_.getExpansionLoc(begin_of_declaration(declaration));
        StringRef path = sources_.getFilename(where);
        const auto slash = path.find_last_of("/\\");
        StringRef name = slash == StringRef::npos ? path : path.drop_front(slash + 1);
        return name.substr(0, name.find_last_of('.')).str();
    }

    std::string local_name(const ValueDecl* declaration) {
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

    // Entities -----------------------------------------------------------------------------------

    void depend(std::size_t index) {
        if (!frames_.empty()) {
            frames_.back().dependencies.insert(index);
        }
    }

    entity new_entity(entity_kind kind, const NamedDecl* declaration) {
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

    std::size_t keep(const Decl* declaration, entity made) {
        made.dependencies.assign(frames_.back().dependencies.begin(),
                                 frames_.back().dependencies.end());
        const std::size_t index = entities_.size();
        entities_.push_back(std::move(made));
        known_[declaration] = index;
        return index;
    }

    std::string require_structure(const CXXRecordDecl* record, SourceLocation where) {
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

    // Whether a comment on its own line belongs to the member that follows: no other member
    // between.
    bool is_last_run(FileID file, const comment& each, const FieldDecl* field) {
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

    void require_enumeration(const EnumDecl* declaration, SourceLocation where) {
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
        const FileID file =
            sources_.getFileID(sources_.getExpansionLoc(declaration->getBeginLoc()));
        std::vector<std::string> lines;
        for (const EnumConstantDecl* each : declaration->enumerators()) {
            check_name(each->getName().str(), each->getLocation(), true);
            std::string text = "const " + scalar_name(kind) + " " + made.name + "_" +
                               each->getName().str() + " = " +
                               integer_text(each->getInitVal(), kind) + ";";
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

    std::string require_constant(const VarDecl* variable, SourceLocation where) {
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

    // Whether an initialiser consists of what GLSL accepts in constant expressions, as written.
    bool is_plain_constant(const Expr* e) {
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

    static std::string integer_text(const llvm::APSInt& value, char kind) {
        const std::string text = decimal(value);
        if (kind == 'u') {
            return std::to_string(value.extOrTrunc(32).getZExtValue()) + "u";
        }
        return text == "-2147483648" ? "int(0x80000000u)" : text; // 2147483648 is no int
    }

    std::string float_text(const llvm::APFloat& value, SourceLocation where) {
        llvm::APFloat rounded = value;
        bool loses = false;
        rounded.convert(llvm::APFloat::IEEEsingle(), llvm::APFloat::rmNearestTiesToEven, &loses);
        if (!rounded.isFinite()) {
            refuse(where, "infinity and NaN have no spelling in GLSL");
            return "0.0";
        }
        return float_literal(rounded.convertToFloat());
    }

    std::string value_text(const APValue& value, QualType type, SourceLocation where) {
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
                result += (i > 0 ? ", " : "") +
                          value_text(value.getStructField(i), field->getType(), where);
                ++i;
            }
            return result + ")";
        }
        refuse(where, "the value of this constant has no spelling in GLSL");
        return "0";
    }

    // Functions ----------------------------------------------------------------------------------

    static std::string operator_name(OverloadedOperatorKind kind, std::size_t arguments) {
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

    std::string display_name(const FunctionDecl* function) {
        std::string text;
        llvm::raw_string_ostream stream(text);
        function->getNameForDiagnostic(stream, context_.getPrintingPolicy(), true);
        return stream.str();
    }

    std::string require_function(const FunctionDecl* function, SourceLocation where) {
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

    entity translate_function(const FunctionDecl* function, const std::string& name) {
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
            const std::string type =
                require_structure(method->getParent(), function->getLocation());
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
            } else if (type->isLValueReferenceType() &&
                       !type->getPointeeType().isConstQualified()) {
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

    // A parameter that has another name in GLSL has it in the doc comment as well.
    static void rename_parameter(std::string& doc, const std::string& from, const std::string& to) {
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

    // The declared type: an array parameter has decayed, and a pointer stays one.
    static QualType parameter_type(const ParmVarDecl* parameter) {
        const QualType type = parameter->getType();
        return type->isReferenceType() ? type->getPointeeType() : type;
    }

    static assigned merge(const assigned& a, const assigned& b) {
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

    std::size_t part_count(QualType type) {
        type = type.getNonReferenceType().getCanonicalType();
        if (const auto glm = as_glm(type)) {
            return glm->columns == 1 ? static_cast<std::size_t>(glm->rows)
                                     : static_cast<std::size_t>(glm->columns);
        }
        if (const auto array = as_array(type)) {
            return static_cast<std::size_t>(array->size);
        }
        if (const CXXRecordDecl* record = type->getAsCXXRecordDecl()) {
            return static_cast<std::size_t>(
                std::distance(record->field_begin(), record->field_end()));
        }
        return 1;
    }

    void check_assigned(const Stmt* body, const ParmVarDecl* parameter) {
        assigned state;
        flow(body, parameter, state);
        require_assigned(body, parameter, state, end_of(body));
    }

    void require_assigned(const Stmt*, const ParmVarDecl* parameter, const assigned& state,
                          SourceLocation where) {
        if (!state.unreachable && !state.whole &&
            state.parts.size() < part_count(parameter->getType())) {
            refuse(where, "'" + parameter->getName().str() +
                              "' is documented as @param[out] and not written on every way to "
                              "here; GLSL leaves it undefined then. Write it, or document it as "
                              "@param[in,out]");
        }
    }

    void flow(const Stmt* s, const ParmVarDecl* p, assigned& state) {
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

    static bool contains_jump(const Stmt* s) {
        if (s == nullptr) {
            return false;
        }
        if (isa<BreakStmt>(s) || isa<ContinueStmt>(s)) {
            return true;
        }
        return std::any_of(s->children().begin(), s->children().end(), contains_jump);
    }

    void flow_expression(const Expr* e, const ParmVarDecl* p, assigned& state) {
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
                isa<CXXOperatorCallExpr>(call) && callee != nullptr && isa<CXXMethodDecl>(callee)
                    ? 1
                    : 0;
            std::vector<const Expr*> written;
            for (unsigned i = 0; i < call->getNumArgs(); ++i) {
                const bool is_out =
                    callee != nullptr && i >= skip && i - skip < callee->getNumParams() &&
                    is_written(callee->getParamDecl(i - skip)) &&
                    documented_direction(
                        callee, pattern_of(callee)->getParamDecl(i - skip)->getName().str()) ==
                        "out";
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
                    state.whole ||
                    (path.steps.empty() ? state.parts.size() >= part_count(p->getType())
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

    // A member of a member: counted as its own part, and the member once all of those are there.
    void note_part(const access& path, const ParmVarDecl* p, assigned& state);

    static bool is_written(const ParmVarDecl* parameter) {
        const QualType type = parameter->getType();
        return type->isLValueReferenceType() && !type->getPointeeType().isConstQualified();
    }

    // Statements ---------------------------------------------------------------------------------

    static std::string indent(int depth) {
        return std::string(static_cast<std::size_t>(depth) * 4, ' ');
    }

    std::size_t first_comment_after(unsigned at) {
        const auto found =
            std::lower_bound(out_.comments->begin(), out_.comments->end(), at,
                             [](const comment& c, unsigned where) { return c.begin < where; });
        return static_cast<std::size_t>(found - out_.comments->begin());
    }

    void blank_line_before(unsigned source_line) {
        if (!out_.at_block_start && source_line > out_.last_line + 1 && !out_.lines.empty() &&
            !out_.lines.back().empty()) {
            out_.lines.emplace_back();
        }
    }

    // Writes the comments that begin before `at`, each where it stood: on the line of what was
    // written last, or on lines of its own.
    void flush_comments(unsigned at, int depth) {
        while (out_.next_comment < out_.comments->size()) {
            const comment& each = (*out_.comments)[out_.next_comment];
            if (each.begin >= at) {
                break;
            }
            ++out_.next_comment;
            const std::vector<std::string> lines = comment_lines(each.text);
            if (!each.own_line && each.line == out_.last_line && !out_.lines.empty() &&
                out_.lines.back().find("//") == std::string::npos && lines.size() == 1) {
                out_.lines.back() += " " + lines.front();
                continue;
            }
            blank_line_before(each.line);
            for (const std::string& text : lines) {
                append_wrapped(out_.lines, indent(depth) + text);
            }
            out_.at_block_start = false;
            out_.last_line = each.last_line;
        }
    }

    void skip_comments(unsigned until) {
        while (out_.next_comment < out_.comments->size() &&
               (*out_.comments)[out_.next_comment].begin < until) {
            ++out_.next_comment;
        }
    }

    // Comments after the end of a statement, on its line.
    void trailing_comment(unsigned source_line) {
        out_.last_line = source_line;
        if (out_.next_comment < out_.comments->size()) {
            const comment& each = (*out_.comments)[out_.next_comment];
            if (each.line == source_line && !each.own_line && !out_.lines.empty() &&
                out_.lines.back().find("//") == std::string::npos) {
                out_.lines.back() += " " + comment_lines(each.text).front();
                ++out_.next_comment;
                out_.last_line = each.last_line;
            }
        }
    }

    void write(const std::string& text, int depth) {
        append_wrapped(out_.lines, indent(depth) + text);
        out_.at_block_start = false;
    }

    void begin_statement(const Stmt* s, unsigned comments_until, int depth) {
        const unsigned first = line(begin_of(s));
        flush_comments(offset(begin_of(s)), depth);
        blank_line_before(first);
        out_.last_line = first;
        // comments inside the statement stand before it
        const std::size_t inner = first_comment_after(comments_until);
        while (out_.next_comment < inner) {
            const comment& each = (*out_.comments)[out_.next_comment++];
            for (const std::string& text : comment_lines(each.text)) {
                append_wrapped(out_.lines, indent(depth) + text);
            }
            out_.at_block_start = false;
        }
    }

    // The statements of a block, without its braces.
    void block(const Stmt* s, int depth) {
        out_.at_block_start = true;
        if (const auto* compound = dyn_cast<CompoundStmt>(s)) {
            trailing_comment(line(sources_.getExpansionLoc(compound->getLBracLoc())));
            for (const Stmt* each : compound->body()) {
                statement(each, depth);
            }
            flush_comments(offset(sources_.getExpansionLoc(compound->getRBracLoc())), depth);
            out_.last_line = line(sources_.getExpansionLoc(compound->getRBracLoc()));
        } else {
            statement(s, depth);
        }
        out_.at_block_start = false;
    }

    void finish(const Stmt* s) { trailing_comment(line(end_of(s))); }

    void statement(const Stmt* s, int depth) {
        if (const auto* attributed = dyn_cast<AttributedStmt>(s)) {
            bool falls = false;
            for (const Attr* each : attributed->getAttrs()) {
                falls = falls || each->getKind() == attr::FallThrough;
            }
            if (falls) {
                flush_comments(offset(begin_of(s)), depth);
                write("// falls through", depth);
                out_.last_line = line(begin_of(s));
                return;
            }
            return statement(attributed->getSubStmt(), depth);
        }
        if (isa<NullStmt>(s)) {
            return;
        }
        if (const auto* compound = dyn_cast<CompoundStmt>(s)) {
            begin_statement(s, offset(begin_of(s)), depth);
            write("{", depth);
            block(compound, depth + 1);
            write("}", depth);
            return finish(s);
        }
        if (const auto* declaration = dyn_cast<DeclStmt>(s)) {
            return declaration_statement(declaration, depth);
        }
        if (const auto* choice = dyn_cast<IfStmt>(s)) {
            return if_statement(choice, depth);
        }
        if (const auto* loop = dyn_cast<ForStmt>(s)) {
            begin_statement(s, offset(begin_of(loop->getBody())), depth);
            if (loop->getConditionVariable() != nullptr) {
                refuse(loop->getBeginLoc(), "a declaration in a condition cannot be shared");
            }
            std::string head = "for (";
            if (const auto* init = dyn_cast_or_null<DeclStmt>(loop->getInit())) {
                head += for_declaration(init);
            } else if (const auto* init_expression = dyn_cast_or_null<Expr>(loop->getInit())) {
                head += effect_list(init_expression);
            }
            head += ";";
            if (loop->getCond() != nullptr) {
                head += " " + full_expression(loop->getCond()).text;
            }
            head += ";";
            if (loop->getInc() != nullptr) {
                head += " " + effect_list(loop->getInc());
            }
            write(head + ") {", depth);
            block(loop->getBody(), depth + 1);
            write("}", depth);
            return finish(s);
        }
        if (const auto* loop = dyn_cast<WhileStmt>(s)) {
            begin_statement(s, offset(begin_of(loop->getBody())), depth);
            if (loop->getConditionVariable() != nullptr) {
                refuse(loop->getBeginLoc(), "a declaration in a condition cannot be shared");
            }
            write("while (" + full_expression(loop->getCond()).text + ") {", depth);
            block(loop->getBody(), depth + 1);
            write("}", depth);
            return finish(s);
        }
        if (const auto* loop = dyn_cast<DoStmt>(s)) {
            begin_statement(s, offset(begin_of(loop->getBody())), depth);
            write("do {", depth);
            block(loop->getBody(), depth + 1);
            write("} while (" + full_expression(loop->getCond()).text + ");", depth);
            return finish(s);
        }
        if (const auto* chosen = dyn_cast<SwitchStmt>(s)) {
            return switch_statement(chosen, depth);
        }
        if (const auto* back = dyn_cast<ReturnStmt>(s)) {
            begin_statement(s, offset(end_of(s)), depth);
            const Expr* value = back->getRetValue();
            write(value == nullptr ? "return;" : "return " + full_expression(value).text + ";",
                  depth);
            return finish(s);
        }
        if (isa<BreakStmt>(s) || isa<ContinueStmt>(s)) {
            begin_statement(s, offset(end_of(s)), depth);
            write(isa<BreakStmt>(s) ? "break;" : "continue;", depth);
            return finish(s);
        }
        if (const auto* e = dyn_cast<Expr>(s)) {
            // (void)x, and what assert leaves behind
            if (const auto* cast = dyn_cast<CastExpr>(e->IgnoreParens());
                cast != nullptr && cast->getCastKind() == CK_ToVoid) {
                skip_comments(offset(end_of(s)));
                out_.last_line = line(end_of(s));
                return;
            }
            begin_statement(s, offset(end_of(s)), depth);
            write(effect_list(e) + ";", depth);
            return finish(s);
        }
        if (isa<CXXForRangeStmt>(s)) {
            refuse(s->getBeginLoc(), "a range-based for cannot be shared: count with an int");
        } else if (isa<CXXTryStmt>(s) || isa<CXXCatchStmt>(s)) {
            refuse(s->getBeginLoc(), "exceptions cannot be shared");
        } else if (isa<GotoStmt>(s) || isa<LabelStmt>(s)) {
            refuse(s->getBeginLoc(), "goto and labels cannot be shared");
        } else {
            refuse(s->getBeginLoc(),
                   std::string("this statement cannot be shared (") + s->getStmtClassName() + ")");
        }
    }

    // An expression as a statement: an effect, or several joined by commas in a for.
    std::string effect_list(const Expr* e) {
        e = e->IgnoreParens();
        if (const auto* cleanups = dyn_cast<ExprWithCleanups>(e)) {
            return effect_list(cleanups->getSubExpr());
        }
        if (const auto* binary = dyn_cast<BinaryOperator>(e);
            binary != nullptr && binary->getOpcode() == BO_Comma) {
            return effect_list(binary->getLHS()) + ", " + effect_list(binary->getRHS());
        }
        return full_expression(e, true).text;
    }

    std::string initialiser(const VarDecl* variable) {
        const Expr* init = variable->getInit();
        if (init == nullptr) {
            return "";
        }
        const Expr* inner = init->IgnoreImplicit();
        if (const auto* made = dyn_cast<CXXConstructExpr>(inner);
            made != nullptr && made->getNumArgs() == 0 && !made->requiresZeroInitialization() &&
            !isa<CXXTemporaryObjectExpr>(made) && !made->isListInitialization()) {
            // default initialisation: values only where members have them
            return has_member_values(variable->getType())
                       ? " = " + default_value(variable->getType(), variable->getLocation())
                       : "";
        }
        return " = " + full_expression(init).text;
    }

    void check_local(const VarDecl* variable, const glsl_type& type) {
        if (variable->getType()->isReferenceType()) {
            refuse(variable->getLocation(),
                   "a local reference cannot be shared: name the value, or write the expression");
        }
        if (type.opaque) {
            refuse(variable->getLocation(), "a device object cannot be a local variable");
        }
        if (variable->isStaticLocal() && !variable->isConstexpr()) {
            refuse(variable->getLocation(), "a static variable cannot be shared");
        }
        if (isa<DecompositionDecl>(variable)) {
            refuse(variable->getLocation(), "structured bindings cannot be shared");
        }
    }

    std::string for_declaration(const DeclStmt* init) {
        std::string text;
        std::string base;
        for (const Decl* each : init->decls()) {
            const auto* variable = dyn_cast<VarDecl>(each);
            if (variable == nullptr) {
                refuse(init->getBeginLoc(), "this declaration cannot be shared");
                return text;
            }
            const glsl_type type = type_of(variable->getType(), variable->getLocation());
            check_local(variable, type);
            const std::string name = local_name(variable);
            if (text.empty()) {
                base = type.base;
                text = type.declare(name) + initialiser(variable);
            } else {
                text += ", " + name + initialiser(variable);
            }
        }
        return text;
    }

    void declaration_statement(const DeclStmt* s, int depth) {
        bool any = false;
        for (const Decl* each : s->decls()) {
            any = any || isa<VarDecl>(each);
        }
        if (!any) {
            for (const Decl* each : s->decls()) {
                if (isa<TagDecl>(each)) {
                    refuse(each->getLocation(), "a type inside a function cannot be shared");
                } else if (!isa<TypedefNameDecl>(each) && !isa<StaticAssertDecl>(each) &&
                           !isa<UsingDecl>(each) && !isa<UsingDirectiveDecl>(each) &&
                           !isa<EmptyDecl>(each)) {
                    refuse(each->getLocation(), "this declaration cannot be shared");
                }
            }
            // aliases and static assertions leave nothing, nor do the comments on them
            drop_comments_above(s);
            skip_comments(offset(end_of(s)));
            if (out_.next_comment < out_.comments->size() &&
                (*out_.comments)[out_.next_comment].line == line(end_of(s)) &&
                !(*out_.comments)[out_.next_comment].own_line) {
                ++out_.next_comment;
            }
            out_.last_line = line(end_of(s));
            return;
        }
        begin_statement(s, offset(end_of(s)), depth);
        std::string open; // a declaration that the next variable may join
        std::string open_type;
        const auto close = [&] {
            if (!open.empty()) {
                write(open + ";", depth);
                open.clear();
            }
        };
        for (const Decl* each : s->decls()) {
            const auto* variable = dyn_cast<VarDecl>(each);
            if (variable == nullptr) {
                refuse(each->getLocation(), "this declaration cannot be shared");
                continue;
            }
            const glsl_type type = type_of(variable->getType(), variable->getLocation());
            check_local(variable, type);
            const std::string init = initialiser(variable);
            const std::string name = local_name(variable);
            const std::string qualifier = variable->isConstexpr() ? "const " : "";
            if (!open.empty() && type.array == 0 && open_type == qualifier + type.base) {
                open += ", " + name + init;
            } else {
                close();
                open = qualifier + type.declare(name) + init;
                open_type = type.array == 0 ? qualifier + type.base : "";
            }
        }
        close();
        finish(s);
    }

    void drop_comments_above(const Stmt* s) {
        // the run of comment lines that touches the statement
        const unsigned begin = offset(begin_of(s));
        std::size_t end = first_comment_after(begin);
        std::size_t first = end;
        unsigned expected = line(begin_of(s));
        while (first > out_.next_comment && (*out_.comments)[first - 1].own_line &&
               (*out_.comments)[first - 1].last_line + 1 == expected) {
            --first;
            expected = (*out_.comments)[first].line;
        }
        if (first < end) {
            flush_comments((*out_.comments)[first].begin, 1);
            out_.next_comment = end;
        }
    }

    void if_statement(const IfStmt* s, int depth, bool after_else = false) {
        if (s->isConstexpr()) {
            return constexpr_if(s, depth);
        }
        if (s->getInit() != nullptr || s->getConditionVariable() != nullptr) {
            refuse(s->getBeginLoc(), "a declaration in a condition cannot be shared");
        }
        if (!after_else) {
            begin_statement(s, offset(begin_of(s->getThen())), depth);
        } else {
            skip_comments(offset(begin_of(s->getThen())));
        }
        const std::string head = "if (" + full_expression(s->getCond()).text + ") {";
        if (after_else) {
            append_wrapped(out_.lines, indent(depth) + "} else " + head);
            out_.at_block_start = false;
        } else {
            write(head, depth);
        }
        block(s->getThen(), depth + 1);
        const Stmt* otherwise = s->getElse();
        if (otherwise != nullptr) {
            flush_comments(offset(begin_of(otherwise)), depth + 1);
            const auto* chained = dyn_cast<IfStmt>(otherwise);
            if (chained != nullptr && !chained->isConstexpr()) {
                return if_statement(chained, depth, true);
            }
            write("} else {", depth);
            block(otherwise, depth + 1);
        }
        write("}", depth);
        finish(s);
    }

    // The branch that was taken at compile time, as if it stood there alone.
    void constexpr_if(const IfStmt* s, int depth) {
        flush_comments(offset(begin_of(s)), depth);
        const auto taken = s->getNondiscardedCase(context_);
        if (!taken) {
            refuse(s->getBeginLoc(), "the condition of this if constexpr is not known");
            return;
        }
        const Stmt* branch = *taken;
        if (branch == nullptr) {
            leave_constexpr_if(s);
            return;
        }
        skip_comments(offset(begin_of(branch)));
        const auto* compound = dyn_cast<CompoundStmt>(branch);
        const bool declares = compound != nullptr && declares_known_name(compound);
        const unsigned saved_line = out_.last_line;
        if (const auto* chained = dyn_cast<IfStmt>(branch);
            chained != nullptr && chained->isConstexpr()) {
            constexpr_if(chained, depth);
        } else if (declares) {
            // its own scope, lest a name is declared twice
            write("{", depth);
            block(branch, depth + 1);
            write("}", depth);
        } else if (compound != nullptr) {
            const bool start = out_.at_block_start;
            skip_comments(offset(begin_of(branch)));
            bool first = true;
            for (const Stmt* each : compound->body()) {
                if (first) {
                    // a blank line only if there was one before the if
                    const bool gap = !start && line(begin_of(s)) > saved_line + 1;
                    out_.at_block_start = start;
                    out_.last_line = gap ? 0 : first_line_with_comments(each);
                    if (gap && !out_.lines.empty() && !out_.lines.back().empty()) {
                        out_.lines.emplace_back();
                        out_.at_block_start = true;
                    }
                    first = false;
                }
                statement(each, depth);
            }
            flush_comments(offset(sources_.getExpansionLoc(compound->getRBracLoc())), depth);
        } else {
            statement(branch, depth);
        }
        leave_constexpr_if(s);
    }

    // Whether a block declares a name that the function declares elsewhere as well.
    bool declares_known_name(const CompoundStmt* s) {
        std::map<std::string, int> counts;
        std::function<void(const Stmt*)> count = [&](const Stmt* each) {
            if (each == nullptr) {
                return;
            }
            if (const auto* declaration = dyn_cast<DeclStmt>(each)) {
                for (const Decl* d : declaration->decls()) {
                    if (const auto* variable = dyn_cast<VarDecl>(d)) {
                        ++counts[variable->getName().str()];
                    }
                }
            }
            for (const Stmt* child : each->children()) {
                count(child);
            }
        };
        count(frames_.back().function->getBody());
        for (const Stmt* each : s->body()) {
            const auto* declaration = dyn_cast<DeclStmt>(each);
            if (declaration == nullptr) {
                continue;
            }
            for (const Decl* d : declaration->decls()) {
                const auto* variable = dyn_cast<VarDecl>(d);
                if (variable != nullptr && counts[variable->getName().str()] > 1) {
                    return true;
                }
            }
        }
        return false;
    }

    // The syntax tree has lost the branches that were not taken: their comments are passed over by
    // the tokens.
    void leave_constexpr_if(const IfStmt* s) {
        const SourceLocation begin = begin_of(s);
        const FileID file = sources_.getFileID(begin);
        const StringRef buffer = sources_.getBufferData(file);
        Lexer lexer(sources_.getLocForStartOfFile(file), context_.getLangOpts(), buffer.begin(),
                    buffer.data() + offset(begin), buffer.end());
        Token token;
        unsigned end = offset(begin);
        const auto next = [&] {
            lexer.LexFromRawLexer(token);
            return !token.is(tok::eof);
        };
        const auto is_word = [&](StringRef word) {
            return token.is(tok::raw_identifier) && token.getRawIdentifier() == word;
        };
        const auto skip_brackets = [&](tok::TokenKind open, tok::TokenKind close) {
            int depth = 0;
            do {
                depth += token.is(open) ? 1 : token.is(close) ? -1 : 0;
                end = offset(token.getLocation()) + token.getLength();
            } while (depth > 0 && next());
        };
        bool more = next();
        while (more) {
            // `if constexpr (…)`, or the statement after else
            if (is_word("if")) {
                while (next() && token.isNot(tok::l_paren)) {
                }
                skip_brackets(tok::l_paren, tok::r_paren);
                more = next();
            }
            if (token.is(tok::l_brace)) {
                skip_brackets(tok::l_brace, tok::r_brace);
            } else {
                while (token.isNot(tok::semi) && next()) {
                }
                end = offset(token.getLocation()) + token.getLength();
            }
            more = next() && is_word("else") && next();
        }
        skip_comments(end);
        out_.last_line =
            line(sources_.getLocForStartOfFile(file).getLocWithOffset(static_cast<int>(end)));
    }

    unsigned first_line_with_comments(const Stmt* s) {
        unsigned first = line(begin_of(s));
        if (out_.next_comment < out_.comments->size()) {
            const comment& each = (*out_.comments)[out_.next_comment];
            if (each.begin < offset(begin_of(s))) {
                first = std::min(first, each.line);
            }
        }
        return first;
    }

    void switch_statement(const SwitchStmt* s, int depth) {
        const auto* body = dyn_cast<CompoundStmt>(s->getBody());
        if (s->getInit() != nullptr || s->getConditionVariable() != nullptr || body == nullptr) {
            refuse(s->getBeginLoc(), "this form of switch cannot be shared");
            return;
        }
        begin_statement(s, offset(begin_of(body)), depth);
        write("switch (" + full_expression(s->getCond()).text + ") {", depth);
        out_.at_block_start = true;
        trailing_comment(line(begin_of(body)));
        bool ends_with_label = false;
        for (const Stmt* each : body->body()) {
            while (const auto* label = dyn_cast<SwitchCase>(each)) {
                flush_comments(offset(begin_of(label)), depth);
                blank_line_before(line(begin_of(label)));
                if (const auto* value = dyn_cast<CaseStmt>(label)) {
                    if (value->getRHS() != nullptr) {
                        refuse(value->getBeginLoc(), "a range of cases cannot be shared");
                    }
                    write("case " + expression(value->getLHS()).text + ":", depth);
                } else {
                    write("default:", depth);
                }
                out_.last_line = line(sources_.getExpansionLoc(label->getColonLoc()));
                trailing_comment(out_.last_line);
                each = label->getSubStmt();
                ends_with_label = isa<NullStmt>(each);
            }
            if (const auto* inner = dyn_cast<CompoundStmt>(each)) {
                out_.lines.back() += " {";
                block(inner, depth + 1);
                write("}", depth);
                finish(inner);
                ends_with_label = false;
            } else if (!isa<NullStmt>(each)) {
                statement(each, depth + 1);
                ends_with_label = false;
            }
        }
        if (ends_with_label) {
            write("break;", depth + 1); // GLSL wants a statement after the last label
        }
        flush_comments(offset(sources_.getExpansionLoc(body->getRBracLoc())), depth + 1);
        write("}", depth);
        finish(s);
    }

    // Side effects -------------------------------------------------------------------------------

    access access_of(const Expr* e) {
        e = e->IgnoreParenImpCasts();
        if (const auto* reference = dyn_cast<DeclRefExpr>(e)) {
            return {reference->getDecl(), false, {}};
        }
        if (isa<CXXThisExpr>(e)) {
            return {nullptr, true, {}};
        }
        if (const auto* op = dyn_cast<UnaryOperator>(e);
            op != nullptr && op->getOpcode() == UO_Deref) {
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
            path.steps.push_back(index->EvaluateAsInt(value, context_)
                                     ? "[" + decimal(value.Val.getInt()) + "]"
                                     : "[]");
            return path;
        }
        return {};
    }

    // .x, .r, .s and [0] of a vector are one component.
    std::string component(const std::string& name, const Expr* base) {
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

    static bool overlap(const access& a, const access& b) {
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

    bool is_assignment(const Expr* e) {
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

    // Lvalues that a call writes to.
    std::vector<access> written_by(const CallExpr* call) {
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

    void collect(const Stmt* s, std::vector<const Expr*>& effects,
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

    code full_expression(const Expr* e, bool is_statement = false) {
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

    void check_aliasing(const CallExpr* call) {
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

    // Expressions --------------------------------------------------------------------------------

    std::string spelling(SourceLocation where) {
        SmallVector<char, 32> buffer;
        return Lexer::getSpelling(sources_.getSpellingLoc(where), buffer, sources_,
                                  context_.getLangOpts())
            .str();
    }

    std::string float_spelling(const FloatingLiteral* literal) {
        std::string text = spelling(literal->getLocation());
        text.erase(std::remove(text.begin(), text.end(), '\''), text.end());
        while (!text.empty() &&
               std::string_view("fFlL").find(text.back()) != std::string_view::npos &&
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

    std::string integer_spelling(const IntegerLiteral* literal, char kind) {
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

    // A literal, perhaps negative, written as a literal of another type.
    std::optional<code> literal_as(const Expr* e, char kind) {
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

    std::optional<code> constant_value(const Expr* e, SourceLocation where) {
        Expr::EvalResult value;
        if (e->isValueDependent() || !e->EvaluateAsRValue(value, context_) ||
            value.HasSideEffects || !(value.Val.isInt() || value.Val.isFloat())) {
            return std::nullopt;
        }
        const std::string text = value_text(value.Val, e->getType(), where);
        return code{text, text.front() == '-' ? unary : primary};
    }

    code convert(const Expr* from, QualType to_type, SourceLocation where) {
        const char to = scalar(to_type);
        char source = scalar(from->getType());
        if (const auto literal = literal_as(from, to)) {
            return *literal;
        }
        if (source == to && to != 'd' && to != 'l') {
            return expression(from);
        }
        if (to == 'd') {
            refuse(where,
                   "arithmetic in double cannot be shared: write T(...) around the constants");
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

    // What a value of 64 bits was converted from, where it was an int or uint.
    const Expr* without_wide_casts(const Expr* e) {
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

    code index(const Expr* e) {
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

    std::string zero_value(QualType type, SourceLocation where) {
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

    bool has_member_values(QualType type) {
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

    // The value of an object without initialiser: members' own values, zero for the rest.
    std::string default_value(QualType type, SourceLocation where) {
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

    code expression(const Expr* e) {
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

    code cast(const CastExpr* e) {
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

    code reference(const DeclRefExpr* e) {
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
            return {(found != known_.end() ? entities_[found->second].name : std::string("ws_")) +
                    "_" + constant->getName().str()};
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

    code member(const MemberExpr* e) {
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

    code subscript(const Expr* base, const Expr* at) {
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

    code unary_operator(const UnaryOperator* e) {
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

    static std::optional<int> level_of(BinaryOperatorKind kind) {
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

    static code infix(const code& left, const std::string& op, const code& right, int level) {
        return {at_least(left, level) + " " + op + " " + at_least(right, level + 1), level};
    }

    // Two operands of one spelling are one value but for NaN.
    void check_nan_test(const Expr* left, const Expr* right, SourceLocation where) {
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

    // Whether an int is surely not negative, from what this function does with it alone.
    bool is_non_negative(const Expr* e, std::set<const VarDecl*>& assumed) {
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
                return is_non_negative(op->getLHS(), assumed) &&
                       is_non_negative(op->getRHS(), assumed);
            case BO_And:
                return is_non_negative(op->getLHS(), assumed) ||
                       is_non_negative(op->getRHS(), assumed);
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

    // Whether no statement can make the variable negative.
    bool stays_non_negative(const Stmt* s, const VarDecl* variable,
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

    void check_division(const Expr* left, const Expr* right, bool remainder, SourceLocation where) {
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

    code binary_operator(const BinaryOperator* e) {
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
            if (kind_of_left != scalar(compound->getComputationResultType()) ||
                kind_of_left == 'b') {
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

    // The bool that C++ made an int to compare it.
    const Expr* promoted_bool(const Expr* e) {
        const auto* cast_to = dyn_cast<ImplicitCastExpr>(e);
        return cast_to != nullptr && scalar(cast_to->getSubExpr()->getType()) == 'b'
                   ? cast_to->getSubExpr()
                   : nullptr;
    }

    // Whether an operator on an enumeration is the bit operation that it looks like.
    bool is_bit_operator(const FunctionDecl* function) {
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
                return op != nullptr && op->getOpcode() == UO_Not &&
                       is_parameter(op->getSubExpr(), 0);
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

    code operator_call(const CXXOperatorCallExpr* e) {
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

    code glm_operator(const CXXOperatorCallExpr* e, OverloadedOperatorKind kind,
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

    code method_call(const CXXMemberCallExpr* e) {
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
            if (as_array(type) && method->getIdentifier() != nullptr &&
                method->getName() == "size") {
                return {std::to_string(as_array(type)->size)};
            }
            refuse(e->getExprLoc(), "a call of " + method->getQualifiedNameAsString() +
                                        " has no counterpart in GLSL");
            return {"0"};
        }
        if (auto snippet = annotation(method, "glsl:")) {
            std::vector<const Expr*> arguments{object};
            arguments.insert(arguments.end(), e->arg_begin(), e->arg_end());
            return expand(*snippet, arguments, e->getExprLoc());
        }
        if (const auto* from = dyn_cast<MemberExpr>(e->getCallee()->IgnoreParens());
            from != nullptr && from->isArrow() &&
            !isa<CXXThisExpr>(object->IgnoreParenImpCasts())) {
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

    // A snippet with $0, $1 … replaced; what is not delimited is bracketed.
    code expand(const std::string& snippet, const std::vector<const Expr*>& arguments,
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

    code call(const CallExpr* e) {
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

    code library_call(const CallExpr* e, const FunctionDecl* callee, bool of_glm) {
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

    code construct(const CXXConstructExpr* e) {
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

    code init_list(const InitListExpr* e) {
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
                } else if (e->hasArrayFiller() &&
                           !isa<ImplicitValueInitExpr>(e->getArrayFiller())) {
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

    // Roots and order ----------------------------------------------------------------------------

    void add_root(const Decl* declaration, SourceLocation where);
    bool order(translation& result);
    void check_signatures();
};

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

void translator::add_root(const Decl* declaration, SourceLocation where) {
    if (const auto* function = dyn_cast<FunctionDecl>(declaration)) {
        if (annotation(function, "glsl:")) {
            return;
        }
        require_function(function, where);
    } else if (const auto* record = dyn_cast<CXXRecordDecl>(declaration)) {
        if (annotation(record, "glsl_type:")) {
            return;
        }
        frames_.push_back({record->getQualifiedNameAsString(), where, {}, nullptr, {}, {}});
        require_structure(record, where);
        frames_.pop_back();
        if (record->getDefinition() == nullptr) {
            return;
        }
        for (const CXXMethodDecl* method : record->getDefinition()->methods()) {
            const FunctionDecl* definition = nullptr;
            if (method->isImplicit() || method->isDefaulted() || method->isDeleted() ||
                isa<CXXConstructorDecl>(method) || isa<CXXDestructorDecl>(method) ||
                method->getAccess() == AS_private || !method->hasBody(definition)) {
                continue;
            }
            require_function(method, where);
        }
    } else if (const auto* enumeration = dyn_cast<EnumDecl>(declaration)) {
        frames_.push_back({enumeration->getQualifiedNameAsString(), where, {}, nullptr, {}, {}});
        require_enumeration(enumeration, where);
        frames_.pop_back();
    } else if (const auto* variable = dyn_cast<VarDecl>(declaration)) {
        frames_.push_back({variable->getQualifiedNameAsString(), where, {}, nullptr, {}, {}});
        require_constant(variable, where);
        frames_.pop_back();
    }
}

bool translator::run(translation& result) {
    const FileID main = sources_.getMainFileID();
    struct root {
        unsigned at;
        const Decl* declaration;
        SourceLocation where;
    };
    std::vector<root> roots;
    const auto add = [&](const Decl* declaration, SourceLocation where) {
        where = sources_.getExpansionLoc(where);
        if (sources_.getFileID(where) == main) {
            roots.push_back({offset(where), declaration, where});
        }
    };
    std::function<void(const DeclContext*)> walk = [&](const DeclContext* context) {
        for (const Decl* each : context->decls()) {
            if (const auto* space = dyn_cast<NamespaceDecl>(each)) {
                if (!space->isStdNamespace() && space->getName() != "glm") {
                    walk(space);
                }
            } else if (const auto* linkage = dyn_cast<LinkageSpecDecl>(each)) {
                static_cast<void>(linkage);
            } else if (const auto* function = dyn_cast<FunctionTemplateDecl>(each)) {
                for (const FunctionDecl* special : function->specializations()) {
                    if (special->getTemplateSpecializationKind() ==
                        TSK_ExplicitInstantiationDefinition) {
                        add(special, special->getPointOfInstantiation());
                    }
                }
            } else if (const auto* record = dyn_cast<ClassTemplateDecl>(each)) {
                for (const ClassTemplateSpecializationDecl* special : record->specializations()) {
                    if (special->getSpecializationKind() == TSK_ExplicitInstantiationDefinition) {
                        add(special, special->getPointOfInstantiation());
                    }
                }
            } else if (const auto* variable = dyn_cast<VarTemplateDecl>(each)) {
                for (const VarTemplateSpecializationDecl* special : variable->specializations()) {
                    if (special->getSpecializationKind() == TSK_ExplicitInstantiationDefinition) {
                        add(special, special->getPointOfInstantiation());
                    }
                }
            } else if (const auto* use = dyn_cast<UsingDecl>(each)) {
                for (const UsingShadowDecl* shadow : use->shadows()) {
                    add(shadow->getTargetDecl(), use->getLocation());
                }
            } else if (isa<ClassTemplateSpecializationDecl>(each) ||
                       isa<VarTemplateSpecializationDecl>(each)) {
                // found through their templates
            } else if (isa<CXXRecordDecl>(each)) {
                const auto* definition = clang::cast<CXXRecordDecl>(each);
                if (definition->isThisDeclarationADefinition() && !definition->isImplicit()) {
                    add(definition, definition->getLocation());
                }
            } else if (isa<FunctionDecl>(each)) {
                const auto* definition = clang::cast<FunctionDecl>(each);
                if (definition->isThisDeclarationADefinition() && !definition->isDeleted() &&
                    !definition->isTemplateInstantiation() &&
                    !(definition->isOverloadedOperator() && is_bit_operator(definition))) {
                    add(definition, definition->getLocation());
                }
            } else if (const auto* enumeration = dyn_cast<EnumDecl>(each)) {
                add(enumeration, enumeration->getLocation());
            } else if (const auto* constant = dyn_cast<VarDecl>(each)) {
                if (constant->isConstexpr()) {
                    add(constant, constant->getLocation());
                }
            }
        }
    };
    walk(context_.getTranslationUnitDecl());
    std::stable_sort(roots.begin(), roots.end(),
                     [](const root& a, const root& b) { return a.at < b.at; });
    if (roots.empty()) {
        DiagnosticsEngine& engine = context_.getDiagnostics();
        engine.Report(sources_.getLocForStartOfFile(main),
                      engine.getCustomDiagID(DiagnosticsEngine::Error, "%0"))
            << "nothing is shared here: no explicit instantiation, definition or "
               "using-declaration";
        return false;
    }
    for (const root& each : roots) {
        if (const auto* templated = dyn_cast<FunctionTemplateDecl>(each.declaration)) {
            refuse(each.where, "'" + templated->getName().str() +
                                   "' is a template: name it by an explicit instantiation");
        } else if (const auto* class_template = dyn_cast<ClassTemplateDecl>(each.declaration)) {
            refuse(each.where, "'" + class_template->getName().str() +
                                   "' is a template: name it by an explicit instantiation");
        } else {
            add_root(each.declaration, each.where);
        }
    }
    if (!failed_) {
        check_signatures();
    }
    return !failed_ && order(result);
}

// Two functions of one name must differ in their parameters, or GLSL takes them for one.
void translator::check_signatures() {
    std::map<std::string, const entity*> seen;
    for (const entity& each : entities_) {
        std::string key = each.name;
        if (each.kind == entity_kind::function) {
            key += "(";
            for (const variable& parameter : each.variables) {
                key += parameter.type + "[" + std::to_string(parameter.array) + "],";
            }
        }
        const auto [found, is_new] = seen.emplace(key, &each);
        if (!is_new) {
            DiagnosticsEngine& engine = context_.getDiagnostics();
            engine.Report(engine.getCustomDiagID(DiagnosticsEngine::Error, "%0"))
                << "'" + found->second->cpp_name + "' and '" + each.cpp_name +
                       "' would both become '" + key + "' in GLSL";
            failed_ = true;
        }
    }
}

bool translator::order(translation& result) {
    // topics in the order in which they need each other, then as they stand in their headers
    std::map<std::string, std::set<std::string>> needs;
    std::vector<std::string> names;
    for (const entity& each : entities_) {
        if (std::find(names.begin(), names.end(), each.topic) == names.end()) {
            names.push_back(each.topic);
        }
        for (const std::size_t used : each.dependencies) {
            if (entities_[used].topic != each.topic) {
                needs[each.topic].insert(entities_[used].topic);
            }
        }
    }
    std::sort(names.begin(), names.end());
    std::vector<std::string> topics;
    std::set<std::string> open;
    std::set<std::string> done;
    bool cyclic = false;
    std::function<void(const std::string&)> visit_topic = [&](const std::string& topic) {
        if (done.count(topic) != 0) {
            return;
        }
        if (!open.insert(topic).second) {
            cyclic = true;
            return;
        }
        for (const std::string& each : needs[topic]) {
            visit_topic(each);
        }
        open.erase(topic);
        done.insert(topic);
        topics.push_back(topic);
    };
    for (const std::string& each : names) {
        visit_topic(each);
    }
    if (cyclic) {
        DiagnosticsEngine& engine = context_.getDiagnostics();
        engine.Report(engine.getCustomDiagID(DiagnosticsEngine::Error, "%0"))
            << "two headers need shared functions of each other";
        return false;
    }
    std::map<std::string, std::size_t> rank;
    for (std::size_t i = 0; i < topics.size(); ++i) {
        rank[topics[i]] = i;
    }
    std::vector<std::size_t> indices(entities_.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        indices[i] = i;
    }
    std::stable_sort(indices.begin(), indices.end(), [&](std::size_t a, std::size_t b) {
        const auto key = [&](std::size_t i) {
            return std::pair(rank[entities_[i].topic], entities_[i].offset);
        };
        return key(a) < key(b);
    });
    std::vector<std::size_t> place(entities_.size());
    std::vector<bool> placed(entities_.size(), false);
    std::vector<entity> ordered;
    std::function<void(std::size_t)> visit = [&](std::size_t i) {
        if (placed[i]) {
            return;
        }
        placed[i] = true;
        std::vector<std::size_t> used = entities_[i].dependencies;
        std::sort(used.begin(), used.end(), [&](std::size_t a, std::size_t b) {
            return std::pair(rank[entities_[a].topic], entities_[a].offset) <
                   std::pair(rank[entities_[b].topic], entities_[b].offset);
        });
        for (const std::size_t each : used) {
            visit(each);
        }
        place[i] = ordered.size();
        ordered.push_back(entities_[i]);
    };
    for (const std::size_t i : indices) {
        visit(i);
    }
    for (entity& each : ordered) {
        for (std::size_t& used : each.dependencies) {
            used = place[used];
        }
        std::sort(each.dependencies.begin(), each.dependencies.end());
    }
    result.entities = std::move(ordered);
    result.topics = std::move(topics);
    return true;
}

class consumer : public ASTConsumer {
  public:
    consumer(const translation_options& options, translation& result, bool& good)
        : options_(options), result_(result), good_(good) {}

    void HandleTranslationUnit(ASTContext& context) override {
        if (context.getDiagnostics().hasErrorOccurred()) {
            return;
        }
        translator work(context, options_);
        translation made;
        if (!work.run(made)) {
            return;
        }
        SourceManager& sources = context.getSourceManager();
        std::set<std::string> inputs;
        for (auto each = sources.fileinfo_begin(); each != sources.fileinfo_end(); ++each) {
            const auto file = each->first;
            const FileID id = sources.translateFile(file);
            if (id.isInvalid() || sources.isInSystemHeader(sources.getLocForStartOfFile(id))) {
                continue;
            }
            inputs.insert(sources.getFilename(sources.getLocForStartOfFile(id)).str());
        }
        made.inputs.assign(inputs.begin(), inputs.end());
        result_ = std::move(made);
        good_ = true;
    }

  private:
    const translation_options& options_;
    translation& result_;
    bool& good_;
};

class action : public ASTFrontendAction {
  public:
    action(const translation_options& options, translation& result, bool& good)
        : options_(options), result_(result), good_(good) {}

    std::unique_ptr<ASTConsumer> CreateASTConsumer(CompilerInstance&, StringRef) override {
        return std::make_unique<consumer>(options_, result_, good_);
    }

  private:
    const translation_options& options_;
    translation& result_;
    bool& good_;
};

} // namespace

bool translate(const translation_options& options, translation& result) {
    bool good = false;
    std::vector<std::string> command{"warpshadow-glslgen",
                                     "-fsyntax-only",
                                     "-x",
                                     "c++",
                                     "-std=c++20",
                                     "-DNDEBUG",
                                     "-DWARPSHADOW_GLSLGEN",
                                     "-Wno-unused",
                                     "-Wno-parentheses",
                                     "-Wno-unsequenced",
                                     "-ferror-limit=100",
                                     "-Wno-pragma-once-outside-header"};
    if (!options.resource_folder.empty()) {
        command.push_back("-resource-dir=" + options.resource_folder);
    }
    command.insert(command.end(), options.flags.begin(), options.flags.end());
    command.push_back(options.source);
    llvm::IntrusiveRefCntPtr<FileManager> files(new FileManager(FileSystemOptions()));
    tooling::ToolInvocation invocation(command, std::make_unique<action>(options, result, good),
                                       files.get());
    const bool ran = invocation.run();
    return ran && good;
}

} // namespace glslgen
