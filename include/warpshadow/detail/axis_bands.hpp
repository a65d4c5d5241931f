// Bands of rows of one axis: each is built on its own, so that several may be built at once.
#pragma once

#include <warpshadow/detail/node_walk.hpp>
#include <warpshadow/detail/row_lanes.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/smoothing.hpp>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow::detail {

/// What all bands of an axis have in common.
struct axis_job {
    count_view counts;
    int radius;   ///< half-width of the window's box, not negative
    int shift;    ///< see `window_shift`
    double floor; ///< density floor
};

/// What a band met; any order of bands gives the same union.
struct band_result {
    std::uint64_t samples = 0;
    double mix = 0.0; ///< share of the common function that the shear limit asks for
    int empty_rows = 0;
    bool too_large = false; ///< a window's sum has 32 bits and more
};

/// Sum of the counts of rows first to last − 1.
inline std::uint64_t samples_in(const count_view& counts, int first, int last) {
    const auto width = static_cast<std::size_t>(counts.width);
    std::uint64_t samples = 0;
    for (std::size_t i = static_cast<std::size_t>(first) * width;
         i < static_cast<std::size_t>(last) * width; ++i) {
        samples += counts.counts[i];
    }
    return samples;
}

/// Nodes of the function that all rows share, kept as bits; node 0 is 0 and not kept.
struct common_nodes {
    std::span<std::uint64_t> bits; ///< width, or empty where there is no such function

    [[nodiscard]] double node(int k) const {
        return k == 0 ? 0.0 : std::bit_cast<double>(bits[static_cast<std::size_t>(k) - 1]);
    }
};

/// Fills them from all counts.
inline void find_common(const axis_job& job, const common_nodes& common) {
    const auto width = static_cast<std::size_t>(job.counts.width);
    for (std::uint64_t& sum : common.bits) {
        sum = 0;
    }
    std::uint64_t total = 0;
    std::size_t count = 0;
    for (int j = 0; j < job.counts.height; ++j) {
        for (std::size_t i = 0; i < width; ++i, ++count) {
            common.bits[i] += job.counts.counts[count];
            total += job.counts.counts[count];
        }
    }
    // a sum has been read when the node behind it takes its place
    walk_nodes(common.bits, total, job.floor, [&common](int k, double node) {
        if (k > 0) {
            common.bits[static_cast<std::size_t>(k) - 1] = std::bit_cast<std::uint64_t>(node);
        }
    });
}

/// Share λ of the common function with which rows first to last − 1, and the one behind them, keep
/// the shear limit: see `build_options::shear`.
///
/// Between the centres of two rows X_y = rows · (F₁ − F₀), and X_x lies between the two slopes; in
/// a cell the first is linear in x and the second constant. So the limit holds everywhere if it
/// does with the larger difference at the cell's ends and the smaller slope. Mixing multiplies the
/// difference D by 1 − λ and makes the slope m (1 − λ) m + λ m̄, which gives the smallest λ as
/// (D − s m) / (D − s m + s m̄).
/// @param memory (box_sums<Passes>::memory + 1) · width numbers
template <int Passes>
void measure_band(const axis_job& job, int first, int last, double shear,
                  const common_nodes& common, std::span<std::uint64_t> memory,
                  band_result& result) {
    const auto width = static_cast<std::size_t>(job.counts.width);
    const std::span<std::uint64_t> kept = memory.first(width);
    box_sums<Passes> window(job.counts, job.radius, job.shift, first, memory.subspan(width));
    const double slope = shear * double(width);
    const double rows = double(job.counts.height);
    const auto remember = [&kept](int k, double node) {
        if (k > 0) {
            kept[static_cast<std::size_t>(k) - 1] = std::bit_cast<std::uint64_t>(node);
        }
    };
    walk_nodes(window.sums(), window.total(), job.floor, remember);
    const int end = last < job.counts.height ? last : job.counts.height - 1;
    while (window.row() < end) {
        window.advance();
        double before0 = 0.0; // node k − 1 of the row before
        double before1 = 0.0; // and of this one
        walk_nodes(window.sums(), window.total(), job.floor, [&](int k, double node) {
            if (k == 0) {
                return;
            }
            const double old = std::bit_cast<double>(kept[static_cast<std::size_t>(k) - 1]);
            const double d0 = std::abs(before1 - before0);
            const double d1 = std::abs(node - old);
            const double step0 = old - before0;
            const double step1 = node - before1;
            const double least = slope * (step0 < step1 ? step0 : step1);
            const double over = rows * (d0 > d1 ? d0 : d1) - least;
            if (over > 0.0) {
                const double relief = slope * (common.node(k) - common.node(k - 1));
                const double mix = over / (over + relief);
                result.mix = mix > result.mix ? mix : result.mix;
            }
            before0 = old;
            before1 = node;
            remember(k, node);
        });
    }
}

