// Importance of the second axis: samples moved by the functions of the first.
#pragma once

#include <warpshadow/importance.hpp>
#include <warpshadow/status.hpp>
#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include <cstddef>
#include <span>

namespace warpshadow {

namespace detail {

/// Cell of a sample in the map of the second axis, or −1.
template <typename T, typename Node>
std::ptrdiff_t column_cell(const table_view<T, Node>& rows, glm::vec<2, T> p,
                           const count_map& map) {
    const int j = cell_of(p.y, map.width);
    if (j < 0 || cell_of(p.x, 1) < 0) {
        return -1;
    }
    const T warped = p.x + axis_offset(rows, blend_rows(p.y, rows.rows), p.x);
    // rounding may carry the last sample past 1
    const int i = cell_of(glm::clamp(warped, T(0), T(1)), map.height);
    return static_cast<std::ptrdiff_t>(i) * map.width + j;
}

/// Counts samples of which `cell(sample)` knows the cell, negative for none.
template <typename Sample, typename Cell>
splat_result count_samples(std::span<const Sample> samples, const Cell& cell,
                           const count_map& map) {
    splat_result result;
    for (const Sample& p : samples) {
        const std::ptrdiff_t index = cell(p);
        if (index < 0) {
            ++result.rejected;
            continue;
        }
        result.flags |= count_sample(map, static_cast<std::size_t>(index));
        ++result.counted;
    }
    result.flags |= result.rejected != 0 ? status::samples_rejected : status::ok;
    return result;
}

} // namespace detail

/// Counts view samples for the second axis: moved by the row functions, and transposed.
///
/// Cell (v, U) of the map, that is row U and column v, counts the samples whose warped u is in
/// column U (Milet et al. 2015, §3, step 6). `build_axis` then gives the column functions.
/// @param samples positions in map space; rejected as in `splat`
/// @param rows    functions of u
/// @param map     counters, added to; `map.width` cells along v, `map.height` columns
/// @return        buffer_too_small, and nothing written, with `fits(map)` or `fits(rows)` false
template <typename T, typename Node>
splat_result splat_columns(std::span<const glm::vec<2, T>> samples, const table_view<T, Node>& rows,
                           const count_map& map) {
    if (!fits(map) || !fits(rows)) {
        splat_result result;
        result.rejected = samples.size();
        result.flags = status::buffer_too_small;
        return result;
    }
    return detail::count_samples(
        samples, [&](glm::vec<2, T> p) { return detail::column_cell(rows, p, map); }, map);
}

/// Adds up the importance of view samples for the second axis.
///
/// What `splat_columns` is to `splat`; see `splat_weighted` for the parameters.
template <typename Point, typename T, typename Node, typename Importance>
splat_result splat_columns_weighted(std::span<const Point> points, const table_view<T, Node>& rows,
                                    const Importance& importance, T steps, cell_rule rule,
                                    const count_map& map) {
    splat_result result;
    if (!fits(map) || !fits(rows)) {
        result.rejected = points.size();
        result.flags = status::buffer_too_small;
        return result;
    }
    for (const Point& point : points) {
        const std::ptrdiff_t cell = detail::column_cell(rows, glm::vec<2, T>(point.p), map);
        if (cell < 0) {
            ++result.rejected;
            continue;
        }
        detail::add_sample<T>(importance(point), steps, rule, static_cast<std::size_t>(cell), map,
                              result);
    }
    result.flags |= result.rejected != 0 ? status::samples_rejected : status::ok;
    return result;
}

} // namespace warpshadow
