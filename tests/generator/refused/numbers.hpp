// Arithmetic that means something else in GLSL, or nothing.
#pragma once

#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include <cmath>
#include <limits>

namespace refused {

template <typename T> T rounds(T x) {
    return glm::round(x) + std::round(x) + std::nearbyint(x);
}
template <typename T> bool tests_nan(T x) {
    return std::isnan(x) || x != x || !(x == x);
}
template <typename T> bool tests_finite(T x) {
    return std::isfinite(x) || glm::isinf(x);
}
template <typename T> T infinite() {
    return std::numeric_limits<T>::infinity();
}
template <typename T> T not_a_number() {
    return std::numeric_limits<T>::quiet_NaN();
}
template <typename T> T sign_bit(T x) {
    return std::signbit(x) ? T(1) : std::copysign(T(1), x);
}
template <typename T> T in_double(T x) {
    return T(0.5 * x);
}
template <typename T> T also_in_double(T x) {
    double y = x;
    return T(y);
}
template <typename T> T unknown(T x, T y) {
    return std::fma(x, y, x) + std::hypot(x, y) + std::fmod(x, y) + std::log1p(x) + std::tgamma(x);
}
inline int remainder(int a, int b) {
    return a % b;
}
inline int counts_down(int n) {
    int sum = 0;
    for (int i = n; i > 0; --i) {
        sum += i % 2;
    }
    return sum;
}
inline int divides_negative(int a) {
    return a / -2;
}
template <typename T> glm::mat<2, 2, T> by_matrix(glm::mat<2, 2, T> m) {
    return m / m;
}
template <typename T> glm::mat<4, 4, T> projection(T x) {
    return glm::ortho(-x, x, -x, x);
}
inline float mixed(unsigned u, float f) {
    u += f;
    bool b = true;
    b &= u > 3u;
    return f;
}
inline int integer_mix(int a, int b) {
    return glm::mix(a, b, true);
}
inline bool ordered(bool a, bool b) {
    return a < b;
}
inline float large() {
    return float(1ull << 40) * float(0x1ffffffffull);
}
inline float not_finite() {
    constexpr float x = 1e30f * 1e30f;
    return x;
}

template float rounds<float>(float);
template bool tests_nan<float>(float);
template bool tests_finite<float>(float);
template float infinite<float>();
template float not_a_number<float>();
template float sign_bit<float>(float);
template float in_double<float>(float);
template float also_in_double<float>(float);
template float unknown<float>(float, float);
template glm::mat<2, 2, float> by_matrix<float>(glm::mat<2, 2, float>);
template glm::mat<4, 4, float> projection<float>(float);

} // namespace refused
