// Several doubles worked on at once, where the compiler has vector types; else one.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
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

/// Square root of each; positive numbers and zero.
template <typename L> L square_roots(const L& value) {
    if constexpr (sizeof(L) == sizeof(double)) {
        return std::sqrt(value);
    } else {
#if defined(__SSE2__)
        // the compilers' own loops stop at each root to set errno
        constexpr std::size_t pairs = sizeof(L) / sizeof(__m128d);
        __m128d parts[pairs];
        std::memcpy(parts, &value, sizeof value);
        for (__m128d& part : parts) {
            part = _mm_sqrt_pd(part);
        }
        L roots;
        std::memcpy(&roots, parts, sizeof roots);
        return roots;
#else
        double parts[sizeof(L) / sizeof(double)];
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
