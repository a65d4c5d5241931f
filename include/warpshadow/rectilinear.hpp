// Rectilinear texture warping: one function per axis (Rosen 2012, §4.2).
//
// The importance of the map is collapsed to a line per axis, smoothed along the line, and summed to
// a table of one row, which `warp` evaluates like any other. Everything up to the one rounding of
// each node is in whole numbers.
#pragma once

#include <warpshadow/build_options.hpp>
#include <warpshadow/detail/node_walk.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/status.hpp>
#include <warpshadow/warp_build.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// How rectilinear tables are built.
template <typename T> struct rectilinear_options {
    /// Importance of a line of cells: their sum, or as published the largest of them.
    cell_rule collapse = cell_rule::sum;
    /// Weights of the smoothing along the axis.
    window_shape shape = window_shape::gaussian;
    /// Standard deviation of a Gaussian, half-width of a box or a tent, in cells; a box takes
    /// 2r + 1 cells, a tent as many with weights r + 1 − |d|, r rounded to whole cells.
    T width = T(12);
    /// Density floor ε: no part of the map shrinks below this share of its uniform extent.
    T floor = build_options<T>{}.floor; // what suits many functions suits one
};

/// The method as published: largest importance, σ = 3, and no floor but what the storage needs.
template <typename T> rectilinear_options<T> rosen_rectilinear() {
    return {cell_rule::largest, window_shape::gaussian, T(3), T(0)};
}

/// Collapses a map to one importance per column and one per row.
///
/// @param counts importance; `fits(counts)`
/// @param rule   sum or largest of the cells of a line
/// @param along_u receives one number per column, `counts.width` of them
/// @param along_v receives one number per row, `counts.height` of them
/// @return       buffer_too_small, and nothing written, if a size does not match
inline status collapse(const count_view& counts, cell_rule rule, std::span<std::uint64_t> along_u,
                       std::span<std::uint64_t> along_v) {
    if (!fits(counts) || along_u.size() < static_cast<std::size_t>(counts.width) ||
        along_v.size() < static_cast<std::size_t>(counts.height)) {
        return status::buffer_too_small;
    }
    const auto width = static_cast<std::size_t>(counts.width);
    for (std::size_t i = 0; i < width; ++i) {
        along_u[i] = 0;
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(counts.height); ++j) {
        const std::span<const std::uint32_t> row = counts.counts.subspan(j * width, width);
        std::uint64_t all = 0;
        if (rule == cell_rule::sum) {
            for (std::size_t i = 0; i < width; ++i) {
                along_u[i] += row[i];
                all += row[i];
            }
        } else {
            for (std::size_t i = 0; i < width; ++i) {
                along_u[i] = along_u[i] < row[i] ? row[i] : along_u[i];
                all = all < row[i] ? row[i] : all;
            }
        }
        along_v[j] = all;
    }
    return status::ok;
}

namespace detail {

/// Weights of a window along a line, in whole numbers.
struct line_weights {
    window_shape shape;
    int radius;               ///< weights beyond it are 0
    double deviation = 0.0;   ///< of a Gaussian
    double scale = 0.0;       ///< 65536 over the sum of the bell's values
    std::uint64_t centre = 1; ///< weight at distance 0
    std::uint64_t total = 1;  ///< sum of all weights

    [[nodiscard]] std::uint64_t at(int distance) const {
        if (distance == 0) {
            return centre;
        }
        if (shape == window_shape::box) {
            return 1;
        }
        if (shape == window_shape::tent) {
            return static_cast<std::uint64_t>(radius + 1 - distance);
        }
        const double x = double(distance) / deviation;
        return static_cast<std::uint64_t>(std::floor(scale * std::exp(-0.5 * x * x) + 0.5));
    }
};

inline line_weights weights_of(window_shape shape, double width, int cells) {
    // mirrored at both ends, a window as wide as the line is level already
    const double widest = double(cells);
    const double used = width > 0.0 ? (width < widest ? width : widest) : 0.0;
    line_weights weights{shape, static_cast<int>(std::floor(used + 0.5))};
    if (shape == window_shape::box) {
        weights.total = 2 * static_cast<std::uint64_t>(weights.radius) + 1;
    } else if (shape == window_shape::tent) {
        weights.centre = static_cast<std::uint64_t>(weights.radius) + 1;
        weights.total = weights.centre * weights.centre;
    } else if (used > 0.0) {
        weights.deviation = used;
        // 2^-17 of the centre, which rounds to 0, is reached at 4.86 σ
        weights.radius = static_cast<int>(4.9 * used) + 1;
        double sum = 1.0;
        for (int d = 1; d <= weights.radius; ++d) {
            const double x = double(d) / used;
            sum += 2.0 * std::exp(-0.5 * x * x);
        }
        weights.scale = 65536.0 / sum;
        weights.total = 65536;
        weights.centre = 65536;
        for (int d = 1; d <= weights.radius; ++d) {
            weights.centre -= 2 * weights.at(d);
        }
    } else {
        weights.radius = 0;
    }
    return weights;
}

} // namespace detail

