// Vectors, matrices, and what binds how strongly.
#pragma once

#include <array>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

namespace fixture {

/// Constructors and components.
template <typename T> glm::vec<4, T> constructors(glm::vec<3, T> v, T s) {
    glm::vec<4, T> a(v, T(1));
    glm::vec<4, T> b = glm::vec<4, T>(glm::vec<2, T>(v), s, T(2));
    glm::vec<3, T> c{v.x, v.g, v[2]};
    glm::vec<2, T> d = {s, T(1)}, e(s);
    glm::vec<4, T> f;
    f = glm::vec<4, T>{};
    f.w = c.z;
    f[1] = d.y + e.x;
    glm::vec<2, int> i(1, 2);
    i += 3;
    i[0]++;
    return a + b * f + glm::vec<4, T>(d, glm::vec<2, T>(i));
}

/// Matrices.
template <typename T> glm::vec<3, T> matrices(const glm::mat<4, 4, T>& m, glm::vec<4, T> v) {
    glm::mat<3, 3, T> linear(m);
    glm::mat<3, 3, T> identity(T(1));
    glm::mat<2, 2, T> small(T(1), T(2), T(3), T(4));
    linear[0] = identity[1];
    linear[2][1] = small[1].x;
    glm::vec<4, T> moved = m * v;
    glm::mat<4, 3, T> affine(m);
    return linear * glm::transpose(identity) * (affine * moved) +
           v.w * affine[0].x * m[3].w * glm::vec<3, T>(v) * linear;
}

/// Parentheses stay where they are needed, and are not lost.
template <typename T> T precedence(T a, T b, T c, int i, int j) {
    T d = a - (b - c) - (a + b) * c / (a / b);
    d += -(a + b) + -a * -b - -c;
    d -= a - -(-b);
    bool e = (a < b) == (b < c) && !(a > b || b > c) && (i & 3) == (j | 1);
    int k = ((i + j) << 2) >> (1 + i) ^ (i & j | 4);
    k += ~(i + 1) - (i - j);
    k += (i > j ? i : j) + 1;
    return ((e ? a : b) + d) * T(k) + (i > j ? (a > b ? a : b) : c);
}

/// Vector operators.
template <typename T> bool relations(glm::vec<3, T> a, glm::vec<3, T> b) {
    a *= T(2);
    a -= b / T(3);
    glm::vec<3, bool> less = glm::lessThan(a, T(2) * -b);
    return glm::any(less) || glm::all(glm::not_(less)) || (a == b) != (a != -b);
}

/// Arrays as parameters and results.
template <typename T>
std::array<glm::vec<2, T>, 3> corners(const std::array<T, 3>& x, const T (&y)[3]) {
    std::array<glm::vec<2, T>, 3> result{};
    for (int i = 0; i < int(result.size()); ++i) {
        result[static_cast<std::size_t>(i)] = glm::vec<2, T>(x[static_cast<std::size_t>(i)], y[i]);
    }
    return result;
}

template glm::vec<4, float> constructors<float>(glm::vec<3, float>, float);
template glm::vec<3, float> matrices<float>(const glm::mat<4, 4, float>&, glm::vec<4, float>);
template float precedence<float>(float, float, float, int, int);
template bool relations<float>(glm::vec<3, float>, glm::vec<3, float>);
template std::array<glm::vec<2, float>, 3> corners<float>(const std::array<float, 3>&,
                                                          const float (&)[3]);

} // namespace fixture
