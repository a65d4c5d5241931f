// The curve that the warp makes of a straight edge, stretch by stretch.
//
// Tables have kinks on lines of the unwarped map: at the nodes of the functions of u, at the
// centres of their rows, and at the nodes of the functions of v. Between two such lines the warp of
// a straight edge is smooth, and how far it departs from the chord of the stretch is known from the
// nodes around it alone. So an edge is walked from line to line, and no bound has to hold for
// places where the edge is not. An edge within one cell is one stretch.
//
// Along a stretch U is a parabola: a bilinear cell with mixed difference X departs from its chord
// by X Δs Δw / 4 for the steps Δs along the cell and Δw across the rows. V is a function of v and
// of the curved U. It departs by a fourth of the kinks that U crosses times the rows crossed (a
// polygon of length L whose slope varies by S departs from its chord by no more than L S / 4), by a
// fourth of its own mixed difference, and by its slope across the rows times the departure of U.
//
// All lengths are in units of the map.
#pragma once

#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace warpshadow {

/// Part of a warped edge without a kink of the unwarped map.
template <typename T> struct warped_stretch {
    glm::vec<2, T> from; ///< warped place of its beginning
    glm::vec<2, T> to;   ///< of its end
    glm::vec<2, T> bend; ///< how far the curve departs from the line between them at most, by axis
};

/// A straight edge on its way over the lines where the tables have kinks.
template <typename T> struct edge_walk {
    glm::vec<2, T> a;    ///< where the edge begins
    glm::vec<2, T> step; ///< to its end
    glm::vec<3, T> at;   ///< in nodes of the rows, row centres, nodes of the columns
    glm::vec<3, T> rate; ///< how these change over the edge
    glm::vec<3, T> line; ///< the next line of each kind
    T share;             ///< of the edge that is walked, 0 to 1
};

/// The unit square's nearest point; 0 for NaN.
template <typename T> glm::vec<2, T> clamp_to_square(glm::vec<2, T> p) {
    return glm::vec<2, T>(clamp_to_unit(p.x), clamp_to_unit(p.y));
}

/// Begins to walk an edge.
///
/// @param rows, columns tables of `warp`
/// @param a, b          ends in the unwarped map; clamped to the unit square
template <typename T, typename Node>
edge_walk<T> walk_edge(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                       glm::vec<2, T> a, glm::vec<2, T> b) {
    edge_walk<T> walk;
    walk.a = clamp_to_square(a);
    walk.step = clamp_to_square(b) - walk.a;
    glm::vec<3, T> scale(T(table_cells(rows)), T(table_rows(rows)), T(table_cells(columns)));
    walk.at = glm::vec<3, T>(walk.a.x, walk.a.y, walk.a.y) * scale - glm::vec<3, T>(0, T(0.5), 0);
    walk.rate = glm::vec<3, T>(walk.step.x, walk.step.y, walk.step.y) * scale;
    for (int i = 0; i < 3; ++i) {
        walk.line[i] =
            walk.rate[i] > T(0) ? glm::floor(walk.at[i]) + T(1) : glm::ceil(walk.at[i]) - T(1);
    }
    walk.share = T(0);
    return walk;
}

/// Goes on to the next line, or to the end of the edge.
///
/// @return share of the edge that is then walked; 1 at the end
template <typename T> T walk_on(edge_walk<T>& walk) {
    T next = T(1);
    for (int i = 0; i < 3; ++i) {
        if (walk.rate[i] != T(0)) {
            next = glm::min(next, (walk.line[i] - walk.at[i]) / walk.rate[i]);
        }
    }
    next = glm::max(next, walk.share);
    for (int i = 0; i < 3; ++i) {
        if (walk.rate[i] != T(0) && !((walk.line[i] - walk.at[i]) / walk.rate[i] > next)) {
            walk.line[i] += walk.rate[i] > T(0) ? T(1) : T(-1);
        }
    }
    walk.share = next;
    return next;
}

