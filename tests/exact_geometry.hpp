// Hull, smallest rectangle and distances in exact arithmetic, by other algorithms than the library.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace exact {

using integer = boost::multiprecision::cpp_int;
using rational = boost::multiprecision::cpp_rational;
using real = boost::multiprecision::cpp_bin_float_100;

struct point {
    integer x, y;
};

/// Points as whole numbers of one power of two.
struct grid_points {
    std::vector<point> points;
    int exponent; // a coordinate is the whole number times 2^exponent
};

/// Precondition: finite points.
template <typename T> grid_points on_grid(std::span<const glm::vec<2, T>> points) {
    grid_points result;
    result.exponent = 2000;
    const auto lowest_bit = [](double x) {
        int exponent = 0;
        const double fraction = std::frexp(x, &exponent);
        auto whole = static_cast<long long>(std::ldexp(fraction, 53));
        exponent -= 53;
        while (whole % 2 == 0) {
            whole /= 2;
            ++exponent;
        }
        return exponent;
    };
    for (const glm::vec<2, T>& p : points) {
        for (const double x : {double(p.x), double(p.y)}) {
            if (x != 0.0) {
                result.exponent = std::min(result.exponent, lowest_bit(x));
            }
        }
    }
    const auto whole = [&](double x) {
        int exponent = 0;
        const double fraction = std::frexp(x, &exponent);
        integer value = static_cast<long long>(std::ldexp(fraction, 53));
        const int shift = exponent - 53 - result.exponent;
        if (x == 0.0) {
            return integer(0);
        }
        return shift >= 0 ? integer(value << shift) : integer(value / (integer(1) << -shift));
    };
    for (const glm::vec<2, T>& p : points) {
        result.points.push_back({whole(double(p.x)), whole(double(p.y))});
    }
    return result;
}

inline integer cross(const point& a, const point& b, const point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Strictly convex hull by gift wrapping, counter-clockwise from the leftmost point, the lowest of
/// those: indices, of equal points the first.
inline std::vector<std::size_t> hull(const std::vector<point>& points) {
    std::vector<std::size_t> result;
    if (points.empty()) {
        return result;
    }
    std::size_t start = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (points[i].x < points[start].x ||
            (points[i].x == points[start].x && points[i].y < points[start].y)) {
            start = i;
        }
    }
    std::size_t current = start;
    do {
        result.push_back(current);
        const point& from = points[current];
        std::size_t next = current;
        integer next_length = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const point& to = points[i];
            const integer length =
                (to.x - from.x) * (to.x - from.x) + (to.y - from.y) * (to.y - from.y);
            if (length == 0) {
                continue;
            }
            const integer turn = next == current ? integer(-1) : cross(from, points[next], to);
            if (turn < 0 || (turn == 0 && length > next_length)) {
                next = i;
                next_length = length;
            }
        }
        current = next;
    } while (current != start && result.size() <= points.size());
    return result;
}

/// Area of the smallest rectangle, by trying every edge of the hull against every point.
inline real smallest_area(const grid_points& set) {
    const std::vector<std::size_t> corners = hull(set.points);
    if (corners.size() < 3) {
        return 0;
    }
    rational best = -1;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const point& a = set.points[corners[i]];
        const point& b = set.points[corners[(i + 1) % corners.size()]];
        const integer ex = b.x - a.x;
        const integer ey = b.y - a.y;
        integer left = 0, right = 0, top = 0;
        for (const std::size_t k : corners) {
            const integer dx = set.points[k].x - a.x;
            const integer dy = set.points[k].y - a.y;
            const integer u = ex * dx + ey * dy;
            const integer v = ex * dy - ey * dx;
            left = std::min(left, u);
            right = std::max(right, u);
            top = std::max(top, v);
        }
        const rational area((right - left) * top, ex * ex + ey * ey);
        if (best < 0 || area < best) {
            best = area;
        }
    }
    return real(best) * boost::multiprecision::ldexp(real(1), 2 * set.exponent);
}

/// Largest distance between two of the points, to a few roundings of double: a scale for errors.
template <typename T> real diameter(std::span<const glm::vec<2, T>> points) {
    double best = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t j = i + 1; j < points.size(); ++j) {
            // Halves first: the difference of two ends of the range of double overflows.
            const double dx = 0.5 * double(points[i].x) - 0.5 * double(points[j].x);
            const double dy = 0.5 * double(points[i].y) - 0.5 * double(points[j].y);
            best = std::max(best, std::hypot(dx, dy));
        }
    }
    return 2 * real(best);
}

/// How far the farthest point lies outside a rectangle, along one of its axes; not below zero.
template <typename T>
real outside(std::span<const glm::vec<2, T>> points, const glm::vec<2, T>& centre,
             const glm::vec<2, T>& axis, const glm::vec<2, T>& half_extents) {
    real worst = 0;
    const real length = sqrt(real(axis.x) * axis.x + real(axis.y) * axis.y);
    for (const glm::vec<2, T>& p : points) {
        const real x = real(p.x) - real(centre.x);
        const real y = real(p.y) - real(centre.y);
        const real u = (axis.x * x + axis.y * y) / length;
        const real v = (axis.x * y - axis.y * x) / length;
        worst = std::max(worst, real(abs(u) - half_extents.x));
        worst = std::max(worst, real(abs(v) - half_extents.y));
    }
    return worst;
}

} // namespace exact
