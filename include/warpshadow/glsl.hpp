// The shared functions as GLSL text, at run time: choose functions, get them and all they need.
//
// The text is the same as in glsl/warpshadow. This is the one header that allocates: it builds
// strings, for programs that put shaders together as they run.
#pragma once

#include <warpshadow/detail/glsl_text.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace warpshadow::glsl {

/// Language that the text is for.
enum class profile : std::uint8_t {
    gl330,  ///< OpenGL 3.3
    gl430,  ///< OpenGL 4.3
    gl450,  ///< OpenGL 4.5
    es310,  ///< OpenGL ES 3.1
    vulkan, ///< GLSL 450 for SPIR-V
};

/// How warp tables are reached.
enum class table_access : std::uint8_t {
    texture, ///< a sampler2D for each table
    buffer,  ///< an ivec3 into one buffer of floats
    hook,    ///< macros that the shader defines: WS_TABLE and WS_TABLE_CELLS, _ROWS and _NODE
};

/// Default precision of float and int; only ES asks for it.
enum class precision : std::uint8_t {
    unstated, ///< the shader states it
    lowp,
    mediump,
    highp,
};

/// What the text should be like. The defaults give the text of glsl/warpshadow.
struct options {
    std::string_view prefix = "ws_"; ///< begins every name; in capitals, every macro
    profile target = profile::gl330;
    precision default_precision = precision::highp; ///< for ES
    table_access tables = table_access::texture;
    bool precise = false; ///< forbids contraction and reordering; needs GLSL 400
    bool comments = true;
};

/// Text, or why there is none.
struct result {
    std::string text;  ///< without `#version`; ends with a line end
    std::string error; ///< one line; empty if all is well
};

/// Names of all functions, in the order in which they are emitted.
inline std::vector<std::string_view> functions() {
    std::vector<std::string_view> names;
    for (const detail::piece& each : detail::pieces) {
        if (each.what == detail::kind::function && (names.empty() || names.back() != each.name)) {
            names.push_back(each.name);
        }
    }
    return names;
}

namespace detail {

inline bool is_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Whether `text` can begin every name: GLSL keeps `gl_` and double underscores for itself.
inline bool is_prefix(std::string_view text) {
    return !text.empty() && !(text[0] >= '0' && text[0] <= '9') && text[0] != '_' &&
           !text.starts_with("gl_") && text.find("__") == std::string_view::npos &&
           std::all_of(text.begin(), text.end(), is_word);
}

/// Text with another prefix: `ws_` and `WS_` at the beginning of whole words.
inline std::string with_prefix(std::string_view text, std::string_view prefix) {
    if (prefix == "ws_") {
        return std::string(text);
    }
    std::string capitals(prefix);
    for (char& c : capitals) {
        c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        while (end < text.size() && is_word(text[end])) {
            ++end;
        }
        std::string_view word = text.substr(i, end - i);
        if (word.starts_with("ws_") || word.starts_with("WS_")) {
            result += word.starts_with("ws_") ? prefix : std::string_view(capitals);
            word.remove_prefix(3);
        }
        result += word;
        i = end;
        while (i < text.size() && !is_word(text[i])) {
            result += text[i++];
        }
    }
    return result;
}

/// Text without comments and without the lines that held nothing else.
inline std::string without_comments(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::size_t comment = line.find("//");
        if (comment != std::string_view::npos) {
            line = line.substr(0, comment);
            while (!line.empty() && line.back() == ' ') {
                line.remove_suffix(1);
            }
            if (line.empty()) {
                continue;
            }
        }
        result += line;
        result += '\n';
    }
    return result;
}

/// Whether a declaration of this type can be `precise`.
inline bool is_floating(std::string_view type) {
    return type == "float" || type.starts_with("vec") || type.starts_with("mat") ||
           type.starts_with("ws_");
}

/// A function whose locals, written parameters and results are `precise`.
///
/// The result goes through a local: not every compiler takes the qualifier on a function.
inline std::string with_precise(std::string_view text) {
    std::string result;
    const std::string_view type = text.substr(0, text.find(' '));
    int results = 0;
    bool start = false; // of a statement
    std::size_t depth = 0;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (text.substr(i).starts_with("//")) {
            const std::size_t end = std::min(text.find('\n', i), text.size());
            result += text.substr(i, end - i);
            i = end;
            continue;
        }
        if (!is_word(c)) {
            start =
                c == '{' || c == '}' || c == ';' || c == ':' || (start && (c == ' ' || c == '\n'));
            depth += c == '{' ? 1 : 0;
            depth -= c == '}' ? 1 : 0;
            result += c;
            ++i;
            continue;
        }
        std::size_t end = i;
        while (end < text.size() && is_word(text[end])) {
            ++end;
        }
        const std::string_view word = text.substr(i, end - i);
        // `for (float x = …` declares as well
        const bool in_for = result.ends_with("for (");
        const bool declares = end + 1 < text.size() && text[end] == ' ' && is_word(text[end + 1]);
        if (depth > 0 && (start || in_for) && declares && is_floating(word)) {
            result += "precise ";
        } else if ((word == "out" || word == "inout") && declares) {
            const std::size_t type_end = std::min(text.find(' ', end + 1), text.size());
            if (is_floating(text.substr(end + 1, type_end - end - 1))) {
                result += "precise ";
            }
        } else if (depth > 0 && start && word == "return" && is_floating(type)) {
            const std::size_t stop = std::min(text.find(';', end), text.size());
            const std::string_view value = text.substr(end, stop - end);
            const std::size_t line = result.rfind('\n') + 1;
            const std::string indent = result.substr(line);
            const std::size_t bracket = type.find('[');
            const std::string name = "precise_result" + std::to_string(results++);
            result.append("precise ").append(type.substr(0, bracket)).append(" ").append(name);
            result += bracket == std::string_view::npos ? "" : type.substr(bracket);
            result.append(" =").append(value).append(";\n");
            result.append(indent).append("return ").append(name);
            i = stop;
            start = false;
            continue;
        }
        result += word;
        start = false;
        i = end;
    }
    return result;
}

