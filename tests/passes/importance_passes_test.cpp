// The passes that weigh importance, on whatever OpenGL there is, against the same steps on the
// host.
#include "gl/context.hpp"
#include "gl/objects.hpp"
#include "passes/compute_pass.hpp"

#include <warpshadow/importance.hpp>
#include <warpshadow/rectilinear.hpp>
#include <warpshadow/second_axis.hpp>
#include <warpshadow/shadow_edges.hpp>
#include <warpshadow/warp_build.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace ws = warpshadow;

namespace {

/// View samples in a buffer: position in the map, weight in steps, class; class < 0 is unlit.
constexpr const char* weighted_samples = R"(
layout(std430, binding = 1) readonly buffer sample_buffer { vec4 sample_list[]; };
uniform ivec2 view_size;
ivec2 ws_view_size() { return view_size; }
vec4 own_sample(ivec2 pixel) { return sample_list[pixel.y * view_size.x + pixel.x]; }
bool ws_view_sample(ivec2 pixel, out vec2 p)
{
    vec4 s = own_sample(pixel);
    p = s.xy;
    return s.w >= 0.0;
}
uint ws_sample_weight(ivec2 pixel, vec2 p) { return uint(own_sample(pixel).z); }
int ws_sample_class(ivec2 pixel, vec2 p) { return int(own_sample(pixel).w); }
)";

/// A sample as the host's splats take it.
struct point {
    glm::vec2 p;
    float weight;
    int of_class;
};

struct view {
    glm::ivec2 size;
    std::vector<glm::vec4> all;
    std::vector<point> lit;
};

view make_view(glm::ivec2 size, unsigned seed) {
    view result{size, {}, {}};
    std::mt19937 random(seed);
    std::normal_distribution<float> near_centre(0.4f, 0.1f);
    std::uniform_int_distribution<int> weights(0, 50);
    for (int i = 0; i < size.x * size.y; ++i) {
        const glm::vec2 p(near_centre(random), near_centre(random));
        const int of_class = i % 13 == 4 ? -1 : i % 3 == 0 ? 1 : 0;
        const auto weight = static_cast<float>(weights(random));
        result.all.emplace_back(p, weight, static_cast<float>(of_class));
        if (of_class >= 0) {
            result.lit.push_back({p, weight, of_class});
        }
    }
    return result;
}

std::vector<std::uint32_t> random_counts(int cells, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::uint32_t> few(0u, 3u);
    std::vector<std::uint32_t> counts(squared(cells));
    for (std::uint32_t& count : counts) {
        count = few(random) == 0u ? static_cast<std::uint32_t>(random() >> 22u) : 0u;
    }
    return counts;
}

gl::texture image_of(const std::vector<std::uint32_t>& counts, int width, int height) {
    gl::texture image(GL_R32UI, width, height);
    image.write(counts.data());
    return image;
}

/// Where a function should be, in double: k / w plus what the importance adds.
std::vector<double> nodes_of(const std::vector<double>& importance, double floor) {
    double total = 0.0;
    for (const double each : importance) {
        total += each;
    }
    const auto cells = static_cast<double>(importance.size());
    std::vector<double> nodes{0.0};
    double before = 0.0;
    for (std::size_t k = 1; k <= importance.size(); ++k) {
        before += importance[k - 1];
        const double x = static_cast<double>(k) / cells;
        nodes.push_back(total > 0.0 ? x + (1.0 - floor) * (before / total - x) : x);
    }
    return nodes;
}

struct comparison {
    double worst = 0.0;
    bool monotone = true;
    bool ends_exact = true;
};

comparison compare(std::span<const float> table, const std::vector<double>& expected) {
    comparison result;
    for (std::size_t k = 0; k < expected.size(); ++k) {
        result.worst =
            std::max(result.worst, std::abs(static_cast<double>(table[k]) - expected[k]));
        result.monotone = result.monotone && (k == 0 || table[k] > table[k - 1]);
    }
    result.ends_exact = table[0] == 0.0f && table[expected.size() - 1] == 1.0f;
    return result;
}

/// Half a unit in the last place of 1.
constexpr double half_ulp = 0x1p-24;

} // namespace

