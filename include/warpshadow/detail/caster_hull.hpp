// Separating axes of the hull of a view and a light against boxes and balls.
//
// Any vector is a valid axis, so that only the projections onto it are rounded: 16u |n| (E + B),
// E and B being bounds on the magnitudes of the hull's corners and of the box, covers them. Corners
// at infinity count as lying along the axis if they do so by more than rounding; at the distance B,
// what is neglected is below that bound again.
#pragma once

#include <warpshadow/cull.hpp>
#include <warpshadow/detail/cull_volume.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace warpshadow::detail {

/// An axis and the hull's extent along it, without rounding bounds.
struct hull_axis {
    dvec3 n;
    double lo, hi;
};

/// Edges of the hull besides those of the view: from the light, corner 8, to each corner.
inline constexpr std::size_t hull_edges = 20;
inline constexpr std::size_t light_corner = 8;

/// The convex hull of the corners of a view and of a light, relative to the light.
struct hull_of_view_and_light {
    std::array<dvec3, 9> corners{};
    std::array<double, 9> weights{};
    std::array<hull_axis, 64> axes{};
    std::size_t faces = 0; ///< axes that hold for any shape: faces of the hull
    std::size_t count = 0; ///< with those that are for boxes only
    double extent = 0.0;   ///< E
};

inline std::size_t edge_end(std::size_t edge, std::size_t end) {
    if (edge < 12) {
        return corner_pairs[edge][end];
    }
    return end == 0 ? light_corner : edge - 12;
}

/// Direction of an edge; zero for one at infinity.
inline dvec3 edge_direction(const hull_of_view_and_light& hull, std::size_t edge) {
    const std::size_t i = edge_end(edge, 0);
    const std::size_t j = edge_end(edge, 1);
    if (hull.weights[i] == 0.0) {
        // the directions themselves may be far from parallel to an edge of the body
        return dvec3(0.0);
    }
    return hull.weights[j] == 0.0 ? hull.corners[j] : hull.corners[j] - hull.corners[i];
}

/// Extent of the hull along n.
inline hull_axis project(const hull_of_view_and_light& hull, const dvec3& n) {
    hull_axis axis{n, 0.0, 0.0}; // the light
    const double bound = 3.0 * rounding_unit * max_abs(n);
    for (std::size_t i = 0; i < 8; ++i) {
        const double s = glm::dot(n, hull.corners[i]);
        if (hull.weights[i] != 0.0) {
            axis.lo = glm::min(axis.lo, s);
            axis.hi = glm::max(axis.hi, s);
        } else if (s > bound * max_abs(hull.corners[i])) {
            axis.hi = std::numeric_limits<double>::infinity();
        } else if (s < -bound * max_abs(hull.corners[i])) {
            axis.lo = -std::numeric_limits<double>::infinity();
        }
    }
    return axis;
}

inline void add_axis(hull_of_view_and_light& hull, const dvec3& n) {
    const hull_axis axis = project(hull, n);
    if (max_abs(n) > 0.0 && (std::isfinite(axis.lo) || std::isfinite(axis.hi))) {
        hull.axes[hull.count] = axis;
        ++hull.count;
    }
}

/// Collects the axes: 6 faces of the view, at most 12 faces through the light, 3 of the box, and
/// the cross products of the box's edges with the 6 directions of the view's edges and the 8 edges
/// from the light: 63 at most.
inline void make_axes(hull_of_view_and_light& hull, const cull_volume& view) {
    for (std::size_t p = 0; p < 6; ++p) {
        add_axis(hull, normal(view, p));
    }
    for (const auto& edge : corner_pairs) {
        const dvec3 n = glm::cross(hull.corners[edge[0]], hull.corners[edge[1]]);
        const hull_axis axis = project(hull, n);
        // of the planes through the light and an edge, those that have the hull on one side
        const double bound = 3.0 * rounding_unit * max_abs(n) * hull.extent;
        if (axis.lo >= -bound || axis.hi <= bound) {
            add_axis(hull, n);
        }
    }
    hull.faces = hull.count;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        dvec3 e(0.0);
        e[axis] = 1.0;
        add_axis(hull, e);
    }
    // the near edges at the left and the right are parallel to the far ones
    const bool flat_near = view.extent[0] == 0.0;
    const std::size_t across = flat_near ? 4 : 0;
    for (std::size_t k = 0; k < 14; ++k) {
        const dvec3 d = k < 2 ? corner(view, across + k + 1) - corner(view, across + k)
                              : edge_direction(hull, k + 6);
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            dvec3 e(0.0);
            e[axis] = 1.0;
            add_axis(hull, glm::cross(e, d));
        }
    }
}

/// Whether the box lo..hi, relative to the light, meets the hull.
inline bool box_meets_hull(const hull_of_view_and_light& hull, const dvec3& lo, const dvec3& hi) {
    const double reach = 3.0 * rounding_unit * (hull.extent + glm::max(max_abs(lo), max_abs(hi)));
    for (std::size_t i = 0; i < hull.count; ++i) {
        const hull_axis& axis = hull.axes[i];
        const dvec3 a = axis.n * lo;
        const dvec3 b = axis.n * hi;
        const dvec3 least = glm::min(a, b);
        const dvec3 most = glm::max(a, b);
        const double bound = reach * max_abs(axis.n);
        if (most.x + most.y + most.z + bound < axis.lo ||
            least.x + least.y + least.z - bound > axis.hi) {
            return false;
        }
    }
    return true;
}

/// Whether the ball, relative to the light, meets the hull.
inline bool ball_meets_hull(const hull_of_view_and_light& hull, const dvec3& centre,
                            double radius) {
    const double reach = 3.0 * rounding_unit * (hull.extent + max_abs(centre) + radius);
    const auto apart = [&](const hull_axis& axis) {
        const double s = glm::dot(axis.n, centre);
        const double margin = radius * glm::length(axis.n) + 2.0 * reach * max_abs(axis.n);
        return s + margin < axis.lo || s - margin > axis.hi;
    };
    for (std::size_t i = 0; i < hull.faces; ++i) {
        if (apart(hull.axes[i])) {
            return false;
        }
    }
    // from the nearest point of an edge to the centre: separates unless a face is nearer
    double nearest = std::numeric_limits<double>::infinity();
    dvec3 towards(0.0);
    for (std::size_t edge = 0; edge < hull_edges; ++edge) {
        const std::size_t i = edge_end(edge, 0);
        const std::size_t j = edge_end(edge, 1);
        if (hull.weights[i] == 0.0) {
            continue;
        }
        const dvec3 along = edge_direction(hull, edge);
        const double square = glm::dot(along, along);
        double t = square > 0.0 ? glm::dot(centre - hull.corners[i], along) / square : 0.0;
        t = hull.weights[j] == 0.0 ? glm::max(t, 0.0) : glm::clamp(t, 0.0, 1.0);
        const dvec3 gap = centre - hull.corners[i] - t * along;
        const double distance = glm::dot(gap, gap);
        if (distance < nearest) {
            nearest = distance;
            towards = gap;
        }
    }
    return !(max_abs(towards) > 0.0) || !apart(project(hull, towards));
}

} // namespace warpshadow::detail
