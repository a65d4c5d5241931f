// The bend table: how far warped edges may bend, for squares of the map and their surroundings.
//
// The rasteriser draws straight edges; the warp makes curves of them. The deviation of a warped
// edge from the line between its warped ends is bounded by second differences of the tables. A bend
// table holds, for squares of the map and their surroundings, one number D such that every edge
// within deviates by no more than D f(n), where n is the longer side of the edge's box in cells and
//
//     f(n) = n / 4 for n ≤ 1,    (n² + 1) / 8 above.
//
// Why: along a line, a function with kinks of slope J at distance h departs from its chord by no
// more than J L / 4 over a length L ≤ h (there is one kink at most, and it does most in the
// middle), and by no more than J (L² + h²) / (8 h) above (the chord of a parabola, and what a
// polygon with corners on it departs from it). J h is a second difference of the nodes. The same
// holds across rows, and a bilinear cell adds a fourth of its mixed difference times the number of
// cells along and across. The second axis sees the curve that the first has made of the line:
// it adds its shear times the deviation of the first.
//
// The bound holds for triangles as well, of which the edge is the longest in this sense: a convex
// sum of functions of u alone and of v alone, which differ from their interpolation over a triangle
// by no more than along its sides, majorises the warp's bending. And a triangle lies within the
// surroundings that are looked up for its longest edge. So where all three edges of a triangle
// pass, the whole triangle does; and what an edge is cut into depends on the edge alone, so that
// both triangles on it agree.
//
// All lengths are in units of the map. Edges lie in the unit square: clip before warping.
#pragma once

#include <warpshadow/status.hpp>
#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <cstddef>
#include <span>