TEST_CASE("passes: weighted samples add up, or leave the largest, as on the host") {
    const gl::headless_context context;
    const view samples = make_view({131, 67}, 11u);
    const gl::buffer list(std::span<const glm::vec4>(samples.all));
    list.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
    const auto weight = [](const point& each) { return each.weight; };
    for (const bool merged : {false, true}) {
        for (const bool largest : {false, true}) {
            for (const int cells : {1, 7, 64}) {
                CAPTURE(merged, largest, cells);
                const std::string head = std::string("#define WS_SPLAT_WEIGHTED\n") +
                                         (merged ? "#define WS_SPLAT_MERGED\n" : "") +
                                         (largest ? "#define WS_SPLAT_LARGEST\n" : "") +
                                         weighted_samples +
                                         "#include \"warpshadow/importance.glsl\"\n";
                const int side = merged ? 2 : 1;
                const auto count = [&](const gl::program& splat) {
                    gl::texture counts(GL_R32UI, cells, cells);
                    counts.clear(glm::uvec4(0u));
                    counts.bind_image(0, GL_READ_WRITE);
                    splat.set("view_size", samples.size);
                    splat.dispatch((samples.size.x + side - 1) / side,
                                   (samples.size.y + side - 1) / side);
                    gl::wait_for_writes();
                    return counts.read<std::uint32_t>();
                };
                const ws::cell_rule rule = largest ? ws::cell_rule::largest : ws::cell_rule::sum;
                std::vector<std::uint32_t> host(squared(cells));
                ws::splat_weighted(std::span<const point>(samples.lit), weight, 1.0f, rule,
                                   ws::count_map{host, cells, cells});
                CHECK(count(pass(head + "#include \"passes/splat.glsl\"\n")) == host);

                // rows that keep every sample where it is: no sample changes cells by rounding
                std::vector<float> identity{0.0f, 1.0f};
                gl::texture rows(GL_R32F, 2, 1);
                rows.write(identity.data());
                rows.bind(0);
                std::fill(host.begin(), host.end(), 0u);
                ws::splat_columns_weighted(std::span<const point>(samples.lit),
                                           ws::table_view<float>{identity, 1, 1}, weight, 1.0f,
                                           rule, ws::count_map{host, cells, cells});
                CHECK(count(pass("#define WS_SPLAT_COLUMNS\n" + head +
                                 "#include \"warpshadow/warp.glsl\"\n"
                                 "#include \"passes/splat.glsl\"\n")) == host);
            }
        }
    }
}

TEST_CASE("passes: each class of samples has an image of its own") {
    const gl::headless_context context;
    const view samples = make_view({131, 67}, 12u);
    const gl::buffer list(std::span<const glm::vec4>(samples.all));
    list.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
    const int cells = 33;
    const gl::program splat =
        pass(std::string("#define WS_SPLAT_CLASSES 2\n") + weighted_samples +
             "#include \"warpshadow/importance.glsl\"\n#include \"passes/splat.glsl\"\n");
    gl::texture counts(GL_R32UI, cells, 2 * cells);
    counts.clear(glm::uvec4(0u));
    counts.bind_image(0, GL_READ_WRITE);
    splat.set("view_size", samples.size);
    splat.dispatch(samples.size.x, samples.size.y);
    gl::wait_for_writes();
    std::vector<std::uint32_t> host;
    for (const int of_class : {0, 1}) {
        std::vector<glm::vec2> own;
        for (const point& each : samples.lit) {
            if (each.of_class == of_class) {
                own.push_back(each.p);
            }
        }
        std::vector<std::uint32_t> image(squared(cells));
        ws::splat(std::span<const glm::vec2>(own), ws::count_map{image, cells, cells});
        host.insert(host.end(), image.begin(), image.end());
    }
    CHECK(counts.read<std::uint32_t>() == host);
}

