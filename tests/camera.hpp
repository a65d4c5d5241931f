// Random cameras and a 100-digit oracle, shared by the tests of conventions, frusta and lights.
#pragma once

#include <warpshadow/conventions.hpp>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <rapidcheck.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace camera_test {

using real = boost::multiprecision::cpp_bin_float_100;
using real3 = std::array<real, 3>;
using real4 = std::array<real, 4>;

/// Unit roundoff: half an ulp of 1.
template <typename T> constexpr double roundoff() {
    return 0.5 * static_cast<double>(std::numeric_limits<T>::epsilon());
}

template <typename T> real3 exact(const glm::vec<3, T>& v) {
    return {real(v.x), real(v.y), real(v.z)};
}

inline real dot(const real3& a, const real3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline real3 cross(const real3& a, const real3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline real3 sum(const real3& a, const real3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

inline real3 times(const real& s, const real3& a) {
    return {s * a[0], s * a[1], s * a[2]};
}

inline real3 minus(const real3& a, const real3& b) {
    return sum(a, times(real(-1), b));
}

inline real length(const real3& a) {
    return sqrt(dot(a, a));
}

inline real3 unit(const real3& a) {
    return times(1 / length(a), a);
}

inline double as_double(const real& x) {
    return static_cast<double>(x);
}

/// The clip position that a matrix of T gives if nothing is rounded but the matrix itself.
template <typename T> real4 multiply(const glm::mat<4, 4, T>& m, const real4& p) {
    real4 q{};
    for (glm::length_t row = 0; row < 4; ++row) {
        const auto r = static_cast<std::size_t>(row);
        q[r] = real(m[0][row]) * p[0] + real(m[1][row]) * p[1] + real(m[2][row]) * p[2] +
               real(m[3][row]) * p[3];
    }
    return q;
}

/// Sum of the magnitudes of the terms of each row: what the rounding of entries is multiplied by.
template <typename T> real4 magnitudes(const glm::mat<4, 4, T>& m, const real4& p) {
    real4 q{};
    for (glm::length_t row = 0; row < 4; ++row) {
        const auto r = static_cast<std::size_t>(row);
        q[r] = abs(real(m[0][row]) * p[0]) + abs(real(m[1][row]) * p[1]) +
               abs(real(m[2][row]) * p[2]) + abs(real(m[3][row]) * p[3]);
    }
    return q;
}

/// Every combination of depth range, reversed, infinite, handedness and y direction.
inline std::vector<warpshadow::clip_space> all_conventions() {
    std::vector<warpshadow::clip_space> all;
    for (unsigned bits = 0; bits < 32; ++bits) {
        all.push_back(warpshadow::clip_space{
            (bits & 1u) != 0 ? warpshadow::depth_range::zero_to_one
                             : warpshadow::depth_range::minus_one_to_one,
            (bits & 2u) != 0, (bits & 4u) != 0, (bits & 8u) != 0, (bits & 16u) != 0});
    }
    return all;
}

inline warpshadow::clip_space any_convention() {
    return all_conventions()[*rc::gen::resize(rc::kNominalSize,
                                              rc::gen::inRange<std::size_t>(0, 32))];
}

/// A few of them: for tests whose oracle is slow, which see them all over many cases.
inline std::vector<warpshadow::clip_space> some_conventions(int count) {
    std::vector<warpshadow::clip_space> some;
    for (int i = 0; i < count; ++i) {
        some.push_back(any_convention());
    }
    return some;
}

/// A number between `lo` and `hi`, evenly distributed whatever RapidCheck's size is.
template <typename T> T between(double lo, double hi) {
    const std::int64_t steps = std::int64_t(1) << 52;
    const std::int64_t k =
        *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int64_t>(0, steps + 1));
    const double t = static_cast<double>(k) / static_cast<double>(steps);
    return static_cast<T>(lo + t * (hi - lo));
}

/// A positive number whose logarithm is evenly distributed.
template <typename T> T log_between(double lo, double hi) {
    return static_cast<T>(std::exp2(between<double>(std::log2(lo), std::log2(hi))));
}

inline bool coin() {
    return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 2)) != 0;
}

