// A box along the axes that holds what the warp makes of a box.
//
// U increases with u and V with v. So over a box of the unwarped map U is least on its left side
// and largest on its right side, and along a side it is a polygon with corners at the row centres:
// no bound is needed but a look at these. V over the box of v and the U found is the same again.
// For what is a few cells long that costs less than the hull of a triangle (warped_hull.hpp) and is
// enough to tell which texels it may cover.
//
// All lengths are in units of the map.
#pragma once

#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace warpshadow {

/// A box along the axes of the map.
template <typename T> struct map_box {
    glm::vec<2, T> lo; ///< corner with the least coordinates
    glm::vec<2, T> hi; ///< and with the largest
};

/// Least value of the functions of one axis at one place, and largest at another, over a range
/// across the rows.
///
/// One step for each row in between.
/// @param table     functions of one axis, increasing
/// @param from, to  range across the rows, from <= to; clamped to [0, 1]
/// @param low, high places along the axis; clamped to [0, 1]
/// @return          least F(low), largest F(high), but for a few units in the last place of 1
template <typename T, typename Node>
glm::vec<2, T> axis_range(const table_view<T, Node>& table, T from, T to, T low, T high) {
    int cells = table_cells(table);
    int rows = table_rows(table);
    T at_low = clamp_to_unit(low) * T(cells);
    T at_high = clamp_to_unit(high) * T(cells);
    int k_low = glm::clamp(int(at_low), 0, cells - 1);
    int k_high = glm::clamp(int(at_high), 0, cells - 1);
    glm::vec<2, T> share(at_low - T(k_low), at_high - T(k_high));
    T begin = glm::clamp(clamp_to_unit(from) * T(rows) - T(0.5), T(0), T(rows - 1));
    T end = glm::clamp(clamp_to_unit(to) * T(rows) - T(0.5), T(0), T(rows - 1));
    int first = glm::clamp(int(begin), 0, rows - 1);
    int last = glm::clamp(int(glm::ceil(end)), 0, rows - 1);
    glm::vec<2, T> value(T(0));
    glm::vec<2, T> range(T(1), T(0));
    // a pass more than there are steps: one place in the text looks up nodes
    for (int row = first; row <= last; ++row) {
        glm::vec<2, T> left(table_node(table, row, k_low), table_node(table, row, k_high));
        glm::vec<2, T> right(table_node(table, row, k_low + 1), table_node(table, row, k_high + 1));
        glm::vec<2, T> next = left + share * (right - left);
        if (row == first) {
            value = next;
        }
        // of the step from the row before, the part within the range
        glm::vec<2, T> step = next - value;
        glm::vec<2, T> at_begin = value + glm::clamp(begin - T(row - 1), T(0), T(1)) * step;
        glm::vec<2, T> at_end = value + glm::clamp(end - T(row - 1), T(0), T(1)) * step;
        if (row > first || first == last) {
            range.x = glm::min(range.x, glm::min(at_begin.x, at_end.x));
            range.y = glm::max(range.y, glm::max(at_begin.y, at_end.y));
        }
        value = next;
    }
    return range;
}

/// A box that holds the warp of a box.
///
/// Rounding adds a few units in the last place of 1.
/// @param rows, columns tables of `warp`
/// @param box           in the unwarped map, lo <= hi; clamped to the unit square
template <typename T, typename Node>
map_box<T> warp_box(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                    const map_box<T>& box) {
    glm::vec<2, T> u = axis_range(rows, box.lo.y, box.hi.y, box.lo.x, box.hi.x);
    glm::vec<2, T> v = axis_range(columns, u.x, u.y, box.lo.y, box.hi.y);
    map_box<T> warped;
    warped.lo = glm::vec<2, T>(u.x, v.x);
    warped.hi = glm::vec<2, T>(u.y, v.y);
    return warped;
}

} // namespace warpshadow
