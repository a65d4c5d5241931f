// Convex bodies of few planes: clipping, frustum and box, volume, and vertices alone, fast.
#pragma once

#include <warpshadow/detail/edge_points.hpp>
#include <warpshadow/detail/lanes.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/status.hpp>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace warpshadow {

/// A convex body with at most `Planes` faces, as its vertices and the planes each of them lies on.
///
/// Two vertices are joined by an edge exactly if they share two planes; no other topology is kept.
/// A convex body with F faces has at most 2F - 4 vertices: Euler's V - E + F = 2 with at least
/// three edges at each vertex, 2E >= 3V. A frustum clipped by a box has 12 faces, so 20 vertices.
///
/// Vertices are homogeneous: w = 1 for a point, w = 0 for a direction, where the body has no end.
template <typename T, std::size_t Planes = 12> struct convex_body {
    static_assert(Planes >= 6 && Planes <= 64, "planes are the bits of a 64-bit mask");
    static constexpr std::size_t capacity = 2 * Planes - 4;

    std::array<glm::vec<4, T>, capacity> vertices;
    std::array<std::uint64_t, capacity> planes_at; ///< bit k: the vertex lies on plane k
    std::size_t count;                             ///< vertices in use
    std::size_t planes;                            ///< planes in use
    status flags; ///< `empty_body`, `degenerate_extent`, `unbounded`, `capacity_reached`,
                  ///< `invalid_input`: of everything done to the body so far
};

/// Where the edge from a to b meets a plane, given the signed distances of its ends.
///
/// Precondition: one distance is negative and the other positive, both finite.
/// Precondition: w of a and b is 1 (a point) or 0 (a direction).
/// Returns |d_b|·a + |d_a|·b with w scaled to 1, or a direction if both ends are. The weights are
/// positive, so that nothing cancels: the point lies within the bounds of the edge, and within
/// 4 ulp of its ends' size of the exact point for these distances. The ends are put in order
/// first: an edge gives the same bits in both directions and seen from both sides of the plane,
/// whatever the compiler contracts.
template <typename T>
glm::vec<4, T> edge_plane_point(const glm::vec<4, T>& a, double distance_a, const glm::vec<4, T>& b,
                                double distance_b) {
    const bool ordered = std::abs(distance_a) >= std::abs(distance_b);
    const glm::dvec4 p(ordered ? a : b); // the end farther from the plane
    const glm::dvec4 q(ordered ? b : a);
    const double from_p = std::abs(ordered ? distance_a : distance_b);
    const double from_q = std::abs(ordered ? distance_b : distance_a);
    const double at_p = from_q / (from_p + from_q);
    const double at_q = from_p / (from_p + from_q);
    glm::dvec4 point(0.0, 0.0, 0.0, p.w == 0.0 && q.w == 0.0 ? 0.0 : 1.0);
    for (glm::length_t k = 0; k < 3; ++k) {
        if (p.w == q.w) {
            point[k] =
                std::clamp(at_p * p[k] + at_q * q[k], std::min(p[k], q[k]), std::max(p[k], q[k]));
        } else if (p.w == 0.0) {
            point[k] = q[k] + from_q / from_p * p[k];
        } else {
            point[k] = p[k] + from_p / from_q * q[k];
        }
    }
    return glm::vec<4, T>(point);
}

namespace detail {

/// Cuts off the vertices at negative distances.
///
/// Strict: a new vertex appears only on an edge from strictly inside to strictly outside, so a
/// plane through a vertex makes no second copy of it.
/// @param on_plane puts a new vertex exactly on the plane where that can be done
template <typename T, std::size_t Planes, typename OnPlane>
void cut(convex_body<T, Planes>& body, const std::array<double, 2 * Planes - 4>& distance,
         OnPlane on_plane) {
    const std::size_t used = body.count;
    std::size_t inside = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < used; ++i) {
        inside += distance[i] > 0.0 ? 1u : 0u;
        kept += distance[i] >= 0.0 ? 1u : 0u;
    }
    if (kept == used && inside > 0) {
        return; // the plane touches at most: it is no face of the body
    }
    // What lies in the plane has no new face, nor any edge that would be cut.
    const bool flat = inside == 0;

