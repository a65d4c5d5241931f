// Guards for values that are computed in double and handed out as T.
#pragma once

#include <warpshadow/status.hpp>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <limits>

namespace warpshadow::detail {

/// Smallest share of a body's largest extent that any of its extents is allowed to have: 2^-24.
inline constexpr double relative_floor = 0x1p-24;

/// Smallest ratio of near to far distance that a near distance is raised to: 2^-20.
inline constexpr double near_floor = 0x1p-20;

/// Whether every component is finite.
template <glm::length_t L, typename T> bool all_finite(const glm::vec<L, T>& v) {
    for (glm::length_t i = 0; i < L; ++i) {
        if (!std::isfinite(v[i])) {
            return false;
        }
    }
    return true;
}

/// Whether `x` is finite and rounds to a finite T.
template <typename T> bool fits(double x) {
    // false for NaN; comparing before converting, as an overflowing conversion is undefined
    return std::abs(x) <= static_cast<double>(std::numeric_limits<T>::max());
}

/// Whether every component is finite and rounds to a finite T.
template <typename T, glm::length_t L> bool fits(const glm::vec<L, double>& v) {
    for (glm::length_t i = 0; i < L; ++i) {
        if (!fits<T>(v[i])) {
            return false;
        }
    }
    return true;
}

/// Whether every entry is finite and rounds to a finite T.
template <typename T> bool fits(const glm::mat<4, 4, double>& m) {
    for (glm::length_t i = 0; i < 4; ++i) {
        if (!fits<T>(m[i])) {
            return false;
        }
    }
    return true;
}

} // namespace warpshadow::detail
