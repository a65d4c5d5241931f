// References: out, inout, and calls that are statements.
#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace fixture {

/// Quotient and rest.
///
/// @param x          dividend
/// @param y          divisor
/// @param[out] rest  x − y·quotient
template <typename T> T divide(T x, T y, T& rest) {
    T quotient = glm::floor(x / y);
    rest = x - y * quotient;
    return quotient;
}

/// Both ends at once.
/// @param[out] lo, hi the ends
/// @param[in,out] count calls so far
template <typename T> void ends(T x, T& lo, T& hi, int& count) {
    if (x < T(0)) {
        lo = x;
        hi = T(0);
        ++count;
        return;
    }
    lo = T(0);
    hi = x;
    count += 1;
}

/// Component by component.
/// @param[out] p both components are written
template <typename T> void by_component(T x, glm::vec<2, T>& p) {
    p.x = x;
    if (x > T(1)) {
        p.y = T(1);
    } else {
        p.y = p.x;
    }
}

/// A rectangle.
template <typename T> struct rect { glm::vec<2, T> lo, hi; };

/// Parts of one variable may be passed together when they do not overlap.
///
/// @param[out] r filled by parts
template <typename T> bool calls(T x, rect<T>& r) {
    int count = 0;
    ends(x, r.lo.x, r.hi.x, count);
    ends(x, r.lo.y, r.hi.y, count);
    T rest;
    T quotient = divide(x, T(2), rest);
    quotient = divide(x + quotient, T(3), rest);
    if (divide(x, T(4), rest) > T(1)) {
        return false;
    }
    return quotient + rest > T(count);
}

/// Without a word in the comment a reference is read and written.
template <typename T> void exchange(T& a, T& b) {
    T c = a;
    a = b;
    b = c;
}

template bool calls<float>(float, rect<float>&);
template void by_component<float>(float, glm::vec<2, float>&);
template void exchange<float>(float&, float&);

} // namespace fixture
