// Names: namespaces, overloads, several instances of one template, GLSL's own functions.
#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace fixture {

namespace detail {
/// Namespace `detail` leaves no trace in the name.
template <typename T> T squared(T x) {
    return x * x;
}
} // namespace detail

namespace clip {
/// Any other namespace does.
inline constexpr int planes = 6;
} // namespace clip

/// Overloads stay overloads: see `size(glm::vec<3, T>)`.
template <typename T> T size(glm::vec<2, T> v) {
    return glm::length(v) + detail::squared(v.x);
}
template <typename T> T size(glm::vec<3, T> v) {
    return glm::length(v) + T(clip::planes);
}

/// Numbers of a template become part of the name.
template <typename T, int N> struct ring { T values[N]; };

/// Sum of a `ring`.
///
/// @see size
template <typename T, int N> T total(const ring<T, N>& r) {
    T sum = T(0);
    for (int i = 0; i < N; ++i) {
        sum += r.values[i];
    }
    return sum / T(N);
}

/// Parameters that hide a function of GLSL get another name.
///
/// @param floor  least value
/// @param length length along the axis
template <typename T> T at_least(T floor, T length, T x) {
    T step = glm::max(floor, x);
    return step * length;
}

template float size<float>(glm::vec<2, float>);
template float size<float>(glm::vec<3, float>);
template float total<float, 3>(const ring<float, 3>&);
template float total<float, 5>(const ring<float, 5>&);
template float at_least<float>(float, float, float);

} // namespace fixture
