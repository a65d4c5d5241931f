// The compute passes on whatever OpenGL there is, against the same steps on the host.
#include "gl/context.hpp"
#include "gl/objects.hpp"
#include "passes/compute_pass.hpp"

#include <warpshadow/fit.hpp>
#include <warpshadow/tessellation.hpp>
#include <warpshadow/warp_build.hpp>

#include <catch2/catch.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace ws = warpshadow;

namespace {

/// View samples in a buffer; those with z = 0 stand for background and unlit surfaces.
constexpr const char* view_samples = R"(
layout(std430, binding = 1) readonly buffer sample_buffer { vec4 sample_list[]; };
uniform ivec2 view_size;
ivec2 ws_view_size() { return view_size; }
bool ws_view_sample(ivec2 pixel, out vec2 p)
{
    vec4 s = sample_list[pixel.y * view_size.x + pixel.x];
    p = s.xy;
    return s.z != 0.0;
}
)";

struct view {
    glm::ivec2 size;
    std::vector<glm::vec4> all;
    std::vector<glm::vec2> lit; ///< what the passes should count
};

/// Clustered samples, some on the border, some outside, some not lit.
view make_view(glm::ivec2 size, unsigned seed) {
    view result{size, {}, {}};
    std::mt19937 random(seed);
    std::normal_distribution<float> near_centre(0.3f, 0.07f);
    std::uniform_real_distribution<float> anywhere(-0.02f, 1.02f);
    for (int i = 0; i < size.x * size.y; ++i) {
        glm::vec2 p(near_centre(random), near_centre(random));
        if (i % 5 == 0) {
            p = glm::vec2(anywhere(random), anywhere(random));
        } else if (i % 997 == 1) {
            p = glm::vec2(i % 2 == 0 ? 0.0f : 1.0f, 1.0f);
        }
        const bool lit = i % 11 != 3;
        result.all.emplace_back(p, lit ? 1.0f : 0.0f, 0.0f);
        if (lit) {
            result.lit.push_back(p);
        }
    }
    return result;
}

/// Distance in units of the last place of 1, the scale of a table.
float ulps_of_one(float a, float b) {
    return std::abs(a - b) / std::numeric_limits<float>::epsilon();
}

struct device_axis {
    std::vector<std::uint32_t> counts;
    std::vector<float> table;
};

/// Nodes of a table of either format.
std::vector<float> nodes_of(const gl::texture& table) {
    if (table.format() == GL_R32F) {
        return table.read<float>();
    }
    std::vector<float> nodes;
    for (const std::uint16_t node : table.read<std::uint16_t>()) {
        nodes.push_back(static_cast<float>(node) / 65535.0f);
    }
    return nodes;
}

