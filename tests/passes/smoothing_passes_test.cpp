// Windows that are no box, and the shear limit, on whatever OpenGL there is, against the host.
#include "gl/context.hpp"
#include "gl/objects.hpp"
#include "passes/compute_pass.hpp"

#include <warpshadow/warp.hpp>
#include <warpshadow/warp_build.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace ws = warpshadow;

namespace {

/// Counts around places that move from row to row.
std::vector<std::uint32_t> clustered(int cells, unsigned samples, unsigned seed) {
    std::vector<std::uint32_t> counts(squared(cells));
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> anywhere(0.0f, 1.0f);
    std::normal_distribution<float> near(0.0f, 0.08f);
    for (unsigned i = 0; i < samples; ++i) {
        const float y = anywhere(random);
        const float x =
            i % 4 == 0 ? anywhere(random) : 0.5f + 0.3f * std::sin(9.0f * y) + near(random);
        const int column = ws::cell_of(x, cells);
        const int row = ws::cell_of(y, cells);
        if (column >= 0 && row >= 0) {
            ++counts[static_cast<std::size_t>(row * cells + column)];
        }
    }
    return counts;
}

struct device_result {
    std::vector<float> table;
    float mix = 0.0f;
};

/// The passes from counts to functions, in their order.
device_result build_on_device(const std::vector<std::uint32_t>& counts, int cells, int radius,
                              const ws::build_options<float>& options, int& shift) {
    const gl::program sum = pass("#include \"passes/column_sums.glsl\"\n");
    const gl::program box = pass("#include \"passes/box_sums.glsl\"\n");
    const gl::program build =
        pass("#include \"warpshadow/warp_build.glsl\"\n#include \"passes/build_axis.glsl\"\n");
    const gl::program limit = pass("#include \"passes/shear_limit.glsl\"\n");
    const gl::program mix = pass("#include \"passes/shear_mix.glsl\"\n");
    gl::texture images[3];
    for (gl::texture& each : images) {
        each = gl::texture(GL_R32UI, cells, cells);
    }
    images[0].write(counts.data());
    images[0].bind_image(0, GL_READ_WRITE);
    sum.dispatch(cells);
    gl::wait_for_writes();
    std::uint64_t most = 0;
    for (const std::uint32_t each : counts) {
        most += each;
    }
    const int boxes = ws::box_passes(options.shape);
    shift = 0;
    for (int i = 1; i < boxes; ++i) {
        const int step = ws::window_shift(most, radius, cells, ws::window_shape::tent, 32);
        box.set("ws_radius", radius);
        box.set("ws_shift", step);
        images[i - 1].bind_image(0, GL_READ_ONLY);
        images[i].bind_image(1, GL_WRITE_ONLY);
        box.dispatch(cells);
        gl::wait_for_writes();
        most = (most >> step) * static_cast<std::uint64_t>(std::min(2 * radius + 1, cells));
        shift += step;
    }
    const auto build_from = [&](const gl::texture& sums, const gl::texture& table, int window,
                                int functions) {
        sums.bind_image(0, GL_READ_ONLY);
        table.bind_image(1, GL_WRITE_ONLY);
        build.set("ws_radius", window);
        build.set("ws_floor", options.floor);
        build.use();
        glDispatchCompute(static_cast<GLuint>(functions), 1, 1);
        gl::wait_for_writes();
    };
    const gl::texture table(GL_R32F, cells + 1, cells);
    build_from(images[boxes - 1], table, radius, cells);
    device_result result;
    if (options.shear < std::numeric_limits<float>::infinity()) {
        const gl::texture common(GL_R32F, cells + 1, 1);
        build_from(images[0], common, cells, 1);
        gl::buffer mixed(sizeof(float), nullptr, GL_DYNAMIC_COPY);
        mixed.fill(0);
        mixed.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        table.bind_image(1, GL_READ_WRITE);
        common.bind_image(2, GL_READ_ONLY);
        limit.set("ws_shear", options.shear);
        limit.use();
        glDispatchCompute(static_cast<GLuint>(cells - 1), 1, 1);
        gl::wait_for_writes();
        mix.dispatch(cells + 1, cells);
        gl::wait_for_writes();
        result.mix = mixed.read<float>().front();
    }
    gl::check("smoothing passes");
    result.table = table.read<float>();
    return result;
}

struct host_result {
    std::vector<float> table;
    ws::build_result<float> built;
};

host_result build_on_host(const std::vector<std::uint32_t>& counts, int cells,
                          const ws::build_options<float>& options) {
    host_result result;
    result.table.resize(squared(cells) + static_cast<std::size_t>(cells));
    std::vector<std::uint64_t> scratch(ws::scratch_size(cells, options));
    result.built = ws::build_axis(ws::count_view(counts, cells, cells), options, std::span(scratch),
                                  ws::table_span<float>{result.table, cells, cells});
    REQUIRE_FALSE(ws::any(result.built.flags, ws::status::buffer_too_small));
    return result;
}

/// Largest difference of two tables; negative if the first is not made of increasing functions
/// from 0 to 1.
double difference(const std::vector<float>& a, const std::vector<float>& b, int cells) {
    const std::size_t stride = static_cast<std::size_t>(cells) + 1;
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const std::size_t k = i % stride;
        if ((k == 0 && a[i] != 0.0f) || (k + 1 == stride && a[i] != 1.0f) ||
            (k > 0 && !(a[i] > a[i - 1]))) {
            return -1.0;
        }
        worst = std::max(worst, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    }
    return worst;
}

/// As much as float on the device departs from double rounded once, see passes_test.cpp.
constexpr double rounding = 6.0 * 0x1p-23;

} // namespace

