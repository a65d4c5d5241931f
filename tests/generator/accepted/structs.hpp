// Structs: arrays, nesting, return, aggregates, initial values, methods, call operators.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <array>

namespace fixture {

/// Convex polygon.
template <typename T> struct polygon {
    glm::vec<2, T> p[8]; ///< vertices; only the first `count` are used
    int count;           ///< number of vertices
};

/// A polygon and what is known of it.
///
/// @tparam T does not exist in GLSL
template <typename T> struct outline {
    polygon<T> shape;
    // two on one line
    T area, perimeter;
    bool closed = true; ///< whether the last vertex meets the first, which is how every polygon
                        ///< of this fixture is made
    std::array<T, 3> weights{T(1), T(0.5), T(0.25)};
    glm::vec<2, T> centre{}; // of mass
};

/// Takes its values from the declaration of the struct.
template <typename T> outline<T> empty_outline() {
    outline<T> result;
    result.shape.count = 0;
    return result;
}

/// Every way to write a value.
template <typename T> polygon<T> triangle(glm::vec<2, T> a, glm::vec<2, T> b) {
    polygon<T> whole{};
    polygon<T> listed{{a, b, glm::vec<2, T>(T(0), T(1))}, 3};
    polygon<T> named{.count = 2};
    whole = listed;
    if (whole.count > named.count) {
        return {{a, b, {T(0), T(2)}}, 3};
    }
    return polygon<T>();
}

/// A segment with methods.
template <typename T> struct segment {
    glm::vec<2, T> from;
    glm::vec<2, T> to;

    /// Its length.
    T length() const { return glm::length(to - from); }

    /// Whether it is longer than another.
    bool longer_than(const segment& other) const { return length() > other.length(); }

    /// Shrinks about its start.
    void shrink(T factor) { this->to = this->from + factor * (to - from); }

    /// A segment on the x axis.
    static segment of_length(T length) { return {glm::vec<2, T>(T(0)), {length, T(0)}}; }

    /// Both ends moved.
    segment operator+(glm::vec<2, T> offset) const { return {from + offset, to + offset}; }
};

/// Calls the methods.
template <typename T> T longest(segment<T> a, segment<T> b) {
    a.shrink(T(0.5));
    segment<T> c = b + glm::vec<2, T>(T(1));
    return a.longer_than(b) ? a.length()
                            : (c + c.to).length() + segment<T>::of_length(T(2)).length();
}

/// A function with a field.
template <typename T> struct falloff {
    T sharpness;
    T operator()(glm::vec<2, T> p) const { return sharpness / (T(1) + glm::dot(p, p)); }
};

/// A function without.
struct constant_importance {
    float operator()(glm::vec<2, float>) const { return 1.0f; }
};

/// Integral over a row of any function.
template <typename T, typename F> T integrate_row(const F& f, T y, int steps) {
    T sum = T(0);
    for (int i = 0; i < steps; ++i) {
        sum += f(glm::vec<2, T>((T(i) + T(0.5)) / T(steps), y));
    }
    return sum / T(steps);
}

/// Makes a functor without fields.
inline float of_constant(float y) {
    return integrate_row<float>(constant_importance{}, y, 4);
}

template struct segment<float>;
template outline<float> empty_outline<float>();
template polygon<float> triangle<float>(glm::vec<2, float>, glm::vec<2, float>);
template float longest<float>(segment<float>, segment<float>);
template float integrate_row<float, falloff<float>>(const falloff<float>&, float, int);

} // namespace fixture