/// Writes the functions of rows first to last − 1.
///
/// @param mix    share of the common function in each
/// @param memory box_sums<Passes>::memory · width numbers
template <int Passes, typename Node>
void write_band(const axis_job& job, int first, int last, double mix, const common_nodes& common,
                std::span<std::uint64_t> memory, std::span<Node> nodes, band_result& result) {
    const std::size_t stride = static_cast<std::size_t>(job.counts.width) + 1;
    box_sums<Passes> window(job.counts, job.radius, job.shift, first, memory);
    for (int row = first; row < last; ++row) {
        const std::span<Node> out = nodes.subspan(static_cast<std::size_t>(row) * stride, stride);
        result.empty_rows += window.total() == 0 ? 1 : 0;
        if (mix > 0.0) {
            walk_nodes(window.sums(), window.total(), job.floor, [&](int k, double node) {
                out[static_cast<std::size_t>(k)] =
                    stored_node<Node>((1.0 - mix) * node + mix * common.node(k));
            });
        } else {
            write_nodes(window.sums(), window.total(), job.floor, out);
        }
        if (row + 1 < last) {
            window.advance();
        }
    }
    result.samples = samples_in(job.counts, first, last);
}

/// Writes the functions of rows first to last − 1 as floats, a vector at a time.
///
/// @param memory width numbers, of which half is used
///
/// If a window's sum is 2³¹ or more the result is `too_large` and part of the rows is not written.
inline void write_band_fast(const axis_job& job, int first, int last,
                            std::span<std::uint64_t> memory, std::span<float> nodes,
                            band_result& result) {
    const int height = job.counts.height;
    const auto width = static_cast<std::size_t>(job.counts.width);
    const std::span<const std::uint32_t> counts = job.counts.counts;
    const auto row_of = [counts, width](int y) {
        return counts.data() + static_cast<std::size_t>(y) * width;
    };
    // two counts in the place of one sum; the memory belongs to this band alone
    std::uint32_t* const sums = reinterpret_cast<std::uint32_t*>(memory.data());
    std::memset(sums, 0, width * sizeof(std::uint32_t));
    std::uint64_t total = 0;
    const auto account = [&](int y, std::uint64_t added) {
        result.samples += y >= first && y < last ? added : 0;
    };
    const int begin = first > job.radius ? first - job.radius : 0;
    const int end = job.radius < height - 1 - first ? first + job.radius : height - 1;
    row_step step{nullptr, nullptr, 0.0, 0.0, nullptr};
    for (int y = begin; y <= end; ++y) {
        step.in = row_of(y);
        const std::uint64_t added = step_row<false, true, false>(sums, width, step).added;
        account(y, added);
        total += added;
    }
    for (int row = first;; ++row) {
        if (total >= (std::uint64_t(1) << 31)) {
            result.too_large = true;
            return;
        }
        const bool empty = total == 0;
        result.empty_rows += empty ? 1 : 0;
        step.a = empty ? 0.0 : (1.0 - job.floor) / double(total);
        step.b = (empty ? 1.0 : job.floor) / double(width);
        step.nodes = nodes.data() + static_cast<std::size_t>(row) * (width + 1);
        const bool more = row + 1 < last;
        const bool remove = more && job.radius <= row;
        const bool add = more && job.radius < height - 1 - row;
        step.out = remove ? row_of(row - job.radius) : nullptr;
        step.in = add ? row_of(row + 1 + job.radius) : nullptr;
        const moved_row moved = add ? (remove ? step_row<true, true, true>(sums, width, step)
                                              : step_row<true, true, false>(sums, width, step))
                                    : (remove ? step_row<true, false, true>(sums, width, step)
                                              : step_row<true, false, false>(sums, width, step));
        if (!more) {
            return;
        }
        if (add) {
            account(row + 1 + job.radius, moved.added);
        }
        if (total + moved.added < (std::uint64_t(1) << 32)) {
            total = moved.total;
        } else {
            total += moved.added;
            for (std::size_t i = 0; remove && i < width; ++i) {
                total -= step.out[i];
            }
        }
    }
}

} // namespace warpshadow::detail
