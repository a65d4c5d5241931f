// Functions of glsl/ come from C++: those of glsl/warpshadow all, and none of glsl/passes is a copy
// of a C++ function by hand.
#include "glsl/shader_check.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <iostream>
#include <regex>
#include <set>
#include <vector>

using namespace shader_check;

namespace {

const fs::path root = SOURCE_FOLDER;

// Names of the functions that a text defines, without comments.
std::set<std::string> defined_in(const std::string& text) {
    const std::string code = glsl::detail::without_comments(text);
    std::set<std::string> names;
    const std::regex definition(R"((?:^|\n)[a-zA-Z_][a-zA-Z0-9_]*(?:\[[0-9]+\])?\s+)"
                                R"(([a-zA-Z_][a-zA-Z0-9_]*)\s*\([^;{}]*\)\s*\{)");
    for (auto each = std::sregex_iterator(code.begin(), code.end(), definition);
         each != std::sregex_iterator(); ++each) {
        names.insert((*each)[1]);
    }
    return names;
}

std::vector<fs::path> files_in(const fs::path& folder, const std::string& extension) {
    std::vector<fs::path> files;
    if (fs::exists(folder)) {
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.path().extension() == extension) {
                files.push_back(entry.path());
            }
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace

TEST_CASE("every function of glsl/warpshadow has its origin in C++") {
    const std::vector<std::string_view> shared = glsl::functions();
    std::size_t found = 0;
    for (const fs::path& file : files_in(root / "glsl" / "warpshadow", ".glsl")) {
        for (const std::string& name : defined_in(read(file))) {
            INFO(file.filename() << " defines " << name);
            CHECK(std::find(shared.begin(), shared.end(), name) != shared.end());
            ++found;
        }
    }
    CHECK(found >= 2 * std::set<std::string_view>(shared.begin(), shared.end()).size());
}

TEST_CASE("no function of glsl/passes has a C++ twin that it does not come from") {
    std::string headers;
    for (const fs::path& file : files_in(root / "include" / "warpshadow", ".hpp")) {
        if (file.filename() != "glsl_text.hpp") {
            headers += read(file);
        }
    }
    std::cout << "functions that exist on the device alone:\n";
    for (const fs::path& file : files_in(root / "glsl" / "passes", ".glsl")) {
        for (const std::string& name : defined_in(read(file))) {
            if (name == "main") {
                continue;
            }
            std::cout << "  " << file.filename().string() << ": " << name << '\n';
            const std::string bare(glsl::detail::bare(name, "ws_"));
            INFO(file.filename() << " defines " << name << ", and the headers " << bare);
            CHECK(!std::regex_search(headers, std::regex("[ >&]" + bare + "\\([^;]*\\)\\s*\\{")));
        }
    }
}

TEST_CASE("the search finds what it is there to find") {
    CHECK(defined_in("float ws_a(float x)\n{\n}\nvec2[3] ws_b()\n{\n}\n// float ws_c() {\n") ==
          std::set<std::string>{"ws_a", "ws_b"});
}

TEST_CASE("the GLSL in the documentation is the real one") {
    std::string real = read(root / "glsl" / "warpshadow" / "warpshadow.glsl");
    for (const fs::path& file : files_in(root / "tests" / "generator" / "accepted", ".glsl")) {
        real += read(file);
    }
    std::istringstream text(read(root / "docs" / "glsl.md"));
    std::string line;
    std::size_t functions = 0;
    while (std::getline(text, line)) {
        if (line != "```glsl") {
            continue;
        }
        // piece by piece: what is left out between two functions is left out
        std::string piece;
        while (std::getline(text, line) && line != "```") {
            piece += line + "\n";
            if (line == "}" || line == "};") {
                const auto begin = piece.find_first_not_of('\n');
                INFO(piece);
                CHECK(real.find(piece.substr(begin)) != std::string::npos);
                piece.clear();
                ++functions;
            }
        }
        CHECK(piece.find_first_not_of('\n') == std::string::npos);
    }
    CHECK(functions >= 8);
}
