// Constants, tables, enumerations, integers, bits, literals.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace fixture {

/// What happened.
enum class status : std::uint32_t {
    ok = 0u,
    clamped = 1u << 0, ///< a value was clamped
    widened = 1u << 1,
};

constexpr status operator|(status a, status b) {
    return static_cast<status>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr status operator&(status a, status b) {
    return static_cast<status>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
constexpr status& operator|=(status& a, status b) {
    a = a | b;
    return a;
}
constexpr status operator~(status a) {
    return static_cast<status>(~static_cast<std::uint32_t>(a));
}

/// Uses the operators of the enumeration.
inline bool any(status flags, status which) {
    return (flags & which) != status::ok;
}

/// Adds a flag.
inline status with_clamped(status flags) {
    flags |= status::clamped | status::widened;
    return flags & ~status::widened;
}

/// Plain enumeration with the type that C++ chooses.
enum class axis { x, y };

/// Direction of an axis.
template <typename T> glm::vec<2, T> direction(axis a) {
    return a == axis::x ? glm::vec<2, T>(T(1), T(0)) : glm::vec<2, T>(T(0), T(1));
}

/// Number of an axis, and back.
inline int number_of(axis a) {
    return static_cast<int>(a) + int(static_cast<axis>(1));
}

/// Gauss-Legendre nodes.
template <typename T>
inline constexpr T gauss_nodes[3] = {T(-0.774596669241483377), T(0), T(0.774596669241483377)};

inline constexpr int table_size = 4;
inline constexpr std::array<float, table_size> weights{0.25f, 0.5f, 1.f, 2};

namespace detail {
constexpr int twice(int n) {
    return 2 * n;
}
template <typename T> inline constexpr T smallest = T(1) / T(65536);
} // namespace detail

/// Computed by the compiler, since GLSL cannot.
inline constexpr int doubled = detail::twice(table_size) + 1;

/// Literals keep their spelling where GLSL has it.
template <typename T> T literals(T x) {
    T sum = T(0.5) + T(1e-3) + T(2.) + T(.25) + T(7) + T(1'000) + T(0x10);
    sum *= T(0x1p-24) + 0.1f - T(-1.5e-7);
    sum = glm::min(sum, T(3.4028234663852886e38)) + T(1.0 / 3.0) - T(-1);
    float third = 1.0 / 3.0;
    float from_int = 3;
    return x * sum + third + from_int;
}

/// Constants of the libraries.
template <typename T> T limits() {
    return std::numeric_limits<T>::max() * std::numeric_limits<T>::epsilon() + glm::pi<T>() +
           std::numeric_limits<T>::lowest() + glm::half_pi<T>() +
           T(std::numeric_limits<int>::min());
}

/// Sum over tables.
template <typename T> T quadrature(T x) {
    constexpr T local_weights[3] = {T(5.0 / 9.0), T(8.0 / 9.0), T(5.0 / 9.0)};
    T sum = detail::smallest<T>;
    for (int i = 0; i < 3; ++i) {
        sum += local_weights[i] * glm::exp(x * gauss_nodes<T>[i]);
    }
    for (int i = 0; i < table_size; ++i) {
        sum += weights[static_cast<std::size_t>(i)] * T(doubled);
    }
    return sum;
}

/// Integers and bits.
inline std::uint32_t hash(std::uint32_t x, int shift) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x = (x & 0xffffu) | (x << shift) ^ ~x;
    x += 1;
    unsigned low = x % 16u;
    int halved = shift / 2;
    int odd = glm::max(halved, 0) % 2;
    for (int i = 0; i < shift; ++i) {
        odd += i % 3;
    }
    return x == 0 ? low : x + static_cast<unsigned>(odd) + std::uint32_t{3};
}

/// Conversions are written out.
template <typename T> T conversions(int i, unsigned u, bool b, T x) {
    T sum = i;
    sum += T(u) + T(b) + T(i + 1);
    int cut = int(x) + static_cast<int>(u) + int(b);
    unsigned bits = unsigned(i) + unsigned(cut) + true;
    bool flag = i != 0;
    flag = bool(u) || flag;
    if (i) {
        sum += T(1);
    }
    glm::vec<2, int> cell(int(x), i);
    glm::vec<2, T> centre = glm::vec<2, T>(cell) + T(0.5);
    return sum + T(cut) + T(bits) + (flag ? centre.x : T(std::abs(i)));
}

/// Functions of std and of the C library are those of GLSL.
template <typename T> T functions(T x, T y) {
    return std::sqrt(x) + std::fabs(x) + sqrtf(x) + std::max(x, y) + std::atan2(y, x) +
           glm::atan(y, x) + glm::mix(x, y, T(0.5)) + std::floor(glm::fract(x)) + glm::radians(x) +
           std::pow(x, y);
}

template glm::vec<2, float> direction<float>(axis);
template float literals<float>(float);
template float limits<float>();
template float quadrature<float>(float);
template float conversions<float>(int, unsigned, bool, float);
template float functions<float>(float, float);

} // namespace fixture
