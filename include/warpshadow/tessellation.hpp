// How often warped edges must be cut for straight lines to follow them.
//
// The rasteriser draws straight edges; the warp makes curves of them. What an edge is cut into
// depends on the edge alone, to the bit, so that both triangles on it agree. With depth from the
// unwarped place per fragment, only the outline of a triangle matters: what lies between is drawn
// by whichever piece covers it. The bound is that of `edge_deviation` (edge_walk.hpp), by proof.
//
// All lengths are in units of the map. Edges lie in the unit square: clip before warping.
#pragma once

#include <warpshadow/edge_walk.hpp>
#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace warpshadow {

/// Whether an edge must be cut in half: the rule for recursive subdivision.
///
/// Cut triangles until no edge asks for it; no outline then departs by more than is allowed.
/// @param rows, columns tables of `warp`
/// @param a, b    ends of the edge, in the unit square of the unwarped map
/// @param allowed deviation in units of the map, above 0
template <typename T, typename Node>
bool edge_needs_cut(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                    glm::vec<2, T> a, glm::vec<2, T> b, T allowed) {
    return edge_deviation(rows, columns, a, b, allowed) > allowed;
}

/// Deviation that is left when an edge is cut into equal pieces: the largest of the pieces' bounds.
///
/// @param rows, columns tables of `warp`
/// @param a, b     ends of the edge, in the unit square of the unwarped map
/// @param segments pieces, 1 or above
/// @param enough   a deviation above which the answer no longer matters: the search may stop there
template <typename T, typename Node>
T split_deviation(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                  glm::vec<2, T> a, glm::vec<2, T> b, int segments, T enough) {
    // the same pieces from both ends
    bool swapped = b.x < a.x || (b.x == a.x && b.y < a.y);
    glm::vec<2, T> from = swapped ? b : a;
    glm::vec<2, T> step = (swapped ? a : b) - from;
    T most = T(0);
    for (int i = 0; i < segments && !(most > enough); ++i) {
        glm::vec<2, T> begin = from + (T(i) / T(segments)) * step;
        glm::vec<2, T> end = from + (T(i + 1) / T(segments)) * step;
        most = glm::max(most, edge_deviation(rows, columns, begin, end, enough));
    }
    return most;
}

/// Number of equal pieces into which an edge must be cut: the factor of hardware tessellation.
///
/// The first power of two that keeps the bound. For the outline of the triangle this is proved;
/// inner edges of the tessellator's pattern may bend more where the triangle is much larger than
/// the cells of the tables, and then a piece may reach beyond the outline by as much.
/// `hull_of_triangle` has no such limit.
/// @param rows, columns tables of `warp`
/// @param a, b    ends of the edge, in the unit square of the unwarped map
/// @param allowed deviation in units of the map, above 0
/// @param limit   largest answer, 1 or above; what is then reached is `split_deviation`
/// @return        1 where nothing needs to be cut
template <typename T, typename Node>
int edge_segments(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                  glm::vec<2, T> a, glm::vec<2, T> b, T allowed, int limit) {
    int segments = 1;
    while (segments < limit && split_deviation(rows, columns, a, b, segments, allowed) > allowed) {
        segments = glm::min(2 * segments, limit);
    }
    return segments;
}

} // namespace warpshadow
