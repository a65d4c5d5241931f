// Statements, with their comments and blank lines.
#include "translator_class.hpp"

namespace glslgen {

std::string translator::indent(int depth) {
    return std::string(static_cast<std::size_t>(depth) * 4, ' ');
}

std::size_t translator::first_comment_after(unsigned at) {
    const auto found =
        std::lower_bound(out_.comments->begin(), out_.comments->end(), at,
                         [](const comment& c, unsigned where) { return c.begin < where; });
    return static_cast<std::size_t>(found - out_.comments->begin());
}

void translator::blank_line_before(unsigned source_line) {
    if (!out_.at_block_start && source_line > out_.last_line + 1 && !out_.lines.empty() &&
        !out_.lines.back().empty()) {
        out_.lines.emplace_back();
    }
}

void translator::flush_comments(unsigned at, int depth) {
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

void translator::skip_comments(unsigned until) {
    while (out_.next_comment < out_.comments->size() &&
           (*out_.comments)[out_.next_comment].begin < until) {
        ++out_.next_comment;
    }
}

void translator::trailing_comment(unsigned source_line) {
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

void translator::write(const std::string& text, int depth) {
    append_wrapped(out_.lines, indent(depth) + text);
    out_.at_block_start = false;
}

void translator::begin_statement(const Stmt* s, unsigned comments_until, int depth) {
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

void translator::block(const Stmt* s, int depth) {
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

void translator::statement(const Stmt* s, int depth) {
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
        write(value == nullptr ? "return;" : "return " + full_expression(value).text + ";", depth);
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

std::string translator::effect_list(const Expr* e) {
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

std::string translator::initialiser(const VarDecl* variable) {
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

void translator::check_local(const VarDecl* variable, const glsl_type& type) {
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

std::string translator::for_declaration(const DeclStmt* init) {
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

void translator::declaration_statement(const DeclStmt* s, int depth) {
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

void translator::drop_comments_above(const Stmt* s) {
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

void translator::if_statement(const IfStmt* s, int depth, bool after_else) {
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

void translator::constexpr_if(const IfStmt* s, int depth) {
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

bool translator::declares_known_name(const CompoundStmt* s) {
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

void translator::leave_constexpr_if(const IfStmt* s) {
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

unsigned translator::first_line_with_comments(const Stmt* s) {
    unsigned first = line(begin_of(s));
    if (out_.next_comment < out_.comments->size()) {
        const comment& each = (*out_.comments)[out_.next_comment];
        if (each.begin < offset(begin_of(s))) {
            first = std::min(first, each.line);
        }
    }
    return first;
}

void translator::switch_statement(const SwitchStmt* s, int depth) {
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

} // namespace glslgen
