// Every emitted text compiles in every language and with every option.
#include "glsl/shader_check.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <vector>

using namespace shader_check;

namespace {

const fs::path folder = fs::path(SOURCE_FOLDER) / "glsl" / "warpshadow";

struct named_file {
    std::string name;
    std::string text;
};

std::vector<named_file> committed() {
    std::vector<named_file> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == ".glsl") {
            files.push_back({entry.path().filename().string(), read(entry.path())});
        }
    }
    std::sort(files.begin(), files.end(),
              [](const named_file& a, const named_file& b) { return a.name < b.name; });
    return files;
}

// A file after those that its first lines name.
std::string with_includes(const named_file& file) {
    const std::string mark = "// Include before: ";
    const auto at = file.text.find(mark);
    std::string text;
    if (at != std::string::npos) {
        const auto end = file.text.find('\n', at);
        std::string list = file.text.substr(at + mark.size(), end - at - mark.size());
        std::replace(list.begin(), list.end(), ',', ' ');
        std::istringstream names(list);
        std::string name;
        while (names >> name) {
            INFO(file.name << " names " << name);
            REQUIRE(fs::exists(folder / name));
            text += read(folder / name);
        }
    }
    return text + file.text;
}

} // namespace

TEST_CASE("every committed file compiles in every language with every table access") {
    const std::vector<named_file> files = committed();
    REQUIRE(files.size() > 1);
    for (const named_file& file : files) {
        const std::string text = with_includes(file);
        const bool tables = text.find("WS_TABLE_ACCESS") != std::string::npos;
        for (const language& in : languages) {
            INFO(file.name << " in " << in.name);
            CHECK(complaints(in, "", text) == "");
            if (tables) {
                CHECK(complaints(in, "#define WS_TABLE_ACCESS_BUFFER\n", text) == "");
                CHECK(complaints(in, "#define WS_TABLE_ACCESS_HOOK\n" + std::string(hook), text) ==
                      "");
            }
        }
    }
}

TEST_CASE("files may be included twice, and beside the file with everything") {
    std::string text;
    for (const named_file& file : committed()) {
        text += with_includes(file);
    }
    for (const language& in : languages) {
        INFO(in.name);
        CHECK(complaints(in, "", text + text) == "");
    }
}

TEST_CASE("committed files are ASCII, and no line of code is wider than 100 columns") {
    for (const named_file& file : committed()) {
        std::istringstream lines(file.text);
        std::string line;
        for (int number = 1; std::getline(lines, line); ++number) {
            INFO(file.name << ":" << number);
            CHECK(line.size() <= 100);
            CHECK(std::all_of(line.begin(), line.end(), [](char c) { return c >= 32 && c < 127; }));
        }
    }
}

TEST_CASE("emit works in every language with every combination of options") {
    for (const language& in : languages) {
        for (const glsl::table_access tables :
             {glsl::table_access::texture, glsl::table_access::buffer, glsl::table_access::hook}) {
            for (const bool precise : {false, true}) {
                for (const bool comments : {false, true}) {
                    for (const std::string_view prefix : {"ws_", "engineX_"}) {
                        glsl::options how;
                        how.target = in.target;
                        how.tables = tables;
                        how.precise = precise;
                        how.comments = comments;
                        how.prefix = prefix;
                        const glsl::result made = glsl::emit({"all"}, how);
                        INFO(in.name << " tables " << int(tables) << " precise " << precise
                                     << " comments " << comments << " prefix " << prefix);
                        if (precise && (in.target == glsl::profile::gl330 ||
                                        in.target == glsl::profile::es310)) {
                            CHECK(made.text.empty());
                            CHECK(made.error.find("precise") != std::string::npos);
                            continue;
                        }
                        CHECK(made.error == "");
                        std::string before;
                        if (tables == glsl::table_access::hook) {
                            before = glsl::detail::with_prefix(hook, prefix);
                        }
                        CHECK(complaints(in, before, made.text) == "");
                        CHECK((made.text.find("//") == std::string::npos) == !comments);
                        CHECK((made.text.find("precise ") != std::string::npos) == precise);
                    }
                }
            }
        }
    }
}

TEST_CASE("each function compiles with what it needs and nothing else") {
    for (const std::string_view name : glsl::functions()) {
        for (const language& in : {languages[0], languages[3]}) {
            glsl::options how;
            how.target = in.target;
            const glsl::result made = glsl::emit({name}, how);
            INFO(name << " in " << in.name);
            CHECK(made.error == "");
            CHECK(complaints(in, "", made.text) == "");
        }
    }
}

