// Objects of the device: the host's body, the shader's snippet.
#pragma once

#include <warpshadow/detail/glsl_annotation.hpp>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include <span>
#include <vector>

namespace fixture {

/// A texture of one channel.
template <typename T> struct WS_GLSL_TYPE("sampler2D") map {
    std::vector<T> texels;
    int width;

    /// Width as a method.
    WS_GLSL_CALL("textureSize($0, 0).x")
    int texels_across() const { return width; }
};

/// One texel.
template <typename T>
WS_GLSL_CALL("texelFetch($0, $1, 0).r")
T texel(const map<T>& from, glm::vec<2, int> at) {
    return from.texels[static_cast<std::size_t>(at.y * from.width + at.x)];
}

/// Numbers in a storage buffer, named by where they begin.
template <typename T> struct WS_GLSL_TYPE("int") numbers { std::span<const T> data; };

/// One of them.
template <typename T> WS_GLSL_CALL("my_numbers[$0 + $1]") T number(const numbers<T>& from, int i) {
    return from.data[static_cast<std::size_t>(i)];
}

/// Whatever the user says it is.
template <typename T> struct WS_GLSL_TYPE("MY_IMPORTANCE") importance { T value; };
template <typename T>
WS_GLSL_CALL("MY_IMPORTANCE_AT($0, $1)")
T importance_at(const importance<T>& from, glm::vec<2, T> p) {
    return from.value * p.x;
}

/// Sum of two neighbours.
template <typename T>
T blended(const map<T>& from, const numbers<T>& list, glm::vec<2, int> at, T t) {
    int next = glm::min(at.x + 1, from.texels_across() - 1);
    T left = texel(from, at);
    T right = texel(from, glm::vec<2, int>(next, at.y));
    return glm::mix(left, right, t) * number(list, next - 1) + number(list, at.x ? 1 : 2);
}

/// Passes objects on.
template <typename T>
T weighted(const map<T>& from, const numbers<T>& list, const importance<T>& hook,
           glm::vec<2, T> p) {
    return blended(from, list, glm::vec<2, int>(p), T(0.5)) * importance_at(hook, p * T(2));
}

template float weighted<float>(const map<float>&, const numbers<float>&, const importance<float>&,
                               glm::vec<2, float>);

} // namespace fixture
