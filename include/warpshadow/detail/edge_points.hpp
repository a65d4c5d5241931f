// Where the edges of a hexahedron enter and leave another convex body of six planes, in lanes.
#pragma once

#include <warpshadow/detail/lanes.hpp>
#include <warpshadow/frustum.hpp>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>

namespace warpshadow::detail {

/// The twelve edges of a hexahedron, as arrays for work in lanes: the rings around the near and
/// far faces, whose edges start at corner 0 to 7 in turn, then the four that join them.
struct hexahedron_edges {
    static constexpr std::size_t count = 12;
    static constexpr std::size_t padded = 16; // whole lanes of 8
    using values = std::array<double, padded>;
    values start[4]; // x, y, z, w
    values end[4];

    template <typename T> explicit hexahedron_edges(const std::array<glm::vec<4, T>, 8>& corners) {
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec4 near_corner(corners[i]);
            const glm::dvec4 far_corner(corners[i + 4]);
            const std::size_t before = (i + 3) % 4;
            for (glm::length_t k = 0; k < 4; ++k) {
                start[k][i] = end[k][before] = near_corner[k];
                start[k][i + 4] = end[k][before + 4] = far_corner[k];
                start[k][i + 8] = start[k][i + 12] = near_corner[k];
                end[k][i + 8] = end[k][i + 12] = far_corner[k];
            }
        }
    }
};

/// Adds the points where each edge enters and leaves another body of six planes.
///
/// An edge whose start lies inside enters there, and one whose end lies inside leaves there; the
/// corners among these are added once, as starts of the rings' edges.
/// An edge runs from t = 0 to 1 and meets a plane at t = |d_a| / (|d_a| + |d_b|). Of the planes
/// through which it enters the last counts, of those through which it leaves the first. Each t is
/// kept as a pair of distances and compared by products: one division per point remains.
/// @param distance distance(plane, point, d) sets d to the signed distances of the points
template <typename L, typename Set, typename Distance>
void add_edge_points(Set& set, const hexahedron_edges& edges, Distance distance) {
    using T = typename Set::value_type;
    constexpr std::size_t width = sizeof(L) / sizeof(double);
    hexahedron_edges::values points[2][3]; // where edges enter, and where they leave
    hexahedron_edges::values found[2];     // 1 where there is such a point
    const L zero = L{};
    const L one = zero + 1.0;
    for (std::size_t first = 0; first < edges.count; first += width) {
        L a[4], b[4];
        for (std::size_t k = 0; k < 4; ++k) {
            load(a[k], &edges.start[k][first]);
            load(b[k], &edges.end[k][first]);
        }
        L enter_a = zero, enter_b = one; // t = 0
        L leave_a = one, leave_b = zero; // t = 1
        auto missed = one < zero;
        for (std::size_t plane = 0; plane < 6; ++plane) {
            L da, db;
            distance(plane, a, da);
            distance(plane, b, db);
            const auto out_a = da < zero;
            const auto out_b = db < zero;
            missed = missed | (out_a & out_b);
            const auto later = out_a & (-da * enter_b > enter_a * db);
            enter_a = later ? -da : enter_a;
            enter_b = later ? db : enter_b;
            const auto sooner = out_b & (da * leave_b < -db * leave_a);
            leave_a = sooner ? da : leave_a;
            leave_b = sooner ? -db : leave_b;
        }
        const L enter_w = enter_b * a[3] + enter_a * b[3];
        const L leave_w = leave_b * a[3] + leave_a * b[3];
        const L entered = enter_a * leave_b;
        const L left = leave_a * enter_b;
        const auto enters = (entered <= left) & (enter_w > zero);
        const auto leaves = (entered < left) & (leave_w > zero) & (leave_b > zero);
        const L per_enter_w = one / (enter_w > zero ? enter_w : one);
        const L per_leave_w = one / (leave_w > zero ? leave_w : one);
        for (std::size_t k = 0; k < 3; ++k) {
            store(&points[0][k][first], L((enter_b * a[k] + enter_a * b[k]) * per_enter_w));
            store(&points[1][k][first], L((leave_b * a[k] + leave_a * b[k]) * per_leave_w));
        }
        // 1: at the edge's start, a corner; 2: inside the edge
        const L at_entry = enter_a > zero ? one + one : one;
        store(&found[0][first], L(missed ? zero : enters ? at_entry : zero));
        store(&found[1][first], L(missed ? zero : leaves ? one : zero));
    }
    std::size_t count = set.count;
    for (std::size_t i = 0; i < edges.count; ++i) {
        // Written first and counted afterwards: no branch to mispredict. Corners come from the
        // rings alone.
        const double least = i < 8 ? 1.0 : 2.0;
        set.points[count] = {static_cast<T>(points[0][0][i]), static_cast<T>(points[0][1][i]),
                             static_cast<T>(points[0][2][i])};
        count += found[0][i] >= least ? 1u : 0u;
        set.points[count] = {static_cast<T>(points[1][0][i]), static_cast<T>(points[1][1][i]),
                             static_cast<T>(points[1][2][i])};
        count += found[1][i] > 0.0 ? 1u : 0u;
    }
    set.count = count;
}

/// Signed distances to the sides of a box.
template <typename T> struct distances_to_box {
    const box3<T>& box;
    template <typename L> void operator()(std::size_t plane, const L* point, L& distance) const {
        const L& x = point[plane / 2];
        const L& w = point[3];
        const auto axis = static_cast<glm::length_t>(plane / 2);
        if (plane % 2 == 0) {
            distance = x - double(box.lo[axis]) * w;
        } else {
            distance = double(box.hi[axis]) * w - x;
        }
    }
};

/// Signed distances of points (w = 1) to six planes.
template <typename T> struct distances_to_planes {
    const std::array<glm::vec<4, T>, 6>& planes;
    template <typename L> void operator()(std::size_t plane, const L* point, L& distance) const {
        const glm::dvec4 p(planes[plane]);
        distance = p.x * point[0] + p.y * point[1] + p.z * point[2] + p.w;
    }
};

/// The corners of a box in the order of `frustum_corners`.
template <typename T> std::array<glm::vec<4, T>, 8> corners_of(const box3<T>& box) {
    const glm::vec<3, T>& a = box.lo;
    const glm::vec<3, T>& b = box.hi;
    return {{{a.x, a.y, a.z, T(1)},
             {b.x, a.y, a.z, T(1)},
             {b.x, b.y, a.z, T(1)},
             {a.x, b.y, a.z, T(1)},
             {a.x, a.y, b.z, T(1)},
             {b.x, a.y, b.z, T(1)},
             {b.x, b.y, b.z, T(1)},
             {a.x, b.y, b.z, T(1)}}};
}

} // namespace warpshadow::detail
