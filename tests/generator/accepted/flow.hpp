// Control flow, and where comments and blank lines go.
#pragma once

#include <glm/common.hpp>

#include <cassert>
#include <cstdint>
#include <type_traits>

namespace fixture {

/// Kinds of light.
enum class kind : std::uint32_t {
    sun,      ///< far away
    spot = 4, ///< a cone
    point, ///< all around, from a place that is far enough from everything else to need many words
};

/// Weight of a kind.
template <typename T> T weight_of(kind k, T x) {
    switch (k) { // all of them
    case kind::sun:
        return T(1);
    case kind::spot: {
        // a block of its own
        T twice = T(2) * x;
        return twice;
    }
    case kind::point:
        x += T(1);
        [[fallthrough]];
    default:
        break; // the rest
    }
    return x;
}

/// Plain switch on an int, last label empty.
inline int digits(int n) {
    int result = 0;
    switch (n) {
    case 0:
    case 1:
        result = 1;
        break;
    case -2:
        result = 2;
        break;
    default:;
    }
    return result;
}

/// Loops of every kind.
template <typename T> int count_steps(T x, T limit) {
    using integer = int; // an alias leaves nothing
    // neither does an assertion
    static_assert(std::is_same_v<integer, int>);
    assert(x < limit);

    integer steps = 0;
    for (int i = 0, n = 10; i < n; ++i, --n) {
        if (x > limit)
            break;
        else if (x < T(0)) {
            continue; // nothing to do
        } else {
            // halfway
            ++steps;
        }
    }

    // now downwards
    while (x > T(1)) {
        x *= T(0.5);
        steps++;
    }
    do {
        x += T(1); /* a block comment */
        steps += x > limit ? 1 : x > T(2) ? 2 : 3;
    } while (x < T(4));
    for (;;) {
        {
            int inner = steps;
            steps = inner + 1;
        }
        break;
    }
    return steps;
}

/// Chosen at compile time.
template <typename T, bool Squared> T chosen(T x) {
    // before the choice
    if constexpr (Squared) {
        // the square
        x = x * x;
    } else {
        // something that float never sees
        x = std::is_integral_v<T> ? T(0) : glm::abs(x);
    }
    if constexpr (std::is_integral_v<T>) {
        return T(0);
    } else if constexpr (sizeof(T) == 4) {
        T halved = T(0.5) * x;
        return halved;
    } else {
        return x;
    }
}

/// Multi-line expressions with comments inside.
template <typename T> T long_expression(T alpha_value, T beta_value, T gamma_value, T delta_value) {
    T result = alpha_value * beta_value + // the first product
               gamma_value * delta_value; // and the second
    return (alpha_value + beta_value) * (gamma_value + delta_value) * (alpha_value - delta_value) +
           glm::clamp(alpha_value * beta_value * gamma_value, beta_value - gamma_value,
                      delta_value) +
           result;
}

/// Nothing at all.
inline void nothing() {}

template float weight_of<float>(kind, float);
template int count_steps<float>(float, float);
template float chosen<float, true>(float);
template float chosen<float, false>(float);
template float long_expression<float>(float, float, float, float);

} // namespace fixture
