// A row of the map at a time: counts added to and taken from a window, and the window's function
// as floats. Written for vectors of counts, as wide as the machine has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace warpshadow::detail {

#if defined(__GNUC__)

#if defined(__AVX512F__)
inline constexpr std::size_t count_lanes = 16;
#elif defined(__AVX2__)
inline constexpr std::size_t count_lanes = 8;
#else
inline constexpr std::size_t count_lanes = 4;
#endif

template <typename Scalar, std::size_t N> struct lanes_type {
    typedef Scalar type __attribute__((vector_size(N * sizeof(Scalar))));
};
template <typename Scalar, std::size_t N> using lanes_n = typename lanes_type<Scalar, N>::type;
using count_vector = lanes_n<std::uint32_t, count_lanes>;
using half_counts = lanes_n<std::int32_t, count_lanes / 2>;
using half_doubles = lanes_n<double, count_lanes / 2>;
using half_floats = lanes_n<float, count_lanes / 2>;

// Sums of all lanes up to each; and of the last lane as all lanes. Zeros are shifted in.
#if defined(__AVX512F__)
inline count_vector scan_lanes(count_vector v) {
    const count_vector z{};
    v += __builtin_shufflevector(z, v, 0, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29,
                                 30);
    v +=
        __builtin_shufflevector(z, v, 0, 0, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29);
    v += __builtin_shufflevector(z, v, 0, 0, 0, 0, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27);
    v += __builtin_shufflevector(z, v, 0, 0, 0, 0, 0, 0, 0, 0, 16, 17, 18, 19, 20, 21, 22, 23);
    return v;
}
inline count_vector last_lane(count_vector v) {
    return __builtin_shufflevector(v, v, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15,
                                   15);
}
#elif defined(__AVX2__)
inline count_vector scan_lanes(count_vector v) {
    const count_vector z{};
    v += __builtin_shufflevector(z, v, 0, 8, 9, 10, 11, 12, 13, 14);
    v += __builtin_shufflevector(z, v, 0, 0, 8, 9, 10, 11, 12, 13);
    v += __builtin_shufflevector(z, v, 0, 0, 0, 0, 8, 9, 10, 11);
    return v;
}
inline count_vector last_lane(count_vector v) {
    return __builtin_shufflevector(v, v, 7, 7, 7, 7, 7, 7, 7, 7);
}
#else
inline count_vector scan_lanes(count_vector v) {
    const count_vector z{};
    v += __builtin_shufflevector(z, v, 0, 4, 5, 6);
    v += __builtin_shufflevector(z, v, 0, 0, 4, 5);
    return v;
}
inline count_vector last_lane(count_vector v) {
    return __builtin_shufflevector(v, v, 3, 3, 3, 3);
}
#endif

#else // one at a time
inline constexpr std::size_t count_lanes = 1;
#endif

/// What moving a window by a row leaves.
struct moved_row {
    std::uint64_t added; ///< exact sum of the row that came in
    std::uint32_t total; ///< sum of the window, modulo 2³²
};

/// Adds a row to the window and takes one from it; all sums modulo 2³².
///
/// @tparam Add, Remove whether there is such a row
template <bool Add, bool Remove>
moved_row move_row(std::uint32_t* sums, const std::uint32_t* in, const std::uint32_t* out,
                   std::size_t width) {
    moved_row moved{0, 0};
    std::size_t i = 0;
#if defined(__GNUC__)
    // low and high halves apart, so that 32 bits hold the sum of 65536 counts in each lane
    count_vector low{};
    count_vector high{};
    count_vector all{};
    for (; i + count_lanes <= width; i += count_lanes) {
        count_vector sum;
        std::memcpy(&sum, sums + i, sizeof sum);
        if constexpr (Add) {
            count_vector row;
            std::memcpy(&row, in + i, sizeof row);
            sum += row;
            low += row & 0xffffu;
            high += row >> 16;
        }
        if constexpr (Remove) {
            count_vector row;
            std::memcpy(&row, out + i, sizeof row);
            sum -= row;
        }
        all += sum;
        std::memcpy(sums + i, &sum, sizeof sum);
    }
    for (std::size_t lane = 0; lane < count_lanes; ++lane) {
        moved.added += low[lane] + (std::uint64_t(high[lane]) << 16);
        moved.total += all[lane];
    }
#endif
    for (; i < width; ++i) {
        if constexpr (Add) {
            sums[i] += in[i];
            moved.added += in[i];
        }
        if constexpr (Remove) {
            sums[i] -= out[i];
        }
        moved.total += sums[i];
    }
    return moved;
}

#if defined(__GNUC__)
/// Nodes of one vector of sums: `before` + scan, times a, plus node number times b.
inline void put_nodes(const std::uint32_t* sums, count_vector& before, half_doubles& k0,
                      half_doubles& k1, double a, double b, float* nodes) {
    constexpr std::size_t half = count_lanes / 2;
    count_vector v;
    std::memcpy(&v, sums, sizeof v);
    v = scan_lanes(v) + before;
    before = last_lane(v);
    half_counts halves[2];
    std::memcpy(halves, &v, sizeof v);
    const half_doubles f0 = __builtin_convertvector(halves[0], half_doubles) * a + k0 * b;
    const half_doubles f1 = __builtin_convertvector(halves[1], half_doubles) * a + k1 * b;
    const half_floats n0 = __builtin_convertvector(f0, half_floats);
    const half_floats n1 = __builtin_convertvector(f1, half_floats);
    std::memcpy(nodes, &n0, sizeof n0);
    std::memcpy(nodes + half, &n1, sizeof n1);
    k0 += double(count_lanes);
    k1 += double(count_lanes);
}
#endif

/// Function of a window as floats: node k is (sum before k) · a + k · b, rounded once.
///
/// The sum of all is below 2³¹, and a · sum + b · width is 1 but for rounding. Each operation is
/// monotone, hence so are the nodes.
/// @param nodes receives width + 1 nodes, the first 0 and the last 1
inline void scan_row(const std::uint32_t* sums, std::size_t width, double a, double b,
                     float* nodes) {
    nodes[0] = 0.0f;
    ++nodes; // nodes[i] now is behind cell i
    std::size_t i = 0;
#if defined(__GNUC__)
    count_vector before{};
    half_doubles k0;
    half_doubles k1;
    for (std::size_t lane = 0; lane < count_lanes / 2; ++lane) {
        k0[lane] = double(lane + 1);
        k1[lane] = double(lane + 1 + count_lanes / 2);
    }
    for (; i + count_lanes <= width; i += count_lanes) {
        put_nodes(sums + i, before, k0, k1, a, b, nodes + i);
    }
    if (i < width) {
        // the same operations for what does not fill a vector
        std::uint32_t rest[count_lanes] = {};
        float last[count_lanes];
        std::memcpy(rest, sums + i, (width - i) * sizeof rest[0]);
        put_nodes(rest, before, k0, k1, a, b, last);
        std::memcpy(nodes + i, last, (width - i) * sizeof last[0]);
    }
#else
    std::uint32_t before = 0;
    for (; i < width; ++i) {
        before += sums[i];
        nodes[i] = static_cast<float>(double(before) * a + double(i + 1) * b);
    }
#endif
    nodes[width - 1] = 1.0f;
}

} // namespace warpshadow::detail
