// Several doubles worked on at once, where the compiler has vector types; else one.
#pragma once

#include <cstring>

namespace warpshadow::detail {

// A kernel written for a lane type L uses + - * /, comparisons and ?: alone. These mean the same
// for a vector and for a plain double, so that lanes<1> is the scalar path and gives equal results.
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

} // namespace warpshadow::detail
