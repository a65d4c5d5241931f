// Many points through a warp at once.
#pragma once

#include <warpshadow/detail/inverse_block.hpp>
#include <warpshadow/detail/point_lanes.hpp>
#include <warpshadow/status.hpp>
#include <warpshadow/unwarp_guide.hpp>
#include <warpshadow/warp.hpp>

#include <glm/vec2.hpp>

#include <cstddef>
#include <span>
#include <type_traits>

namespace warpshadow {

/// Warps points: what `warp` does to each, for tables of floats in vectors of four.
///
/// The same operations in the same order: to the bit where the compiler does not fuse
/// multiplications and additions, as it does by default on machines that can.
/// @param rows,columns tables of the warp; `fits` both
/// @param points positions in map space
/// @param warped receives as many; may be the same memory, else no part of it
/// @return       buffer_too_small, and nothing written, if a size does not match
template <typename T, typename Node>
status warp_points(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                   std::span<const glm::vec<2, T>> points, std::span<glm::vec<2, T>> warped) {
    if (!fits(rows) || !fits(columns) || warped.size() < points.size()) {
        return status::buffer_too_small;
    }
    std::size_t i = 0;
#if defined(__GNUC__)
    if constexpr (std::is_same_v<T, float> && std::is_same_v<Node, float>) {
        for (; i + 4 <= points.size(); i += 4) {
            detail::warp_lanes(rows, columns, &points[i].x, &warped[i].x);
        }
    }
#endif
    for (; i < points.size(); ++i) {
        warped[i] = warp(rows, columns, points[i]);
    }
    return status::ok;
}

/// Unwarps points: what `unwarp` with guides does to each, sixteen at a time.
///
/// @param rows,columns tables of the warp; `fits` both
/// @param row_guide    of `rows`: `fits(row_guide, rows)`
/// @param column_guide of `columns`
/// @param warped positions in the warped map
/// @param points receives as many; may be the same memory, else no part of it
/// @return       buffer_too_small, and nothing written, if a size does not match
template <typename T, typename Node>
status unwarp_points(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                     const guide_view& row_guide, const guide_view& column_guide,
                     std::span<const glm::vec<2, T>> warped, std::span<glm::vec<2, T>> points) {
    if (!fits(rows) || !fits(columns) || !fits(row_guide, rows) || !fits(column_guide, columns) ||
        points.size() < warped.size()) {
        return status::buffer_too_small;
    }
    T u[detail::inverse_block];
    T v[detail::inverse_block];
    T offset[detail::inverse_block];
    for (std::size_t begin = 0; begin < warped.size(); begin += detail::inverse_block) {
        const std::size_t left = warped.size() - begin;
        const std::size_t count = left < detail::inverse_block ? left : detail::inverse_block;
        for (std::size_t i = 0; i < count; ++i) {
            u[i] = warped[begin + i].x;
            v[i] = warped[begin + i].y;
        }
        detail::inverse_offsets(columns, column_guide, count, u, v, offset);
        for (std::size_t i = 0; i < count; ++i) {
            v[i] += offset[i];
        }
        detail::inverse_offsets(rows, row_guide, count, v, u, offset);
        for (std::size_t i = 0; i < count; ++i) {
            points[begin + i] = glm::vec<2, T>(u[i] + offset[i], v[i]);
        }
    }
    return status::ok;
}

} // namespace warpshadow
