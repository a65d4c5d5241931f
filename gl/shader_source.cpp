#include "gl/shader_source.hpp"

#include <algorithm>

namespace gl {
namespace {

std::string_view trimmed(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view() : line.substr(first);
}

/// Rest of the line after `#word`, or nothing when the line is not that directive.
bool directive(std::string_view line, std::string_view word, std::string_view& rest) {
    line = trimmed(line);
    if (!line.starts_with('#')) {
        return false;
    }
    line = trimmed(line.substr(1));
    if (!line.starts_with(word)) {
        return false;
    }
    rest = trimmed(line.substr(word.size()));
    return true;
}

bool has_version(std::string_view text) {
    std::string_view rest;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        if (directive(text.substr(0, end), "version", rest)) {
            return true;
        }
        text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    }
    return false;
}

std::string line_directive(std::size_t line, std::size_t file) {
    return "#line " + std::to_string(line) + " " + std::to_string(file) + "\n";
}

std::string define_lines(std::span<const std::string> defines) {
    std::string result;
    for (const std::string& text : defines) {
        result += "#define " + text + "\n";
    }
    return result;
}

} // namespace

shader_library::shader_library(std::initializer_list<std::span<const shader_file>> sets) {
    for (const std::span<const shader_file> set : sets) {
        files_.insert(files_.end(), set.begin(), set.end());
    }
}

shader_source shader_library::load(std::string_view name,
                                   std::span<const std::string> defines) const {
    const auto found = std::find_if(files_.begin(), files_.end(),
                                    [&](const shader_file& file) { return file.name == name; });
    if (found == files_.end()) {
        throw error("no shader file \"" + std::string(name) + "\"");
    }
    return compose(found->text, name, defines);
}

shader_source shader_library::compose(std::string_view text, std::string_view name,
                                      std::span<const std::string> defines) const {
    shader_source out;
    out.files.emplace_back(name);
    if (!has_version(text)) {
        out.text = "#version 430 core\n" + define_lines(defines) + line_directive(1, 0);
        defines = {};
    }
    append(out, text, 0, defines);
    return out;
}

void shader_library::append(shader_source& out, std::string_view text, std::size_t file,
                            std::span<const std::string> defines) const {
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view line = text.substr(0, end);
        text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
        ++number;

        std::string_view rest;
        if (directive(line, "version", rest)) {
            if (file != 0) {
                throw error(out.files[file] + ":" + std::to_string(number) +
                            ": #version in an included file");
            }
            out.text += line;
            out.text += '\n';
            out.text += define_lines(defines) + line_directive(number + 1, file);
            continue;
        }
        if (!directive(line, "include", rest)) {
            out.text += line;
            out.text += '\n';
            continue;
        }
        const std::size_t close = rest.size() < 2 ? std::string_view::npos : rest.find('"', 1);
        if (!rest.starts_with('"') || close == std::string_view::npos) {
            throw error(out.files[file] + ":" + std::to_string(number) +
                        ": #include wants \"name\"");
        }
        const std::string_view name = rest.substr(1, close - 1);
        const auto found = std::find_if(files_.begin(), files_.end(),
                                        [&](const shader_file& each) { return each.name == name; });
        if (found == files_.end()) {
            throw error(out.files[file] + ":" + std::to_string(number) + ": no shader file \"" +
                        std::string(name) + "\"");
        }
        if (std::find(out.files.begin(), out.files.end(), name) == out.files.end()) {
            out.files.emplace_back(name);
            const std::size_t included = out.files.size() - 1;
            out.text += line_directive(1, included);
            append(out, found->text, included, {});
        }
        out.text += line_directive(number + 1, file);
    }
}

} // namespace gl
