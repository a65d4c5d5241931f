// Four points at a time through a table of floats: what `axis_offset` does, in vectors.
#pragma once

#include <warpshadow/warp.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__GNUC__)

namespace warpshadow::detail {

typedef float float_lanes __attribute__((vector_size(16)));
typedef std::int32_t int_lanes __attribute__((vector_size(16)));
typedef double node_pairs __attribute__((vector_size(16)));

/// `clamp_to_unit`, lane by lane.
inline void clamp_lanes(float_lanes& x) {
    const float_lanes zero{};
    const float_lanes one = zero + 1.0f;
    const float_lanes low = one < x ? one : x;
    x = x > zero ? low : zero;
}

/// `axis_offset` with `blend_rows`, lane by lane, by the same operations.
///
/// @param table  `fits(table)`
/// @param across coordinates across the rows
/// @param x      coordinates along the axis
/// @param offset receives F(x) − x
inline void offset_lanes(const table_view<float>& table, const float_lanes& across,
                         const float_lanes& x, float_lanes& offset) {
    const float_lanes zero{};
    const float_lanes last_row = zero + float(table.rows - 1);
    const float_lanes cells = zero + float(table.cells);
    float_lanes row = across;
    clamp_lanes(row);
    row = row * float(table.rows) - 0.5f;
    row = row < zero ? zero : row;
    row = last_row < row ? last_row : row;
    const int_lanes row0 = __builtin_convertvector(row, int_lanes);
    const float_lanes weight = row - __builtin_convertvector(row0, float_lanes);

    float_lanes position = x;
    clamp_lanes(position);
    position = position * cells;
    int_lanes cell = __builtin_convertvector(position, int_lanes);
    const int_lanes last_cell = int_lanes{} + (table.cells - 1);
    cell = cell < last_cell ? cell : last_cell;
    const float_lanes k = __builtin_convertvector(cell, float_lanes);

    // both nodes of a cell in one load, both functions in one vector
    const std::size_t stride = static_cast<std::size_t>(table.cells) + 1;
    float_lanes node[4];
    for (int lane = 0; lane < 4; ++lane) {
        const float* const below = table.nodes.data() +
                                   static_cast<std::size_t>(row0[lane]) * stride +
                                   static_cast<std::size_t>(cell[lane]);
        const float* const above = below + (row0[lane] + 1 < table.rows ? stride : 0);
        double pairs[2];
        std::memcpy(pairs, below, sizeof pairs[0]);
        std::memcpy(pairs + 1, above, sizeof pairs[1]);
        const node_pairs both{pairs[0], pairs[1]};
        node[lane] = reinterpret_cast<float_lanes>(both);
    }
    const float_lanes low01 = __builtin_shufflevector(node[0], node[1], 0, 4, 1, 5);
    const float_lanes low23 = __builtin_shufflevector(node[2], node[3], 0, 4, 1, 5);
    const float_lanes high01 = __builtin_shufflevector(node[0], node[1], 2, 6, 3, 7);
    const float_lanes high23 = __builtin_shufflevector(node[2], node[3], 2, 6, 3, 7);
    const float_lanes below0 = __builtin_shufflevector(low01, low23, 0, 1, 4, 5);
    const float_lanes below1 = __builtin_shufflevector(low01, low23, 2, 3, 6, 7);
    const float_lanes above0 = __builtin_shufflevector(high01, high23, 0, 1, 4, 5);
    const float_lanes above1 = __builtin_shufflevector(high01, high23, 2, 3, 6, 7);

    const float_lanes offset0 = below0 + weight * (above0 - below0) - k / cells;
    const float_lanes offset1 = below1 + weight * (above1 - below1) - (k + 1.0f) / cells;
    offset = offset0 + (position - k) * (offset1 - offset0);
}

/// Warps four points; `to` may be `from`.
inline void warp_lanes(const table_view<float>& rows, const table_view<float>& columns,
                       const float* from, float* to) {
    float_lanes first;
    float_lanes second;
    std::memcpy(&first, from, sizeof first);
    std::memcpy(&second, from + 4, sizeof second);
    const float_lanes x = __builtin_shufflevector(first, second, 0, 2, 4, 6);
    const float_lanes y = __builtin_shufflevector(first, second, 1, 3, 5, 7);
    float_lanes u;
    float_lanes v;
    offset_lanes(rows, y, x, u);
    u += x;
    offset_lanes(columns, u, y, v);
    v += y;
    first = __builtin_shufflevector(u, v, 0, 4, 1, 5);
    second = __builtin_shufflevector(u, v, 2, 6, 3, 7);
    std::memcpy(to, &first, sizeof first);
    std::memcpy(to + 4, &second, sizeof second);
}

} // namespace warpshadow::detail

#endif
