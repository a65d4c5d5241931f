// References that GLSL copies.
#pragma once

#include <glm/vec2.hpp>

namespace refused {

/// Halves and rest.
/// @param[out] rest what is left
template <typename T> T halves(const T& x, T& rest) {
    rest = x - T(0.5) * x;
    return T(0.5) * x;
}

/// A reference before a value.
template <typename T> void order(T& result, T x) {
    result = x;
}

/// Returns a reference.
template <typename T> T& same(T& x) {
    return x;
}

/// Takes an rvalue.
inline float moved(float&& x) {
    return x;
}

/// The same variable twice.
template <typename T> T aliased(T x) {
    T half_of_x = halves(x, x);
    return half_of_x + x;
}

/// A part and the whole.
template <typename T> void first_of(const glm::vec<2, T>& v, T& x) {
    x = v.x;
}
template <typename T> T overlapping(glm::vec<2, T> v) {
    first_of(v, v.y);
    return v.y;
}

/// Elements that may be the same.
template <typename T> T elements(int i, int j) {
    T a[3] = {T(1), T(2), T(3)};
    halves(a[i], a[j]);
    return a[0];
}

/// Written and used in one expression.
template <typename T> T unordered(T x) {
    T rest = x;
    return rest + halves(x, rest);
}

/// Two calls that write.
template <typename T> T twice(T x) {
    T a;
    T b;
    return halves(x, a) + halves(x, b);
}

/// Not written on every way.
/// @param[out] result only for positive x
template <typename T> bool sometimes(T x, T& result) {
    if (x > T(0)) {
        result = x;
        return true;
    }
    return false;
}

/// Read before it is written.
/// @param[out] sum grows
template <typename T> void accumulates(T x, T& sum) {
    sum += x;
}

/// One component is missing.
/// @param[out] p only x
template <typename T> void partly(T x, glm::vec<2, T>& p) {
    p.x = x;
}

/// Written in a loop that may not run.
/// @param[out] last the last number
template <typename T> void looped(int n, T& last) {
    for (int i = 0; i < n; ++i) {
        last = T(i);
    }
}

template void order<float>(float&, float);
template float& same<float>(float&);
template float aliased<float>(float);
template float overlapping<float>(glm::vec<2, float>);
template float elements<float>(int, int);
template float unordered<float>(float);
template float twice<float>(float);
template bool sometimes<float>(float, float&);
template void accumulates<float>(float, float&);
template void partly<float>(float, glm::vec<2, float>&);
template void looped<float>(int, float&);

} // namespace refused