/// Splats and builds one axis; `rows` is the table of the first axis or null.
device_axis build_on_device(const view& samples, int size, int radius, float floor,
                            const gl::texture* rows, gl::texture& table) {
    const std::string splat_text =
        std::string(rows != nullptr ? "#define WS_SPLAT_COLUMNS\n" : "") + view_samples +
        "#include \"warpshadow/importance.glsl\"\n#include \"warpshadow/warp.glsl\"\n"
        "#include \"passes/splat.glsl\"\n";
    const gl::program splat = pass(splat_text);
    const gl::program sums = pass("#include \"passes/column_sums.glsl\"\n");
    const gl::program build =
        pass(std::string(table.format() == GL_R16 ? "#define WS_TABLE_FORMAT r16\n" : "") +
             "#include \"warpshadow/warp_build.glsl\"\n#include \"passes/build_axis.glsl\"\n");

    const gl::buffer list(std::span<const glm::vec4>(samples.all));
    gl::texture counts(GL_R32UI, size, size);
    counts.clear(glm::uvec4(0u));
    list.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
    counts.bind_image(0, GL_READ_WRITE);
    if (rows != nullptr) {
        rows->bind(0);
    }
    splat.set("view_size", samples.size);
    splat.dispatch(samples.size.x, samples.size.y);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    device_axis result;
    result.counts = counts.read<std::uint32_t>();

    sums.dispatch(size);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    table.bind_image(1, GL_WRITE_ONLY);
    build.set("ws_radius", radius);
    build.set("ws_floor", floor);
    build.use();
    glDispatchCompute(static_cast<GLuint>(size), 1, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    result.table = nodes_of(table);
    return result;
}

std::vector<float> build_on_host(std::vector<std::uint32_t> counts, int size,
                                 const ws::build_options<float>& options) {
    std::vector<std::uint64_t> scratch(static_cast<std::size_t>(size));
    std::vector<float> nodes(static_cast<std::size_t>(size) * (static_cast<std::size_t>(size) + 1));
    const ws::table_span<float> out{nodes, size, size};
    const ws::build_result<float> built =
        ws::build_axis(ws::count_view(counts, size, size), options, std::span(scratch), out);
    REQUIRE_FALSE(ws::any(built.flags, ws::status::buffer_too_small));
    return nodes;
}

void compare_tables(const std::vector<float>& device, const std::vector<float>& host, int size) {
    REQUIRE(device.size() == host.size());
    const std::size_t stride = static_cast<std::size_t>(size) + 1;
    float worst = 0.0f;
    bool monotone = true;
    bool ends_exact = true;
    for (std::size_t row = 0; row < static_cast<std::size_t>(size); ++row) {
        for (std::size_t k = 0; k < stride; ++k) {
            worst = std::max(worst, ulps_of_one(device[row * stride + k], host[row * stride + k]));
            monotone =
                monotone && (k == 0 || device[row * stride + k] > device[row * stride + k - 1]);
        }
        ends_exact =
            ends_exact && device[row * stride] == 0.0f && device[row * stride + stride - 1] == 1.0f;
    }
    // float on the device against double rounded once: the quotient k / w, the excess, its product
    // with 1 - floor and the sum round once each, and a GPU's division may be off by 2.5 ulp twice
    CHECK(worst <= 6.0f);
    CHECK(monotone);
    CHECK(ends_exact);
}

} // namespace

TEST_CASE("passes: tables of 16 bits are those of the host to half a step, and increase") {
    const gl::headless_context context;
    for (const int size : {2, 17, 128, 512}) {
        DYNAMIC_SECTION("map of " << size) {
            const view samples = make_view({257, 193}, static_cast<unsigned>(size));
            ws::build_options<float> options;
            // of the storage, and what the device's float may be off by at both nodes
            options.floor = ws::smallest_floor<float, std::uint16_t>(size) +
                            4.0f * ws::smallest_floor<float, float>(size);
            const int radius = ws::window_radius(options.window, size);
            gl::texture table(GL_R16, size + 1, size);
            const device_axis built =
                build_on_device(samples, size, radius, options.floor, nullptr, table);
            const std::vector<float> host = build_on_host(built.counts, size, options);
            const std::size_t stride = static_cast<std::size_t>(size) + 1;
            float worst = 0.0f;
            bool monotone = true;
            for (std::size_t i = 0; i < host.size(); ++i) {
                worst = std::max(worst, std::abs(built.table[i] - host[i]) * 65535.0f);
                monotone = monotone && (i % stride == 0 || built.table[i] > built.table[i - 1]);
                if (i % stride == 0 || i % stride == stride - 1) {
                    REQUIRE(built.table[i] == (i % stride == 0 ? 0.0f : 1.0f));
                }
            }
            CHECK(worst < 0.5f + 0.1f); // 6 ulps of 1 are a twentieth of a step
            CHECK(monotone);
        }
    }
}

