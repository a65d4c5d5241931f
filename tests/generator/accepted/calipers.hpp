// A loop as it stands in the library: rotating calipers.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <limits>

namespace fixture {

/// Convex hull, counter-clockwise.
template <typename T> struct hull {
    glm::vec<2, T> p[8]; ///< vertices; only the first `count` are used
    int count;           ///< number of vertices
};

/// Two-dimensional cross product: the z of (a, 0) × (b, 0).
template <typename T> T cross2(glm::vec<2, T> a, glm::vec<2, T> b) {
    return a.x * b.y - a.y * b.x;
}

/// Enclosing rectangle of least area by rotating calipers.
///
/// @param shape     convex polygon
/// @param[out] axis unit direction of one side of the best rectangle
/// @return          its area
template <typename T> T min_area_axis(const hull<T>& shape, glm::vec<2, T>& axis) {
    T best = std::numeric_limits<T>::max();
    axis = glm::vec<2, T>(1, 0);
    for (int i = 0; i < shape.count; ++i) {
        int j = i + 1 == shape.count ? 0 : i + 1;
        auto e = shape.p[j] - shape.p[i];
        T len = glm::length(e);
        if (len <= T(0)) {
            continue; // repeated vertex
        }
        e /= len;
        T lo = T(0), hi = T(0), height = T(0);
        int n = 0;
        while (n < shape.count) {
            auto d = shape.p[n] - shape.p[i];
            lo = glm::min(lo, glm::dot(d, e));
            hi = glm::max(hi, glm::dot(d, e));
            height = glm::max(height, cross2(e, d));
            n++;
        }
        T area = (hi - lo) * height;
        if (area < best) {
            best = area;
            axis = e;
        } else if (area == best && i % 2 == 0) {
            axis = T(i) * e / T(i);
        }
    }
    return best;
}

template float min_area_axis<float>(const hull<float>&, glm::vec<2, float>&);

} // namespace fixture
