// warpshadow-glsl: lists, shows and emits the shared functions as GLSL.
#include <warpshadow/glsl.hpp>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace glsl = warpshadow::glsl;

const std::map<std::string, glsl::profile> profiles{{"330", glsl::profile::gl330},
                                                    {"430", glsl::profile::gl430},
                                                    {"450", glsl::profile::gl450},
                                                    {"es310", glsl::profile::es310},
                                                    {"vulkan", glsl::profile::vulkan}};
const std::map<std::string, glsl::precision> precisions{{"none", glsl::precision::unstated},
                                                        {"lowp", glsl::precision::lowp},
                                                        {"mediump", glsl::precision::mediump},
                                                        {"highp", glsl::precision::highp}};
const std::map<std::string, glsl::table_access> accesses{{"texture", glsl::table_access::texture},
                                                         {"buffer", glsl::table_access::buffer},
                                                         {"hook", glsl::table_access::hook}};

template <typename Map> std::vector<std::string> names_of(const Map& map) {
    std::vector<std::string> names;
    for (const auto& [name, value] : map) {
        names.push_back(name);
    }
    return names;
}

int fail(const std::string& message, int code) {
    std::cerr << "warpshadow-glsl: " << message << '\n';
    return code;
}

// First sentence of a doc comment, on one line.
std::string summary(std::string_view doc) {
    std::string text;
    while (!doc.empty()) {
        const std::size_t end = std::min(doc.find('\n'), doc.size());
        std::string_view line = doc.substr(0, end);
        doc.remove_prefix(std::min(end + 1, doc.size()));
        line.remove_prefix(std::min<std::size_t>(3, line.size()));
        const std::size_t first = line.find_first_not_of(' ');
        if (first == std::string_view::npos || line.substr(first).starts_with('@')) {
            break;
        }
        text += text.empty() ? "" : " ";
        text += line.substr(first);
    }
    for (std::size_t i = 0; i + 2 < text.size(); ++i) {
        // not the point of "et al." or "eq."
        if (text.compare(i, 2, ". ") == 0 && text[i + 2] >= 'A' && text[i + 2] <= 'Z') {
            return text.substr(0, i + 1);
        }
    }
    return text;
}

int list() {
    std::string_view topic;
    std::size_t width = 0;
    for (const glsl::detail::piece& each : glsl::detail::pieces) {
        width = std::max(width, each.name.size());
    }
    for (const glsl::detail::piece& each : glsl::detail::pieces) {
        if (each.topic != topic) {
            std::cout << (topic.empty() ? "" : "\n") << each.topic << '\n';
            topic = each.topic;
        }
        std::cout << "  " << each.name << std::string(width - each.name.size() + 2, ' ')
                  << summary(each.doc) << '\n';
    }
    return 0;
}

int show(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
        const std::string_view wanted = glsl::detail::bare(name, "ws_");
        bool found = false;
        for (const glsl::detail::piece& each : glsl::detail::pieces) {
            if (each.name.substr(3) != wanted) {
                continue;
            }
            found = true;
            text += text.empty() ? "" : "\n";
            text.append(each.doc).append(each.text);
            for (std::size_t use = 0; use < each.use_count; ++use) {
                text += use == 0 ? "// uses " : ", ";
                text += glsl::detail::pieces[glsl::detail::uses[each.first_use + use]].name;
            }
            text += each.use_count != 0 ? "\n" : "";
        }
        if (!found) {
            const std::string_view view = name;
            return fail(glsl::emit({view}).error, 1);
        }
    }
    std::cout << text;
    return 0;
}

// The file as a whole or not at all.
int write(const std::string& path, const std::string& text) {
    if (path.empty() || path == "-") {
        std::cout << text << std::flush;
        return std::cout ? 0 : fail("cannot write to the output", 1);
    }
    const std::string part = path + ".part";
    std::ofstream file(part, std::ios::binary);
    file << text;
    file.close();
    std::error_code code;
    if (file) {
        std::filesystem::rename(part, path, code);
    }
    if (!file || code) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        return fail("cannot write " + path, 1);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"The functions that warpshadow shares between C++ and GLSL, as GLSL.",
                 "warpshadow-glsl"};
    app.require_subcommand(1);
    app.set_version_flag("--version", "warpshadow-glsl, text of warpshadow-glslgen " +
                                          std::string(glsl::detail::generator));

    CLI::App* lists = app.add_subcommand("list", "name everything there is, by topic");

    std::vector<std::string> names;
    CLI::App* shows = app.add_subcommand("show", "print functions as they are, and what they use");
    shows->add_option("names", names, "functions, structs or constants")
        ->required()
        ->option_text("NAME...");

    glsl::options how;
    std::string prefix = "ws_";
    std::string output;
    bool strip = false;
    CLI::App* emits = app.add_subcommand("emit", "print functions and everything they need");
    emits->add_option("names", names, "functions, structs or constants, or all")
        ->required()
        ->option_text("NAME...");
    emits->add_option("--prefix", prefix, "begins every name; in capitals, every macro")
        ->option_text("ws_");
    std::string target = "330";
    std::string default_precision = "highp";
    std::string tables = "texture";
    emits->add_option("--profile", target, "language of the shader")
        ->check(CLI::IsMember(names_of(profiles)).description(""))
        ->option_text("330|430|450|es310|vulkan");
    emits->add_option("--precision", default_precision, "default precision that is stated for ES")
        ->check(CLI::IsMember(names_of(precisions)).description(""))
        ->option_text("none|lowp|mediump|highp");
    emits->add_option("--tables", tables, "how warp tables are reached")
        ->check(CLI::IsMember(names_of(accesses)).description(""))
        ->option_text("texture|buffer|hook");
    emits->add_flag("--precise", how.precise,
                    "forbid the compiler to contract and reorder; needs GLSL 400");
    emits->add_flag("--strip-comments", strip, "leave comments out");
    emits->add_option("-o,--output", output, "write a file instead of the terminal")
        ->option_text("FILE");
    app.footer("warpshadow-glsl emit warp unwarp --profile 430 -o warp.glsl");

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);
        }
        return fail(std::string(error.what()) + "; see --help", 2);
    }
    if (lists->parsed()) {
        return list();
    }
    if (shows->parsed()) {
        return show(names);
    }
    how.prefix = prefix;
    how.target = profiles.at(target);
    how.default_precision = precisions.at(default_precision);
    how.tables = accesses.at(tables);
    how.comments = !strip;
    const std::vector<std::string_view> views(names.begin(), names.end());
    const glsl::result made = glsl::emit(views, how);
    if (!made.error.empty()) {
        return fail(made.error, 1);
    }
    return write(output, made.text);
}
