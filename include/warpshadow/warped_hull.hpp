// A polygon of three or four corners that holds a warped triangle.
//
// The rasteriser draws straight edges; the warp makes curves of them. Instead of cutting a triangle
// until straight edges come close enough, draw what surely holds the curved one and let each
// fragment decide: its texel's centre, unwarped, lies in the triangle or it does not. What is drawn
// then has no error but rounding, however strong the warp, and cutting is a matter of cost alone:
// `excess` says how much is drawn in vain. Pieces of one triangle need not agree with those of the
// next, because all fragments ask the edges of the whole triangle.
//
// All lengths are in units of the map.
#pragma once

#include <warpshadow/edge_walk.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace warpshadow {

/// How far something reaches in six directions.
template <typename T> struct hull_reach {
    glm::vec<2, T> direction[6];
    T reach[6];
};

/// A polygon that holds a warped triangle.
template <typename T> struct warped_hull {
    glm::vec<2, T> corner[4]; ///< in turn, in the warped map; the fourth is the third of a triangle
    int corners;              ///< 3 or 4
    T area;                   ///< of the polygon, in units of the map
    T excess;                 ///< what of it the triangle between the warped corners leaves
};

/// Product of two vectors that is twice the area between them.
template <typename T> T cross_product(glm::vec<2, T> a, glm::vec<2, T> b) {
    return a.x * b.y - a.y * b.x;
}

/// Lets the reach grow by a warped edge.
///
/// @param rows, columns tables of `warp`
/// @param a, b          ends in the unwarped map; clamped to the unit square
/// @param origin        where reach is measured from, in the warped map
/// @param[in,out] hull  directions, and what they reach so far
template <typename T, typename Node>
void reach_edge(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                glm::vec<2, T> a, glm::vec<2, T> b, glm::vec<2, T> origin, hull_reach<T>& hull) {
    edge_walk<T> walk = walk_edge(rows, columns, a, b);
    while (walk.share < T(1)) {
        T from = walk.share;
        T to = walk_on(walk);
        warped_stretch<T> stretch =
            warp_stretch(rows, columns, walk.a + from * walk.step, walk.a + to * walk.step);
        for (int i = 0; i < 6; ++i) {
            T end = glm::max(glm::dot(hull.direction[i], stretch.from - origin),
                             glm::dot(hull.direction[i], stretch.to - origin));
            hull.reach[i] =
                glm::max(hull.reach[i], end + glm::dot(glm::abs(hull.direction[i]), stretch.bend));
        }
    }
}

/// Where two lines meet that lie `reach` off the origin in their directions.
///
/// The directions are not parallel.
template <typename T>
glm::vec<2, T> meeting_point(glm::vec<2, T> direction0, T reach0, glm::vec<2, T> direction1,
                             T reach1) {
    return glm::vec<2, T>(reach0 * direction1.y - reach1 * direction0.y,
                          reach1 * direction0.x - reach0 * direction1.x) /
           cross_product(direction0, direction1);
}

