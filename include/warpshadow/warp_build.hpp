// Building warp tables from importance: the second half of Milet et al. 2015, §3.
#pragma once

#include <warpshadow/build_options.hpp>
#include <warpshadow/detail/axis_bands.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/second_axis.hpp>
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

/// Smallest density floor with which `unwarp` finds its way back to a share of a texel.
///
/// Rounding of a warped position is magnified by 1 / ε on the way back: w · u / ε texels of w.
/// @tparam Node   stored type
/// @param  cells  texels of the map along the axis, positive
/// @param  texels what is allowed to be lost, positive
template <typename T, typename Node> T density_floor(int cells, T texels) {
    const T lost = T(cells) * T(0.5) * std::numeric_limits<T>::epsilon() / texels;
    const T smallest = smallest_floor<T, Node>(cells);
    return lost > smallest ? (lost < T(1) ? lost : T(1)) : smallest;
}

namespace detail {

/// Density floor, window and shear limit as they can be used.
template <typename T, typename Node>
build_options<T> checked_options(const build_options<T>& options, int cells, int rows,
                                 status& flags) {
    const auto is_nan = [](T x) { return !(x >= T(0)) && !(x < T(0)); };
    build_options<T> used = options;
    if (!(options.floor >= T(0) && options.floor <= T(1))) {
        used.floor = is_nan(options.floor)  ? build_options<T>{}.floor
                     : options.floor < T(0) ? T(0)
                                            : T(1);
        flags |= is_nan(options.floor) ? status::invalid_input : status::out_of_range;
    }
    if (!(options.shear >= T(0))) {
        used.shear = is_nan(options.shear) ? build_options<T>{}.shear : T(0);
        flags |= is_nan(options.shear) ? status::invalid_input : status::out_of_range;
    }
    T smallest = smallest_floor<T, Node>(cells);
    if (std::is_same_v<Node, double> && used.shear < std::numeric_limits<T>::infinity()) {
        smallest *= T(2); // mixing rounds once more
    }
    if (used.floor < smallest) {
        // storage too coarse for any floor below 1 leaves nothing but the identity
        used.floor = smallest < T(1) ? smallest : T(1);
        flags |= status::floor_raised;
    }
    if (options.radius >= 0) {
        used.radius = options.radius;
        return used;
    }
    if (!(options.window >= T(0) && options.window <= T(2))) {
        used.window = is_nan(options.window) ? build_options<T>{}.window : options.window;
        flags |= is_nan(options.window) ? status::invalid_input : status::out_of_range;
    }
    used.radius = window_radius(used.window, rows);
    return used;
}

/// Builds all bands of an axis; the result does not depend on their number.
template <int Passes, typename T, typename Node, typename Parallel>
band_result build_bands(const axis_job& job, double shear, std::span<std::uint64_t> scratch,
                        std::span<Node> nodes, const Parallel& parallel) {
    const auto width = static_cast<std::size_t>(job.counts.width);
    const int rows = job.counts.height;
    const bool limited = shear < std::numeric_limits<double>::infinity();
    const common_nodes common{scratch.first(limited ? width : 0)};
    const std::span<std::uint64_t> memory = scratch.subspan(limited ? width : 0);
    const std::size_t share = width * (box_sums<Passes>::memory + (limited ? 1 : 0));
    const std::size_t room = memory.size() / share;
    int bands = room < std::size_t(most_bands) ? static_cast<int>(room) : most_bands;
    bands = bands < rows ? bands : rows;
    band_result results[most_bands];

    // calls work(first, last, memory, result) for each band
    const auto for_bands = [&](const auto& work) {
        for (int band = 0; band < bands; ++band) {
            results[band] = band_result{};
        }
        parallel(bands, [&](int band) {
            const auto first_of = [&](int b) {
                return static_cast<int>(std::int64_t(rows) * b / bands);
            };
            work(first_of(band), first_of(band + 1),
                 memory.subspan(static_cast<std::size_t>(band) * share, share), results[band]);
        });
        band_result all;
        for (int band = 0; band < bands; ++band) {
            all.samples += results[band].samples;
            all.empty_rows += results[band].empty_rows;
            all.mix = all.mix > results[band].mix ? all.mix : results[band].mix;
            all.too_large = all.too_large || results[band].too_large;
        }
        return all;
    };

    double mix = 0.0;
    if (limited) {
        find_common(job, common);
        mix =
            for_bands([&](int first, int last, std::span<std::uint64_t> own, band_result& result) {
                measure_band<Passes>(job, first, last, shear, common, own, result);
            }).mix;
        // so that rounding cannot leave the limit
        mix = mix > 0.0 ? 1.0 - (1.0 - mix) * (1.0 - 0x1p-40) : 0.0;
    }
    if constexpr (Passes == 1 && std::is_same_v<Node, float>) {
        if (!(mix > 0.0)) {
            const band_result all = for_bands(
                [&](int first, int last, std::span<std::uint64_t> own, band_result& result) {
                    write_band_fast(job, first, last, own, nodes, result);
                });
            if (!all.too_large) {
                return all;
            }
        }
    }
    band_result all =
        for_bands([&](int first, int last, std::span<std::uint64_t> own, band_result& result) {
            write_band<Passes, Node>(job, first, last, mix, common, own, nodes, result);
        });
    all.mix = mix;
    return all;
}

} // namespace detail