inline std::string table_prologue(const options& how) {
    std::string text;
    const auto add = [&](auto... parts) { (text.append(parts), ...); };
    if (how.tables == table_access::texture) {
        add(table_texture_head,
            how.target == profile::es310 ? table_texture_type_es : table_texture_type,
            table_texture_macros);
    } else if (how.tables == table_access::hook) {
        add(table_hook);
    } else if (how.target == profile::gl330) {
        add(table_buffer_head, table_buffer_texels, table_buffer_macros);
    } else if (how.target == profile::vulkan) {
        add(table_buffer_head, table_buffer_binding, table_buffer_set, table_buffer_vulkan,
            table_buffer_macros);
    } else {
        add(table_buffer_head, table_buffer_binding, table_buffer_storage, table_buffer_macros);
    }
    return text;
}

/// Number of single-letter changes between two words.
inline std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        row[j] = j;
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

/// Name without the library's prefix, or the one that was asked for.
inline std::string_view bare(std::string_view name, std::string_view prefix) {
    if (name.starts_with("ws_")) {
        return name.substr(3);
    }
    return prefix != "ws_" && name.starts_with(prefix) ? name.substr(prefix.size()) : name;
}

} // namespace detail

/// Up to three names of functions, structs and constants that are most like a given one.
inline std::vector<std::string_view> nearest(std::string_view name) {
    const std::string_view wanted = detail::bare(name, "ws_");
    std::vector<std::pair<std::size_t, std::string_view>> ranked;
    for (const detail::piece& each : detail::pieces) {
        const std::string_view own = each.name.substr(3);
        std::size_t rank = detail::distance(wanted, own);
        // a part of a name is nearer than any misspelling
        if (wanted.size() > 2 && own.find(wanted) != std::string_view::npos) {
            rank = 0;
        }
        ranked.emplace_back(rank, each.name);
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string_view> names;
    for (const auto& [rank, each] : ranked) {
        if (names.size() < 3 && std::find(names.begin(), names.end(), each) == names.end()) {
            names.push_back(each);
        }
    }
    return names;
}

/// GLSL of the named functions and of everything that they use.
///
/// @param names functions, structs or constants, with or without prefix; "all" for everything
/// @param how   what the text should be like
/// @return      the text, or the reason why there is none: an unknown name (with the nearest ones),
///              a prefix that GLSL forbids, or `precise` for a language that has none
inline result emit(std::span<const std::string_view> names, const options& how = {}) {
    result made;
    if (!detail::is_prefix(how.prefix)) {
        made.error = "the prefix \"" + std::string(how.prefix) + "\" cannot begin a name in GLSL";
        return made;
    }
    if (how.precise && (how.target == profile::gl330 || how.target == profile::es310)) {
        made.error = "precise needs GLSL 400: GLSL 330 and ES 310 have none";
        return made;
    }
    std::vector<bool> wanted(detail::pieces.size(), false);
    for (const std::string_view name : names) {
        bool found = name == "all";
        for (std::size_t i = 0; i < detail::pieces.size(); ++i) {
            if (name == "all" ||
                detail::pieces[i].name.substr(3) == detail::bare(name, how.prefix)) {
                wanted[i] = true;
                found = true;
            }
        }
        if (!found) {
            made.error = "no function \"" + std::string(name) + "\"";
            const std::vector<std::string_view> near_names = nearest(name);
            for (std::size_t i = 0; i < near_names.size(); ++i) {
                made.error += i == 0 ? "; the nearest are " : ", ";
                made.error += near_names[i];
            }
            return made;
        }
    }
    // what a piece uses stands before it
    bool tables = false;
    for (std::size_t i = detail::pieces.size(); i-- > 0;) {
        const detail::piece& each = detail::pieces[i];
        if (!wanted[i]) {
            continue;
        }
        tables = tables || each.tables;
        for (std::size_t use = 0; use < each.use_count; ++use) {
            wanted[detail::uses[each.first_use + use]] = true;
        }
    }
    std::string text = "// From warpshadow, generated from C++ by warpshadow-glslgen " +
                       std::string(detail::generator) + ".\n";
    if (how.target == profile::es310 && how.default_precision != precision::unstated) {
        static constexpr std::array<std::string_view, 4> words{"", "lowp", "mediump", "highp"};
        const std::string_view word = words[static_cast<std::size_t>(how.default_precision)];
        text.append("precision ").append(word).append(" float;\n");
        text.append("precision ").append(word).append(" int;\n");
    }
    if (tables) {
        text += detail::table_prologue(how);
    }
    for (std::size_t i = 0; i < detail::pieces.size(); ++i) {
        const detail::piece& each = detail::pieces[i];
        if (wanted[i]) {
            text += '\n';
            text += each.doc;
            text += how.precise && each.what == detail::kind::function
                        ? detail::with_precise(each.text)
                        : std::string(each.text);
        }
    }
    if (!how.comments) {
        text = detail::without_comments(text);
        text.erase(0, text.find_first_not_of('\n'));
    }
    made.text = detail::with_prefix(text, how.prefix);
    return made;
}

/// The same for a list that is written out: `emit({"warp", "unwarp"})`.
inline result emit(std::initializer_list<std::string_view> names, const options& how = {}) {
    return emit(std::span(names.begin(), names.size()), how);
}

} // namespace warpshadow::glsl