/// A volume that needs no repair: off-centre, sometimes mirrored.
template <typename T> warpshadow::view_volume<T> any_volume(bool orthographic, double max_ratio) {
    const double size = orthographic ? log_between<double>(1e-3, 1e3) : 1.0;
    warpshadow::view_volume<T> v{};
    v.orthographic = orthographic;
    v.left = static_cast<T>(size * between<double>(-2.0, 0.5));
    v.right = static_cast<T>(static_cast<double>(v.left) + size * between<double>(0.05, 4.0));
    v.bottom = static_cast<T>(size * between<double>(-2.0, 0.5));
    v.top = static_cast<T>(static_cast<double>(v.bottom) + size * between<double>(0.05, 4.0));
    if (coin() && coin()) {
        std::swap(v.left, v.right);
    }
    const double nearest =
        orthographic ? size * between<double>(-10.0, 10.0) : log_between<double>(1e-3, 1e3);
    const double ratio = log_between<double>(1.01, max_ratio);
    v.near_distance = static_cast<T>(nearest);
    v.far_distance = static_cast<T>(orthographic ? nearest + size * ratio : nearest * ratio);
    return v;
}

/// A vector of any direction with its length between `lo` and `hi`.
template <typename T> glm::vec<3, T> any_direction(double lo, double hi) {
    const double length = log_between<double>(lo, hi);
    const double z = between<double>(-1.0, 1.0);
    const double angle = between<double>(0.0, 6.283185307179586);
    const double r = std::sqrt(1.0 - z * z);
    return glm::vec<3, T>(static_cast<T>(length * r * std::cos(angle)),
                          static_cast<T>(length * r * std::sin(angle)), static_cast<T>(length * z));
}

/// One of the numbers that break things, or an ordinary one.
template <typename T> T any_number() {
    using limits = std::numeric_limits<T>;
    const T special[] = {T(0),
                         T(-0.0),
                         T(1),
                         T(-1),
                         T(2),
                         T(0.5),
                         T(1e-3),
                         T(1e10),
                         limits::infinity(),
                         -limits::infinity(),
                         limits::quiet_NaN(),
                         limits::max(),
                         limits::lowest(),
                         limits::min(),
                         limits::denorm_min(),
                         -limits::denorm_min(),
                         limits::epsilon(),
                         T(1) + limits::epsilon(),
                         T(3.0e38),
                         T(1.0e-38)};
    const std::size_t count = sizeof(special) / sizeof(special[0]);
    const std::size_t i =
        *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(0, count + 6));
    return i < count ? special[i] : between<T>(-100.0, 100.0);
}

template <typename T> glm::vec<3, T> any_numbers() {
    const T x = any_number<T>();
    const T y = any_number<T>();
    const T z = any_number<T>();
    return glm::vec<3, T>(x, y, z);
}

template <glm::length_t L, typename T> bool finite(const glm::vec<L, T>& v) {
    for (glm::length_t i = 0; i < L; ++i) {
        if (!std::isfinite(v[i])) {
            return false;
        }
    }
    return true;
}

template <typename T> bool finite(const glm::mat<4, 4, T>& m) {
    return finite(m[0]) && finite(m[1]) && finite(m[2]) && finite(m[3]);
}

/// Everything finite but for a far distance at infinity.
template <typename T> bool usable(const warpshadow::view_volume<T>& v) {
    return std::isfinite(v.left) && std::isfinite(v.right) && std::isfinite(v.bottom) &&
           std::isfinite(v.top) && std::isfinite(v.near_distance) && v.left != v.right &&
           v.bottom != v.top && v.near_distance < v.far_distance &&
           (v.orthographic || v.near_distance > T(0));
}

template <typename T> glm::mat<4, 4, T> identity() {
    return glm::mat<4, 4, T>(T(1));
}

} // namespace camera_test
