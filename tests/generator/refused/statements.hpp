// Statements and expressions outside the subset.
#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <stdexcept>
#include <utility>

namespace refused {

template <typename T> T lambda(T x) {
    auto twice = [](T y) { return y + y; };
    return twice(x);
}
template <typename T> T local_reference(glm::vec<2, T> v) {
    const T& x = v.x;
    return x;
}
template <typename T> T ranged(const std::array<T, 3>& values) {
    T sum = T(0);
    for (T x : values) {
        sum += x;
    }
    return sum;
}
template <typename T> T thrown(T x) {
    if (x < T(0)) {
        throw std::range_error("negative");
    }
    return x;
}
template <typename T> T caught(T x) {
    try {
        return x;
    } catch (...) {
        return T(0);
    }
}
template <typename T> int jumps(T x) {
    int n = 0;
again:
    ++n;
    if (T(n) < x) {
        goto again;
    }
    return n;
}
template <typename T> T factorial(T n) {
    return n < T(2) ? T(1) : n * factorial(n - T(1));
}
template <typename T> T odd(T n);
template <typename T> T even(T n) {
    return n < T(1) ? T(1) : odd(n - T(1));
}
template <typename T> T odd(T n) {
    return n < T(1) ? T(0) : even(n - T(1));
}
template <typename T> T remembered(T x) {
    static T sum = T(0);
    sum += x;
    return sum;
}
template <typename T> T bound(glm::vec<2, T> v) {
    auto pair = std::pair<T, T>(v.x, v.y);
    return pair.first;
}
inline float unpacked(const std::array<float, 2>& a) {
    auto [x, y] = a;
    return x + y;
}
template <typename T> T inside(const T (&values)[4]) {
    int i = 0;
    T sum = values[i++];
    sum = values[++i] + (i = 2);
    return sum;
}
template <typename T> T comma(T x) {
    return (x + T(1), x);
}
template <typename T> T declared(T x) {
    if (T y = x * x; y > T(1)) {
        return y;
    }
    return x;
}
inline int global = 3;
inline int reads_global() {
    return global;
}
template <typename T> T inner_type(T x) {
    struct pair {
        T a;
    };
    pair p{x};
    return p.a;
}
inline float function_value(float x) {
    return x > 0.0f ? lambda<float>(x) : 0.0f;
}
inline void no_effect(int x) {
    x + 1;
}
inline float* allocated() {
    return new float(1.0f);
}

template float lambda<float>(float);
template float local_reference<float>(glm::vec<2, float>);
template float ranged<float>(const std::array<float, 3>&);
template float thrown<float>(float);
template float caught<float>(float);
template int jumps<float>(float);
template float factorial<float>(float);
template float even<float>(float);
template float remembered<float>(float);
template float bound<float>(glm::vec<2, float>);
template float inside<float>(const float (&)[4]);
template float comma<float>(float);
template float declared<float>(float);
template float inner_type<float>(float);

} // namespace refused
