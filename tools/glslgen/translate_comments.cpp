// Diagnostics, places in the source, and the comments that are carried over.
#include "translator_class.hpp"

namespace glslgen {

void translator::refuse(SourceLocation where, const std::string& message) {
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

SourceLocation translator::end_of(const Stmt* s) {
    const auto range = sources_.getExpansionRange(s->getSourceRange());
    return Lexer::getLocForEndOfToken(range.getEnd(), 0, sources_, context_.getLangOpts());
}

const std::vector<comment>& translator::comments_of(FileID file) {
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
            each.last_line = each.line + static_cast<unsigned>(
                                             std::count(each.text.begin(), each.text.end(), '\n'));
            const StringRef before = buffer.substr(0, each.begin);
            const auto newline = before.rfind('\n');
            each.own_line =
                before.substr(newline == StringRef::npos ? 0 : newline + 1).trim().empty();
            result.push_back(std::move(each));
        }
    } while (token.isNot(tok::eof));
    return result;
}

std::vector<std::string> translator::comment_lines(const std::string& text) {
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

std::vector<std::string> translator::doc_lines(SourceLocation declaration) {
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

std::string translator::comment_on(FileID file, SourceLocation end, unsigned& last_line) {
    const unsigned at = line(end);
    std::string tail;
    for (const comment& each : comments_of(file)) {
        if (tail.empty()) {
            if (!each.own_line && each.line == at &&
                each.begin > offset(sources_.getExpansionLoc(end))) {
                tail = comment_lines(each.text).front();
                last_line = each.line;
            }
        } else if (each.own_line && each.line == last_line + 1 && each.text.rfind("///<", 0) == 0) {
            tail += " " + StringRef(comment_lines(each.text).front()).drop_front(4).trim().str();
            last_line = each.line;
        }
    }
    return tail;
}

void translator::align_comments(std::vector<std::string>& lines) {
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

void translator::append_with_comment(std::vector<std::string>& lines, const std::string& text,
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

std::string translator::joined(const std::vector<std::string>& lines) {
    std::string result;
    for (const std::string& each : lines) {
        result += each + "\n";
    }
    return result;
}

std::optional<std::string> translator::documented_direction(const FunctionDecl* function,
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

SourceLocation translator::begin_of_declaration(const NamedDecl* declaration) {
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

SourceLocation translator::end_of_declaration(const NamedDecl* declaration) {
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

std::string translator::source_between(SourceLocation begin, SourceLocation end) {
    return Lexer::getSourceText(CharSourceRange::getTokenRange(sources_.getExpansionLoc(begin),
                                                               sources_.getExpansionLoc(end)),
                                sources_, context_.getLangOpts())
        .str();
}

} // namespace glslgen
