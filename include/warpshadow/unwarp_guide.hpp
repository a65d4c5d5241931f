// Where to look for an inverse: a guide table next to a warp table, for many points to unwarp.
//
// `unwarp` finds a cell by bisection, two look-ups in each of log2(cells) steps. A guide remembers
// for equal steps of a function's image in which cell the function takes that value; the cell of a
// blended function lies between those of the two functions that are blended. What is left to search
// are a few cells: the answer is that of `unwarp`, to the bit, for about a fifth of the look-ups.
#pragma once

#include <warpshadow/status.hpp>
#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// Guide of one axis, for reading: `rows` functions of `steps` + 1 cells each, row after row.
struct guide_view {
    std::span<const std::uint16_t> cells; ///< rows · (steps + 1) cells
    int steps = 0;                        ///< equal steps of the image
    int rows = 0;                         ///< functions, as many as the table has
};

/// The same, for writing.
struct guide_span {
    std::span<std::uint16_t> cells; ///< at least rows · (steps + 1) cells
    int steps = 0;                  ///< as many as the table has cells is a good choice
    int rows = 0;

    // What can be written can be read; the implicit conversion is the point.
    constexpr operator guide_view() const { // NOLINT(google-explicit-constructor)
        return {cells, steps, rows};
    }
};

/// Numbers of memory of a guide.
constexpr std::size_t guide_size(int steps, int rows) {
    return (static_cast<std::size_t>(steps) + 1) * static_cast<std::size_t>(rows);
}

/// Fills the guide of a table: the last cell whose left node is not above g / steps, for each g.
///
/// One walk along each function.
/// @param table functions of one axis, increasing; at most 65536 cells
/// @param guide as many rows as the table; at least one step
/// @return      buffer_too_small, and nothing written, if a size does not match; out_of_range,
///              and nothing written, for more cells than 16 bits hold
template <typename T, typename Node>
status build_guide(const table_view<T, Node>& table, const guide_span& guide) {
    if (!fits(table) || guide.rows != table.rows || guide.steps < 1 ||
        guide.cells.size() < guide_size(guide.steps, guide.rows)) {
        return status::buffer_too_small;
    }
    if (table.cells > int(std::numeric_limits<std::uint16_t>::max()) + 1) {
        return status::out_of_range;
    }
    std::size_t at = 0;
    for (int row = 0; row < table.rows; ++row) {
        int cell = 0;
        for (int g = 0; g <= guide.steps; ++g, ++at) {
            const T image = T(g) / T(guide.steps);
            while (cell + 1 < table.cells && table_node(table, row, cell + 1) <= image) {
                ++cell;
            }
            guide.cells[at] = static_cast<std::uint16_t>(cell);
        }
    }
    return status::ok;
}

/// Whether a guide has the rows of a table, a step, and memory for all of them.
template <typename T, typename Node>
bool fits(const guide_view& guide, const table_view<T, Node>& table) {
    return guide.rows == table.rows && guide.steps > 0 &&
           guide.cells.size() / (static_cast<std::size_t>(guide.steps) + 1) >=
               static_cast<std::size_t>(guide.rows);
}

/// Offset F⁻¹(X) − X of the inverse of a blended function, found with a guide.
///
/// The same as without, to the bit, where the blended nodes increase; where rounding makes
/// neighbours equal or worse, another of the cells that hold X. A guide of another table costs time
/// and changes nothing.
/// @param table functions of one axis, increasing
/// @param guide `fits(guide, table)`
/// @param blend from `blend_rows` or `floor_row`
/// @param image value X of the function; clamped to [0, 1]
template <typename T, typename Node>
T axis_inverse_offset(const table_view<T, Node>& table, const guide_view& guide,
                      const row_blend<T>& blend, T image) {
    const int step = glm::clamp(int(clamp_to_unit(image) * T(guide.steps)), 0, guide.steps - 1);
    const std::size_t stride = static_cast<std::size_t>(guide.steps) + 1;
    const auto guided = [&](int row) {
        return int(
            guide.cells[static_cast<std::size_t>(row) * stride + static_cast<std::size_t>(step)]);
    };
    int cell = glm::min(guided(blend.row0), guided(blend.row1));
    return axis_inverse_offset_near(table, blend, image, cell);
}

/// Position whose warp is q, found with guides: `unwarp` for many points.
///
/// @param rows,columns tables of the warp
/// @param row_guide    of `rows`: `fits(row_guide, rows)`
/// @param column_guide of `columns`
/// @param q            position in the warped map
/// @see   unwarp
template <typename T, typename Node>
glm::vec<2, T> unwarp(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                      const guide_view& row_guide, const guide_view& column_guide,
                      glm::vec<2, T> q) {
    const T v =
        q.y + axis_inverse_offset(columns, column_guide, blend_rows(q.x, columns.rows), q.y);
    const T u = q.x + axis_inverse_offset(rows, row_guide, blend_rows(v, rows.rows), q.x);
    return glm::vec<2, T>(u, v);
}

} // namespace warpshadow
