// Compute passes of glsl/passes against the G-buffer pass of the same run.
//
// A scene of 261,000 triangles, seen at 1024² pixels. Every round draws the G-buffer once and runs
// every pipeline once, so that all share whatever the machine is doing; medians over the rounds.
// The inverse of all texel centres follows, by strips of a column and by a search for each texel.
// Usage: passes_bench [rounds] [part of a line's name, such as "tables 128"] [FILE.json]
#include "arguments.hpp"
#include "gl/context.hpp"
#include "gl/mesh.hpp"
#include "gl/objects.hpp"
#include "gl/timer.hpp"
#include "passes_scene.hpp"

#include <warpshadow/conventions.hpp>
#include <warpshadow/fit.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/smoothing.hpp>
#include <warpshadow/warp_build.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <vector>

namespace ws = warpshadow;

namespace {

constexpr int view = 1024;

constexpr const char* g_buffer_vertex = R"(#version 430 core
layout(location = 0) in vec3 position;
uniform mat4 camera;
out vec3 world;
void main()
{
    world = position;
    gl_Position = camera * vec4(position, 1.0);
}
)";

constexpr const char* g_buffer_fragment = R"(#version 430 core
in vec3 world;
uniform vec3 eye;
layout(std430, binding = 0) readonly buffer face_normals { vec4 face_normal[]; };
layout(location = 0) out vec4 out_position;
layout(location = 1) out vec4 out_normal;
void main()
{
    vec3 normal = face_normal[gl_PrimitiveID].xyz;
    out_position = vec4(world, 1.0);
    out_normal = vec4(dot(normal, eye - world) < 0.0 ? -normal : normal, 0.0);
}
)";

/// View samples of the G-buffer in the map of the light, whole or cropped.
constexpr const char* view_samples = R"(
layout(binding = 0) uniform sampler2D g_position;
layout(binding = 1) uniform sampler2D g_normal;
layout(std140, binding = 4) uniform light_buffer // read so, written as a storage buffer
{
    mat4 light_full;
    mat4 light_matrix;
    vec4 light_position;
};
ivec2 ws_view_size() { return textureSize(g_position, 0); }
bool ws_view_sample(ivec2 pixel, out vec2 p)
{
    p = vec2(0.0);
    vec4 world = texelFetch(g_position, pixel, 0);
    if (world.w == 0.0 ||
        dot(texelFetch(g_normal, pixel, 0).xyz,
            normalize(light_position.xyz - light_position.w * world.xyz)) <= 0.0) {
        return false;
    }
#ifdef FULL_MAP
    vec4 clip = light_full * vec4(world.xyz, 1.0);
#else
    vec4 clip = light_matrix * vec4(world.xyz, 1.0);
#endif
    p = clip.xy / clip.w * 0.5 + 0.5;
    return clip.w > 0.0;
}
)";

gl::shader_library& library() {
    static gl::shader_library files{gl::glsl_files()};
    return files;
}

gl::program compute(const std::string& text) {
    return gl::program::compute(library().compose("#version 430 core\n" + text, "passes_bench"));
}

void wait_for_writes() {
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0.0 : values[values.size() / 2];
}

struct large_scene {
    large_scene() {
        const glm::dvec3 eye(-60.0, static_cast<double>(passes_scene::height(-60.0f, 5.0f)) + 3.0,
                             5.0);
        const ws::view_volume<double> volume = ws::perspective_volume(1.0, 1.0, 0.05, 400.0);
        const ws::frustum<double> frustum =
            ws::make_frustum(eye, glm::dvec3(1.0, -0.12, 0.1), glm::dvec3(0.0, 1.0, 0.0), volume)
                .value;
        draw.set("camera", glm::mat4(ws::projection_matrix(volume, ws::clip::opengl) *
                                     ws::view_matrix(frustum, ws::clip::opengl)));
        draw.set("eye", glm::vec3(eye));
        const glm::dvec3 sun(0.6, -1.0, 0.35);
        struct {
            glm::mat4 full, matrix;
            glm::vec4 position;
        } block;
        block.full = block.matrix = glm::mat4(
            ws::directional_light_matrix(ws::sun(sun), world.box, ws::clip::opengl).matrix);
        block.position = glm::vec4(-glm::vec3(glm::normalize(sun)), 0.0f);
        light = gl::buffer(sizeof block, &block, GL_DYNAMIC_DRAW);
        light.bind_base(GL_SHADER_STORAGE_BUFFER, 4);
        light.bind_base(GL_UNIFORM_BUFFER, 4);
        normals = gl::buffer(std::span<const glm::vec4>(world.normals));
        normals.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    }

