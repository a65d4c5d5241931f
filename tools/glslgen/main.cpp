// warpshadow-glslgen: GLSL from C++ headers.
#include "output.hpp"
#include "text.hpp"
#include "translator.hpp"
#include "version.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>

namespace {

namespace fs = std::filesystem;

std::optional<std::string> read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return std::nullopt;
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

bool fail(const std::string& message) {
    std::cerr << "warpshadow-glslgen: " << message << '\n';
    return false;
}

// All files or none: each is written beside its place first, and moved there when all are good.
bool write_all(const std::vector<glslgen::output_file>& files) {
    std::vector<fs::path> temporary;
    std::error_code ignored;
    const auto give_up = [&](const std::string& message) {
        for (const fs::path& path : temporary) {
            fs::remove(path, ignored);
        }
        return fail(message);
    };
    for (const glslgen::output_file& each : files) {
        if (read(each.path) == each.text) {
            temporary.emplace_back();
            continue; // untouched, so that nothing is rebuilt
        }
        const fs::path folder = fs::path(each.path).parent_path();
        std::error_code code;
        if (!folder.empty()) {
            fs::create_directories(folder, code);
        }
        temporary.push_back(each.path + ".part");
        std::ofstream file(temporary.back(), std::ios::binary);
        file << each.text;
        file.close();
        if (!file) {
            return give_up("cannot write " + each.path);
        }
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (!temporary[i].empty()) {
            std::error_code code;
            fs::rename(temporary[i], files[i].path, code);
            if (code) {
                return give_up("cannot write " + files[i].path + ": " + code.message());
            }
        }
    }
    return true;
}

// Compares instead of writing.
bool check_all(const std::vector<glslgen::output_file>& files, const std::string& folder,
               const std::string& mend) {
    bool fresh = true;
    for (const glslgen::output_file& each : files) {
        const std::optional<std::string> present = read(each.path);
        if (present != each.text) {
            fresh = fail(each.path + (present ? " is out of date" : " is missing"));
        }
    }
    if (!folder.empty()) {
        for (const auto& entry : fs::directory_iterator(folder)) {
            if (entry.path().extension() == ".glsl" &&
                std::none_of(files.begin(), files.end(), [&](const glslgen::output_file& each) {
                    return fs::path(each.path).filename() == entry.path().filename();
                })) {
                fresh = fail(entry.path().string() + " comes from no header");
            }
        }
    }
    if (!fresh && !mend.empty()) {
        std::cerr << "To mend it, run: " << mend << '\n';
    }
    return fresh;
}

std::string make_escaped(const std::string& path) {
    std::string result;
    for (const char c : path) {
        if (c == ' ' || c == '#') {
            result += '\\';
        }
        result += c == '$' ? "$$" : std::string(1, c);
    }
    return result;
}

bool is_prefix(const std::string& text) {
    const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    return !text.empty() && is_letter(text[0]) && text.rfind("gl_", 0) != 0 &&
           text.find("__") == std::string::npos &&
           std::all_of(text.begin(), text.end(),
                       [&](char c) { return is_letter(c) || c == '_' || (c >= '0' && c <= '9'); });
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    glslgen::translation_options options;
    const auto dashes = std::find(arguments.begin(), arguments.end(), "--");
    if (dashes != arguments.end()) {
        options.flags.assign(dashes + 1, arguments.end());
        arguments.erase(dashes, arguments.end());
    }

    CLI::App app{"Writes the GLSL of C++ functions on GLM types.\n\n"
                 "What is translated: explicit instantiations, definitions and using-declarations\n"
                 "in SOURCE, and everything that these need. What GLSL cannot express is refused\n"
                 "with the place where it stands; nothing is then written.",
                 "warpshadow-glslgen"};
    std::string output;
    std::string folder;
    std::string header;
    std::string parity;
    std::string depfile;
    std::string prefix = "ws_";
    std::string mend;
    bool check = false;
    app.add_option("source", options.source, "C++ file")->required()->option_text("SOURCE");
    app.add_option("-o,--output", output, "write everything into one file, - for the terminal")
        ->option_text("FILE");
    app.add_option("--out-dir", folder,
                   "write one file per header, and warpshadow.glsl with everything")
        ->option_text("DIR");
    app.add_option("--text-header", header, "write the text as a C++ header, for glsl.hpp")
        ->option_text("FILE");
    app.add_option("--parity-list", parity, "write the signatures for parity tests")
        ->option_text("FILE");
    app.add_option("--depfile", depfile, "write the files that were read, as a makefile rule")
        ->option_text("FILE");
    app.add_option("--prefix", prefix, "begins every name (ws_)")->option_text("NAME");
    app.add_option("--resource-dir", options.resource_folder, "headers of the compiler itself")
        ->option_text("DIR");
    app.add_flag("--check", check, "compare the files with what would be written");
    app.add_option("--mend", mend, "command to name when --check finds a difference")
        ->option_text("TEXT");
    app.set_version_flag("--version", "warpshadow-glslgen " GLSLGEN_VERSION);
    app.footer("Flags of the compiler (-I, -D, -std) go after --, as in\n"
               "  warpshadow-glslgen mine.hpp -o mine.glsl -- -Iinclude");
    try {
        std::reverse(arguments.begin(), arguments.end());
        app.parse(arguments);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);
        }
        fail(std::string(error.what()) + "; see --help");
        return 2;
    }
    if (!is_prefix(prefix)) {
        fail("--prefix " + prefix + " cannot begin a name in GLSL");
        return 2;
    }
    if (!fs::is_regular_file(options.source)) {
        fail("no file " + options.source);
        return 2;
    }
    if (options.resource_folder.empty()) {
        options.resource_folder = GLSLGEN_RESOURCE_DIR;
    }
    // the headers of warpshadow come last, so that flags can put others before them
    options.flags.push_back("-I" GLSLGEN_INCLUDE_DIR);

    glslgen::translation made;
    if (!glslgen::translate(options, made)) {
        return 1;
    }
    std::vector<glslgen::output_file> files;
    if (!folder.empty()) {
        for (const std::string& topic : made.topics) {
            files.push_back(
                {folder + "/" + topic + ".glsl", glslgen::topic_text(made, topic, prefix)});
        }
        files.push_back({folder + "/warpshadow.glsl", glslgen::complete_text(made, prefix)});
    }
    if (!header.empty()) {
        files.push_back({header, glslgen::text_header(made)});
    }
    if (!parity.empty()) {
        files.push_back({parity, glslgen::parity_list(made)});
    }
    const std::string complete = glslgen::complete_text(made, prefix);
    if (!output.empty() && output != "-") {
        files.push_back({output, complete});
    }
    if (check) {
        return check_all(files, folder, mend) ? 0 : 1;
    }
    if (!depfile.empty()) {
        if (files.empty()) {
            fail("--depfile needs an output file");
            return 2;
        }
        std::string rule = make_escaped(files.front().path) + ":";
        for (const std::string& input : made.inputs) {
            rule += " \\\n  " + make_escaped(input);
        }
        files.push_back({depfile, rule + "\n"});
    }
    if (!write_all(files)) {
        return 1;
    }
    if (output == "-" || files.empty()) {
        std::cout << complete;
    }
    return 0;
}