TEST_CASE("passes: cells of lit and dark samples weigh what they should") {
    const gl::headless_context context;
    const int cells = 37;
    std::vector<std::uint32_t> counts = random_counts(cells, 1u);
    const std::vector<std::uint32_t> dark = random_counts(cells, 2u);
    counts.insert(counts.end(), dark.begin(), dark.end());
    const gl::program weigh =
        pass("#include \"warpshadow/importance.glsl\"\n#include \"passes/weigh_cells.glsl\"\n");
    const gl::texture classes = image_of(counts, cells, 2 * cells);
    const gl::texture importance(GL_R32UI, cells, cells);
    classes.bind_image(0, GL_READ_ONLY);
    importance.bind_image(1, GL_WRITE_ONLY);
    weigh.set("ws_share", 0.125f); // exact in all that follows
    weigh.set("ws_steps", 64.0f);
    weigh.dispatch(cells, cells);
    gl::wait_for_writes();
    std::vector<std::uint32_t> host;
    for (std::size_t i = 0; i < squared(cells); ++i) {
        const std::uint32_t lit = counts[i];
        host.push_back(8 * (lit + dark[i]) + 64 * std::min(lit, dark[i]));
    }
    CHECK(importance.read<std::uint32_t>() == host);
}

TEST_CASE("passes: lines of the device are those of the host") {
    const gl::headless_context context;
    for (const bool largest : {false, true}) {
        const gl::program collapse =
            pass(std::string(largest ? "#define WS_COLLAPSE_LARGEST\n" : "") +
                 "#include \"passes/collapse.glsl\"\n");
        for (const int cells : {1, 31, 128, 300}) {
            CAPTURE(largest, cells);
            const std::vector<std::uint32_t> counts =
                random_counts(cells, static_cast<unsigned>(cells));
            const gl::texture image = image_of(counts, cells, cells);
            const gl::texture lines(GL_R32UI, cells, 2);
            image.bind_image(0, GL_READ_ONLY);
            lines.bind_image(1, GL_WRITE_ONLY);
            collapse.dispatch(cells);
            gl::wait_for_writes();
            const auto side = static_cast<std::size_t>(cells);
            std::vector<std::uint64_t> u(side);
            std::vector<std::uint64_t> v(side);
            REQUIRE(ws::collapse(ws::count_view(counts, cells, cells),
                                 largest ? ws::cell_rule::largest : ws::cell_rule::sum, u,
                                 v) == ws::status::ok);
            std::vector<std::uint32_t> host(u.begin(), u.end());
            host.insert(host.end(), v.begin(), v.end());
            CHECK(lines.read<std::uint32_t>() == host);
        }
    }
}

TEST_CASE("passes: rectilinear tables are those of a Gaussian in double") {
    const gl::headless_context context;
    const gl::program build =
        pass("#include \"warpshadow/warp_build.glsl\"\n#include \"passes/build_line.glsl\"\n");
    struct line {
        int cells;
        double width;
        double floor;
        double power;
        bool empty;
    };
    for (const line& each : {line{1, 0.0, 0.3, 1.0, false}, line{17, 3.0, 0.3, 1.0, false},
                             line{64, 0.0, 0.01, 1.0, false}, line{128, 3.0, 0.1, 1.0, false},
                             line{300, 12.0, 0.3, 0.5, false}, line{128, 500.0, 0.1, 1.0, false},
                             line{4096, 24.0, 0.3, 1.0, false}, line{64, 3.0, 0.1, 1.0, true}}) {
        CAPTURE(each.cells, each.width, each.floor, each.power, each.empty);
        const auto side = static_cast<std::size_t>(each.cells);
        std::vector<std::uint32_t> importance(2 * side);
        std::mt19937 random(static_cast<unsigned>(each.cells));
        for (std::uint32_t& value : importance) {
            value = each.empty ? 0u : static_cast<std::uint32_t>(random() >> 12u);
        }
        const gl::texture lines = image_of(importance, each.cells, 2);
        const gl::texture u(GL_R32F, each.cells + 1, 1);
        const gl::texture v(GL_R32F, each.cells + 1, 1);
        lines.bind_image(0, GL_READ_ONLY);
        u.bind_image(1, GL_WRITE_ONLY);
        v.bind_image(2, GL_WRITE_ONLY);
        build.set("ws_cells", glm::ivec2(each.cells));
        build.set("ws_width", static_cast<float>(each.width));
        build.set("ws_floor", static_cast<float>(each.floor));
        build.set("ws_power", static_cast<float>(each.power));
        build.use();
        glDispatchCompute(2, 1, 1);
        gl::wait_for_writes();
        const double width = std::min(each.width, static_cast<double>(each.cells));
        const int reach = width > 0.0 ? static_cast<int>(4.9 * width) + 1 : 0;
        for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
            std::vector<double> smooth(side);
            for (int i = 0; i < each.cells; ++i) {
                for (int d = -reach; d <= reach; ++d) {
                    int at = (i + d) % (2 * each.cells);
                    at = at < 0 ? at + 2 * each.cells : at;
                    at = at < each.cells ? at : 2 * each.cells - 1 - at;
                    const double x = width > 0.0 ? d / width : 0.0;
                    smooth[static_cast<std::size_t>(i)] +=
                        std::exp(-0.5 * x * x) *
                        std::pow(static_cast<double>(
                                     importance[axis * side + static_cast<std::size_t>(at)]),
                                 each.power);
                }
            }
            const std::vector<float> table = axis == 0 ? u.read<float>() : v.read<float>();
            const comparison found = compare(
                table, nodes_of(smooth, static_cast<double>(static_cast<float>(each.floor))));
            // each smoothed cell: a rounding per term, those of exp and pow as GLSL allows them (32
            // units of the last place at these arguments), and half of 2^-30 of the sum for whole
            // numbers; twice, for sum and total. The node itself rounds as in build_axis.
            const double relative = (2.0 * reach + 3.0 + 32.0) * half_ulp;
            CHECK(found.worst <= 2.0 * (relative + each.cells * 0x1p-31) + 12.0 * half_ulp);
            CHECK(found.monotone);
            CHECK(found.ends_exact);
        }
    }
}