TEST_CASE("passes: tables of the device are those of the host") {
    const gl::headless_context context;
    for (const int size : {1, 2, 3, 17, 64, 100, 128, 129, 512, 1000}) {
        DYNAMIC_SECTION("map of " << size) {
            const view samples = make_view({257, 193}, static_cast<unsigned>(size));
            const ws::build_options<float> options;
            const int radius = ws::window_radius(options.window, size);
            const float floor = options.floor;

            gl::texture rows(GL_R32F, size + 1, size);
            const device_axis first = build_on_device(samples, size, radius, floor, nullptr, rows);
            std::vector<std::uint32_t> counts(static_cast<std::size_t>(size) *
                                              static_cast<std::size_t>(size));
            ws::splat(std::span<const glm::vec2>(samples.lit), ws::count_map{counts, size, size});
            CHECK(first.counts == counts);
            compare_tables(first.table, build_on_host(first.counts, size, options), size);

            gl::texture columns(GL_R32F, size + 1, size);
            const device_axis second =
                build_on_device(samples, size, radius, floor, &rows, columns);
            std::fill(counts.begin(), counts.end(), 0u);
            const ws::table_view<float> host_rows{first.table, size, size};
            const ws::splat_result counted =
                ws::splat_columns(std::span<const glm::vec2>(samples.lit), host_rows,
                                  ws::count_map{counts, size, size});
            std::uint64_t moved = 0;
            std::uint64_t total = 0;
            for (std::size_t i = 0; i < counts.size(); ++i) {
                moved += counts[i] > second.counts[i] ? counts[i] - second.counts[i]
                                                      : second.counts[i] - counts[i];
                total += second.counts[i];
            }
            CHECK(total == counted.counted);
            // a sample within rounding of a cell's edge, 4 ulp of 1 out of 1 / size, may change
            // sides
            const double expected = 2.0 * 4.0 * 1.2e-7 * size * static_cast<double>(total);
            CHECK(static_cast<double>(moved) <= 16.0 + 4.0 * expected);
            compare_tables(second.table, build_on_host(second.counts, size, options), size);

            gl::texture centres(GL_RG32F, size, size);
            rows.bind(0);
            columns.bind(1);
            centres.bind_image(0, GL_WRITE_ONLY);
            const gl::program unwarp = pass(
                "#include \"warpshadow/warp.glsl\"\n#include \"passes/unwarp_centres.glsl\"\n");
            unwarp.dispatch(size, size);
            glMemoryBarrier(GL_ALL_BARRIER_BITS);
            const std::vector<glm::vec2> device_centres = centres.read<glm::vec2>();
            const ws::table_view<float> host_columns{second.table, size, size};
            // judged by what it achieves: warped again it is the centre, up to the roundings of p
            // (an ulp of 1 from each of the four steps of either search) that the warp magnifies
            // there
            double worst = 0.0;
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x) {
                    const glm::vec2 q = (glm::vec2(x, y) + 0.5f) / static_cast<float>(size);
                    const glm::vec2 p = device_centres[static_cast<std::size_t>(y) *
                                                           static_cast<std::size_t>(size) +
                                                       static_cast<std::size_t>(x)];
                    const glm::vec2 back = ws::warp(host_rows, host_columns, p);
                    const glm::mat2 j = ws::jacobian(host_rows, host_columns, p);
                    const double growth =
                        static_cast<double>(1.0f + std::abs(j[0][0]) + std::abs(j[0][1]) +
                                            std::abs(j[1][0]) + std::abs(j[1][1]));
                    worst = std::max(worst, static_cast<double>(glm::distance(back, q)) / growth);
                }
            }
            CHECK(worst <= 8.0 * static_cast<double>(std::numeric_limits<float>::epsilon()));
        }
    }
}