    void draw_view() {
        target.bind();
        glEnable(GL_DEPTH_TEST);
        glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        draw.use();
        mesh.draw();
    }

    passes_scene::scene world = passes_scene::make_scene();
    gl::mesh mesh{world.positions, world.triangles};
    gl::buffer normals, light;
    gl::texture position{GL_RGBA32F, view, view}, normal{GL_RGBA32F, view, view},
        depth{GL_DEPTH_COMPONENT32F, view, view};
    gl::framebuffer target{{&position, &normal}, &depth};
    gl::program draw{{{GL_VERTEX_SHADER, library().compose(g_buffer_vertex, "vertex")},
                      {GL_FRAGMENT_SHADER, library().compose(g_buffer_fragment, "fragment")}}};
    gl::stopwatch watch{gl::best_timing()};
};

/// The steps of one way to build the tables, each timed.
struct pipeline {
    std::string name;
    std::vector<std::pair<std::string, std::function<void()>>> steps;
    std::vector<std::vector<double>> times; ///< per step
    std::vector<double> sums;
};

/// Counts and tables of one size.
struct tables {
    explicit tables(int cells)
        : counts(GL_R32UI, cells, cells), rows(GL_R32F, cells + 1, cells),
          columns(GL_R32F, cells + 1, cells) {}
    gl::texture counts, rows, columns;
};

struct programs {
    static gl::program splat(bool columns, bool subset) {
        return compute("#define WS_SPLAT_MERGED\n" +
                       std::string(subset ? "#define WS_SPLAT_SUBSET\n" : "") +
                       (columns ? "#define WS_SPLAT_COLUMNS\n#define WS_BINDING_ROWS 2\n" : "") +
                       view_samples +
                       "#include \"warpshadow/importance.glsl\"\n"
                       "#include \"warpshadow/warp.glsl\"\n#include \"passes/splat.glsl\"\n");
    }
    gl::program find =
        compute(std::string("#define FULL_MAP\n#define WS_BINDING_DESIRED_VIEW 5\n") +
                view_samples + "#include \"passes/desired_view.glsl\"\n");
    std::array<gl::program, 2> splat_rows{splat(false, false), splat(false, true)}; // all, subset
    std::array<gl::program, 2> splat_columns{splat(true, false), splat(true, true)};
    gl::program sums = compute("#include \"passes/column_sums.glsl\"\n");
    gl::program build = compute("#include \"warpshadow/warp_build.glsl\"\n"
                                "#include \"passes/build_axis.glsl\"\n");
    gl::program crop = compute(R"(
#include "warpshadow/fit.glsl"
layout(local_size_x = 1) in;
layout(std430, binding = 4) buffer light_buffer { mat4 light_full; mat4 light_matrix; };
layout(std430, binding = 5) readonly buffer desired_view { uint lo_bits[2]; uint hi_bits[2]; };
void main()
{
    vec2 lo = vec2(0.0);
    vec2 hi = vec2(1.0);
    if (lo_bits[0] <= hi_bits[0]) {
        ws_widen_side(uintBitsToFloat(lo_bits[0]), uintBitsToFloat(hi_bits[0]), 0.001, lo.x, hi.x);
        ws_widen_side(uintBitsToFloat(lo_bits[1]), uintBitsToFloat(hi_bits[1]), 0.001, lo.y, hi.y);
    }
    vec2 scale = 1.0 / (hi - lo);
    vec2 shift = (1.0 - 2.0 * lo) * scale - 1.0;
    mat4 cropped = light_full;
    for (int column = 0; column < 4; ++column) {
        cropped[column].xy = scale * cropped[column].xy + shift * cropped[column].w;
    }
    light_matrix = cropped;
}
)");
};

/// Each texel's centre by itself: two bisections.
constexpr const char* unwarp_each = R"(
layout(local_size_x = 16, local_size_y = 8) in;
layout(rg32f, binding = 0) uniform writeonly image2D centres;
layout(binding = WS_BINDING_ROWS) uniform sampler2D rows;
layout(binding = WS_BINDING_COLUMNS) uniform sampler2D columns;
void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, imageSize(centres)))) {
        vec2 q = (vec2(texel) + 0.5) / vec2(imageSize(centres));
        imageStore(centres, texel, vec4(ws_unwarp(rows, columns, q), 0.0, 0.0));
    }
}
)";