namespace warpshadow {

/// Largest deviation for which the bound is a bound: this share of the map.
///
/// Above it the bound is no less than this, but how much more is not known. It leaves room for
/// curves where the second axis is looked up.
template <typename T> inline constexpr T bend_margin = T(1.0 / 128.0);

/// Squares along each side of the map by which a bend table tells places apart, at most.
inline constexpr int most_bend_blocks = 64;

/// Rows of a bend table: levels of `blocks`, blocks / 2, … 1 squares along each side.
///
/// @param blocks power of two, 2 to 64
constexpr int bend_rows(int blocks) {
    return 2 * blocks - 1;
}

/// Cells of each row of a bend table. Of a level with n squares a side, nodes 0 to n − 1 are used.
///
/// @param blocks power of two, 2 to 64
constexpr int bend_cells(int blocks) {
    return blocks - 1;
}

/// Numbers in a bend table.
///
/// @param blocks power of two, 2 to 64
constexpr std::size_t bend_nodes(int blocks) {
    return static_cast<std::size_t>(bend_rows(blocks)) * static_cast<std::size_t>(blocks);
}

/// Largest differences between nodes in a part of a table.
template <typename T> struct table_bends {
    T along;       ///< second difference along a function
    T across;      ///< second difference across three rows
    T cross;       ///< mixed difference over a cell of two rows
    T step_along;  ///< first difference along a function
    T step_across; ///< first difference across two rows
};

/// Largest differences in a range of cells and rows.
///
/// Counted are kinks at the nodes inside the range, not at its ends, and kinks at all its rows, the
/// outermost of the table included, beyond which functions are constant.
/// @param table functions of one axis
/// @param cell0 first cell, 0 ≤ cell0 ≤ cell1
/// @param cell1 last cell, cell1 < cells
/// @param row0  first row, 0 ≤ row0 ≤ row1
/// @param row1  last row, row1 < rows
template <typename T, typename Node>
table_bends<T> bends_between(const table_view<T, Node>& table, int cell0, int cell1, int row0,
                             int row1) {
    table_bends<T> most;
    most.along = T(0);
    most.across = T(0);
    most.cross = T(0);
    most.step_along = T(0);
    most.step_across = T(0);
    int last_row = table_rows(table) - 1;
    for (int row = row0; row <= row1; ++row) {
        int row_below = glm::max(row - 1, 0);
        int row_above = glm::min(row + 1, last_row);
        T node = T(0);
        T above = T(0);
        T step = T(0);
        for (int k = cell0; k <= cell1 + 1; ++k) {
            T next = table_node(table, row, k);
            T next_above = table_node(table, row_above, k);
            T up = next_above - next;
            T down = next - table_node(table, row_below, k);
            most.across = glm::max(most.across, glm::abs(up - down));
            if (row < row1) {
                most.step_across = glm::max(most.step_across, glm::abs(up));
            }
            if (k > cell0) {
                T next_step = next - node;
                most.step_along = glm::max(most.step_along, glm::abs(next_step));
                if (k > cell0 + 1) {
                    most.along = glm::max(most.along, glm::abs(next_step - step));
                }
                if (row < row1) {
                    most.cross = glm::max(most.cross, glm::abs((next_above - above) - next_step));
                }
                step = next_step;
            }
            node = next;
            above = next_above;
        }
    }
    return most;
}

/// The row whose centre is the last at or before a position, or the first row.
///
/// @param across coordinate across the rows
/// @param rows   number of functions, positive
template <typename T> int row_before(T across, int rows) {
    return glm::clamp(int(glm::floor(clamp_to_unit(across) * T(rows) - T(0.5))), 0, rows - 1);
}

/// The row whose centre is the first at or after a position, or the last row.
///
/// @param across coordinate across the rows
/// @param rows   number of functions, positive
template <typename T> int row_after(T across, int rows) {
    return glm::clamp(int(glm::ceil(clamp_to_unit(across) * T(rows) - T(0.5))), 0, rows - 1);
}

/// Cells of the coarsest of both tables in any direction: the unit in which edges are measured.
///
/// @param rows, columns tables of `warp`
template <typename T, typename Node>
int bend_unit(const table_view<T, Node>& rows, const table_view<T, Node>& columns) {
    return glm::min(glm::min(table_cells(rows), table_rows(rows)),
                    glm::min(table_cells(columns), table_rows(columns)));
}

/// D f(ratio n) ≤ growth(ratio) D f(n), for any n: how the bound grows with the unit.
template <typename T> T bend_growth(T ratio) {
    return glm::max(ratio, ratio * ratio);
}

/// D of one square of the map, without its surroundings.
///
/// @param rows    functions of u, one per row
/// @param columns functions of v, one per column of the half-warped map
/// @param blocks  squares along each side, a power of two, 2 to 64
/// @param x       column of squares, 0 ≤ x < blocks
/// @param y       row of squares, 0 ≤ y < blocks
/// @return        bound for edges inside the square, in the sense of `edge_deviation`
template <typename T, typename Node>
T bend_of_block(const table_view<T, Node>& rows, const table_view<T, Node>& columns, int blocks,
                int x, int y) {
    T unit = T(bend_unit(rows, columns));
    T size = T(1) / T(blocks); // a power of two: corners are exact
    T bottom = T(y) * size;

    // first axis: the cells that touch the square, and one more for the kink at its right end
    int cells = table_cells(rows);
    int cell0 = glm::min(x * cells / blocks, cells - 1);
    int cell1 = glm::min((x + 1) * cells / blocks, cells - 1);
    int row0 = row_before(bottom, table_rows(rows));
    int row1 = row_after(bottom + size, table_rows(rows));
    table_bends<T> first = bends_between(rows, cell0, cell1, row0, row1);
    T along = T(cells) / unit;
    T across = T(table_rows(rows)) / unit;
    T bend_u = first.along * along * along + first.across * across * across +
               T(2) * first.cross * along * across;
    T reach = first.step_along * T(cells) + first.step_across * T(table_rows(rows));

    // second axis: what the square becomes, and a margin for the curves
    T u0 = T(1);
    T u1 = T(0);
    for (int row = row0; row <= row1; ++row) {
        u0 = glm::min(u0, table_node(rows, row, cell0));
        u1 = glm::max(u1, table_node(rows, row, cell1 + 1));
    }
    cells = table_cells(columns);
    cell0 = glm::min(y * cells / blocks, cells - 1);
    cell1 = glm::min((y + 1) * cells / blocks, cells - 1);
    row0 = row_before(u0 - bend_margin<T>, table_rows(columns));
    row1 = row_after(u1 + bend_margin<T>, table_rows(columns));
    table_bends<T> second = bends_between(columns, cell0, cell1, row0, row1);
    along = T(cells) / unit;
    across = reach * T(table_rows(columns)) / unit;
    T shear = second.step_across * T(table_rows(columns));
    T bend_v = second.along * along * along + second.across * bend_growth(across) +
               T(2) * second.cross * along * across + shear * bend_u;
    return glm::sqrt(bend_u * bend_u + bend_v * bend_v);
}

/// First row of a level of a bend table.
///
/// @param blocks squares along each side at level 0, a power of two, 2 to 64
/// @param level  0 ≤ level; a level has blocks / 2^level squares along each side, at least one
inline int bend_level_row(int blocks, int level) {
    int row = 0;
    int n = blocks;
    for (int i = 0; i < level; ++i) {
        row += n;
        n = n / 2;
    }
    return row;
}

/// D of a square of level 1 or above and of the eight around it, from the level below.
///
/// Level 0 holds squares without their surroundings.
/// @param bends  bend table whose levels below are complete
/// @param blocks squares along each side at level 0, a power of two, 2 to 64
/// @param level  1 or above
/// @param x, y   square, 0 ≤ x, y < blocks / 2^level
template <typename T>
T bend_of_surroundings(const table_view<T>& bends, int blocks, int level, int x, int y) {
    int below = bend_level_row(blocks, level - 1);
    int last = glm::max(bend_level_row(blocks, level) - below - 1, 0);
    int last_row = table_rows(bends) - 1;
    // level 0: six squares across. Above, two of them that know their own surroundings
    int step = level == 1 ? 1 : 3;
    int first_x = level == 1 ? 2 * x - 2 : 2 * x - 1;
    int first_y = level == 1 ? 2 * y - 2 : 2 * y - 1;
    int reach = level == 1 ? 5 : 3;
    T most = T(0);
    for (int j = 0; j <= reach; j += step) {
        for (int i = 0; i <= reach; i += step) {
            int row = glm::min(below + glm::clamp(first_y + j, 0, last), last_row);
            most = glm::max(most, table_node(bends, row, glm::clamp(first_x + i, 0, last)));
        }
    }
    return most;
}

/// Builds the bend table of a pair of tables. Once per pair, not per edge.
///
/// @param rows, columns tables of `warp`
/// @param blocks squares along each side at level 0, a power of two, 2 to 64; 64 by default serves
///               maps of all sizes
/// @param memory at least `bend_nodes(blocks)` numbers
/// @param[out] bends the finished table, in `memory`
/// @return buffer_too_small when memory is too small, a table does not fit its memory, or blocks is
///         no such power: bends is then empty and must not be used
template <typename T, typename Node>
status build_bends(const table_view<T, Node>& rows, const table_view<T, Node>& columns, int blocks,
                   std::span<T> memory, table_view<T>& bends) {
    bends = table_view<T>{};
    const bool power = blocks >= 2 && blocks <= most_bend_blocks && (blocks & (blocks - 1)) == 0;
    if (!power || memory.size() < bend_nodes(blocks) || !fits(rows) || !fits(columns)) {
        return status::buffer_too_small;
    }
    const auto at = [&](int row, int k) -> T& {
        return memory[static_cast<std::size_t>(row) * static_cast<std::size_t>(blocks) +
                      static_cast<std::size_t>(k)];
    };
    for (int y = 0; y < blocks; ++y) {
        for (int x = 0; x < blocks; ++x) {
            at(y, x) = bend_of_block(rows, columns, blocks, x, y);
        }
    }
    bends = {memory.first(bend_nodes(blocks)), bend_cells(blocks), bend_rows(blocks)};
    for (int level = 1, n = blocks / 2; n >= 1; ++level, n /= 2) {
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                at(bend_level_row(blocks, level) + y, x) =
                    bend_of_surroundings(bends, blocks, level, x, y);
            }
        }
    }
    at(bend_rows(blocks) - 1, 1) = T(bend_unit(rows, columns));
    return status::ok;
}

} // namespace warpshadow
