// The translator's class. Each construct is either known here, with the same meaning in C++ and
// GLSL, or refused by a diagnostic at the place where it stands: nothing is guessed.
#pragma once

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

inline std::string at_least(const code& part, int level) {
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

inline std::string squeeze(std::string name) {
    std::size_t at = 0;
    while ((at = name.find("__", at)) != std::string::npos) {
        name.erase(at, 1);
    }
    return name;
}

inline bool in_namespace(const Decl* decl, StringRef name) {
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

inline const FunctionDecl* pattern_of(const FunctionDecl* function) {
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
inline std::string decimal(const llvm::APSInt& value) {
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

    void refuse(SourceLocation where, const std::string& message);

    // Places and comments ------------------------------------------------------------------------

    SourceLocation begin_of(const Stmt* s) { return sources_.getExpansionLoc(s->getBeginLoc()); }
    SourceLocation end_of(const Stmt* s);
    unsigned offset(SourceLocation where) { return sources_.getFileOffset(where); }
    unsigned line(SourceLocation where) { return sources_.getExpansionLineNumber(where); }

    const std::vector<comment>& comments_of(FileID file);

    // A block comment as `//` lines; a line comment as it is.
    static std::vector<std::string> comment_lines(const std::string& text);

    // The doc comment directly above a declaration.
    std::vector<std::string> doc_lines(SourceLocation declaration);

    // The comment behind a member or an enumerator, with what it says on further lines.
    std::string comment_on(FileID file, SourceLocation end, unsigned& last_line);

    // Comments behind the code of neighbouring lines begin in one column.
    static void align_comments(std::vector<std::string>& lines);

    // A line of code and the comment on it, which goes above where there is no room.
    static void append_with_comment(std::vector<std::string>& lines, const std::string& text,
                                    const std::string& tail);

    static std::string joined(const std::vector<std::string>& lines);

    // `@param[out]` and `@param[in,out]` of a function's doc comment.
    std::optional<std::string> documented_direction(const FunctionDecl* function,
                                                    const std::string& parameter);

    // Where the text of a declaration begins, `template <…>` included.
    SourceLocation begin_of_declaration(const NamedDecl* declaration);

    SourceLocation end_of_declaration(const NamedDecl* declaration);

    std::string source_between(SourceLocation begin, SourceLocation end);

    // Types --------------------------------------------------------------------------------------

    // f float, i int, u uint, b bool, d double, l other integers, 0 not a scalar.
    char scalar(QualType type);

    static std::string scalar_name(char kind);

    std::optional<glm_type> as_glm(QualType type);

    struct array_type {
        QualType element;
        int size;
    };

    // A C array or a std::array.
    std::optional<array_type> as_array(QualType type);

    // The text of an annotation that begins with `key`, on a declaration or its template.
    std::optional<std::string> annotation(const Decl* declaration, StringRef key);

    glsl_type type_of(QualType type, SourceLocation where);

    // The C++ type with float written T, for the parity tests; empty where it has no plain form.
    std::string cpp_type(QualType type, const std::string& scalar_text);

    std::string template_arguments(const TemplateArgumentList& list,
                                   const std::string& scalar_text);

    // Names --------------------------------------------------------------------------------------

    // Names at namespace scope get a prefix and may be reserved words.
    void check_name(const std::string& name, SourceLocation where, bool has_prefix = false);

    // Name without the outermost namespace; further namespaces but `detail` become part of it.
    std::string global_name(const NamedDecl* declaration, const std::string& own);

    // Template arguments that tell specialisations of one struct apart: numbers and other structs.
    std::string name_suffix(const TemplateArgumentList& list);

    std::string topic_of(const NamedDecl* declaration);

    std::string local_name(const ValueDecl* declaration);

    // Entities -----------------------------------------------------------------------------------

    void depend(std::size_t index);

    entity new_entity(entity_kind kind, const NamedDecl* declaration);

    std::size_t keep(const Decl* declaration, entity made);

    std::string require_structure(const CXXRecordDecl* record, SourceLocation where);

    // Whether a comment on its own line belongs to the member that follows: no other member
    // between.
    bool is_last_run(FileID file, const comment& each, const FieldDecl* field);

    void require_enumeration(const EnumDecl* declaration, SourceLocation where);

    std::string require_constant(const VarDecl* variable, SourceLocation where);

    // Whether an initialiser consists of what GLSL accepts in constant expressions, as written.
    bool is_plain_constant(const Expr* e);

    static std::string integer_text(const llvm::APSInt& value, char kind);

    std::string float_text(const llvm::APFloat& value, SourceLocation where);

    std::string value_text(const APValue& value, QualType type, SourceLocation where);

    // Functions ----------------------------------------------------------------------------------

    static std::string operator_name(OverloadedOperatorKind kind, std::size_t arguments);

    std::string display_name(const FunctionDecl* function);

    std::string require_function(const FunctionDecl* function, SourceLocation where);

    entity translate_function(const FunctionDecl* function, const std::string& name);

    // A parameter that has another name in GLSL has it in the doc comment as well.
    static void rename_parameter(std::string& doc, const std::string& from, const std::string& to);

    // The declared type: an array parameter has decayed, and a pointer stays one.
    static QualType parameter_type(const ParmVarDecl* parameter);

    static assigned merge(const assigned& a, const assigned& b);

    std::size_t part_count(QualType type);

    void check_assigned(const Stmt* body, const ParmVarDecl* parameter);

    void require_assigned(const Stmt*, const ParmVarDecl* parameter, const assigned& state,
                          SourceLocation where);

    void flow(const Stmt* s, const ParmVarDecl* p, assigned& state);

    static bool contains_jump(const Stmt* s);

    void flow_expression(const Expr* e, const ParmVarDecl* p, assigned& state);

    // A member of a member: counted as its own part, and the member once all of those are there.
    void note_part(const access& path, const ParmVarDecl* p, assigned& state);

    static bool is_written(const ParmVarDecl* parameter);

    // Statements ---------------------------------------------------------------------------------

    static std::string indent(int depth);

    std::size_t first_comment_after(unsigned at);

    void blank_line_before(unsigned source_line);

    // Writes the comments that begin before `at`, each where it stood: on the line of what was
    // written last, or on lines of its own.
    void flush_comments(unsigned at, int depth);

    void skip_comments(unsigned until);

    // Comments after the end of a statement, on its line.
    void trailing_comment(unsigned source_line);

    void write(const std::string& text, int depth);

    void begin_statement(const Stmt* s, unsigned comments_until, int depth);

    // The statements of a block, without its braces.
    void block(const Stmt* s, int depth);

    void finish(const Stmt* s) { trailing_comment(line(end_of(s))); }

    void statement(const Stmt* s, int depth);

    // An expression as a statement: an effect, or several joined by commas in a for.
    std::string effect_list(const Expr* e);

    std::string initialiser(const VarDecl* variable);

    void check_local(const VarDecl* variable, const glsl_type& type);

    std::string for_declaration(const DeclStmt* init);

    void declaration_statement(const DeclStmt* s, int depth);

    void drop_comments_above(const Stmt* s);

    void if_statement(const IfStmt* s, int depth, bool after_else = false);

    // The branch that was taken at compile time, as if it stood there alone.
    void constexpr_if(const IfStmt* s, int depth);

    // Whether a block declares a name that the function declares elsewhere as well.
    bool declares_known_name(const CompoundStmt* s);

    // The syntax tree has lost the branches that were not taken: their comments are passed over by
    // the tokens.
    void leave_constexpr_if(const IfStmt* s);

    unsigned first_line_with_comments(const Stmt* s);

    void switch_statement(const SwitchStmt* s, int depth);

    // Side effects -------------------------------------------------------------------------------

    access access_of(const Expr* e);

    // .x, .r, .s and [0] of a vector are one component.
    std::string component(const std::string& name, const Expr* base);

    static bool overlap(const access& a, const access& b);

    bool is_assignment(const Expr* e);

    // Lvalues that a call writes to.
    std::vector<access> written_by(const CallExpr* call);

    void collect(const Stmt* s, std::vector<const Expr*>& effects,
                 std::multiset<const ValueDecl*>& mentioned);

    code full_expression(const Expr* e, bool is_statement = false);

    void check_aliasing(const CallExpr* call);

    // Expressions --------------------------------------------------------------------------------

    std::string spelling(SourceLocation where);

    std::string float_spelling(const FloatingLiteral* literal);

    std::string integer_spelling(const IntegerLiteral* literal, char kind);

    // A literal, perhaps negative, written as a literal of another type.
    std::optional<code> literal_as(const Expr* e, char kind);

    std::optional<code> constant_value(const Expr* e, SourceLocation where);

    code convert(const Expr* from, QualType to_type, SourceLocation where);

    // What a value of 64 bits was converted from, where it was an int or uint.
    const Expr* without_wide_casts(const Expr* e);

    code index(const Expr* e);

    std::string zero_value(QualType type, SourceLocation where);

    bool has_member_values(QualType type);

    // The value of an object without initialiser: members' own values, zero for the rest.
    std::string default_value(QualType type, SourceLocation where);

    code expression(const Expr* e);

    code cast(const CastExpr* e);

    code reference(const DeclRefExpr* e);

    code member(const MemberExpr* e);

    code subscript(const Expr* base, const Expr* at);

    code unary_operator(const UnaryOperator* e);

    static std::optional<int> level_of(BinaryOperatorKind kind);

    static code infix(const code& left, const std::string& op, const code& right, int level);

    // Two operands of one spelling are one value but for NaN.
    void check_nan_test(const Expr* left, const Expr* right, SourceLocation where);

    // Whether an int is surely not negative, from what this function does with it alone.
    bool is_non_negative(const Expr* e, std::set<const VarDecl*>& assumed);

    // Whether no statement can make the variable negative.
    bool stays_non_negative(const Stmt* s, const VarDecl* variable,
                            std::set<const VarDecl*>& assumed);

    void check_division(const Expr* left, const Expr* right, bool remainder, SourceLocation where);

    code binary_operator(const BinaryOperator* e);

    // The bool that C++ made an int to compare it.
    const Expr* promoted_bool(const Expr* e);

    // Whether an operator on an enumeration is the bit operation that it looks like.
    bool is_bit_operator(const FunctionDecl* function);

    code operator_call(const CXXOperatorCallExpr* e);

    code glm_operator(const CXXOperatorCallExpr* e, OverloadedOperatorKind kind,
                      const std::string& spelled);

    code method_call(const CXXMemberCallExpr* e);

    // A snippet with $0, $1 … replaced; what is not delimited is bracketed.
    code expand(const std::string& snippet, const std::vector<const Expr*>& arguments,
                SourceLocation where);

    code call(const CallExpr* e);

    code library_call(const CallExpr* e, const FunctionDecl* callee, bool of_glm);

    code construct(const CXXConstructExpr* e);

    code init_list(const InitListExpr* e);

    // Roots and order ----------------------------------------------------------------------------

    void add_root(const Decl* declaration, SourceLocation where);
    bool order(translation& result);
    void check_signatures();
};

} // namespace glslgen