/// Inverse of all texel centres of a map; `strip` texels of a column by each invocation, 0 for a
/// search of its own for each texel.
pipeline make_centres(std::list<gl::program>& kept, std::list<gl::texture>& maps, tables& from,
                      int map, int strip) {
    const std::string bindings = "#define WS_BINDING_ROWS 2\n#define WS_BINDING_COLUMNS 3\n"
                                 "#include \"warpshadow/warp.glsl\"\n";
    const gl::program& unwarp = kept.emplace_back(
        strip > 0 ? compute("#define WS_CENTRES_STRIP " + std::to_string(strip) + "\n" + bindings +
                            "#include \"passes/unwarp_centres.glsl\"\n")
                  : compute(bindings + unwarp_each));
    const gl::texture& centres = maps.emplace_back(GL_RG32F, map, map);
    pipeline result;
    result.name = "centres " + std::to_string(map) + " of " + std::to_string(from.counts.width()) +
                  (strip > 0 ? ", strips of " + std::to_string(strip) : ", bisection");
    result.steps = {{"centres", [&unwarp, &centres, &from, map, strip] {
                         from.rows.bind(2);
                         from.columns.bind(3);
                         centres.bind_image(0, GL_WRITE_ONLY);
                         unwarp.dispatch(map, strip > 0 ? (map + strip - 1) / strip : map);
                         wait_for_writes();
                     }}};
    result.times.resize(result.steps.size());
    return result;
}

int blocks_along(int every) {
    return (view + 2 * every - 1) / (2 * every);
}

pipeline make_pipeline(const programs& run, gl::buffer& bounds, tables& to, int every) {
    const int cells = to.counts.width();
    const auto splat = [&to, every](const std::array<gl::program, 2>& of) {
        const gl::program& with = of[every > 1 ? 1 : 0];
        to.counts.clear(glm::uvec4(0u));
        to.counts.bind_image(0, GL_READ_WRITE);
        with.set("ws_every", every);
        with.dispatch(blocks_along(every), blocks_along(every));
        wait_for_writes();
    };
    const auto build = [&run, &to, cells](const gl::texture& table) {
        to.counts.bind_image(0, GL_READ_WRITE);
        run.sums.dispatch(cells);
        wait_for_writes();
        table.bind_image(1, GL_WRITE_ONLY);
        run.build.set("ws_radius", ws::window_radius(0.12f, cells));
        run.build.set("ws_floor", std::max(0.2f, 4.0f * ws::smallest_floor<float, float>(cells)));
        run.build.use();
        glDispatchCompute(static_cast<GLuint>(cells), 1, 1);
        wait_for_writes();
    };
    pipeline result;
    result.name = "tables " + std::to_string(cells) + ", every " + std::to_string(every);
    result.steps = {
        {"view",
         [&run, &bounds] {
             const std::array<std::uint32_t, 4> empty{0x7f800000u, 0x7f800000u, 0u, 0u};
             bounds.write(0, sizeof empty, empty.data());
             run.find.dispatch((view + 3) / 4, (view + 3) / 4);
             wait_for_writes();
             run.crop.dispatch(1);
             wait_for_writes();
         }},
        {"splat u", [splat, &run] { splat(run.splat_rows); }},
        {"build u", [build, &to] { build(to.rows); }},
        {"splat v",
         [splat, &run, &to] {
             to.rows.bind(2);
             splat(run.splat_columns);
         }},
        {"build v", [build, &to] { build(to.columns); }},
    };
    result.times.resize(result.steps.size());
    return result;
}

/// Runs one pipeline and returns the sum of its steps in milliseconds.
double time_once(pipeline& each, gl::stopwatch& watch) {
    double sum = 0.0;
    for (std::size_t i = 0; i < each.steps.size(); ++i) {
        watch.start();
        each.steps[i].second();
        each.times[i].push_back(watch.stop());
        sum += each.times[i].back();
    }
    each.sums.push_back(sum);
    return sum;
}

/// What was measured, times as ratios to the G-buffer pass.
nlohmann::ordered_json json_of(const std::vector<pipeline>& all,
                               const std::vector<std::vector<double>>& ratios, double g_buffer) {
    nlohmann::ordered_json lines = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < all.size(); ++i) {
        nlohmann::ordered_json line;
        line["name"] = all[i].name;
        line["ratio"] = median(ratios[i]);
        for (std::size_t k = 0; k < all[i].steps.size(); ++k) {
            line["steps"][all[i].steps[k].first] = median(all[i].times[k]) / g_buffer;
        }
        lines.push_back(line);
    }
    return lines;
}