TEST_CASE("every precision compiles for ES, and unstated leaves it to the shader") {
    for (const glsl::precision precision : {glsl::precision::unstated, glsl::precision::lowp,
                                            glsl::precision::mediump, glsl::precision::highp}) {
        glsl::options how;
        how.target = glsl::profile::es310;
        how.default_precision = precision;
        const std::string text = glsl::emit({"all"}, how).text;
        const bool unstated = precision == glsl::precision::unstated;
        CHECK(complaints(languages[3], unstated ? "precision highp float;\n" : "", text) == "");
        CHECK((text.find("precision ") == std::string::npos) == unstated);
        if (unstated) {
            CHECK(complaints(languages[3], "", text) != "");
        }
    }
}

TEST_CASE("a hook that is not defined is named by the compiler") {
    glsl::options how;
    how.tables = glsl::table_access::hook;
    const std::string text = glsl::emit({"warp"}, how).text;
    const std::string said = complaints(languages[0], "", text);
    CHECK(said.find("Define WS_TABLE before this text") != std::string::npos);
    std::string before(hook);
    before = before.substr(0, before.find("#define WS_TABLE_NODE"));
    CHECK(complaints(languages[0], before, text).find("WS_TABLE_NODE") != std::string::npos);
}

TEST_CASE("what cannot be emitted is said in one line") {
    CHECK(glsl::emit({"warpp"}).error.find("ws_warp") != std::string::npos);
    CHECK(glsl::emit({"warpp"}).text.empty());
    for (const std::string_view prefix : {"", "9", "gl_", "a__b", "a b", "é", "_a"}) {
        glsl::options how;
        how.prefix = prefix;
        INFO(prefix);
        CHECK(glsl::emit({"warp"}, how).error.find("prefix") != std::string::npos);
    }
}

TEST_CASE("the closure of a function is complete, in order and free of everything else") {
    const std::string text = glsl::emit({"ws_warp"}).text;
    const auto place = [&](std::string_view what) { return text.find(what); };
    CHECK(place("struct ws_row_blend {") < place("ws_row_blend ws_blend_rows("));
    CHECK(place("vec2 ws_warp_offset(") < place("vec2 ws_warp("));
    CHECK(place("vec2 ws_warp(") != std::string::npos);
    CHECK(place("ws_unwarp(") == std::string::npos);
    CHECK(place("ws_widen_side(") == std::string::npos);
    CHECK(place("#version") == std::string::npos);
}

TEST_CASE("header and files hold the same text") {
    const std::string whole = read(folder / "warpshadow.glsl");
    for (const glsl::detail::piece& each : glsl::detail::pieces) {
        INFO(each.name);
        const std::string own = read(folder / (std::string(each.topic) + ".glsl"));
        CHECK(whole.find(std::string(each.doc) + std::string(each.text)) != std::string::npos);
        CHECK(own.find(std::string(each.doc) + std::string(each.text)) != std::string::npos);
    }
}

TEST_CASE("everything is emitted in less than 50 ms") {
    double best = 1.0;
    for (int i = 0; i < 5; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        glsl::options how;
        how.prefix = "my_";
        how.comments = false;
        how.precise = true;
        how.target = glsl::profile::gl450;
        const std::size_t size = glsl::emit({"all"}, how).text.size();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        CHECK(size > 1000);
        best = std::min(best, taken.count());
    }
    CHECK(best < 0.05);
}

// Faults of the generator that a compiler can see. What only changes the meaning is seen by the
// replay (tests/parity/fault_test.cpp).
TEST_CASE("planted faults are refused by the compiler") {
    const std::string whole = read(folder / "warpshadow.glsl");
    const auto with_fault = [&](std::string_view from, std::string_view to) {
        std::string text = whole;
        const auto at = text.find(from);
        INFO(from);
        REQUIRE(at != std::string::npos);
        return text.replace(at, from.size(), to);
    };
    // an int where float is wanted: ES converts nothing
    CHECK(complaints(languages[3], "", with_fault("= 1.0 / 65536.0", "= 1 / 65536")) != "");
    // a conversion is lost
    CHECK(complaints(languages[3], "", with_fault("float(cells)", "cells")) != "");
    // arguments of unlike types are exchanged
    CHECK(complaints(languages[0], "",
                     with_fault("ws_blend_rows(p.y, WS_TABLE_ROWS(rows))",
                                "ws_blend_rows(WS_TABLE_ROWS(rows), p)")) != "");
    // a parenthesis is lost
    CHECK(complaints(languages[0], "",
                     with_fault("return p + ws_warp_offset(rows, columns, p);",
                                "return p + ws_warp_offset(rows, columns, p;")) != "");
    // a callee stands behind its caller
    const auto last = whole.rfind("\n#endif");
    CHECK(complaints(languages[0], "",
                     "float ws_early(float x)\n{\n    return ws_late(x);\n}\n" +
                         whole.substr(0, last) + "float ws_late(float x)\n{\n    return x;\n}\n" +
                         whole.substr(last)) != "");
}
