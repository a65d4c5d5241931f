// The planes of a receivers' body by number, and checks of the boxes that some of them come from.
#pragma once

#include <warpshadow/detail/direction.hpp>
#include <warpshadow/detail/light_view.hpp>
#include <warpshadow/frustum.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cmath>
#include <cstddef>

namespace warpshadow {

/// Planes of a receivers' body: 0 to 5 the view's (left, right, bottom, top, near, far), 6 to 11
/// the receiver box's (lo x, hi x, lo y, hi y, lo z, hi z), 12 to 19 those around a spot's cone.
inline constexpr std::size_t receiver_planes = 20;

} // namespace warpshadow

namespace warpshadow::detail {

/// Whether a box can be used: lo <= hi, and all bounds that are finite in range.
inline bool usable_box(const box3<double>& box) {
    bool usable = true;
    for (glm::length_t k = 0; k < 3; ++k) {
        for (const double x : {box.lo[k], box.hi[k]}) {
            usable = usable && (std::isinf(x) || std::abs(x) <= largest_coordinate);
        }
        usable = usable && box.lo[k] <= box.hi[k] && box.lo[k] < largest_coordinate &&
                 box.hi[k] > -largest_coordinate;
    }
    return usable;
}

template <typename T> box3<double> relative_box(const box3<T>& box, const dvec3& eye) {
    return {dvec3(box.lo) - eye, dvec3(box.hi) - eye};
}

/// Largest distance of a point of the box along a direction; infinity or NaN where it has no end.
inline double farthest(const box3<double>& box, const dvec3& along) {
    const dvec3 a = box.lo * along;
    const dvec3 b = box.hi * along;
    return glm::max(a.x, b.x) + glm::max(a.y, b.y) + glm::max(a.z, b.z);
}

/// The planes of the receivers' body by number; those that do not exist hold everything.
struct plane_list {
    std::array<glm::dvec4, receiver_planes> planes;
    plane_list() { planes.fill(glm::dvec4(0.0, 0.0, 0.0, 1.0)); }
};

/// Eight planes around a spot's cone that touch it, through the light.
inline void add_cone(plane_list& list, const light_view& view, double half_angle) {
    const double s = std::sin(half_angle);
    const double c = std::cos(half_angle);
    const double d = 0.70710678118654752440;
    const double around[8][2] = {{1, 0},  {d, d},   {0, 1},  {-d, d},
                                 {-1, 0}, {-d, -d}, {0, -1}, {d, -d}};
    for (std::size_t i = 0; i < 8; ++i) {
        const dvec3 n = s * view.forward - c * (around[i][0] * view.right + around[i][1] * view.up);
        list.planes[12 + i] = glm::dvec4(n, -glm::dot(n, view.position));
    }
}

} // namespace warpshadow::detail
