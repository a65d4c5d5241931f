// The programs as a person meets them: what they print, what they refuse, what they leave behind.
#include "glsl/shader_check.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

#include <sys/wait.h>

using namespace shader_check;

namespace {

struct outcome {
    int code;
    std::string out;
    std::string err;
};

outcome run(const std::string& program, const std::string& arguments) {
    const fs::path out = scratch() / "out.txt";
    const fs::path err = scratch() / "err.txt";
    const std::string command = "cd '" + scratch().string() + "' && '" + program + "' " +
                                arguments + " >'" + out.string() + "' 2>'" + err.string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
}

outcome run(const std::string& arguments) {
    return run(PROGRAM, arguments);
}

// Refused: one line that says why, nothing on the output, no file.
void check_refused(const outcome& got, std::string_view reason) {
    INFO(got.err);
    CHECK(got.code != 0);
    CHECK(got.out.empty());
    CHECK(std::count(got.err.begin(), got.err.end(), '\n') == 1);
    CHECK(got.err.find(reason) != std::string::npos);
}

bool is_present(const std::string& name) {
    return fs::exists(scratch() / name) || fs::exists(scratch() / (name + ".part"));
}

} // namespace

TEST_CASE("warpshadow-glsl lists, shows and emits") {
    const outcome list = run("list");
    CHECK(list.code == 0);
    CHECK(list.out.find("  ws_unwarp ") != std::string::npos);
    const outcome show = run("show unwarp ws_crop");
    CHECK(show.code == 0);
    CHECK(show.out.find("vec2 ws_unwarp(") != std::string::npos);
    CHECK(show.out.find("// uses ") != std::string::npos);
    CHECK(show.out.find("vec2 ws_crop(") != std::string::npos);
    const outcome emit = run("emit warp");
    CHECK(emit.code == 0);
    CHECK(emit.out == glsl::emit({"warp"}).text);
    CHECK(run("emit my_warp --prefix my_ --profile vulkan --tables buffer --precise "
              "--strip-comments -o x.glsl")
              .code == 0);
    glsl::options how;
    how.prefix = "my_";
    how.target = glsl::profile::vulkan;
    how.tables = glsl::table_access::buffer;
    how.precise = true;
    how.comments = false;
    CHECK(read(scratch() / "x.glsl") == glsl::emit({"warp"}, how).text);
    CHECK(!fs::exists(scratch() / "x.glsl.part"));
}

TEST_CASE("warpshadow-glsl explains itself") {
    for (const char* arguments : {"--help", "emit --help", "--version"}) {
        const outcome help = run(arguments);
        CHECK(help.code == 0);
        CHECK(help.out.size() > 20);
    }
}

TEST_CASE("warpshadow-glsl refuses in one line") {
    check_refused(run("emit wrap -o y.glsl"), "ws_warp");
    check_refused(run("show nothing_like_it"), "nearest");
    check_refused(run("emit warp --profile 120 -o y.glsl"), "330");
    check_refused(run("emit warp --tables sampler -o y.glsl"), "texture");
    check_refused(run("emit warp --precision best -o y.glsl"), "highp");
    check_refused(run("emit warp --prefix gl_ -o y.glsl"), "prefix");
    check_refused(run("emit warp --precise -o y.glsl"), "GLSL 400");
    check_refused(run("emit -o y.glsl"), "names");
    check_refused(run("bogus"), "");
    check_refused(run(""), "subcommand");
    check_refused(run("emit warp -o no/such/folder/y.glsl"), "cannot write");
    CHECK(!is_present("y.glsl"));
}

#ifdef GENERATOR
TEST_CASE("warpshadow-glslgen refuses without leaving a file") {
    check_refused(run(GENERATOR, "missing.hpp -o z.glsl"), "missing.hpp");
    check_refused(run(GENERATOR, "-o z.glsl"), "source");
    check_refused(run(GENERATOR, "x.hpp --prefix 9 -o z.glsl"), "prefix");
    std::ofstream(scratch() / "bad.hpp") << "inline double f(double x) { return x; }\n";
    const outcome bad = run(GENERATOR, "bad.hpp -o z.glsl --depfile z.d");
    CHECK(bad.code == 1);
    CHECK(bad.err.find("bad.hpp:1:24: error: double cannot be shared") != std::string::npos);
    std::ofstream(scratch() / "broken.hpp") << "inline float f(float x { return x; }\n";
    CHECK(run(GENERATOR, "broken.hpp -o z.glsl").code == 1);
    std::ofstream(scratch() / "empty.hpp") << "\n";
    CHECK(run(GENERATOR, "empty.hpp -o z.glsl").err.find("nothing is shared") != std::string::npos);
    std::ofstream(scratch() / "good.hpp") << "inline float f(float x) { return x; }\n";
    CHECK(run(GENERATOR, "good.hpp -o no/such/place/z.glsl").code == 0); // makes the folder
    CHECK(run(GENERATOR, "good.hpp -o /proc/nothing/z.glsl").code == 1);
    CHECK(!is_present("z.glsl"));
    CHECK(!is_present("z.d"));
}

TEST_CASE("warpshadow-glslgen is deterministic and names no path and no date") {
    std::ofstream(scratch() / "good.hpp") << "inline float f(float x) { return x; }\n";
    const outcome once = run(GENERATOR, "good.hpp");
    CHECK(once.code == 0);
    CHECK(once.out == run(GENERATOR, scratch().string() + "/good.hpp").out);
    CHECK(once.out.find(scratch().string()) == std::string::npos);
    CHECK(once.out.find("float ws_f(float x)") != std::string::npos);
    CHECK(run(GENERATOR, "good.hpp -o a.glsl --depfile a.d").code == 0);
    CHECK(read(scratch() / "a.d").find("good.hpp") != std::string::npos);
    CHECK(run(GENERATOR, "good.hpp --check -o a.glsl").code == 0);
    std::ofstream(scratch() / "a.glsl") << "edited\n";
    const outcome stale = run(GENERATOR, "good.hpp --check -o a.glsl --mend 'make glsl'");
    CHECK(stale.code == 1);
    CHECK(stale.err.find("a.glsl is out of date") != std::string::npos);
    CHECK(stale.err.find("make glsl") != std::string::npos);
}
#endif