/// Builds the functions of one axis from a count map: one per row, smoothed across rows.
///
/// The rows of `out` are the rows of the map, whatever its size: a grid of 64² or 128² functions
/// serves a shadow map of any number of texels. Sums are 64-bit integers and nodes are rounded
/// once: each function increases, starts at exactly 0 and ends at exactly 1.
/// @param counts   importance; `fits(counts)`, and of the size of `out`
/// @param options  window, floor, shear limit; out of range or NaN is clamped or replaced by the
///                 default
/// @param scratch  `scratch_size(counts.width, options)` numbers; with memory for several bands,
///                 as many are built at once
/// @param out      functions
/// @param parallel parallel-for, see `serial_for`; the result is the same to the bit with any
/// @return         buffer_too_small, and nothing written, if a size does not match
template <typename T, typename Node, typename Parallel = serial_for>
build_result<T> build_axis(const count_view& counts, const build_options<T>& options,
                           std::span<std::uint64_t> scratch, const table_span<T, Node>& out,
                           const Parallel& parallel = Parallel{}) {
    build_result<T> result;
    const std::size_t stride = static_cast<std::size_t>(out.cells) + 1;
    if (!fits(counts) || out.cells != counts.width || out.rows != counts.height ||
        scratch.size() < scratch_size(counts.width, options) ||
        out.nodes.size() < static_cast<std::size_t>(out.rows) * stride) {
        result.flags = status::buffer_too_small;
        return result;
    }
    const build_options<T> used =
        detail::checked_options<T, Node>(options, out.cells, out.rows, result.flags);
    result.floor = used.floor;
    result.radius = used.radius;
    detail::axis_job job{counts, used.radius, 0, double(used.floor)};
    if (used.shape != window_shape::box) {
        job.shift = window_shift(detail::samples_in(counts, 0, counts.height), used.radius,
                                 counts.height, used.shape);
        result.flags |= job.shift > 0 ? status::out_of_range : status::ok;
    }
    const double shear = double(used.shear);
    const detail::band_result bands =
        used.shape == window_shape::box
            ? detail::build_bands<1, T, Node>(job, shear, scratch, out.nodes, parallel)
        : used.shape == window_shape::tent
            ? detail::build_bands<2, T, Node>(job, shear, scratch, out.nodes, parallel)
            : detail::build_bands<3, T, Node>(job, shear, scratch, out.nodes, parallel);
    result.samples = bands.samples;
    result.empty_rows = bands.empty_rows;
    result.mix = T(bands.mix);
    if (result.samples == 0) {
        result.flags |= status::empty_importance;
    } else if (result.empty_rows > 0) {
        result.flags |= status::empty_rows;
    }
    return result;
}

/// Memory for `build_warp`, owned by the caller.
template <typename T, typename Node = T> struct warp_memory {
    int size = 0;                     ///< cells of a function, along either axis
    std::span<std::uint32_t> counts;  ///< size · functions
    std::span<std::uint64_t> scratch; ///< `scratch_size(size, options)`; size for the defaults
    std::span<Node> rows;             ///< functions · (size + 1): receives the row functions
    std::span<Node> columns;          ///< functions · (size + 1): receives the column functions
    int functions = 0;                ///< functions of either axis; 0 for `size`
};