    std::array<glm::vec<4, T>, 2 * Planes - 4> made;
    std::array<std::uint64_t, 2 * Planes - 4> made_at;
    std::size_t count = 0;
    const std::uint64_t bit = flat ? 0 : std::uint64_t{1} << (body.planes & 63);
    if (!flat) {
        if (body.planes == Planes) {
            body.flags |= status::capacity_reached;
            return;
        }
        for (std::size_t i = 0; i < used; ++i) {
            if (!(distance[i] > 0.0)) {
                continue;
            }
            for (std::size_t j = 0; j < used; ++j) {
                const std::uint64_t shared = body.planes_at[i] & body.planes_at[j];
                if (!(distance[j] < 0.0) || std::popcount(shared) < 2) {
                    continue;
                }
                if (kept + count == made.size()) {
                    body.flags |= status::capacity_reached;
                    return;
                }
                made[count] = on_plane(
                    edge_plane_point(body.vertices[i], distance[i], body.vertices[j], distance[j]));
                made_at[count++] = shared | bit;
            }
        }
        ++body.planes;
    }
    std::size_t end = 0;
    for (std::size_t i = 0; i < used; ++i) {
        if (distance[i] >= 0.0) {
            body.vertices[end] = body.vertices[i];
            body.planes_at[end++] = body.planes_at[i] | (distance[i] == 0.0 ? bit : 0);
        }
    }
    std::copy_n(made.begin(), count, body.vertices.begin() + static_cast<std::ptrdiff_t>(end));
    std::copy_n(made_at.begin(), count, body.planes_at.begin() + static_cast<std::ptrdiff_t>(end));
    body.count = end + count;
    if (body.count == 0) { // what it was before does not matter any more
        body.flags =
            status::empty_body | (body.flags & (status::invalid_input | status::capacity_reached));
    } else if (flat) {
        body.flags |= status::degenerate_extent;
    }
}

} // namespace detail

/// The body with these eight corners: near (left bottom, right bottom, right top, left top), then
/// far in the same order, as `frustum_corners` gives them.
///
/// Its planes are 0 to 5: left, right, bottom, top, near, far. w must be 1 or 0; a corner with a
/// NaN or an infinity makes the body empty (`empty_body`, `invalid_input`).
template <typename T, std::size_t Planes = 12>
convex_body<T, Planes> body_from_corners(const std::array<glm::vec<4, T>, 8>& corners) {
    convex_body<T, Planes> body{};
    for (std::size_t i = 0; i < 8; ++i) {
        const glm::vec<4, T>& corner = corners[i];
        if (!detail::all_finite(corner) || (corner.w != T(0) && corner.w != T(1))) {
            body = {};
            body.flags = status::empty_body | status::invalid_input;
            return body;
        }
        const std::uint64_t side = i % 4 == 1 || i % 4 == 2 ? 1u << 1 : 1u << 0;
        const std::uint64_t level = i % 4 >= 2 ? 1u << 3 : 1u << 2;
        const std::uint64_t end = i < 4 ? 1u << 4 : 1u << 5;
        body.vertices[i] = corner;
        body.planes_at[i] = side | level | end;
    }
    body.count = 8;
    body.planes = 6;
    return body;
}

/// Removes what lies outside a plane (n, d), where dot(n, p) + d < 0.
///
/// The body stays closed: what lies in the plane remains, a flat body too (`degenerate_extent` if
/// nothing else remains). Vertices are classified by their distances in double; one that is closer
/// to the plane than rounding, 4·2^-53·(|n||p| + |d|), may go either way.
///
/// A normal of zero removes nothing or, if d < 0, everything. A plane that is not finite is ignored
/// (`invalid_input`). Beyond the capacity the body is left as it was, which is larger than
/// wanted but holds everything (`capacity_reached`).
template <typename T, std::size_t Planes>
void clip_body(convex_body<T, Planes>& body, const glm::vec<4, T>& plane) {
    if (!detail::all_finite(plane)) {
        body.flags |= status::invalid_input;
        return;
    }
    const glm::dvec4 p(plane);
    std::array<double, 2 * Planes - 4> distance;
    for (std::size_t i = 0; i < body.count; ++i) {
        const glm::dvec4 v(body.vertices[i]);
        distance[i] = p.x * v.x + p.y * v.y + p.z * v.z + p.w * v.w;
    }
    detail::cut(body, distance, [](const glm::vec<4, T>& point) { return point; });
}

/// Removes what lies outside an axis-aligned box.
///
/// Coordinates are compared as they are, and new vertices lie on the box's planes exactly. So a
/// box plane through a corner or an edge of the body, or in one of its faces, makes no
/// duplicates, and lo == hi gives a flat body (`degenerate_extent`). Infinite bounds do not clip.
/// A NaN or lo > hi makes the body empty (`empty_body`, `invalid_input`). A body that is still
/// without an end afterwards says so (`unbounded`).
template <typename T, std::size_t Planes>
void clip_body(convex_body<T, Planes>& body, const box3<T>& box) {
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        if (!(box.lo[axis] <= box.hi[axis])) {
            body.count = 0;
            body.flags |= status::empty_body | status::invalid_input;
            return;
        }
    }
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            const T bound = sign > 0.0 ? box.lo[axis] : box.hi[axis];
            if (!std::isfinite(bound)) {
                continue;
            }
            std::array<double, 2 * Planes - 4> distance;
            for (std::size_t i = 0; i < body.count; ++i) {
                const glm::vec<4, T>& v = body.vertices[i];
                distance[i] = sign * (double(v[axis]) - (v.w == T(0) ? 0.0 : double(bound)));
            }
            detail::cut(body, distance, [&](glm::vec<4, T> point) {
                point[axis] = point.w == T(0) ? T(0) : bound;
                return point;
            });
        }
    }
    for (std::size_t i = 0; i < body.count; ++i) {
        if (body.vertices[i].w == T(0)) {
            body.flags |= status::unbounded;
        }
    }
}