TEST_CASE(
    "passes: tessellation factors of the device are those of the host, on both sides of edges") {
    const gl::headless_context context;
    static const gl::shader_library library{gl::glsl_files()};
    const auto stage = [&](GLenum type, const std::string& text) {
        return gl::stage{type, library.compose("#version 430 core\n" + text, "stage")};
    };
    const gl::program draw(
        {stage(GL_VERTEX_SHADER,
               "layout(std430, binding = 1) readonly buffer corners { vec4 corner[]; };\n"
               "out vec3 ws_map_place;\n"
               "void main() { ws_map_place = corner[gl_VertexID].xyz; }\n"),
         stage(GL_TESS_CONTROL_SHADER, "#include \"warpshadow/warp.glsl\"\n"
                                       "#include \"warpshadow/edge_walk.glsl\"\n"
                                       "#include \"warpshadow/tessellation.glsl\"\n"
                                       "#include \"passes/tessellation_control.glsl\"\n"),
         stage(GL_TESS_EVALUATION_SHADER, "#include \"warpshadow/warp.glsl\"\n"
                                          "#include \"passes/tessellation_evaluation.glsl\"\n"),
         stage(GL_FRAGMENT_SHADER, "void main() {}\n")});
    CHECK(draw.id() != 0); // the stages link; their factors are those of the function below
    const gl::program measure = pass(
        "layout(local_size_x = 64) in;\n#include \"warpshadow/warp.glsl\"\n"
        "#include \"warpshadow/edge_walk.glsl\"\n#include \"warpshadow/tessellation.glsl\"\n"
        "layout(std430, binding = 1) readonly buffer corners { vec4 corner[]; };\n"
        "layout(std430, binding = 2) writeonly buffer levels { vec4 level[]; };\n"
        "layout(binding = 0) uniform sampler2D rows;\n"
        "layout(binding = 1) uniform sampler2D columns;\n"
        "uniform float allowed;\n"
        "void main() {\n"
        "    uint i = gl_GlobalInvocationID.x;\n"
        "    if (i < uint(level.length())) {\n"
        "        vec4 found = vec4(0.0);\n"
        "        for (uint k = 0u; k < 3u; ++k) {\n"
        "            found[k] = float(ws_edge_segments(rows, columns,\n"
        "                corner[3u * i + (k + 1u) % 3u].xy, corner[3u * i + (k + 2u) % 3u].xy,\n"
        "                allowed, 32));\n"
        "        }\n"
        "        found.w = max(found.x, max(found.y, found.z));\n"
        "        level[i] = found;\n"
        "    }\n"
        "}\n");
    const int size = 48;
    const view samples = make_view({97, 61}, 5);
    const auto cells = static_cast<std::size_t>(size);
    std::vector<std::uint32_t> counts(cells * cells);
    std::vector<std::uint64_t> scratch(cells);
    std::vector<float> row_nodes(cells * (cells + 1));
    std::vector<float> column_nodes(cells * (cells + 1));
    const ws::warp_result<float> warp =
        ws::build_warp<float, float>(samples.lit, {.window = 0.3f, .floor = 0.2f},
                                     {size, counts, scratch, row_nodes, column_nodes});
    gl::texture rows(GL_R32F, size + 1, size);
    gl::texture columns(GL_R32F, size + 1, size);
    rows.write(row_nodes.data());
    columns.write(column_nodes.data());
    rows.bind(0);
    columns.bind(1);

    // a net of triangles over the map with moved corners; llvmpipe counts 340 patches right
    const int across = 12;
    std::mt19937 random(11);
    std::uniform_real_distribution<float> shift(-0.3f, 0.3f);
    std::vector<glm::vec4> net;
    for (int i = 0; i < (across + 1) * (across + 1); ++i) {
        const glm::vec2 p((static_cast<float>(i % (across + 1)) + shift(random)) / across,
                          (static_cast<float>(i / (across + 1)) + shift(random)) / across);
        net.emplace_back(glm::clamp(p, 0.0f, 1.0f), 0.5f, 0.0f);
    }
    std::vector<glm::vec4> corners;
    for (int y = 0; y < across; ++y) {
        for (int x = 0; x < across; ++x) {
            const int first = y * (across + 1) + x;
            for (const int i : {0, 1, across + 2, 0, across + 2, across + 1}) {
                corners.push_back(net[static_cast<std::size_t>(first + i)]);
            }
        }
    }
    const std::size_t patches = corners.size() / 3;
    const gl::buffer corner_buffer{std::span<const glm::vec4>(corners)};
    gl::buffer levels(patches * sizeof(glm::vec4), nullptr, GL_DYNAMIC_COPY);
    levels.fill(0);
    const float allowed = 0.25f / 512.0f;
    corner_buffer.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
    levels.bind_base(GL_SHADER_STORAGE_BUFFER, 2);
    measure.set("allowed", allowed);
    measure.dispatch(static_cast<int>(patches));
    gl::wait_for_writes();
    const std::vector<glm::vec4> device = levels.read<glm::vec4>();
    gl::check("tessellation");

    std::map<std::array<float, 4>, float> of_edge;
    int cut = 0;
    int shared = 0;
    for (std::size_t i = 0; i < patches; ++i) {
        float most = 0.0f;
        for (int k = 0; k < 3; ++k) {
            const auto corner = [&](int c) {
                return glm::vec2(corners[3 * i + static_cast<std::size_t>(c % 3)]);
            };
            glm::vec2 a = corner(k + 1);
            glm::vec2 b = corner(k + 2);
            const float level = device[i][k];
            most = std::max(most, level);
            CAPTURE(i, k, level);
            // what the device rounds otherwise may tip a bound over what is allowed
            const float one = 1e-6f;
            const int least = ws::edge_segments(warp.rows, warp.columns, a, b, allowed + one, 32);
            const int largest = ws::edge_segments(warp.rows, warp.columns, a, b, allowed - one, 32);
            CHECK(level >= static_cast<float>(least));
            CHECK(level <= static_cast<float>(largest));
            cut += level > 1.0f ? 1 : 0;
            if (b.x < a.x || (b.x == a.x && b.y < a.y)) {
                std::swap(a, b);
            }
            const auto [found, fresh] = of_edge.try_emplace({a.x, a.y, b.x, b.y}, level);
            CHECK(found->second == level);
            shared += fresh ? 0 : 1;
        }
        CHECK(device[i][3] == most);
    }
    CHECK(cut > 40);
    CHECK(shared == across * across + 2 * across * (across - 1));
}