/// The smallest table there is: one function of one cell, the identity.
template <typename T, typename Node = T> table_view<T, Node> identity_table() {
    static constexpr Node nodes[2] = {
        Node(0), std::is_integral_v<Node> ? std::numeric_limits<Node>::max() : Node(1)};
    return {nodes, 1, 1};
}

/// Tables of both axes and what building them met.
template <typename T, typename Node = T> struct warp_result {
    /// Functions of u, one per row; with `v_first` functions of v, one per column.
    table_view<T, Node> rows = identity_table<T, Node>();
    /// Functions of v, one per column; with `v_first` functions of u, one per row.
    table_view<T, Node> columns = identity_table<T, Node>();
    splat_result splat;        ///< counted and rejected samples
    status flags = status::ok; ///< union of all steps
    T row_mix = T(0);          ///< what the shear limit took of the first axis
    T column_mix = T(0);       ///< and of the second
    /// The tables are those of the map with its axes exchanged: `warp(rows, columns, p.yx)` is the
    /// warped (V, U), the same for `unwarp`, and `jacobian` gives columns ∂/∂v and ∂/∂u of (V, U).
    bool v_first = false;
};

/// Builds a non-orthogonal warp from view samples (Milet et al. 2015, §3, steps 2 to 7).
///
/// @param samples  positions of lit-facing view samples in map space
/// @param options  window, floor, shear limit, order of axes
/// @param memory   where counts and tables go; with buffer_too_small nothing is written and the
///                 result's tables are the identity
/// @param parallel parallel-for, see `serial_for`; the samples are counted one after another
template <typename T, typename Node, typename Parallel = serial_for>
warp_result<T, Node> build_warp(std::span<const glm::vec<2, T>> samples,
                                const build_options<T>& options, const warp_memory<T, Node>& memory,
                                const Parallel& parallel = Parallel{}) {
    warp_result<T, Node> result;
    const int functions = memory.functions == 0 ? memory.size : memory.functions;
    const std::size_t cells = memory.size > 0 ? static_cast<std::size_t>(memory.size) : 0;
    const std::size_t count = functions > 0 ? static_cast<std::size_t>(functions) : 0;
    if (cells == 0 || count == 0 || memory.counts.size() < cells * count ||
        memory.scratch.size() < scratch_size(memory.size, options) ||
        memory.rows.size() < count * (cells + 1) || memory.columns.size() < count * (cells + 1)) {
        result.flags = status::buffer_too_small;
        return result;
    }
    const count_map counts{memory.counts, memory.size, functions};
    const table_span<T, Node> rows{memory.rows, memory.size, functions};
    const table_span<T, Node> columns{memory.columns, memory.size, functions};
    const auto ordered = [&options](glm::vec<2, T> p) {
        return options.v_first ? glm::vec<2, T>(p.y, p.x) : p;
    };

    clear(counts);
    result.splat = detail::count_samples(
        samples,
        [&](glm::vec<2, T> p) {
            const glm::vec<2, T> q = ordered(p);
            const int i = cell_of(q.x, counts.width);
            const int j = cell_of(q.y, counts.height);
            return i < 0 || j < 0 ? std::ptrdiff_t(-1)
                                  : static_cast<std::ptrdiff_t>(j) * counts.width + i;
        },
        counts);
    result.flags |= result.splat.flags;
    const build_result<T> first = build_axis(counts, options, memory.scratch, rows, parallel);
    result.flags |= first.flags;
    result.row_mix = first.mix;
    result.rows = rows;

    clear(counts);
    result.flags |=
        detail::count_samples(
            samples,
            [&](glm::vec<2, T> p) { return detail::column_cell(result.rows, ordered(p), counts); },
            counts)
            .flags;
    const build_result<T> second = build_axis(counts, options, memory.scratch, columns, parallel);
    result.flags |= second.flags;
    result.column_mix = second.mix;
    result.columns = columns;
    result.v_first = options.v_first;
    return result;
}

} // namespace warpshadow
