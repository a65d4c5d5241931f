// Building warp tables from importance: the second half of Milet et al. 2015, §3.
#pragma once

#include <warpshadow/importance.hpp>
#include <warpshadow/smoothing.hpp>
#include <warpshadow/warp.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

namespace warpshadow {

/// Functions of one axis, for writing; the layout of `table_view`.
template <typename T, typename Node = T> struct table_span {
    std::span<Node> nodes; ///< at least rows · (cells + 1) nodes
    int cells = 0;         ///< cells along the axis that is warped
    int rows = 0;          ///< functions, one per row across that axis

    // What can be written can be read; the implicit conversion is the point.
    constexpr operator table_view<T, Node>() const { // NOLINT(google-explicit-constructor)
        return {nodes, cells, rows};
    }
};

/// How tables are built. The defaults suit outdoor and indoor scenes alike.
template <typename T> struct build_options {
    /// Width of the smoothing window across functions, as a share of their number. Wide windows
    /// make neighbouring functions alike, which the rasteriser's straight edges need; a share of 2
    /// makes all equal (rectilinear warping).
    T window = T(0.12);
    /// Density floor ε: no part of the map shrinks below this share of its uniform extent.
    T floor = T(0.2);
};

/// What building one axis met.
template <typename T> struct build_result {
    std::uint64_t samples = 0; ///< sum of all counts
    int empty_rows = 0;        ///< functions without a sample in their window: the identity
    T floor = T(0);            ///< the density floor that was used
    status flags = status::ok; ///< empty_importance, empty_rows, floor_raised, out_of_range, …
};

/// Smallest density floor with which stored functions still increase strictly.
///
/// @tparam Node  stored type
/// @param  cells cells of a function, positive
/// @return       cells · 2⁻²³ for float: an increment of ε / cells is two steps near 1, rounding
///               takes at most one. cells / 65534 for 16 bits: just above one step. cells · 2⁻⁵⁰
///               for double, where both nodes carry an error of up to 3.5 · 2⁻⁵³ from their
///               computation
template <typename T, typename Node> T smallest_floor(int cells) {
    if constexpr (std::is_integral_v<Node>) {
        // a floor that is rounded down must not fall below one step
        return T(cells) / T(std::numeric_limits<Node>::max() - 1);
    } else if constexpr (sizeof(Node) < sizeof(double)) {
        return T(cells) * T(std::numeric_limits<Node>::epsilon());
    } else {
        return T(cells) * T(4) * T(std::numeric_limits<Node>::epsilon());
    }
}

/// Node k of a function from an exclusive sum of counts (Milet et al. 2015, eq. 4, with a floor).
///
/// F(k/w) = k/w + (1 − ε) · (before/total − k/w). The difference is taken in integers, so it is
/// exact before its one rounding: a uniform row gives k/w to the bit, and F(0) = 0 and F(1) = 1.
/// @param before sum of the counts of cells 0 to k − 1
/// @param total  sum of all counts of the row; 0 gives the identity
/// @param k      node, 0 ≤ k ≤ cells
/// @param cells  cells of the row, 1 to 32768
/// @param floor  density floor ε in [0, 1]
template <typename T, typename Count>
T warp_node(Count before, Count total, int k, int cells, T floor) {
    T x = T(k) / T(cells);
    if (total == Count(0)) {
        return x;
    }
    // k · total / cells as whole part and remainder, without a product that overflows
    Count quotient = total / Count(cells);
    Count remainder = Count(k) * (total - quotient * Count(cells));
    Count expected = Count(k) * quotient + remainder / Count(cells);
    T fraction = T(remainder - remainder / Count(cells) * Count(cells)) / T(cells);
    T excess = before >= expected ? T(before - expected) : -T(expected - before);
    return x + (T(1) - floor) * ((excess - fraction) / T(total));
}

/// Builds the functions of one axis from a count map: one per row, smoothed across rows.
///
/// The rows of `out` are the rows of the map. Sums are 64-bit integers and nodes are rounded once:
/// each function increases, starts at exactly 0 and ends at exactly 1.
/// @param counts  importance; `fits(counts)`, and of the size of `out`
/// @param options window and floor; out of range or NaN is clamped or replaced by the default
/// @param scratch memory for `counts.width` sums
/// @param out     functions
/// @return        buffer_too_small, and nothing written, if a size does not match
template <typename T, typename Node>
build_result<T> build_axis(const count_view& counts, const build_options<T>& options,
                           std::span<std::uint64_t> scratch, const table_span<T, Node>& out) {
    build_result<T> result;
    const std::size_t stride = static_cast<std::size_t>(out.cells) + 1;
    if (!fits(counts) || out.cells != counts.width || out.rows != counts.height ||
        scratch.size() < static_cast<std::size_t>(counts.width) ||
        out.nodes.size() < static_cast<std::size_t>(out.rows) * stride) {
        result.flags = status::buffer_too_small;
        return result;
    }

    result.floor = options.floor;
    if (!(options.floor >= T(0) && options.floor <= T(1))) {
        const bool is_nan = !(options.floor >= T(0)) && !(options.floor < T(0));
        result.floor = is_nan ? build_options<T>{}.floor : options.floor < T(0) ? T(0) : T(1);
        result.flags |= is_nan ? status::invalid_input : status::out_of_range;
    }
    const T smallest = smallest_floor<T, Node>(out.cells);
    if (result.floor < smallest) {
        // storage too coarse for any floor below 1 leaves nothing but the identity
        result.floor = smallest < T(1) ? smallest : T(1);
        result.flags |= status::floor_raised;
    }
    T share = options.window;
    if (!(share >= T(0) && share <= T(2))) {
        const bool is_nan = !(share >= T(0)) && !(share < T(0));
        share = is_nan ? build_options<T>{}.window : share; // window_radius clamps
        result.flags |= is_nan ? status::invalid_input : status::out_of_range;
    }

    row_window window(counts, window_radius(share, counts.height), scratch);
    for (int row = 0; row < out.rows; ++row) {
        const std::span<Node> nodes =
            out.nodes.subspan(static_cast<std::size_t>(row) * stride, stride);
        const std::span<const std::uint64_t> sums = window.sums();
        const std::uint64_t total = window.total();
        result.empty_rows += total == 0 ? 1 : 0;
        std::uint64_t before = 0;
        double previous = 0.0;
        for (int k = 0; k <= out.cells; ++k) {
            double node = warp_node<double>(before, total, k, out.cells, double(result.floor));
            // rounding may undo an increment that is as small as the rounding itself
            node = node < previous ? previous : node > 1.0 ? 1.0 : node;
            previous = node;
            if constexpr (std::is_integral_v<Node>) {
                nodes[static_cast<std::size_t>(k)] = static_cast<Node>(
                    std::floor(node * double(std::numeric_limits<Node>::max()) + 0.5));
            } else {
                nodes[static_cast<std::size_t>(k)] = static_cast<Node>(node);
            }
            if (k < out.cells) {
                before += sums[static_cast<std::size_t>(k)];
            }
        }
        if (row + 1 < out.rows) {
            window.advance();
        }
    }

    for (std::size_t i = 0;
         i < static_cast<std::size_t>(counts.width) * static_cast<std::size_t>(counts.height);
         ++i) {
        result.samples += counts.counts[i];
    }
    if (result.samples == 0) {
        result.flags |= status::empty_importance;
    } else if (result.empty_rows > 0) {
        result.flags |= status::empty_rows;
    }
    return result;
}

/// Counts view samples for the second axis: moved by the row functions, and transposed.
///
/// Cell (v, U) of the map, that is row U and column v, counts the samples whose warped u is in
/// column U (Milet et al. 2015, §3, step 6). `build_axis` then gives the column functions.
/// @param samples positions in map space; rejected as in `splat`
/// @param rows    functions of u
/// @param map     counters, added to; `map.width` cells along v, `map.height` columns
/// @return        buffer_too_small, and nothing written, with `fits(map)` or `fits(rows)` false
template <typename T, typename Node>
splat_result splat_columns(std::span<const glm::vec<2, T>> samples, const table_view<T, Node>& rows,
                           const count_map& map) {
    splat_result result;
    if (!fits(map) || !fits(rows)) {
        result.rejected = samples.size();
        result.flags = status::buffer_too_small;
        return result;
    }
    for (const glm::vec<2, T>& p : samples) {
        const int j = cell_of(p.y, map.width);
        if (j < 0 || cell_of(p.x, 1) < 0) {
            ++result.rejected;
            continue;
        }
        const T warped = p.x + axis_offset(rows, blend_rows(p.y, rows.rows), p.x);
        // rounding may carry the last sample past 1
        const int i = cell_of(glm::clamp(warped, T(0), T(1)), map.height);
        const auto cell = static_cast<std::size_t>(i) * static_cast<std::size_t>(map.width) +
                          static_cast<std::size_t>(j);
        result.flags |= count_sample(map, cell);
        ++result.counted;
    }
    if (result.rejected != 0) {
        result.flags |= status::samples_rejected;
    }
    return result;
}

/// Memory for `build_warp`, owned by the caller, for a map of size × size cells.
template <typename T, typename Node = T> struct warp_memory {
    int size = 0;                     ///< cells along either axis
    std::span<std::uint32_t> counts;  ///< size · size
    std::span<std::uint64_t> scratch; ///< size
    std::span<Node> rows;             ///< size · (size + 1): receives the row functions
    std::span<Node> columns;          ///< size · (size + 1): receives the column functions
};

/// The smallest table there is: one function of one cell, the identity.
template <typename T, typename Node = T> table_view<T, Node> identity_table() {
    static constexpr Node nodes[2] = {
        Node(0), std::is_integral_v<Node> ? std::numeric_limits<Node>::max() : Node(1)};
    return {nodes, 1, 1};
}

/// Tables of both axes and what building them met.
template <typename T, typename Node = T> struct warp_result {
    /// Functions of u, one per row.
    table_view<T, Node> rows = identity_table<T, Node>();
    /// Functions of v, one per column.
    table_view<T, Node> columns = identity_table<T, Node>();
    splat_result splat;        ///< counted and rejected samples
    status flags = status::ok; ///< union of all steps
};

/// Builds a non-orthogonal warp from view samples (Milet et al. 2015, §3, steps 2 to 7).
///
/// @param samples positions of lit-facing view samples in map space
/// @param options window and floor
/// @param memory  where counts and tables go; with buffer_too_small nothing is written and the
///                result's tables are the identity
template <typename T, typename Node>
warp_result<T, Node> build_warp(std::span<const glm::vec<2, T>> samples,
                                const build_options<T>& options,
                                const warp_memory<T, Node>& memory) {
    warp_result<T, Node> result;
    const std::size_t cells = memory.size > 0 ? static_cast<std::size_t>(memory.size) : 0;
    if (cells == 0 || memory.counts.size() < cells * cells || memory.scratch.size() < cells ||
        memory.rows.size() < cells * (cells + 1) || memory.columns.size() < cells * (cells + 1)) {
        result.flags = status::buffer_too_small;
        return result;
    }
    const count_map counts{memory.counts, memory.size, memory.size};
    const table_span<T, Node> rows{memory.rows, memory.size, memory.size};
    const table_span<T, Node> columns{memory.columns, memory.size, memory.size};

    clear(counts);
    result.splat = splat(samples, counts);
    result.flags |= result.splat.flags;
    result.flags |= build_axis(counts, options, memory.scratch, rows).flags;
    result.rows = rows;

    clear(counts);
    result.flags |= splat_columns(samples, result.rows, counts).flags;
    result.flags |= build_axis(counts, options, memory.scratch, columns).flags;
    result.columns = columns;
    return result;
}

} // namespace warpshadow