/// The smaller of a triangle and a rectangle that hold a warped triangle.
///
/// The triangle has the edges between the warped corners, moved outwards; the rectangle lies along
/// the longest of them and is taken for slivers.
/// @param rows, columns tables of `warp`
/// @param p0, p1, p2    corners in the unwarped map; clamped to the unit square
/// @param margin        added on all sides for the rounding of what draws it, 0 or above; the
///                      rounding of this function needs a few units in the last place of 1
template <typename T, typename Node>
warped_hull<T> hull_of_triangle(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                                glm::vec<2, T> p0, glm::vec<2, T> p1, glm::vec<2, T> p2, T margin) {
    glm::vec<2, T> q0 = warp(rows, columns, clamp_to_square(p0));
    glm::vec<2, T> edge0 = warp(rows, columns, clamp_to_square(p1)) - q0;
    glm::vec<2, T> edge2 = q0 - warp(rows, columns, clamp_to_square(p2));
    glm::vec<2, T> edge1 = -edge2 - edge0;
    T length0 = glm::length(edge0);
    T length1 = glm::length(edge1);
    T length2 = glm::length(edge2);
    T longest = glm::max(length0, glm::max(length1, length2));
    glm::vec<2, T> along(T(1), T(0));
    if (longest > T(0)) {
        along = (longest == length0 ? edge0 : longest == length1 ? edge1 : edge2) / longest;
    }
    T twice = cross_product(edge0, edge1);
    T turn = twice < T(0) ? T(-1) : T(1);
    hull_reach<T> hull;
    // a shorter edge without length has no direction: the rectangle is taken then
    hull.direction[0] =
        turn * glm::vec<2, T>(edge0.y, -edge0.x) / glm::max(length0, longest * T(1e-4));
    hull.direction[1] =
        turn * glm::vec<2, T>(edge1.y, -edge1.x) / glm::max(length1, longest * T(1e-4));
    hull.direction[2] =
        turn * glm::vec<2, T>(edge2.y, -edge2.x) / glm::max(length2, longest * T(1e-4));
    hull.direction[3] = along;
    hull.direction[4] = -along;
    hull.direction[5] = turn * glm::vec<2, T>(-along.y, along.x);
    glm::vec<2, T> outward = -hull.direction[5];
    if (!(longest > T(0))) {
        hull.direction[0] = outward;
        hull.direction[1] = outward;
        hull.direction[2] = outward;
    }
    for (int i = 0; i < 6; ++i) {
        hull.reach[i] = T(0);
    }
    glm::vec<2, T> from = p2;
    glm::vec<2, T> to = p0;
    // a loop, and not three calls: shader compilers copy what is called
    for (int i = 0; i < 3; ++i) {
        reach_edge(rows, columns, from, to, q0, hull);
        from = to;
        to = i == 0 ? p1 : p2;
    }

    T beyond = longest == length0 || !(longest > T(0)) ? hull.reach[0]
               : longest == length1                    ? hull.reach[1]
                                                       : hull.reach[2];
    T ahead = hull.reach[3] + margin;
    T behind = -hull.reach[4] - margin;
    T inner = hull.reach[5] + margin;
    beyond = beyond + margin;
    warped_hull<T> result;
    result.corners = 4;
    result.corner[0] = q0 + ahead * along + beyond * outward;
    result.corner[1] = q0 + behind * along + beyond * outward;
    result.corner[2] = q0 + behind * along - inner * outward;
    result.corner[3] = q0 + ahead * along - inner * outward;
    result.area = (ahead - behind) * (beyond + inner);

    // between lines that are nearly parallel a corner is far off and not accurate
    T sine = glm::min(cross_product(hull.direction[0], hull.direction[1]) * turn,
                      glm::min(cross_product(hull.direction[1], hull.direction[2]) * turn,
                               cross_product(hull.direction[2], hull.direction[0]) * turn));
    if (sine > T(0.02)) {
        glm::vec<2, T> c0 = meeting_point(hull.direction[2], hull.reach[2] + margin,
                                          hull.direction[0], hull.reach[0] + margin);
        glm::vec<2, T> c1 = meeting_point(hull.direction[0], hull.reach[0] + margin,
                                          hull.direction[1], hull.reach[1] + margin);
        glm::vec<2, T> c2 = meeting_point(hull.direction[1], hull.reach[1] + margin,
                                          hull.direction[2], hull.reach[2] + margin);
        T area = T(0.5) * glm::abs(cross_product(c1 - c0, c2 - c0));
        if (area < result.area) {
            result.corners = 3;
            result.corner[0] = q0 + c0;
            result.corner[1] = q0 + c1;
            result.corner[2] = q0 + c2;
            result.corner[3] = result.corner[2];
            result.area = area;
        }
    }
    result.excess = result.area - T(0.5) * glm::abs(twice);
    return result;
}

} // namespace warpshadow
