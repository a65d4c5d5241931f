// Objects of the device outside the places where GLSL allows them.
#pragma once

#include <warpshadow/detail/glsl_annotation.hpp>

#include <vector>

namespace refused {

template <typename T> struct WS_GLSL_TYPE("sampler2D") map {
    std::vector<T> texels;
    int width;
};
template <typename T>
WS_GLSL_CALL("texelFetch($0, ivec2($1, $2), 0).r")
T texel(const map<T>& from, int x, int y) {
    return from.texels[static_cast<std::size_t>(y * from.width + x)];
}
template <typename T>
WS_GLSL_CALL("texelFetch($0, ivec2($1, $2), $3).r")
T level(const map<T>& from, int x, int y) {
    return texel(from, x, y);
}

struct holder {
    map<float> inner;
};

inline float local(const map<float>& m) {
    map<float> copy = m;
    return texel(copy, 0, 0);
}
inline float member(const holder& h) {
    return texel(h.inner, 0, 0);
}
inline int raw(const map<float>& m) {
    return m.width;
}
inline map<float> returned(const map<float>& m) {
    return m;
}
inline float chosen(const map<float>& a, const map<float>& b, bool first) {
    return texel(first ? a : b, 0, 0);
}
inline float missing(const map<float>& m) {
    return level(m, 0, 0);
}

} // namespace refused