TEST_CASE("passes: a power of what windows count") {
    const gl::headless_context context;
    const gl::program sums = pass("#include \"passes/column_sums.glsl\"\n");
    const gl::program build =
        pass("#define WS_BUILD_POWER\n#include \"warpshadow/importance.glsl\"\n"
             "#include \"warpshadow/warp_build.glsl\"\n#include \"passes/build_axis.glsl\"\n");
    for (const int cells : {5, 64, 200}) {
        for (const float power : {0.5f, 0.75f, 1.0f}) {
            CAPTURE(cells, power);
            const std::vector<std::uint32_t> counts =
                random_counts(cells, static_cast<unsigned>(cells));
            const gl::texture image = image_of(counts, cells, cells);
            const gl::texture table(GL_R32F, cells + 1, cells);
            image.bind_image(0, GL_READ_WRITE);
            sums.dispatch(cells);
            gl::wait_for_writes();
            table.bind_image(1, GL_WRITE_ONLY);
            const int radius = cells / 5;
            const float floor = 0.1f;
            const float steps = power == 1.0f ? 16.0f : 4096.0f;
            build.set("ws_radius", radius);
            build.set("ws_floor", floor);
            build.set("ws_power", power);
            build.set("ws_power_steps", steps);
            build.use();
            glDispatchCompute(static_cast<GLuint>(cells), 1, 1);
            gl::wait_for_writes();
            const std::vector<float> nodes = table.read<float>();
            const auto side = static_cast<std::size_t>(cells);
            for (int row = 0; row < cells; ++row) {
                std::vector<double> importance(side);
                for (int y = std::max(row - radius, 0); y <= std::min(row + radius, cells - 1);
                     ++y) {
                    for (std::size_t i = 0; i < side; ++i) {
                        importance[i] +=
                            static_cast<double>(counts[static_cast<std::size_t>(y) * side + i]);
                    }
                }
                for (double& each : importance) {
                    each = each > 0.0 ? std::pow(each, static_cast<double>(power)) : 0.0;
                }
                const comparison found = compare(
                    std::span(nodes).subspan(static_cast<std::size_t>(row) * (side + 1), side + 1),
                    nodes_of(importance, static_cast<double>(floor)));
                // a step at most of each weight, whose least is 1; pow as GLSL allows it
                REQUIRE(found.worst <= 2.0 * (1.0 / static_cast<double>(steps) + 64.0 * half_ulp));
                REQUIRE(found.monotone);
                REQUIRE(found.ends_exact);
            }
        }
    }
}

