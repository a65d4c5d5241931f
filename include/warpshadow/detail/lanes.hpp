// Several doubles worked on at once, where the compiler has vector types; else one.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

// the compilers' own loops stop at each root to set errno
#if defined(__has_builtin)
#if __has_builtin(__builtin_elementwise_sqrt)
#define WARPSHADOW_ROOTS __builtin_elementwise_sqrt
#elif __has_builtin(__builtin_ia32_sqrtpd)
#define WARPSHADOW_PAIR_OF_ROOTS __builtin_ia32_sqrtpd
#endif
#endif

namespace warpshadow::detail {

// A kernel written for a lane type L uses + - * /, comparisons, ?: and `square_roots` alone. These
// mean the same for a vector and for a plain double, so that lanes<1> is the scalar path and gives
// equal results.
#if defined(__GNUC__)
template <int N> struct lanes_of {
    typedef double type __attribute__((vector_size(N * sizeof(double))));
};
template <> struct lanes_of<1> { using type = double; };
#if defined(__AVX512F__)
inline constexpr int native_lanes = 8;
#elif defined(__AVX__)
inline constexpr int native_lanes = 4;
#else
inline constexpr int native_lanes = 2;
#endif
#else
template <int N> struct lanes_of {
    static_assert(N == 1, "this compiler has no vector types");
    using type = double;
};
inline constexpr int native_lanes = 1;
#endif

/// N doubles.
template <int N> using lanes = typename lanes_of<N>::type;

/// Reads as many doubles as L holds.
template <typename L> void load(L& value, const double* source) {
    std::memcpy(&value, source, sizeof value);
}

/// Writes as many doubles as L holds.
template <typename L> void store(double* target, const L& value) {
    std::memcpy(target, &value, sizeof value);
}

/// The same from doubles that were written just now, put together in registers.
template <std::size_t N> lanes<static_cast<int>(N)> lane_of(const double (&source)[N]) {
    lanes<static_cast<int>(N)> value;
    if constexpr (N == 1) {
        value = source[0];
    } else {
        for (std::size_t i = 0; i < N; ++i) {
            value[i] = source[i];
        }
    }
    return value;
}

/// Square root of each; positive numbers and zero.
template <typename L> L square_roots(const L& value) {
    if constexpr (sizeof(L) == sizeof(double)) {
        return std::sqrt(value);
    } else {
#if defined(WARPSHADOW_ROOTS)
        return WARPSHADOW_ROOTS(value);
#elif defined(WARPSHADOW_PAIR_OF_ROOTS)
        constexpr std::size_t pairs = sizeof(L) / (2 * sizeof(double));
        lanes<2> parts[pairs];
        std::memcpy(parts, &value, sizeof value);
        for (lanes<2>& part : parts) {
            part = WARPSHADOW_PAIR_OF_ROOTS(part);
        }
        L roots;
        std::memcpy(&roots, parts, sizeof roots);
        return roots;
#else
        constexpr std::size_t count = sizeof(L) / sizeof(double);
        double parts[count];
        store(parts, value);
        for (double& part : parts) {
            part = std::sqrt(part);
        }
        L roots;
        load(roots, parts);
        return roots;
#endif
    }
}

} // namespace warpshadow::detail

#undef WARPSHADOW_ROOTS
#undef WARPSHADOW_PAIR_OF_ROOTS
