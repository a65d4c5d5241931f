// Hull and smallest rectangle as they are usually written, in plain arithmetic of T.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace plain_hull {

/// Twice the area of a triangle: the orientation of its corners by its sign.
template <typename T>
T turn(const glm::vec<2, T>& a, const glm::vec<2, T>& b, const glm::vec<2, T>& c) {
    return (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
}

/// Andrew's monotone chain.
template <typename T>
void monotone_chain(const std::vector<glm::vec<2, T>>& points, std::vector<glm::vec<2, T>>& sorted,
                    std::vector<glm::vec<2, T>>& hull) {
    sorted = points;
    std::sort(sorted.begin(), sorted.end(),
              [](const auto& p, const auto& q) { return p.x < q.x || (p.x == q.x && p.y < q.y); });
    hull.clear();
    const auto extend = [&hull](const glm::vec<2, T>& p, std::size_t start) {
        while (hull.size() >= start + 2 && !(turn(hull[hull.size() - 2], hull.back(), p) > T(0))) {
            hull.pop_back();
        }
        hull.push_back(p);
    };
    for (const auto& p : sorted) {
        extend(p, 0);
    }
    hull.pop_back();
    const std::size_t upper = hull.size();
    for (std::size_t i = sorted.size(); i-- > 0;) {
        extend(sorted[i], upper);
    }
    hull.pop_back();
}

template <typename T> struct rectangle { glm::vec<2, T> centre, axis, half_extents; };

/// The smallest rectangle with a side on an edge of the hull: every edge against every vertex.
template <typename T> rectangle<T> smallest_rectangle(const std::vector<glm::vec<2, T>>& hull) {
    rectangle<T> best{glm::vec<2, T>(T(0)), glm::vec<2, T>(T(1), T(0)), glm::vec<2, T>(T(0))};
    T least = std::numeric_limits<T>::max();
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const glm::vec<2, T> axis = glm::normalize(hull[(i + 1) % hull.size()] - hull[i]);
        const glm::vec<2, T> across(-axis.y, axis.x);
        glm::vec<2, T> lo(std::numeric_limits<T>::max());
        glm::vec<2, T> hi(std::numeric_limits<T>::lowest());
        for (const auto& p : hull) {
            const glm::vec<2, T> q(glm::dot(p, axis), glm::dot(p, across));
            lo = glm::min(lo, q);
            hi = glm::max(hi, q);
        }
        const T area = (hi.x - lo.x) * (hi.y - lo.y);
        if (area < least) {
            least = area;
            const glm::vec<2, T> middle = T(0.5) * (lo + hi);
            best = {middle.x * axis + middle.y * across, axis, T(0.5) * (hi - lo)};
        }
    }
    return best;
}

} // namespace plain_hull