TEST_CASE("passes: an empty view gives the identity") {
    const gl::headless_context context;
    view nothing{{16, 16}, std::vector<glm::vec4>(256, glm::vec4(0.5f, 0.5f, 0.0f, 0.0f)), {}};
    const int size = 96;
    gl::texture rows(GL_R32F, size + 1, size);
    const device_axis built = build_on_device(nothing, size, 5, 0.2f, nullptr, rows);
    for (int row = 0; row < size; ++row) {
        for (int k = 0; k <= size; ++k) {
            const float node = built.table[static_cast<std::size_t>(row * (size + 1) + k)];
            REQUIRE(ulps_of_one(node, static_cast<float>(k) / static_cast<float>(size)) <= 1.25f);
        }
    }
}

TEST_CASE("passes: desired view is that of the host") {
    const gl::headless_context context;
    const gl::program find =
        pass(std::string(view_samples) + "#include \"passes/desired_view.glsl\"\n");
    const std::uint32_t infinity =
        std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(5, 3), glm::ivec2(640, 479)}) {
        view samples = make_view(size, static_cast<unsigned>(size.x));
        samples.all.front().x = -0.0f; // a negative zero is inside, and the least there is
        samples.all.front().z = 1.0f;
        samples.lit.emplace_back(samples.all.front());
        const gl::buffer list(std::span<const glm::vec4>(samples.all));
        const std::array<std::uint32_t, 4> start{infinity, infinity, 0u, 0u};
        const gl::buffer bounds(sizeof start, start.data());
        list.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
        bounds.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        find.set("view_size", size);
        find.dispatch((size.x + 3) / 4, (size.y + 3) / 4);
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        const std::vector<float> device = bounds.read<float>();

        glm::vec2 lo(std::numeric_limits<float>::infinity());
        glm::vec2 hi(0.0f);
        for (const glm::vec2& p : samples.lit) {
            if (p.x >= 0.0f && p.x <= 1.0f && p.y >= 0.0f && p.y <= 1.0f) {
                lo = glm::min(lo, p);
                hi = glm::max(hi, p);
            }
        }
        CHECK(device[0] == lo.x);
        CHECK(device[1] == lo.y);
        CHECK(device[2] == hi.x);
        CHECK(device[3] == hi.y);
    }
}

