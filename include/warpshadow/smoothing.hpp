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
        : map_(map), radius_(radius < 0 ? 0 : radius), sums_(sums) {
        for (int i = 0; i < map_.width; ++i) {
            sums_[static_cast<std::size_t>(i)] = 0;
        }
        const int last = radius_ < map_.height - 1 ? radius_ : map_.height - 1;
        for (int y = 0; y <= last; ++y) {
            add(y);
        }
    }

    /// Moves to the next row.
    ///
    /// The present row is not the last one.
    void advance() {
        // written without `row_ + radius_`, which may overflow for a huge radius
        if (radius_ <= row_) {
            remove(row_ - radius_);
        }
        ++row_;
        if (radius_ < map_.height - row_) {
            add(row_ + radius_);
        }
    }

    /// The row whose window is summed.
    [[nodiscard]] int row() const { return row_; }

    /// Sums of the window, one per cell of a row.
    [[nodiscard]] std::span<const std::uint64_t> sums() const {
        return sums_.first(static_cast<std::size_t>(map_.width));
    }

    /// Number of samples in the window.
    [[nodiscard]] std::uint64_t total() const { return total_; }

  private:
    void add(int y) {
        const std::size_t first =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(map_.width);
        for (std::size_t i = 0; i < static_cast<std::size_t>(map_.width); ++i) {
            sums_[i] += map_.counts[first + i];
            total_ += map_.counts[first + i];
        }
    }

    void remove(int y) {
        const std::size_t first =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(map_.width);
        for (std::size_t i = 0; i < static_cast<std::size_t>(map_.width); ++i) {
            sums_[i] -= map_.counts[first + i];
            total_ -= map_.counts[first + i];
        }
    }

    count_view map_;
    int radius_ = 0;
    std::span<std::uint64_t> sums_;
    int row_ = 0;
    std::uint64_t total_ = 0;
};

} // namespace warpshadow
