// Importance of the light's map: how many view samples fall into each of its cells.
#pragma once

#include <warpshadow/status.hpp>

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// View-sample counts over map space, in memory of the caller.
///
/// Cell (i, j) covers [i/width, (i+1)/width] × [j/height, (j+1)/height] of the unit square and
/// stands at `counts[j * width + i]`.
struct count_map {
    std::span<std::uint32_t> counts; ///< at least width · height counters
    int width = 0;                   ///< cells along u
    int height = 0;                  ///< cells along v
};

/// The same, for reading.
struct count_view {
    std::span<const std::uint32_t> counts; ///< at least width · height counters
    int width = 0;                         ///< cells along u
    int height = 0;                        ///< cells along v

    constexpr count_view() = default;
    constexpr count_view(std::span<const std::uint32_t> c, int w, int h)
        : counts(c), width(w), height(h) {}
    // A map is its own view; the implicit conversion is the point.
    constexpr count_view(const count_map& map) // NOLINT(google-explicit-constructor)
        : counts(map.counts), width(map.width), height(map.height) {}
};

/// Whether the sizes are positive and the memory holds them.
constexpr bool fits(const count_view& map) {
    return map.width > 0 && map.height > 0 &&
           map.counts.size() >=
               static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
}

/// What a splat counted.
struct splat_result {
    std::uint64_t counted = 0;  ///< samples inside the unit square, full counters included
    std::uint64_t rejected = 0; ///< samples outside the unit square, or with a NaN
    status flags = status::ok;  ///< samples_rejected, count_overflow, buffer_too_small
};

/// Index of the cell that holds x, or −1 for x outside [0, 1] and for NaN.
///
/// Cells are closed on the left; x = 1 belongs to the last cell.
/// @param x     coordinate in map space
/// @param cells number of cells, positive
template <typename T> int cell_of(T x, int cells) {
    if (x >= T(0) && x <= T(1)) {
        int cell = int(x * T(cells));
        // x just below 1 may round up to `cells`, as x = 1 does
        return cell < cells ? cell : cells - 1;
    }
    return -1;
}

/// Adds one to the counter of a cell; a counter at its largest value stays there.
///
/// @param map  counts; `fits(map)`
/// @param cell index into `map.counts`
/// @return     count_overflow if the counter was full, else ok
inline status count_sample(const count_map& map, std::size_t cell) {
    std::uint32_t& counter = map.counts[cell];
    if (counter == std::numeric_limits<std::uint32_t>::max()) {
        return status::count_overflow;
    }
    ++counter;
    return status::ok;
}

/// Sets all counters to zero.
///
/// @param map counts; nothing happens unless `fits(map)`
inline void clear(const count_map& map) {
    if (!fits(map)) {
        return;
    }
    const std::size_t size =
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    for (std::size_t i = 0; i < size; ++i) {
        map.counts[i] = 0;
    }
}

/// Counts view samples in the cells of a map (Milet et al. 2015, §3, step 2).
///
/// The counts are added to what the map holds, so several views may share one map. Count only
/// the samples that face the light: the others are dark whatever the map says.
/// @param samples positions in map space, the unit square; samples outside it and NaN are
///                rejected, and counted as such
/// @param map     counters, added to; with `fits(map)` false nothing is written and the status is
///                buffer_too_small
template <typename T>
splat_result splat(std::span<const glm::vec<2, T>> samples, const count_map& map) {
    splat_result result;
    if (!fits(map)) {
        result.rejected = samples.size();
        result.flags = status::buffer_too_small;
        return result;
    }
    for (const glm::vec<2, T>& p : samples) {
        const int i = cell_of(p.x, map.width);
        const int j = cell_of(p.y, map.height);
        if (i < 0 || j < 0) {
            ++result.rejected;
            continue;
        }
        const auto cell = static_cast<std::size_t>(j) * static_cast<std::size_t>(map.width) +
                          static_cast<std::size_t>(i);
        result.flags |= count_sample(map, cell);
        ++result.counted;
    }
    if (result.rejected != 0) {
        result.flags |= status::samples_rejected;
    }
    return result;
}

/// Concentration of the importance: cells · Σn² / (Σn)², between 1 (uniform) and the number of
/// cells (all samples in one), or 0 for an empty map.
///
/// A warp is worth its price where this is large: many samples share few cells.
/// @param map counts; 0 is returned unless `fits(map)`
inline double concentration(const count_view& map) {
    if (!fits(map)) {
        return 0.0;
    }
    const std::size_t size =
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    double sum = 0.0;
    double sum_of_squares = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
        const double n = static_cast<double>(map.counts[i]);
        sum += n;
        sum_of_squares += n * n;
    }
    return sum > 0.0 ? static_cast<double>(size) * sum_of_squares / (sum * sum) : 0.0;
}

} // namespace warpshadow
