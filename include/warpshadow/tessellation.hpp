// How often warped edges must be cut for straight lines to follow them.
//
// The rasteriser draws straight edges; the warp makes curves of them. By the bound of a bend table
// (bend_table.hpp), or by trying points along an edge. What an edge is cut into depends on the edge
// alone, so that both triangles on it agree.
//
// All lengths are in units of the map. Edges lie in the unit square: clip before warping.
#pragma once

#include <warpshadow/bend_table.hpp>
#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace warpshadow {

/// Cells in a unit of the map, in which a bend table measures edges (see `bend_unit`).
template <typename T> T bend_cells_per_map(const table_view<T>& bends) {
    return table_node(bends, table_rows(bends) - 1, 1);
}

/// Longer side of the box of an edge, in units of the map: the length that bends go by.
template <typename T> T bend_length(glm::vec<2, T> a, glm::vec<2, T> b) {
    return glm::max(glm::abs(b.x - a.x), glm::abs(b.y - a.y));
}

/// D for an edge and for every triangle of which it is the longest.
///
/// One look-up. Depends on the edge alone and not on its direction, to the bit.
/// @param bends table of `build_bends`
/// @param a, b  ends of the edge, in the unit square of the unwarped map
template <typename T> T edge_bend(const table_view<T>& bends, glm::vec<2, T> a, glm::vec<2, T> b) {
    T reach = bend_length(a, b);
    int n = table_cells(bends) + 1;
    int row = n;
    n = n / 2;
    // the smallest squares that are no smaller than the edge
    while (n > 1 && reach * T(n) > T(1)) {
        row += n;
        n = n / 2;
    }
    glm::vec<2, T> middle = (a + b) * T(0.5);
    int x = glm::min(int(clamp_to_unit(middle.x) * T(n)), n - 1);
    int y = glm::min(int(clamp_to_unit(middle.y) * T(n)), n - 1);
    return table_node(bends, glm::min(row + y, table_rows(bends) - 1), x);
}

/// D f(n): how far an edge of n cells departs from the line between its ends, at most.
///
/// @param bend  D, 0 or above
/// @param cells n, 0 or above
template <typename T> T bend_deviation(T bend, T cells) {
    return bend * (cells <= T(1) ? T(0.25) * cells : T(0.125) * (cells * cells + T(1)));
}

/// How far the warped edge departs from the straight line between its warped ends, at most.
///
/// Points are compared at the same share of the edge. The same holds for all points of a triangle
/// of which no edge is longer (`bend_length`), against its plane interpolation. A bound up to
/// `bend_margin`; above, the deviation may be larger still. Rounding of the tables' evaluation adds
/// its own, a few units in the last place of 1.
/// @param bends table of `build_bends`
/// @param a, b  ends of the edge, in the unit square of the unwarped map
/// @return      length in the warped map, in units of the map: times its size, in texels
template <typename T>
T edge_deviation(const table_view<T>& bends, glm::vec<2, T> a, glm::vec<2, T> b) {
    return bend_deviation(edge_bend(bends, a, b), bend_length(a, b) * bend_cells_per_map(bends));
}

/// Whether an edge must be cut in half: the rule for recursive subdivision.
///
/// Cut triangles until no edge asks for it; no triangle then departs by more than is allowed.
/// @param bends   table of `build_bends`
/// @param a, b    ends of the edge, in the unit square of the unwarped map
/// @param allowed deviation in units of the map, above 0; taken as `bend_margin` where it is larger
template <typename T>
bool edge_needs_cut(const table_view<T>& bends, glm::vec<2, T> a, glm::vec<2, T> b, T allowed) {
    return edge_deviation(bends, a, b) > glm::min(allowed, bend_margin<T>);
}