/// What a frustum and a box have in common, both relative to the same origin.
///
/// @param corners as `frustum_corners` gives them; the far ones may be directions
template <typename T>
convex_body<T> intersection(const std::array<glm::vec<4, T>, 8>& corners, const box3<T>& box) {
    convex_body<T> body = body_from_corners(corners);
    clip_body(body, box);
    return body;
}

/// Volume of a body, in double; 0 for one that is empty or flat, the largest double for one that
/// has no end.
///
/// The sum over all faces' edges of the tetrahedra that reach to the faces' and the body's centre.
template <typename T, std::size_t Planes> double volume(const convex_body<T, Planes>& body) {
    const std::size_t used = body.count;
    glm::dvec3 centre(0.0);
    for (std::size_t i = 0; i < used; ++i) {
        if (body.vertices[i].w == T(0)) {
            return std::numeric_limits<double>::max();
        }
        centre += glm::dvec3(body.vertices[i]) / static_cast<double>(used);
    }
    double sum = 0.0;
    for (std::size_t plane = 0; plane < body.planes; ++plane) {
        const std::uint64_t bit = std::uint64_t{1} << plane;
        glm::dvec3 middle(0.0);
        double corners = 0.0;
        for (std::size_t i = 0; i < used; ++i) {
            if ((body.planes_at[i] & bit) != 0) {
                middle += glm::dvec3(body.vertices[i]) - centre;
                corners += 1.0;
            }
        }
        middle /= std::max(corners, 1.0);
        for (std::size_t i = 0; i < used; ++i) {
            for (std::size_t j = i + 1; j < used; ++j) {
                const std::uint64_t shared = body.planes_at[i] & body.planes_at[j];
                if ((shared & bit) != 0 && std::popcount(shared) >= 2) {
                    const glm::dvec3 a = glm::dvec3(body.vertices[i]) - centre;
                    const glm::dvec3 b = glm::dvec3(body.vertices[j]) - centre;
                    sum += std::abs(glm::dot(middle, glm::cross(a, b))) / 6.0;
                }
            }
        }
    }
    return sum;
}

/// Vertices of a body without its faces: all that a hull, a rectangle or a matrix needs.
///
/// Two points at most on each of the twelve edges of the frustum and of the box, so 48 whatever
/// rounding does; 20 different ones at most, as for `convex_body`.
template <typename T> struct vertex_set {
    using value_type = T;
    static constexpr std::size_t capacity = 48;
    std::array<glm::vec<3, T>, capacity> points;
    std::size_t count;
    status flags;
};

/// Vertices of what a frustum and a box have in common, both relative to the same origin: those of
/// `intersection`, several times faster.
///
/// Precondition: products of two coordinates neither overflow nor underflow in double.
/// A point may occur twice where an edge of the frustum meets an edge of the box, and a flat body
/// is not reported as such. Computed in double and rounded once: points are as good as the corners
/// and planes given, magnified where an edge grazes a plane by one over the sine of the angle.
/// @param corners,planes as `frustum_corners` and `frustum_planes` give them
/// @return `empty_body` where nothing is in common. An infinite or invalid box, or a corner or a
///         plane that is not finite, is handed to `intersection` with its status, which needs no
///         planes (`invalid_input` if they are not finite); what has no end (`unbounded`) keeps its
///         finite vertices
template <typename T>
vertex_set<T> intersection_vertices(const std::array<glm::vec<4, T>, 8>& corners,
                                    const std::array<glm::vec<4, T>, 6>& planes,
                                    const box3<T>& box) {
    vertex_set<T> set;
    set.count = 0;
    set.flags = status::ok;
    bool planes_usable = true;
    for (const glm::vec<4, T>& plane : planes) {
        planes_usable = planes_usable && detail::all_finite(plane);
    }
    bool usable = planes_usable && detail::all_finite(box.lo) && detail::all_finite(box.hi);
    for (glm::length_t k = 0; k < 3; ++k) {
        usable = usable && box.lo[k] <= box.hi[k];
    }
    for (const glm::vec<4, T>& corner : corners) {
        usable = usable && detail::all_finite(corner);
    }
    if (!usable) {
        const convex_body<T> body = intersection(corners, box);
        for (std::size_t i = 0; i < body.count; ++i) {
            if (body.vertices[i].w != T(0)) {
                set.points[set.count++] = body.vertices[i];
            }
        }
        set.flags = planes_usable ? body.flags : body.flags | status::invalid_input;
        return set;
    }
    using L = detail::lanes<detail::native_lanes>;
    detail::add_edge_points<L>(set, detail::hexahedron_edges(corners),
                               detail::distances_to_box<T>{box});
    detail::add_edge_points<L>(set, detail::hexahedron_edges(detail::corners_of(box)),
                               detail::distances_to_planes<T>{planes});
    if (set.count == 0) {
        set.flags |= status::empty_body;
    }
    return set;
}

} // namespace warpshadow