/// Smooths the importance along a line, which goes on mirrored beyond its ends.
///
/// What is uniform stays so, to the bit, and the sum of all is multiplied by the sum of the
/// weights: a Gaussian's are whole numbers of sum 65536, the others as documented at
/// `rectilinear_options`. A Gaussian's weights depend on the rounding of `std::exp`.
/// @param line   importance
/// @param shape  weights
/// @param width  standard deviation or half-width in cells; clamped to the line's length, 0 for NaN
/// @param smooth receives as many numbers; not the same memory
/// @return       out_of_range if the importance was divided by a power of two first, because
///               its sum times that of the weights is 2⁶³ or more; buffer_too_small, and nothing
///               written, if `smooth` is too short
template <typename T>
status smooth_line(std::span<const std::uint64_t> line, window_shape shape, T width,
                   std::span<std::uint64_t> smooth) {
    const std::size_t size = line.size();
    if (smooth.size() < size) {
        return status::buffer_too_small;
    }
    if (size == 0) {
        return status::ok;
    }
    const detail::line_weights weights =
        detail::weights_of(shape, double(width), static_cast<int>(size));
    double sum = 0.0;
    for (const std::uint64_t importance : line) {
        sum += double(importance);
    }
    int shift = 0;
    while (std::ldexp(sum * double(weights.total), -shift) >= 0x1p63) {
        ++shift;
    }
    for (std::size_t i = 0; i < size; ++i) {
        smooth[i] = weights.centre * (line[i] >> shift);
    }
    for (int d = 1; d <= weights.radius; ++d) {
        const std::uint64_t weight = weights.at(d);
        // the mirrored line repeats after twice its length
        const std::size_t step = static_cast<std::size_t>(d) % (2 * size);
        const auto mirrored = [size](std::size_t i) {
            const std::size_t k = i % (2 * size);
            return k < size ? k : 2 * size - 1 - k;
        };
        for (std::size_t i = 0; weight != 0 && i < size; ++i) {
            smooth[i] += weight * ((line[mirrored(i + step)] >> shift) +
                                   (line[mirrored(i + 2 * size - step)] >> shift));
        }
    }
    return shift > 0 ? status::out_of_range : status::ok;
}

/// Numbers of scratch memory that `build_rectilinear` takes.
constexpr std::size_t rectilinear_scratch(int width, int height) {
    return 2 * (static_cast<std::size_t>(width) + static_cast<std::size_t>(height));
}

/// Builds the two functions of a rectilinear warp from the importance of the map.
///
/// Both come from the same map: the second axis is not counted again.
/// @param counts  importance; `fits(counts)`
/// @param options collapse, smoothing, floor; out of range or NaN is clamped or replaced by the
///                default
/// @param scratch `rectilinear_scratch(counts.width, counts.height)` numbers
/// @param u       function of u: one row of `counts.width` cells
/// @param v       function of v: one row of `counts.height` cells
/// @return        empty_importance, with both the identity, for a map of zeros; buffer_too_small,
///                and nothing written, if a size does not match
template <typename T, typename Node>
build_result<T> build_rectilinear(const count_view& counts, const rectilinear_options<T>& options,
                                  std::span<std::uint64_t> scratch, const table_span<T, Node>& u,
                                  const table_span<T, Node>& v) {
    build_result<T> result;
    if (!fits(counts) || u.rows != 1 || v.rows != 1 || u.cells != counts.width ||
        v.cells != counts.height || u.nodes.size() <= static_cast<std::size_t>(u.cells) ||
        v.nodes.size() <= static_cast<std::size_t>(v.cells) ||
        scratch.size() < rectilinear_scratch(counts.width, counts.height)) {
        result.flags = status::buffer_too_small;
        return result;
    }
    const auto width = static_cast<std::size_t>(counts.width);
    const auto height = static_cast<std::size_t>(counts.height);
    const std::span<std::uint64_t> lines[2] = {scratch.first(width),
                                               scratch.subspan(width, height)};
    result.flags |= collapse(counts, options.collapse, lines[0], lines[1]);

    T smoothing = options.width;
    if (!(smoothing >= T(0) && smoothing <= std::numeric_limits<T>::max())) {
        const bool is_nan = !(smoothing >= T(0)) && !(smoothing < T(0));
        smoothing = is_nan ? rectilinear_options<T>{}.width : smoothing;
        result.flags |= is_nan ? status::invalid_input : status::out_of_range;
    }
    build_options<T> wanted;
    wanted.floor = options.floor;
    const table_span<T, Node>* const tables[2] = {&u, &v};
    for (int axis = 0; axis < 2; ++axis) {
        const std::span<std::uint64_t> line = lines[axis];
        const std::span<std::uint64_t> smooth =
            scratch.subspan(width + height + (axis == 0 ? 0 : width), line.size());
        result.flags |=
            smooth_line(std::span<const std::uint64_t>(line), options.shape, smoothing, smooth);
        std::uint64_t total = 0;
        for (const std::uint64_t importance : smooth) {
            total += importance;
        }
        const T floor =
            detail::checked_options<T, Node>(wanted, static_cast<int>(line.size()), 1, result.flags)
                .floor;
        result.floor = floor > result.floor ? floor : result.floor;
        result.flags |= total == 0 ? status::empty_importance : status::ok;
        detail::write_nodes(std::span<const std::uint64_t>(smooth), total, double(floor),
                            tables[axis]->nodes.first(line.size() + 1));
    }
    result.samples = detail::samples_in(counts, 0, counts.height);
    return result;
}

} // namespace warpshadow