TEST_CASE("passes: tents and bells of the device are those of the host") {
    const gl::headless_context context;
    for (const int cells : {1, 2, 17, 64, 128, 500}) {
        for (const unsigned samples : {0u, 40000u, 400000u}) {
            const std::vector<std::uint32_t> counts =
                clustered(cells, samples, static_cast<unsigned>(cells));
            for (const ws::window_shape shape :
                 {ws::window_shape::box, ws::window_shape::tent, ws::window_shape::gaussian}) {
                for (const float window : {0.0f, 0.2f, 0.7f, 2.0f}) {
                    ws::build_options<float> options;
                    options.shape = shape;
                    options.window = window;
                    const int radius = ws::window_radius(window, cells);
                    int shift = 0;
                    const device_result device =
                        build_on_device(counts, cells, radius, options, shift);
                    const host_result host = build_on_host(counts, cells, options);
                    CAPTURE(cells, samples, static_cast<int>(shape), window, shift);
                    const double worst = difference(device.table, host.table, cells);
                    CHECK(worst >= 0.0);
                    // each box that is divided loses less than 1 of a cell's sum; 2^30 is what the
                    // rows least in reach of the others still hold
                    const double lost =
                        shift == 0 ? 0.0 : 2.0 * cells * std::min(2 * radius + 1, cells) * 0x1p-30;
                    CHECK(worst <= rounding + lost);
                }
            }
        }
    }
}

TEST_CASE("passes: the shear limit of the device is that of the host") {
    const gl::headless_context context;
    for (const int cells : {2, 17, 64, 128, 300}) {
        const std::vector<std::uint32_t> counts =
            clustered(cells, 40000, static_cast<unsigned>(cells));
        for (const ws::window_shape shape : {ws::window_shape::box, ws::window_shape::tent}) {
            for (const float shear : {0.0f, 0.25f, 1.0f, 2.0f, 100.0f}) {
                ws::build_options<float> options;
                options.shape = shape;
                options.window = 0.1f;
                options.floor = 0.1f;
                options.shear = shear;
                int shift = 0;
                const device_result device = build_on_device(
                    counts, cells, ws::window_radius(options.window, cells), options, shift);
                const host_result host = build_on_host(counts, cells, options);
                CAPTURE(cells, static_cast<int>(shape), shear, device.mix, host.built.mix);
                // differences of nodes that are rounded, over a slope of at least a tenth
                const double error = cells * 0x1p-18;
                CHECK(static_cast<double>(device.mix) ==
                      Approx(static_cast<double>(host.built.mix)).margin(error));
                const double worst = difference(device.table, host.table, cells);
                CHECK(worst >= 0.0);
                CHECK(worst <= rounding + error);
            }
        }
    }
}
