// Points in the plane as doubles of a safe size, and directions turned towards the x axis.
#pragma once

#include <warpshadow/detail/power_of_two.hpp>

#include <glm/vec2.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

namespace warpshadow::detail {

/// The points as doubles, scaled by a power of two so that squares of areas neither overflow nor
/// underflow. Differences are taken of scaled points, never of translated ones: they keep their
/// relative accuracy at any offset.
template <typename T> struct scaled_points {
    std::span<const glm::vec<2, T>> points;
    bool all_finite;
    int exponent = 0; // a scaled length times 2^exponent is the length
    double scale = 1.0;

    explicit scaled_points(std::span<const glm::vec<2, T>> unscaled) : points(unscaled) {
        // As whole numbers, magnitudes are ordered as their values are, then infinity, then NaN.
        magnitude largest = 0;
        for (const glm::vec<2, T>& p : points) {
            largest = std::max(largest, std::max(magnitude_of(p.x), magnitude_of(p.y)));
        }
        all_finite = largest < infinite;
        if (!all_finite) {
            largest = 0;
            for (const glm::vec<2, T>& p : points) {
                const magnitude m = std::max(magnitude_of(p.x), magnitude_of(p.y));
                largest = m < infinite ? std::max(largest, m) : largest;
            }
        }
        if constexpr (sizeof(T) == 8) { // of float, the fourth power fits a double
            exponent = exponent_of(std::bit_cast<T>(largest));
            scale = power_of_two(-exponent);
        }
    }

    bool left_out(std::size_t i) const {
        return !all_finite &&
               std::max(magnitude_of(points[i].x), magnitude_of(points[i].y)) >= infinite;
    }
    std::size_t size() const { return points.size(); }
    glm::dvec2 operator[](std::size_t i) const {
        if constexpr (sizeof(T) == 4) {
            return {double(points[i].x), double(points[i].y)};
        } else {
            return {double(points[i].x) * scale, double(points[i].y) * scale};
        }
    }

  private:
    using magnitude = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    static constexpr magnitude magnitude_of(T x) {
        return std::bit_cast<magnitude>(x) & (~magnitude{0} >> 1);
    }
    static constexpr magnitude infinite = magnitude_of(std::numeric_limits<T>::infinity());
};

constexpr double dot(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.x + a.y * b.y;
}

constexpr double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// By how many quarter turns to the right a direction comes nearest to +x: -x < y <= x.
inline std::size_t turns_towards_x(const glm::dvec2& d) {
    // Logic on integers: which of the four it is cannot be predicted.
    const unsigned steep = unsigned{std::abs(d.x) < std::abs(d.y)} | unsigned{d.x == -d.y};
    const unsigned back = (steep & unsigned{d.y < 0.0}) | (~steep & unsigned{d.x < 0.0});
    return steep + 2u * back;
}

/// The direction after some quarter turns to the right.
inline glm::dvec2 turned(const glm::dvec2& d, std::size_t turns) {
    const double parts[4] = {d.x, d.y, -d.x, -d.y};
    return {parts[turns], parts[(turns + 1) % 4]};
}

inline glm::dvec2 nearest_to_x(const glm::dvec2& d) {
    return turned(d, turns_towards_x(d));
}

} // namespace warpshadow::detail
