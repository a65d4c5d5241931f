// A row of the map at a time: the function of a window as floats, and the window moved on by a row.
// Written for vectors, and in one pass over the memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace warpshadow::detail {

/// What moving a window by a row leaves.
struct moved_row {
    std::uint64_t added; ///< exact sum of the row that came in
    std::uint32_t total; ///< sum of the window, modulo 2³²
};

/// What becomes of a row of sums.
struct row_step {
    const std::uint32_t* in;  ///< counts to add, or null
    const std::uint32_t* out; ///< counts to take away, or null
    double a;                 ///< the function: (sum before k) · a + k · b
    double b;
    float* nodes; ///< receives width + 1 nodes of the sums as they were, or null
};

#if defined(__GNUC__)

typedef std::uint32_t four_counts __attribute__((vector_size(16)));
typedef std::int32_t four_ints __attribute__((vector_size(16)));
typedef double four_doubles __attribute__((vector_size(32)));
typedef float four_floats __attribute__((vector_size(16)));

#if defined(__AVX2__)
typedef std::uint32_t some_counts __attribute__((vector_size(32)));
#else
typedef four_counts some_counts;
#endif
inline constexpr std::size_t count_lanes = sizeof(some_counts) / sizeof(std::uint32_t);

/// Counts that are done in one round of a loop, so that latencies overlap.
inline constexpr std::size_t counts_at_once = 16;

/// Counts below 2³¹, as signed numbers: those every machine converts.
inline void convert(four_counts v, four_doubles& to) {
#if defined(__AVX__) && !defined(__clang__)
    // GCC 12 converts two halves without being told
    to = __builtin_ia32_cvtdq2pd256(reinterpret_cast<four_ints>(v));
#else
    to = __builtin_convertvector(reinterpret_cast<four_ints>(v), four_doubles);
#endif
}

/// Sums of the lanes up to each. Zeros are shifted in.
inline four_counts scan_lanes(four_counts v) {
    const four_counts z{};
    v += __builtin_shufflevector(z, v, 0, 4, 5, 6);
    v += __builtin_shufflevector(z, v, 0, 0, 4, 5);
    return v;
}

/// Writes four nodes: (sum before) · a + kb.
inline void put_nodes(const std::uint32_t* sums, four_counts& before, double a,
                      const four_doubles& kb, float* nodes) {
    four_counts v;
    std::memcpy(&v, sums, sizeof v);
    v = scan_lanes(v);
    four_doubles f;
    convert(v + before, f);
    f = f * a + kb;
    before += __builtin_shufflevector(v, v, 3, 3, 3, 3);
    const four_floats node = __builtin_convertvector(f, four_floats);
    std::memcpy(nodes, &node, sizeof node);
}

#endif

/// Exact sum of a row of counts.
inline std::uint64_t sum_of_row(const std::uint32_t* counts, std::size_t width) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < width; ++i) {
        sum += counts[i];
    }
    return sum;
}

/// Writes the function of a window, and moves the window on; all sums modulo 2³².
///
/// Node k is rounded once, to float. The sum of all is below 2³¹, and a · sum + b · width is 1 but
/// for rounding. Each operation is monotone, hence so are the nodes; the first is 0 and the last 1.
/// @tparam Write, Add, Remove whether there are nodes, a row to add and a row to take away
template <bool Write, bool Add, bool Remove>
moved_row step_row(std::uint32_t* sums, std::size_t width, const row_step& step) {
    const std::uint32_t* const in = step.in;
    const std::uint32_t* const out = step.out;
    const double a = step.a;
    const double b = step.b;
    float* const nodes = Write ? step.nodes + 1 : nullptr; // nodes[i] is behind cell i
    moved_row moved{0, 0};
    std::size_t i = 0;
    std::uint32_t first = 0; // sum before cell i
#if defined(__GNUC__)
    some_counts added{};
    some_counts bits{}; // of all counts that are added
    some_counts all{};
    four_counts before{};
    four_doubles k{1.0, 2.0, 3.0, 4.0};
    const four_doubles step_b = four_doubles{} + 4.0 * b;
    const auto move = [&](std::size_t j) {
        some_counts sum;
        std::memcpy(&sum, sums + j, sizeof sum);
        if constexpr (Add) {
            some_counts row;
            std::memcpy(&row, in + j, sizeof row);
            sum += row;
            added += row;
            bits |= row;
        }
        if constexpr (Remove) {
            some_counts row;
            std::memcpy(&row, out + j, sizeof row);
            sum -= row;
        }
        if constexpr (Add || Remove) {
            std::memcpy(sums + j, &sum, sizeof sum);
        }
        all += sum;
    };
    for (; i + counts_at_once <= width; i += counts_at_once) {
        if constexpr (Write) {
            four_doubles kb = k * b;
            put_nodes(sums + i, before, a, kb, nodes + i);
            kb += step_b;
            put_nodes(sums + i + 4, before, a, kb, nodes + i + 4);
            kb += step_b;
            put_nodes(sums + i + 8, before, a, kb, nodes + i + 8);
            kb += step_b;
            put_nodes(sums + i + 12, before, a, kb, nodes + i + 12);
            k += double(counts_at_once);
        }
        move(i);
        move(i + count_lanes);
        if constexpr (count_lanes < 8) {
            move(i + 2 * count_lanes);
            move(i + 3 * count_lanes);
        }
    }
    std::uint32_t any = 0;
    for (std::size_t lane = 0; lane < count_lanes; ++lane) {
        moved.added += added[lane];
        moved.total += all[lane];
        any |= bits[lane];
    }
    if (std::uint64_t(any) * i >= std::uint64_t(1) << 32) {
        moved.added = sum_of_row(in, i); // a lane may have overflowed
    }
    first = before[0];
#endif
    for (; i < width; ++i) {
        if constexpr (Write) {
            first += sums[i];
            nodes[i] = static_cast<float>(double(first) * a + double(i + 1) * b);
        }
        if constexpr (Add) {
            sums[i] += in[i];
            moved.added += in[i];
        }
        if constexpr (Remove) {
            sums[i] -= out[i];
        }
        moved.total += sums[i];
    }
    if constexpr (Write) {
        step.nodes[0] = 0.0f;
        step.nodes[width] = 1.0f;
    }
    return moved;
}

} // namespace warpshadow::detail
