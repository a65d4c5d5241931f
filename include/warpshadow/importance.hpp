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
    std::uint64_t counted = 0;    ///< samples inside the unit square, full counters included
    std::uint64_t rejected = 0;   ///< samples outside the unit square, or with a NaN
    status flags = status::ok;    ///< samples_rejected, count_overflow, buffer_too_small
    std::uint64_t weightless = 0; ///< of the counted ones, those of no importance
    std::uint64_t weight = 0;     ///< what the counted ones added, in steps; 0 if not weighted
};

/// What a cell makes of the importance of several samples.
enum class cell_rule {
    sum,    ///< their sum: as many samples, as much of the map (Milet)
    largest ///< the largest of them: no more for being seen twice (Rosen)
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

/// Importance of one sample in whole steps, rounded up: what is added to a counter.
///
/// Whole numbers make sums exact, and the same in any order. Rounded up, no importance vanishes.
/// @param weight importance; 0, negative numbers and NaN give 0
/// @param steps  steps in an importance of 1, positive; see `weight_steps`
/// @return       weight · steps rounded up, at most 2²⁴
template <typename T> unsigned weight_in_steps(T weight, T steps) {
    T scaled = weight * steps;
    if (!(scaled > T(0))) {
        return 0u;
    }
    if (scaled >= T(16777216)) {
        return 16777216u;
    }
    unsigned whole = unsigned(scaled);
    return T(whole) < scaled ? whole + 1u : whole;
}

/// Most steps in an importance of 1 with which no sum of all samples reaches 2³², a power of two.
///
/// The passes on a device sum in 32 bits, and `count_overflow` is then out of reach on the host.
/// @param samples number of samples
/// @param largest largest importance of a sample, positive
/// @return        between 1 and 65536; 1 as well if even that is too many
template <typename T> T weight_steps(std::uint64_t samples, T largest) {
    double steps = 65536.0;
    // a step more for each sample, which rounding up may add
    while (steps > 1.0 && !(double(samples) * (steps * double(largest) + 1.0) < 4294967296.0)) {
        steps *= 0.5;
    }
    return T(steps);
}

/// Adds to the counter of a cell; one that would pass its largest value stops there.
///
/// @param map    counts; `fits(map)`
/// @param cell   index into `map.counts`
/// @param amount what is added, or for `largest` what the counter is raised to
/// @param rule   sum or largest
/// @return       count_overflow if the counter stopped, else ok
inline status add_weight(const count_map& map, std::size_t cell, std::uint32_t amount,
                         cell_rule rule) {
    std::uint32_t& counter = map.counts[cell];
    if (rule == cell_rule::largest) {
        counter = counter < amount ? amount : counter;
        return status::ok;
    }
    if (amount > std::numeric_limits<std::uint32_t>::max() - counter) {
        counter = std::numeric_limits<std::uint32_t>::max();
        return status::count_overflow;
    }
    counter += amount;
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

namespace detail {

/// Adds the importance of one sample that is in the map.
template <typename T>
void add_sample(T weight, T steps, cell_rule rule, std::size_t cell, const count_map& map,
                splat_result& result) {
    if (!(weight >= T(0) || weight < T(0))) {
        ++result.rejected;
        return;
    }
    const std::uint32_t amount = weight_in_steps(weight, steps);
    // a sample that is too important counts as the most important there can be
    result.flags |= weight * steps > T(16777216) ? status::out_of_range : status::ok;
    result.weightless += amount == 0 ? 1 : 0;
    result.weight += amount;
    result.flags |= add_weight(map, cell, amount, rule);
    ++result.counted;
}

} // namespace detail

/// Adds up the importance of view samples in the cells of a map (Rosen 2012, §4.1).
///
/// @tparam Point      has a member `p`, its position in map space: `seen_point`, or one of yours
/// @tparam Importance called with a Point, gives its importance as a T
/// @param points     samples; those outside the unit square, and those whose position or importance
///                   is NaN, are rejected; negative importance counts as 0
/// @param importance the functor; `view_importance` of importance_functions.hpp, or one of yours
/// @param steps      steps in an importance of 1, positive; see `weight_steps`
/// @param rule       what a cell makes of several samples
/// @param map        counters, added to; nothing is written, and the status is buffer_too_small,
///                   with `fits(map)` false
/// @return           out_of_range if an importance of more than 2²⁴ steps was cut to that,
///                   count_overflow if a counter stopped at 2³² − 1
template <typename Point, typename T, typename Importance>
splat_result splat_weighted(std::span<const Point> points, const Importance& importance, T steps,
                            cell_rule rule, const count_map& map) {
    splat_result result;
    if (!fits(map)) {
        result.rejected = points.size();
        result.flags = status::buffer_too_small;
        return result;
    }
    for (const Point& point : points) {
        const int i = cell_of(point.p.x, map.width);
        const int j = cell_of(point.p.y, map.height);
        if (i < 0 || j < 0) {
            ++result.rejected;
            continue;
        }
        const auto cell = static_cast<std::size_t>(j) * static_cast<std::size_t>(map.width) +
                          static_cast<std::size_t>(i);
        detail::add_sample<T>(importance(point), steps, rule, cell, map, result);
    }
    if (result.rejected != 0) {
        result.flags |= status::samples_rejected;
    }
    return result;
}

/// A count on its way from the last frame's to this frame's, in whole numbers.
///
/// The way is shortened by share / 65536, rounded up: counts that stand still are reached after
/// finitely many frames, none is passed, and equal counts stay as they are to the bit.
/// @param previous what is shown now
/// @param current  what was counted
/// @param share    share of the way in 1/65536, 0 to 65536: 65536 takes the current count
template <typename Count> Count blended_count(Count previous, Count current, Count share) {
    Count part = share < Count(65536) ? share : Count(65536);
    Count way = current > previous ? current - previous : previous - current;
    // in two halves, so that 32 bits hold each product
    Count high = way / Count(65536);
    Count low = way - high * Count(65536);
    Count step = high * part + (low * part + Count(65535)) / Count(65536);
    return current > previous ? previous + step : previous - step;
}

/// Moves a map of importance towards the one of this frame, cell by cell (Rosen 2012, §5.5).
///
/// @param current importance of this frame
/// @param share   of the way in 1/65536, see `blended_count`; out of range is clamped
/// @param map     importance of the last frame; receives what to build with
/// @return        out_of_range; buffer_too_small, and nothing written, unless both fit their memory
///                and have the same sizes
inline status blend(const count_view& current, int share, const count_map& map) {
    if (!fits(current) || !fits(map) || current.width != map.width ||
        current.height != map.height) {
        return status::buffer_too_small;
    }
    const int clamped = share < 0 ? 0 : share > 65536 ? 65536 : share;
    const std::size_t size =
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    for (std::size_t i = 0; i < size; ++i) {
        map.counts[i] =
            blended_count(map.counts[i], current.counts[i], static_cast<std::uint32_t>(clamped));
    }
    return clamped == share ? status::ok : status::out_of_range;
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
