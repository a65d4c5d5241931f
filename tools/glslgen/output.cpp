#include "output.hpp"

#include "table_access.hpp"
#include "text.hpp"
#include "version.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <set>

namespace glslgen {
namespace {

std::string hex(std::uint64_t value) {
    std::array<char, 17> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%016llx", static_cast<unsigned long long>(value));
    return buffer.data();
}

bool uses_tables(const entity& each) {
    return each.text.find(table_access::mark) != std::string::npos;
}

std::string guard_name(std::string_view topic) {
    std::string name = "WS_" + upper(topic) + "_GLSL";
    std::replace_if(
        name.begin(), name.end(),
        [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return name;
}

// Comments call functions by their C++ names between backquotes; the reader of the GLSL has others.
std::string rename_in_comment(std::string_view doc,
                              const std::map<std::string, std::string, std::less<>>& names) {
    std::string result;
    while (!doc.empty()) {
        const std::size_t open = doc.find('`');
        const std::size_t close = open == std::string_view::npos ? open : doc.find('`', open + 1);
        if (close == std::string_view::npos) {
            return result + std::string(doc);
        }
        const std::string_view word = doc.substr(open + 1, close - open - 1);
        const auto end = word.find_first_of("(<");
        const auto found = names.find(word.substr(0, end));
        result += doc.substr(0, open + 1);
        if (found != names.end()) {
            result += found->second;
            const auto bracket = word.find('(');
            result += bracket == std::string_view::npos ? "" : word.substr(bracket);
        } else {
            result += word;
        }
        result += '`';
        doc.remove_prefix(close + 1);
    }
    return result;
}

std::map<std::string, std::string, std::less<>> comment_names(const translation& source) {
    std::map<std::string, std::string, std::less<>> names;
    const auto add = [&](const std::string& from, const std::string& to) {
        const auto [found, is_new] = names.emplace(from, to);
        if (!is_new && found->second != to) {
            found->second = from; // several instances of one template: left as it is
        }
    };
    for (const entity& each : source.entities) {
        const auto colon = each.cpp_name.rfind("::");
        add(colon == std::string::npos ? each.cpp_name : each.cpp_name.substr(colon + 2),
            each.name);
        add(each.cpp_name, each.name);
    }
    return names;
}

// @see takes names as they are.
std::string rename_after_see(std::string doc,
                             const std::map<std::string, std::string, std::less<>>& names) {
    std::size_t at = 0;
    while ((at = doc.find("@see ", at)) != std::string::npos) {
        at += 5;
        const std::size_t end = std::min(doc.find_first_of(" \n,", at), doc.size());
        const auto found = names.find(doc.substr(at, end - at));
        if (found != names.end()) {
            doc.replace(at, end - at, found->second);
        }
    }
    return doc;
}

// Comments inside the code as well; code itself has no backquotes.
std::string with_glsl_names(const std::string& text,
                            const std::map<std::string, std::string, std::less<>>& names) {
    if (text.find('`') == std::string::npos && text.find("@see") == std::string::npos) {
        return text;
    }
    std::string renamed = rename_after_see(rename_in_comment(text, names), names);
    // names have grown, and so have lines
    std::vector<std::string> lines;
    std::size_t begin = 0;
    while (begin < renamed.size()) {
        const std::size_t end = renamed.find('\n', begin);
        append_wrapped(lines, renamed.substr(begin, end - begin));
        begin = end + 1;
    }
    renamed.clear();
    for (const std::string& line : lines) {
        renamed += line + "\n";
    }
    return renamed;
}

std::string topic_body(const translation& source, std::string_view topic) {
    const auto names = comment_names(source);
    const std::string guard = guard_name(topic);
    std::string text = "#ifndef " + guard + "\n#define " + guard + "\n";
    const bool tables =
        std::any_of(source.entities.begin(), source.entities.end(),
                    [&](const entity& each) { return each.topic == topic && uses_tables(each); });
    if (tables) {
        text += "\n" + table_access::chosen_by_macro();
    }
    bool after_constant = false;
    for (const entity& each : source.entities) {
        if (each.topic != topic) {
            continue;
        }
        const bool plain = each.kind == entity_kind::constant && each.doc.empty();
        if (!plain || !after_constant) {
            text += "\n";
        }
        text += with_glsl_names(each.doc, names) + with_glsl_names(each.text, names);
        after_constant = plain;
    }
    return text + "\n#endif\n";
}

std::uint64_t hash_of(const translation& source, std::string_view topic) {
    std::uint64_t state = fnv1a(GLSLGEN_VERSION);
    for (const entity& each : source.entities) {
        if (topic.empty() || each.topic == topic) {
            state = fnv1a(each.source, fnv1a(each.cpp_call, state));
        }
    }
    return state;
}

std::string head_line(std::uint64_t hash) {
    return "// Generated by warpshadow-glslgen " GLSLGEN_VERSION " from C++ (" + hex(hash) +
           "). Do not edit.\n";
}

// ES has no default precision for float in fragment shaders.
constexpr std::string_view precision_text = "#ifdef GL_ES\n"
                                            "precision highp float;\n"
                                            "precision highp int;\n"
                                            "#endif\n";

std::set<std::string> needed_topics(const translation& source, std::string_view topic) {
    std::set<std::string> needed;
    std::vector<std::size_t> open;
    for (const entity& each : source.entities) {
        if (each.topic == topic) {
            open.insert(open.end(), each.dependencies.begin(), each.dependencies.end());
        }
    }
    std::set<std::size_t> seen;
    while (!open.empty()) {
        const std::size_t i = open.back();
        open.pop_back();
        if (!seen.insert(i).second) {
            continue;
        }
        if (source.entities[i].topic != topic) {
            needed.insert(source.entities[i].topic);
        }
        open.insert(open.end(), source.entities[i].dependencies.begin(),
                    source.entities[i].dependencies.end());
    }
    return needed;
}

} // namespace

std::string topic_text(const translation& source, std::string_view topic, std::string_view prefix) {
    std::string text = head_line(hash_of(source, topic));
    // a file that is included needs whatever all of its own functions do
    std::set<std::string> needed = needed_topics(source, topic);
    for (std::size_t before = 0; before != needed.size();) {
        before = needed.size();
        for (const std::string& each : std::set<std::string>(needed)) {
            needed.merge(needed_topics(source, each));
        }
    }
    needed.erase(std::string(topic));
    std::string list;
    for (const std::string& each : source.topics) {
        if (needed.count(each) != 0) {
            list += (list.empty() ? "" : ", ") + each + ".glsl";
        }
    }
    if (!list.empty()) {
        text += "// Include before: " + list + "\n";
    }
    text += precision_text;
    text += topic_body(source, topic);
    return with_prefix(text, prefix);
}

std::string complete_text(const translation& source, std::string_view prefix) {
    std::string text = head_line(hash_of(source, {}));
    text += precision_text;
    for (const std::string& topic : source.topics) {
        text += "\n// " + topic + "\n" + topic_body(source, topic);
    }
    return with_prefix(text, prefix);
}

std::string text_header(const translation& source) {
    const auto names = comment_names(source);
    std::string text = head_line(hash_of(source, {}));
    text += "// The shared functions as GLSL text, for glsl.hpp.\n"
            "#pragma once\n\n"
            "#include <array>\n"
            "#include <cstdint>\n"
            "#include <string_view>\n\n"
            "// clang-format off\nnamespace warpshadow::glsl::detail {\n\n"
            "enum class kind : std::uint8_t { constant, enumeration, structure, function };\n\n"
            "/// One piece of GLSL; what it uses stands before it.\n"
            "struct piece {\n"
            "    std::string_view name;     ///< with the prefix ws_\n"
            "    std::string_view topic;    ///< header that it is written in\n"
            "    kind what;\n"
            "    bool tables;               ///< whether it names the WS_TABLE macros\n"
            "    std::uint16_t first_use;   ///< its part of `uses`\n"
            "    std::uint16_t use_count;\n"
            "    std::string_view doc;      ///< `///` lines\n"
            "    std::string_view text;\n"
            "};\n\n";
    text += "inline constexpr std::string_view generator = \"" GLSLGEN_VERSION "\";\n\n";
    std::vector<std::size_t> uses;
    std::string pieces;
    for (const entity& each : source.entities) {
        static constexpr std::array kinds{"constant", "enumeration", "structure", "function"};
        pieces += "    {\"" + each.name + "\", \"" + each.topic +
                  "\", kind::" + kinds[static_cast<std::size_t>(each.kind)] + ", " +
                  (uses_tables(each) ? "true" : "false") + ", " + std::to_string(uses.size()) +
                  ", " + std::to_string(each.dependencies.size()) + ",\n";
        std::string doc = quoted(with_glsl_names(each.doc, names), "     ");
        doc.insert(doc.size() - 1, ",");
        std::string body = quoted(with_glsl_names(each.text, names), "     ");
        body.insert(body.size() - 1, "},");
        pieces += doc + body;
        uses.insert(uses.end(), each.dependencies.begin(), each.dependencies.end());
    }
    text += "inline constexpr std::array<std::uint16_t, " + std::to_string(uses.size()) + "> uses{";
    for (std::size_t i = 0; i < uses.size(); ++i) {
        text += (i % 20 == 0 ? "\n    " : " ") + std::to_string(uses[i]) + ",";
    }
    text += "\n};\n\n";
    text += "inline constexpr std::array<piece, " + std::to_string(source.entities.size()) +
            "> pieces{{\n" + pieces + "}};\n\n";
    const auto access = [&](std::string_view name, std::string_view body) {
        std::string literal = quoted(body, "    ");
        literal.insert(literal.size() - 1, ";");
        text += "inline constexpr std::string_view table_" + std::string(name) + " =\n" + literal +
                "\n";
    };
    for (const auto& [name, body] : table_access::all) {
        access(name, body);
    }
    text += "} // namespace warpshadow::glsl::detail\n// clang-format on\n";
    return text;
}

std::string parity_list(const translation& source) {
    std::string text = head_line(hash_of(source, {}));
    text +=
        "// WS_STRUCT(GLSL name, C++ type, members) for a template of T, WS_PLAIN_STRUCT for "
        "others;\n"
        "// WS_FUNCTION(GLSL name, C++ function, C++ result, C++ parameters, GLSL result,\n"
        "// GLSL parameters). A variable is WS_VARIABLE(name, GLSL type, array size, direction).\n";
    const auto variables = [](const entity& each) {
        std::string list;
        for (const variable& v : each.variables) {
            list += (list.empty() ? "WS_VARIABLE(" : " WS_VARIABLE(") + v.name + ", " + v.type +
                    ", " + std::to_string(v.array) + ", \"" + v.direction + "\")";
        }
        return list;
    };
    for (const entity& each : source.entities) {
        if (each.kind == entity_kind::structure) {
            text += (each.is_template ? "WS_STRUCT(" : "WS_PLAIN_STRUCT(") + each.name + ", (" +
                    each.cpp_call + "),\n    " + variables(each) + ")\n";
        } else if (each.kind == entity_kind::function && !each.is_method) {
            std::string parameters;
            for (const variable& v : each.variables) {
                parameters += (parameters.empty() ? "" : ", ") + v.cpp_type;
            }
            std::string result = each.result;
            text += "WS_FUNCTION(" + each.name + ", (" + each.cpp_call + "),\n    (" +
                    each.cpp_result + "), (" + parameters + "),\n    " + result + ", " +
                    variables(each) + ")\n";
        }
    }
    return text;
}

} // namespace glslgen
