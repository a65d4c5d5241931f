// Evaluation of warp tables: warp, its exact inverse, its Jacobian, and the warp of a vertex.
//
// A table holds one monotone function per row; its w + 1 nodes lie on the cell edges and store the
// function F itself, with F(0) = 0 and F(1) = 1. The function of row i holds at the centre of the
// row, (i + ½) / rows, and functions are blended linearly in between: the two-dimensional map is a
// homeomorphism of the unit square for any tables that increase strictly. Milet et al. 2015, eq. 6
// picks the function by the floor of the row coordinate instead; the map is then still one to one,
// but torn at every row. It is kept for comparison (`warp_floor`).
//
// Everything is evaluated through the offset F − x: tables of the identity give back the very
// number that came in.
#pragma once

#include <warpshadow/detail/glsl_annotation.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

namespace warpshadow {

/// Functions of one axis, for reading: `rows` functions of `cells` + 1 nodes each, row after row.
///
/// Functions that evaluate a table take at least one cell and one row; see `fits`.
/// In a shader this is the macro `WS_TABLE`: a texture, a range of a buffer, or the user's own.
/// @tparam T    type of the results
/// @tparam Node stored type: float, double, or std::uint16_t for [0, 1] in steps of 1/65535
template <typename T, typename Node = T> struct WS_GLSL_TYPE("WS_TABLE") table_view {
    std::span<const Node> nodes; ///< rows · (cells + 1) nodes, row after row
    int cells = 0;               ///< cells along the axis that is warped
    int rows = 0;                ///< functions, one per row across that axis
};

/// Whether a table has a cell and a row, and its memory holds all of them.
template <typename T, typename Node> bool fits(const table_view<T, Node>& table) {
    return table.cells > 0 && table.rows > 0 &&
           table.nodes.size() / (static_cast<std::size_t>(table.cells) + 1) >=
               static_cast<std::size_t>(table.rows);
}

/// Number of cells of each function of a table.
template <typename T, typename Node>
WS_GLSL_CALL("WS_TABLE_CELLS($0)")
int table_cells(const table_view<T, Node>& table) {
    return table.cells;
}

/// Number of functions of a table.
template <typename T, typename Node>
WS_GLSL_CALL("WS_TABLE_ROWS($0)")
int table_rows(const table_view<T, Node>& table) {
    return table.rows;
}

namespace detail {

/// Value of a stored node.
template <typename T, typename Node> T node_value(Node node) {
    if constexpr (std::is_integral_v<Node>) {
        return T(node) / T(std::numeric_limits<Node>::max());
    } else {
        return T(node);
    }
}

} // namespace detail

/// Node k of the function of a row: F_row(k / cells).
///
/// 0 ≤ row < rows and 0 ≤ k ≤ cells.
template <typename T, typename Node>
WS_GLSL_CALL("WS_TABLE_NODE($0, $1, $2)")
T table_node(const table_view<T, Node>& table, int row, int k) {
    return detail::node_value<T>(
        table.nodes[static_cast<std::size_t>(row) * (static_cast<std::size_t>(table.cells) + 1) +
                    static_cast<std::size_t>(k)]);
}

/// x clamped to [0, 1]; 0 for NaN, so that it can be turned into an index.
///
/// A shader that does not honour NaN may return either end.
template <typename T> T clamp_to_unit(T x) {
    return x > T(0) ? glm::min(x, T(1)) : T(0);
}

/// Two neighbouring functions of a table and the weight of the second.
template <typename T> struct row_blend {
    int row0; ///< the function below
    int row1; ///< the function above, `row0` at the border
    T weight; ///< of row1, in [0, 1)
};

/// Functions to blend at a position across the rows; constant beyond the outermost row centres.
///
/// @param across coordinate across the rows in map space; clamped to [0, 1]
/// @param rows   number of functions, positive
template <typename T> row_blend<T> blend_rows(T across, int rows) {
    row_blend<T> blend;
    T position = glm::clamp(clamp_to_unit(across) * T(rows) - T(0.5), T(0), T(rows - 1));
    blend.row0 = glm::clamp(int(position), 0, rows - 1);
    blend.row1 = glm::min(blend.row0 + 1, rows - 1);
    blend.weight = position - T(blend.row0);
    return blend;
}

/// The one function of the row that holds a position (Milet et al. 2015, eq. 6).
///
/// @param across coordinate across the rows in map space; clamped to [0, 1]
/// @param rows   number of functions, positive
template <typename T> row_blend<T> floor_row(T across, int rows) {
    row_blend<T> blend;
    blend.row0 = glm::clamp(int(clamp_to_unit(across) * T(rows)), 0, rows - 1);
    blend.row1 = blend.row0;
    blend.weight = T(0);
    return blend;
}

/// Node k of a blended function.
///
/// @param table functions of one axis
/// @param blend from `blend_rows` or `floor_row`
/// @param k     node, 0 ≤ k ≤ cells
template <typename T, typename Node>
T blended_node(const table_view<T, Node>& table, const row_blend<T>& blend, int k) {
    T node0 = table_node(table, blend.row0, k);
    T node1 = table_node(table, blend.row1, k);
    // exact where both agree, hence F(0) = 0 and F(1) = 1 hold for every blend
    return node0 + blend.weight * (node1 - node0);
}

/// Offset F(x) − x of a blended function.
///
/// @param table functions of one axis
/// @param blend from `blend_rows` or `floor_row`
/// @param x     coordinate along the axis; clamped to [0, 1], where the offset is 0 at both ends
template <typename T, typename Node>
T axis_offset(const table_view<T, Node>& table, const row_blend<T>& blend, T x) {
    int cells = table_cells(table);
    T position = clamp_to_unit(x) * T(cells);
    int k = glm::clamp(int(position), 0, cells - 1);
    T offset0 = blended_node(table, blend, k) - T(k) / T(cells);
    T offset1 = blended_node(table, blend, k + 1) - T(k + 1) / T(cells);
    return offset0 + (position - T(k)) * (offset1 - offset0);
}

/// Slope dF/dx of a blended function in the cell that holds x; the right-hand slope on a node.
///
/// @param table functions of one axis
/// @param blend from `blend_rows` or `floor_row`
/// @param x     coordinate along the axis; clamped to [0, 1]
template <typename T, typename Node>
T axis_slope(const table_view<T, Node>& table, const row_blend<T>& blend, T x) {
    int cells = table_cells(table);
    int k = glm::clamp(int(clamp_to_unit(x) * T(cells)), 0, cells - 1);
    return (blended_node(table, blend, k + 1) - blended_node(table, blend, k)) * T(cells);
}

/// Offset F⁻¹(X) − X in the cell that holds X.
///
/// @param node0,node1 F at the ends of the cell
/// @param cell  its number, 0 ≤ cell < cells
/// @param cells of the function
/// @param image value X of the function, node0 ≤ X ≤ node1; clamped to that
template <typename T> T inverse_offset_in_cell(T node0, T node1, int cell, int cells, T image) {
    T offset0 = node0 - T(cell) / T(cells);
    T offset1 = node1 - T(cell + 1) / T(cells);
    // a cell of no extent is hit only by a table that does not increase: its left end is returned
    T t = node1 > node0 ? glm::clamp((image - node0) / (node1 - node0), T(0), T(1)) : T(0);
    return -(offset0 + t * (offset1 - offset0));
}

/// Offset F⁻¹(X) − X of the inverse of a blended function.
///
/// Finds the cell by bisection and solves in it; no inverse table is interpolated. The error in x
/// is that of X divided by the slope of F, which the density floor bounds from below.
/// @param table functions of one axis, increasing
/// @param blend from `blend_rows` or `floor_row`
/// @param image value X of the function; clamped to [0, 1]
template <typename T, typename Node>
T axis_inverse_offset(const table_view<T, Node>& table, const row_blend<T>& blend, T image) {
    int cells = table_cells(table);
    T clamped = clamp_to_unit(image);
    int below = 0;
    int above = cells;
    T node0 = T(0);
    T node1 = T(1);
    while (above - below > 1) {
        int middle = (below + above) / 2;
        T node = blended_node(table, blend, middle);
        if (node <= clamped) {
            below = middle;
            node0 = node;
        } else {
            above = middle;
            node1 = node;
        }
    }
    return inverse_offset_in_cell(node0, node1, below, cells, clamped);
}

/// Offset F⁻¹(X) − X of the inverse of a blended function, searched from a cell nearby.
///
/// What `axis_inverse_offset` gives, to the bit, where the blended nodes increase, by steps that
/// double until X is between them: a few look-ups if the start is good, twice those of a bisection
/// if it is not.
/// @param table functions of one axis, increasing
/// @param blend from `blend_rows` or `floor_row`
/// @param image value X of the function; clamped to [0, 1]
/// @param cell  where to start; receives the cell that was found
template <typename T, typename Node>
T axis_inverse_offset_near(const table_view<T, Node>& table, const row_blend<T>& blend, T image,
                           int& cell) {
    int cells = table_cells(table);
    T clamped = clamp_to_unit(image);
    int below = 0;
    int above = cells;
    T node0 = T(0);
    T node1 = T(1);
    int probe = glm::clamp(cell, 1, glm::max(cells - 1, 1));
    int up = 1;
    int down = 1;
    // one look-up in each round: a vector of fragments goes through the longest path of all
    while (above - below > 1) {
        T node = blended_node(table, blend, probe);
        bool low = node <= clamped;
        int stride = low ? up : -down;
        if (low) {
            below = probe;
            node0 = node;
            up *= 2;
            down = 0;
        } else {
            above = probe;
            node1 = node;
            down *= 2;
            up = 0;
        }
        // halved once X is between two probes
        probe =
            stride != 0 ? glm::clamp(probe + stride, below + 1, above - 1) : (below + above) / 2;
    }
    cell = below;
    return inverse_offset_in_cell(node0, node1, below, cells, clamped);
}

/// Displacement warp(p) − p, continuous on the whole plane.
///
/// The row functions move u, then the column functions, chosen by the new u, move v. Outside the
/// unit square a coordinate keeps its value: the functions are 0 at 0 and 1 at 1.
/// @param rows    functions of u, one per row (constant v)
/// @param columns functions of v, one per column (constant warped u)
/// @param p       position in map space
template <typename T, typename Node>
glm::vec<2, T> warp_offset(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                           glm::vec<2, T> p) {
    T u = axis_offset(rows, blend_rows(p.y, table_rows(rows)), p.x);
    T v = axis_offset(columns, blend_rows(p.x + u, table_rows(columns)), p.y);
    return glm::vec<2, T>(u, v);
}

/// Warped position of a point of the map (Milet et al. 2015, eq. 6, with rows blended linearly).
///
/// @param rows    functions of u, one per row
/// @param columns functions of v, one per column of the half-warped map
/// @param p       position in map space
/// @return        position in the warped map; p itself, to the bit, for tables of the identity
template <typename T, typename Node>
glm::vec<2, T> warp(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                    glm::vec<2, T> p) {
    return p + warp_offset(rows, columns, p);
}

/// Position whose warp is q: the exact inverse of `warp`, two searches and no iteration.
///
/// |unwarp(warp(p)) − p| is the rounding of warp(p) over the slopes of the functions. For a density
/// floor ε that is about u/ε of the map along v, and (1 + s/ε) u/ε along u where the row functions
/// have a shear s (see `axis_shear`), with u = 2⁻²⁴ in float and 2⁻⁵³ in double. Where samples are
/// dense the slopes are large, and the error is a few u.
/// @param rows    functions of u, one per row
/// @param columns functions of v, one per column of the half-warped map
/// @param q       position in the warped map
template <typename T, typename Node>
glm::vec<2, T> unwarp(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                      glm::vec<2, T> q) {
    T v = q.y + axis_inverse_offset(columns, blend_rows(q.x, table_rows(columns)), q.y);
    T u = q.x + axis_inverse_offset(rows, blend_rows(v, table_rows(rows)), q.x);
    return glm::vec<2, T>(u, v);
}

/// Warped position with the function of a row held constant over the row, as published.
///
/// One to one, but discontinuous across rows: use `warp` for rendering.
/// @see warp
template <typename T, typename Node>
glm::vec<2, T> warp_floor(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                          glm::vec<2, T> p) {
    T u = p.x + axis_offset(rows, floor_row(p.y, table_rows(rows)), p.x);
    T v = p.y + axis_offset(columns, floor_row(u, table_rows(columns)), p.y);
    return glm::vec<2, T>(u, v);
}

/// Exact inverse of `warp_floor`.
/// @see unwarp
template <typename T, typename Node>
glm::vec<2, T> unwarp_floor(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                            glm::vec<2, T> q) {
    T v = q.y + axis_inverse_offset(columns, floor_row(q.x, table_rows(columns)), q.y);
    T u = q.x + axis_inverse_offset(rows, floor_row(v, table_rows(rows)), q.x);
    return glm::vec<2, T>(u, v);
}

/// How fast a blended function changes from row to row: ∂F/∂across.
///
/// Zero beyond the outermost row centres, where the function is constant across.
/// @param table  functions of one axis
/// @param across coordinate across the rows in map space
/// @param x      coordinate along the axis; clamped to [0, 1]
template <typename T, typename Node> T axis_shear(const table_view<T, Node>& table, T across, T x) {
    int rows = table_rows(table);
    T position = across * T(rows) - T(0.5);
    if (!(position >= T(0) && position < T(rows - 1))) {
        return T(0);
    }
    row_blend<T> blend = blend_rows(across, rows);
    row_blend<T> lower;
    lower.row0 = blend.row0;
    lower.row1 = blend.row0;
    lower.weight = T(0);
    row_blend<T> upper;
    upper.row0 = blend.row1;
    upper.row1 = blend.row1;
    upper.weight = T(0);
    return (axis_offset(table, upper, x) - axis_offset(table, lower, x)) * T(rows);
}

/// Jacobian of `warp` at p: column 0 is ∂(U, V)/∂u, column 1 is ∂(U, V)/∂v.
///
/// One-sided (from the right) on the lines where the tables have a kink. Its determinant is the
/// area of map that a unit of area receives: positive, at least the square of the density floor.
/// @param rows    functions of u, one per row
/// @param columns functions of v, one per column of the half-warped map
/// @param p       position in map space; the identity outside the unit square in that coordinate
template <typename T, typename Node>
glm::mat<2, 2, T> jacobian(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                           glm::vec<2, T> p) {
    row_blend<T> row = blend_rows(p.y, table_rows(rows));
    bool inside_u = p.x >= T(0) && p.x <= T(1);
    bool inside_v = p.y >= T(0) && p.y <= T(1);
    T warped_u = p.x + axis_offset(rows, row, p.x);
    row_blend<T> column = blend_rows(warped_u, table_rows(columns));
    T u_du = inside_u ? axis_slope(rows, row, p.x) : T(1);
    T u_dv = inside_u ? axis_shear(rows, p.y, p.x) : T(0);
    T v_dv = inside_v ? axis_slope(columns, column, p.y) : T(1);
    T v_dU = inside_v ? axis_shear(columns, warped_u, p.y) : T(0);
    return glm::mat<2, 2, T>(u_du, v_dU * u_du, u_dv, v_dv + v_dU * u_dv);
}

/// Warps a vertex in the light's clip space (Milet et al. 2015, algorithm 1, in offset form).
///
/// The map is NDC · ½ + ½. Triangles must be clipped to w > 0 before they are warped, and cut
/// where the warp bends them: the rasteriser draws straight edges.
/// @param rows    functions of u, one per row
/// @param columns functions of v, one per column of the half-warped map
/// @param a       homogeneous position, light matrix · vertex
/// @return        a with x and y displaced; a itself for w ≤ 0, for w beyond half the largest
///                number and where a / w is not finite
template <typename T, typename Node>
glm::vec<4, T> warp_clip(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                         glm::vec<4, T> a) {
    T largest = std::numeric_limits<T>::max();
    // half: 2 · offset · w must not overflow on its way
    if (a.w > T(0) && a.w <= T(0.5) * largest) {
        glm::vec<2, T> ndc = glm::vec<2, T>(a.x, a.y) / a.w;
        if (glm::abs(ndc.x) <= largest && glm::abs(ndc.y) <= largest) {
            glm::vec<2, T> offset = warp_offset(rows, columns, ndc * T(0.5) + T(0.5));
            return glm::vec<4, T>(a.x + T(2) * offset.x * a.w, a.y + T(2) * offset.y * a.w, a.z,
                                  a.w);
        }
    }
    return a;
}

} // namespace warpshadow
