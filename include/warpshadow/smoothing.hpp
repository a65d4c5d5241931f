// Smoothing across the functions of a warp: rows share their samples with their neighbours.
//
// Milet et al. 2015 (§3.1) average the functions of neighbouring rows, weighted by the number of
// view samples N(y) of each row. With g_y the prefix sum of row y, a function is F_y = g_y / N(y),
// so
//
//     Σ N(y) F_y(x) / Σ N(y)  =  Σ g_y(x) / Σ N(y)
//
// which is the prefix sum of the *summed counts*. Hence the counts are smoothed, in integers, and
// scanned once: exact, without drift, monotone, and a row without samples needs no special case.
#pragma once

#include <warpshadow/importance.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace warpshadow {

/// Half-width r of a smoothing window of 2r + 1 rows that covers a share of all rows.
///
/// @param share width of the window as a share of `rows`; clamped to [0, 2], 0 for NaN
/// @param rows  number of rows, positive
/// @return      r in [0, rows]; r = rows − 1 and above make all functions equal
template <typename T> int window_radius(T share, int rows) {
    T clamped = share > T(0) ? (share < T(2) ? share : T(2)) : T(0);
    // in double, which holds every number of rows: float could round it up and exceed `rows`
    return int(0.5 * double(clamped) * double(rows));
}

/// How the rows of a window are weighted.
///
/// A tent is a box applied twice, the bell of a Gaussian a box applied three times, each cut at the
/// map's border. So the same radius makes a tent twice and a Gaussian three times as wide as a box,
/// √2 and √3 times in standard deviation, and every shape ends, when its box covers all rows, at
/// the one function that all rows share.
enum class window_shape {
    box,     ///< all rows alike
    tent,    ///< falling off linearly
    gaussian ///< falling off like a bell
};

/// How often a box is applied for a shape.
constexpr int box_passes(window_shape shape) {
    return shape == window_shape::box ? 1 : shape == window_shape::tent ? 2 : 3;
}

/// Half-width of the box whose repetition has a given standard deviation, the nearest there is.
///
/// A box of 2r + 1 rows has the variance r (r + 1) / 3.
/// @param deviation standard deviation in rows; negative numbers and NaN count as 0
/// @param shape     window
/// @return          r, at most 2³⁰
template <typename T> int radius_for_deviation(T deviation, window_shape shape) {
    const double d = deviation > T(0) ? double(deviation) : 0.0;
    // the root of r (r + 1) = 3 d² / passes, without cancellation for small d
    const double product = 3.0 * d * d / double(box_passes(shape));
    const double r = 2.0 * product / (1.0 + std::sqrt(1.0 + 4.0 * product));
    return r < 1073741824.0 ? static_cast<int>(std::floor(r + 0.5)) : 1073741824;
}

/// Power of two that the counts are divided by so that sums over windows fit.
///
/// A row's window weighs a row by (2r + 1)^(p−1) at most, p the number of passes. The exponent is 0
/// while samples · min(2r + 1, rows)^(p−1) < 2^bits: with 63 bits always for a box, and for 2²⁸
/// samples and 4096 rows with any window.
/// @param samples sum of all counts
/// @param radius  half-width of the box in rows, not negative
/// @param rows    number of rows, positive
/// @param shape   window
/// @param bits    of the sums, 1 to 63
inline int window_shift(std::uint64_t samples, int radius, int rows, window_shape shape,
                        int bits = 63) {
    const std::uint64_t widest =
        static_cast<std::uint64_t>(radius < rows / 2 ? 2 * radius + 1 : rows);
    std::uint64_t most = std::uint64_t(1) << bits;
    for (int pass = 1; pass < box_passes(shape); ++pass) {
        most /= widest;
    }
    int shift = 0;
    while (samples >> shift >= most) {
        ++shift;
    }
    return shift;
}

