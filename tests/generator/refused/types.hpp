// Types that GLSL does not have.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace refused {

inline float pointer(const float* p) {
    return *p;
}
inline float optional_pointer(float x) {
    float* p = &x;
    return p != nullptr ? x : 0.0f;
}
inline float container(const std::vector<float>& v) {
    return v[0];
}
inline float view(std::span<const float> v) {
    return v[0];
}
inline float number(double x) {
    return float(x);
}
inline float wide(std::uint64_t n) {
    return float(n);
}
inline float size(std::size_t n) {
    return float(n + 1);
}
inline char text(int i) {
    return "abc"[i];
}
inline float arrays(const std::array<std::array<float, 2>, 2>& a) {
    return a[0][0];
}
inline glm::dmat4 matrix() {
    return glm::dmat4(1.0);
}
inline float through_pointer(float (*f)(float)) {
    return f(1.0f);
}

struct base {
    float x;
};
struct derived : base {
    float y;
};
inline float inherited(const derived& d) {
    return d.y;
}

struct with_constructor {
    float x;
    explicit with_constructor(float v) : x(v) {}
};
inline float constructed(float x) {
    return with_constructor(x).x;
}

struct with_virtual {
    float x;
    virtual float get() const { return x; }
};
inline float dispatched(const with_virtual& v) {
    return v.x;
}

struct with_reference {
    float& x;
};
inline float referenced(const with_reference& r) {
    return r.x;
}

struct with_bits {
    unsigned low : 4;
};
inline unsigned bits(const with_bits& b) {
    return b.low;
}

struct with_nested {
    std::vector<float> values;
    int near;
};
inline int nested(const with_nested& n) {
    return n.near;
}

enum class small : std::uint8_t { one };
inline bool is_one(small s) {
    return s == small::one;
}

union either {
    float f;
    int i;
};
inline float from_union(either e) {
    return e.f;
}

} // namespace refused