/// Largest deviation met at points along a warped edge: what the bound is a bound of, by trying.
///
/// Equal intervals, about two to a cell and sixteen at most; so what lies between two points is not
/// seen. Depends on the edge alone and not on its direction, to the bit.
/// @param rows, columns tables of `warp`
/// @param a, b   ends of the edge, in the unit square of the unwarped map
/// @param enough a deviation above which the search may stop
template <typename T, typename Node>
T measured_deviation(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                     glm::vec<2, T> a, glm::vec<2, T> b, T enough) {
    bool swapped = b.x < a.x || (b.x == a.x && b.y < a.y);
    glm::vec<2, T> from = swapped ? b : a;
    glm::vec<2, T> to = swapped ? a : b;
    glm::vec<2, T> warped_from = warp(rows, columns, from);
    glm::vec<2, T> warped_to = warp(rows, columns, to);
    T cells = bend_length(a, b) * T(glm::max(glm::max(table_cells(rows), table_rows(rows)),
                                             glm::max(table_cells(columns), table_rows(columns))));
    T most = T(0);
    // the middle first, then between: an edge that bends is told apart early
    T step = T(1);
    int points = 1;
    bool finer = true;
    while (finer) {
        for (int k = 0; k < points; ++k) {
            T share = (T(k) + T(0.5)) * step;
            glm::vec<2, T> curve = warp(rows, columns, from + share * (to - from));
            glm::vec<2, T> line = warped_from + share * (warped_to - warped_from);
            most = glm::max(most, glm::length(curve - line));
        }
        step = T(0.5) * step;
        points = 2 * points;
        finer = most <= enough && step > T(0.1) && step * cells > T(0.5);
    }
    return most;
}

/// Whether an edge must be cut in half, by the bound first and then by trying.
///
/// Where functions have steep places the bound asks for many more cuts than are needed. Here an
/// edge is left whole if the bound allows it, or else if the deviation allows it at every point
/// that is tried: measured, not proved. Depends on the edge alone and not on its direction.
/// @param rows, columns tables of `warp`
/// @param bends   their bend table
/// @param a, b    ends of the edge, in the unit square of the unwarped map
/// @param allowed deviation in units of the map, above 0
template <typename T, typename Node>
bool edge_departs(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                  const table_view<T>& bends, glm::vec<2, T> a, glm::vec<2, T> b, T allowed) {
    bool departs = edge_needs_cut(bends, a, b, allowed);
    if (departs) {
        departs = measured_deviation(rows, columns, a, b, allowed) > allowed;
    }
    return departs;
}

/// Number of equal pieces into which an edge must be cut: the rule for hardware tessellation.
///
/// Along the edge the bound is proved. A triangle cut into n² similar ones keeps it everywhere for
/// the largest n of its edges; patterns with other pieces inside need a margin.
/// @param bends   table of `build_bends`
/// @param a, b    ends of the edge, in the unit square of the unwarped map
/// @param allowed deviation in units of the map, above 0; taken as `bend_margin` where it is larger
/// @param limit   largest answer, 1 or above; what is then reached is `split_deviation`
/// @return        1 where nothing needs to be cut
template <typename T>
int edge_segments(const table_view<T>& bends, glm::vec<2, T> a, glm::vec<2, T> b, T allowed,
                  int limit) {
    T bend = edge_bend(bends, a, b);
    T cells = bend_length(a, b) * bend_cells_per_map(bends);
    T most = glm::min(allowed, bend_margin<T>);
    if (!(bend_deviation(bend, cells) > most)) {
        return 1;
    }
    T share = most / bend;
    T longest = share >= T(0.25) ? glm::sqrt(glm::max(T(8) * share - T(1), T(1))) : T(4) * share;
    if (!(longest * T(limit) > cells)) {
        return limit;
    }
    return glm::clamp(int(glm::ceil(cells / longest)), 1, limit);
}

/// Deviation that is left when an edge is cut into equal pieces.
///
/// @param bends    table of `build_bends`
/// @param a, b     ends of the edge, in the unit square of the unwarped map
/// @param segments pieces, 1 or above
template <typename T>
T split_deviation(const table_view<T>& bends, glm::vec<2, T> a, glm::vec<2, T> b, int segments) {
    return bend_deviation(edge_bend(bends, a, b),
                          bend_length(a, b) * bend_cells_per_map(bends) / T(segments));
}

} // namespace warpshadow
