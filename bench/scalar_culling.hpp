// Intersection of frusta as one would write it, to compare with.
#pragma once

#include <warpshadow/cull.hpp>
#include <warpshadow/frustum.hpp>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>

namespace scalar_culling {

/// Points and edges against planes as one would write it: King and Newhall 2004, one thing after
/// the other, in N, without rounding bounds. Corners and planes are prepared.
template <typename N> struct prepared {
    std::array<glm::vec<3, N>, 8> corners;
    std::array<glm::vec<4, N>, 6> planes;
};

template <typename N, typename T>
prepared<N> prepare(const warpshadow::frustum<T>& f, const glm::vec<3, N>& origin) {
    using vec3 = glm::vec<3, N>;
    const warpshadow::view_volume<T>& v = f.volume;
    const warpshadow::frustum<N> own{vec3(f.eye),
                                     vec3(f.right),
                                     vec3(f.up),
                                     vec3(f.forward),
                                     {N(v.left), N(v.right), N(v.bottom), N(v.top),
                                      N(v.near_distance), N(v.far_distance), v.orthographic}};
    const vec3 offset = own.eye - origin;
    prepared<N> s;
    const auto corners = warpshadow::frustum_corners(own);
    const auto planes = warpshadow::frustum_planes(own);
    for (std::size_t i = 0; i < 8; ++i) {
        s.corners[i] = vec3(corners[i]) + offset;
    }
    for (std::size_t i = 0; i < 6; ++i) {
        const vec3 n(planes[i]);
        s.planes[i] = glm::vec<4, N>(n, planes[i].w - glm::dot(n, offset));
    }
    return s;
}

template <typename N> bool point_or_edge_inside(const prepared<N>& a, const prepared<N>& b) {
    using vec3 = glm::vec<3, N>;
    using vec4 = glm::vec<4, N>;
    for (const vec3& p : b.corners) {
        bool inside = true;
        for (const vec4& plane : a.planes) {
            if (glm::dot(vec3(plane), p) + plane.w < N(0)) {
                inside = false;
                break;
            }
        }
        if (inside) {
            return true;
        }
    }
    for (const auto& edge : warpshadow::detail::corner_pairs) {
        const vec3& p = b.corners[edge[0]];
        const vec3& q = b.corners[edge[1]];
        N enter = N(0);
        N leave = N(1);
        for (const vec4& plane : a.planes) {
            const N s = glm::dot(vec3(plane), p) + plane.w;
            const N t = glm::dot(vec3(plane), q) + plane.w;
            if (s < N(0) && t < N(0)) {
                enter = N(2);
                break;
            }
            if (s < N(0)) {
                enter = enter > s / (s - t) ? enter : s / (s - t);
            } else if (t < N(0)) {
                leave = leave < s / (s - t) ? leave : s / (s - t);
            }
        }
        if (enter <= leave) {
            return true;
        }
    }
    return false;
}

template <typename N> bool scalar_intersects(const prepared<N>& a, const prepared<N>& b) {
    return point_or_edge_inside(a, b) || point_or_edge_inside(b, a);
}

} // namespace scalar_culling