/// Warp of a stretch that crosses no line inside, and how far it bends.
///
/// @param rows, columns tables of `warp`
/// @param begin, end    its ends in the unwarped map; clamped to the unit square
template <typename T, typename Node>
warped_stretch<T> warp_stretch(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                               glm::vec<2, T> begin, glm::vec<2, T> end) {
    warped_stretch<T> stretch;
    glm::vec<2, T> p0 = clamp_to_square(begin);
    glm::vec<2, T> p1 = clamp_to_square(end);
    glm::vec<2, T> middle = (p0 + p1) * T(0.5);
    // U, in one cell between two rows
    int cells = table_cells(rows);
    int k = glm::min(int(middle.x * T(cells)), cells - 1);
    row_blend<T> blend = blend_rows(middle.y, table_rows(rows));
    T last = T(table_rows(rows) - 1);
    T w0 = glm::clamp(p0.y * T(table_rows(rows)) - T(0.5), T(0), last) - T(blend.row0);
    T w1 = glm::clamp(p1.y * T(table_rows(rows)) - T(0.5), T(0), last) - T(blend.row0);
    T s0 = p0.x * T(cells) - T(k);
    T s1 = p1.x * T(cells) - T(k);
    T below = table_node(rows, blend.row0, k);
    T above = table_node(rows, blend.row1, k);
    T below_step = table_node(rows, blend.row0, k + 1) - below;
    T above_step = table_node(rows, blend.row1, k + 1) - above;
    T mixed = above_step - below_step;
    stretch.from.x = below + s0 * below_step + w0 * (above - below + s0 * mixed);
    stretch.to.x = below + s1 * below_step + w1 * (above - below + s1 * mixed);
    stretch.bend.x = T(0.25) * glm::abs(mixed * (s1 - s0) * (w1 - w0));

    // V, in one cell but across as many rows as the curved U meets
    cells = table_cells(columns);
    k = glm::min(int(middle.y * T(cells)), cells - 1);
    s0 = p0.y * T(cells) - T(k);
    s1 = p1.y * T(cells) - T(k);
    int count = table_rows(columns);
    T x0 = stretch.from.x * T(count) - T(0.5);
    T x1 = stretch.to.x * T(count) - T(0.5);
    T slack = stretch.bend.x * T(count);
    // compared before they are converted: a NaN of the tables costs a few rows, not all numbers
    T low = glm::floor(glm::min(x0, x1) - slack);
    T high = glm::ceil(glm::max(x0, x1) + slack);
    int first = low > T(-1) ? (low < T(count - 1) ? int(low) : count - 1) : -1;
    int last_row = high > T(first + 1) ? (high < T(count) ? int(high) : count) : first + 1;
    glm::vec<2, T> node(T(0));  // of the functions, at both nodes of the cell
    glm::vec<2, T> slope(T(0)); // from row to row
    glm::vec<2, T> kinks(T(0));
    glm::vec<2, T> at_x0(T(0));
    glm::vec<2, T> at_x1(T(0));
    T steepest = T(0);
    for (int j = first; j <= last_row; ++j) {
        int row = glm::clamp(j, 0, count - 1);
        glm::vec<2, T> next(table_node(columns, row, k), table_node(columns, row, k + 1));
        if (j > first) {
            glm::vec<2, T> next_slope = next - node;
            steepest = glm::max(steepest, glm::max(glm::abs(next_slope.x), glm::abs(next_slope.y)));
            if (j > first + 1) {
                kinks += glm::abs(next_slope - slope);
            }
            // the last interval that begins at or before the place
            T x = T(j - 1);
            if (x0 >= x || j == first + 1) {
                at_x0 = node + (x0 - x) * next_slope;
            }
            if (x1 >= x || j == first + 1) {
                at_x1 = node + (x1 - x) * next_slope;
            }
            slope = next_slope;
        }
        node = next;
    }
    T span0 = at_x0.y - at_x0.x;
    T span1 = at_x1.y - at_x1.x;
    stretch.from.y = at_x0.x + s0 * span0;
    stretch.to.y = at_x1.x + s1 * span1;
    stretch.bend.y = T(0.25) * (glm::max(kinks.x, kinks.y) * glm::abs(x1 - x0) +
                                glm::abs((s1 - s0) * (span1 - span0))) +
                     steepest * slack;
    return stretch;
}

/// How far the curve of a warped edge leaves the line through its warped ends: a proved bound.
///
/// Measured across the line, which is what moves the border of what is rasterised; along it points
/// may move. Rounding adds a few units in the last place of 1. Depends on the edge alone and not on
/// its direction, to the bit: both triangles on it get the same.
/// @param rows, columns tables of `warp`
/// @param a, b          ends in the unwarped map; clamped to the unit square
/// @param enough        a deviation above which the answer no longer matters: the walk may stop
/// there
/// @return              length in the warped map, in units of the map; 0 for an edge without length
template <typename T, typename Node>
T edge_deviation(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                 glm::vec<2, T> a, glm::vec<2, T> b, T enough) {
    bool swapped = b.x < a.x || (b.x == a.x && b.y < a.y);
    edge_walk<T> walk = walk_edge(rows, columns, swapped ? b : a, swapped ? a : b);
    glm::vec<2, T> origin = warp(rows, columns, walk.a);
    glm::vec<2, T> chord = warp(rows, columns, walk.a + walk.step) - origin;
    T length = glm::length(chord);
    glm::vec<2, T> across =
        length > T(0) ? glm::vec<2, T>(-chord.y, chord.x) / length : glm::vec<2, T>(T(0));
    glm::vec<2, T> size = length > T(0) ? glm::abs(across) : glm::vec<2, T>(T(1));
    T most = T(0);
    while (walk.share < T(1) && !(most > enough)) {
        T from = walk.share;
        T to = walk_on(walk);
        warped_stretch<T> stretch =
            warp_stretch(rows, columns, walk.a + from * walk.step, walk.a + to * walk.step);
        T away = glm::max(glm::abs(glm::dot(across, stretch.from - origin)),
                          glm::abs(glm::dot(across, stretch.to - origin)));
        most = glm::max(most, away + glm::dot(size, stretch.bend));
    }
    return most;
}

} // namespace warpshadow