TEST_CASE("passes: ends of shadows are those of the host") {
    const gl::headless_context context;
    const gl::program ask = pass(R"(
#include "warpshadow/importance_functions.glsl"
#include "warpshadow/warp.glsl"
#include "warpshadow/bias.glsl"
#define WS_BINDING_DEPTHS 0
#include "passes/shadow_end.glsl"
layout(local_size_x = 64) in;
struct asked { vec4 p; vec4 normal; };
layout(std430, binding = 1) readonly buffer question_buffer { asked questions[]; };
layout(std430, binding = 2) writeonly buffer answer_buffer { vec2 answers[]; };
uniform float bias;
void main()
{
    int i = int(gl_GlobalInvocationID.x);
    if (i < questions.length()) {
        answers[i] = ws_shadow_end_in_image(questions[i].p.xyz, questions[i].normal.xyz, bias);
    }
}
)");
    const float bias = 0.001f;
    ask.set("bias", bias);
    std::mt19937 random(11u);
    std::uniform_real_distribution<float> place(-0.05f, 1.05f);
    std::uniform_real_distribution<float> share(0.0f, 1.0f);
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(2, 9), glm::ivec2(61, 40)}) {
        CAPTURE(size.x, size.y);
        std::vector<float> depths;
        for (int i = 0; i < size.x * size.y; ++i) {
            depths.push_back(share(random) < 0.3f ? 0.25f : 0.75f);
        }
        gl::texture image(GL_R32F, size.x, size.y);
        image.write(depths.data());
        image.bind(0);
        std::vector<glm::vec4> questions;
        for (int i = 0; i < 5000; ++i) {
            questions.emplace_back(place(random), place(random), share(random), 0.0f);
            questions.emplace_back(share(random) - 0.5f, share(random) - 0.5f, 1.0f, 0.0f);
        }
        const gl::buffer in(questions.size() * sizeof(glm::vec4), questions.data());
        const gl::buffer out(questions.size() / 2 * sizeof(glm::vec2), nullptr, GL_DYNAMIC_COPY);
        in.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
        out.bind_base(GL_SHADER_STORAGE_BUFFER, 2);
        ask.dispatch(static_cast<int>(questions.size() / 2));
        gl::wait_for_writes();
        const std::vector<glm::vec2> device = out.read<glm::vec2>();
        std::size_t ends = 0;
        std::size_t close = 0; // to one of two answers
        for (std::size_t i = 0; i < device.size(); ++i) {
            const auto on_host = [&](float of_bias) {
                return ws::shadow_end_at(ws::image_view<float>{depths, size.x, size.y},
                                         glm::vec3(questions[2 * i]),
                                         glm::vec3(questions[2 * i + 1]), of_bias);
            };
            const float margin = 1e-5f; // far beyond what either side rounds
            const glm::vec2 least = on_host(bias - margin);
            const glm::vec2 most = on_host(bias + margin);
            if (least != most) {
                ++close;
                continue;
            }
            REQUIRE(std::abs(device[i].x - least.x) <= 1e-6f);
            REQUIRE(std::abs(device[i].y - least.y) <= 1e-6f);
            ends += least.x + least.y > 0.0f ? 1 : 0;
        }
        CHECK(close < 50);
        CHECK((ends > 1000) == (size.x * size.y > 1));
    }
}

TEST_CASE("passes: edges of a depth image are those of the host") {
    const gl::headless_context context;
    const gl::program mark = pass("#include \"warpshadow/importance_functions.glsl\"\n"
                                  "#include \"passes/depth_edges.glsl\"\n");
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(2, 9), glm::ivec2(61, 40)}) {
        CAPTURE(size.x, size.y);
        std::vector<float> depths;
        std::mt19937 random(7u);
        std::uniform_real_distribution<float> step(0.0f, 0.02f);
        for (int i = 0; i < size.x * size.y; ++i) {
            depths.push_back((i / 23 % 2 == 0 ? 0.3f : 0.31f) + step(random));
        }
        gl::texture image(GL_R32F, size.x, size.y);
        image.write(depths.data());
        image.bind(0);
        const gl::texture edges(GL_R8UI, size.x, size.y);
        edges.bind_image(0, GL_WRITE_ONLY);
        const float bias = 0.02f;
        mark.set("ws_edge_bias", bias);
        mark.dispatch(size.x, size.y);
        gl::wait_for_writes();
        std::vector<std::uint8_t> host(depths.size());
        REQUIRE(ws::mark_depth_edges(ws::image_view<float>{depths, size.x, size.y}, bias,
                                     std::span(host)) == ws::status::ok);
        CHECK(edges.read<std::uint8_t>() == host);
    }
}