TEST_CASE("passes: every way to splat counts the same samples") {
    const gl::headless_context context;
    GLint extensions = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &extensions);
    int found = 0;
    for (GLint i = 0; i < extensions; ++i) {
        const std::string name(
            reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))));
        found += name == "GL_ARB_shader_ballot" || name == "GL_ARB_gpu_shader_int64" ? 1 : 0;
    }
    struct way {
        std::string head;
        int per_side; ///< samples along a side of what an invocation takes
    };
    std::vector<way> ways{{"", 1}, {"#define WS_SPLAT_MERGED\n", 2}};
    if (found == 2) {
        ways.push_back({"#extension GL_ARB_shader_ballot : require\n"
                        "#extension GL_ARB_gpu_shader_int64 : require\n"
                        "#define WS_SPLAT_BALLOT\n",
                        1});
    }
    for (const way& each : ways) {
        for (const int every : {0, 1, 2, 3, 4, 7}) { // 0: all of them, without the option
            const gl::program splat =
                pass(each.head + (every > 0 ? "#define WS_SPLAT_SUBSET\n" : "") + view_samples +
                     "#include \"warpshadow/importance.glsl\"\n#include \"passes/splat.glsl\"\n");
            for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(257, 193)}) {
                const view samples = make_view(size, 5u);
                const gl::buffer list(std::span<const glm::vec4>(samples.all));
                list.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
                const int block = std::max(every, 1);
                std::vector<glm::vec2> expected;
                for (int y = 0; y < size.y; ++y) {
                    for (int x = 0; x < size.x; ++x) {
                        const glm::ivec2 in_block(x % block, y % block);
                        const glm::ivec2 turn((y / block) % block, (x / block) % block);
                        const glm::vec4 s = samples.all[static_cast<std::size_t>(y * size.x + x)];
                        if (in_block == turn && s.z != 0.0f) {
                            expected.emplace_back(s);
                        }
                    }
                }
                for (const int cells : {1, 5, 64, 301}) {
                    gl::texture counts(GL_R32UI, cells, cells);
                    counts.clear(glm::uvec4(0u));
                    counts.bind_image(0, GL_READ_WRITE);
                    splat.set("view_size", size);
                    splat.set("ws_every", every);
                    const int side = block * each.per_side;
                    splat.dispatch((size.x + side - 1) / side, (size.y + side - 1) / side);
                    glMemoryBarrier(GL_ALL_BARRIER_BITS);

                    std::vector<std::uint32_t> host(static_cast<std::size_t>(cells * cells));
                    ws::splat(std::span<const glm::vec2>(expected),
                              ws::count_map{host, cells, cells});
                    INFO(each.head << "every " << every << ", " << size.x << " samples, " << cells
                                   << " cells");
                    CHECK(counts.read<std::uint32_t>() == host);
                }
            }
        }
    }
}

TEST_CASE("passes: tables of the largest size") {
    const gl::headless_context context;
    const int size = 4096;
    const view samples = make_view({640, 479}, 3u);
    const ws::build_options<float> options;
    gl::texture rows(GL_R32F, size + 1, size);
    const device_axis built = build_on_device(
        samples, size, ws::window_radius(options.window, size), options.floor, nullptr, rows);
    compare_tables(built.table, build_on_host(built.counts, size, options), size);
}