int run(int rounds, const std::string& part, const char* file) {
    const gl::headless_context context;
    large_scene b;
    b.draw_view();
    b.position.bind(0);
    b.normal.bind(1);
    gl::buffer bounds(16, nullptr, GL_DYNAMIC_DRAW);
    bounds.bind_base(GL_SHADER_STORAGE_BUFFER, 5);
    const programs with;
    std::list<tables> sizes;
    std::vector<pipeline> all;
    for (const int cells : {64, 128, 256, 512, 1024, 2048, 4096}) {
        tables& to = sizes.emplace_back(cells);
        for (const int every : {1, 2, 4}) {
            pipeline made = make_pipeline(with, bounds, to, every);
            if ((cells <= 512 || every == 1) && made.name.find(part) != std::string::npos) {
                all.push_back(std::move(made));
            }
        }
    }
    const std::size_t table_lines = all.size();
    std::list<gl::program> kept;
    std::list<gl::texture> maps;
    for (tables& from : sizes) {
        const int cells = from.counts.width();
        pipeline fill = make_pipeline(with, bounds, from, 1);
        for (const int strip : {0, 8, 16, 32}) {
            pipeline made = make_centres(kept, maps, from, cells, strip);
            if (cells >= 512 && cells <= 2048 && made.name.find(part) != std::string::npos) {
                if (!fill.steps.empty()) {
                    time_once(fill, b.watch);
                    fill.steps.clear();
                }
                all.push_back(std::move(made));
            }
        }
    }
    std::size_t covered = 0;
    for (const glm::vec4& p : b.position.read<glm::vec4>()) {
        covered += p.w != 0.0f ? 1 : 0;
    }
    std::printf("%s, %zu triangles, %d x %d pixels, %.0f %% of them covered, %s, %d rounds\n",
                context.info().renderer.c_str(), b.world.triangles.size(), view, view,
                100.0 * static_cast<double>(covered) / (view * view),
                gl::timing_name(gl::best_timing()), rounds);

    std::vector<double> g_buffer;
    std::vector<std::vector<double>> ratios(all.size());
    for (int round = -1; round < rounds; ++round) { // the first warms up
        b.watch.start();
        b.draw_view();
        const double drawn = b.watch.stop();
        for (std::size_t i = 0; i < all.size(); ++i) {
            ratios[i].push_back(time_once(all[i], b.watch) / drawn);
        }
        g_buffer.push_back(drawn);
        if (round < 0) {
            g_buffer.clear();
            for (std::size_t i = 0; i < all.size(); ++i) {
                ratios[i].clear();
                all[i].sums.clear();
                all[i].times.assign(all[i].steps.size(), {});
            }
        }
    }
    gl::check("passes_bench");
    std::printf("G-buffer pass: %.2f ms\n%-26s", median(g_buffer), "ms");
    for (const char* name : {"view", "splat u", "build u", "splat v", "build v", "sum", "ratio"}) {
        std::printf("%9s", name);
    }
    std::printf("\n");
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i == table_lines) {
            std::printf("%-36s%9s%9s\n", "centres of texels", "ms", "ratio");
        }
        if (i >= table_lines) {
            std::printf("%-36s%9.2f%9.3f\n", all[i].name.c_str(), median(all[i].sums),
                        median(ratios[i]));
            continue;
        }
        std::printf("%-26s", all[i].name.c_str());
        for (const std::vector<double>& times : all[i].times) {
            std::printf("%9.2f", median(times));
        }
        std::printf("%9.2f%9.3f\n", median(all[i].sums), median(ratios[i]));
    }
    if (file != nullptr) {
        nlohmann::ordered_json json;
        json["renderer"] = context.info().renderer;
        json["triangles"] = b.world.triangles.size();
        json["view"] = view;
        json["rounds"] = rounds;
        json["g_buffer_ms"] = median(g_buffer);
        json["lines"] = json_of(all, ratios, median(g_buffer));
        std::ofstream out(file);
        out << json.dump(1) << '\n';
        if (!out.flush()) {
            std::fprintf(stderr, "passes_bench: cannot write %s\n", file);
            return 1;
        }
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    constexpr const char* usage = "passes_bench [ROUNDS [PART OF A LINE'S NAME [FILE.json]]]";
    bench::expect_values(argc, argv, 3, usage);
    int rounds = 11;
    const std::string_view first = argc > 1 ? argv[1] : "11";
    const auto [rest, error] = std::from_chars(first.data(), first.data() + first.size(), rounds);
    if (error != std::errc() || rest != first.data() + first.size() || rounds < 1) {
        std::fprintf(stderr, "usage: %s\n", usage);
        return 2;
    }
    try {
        return run(rounds, argc > 2 ? argv[2] : "", argc > 3 ? argv[3] : nullptr);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "passes_bench: %s\n", problem.what());
        return 1;
    }
}
