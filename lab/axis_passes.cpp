#include "lab/axis_passes.hpp"

#include <warpshadow/smoothing.hpp>
#include <warpshadow/warp_build.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lab {

namespace ws = warpshadow;

namespace {

/// Bits of a counter.
constexpr int count_bits = 32;

float power_steps(const warp_options& options, int cells) {
    // most steps that all windows of a row can hold, as many in each cell
    const double all = 4294967296.0 / 2.0;
    const double each = std::pow(all / cells, static_cast<double>(options.power));
    const double steps = (all / cells - 1.0) / each;
    return static_cast<float>(std::exp2(std::floor(std::log2(std::max(steps, 0x1p-20)))));
}

} // namespace

float least_floor(int cells, table_format format) {
    // the device computes nodes in float: four times the floor that rounding once needs
    const float computed = 4.0f * ws::smallest_floor<float, float>(cells);
    return format == table_format::unorm16
               ? computed + ws::smallest_floor<float, std::uint16_t>(cells)
               : computed;
}

axis_passes::axis_passes(passes& gpu)
    : gpu_(gpu), mixed_(sizeof(std::uint32_t), nullptr, GL_DYNAMIC_COPY) {
    sum_columns_ = gpu.compute("column_sums.comp");
}

axis_passes::table_programs& axis_passes::programs(table_format format) {
    table_programs& found = programs_[static_cast<std::size_t>(format)];
    if (found.build.id() == 0) {
        const std::string stored = "WS_TABLE_FORMAT " + image_format(format);
        found.build = gpu_.compute("build_axis.comp", {stored});
        found.build_power = gpu_.compute("build_axis.comp", {stored, "WS_BUILD_POWER"});
    }
    return found;
}

void axis_passes::build_functions(const gl::texture& table, const warp_options& options, int cells,
                                  int radius, int functions) {
    const table_programs& of_format = programs(options.format);
    const gl::program& build = options.power == 1.0f ? of_format.build : of_format.build_power;
    build.set("ws_radius", radius);
    build.set("ws_floor", std::max(options.build.floor, least_floor(cells, options.format)));
    build.set("ws_power", options.power);
    build.set("ws_power_steps", power_steps(options, cells));
    table.bind_image(1, GL_WRITE_ONLY);
    build.use();
    glDispatchCompute(static_cast<GLuint>(functions), 1, 1);
    gl::wait_for_writes();
}

const gl::texture& axis_passes::smooth(map_resources::tables& warp, const warp_options& options,
                                       int radius, std::uint64_t most) {
    const int cells = warp.counts.width();
    if (sum_boxes_.id() == 0) {
        sum_boxes_ = gpu_.compute("box_sums.comp");
    }
    for (gl::texture& each : warp.boxes) {
        if (each.width() != cells) {
            each = gl::texture(GL_R32UI, cells, cells);
        }
    }
    const gl::texture* from = &warp.counts;
    for (int pass = 1; pass < ws::box_passes(options.build.shape); ++pass) {
        gl::texture& to = warp.boxes[static_cast<std::size_t>(pass - 1)];
        const int shift = ws::window_shift(most, radius, cells, ws::window_shape::tent, count_bits);
        sum_boxes_.set("ws_radius", radius);
        sum_boxes_.set("ws_shift", shift);
        from->bind_image(0, GL_READ_ONLY);
        to.bind_image(1, GL_WRITE_ONLY);
        sum_boxes_.dispatch(cells);
        gl::wait_for_writes();
        most = (most >> shift) * static_cast<std::uint64_t>(std::min(2 * radius + 1, cells));
        from = &to;
    }
    return *from;
}

void axis_passes::limit_shear(map_resources::tables& warp, const gl::texture& table,
                              const warp_options& options) {
    const int cells = warp.counts.width();
    table_programs& of_format = programs(options.format);
    if (of_format.limit_shear.id() == 0) {
        const std::string stored = "WS_TABLE_FORMAT " + image_format(options.format);
        of_format.limit_shear = gpu_.compute("shear_limit.comp", {stored});
        of_format.mix = gpu_.compute("shear_mix.comp", {stored});
    }
    if (warp.common.width() != cells + 1) {
        warp.common = gl::texture(internal_format(options.format), cells + 1, 1);
    }
    // a window of all rows around the first
    warp.counts.bind_image(0, GL_READ_ONLY);
    build_functions(warp.common, options, cells, cells, 1);
    mixed_.fill(0);
    mixed_.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    warp.common.bind_image(2, GL_READ_ONLY);
    table.bind_image(1, GL_READ_ONLY);
    of_format.limit_shear.set("ws_shear", options.build.shear);
    of_format.limit_shear.use();
    glDispatchCompute(static_cast<GLuint>(cells - 1), 1, 1);
    gl::wait_for_writes();
    table.bind_image(1, GL_READ_WRITE);
    of_format.mix.dispatch(table.width(), table.height());
    gl::wait_for_writes();
}

void axis_passes::build(map_resources::tables& warp, const gl::texture& table,
                        const warp_options& options, std::uint64_t most) {
    const int cells = warp.counts.width();
    const int radius = ws::window_radius(options.build.window, cells);
    warp.counts.bind_image(0, GL_READ_WRITE);
    sum_columns_.dispatch(cells);
    gl::wait_for_writes();
    const gl::texture& sums = options.build.shape == ws::window_shape::box
                                  ? warp.counts
                                  : smooth(warp, options, radius, most);
    sums.bind_image(0, GL_READ_ONLY);
    build_functions(table, options, cells, radius, cells);
    if (options.build.shear < std::numeric_limits<float>::infinity() && cells > 1) {
        limit_shear(warp, table, options);
    }
}

} // namespace lab