/// Sums over a window that is a box applied `Passes` times, moved down one row at a time.
///
/// Each pass is the difference of two places of the pass before it, which are moved along: no map
/// in between is stored, and nothing drifts. Rows beyond the map's border do not exist, for any
/// pass.
/// @tparam Passes 1 to 3, see `window_shape`
template <int Passes> class box_sums {
  public:
    /// Memory, in multiples of the map's width.
    static constexpr std::size_t memory = 2 * box_sums<Passes - 1>::memory + 1;

    /// Starts at a row.
    ///
    /// @param map    counts; `fits(map)`
    /// @param radius half-width of each box in rows, not negative
    /// @param shift  counts are divided by this power of two, see `window_shift`
    /// @param first  row to start at, 0 ≤ first < height
    /// @param sums   `memory` · `map.width` numbers, kept by the caller while the window lives
    box_sums(const count_view& map, int radius, int shift, int first, std::span<std::uint64_t> sums)
        : sums_(sums.first(static_cast<std::size_t>(map.width))),
          lead_(map, radius, shift, first > radius ? first - radius : 0,
                sums.subspan(sums_.size(), box_sums<Passes - 1>::memory * sums_.size())),
          trail_(map, radius, shift, lead_.row(),
                 sums.subspan((1 + box_sums<Passes - 1>::memory) * sums_.size())),
          height_(map.height), radius_(radius), row_(first) {
        for (std::uint64_t& sum : sums_) {
            sum = 0;
        }
        add();
        while (lead_.row() < height_ - 1 && lead_.row() - first < radius) {
            lead_.advance();
            add();
        }
    }

    /// Moves to the next row; the present row is not the last one.
    void advance() {
        if (radius_ <= row_) {
            const std::span<const std::uint64_t> old = trail_.sums();
            for (std::size_t i = 0; i < sums_.size(); ++i) {
                sums_[i] -= old[i];
            }
            total_ -= trail_.total();
            trail_.advance();
        }
        ++row_;
        if (radius_ < height_ - row_) {
            lead_.advance();
            add();
        }
    }

    /// The row whose window is summed.
    [[nodiscard]] int row() const { return row_; }
    /// Sums of the window, one per cell of a row.
    [[nodiscard]] std::span<const std::uint64_t> sums() const { return sums_; }
    /// Sum of the sums.
    [[nodiscard]] std::uint64_t total() const { return total_; }

  private:
    void add() {
        const std::span<const std::uint64_t> next = lead_.sums();
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            sums_[i] += next[i];
        }
        total_ += lead_.total();
    }

    std::span<std::uint64_t> sums_;
    box_sums<Passes - 1> lead_;
    box_sums<Passes - 1> trail_;
    int height_;
    int radius_;
    int row_;
    std::uint64_t total_ = 0;
};

/// One pass: the window of row y is rows y − radius to y + radius, read from the map.
template <> class box_sums<1> {
  public:
    static constexpr std::size_t memory = 1;

    box_sums(const count_view& map, int radius, int shift, int first, std::span<std::uint64_t> sums)
        : map_(map), sums_(sums.first(static_cast<std::size_t>(map.width))), radius_(radius),
          shift_(shift), row_(first) {
        for (std::uint64_t& sum : sums_) {
            sum = 0;
        }
        // written without `first + radius`, which may overflow for a huge radius
        const int last = radius < map.height - 1 - first ? first + radius : map.height - 1;
        for (int y = first > radius ? first - radius : 0; y <= last; ++y) {
            add(y);
        }
    }

    void advance() {
        if (radius_ <= row_) {
            remove(row_ - radius_);
        }
        ++row_;
        if (radius_ < map_.height - row_) {
            add(row_ + radius_);
        }
    }

    [[nodiscard]] int row() const { return row_; }
    [[nodiscard]] std::span<const std::uint64_t> sums() const { return sums_; }
    [[nodiscard]] std::uint64_t total() const { return total_; }

  private:
    void add(int y) {
        const std::size_t first = static_cast<std::size_t>(y) * sums_.size();
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            const std::uint32_t count = map_.counts[first + i] >> shift_;
            sums_[i] += count;
            total_ += count;
        }
    }

    void remove(int y) {
        const std::size_t first = static_cast<std::size_t>(y) * sums_.size();
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            const std::uint32_t count = map_.counts[first + i] >> shift_;
            sums_[i] -= count;
            total_ -= count;
        }
    }

    count_view map_;
    std::span<std::uint64_t> sums_;
    int radius_;
    int shift_;
    int row_;
    std::uint64_t total_ = 0;
};

/// Sums of the counts over a window of rows, moved down one row at a time.
///
/// The window of row y is rows y − radius to y + radius, cut at the map's border. Sums are exact
/// 64-bit integers: nothing drifts, however many rows were added and removed.
class row_window {
  public:
    /// Starts at row 0.
    ///
    /// @param map    counts; `fits(map)`
    /// @param radius half-width in rows; negative values count as 0
    /// @param sums   memory for `map.width` sums, kept by the caller while the window lives
    row_window(const count_view& map, int radius, std::span<std::uint64_t> sums)
        : box_(map, radius < 0 ? 0 : radius, 0, 0, sums) {}

    /// Moves to the next row.
    ///
    /// The present row is not the last one.
    void advance() { box_.advance(); }

    /// The row whose window is summed.
    [[nodiscard]] int row() const { return box_.row(); }

    /// Sums of the window, one per cell of a row.
    [[nodiscard]] std::span<const std::uint64_t> sums() const { return box_.sums(); }

    /// Number of samples in the window.
    [[nodiscard]] std::uint64_t total() const { return box_.total(); }

  private:
    box_sums<1> box_;
};

} // namespace warpshadow
