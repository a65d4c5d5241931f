// Golden tests of warpshadow-glslgen.
//
//   golden_test GENERATOR golden FOLDER    accepted/X.hpp gives accepted/X.glsl, refused/X.hpp
//   gives
//                                          the diagnostics in refused/X.txt and no file
//   golden_test GENERATOR subset FILE      the examples of docs/shared-subset.md are what they
//   claim
//
// With WARPSHADOW_UPDATE_GOLDEN=1 in the environment the expected files are rewritten.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <sys/wait.h>

namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

void write(const fs::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    if (!file) {
        std::cerr << "cannot write " << path << '\n';
        std::exit(2);
    }
}

struct run_result {
    int code = 0;
    std::string output;
    std::string diagnostics;
    bool wrote = false;
};

// Runs the generator inside `folder`, so that no path of this machine is in its messages.
run_result run(const std::string& generator, const fs::path& folder, const std::string& source,
               const fs::path& scratch) {
    const fs::path out = scratch / "out.glsl";
    const fs::path err = scratch / "err.txt";
    fs::remove(out);
    const std::string command = "cd '" + folder.string() + "' && '" + generator + "' '" + source +
                                "' -o '" + out.string() + "' 2>'" + err.string() + "'";
    const int status = std::system(command.c_str());
    run_result result;
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    result.wrote = fs::exists(out);
    result.output = result.wrote ? read(out) : "";
    result.diagnostics = read(err);
    return result;
}

int failures = 0;

void fail(const std::string& what) {
    ++failures;
    std::cerr << "FAILED " << what << '\n';
}

// Prints the first line that differs.
void compare(const std::string& name, const std::string& present, const std::string& expected) {
    if (present == expected) {
        return;
    }
    std::istringstream a(expected);
    std::istringstream b(present);
    std::string line_a;
    std::string line_b;
    for (int number = 1;; ++number) {
        const bool more_a = static_cast<bool>(std::getline(a, line_a));
        const bool more_b = static_cast<bool>(std::getline(b, line_b));
        if (!more_a && !more_b) {
            break;
        }
        if (more_a != more_b || line_a != line_b) {
            fail(name + ", line " + std::to_string(number) + "\n  expected: " +
                 (more_a ? line_a : "(end)") + "\n  present:  " + (more_b ? line_b : "(end)"));
            return;
        }
    }
    fail(name + ": line ends differ");
}

std::vector<fs::path> headers(const fs::path& folder) {
    std::vector<fs::path> result;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == ".hpp") {
            result.push_back(entry.path());
        }
    }
    std::sort(result.begin(), result.end());
    return result;
}

int golden(const std::string& generator, const fs::path& folder, const fs::path& scratch,
           bool update) {
    int tests = 0;
    for (const fs::path& header : headers(folder / "accepted")) {
        const run_result result =
            run(generator, header.parent_path(), header.filename().string(), scratch);
        fs::path expected = header;
        expected.replace_extension(".glsl");
        const std::string name = "accepted/" + header.filename().string();
        ++tests;
        if (result.code != 0 || !result.diagnostics.empty()) {
            fail(name + " was refused:\n" + result.diagnostics);
        } else if (update) {
            write(expected, result.output);
        } else {
            compare(name, result.output, read(expected));
        }
    }
    for (const fs::path& header : headers(folder / "refused")) {
        const run_result result =
            run(generator, header.parent_path(), header.filename().string(), scratch);
        fs::path expected = header;
        expected.replace_extension(".txt");
        const std::string name = "refused/" + header.filename().string();
        ++tests;
        if (result.code != 1) {
            fail(name + " ended with code " + std::to_string(result.code) + ", not 1");
        }
        if (result.wrote) {
            fail(name + " was refused, and a file was written all the same");
        }
        if (update) {
            write(expected, result.diagnostics);
        } else {
            compare(name, result.diagnostics, read(expected));
        }
    }
    return tests;
}

// Includes of every example, which are about something else.
constexpr const char* prelude = "#include <warpshadow/detail/glsl_annotation.hpp>\n"
                                "#include <glm/glm.hpp>\n"
                                "#include <glm/gtc/constants.hpp>\n"
                                "#include <array>\n"
                                "#include <cmath>\n"
                                "#include <cstdint>\n"
                                "#include <limits>\n"
                                "#include <vector>\n";

int subset(const std::string& generator, const fs::path& file, const fs::path& scratch) {
    std::istringstream text(read(file));
    std::string line;
    int number = 0;
    int tests = 0;
    while (std::getline(text, line)) {
        ++number;
        const bool accepted = line == "```cpp accepted";
        const bool refused = line == "```cpp refused";
        if (!accepted && !refused) {
            continue;
        }
        const std::string name = file.filename().string() + ":" + std::to_string(number);
        std::string body = prelude;
        std::vector<std::string> messages;
        while (std::getline(text, line) && line != "```") {
            ++number;
            body += line + "\n";
            const std::string mark = "// error: ";
            const auto at = line.find(mark);
            if (at != std::string::npos) {
                messages.push_back(line.substr(at + 2 + 1));
            }
        }
        ++number;
        ++tests;
        write(scratch / "example.hpp", body);
        const run_result result = run(generator, scratch, "example.hpp", scratch);
        if (accepted && result.code != 0) {
            fail(name + " should be accepted:\n" + result.diagnostics);
        }
        if (refused) {
            if (result.code == 0) {
                fail(name + " should be refused");
            }
            if (messages.empty()) {
                fail(name + " names no error");
            }
            for (const std::string& message : messages) {
                if (result.diagnostics.find(message) == std::string::npos) {
                    fail(name + " should give \"" + message + "\":\n" + result.diagnostics);
                }
            }
        }
    }
    if (tests == 0) {
        fail("no examples in " + file.string());
    }
    return tests;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::cerr << "usage: golden_test GENERATOR golden|subset PATH\n";
        return 2;
    }
    const std::string mode = argv[2];
    const fs::path scratch =
        fs::temp_directory_path() /
        ("warpshadow_golden_" + mode + "_" + std::to_string(std::hash<std::string>{}(argv[1])));
    fs::create_directories(scratch);
    const bool update = std::getenv("WARPSHADOW_UPDATE_GOLDEN") != nullptr;
    const int tests = mode == "golden" ? golden(argv[1], argv[3], scratch, update)
                                       : subset(argv[1], argv[3], scratch);
    fs::remove_all(scratch);
    std::cout << tests << " examples, " << failures << " failures\n";
    if (failures != 0 && mode == "golden") {
        std::cerr << "To accept what is present, run with WARPSHADOW_UPDATE_GOLDEN=1 and look at "
                     "the difference.\n";
    }
    return failures == 0 ? 0 : 1;
}
