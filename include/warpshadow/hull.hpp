// Convex hull in the plane: strictly convex, counter-clockwise, exact for every finite input.
#pragma once

#include <warpshadow/predicates.hpp>
#include <warpshadow/status.hpp>

#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace warpshadow {

/// Size of a hull and what had to be done to get it.
struct hull_result {
    std::size_t count; ///< vertices of the hull; they come first in the caller's span
    status flags;
};

namespace detail {

/// A hull item that is the point itself.
struct point_items {
    template <typename T> const glm::vec<2, T>& operator()(const glm::vec<2, T>& item) const {
        return item;
    }
    template <typename T> static bool ranks_before(const glm::vec<2, T>&, const glm::vec<2, T>&) {
        return false;
    }
};

/// A hull item that is an index into points; of equal points the lowest index ranks first.
template <typename T> struct index_items {
    std::span<const glm::vec<2, T>> points;
    const glm::vec<2, T>& operator()(std::uint32_t item) const { return points[item]; }
    static bool ranks_before(std::uint32_t a, std::uint32_t b) { return a < b; }
};

// Comparisons without branches: on points in no order a branch is mispredicted every other time.

/// Left to right, of one x bottom to top, of equal points by rank.
template <typename Items> struct ascending {
    Items at;
    template <typename Item> bool operator()(const Item& a, const Item& b) const {
        const auto& p = at(a);
        const auto& q = at(b);
        const bool lower = (p.y < q.y) | ((p.y == q.y) & Items::ranks_before(a, b));
        return (p.x < q.x) | ((p.x == q.x) & lower);
    }
};

/// Right to left, of one x top to bottom, of equal points by rank.
template <typename Items> struct descending {
    Items at;
    template <typename Item> bool operator()(const Item& a, const Item& b) const {
        const auto& p = at(a);
        const auto& q = at(b);
        const bool higher = (p.y > q.y) | ((p.y == q.y) & Items::ranks_before(a, b));
        return (p.x > q.x) | ((p.x == q.x) & higher);
    }
};

/// Sorts a few items by counting for each how many come before it.
template <typename Item, typename Before>
void sort_by_counting(std::span<Item> items, Before before) {
    std::array<Item, 12> unsorted;
    std::array<std::size_t, 12> place{};
    for (std::size_t i = 0; i < items.size(); ++i) {
        unsorted[i] = items[i];
        for (std::size_t j = 0; j < i; ++j) {
            const std::size_t sooner = before(items[i], items[j]) ? 1 : 0;
            place[j] += sooner;
            place[i] += 1 - sooner;
        }
    }
    for (std::size_t i = 0; i < items.size(); ++i) {
        items[place[i]] = unsorted[i];
    }
}

/// Quicksort down to a few items, with a partition that has no branch on the data either.
/// @param depth splits that are left before `std::sort` takes over, so that bad luck costs no more
template <typename Item, typename Before>
void sort_items(std::span<Item> items, Before before, int depth) {
    while (items.size() > 12) {
        if (depth-- == 0) {
            std::sort(items.begin(), items.end(), before);
            return;
        }
        const Item& a = items.front();
        const Item& b = items[items.size() / 2];
        const Item& c = items.back();
        const bool ab = before(a, b);
        const Item& median = ab == before(b, c) ? b : (ab == before(a, c) ? c : a);
        const Item pivot = median;
        std::size_t count = 0;
        for (Item& item : items) {
            const std::size_t step = before(item, pivot) ? 1 : 0;
            std::swap(item, items[count]);
            count += step;
        }
        sort_items(items.first(count), before, depth);
        items = items.subspan(count);
    }
    sort_by_counting(items, before);
}

/// Points of a set that lie far out in sixteen directions, and the inside of their polygon, where
/// no vertex of the hull can be (Akl and Toussaint 1978).
///
/// Any points of the set would do, and any closed polygon of them: what is strictly left of all
/// its sides is surrounded by it.
class inner_polygon {
  public:
    template <typename Item, typename Items>
    inner_polygon(std::span<const Item> items, const Items& at) {
        // Of many points, every sixteenth is far out enough.
        const std::size_t stride = std::min<std::size_t>(1 + items.size() / 256, 16);
        std::array<glm::dvec2, size> corners{};
        std::array<double, size> reached;
        reached.fill(-std::numeric_limits<double>::infinity());
        for (std::size_t i = 0; i < items.size(); i += stride) {
            const glm::dvec2 p(at(items[i]));
            if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
                continue;
            }
            const double x = 0.5 * p.x; // twice a coordinate might overflow
            const double y = 0.5 * p.y;
            const double reach[size / 2] = {x, x + 0.5 * y, x + y, 0.5 * x + y,
                                            y, y - 0.5 * x, y - x, 0.5 * y - x};
            for (std::size_t k = 0; k < size / 2; ++k) {
                if (reach[k] > reached[k]) {
                    reached[k] = reach[k];
                    corners[k] = p;
                }
                if (-reach[k] > reached[k + size / 2]) {
                    reached[k + size / 2] = -reach[k];
                    corners[k + size / 2] = p;
                }
            }
        }
        lo_ = {corners[8].x, corners[12].y};
        hi_ = {corners[0].x, corners[4].y};
        make_bands(corners);
    }

    /// Whether p is inside for certain; not for a NaN, nor if all corners are one point.
    bool contains(const glm::dvec2& p) const {
        const double place = (p.x - lo_.x) * bands_per_unit_;
        const bool between = (place > 0.0) & (p.x < hi_.x);
        const band& b = bands_[static_cast<std::size_t>(static_cast<int>(between ? place : 0.0))];
        return between & (p.y > b.lower + b.lower_slope * p.x) &
               (p.y < b.upper + b.upper_slope * p.x);
    }

  private:
    static constexpr std::size_t size = 16;
    static constexpr std::size_t bands = 16;

    /// A strip from x to x: the inside lies between two lines there.
    struct band {
        double lower, lower_slope, upper, upper_slope;
    };

    /// Divides the extent into strips. The lower sides' lines have a convex largest value: in a
    /// strip it is below its chord. So is the smallest value of the upper sides' lines above its.
    void make_bands(const std::array<glm::dvec2, size>& corners) {
        constexpr double endless = std::numeric_limits<double>::infinity();
        const double step = (hi_.x - lo_.x) / static_cast<double>(bands);
        std::array<double, bands + 1> lower;
        std::array<double, bands + 1> upper;
        lower.fill(-endless);
        upper.fill(endless);
        double steepest = 0.0;
        for (std::size_t i = 0; i < size; ++i) {
            const glm::dvec2 d = corners[(i + 1) % size] - corners[i];
            if (d.x == 0.0) {
                continue; // upright: the extent is its bound
            }
            const double slope = d.y / d.x;
            const double at_lo = corners[i].y + (lo_.x - corners[i].x) * slope;
            const double rise = step * slope;
            steepest = std::max(steepest, std::abs(slope));
            for (std::size_t k = 0; k <= bands; ++k) {
                const double y = at_lo + static_cast<double>(k) * rise;
                lower[k] = d.x > 0.0 && y > lower[k] ? y : lower[k];
                upper[k] = d.x < 0.0 && y < upper[k] ? y : upper[k];
            }
        }
        // More than all roundings, 64u (u = 2^-53), here and in `contains`: of lines, of their
        // values, and of the place of p among the strips. The last term: slopes may underflow.
        const double x = std::max(std::abs(lo_.x), std::abs(hi_.x));
        const double y = std::max(std::abs(lo_.y), std::abs(hi_.y));
        const double error = 0x1p-46 * (steepest * x + y) + 0x1p-1070 * x + 0x1p-1018;
        for (std::size_t k = 0; k < bands; ++k) {
            const double from = lo_.x + static_cast<double>(k) * step;
            band& b = bands_[k];
            b.lower_slope = (lower[k + 1] - lower[k]) / step;
            b.upper_slope = (upper[k + 1] - upper[k]) / step;
            b.lower = lower[k] - b.lower_slope * from + error;
            b.upper = upper[k] - b.upper_slope * from - error;
        }
        bands_[bands] = {endless, 0.0, -endless, 0.0}; // where a place rounds up
        const double per_unit = 1.0 / step;
        bands_per_unit_ = std::isfinite(per_unit) ? per_unit : 0.0;
    }

    std::array<band, bands + 1> bands_; // NaN in one, from an overflow, has nothing inside
    double bands_per_unit_;
    glm::dvec2 lo_, hi_;
};

/// Andrew's chain in place: items below the line from the first to the last point, sorted one way,
/// those above it the other way, then one scan around.
template <typename Item, typename Items>
std::size_t hull_in_place(std::span<Item> items, Items at) {
    const ascending<Items> before{at};
    const descending<Items> after{at};
    std::swap(items.back(), *std::min_element(items.begin(), items.end(), after));
    std::swap(items.front(), *std::min_element(items.begin(), items.end(), before));
    const Item first = items.front();
    const Item last = items.back();
    if (at(first) == at(last)) {
        return 1;
    }

    // Partition into first | below | last | above; points on the line are left behind.
    const std::size_t end = items.size() - 1;
    std::size_t below = 1;
    std::size_t above = 1;
    for (std::size_t i = 1; i < end; ++i) {
        const int side = orient2d(at(first), at(last), at(items[i]));
        if (side != 0) {
            std::swap(items[i], items[above]);
            if (side < 0) {
                std::swap(items[above], items[below++]);
            }
            ++above;
        }
    }
    std::swap(items[above], items[end]);
    std::swap(items[below], items[above]);
    const std::span<Item> chain = items.first(above + 1);
    const std::span<Item> lower = chain.subspan(1, below - 1);
    const std::span<Item> upper = chain.subspan(below + 1);
    const int depth = 2 * static_cast<int>(std::bit_width(chain.size()));
    sort_items(lower, before, depth);
    sort_items(upper, after, depth);

    std::size_t count = 1;
    for (std::size_t i = 1; i < chain.size(); ++i) {
        if (at(chain[i]) == at(chain[count - 1])) {
            continue; // a duplicate of higher rank
        }
        while (count >= 2 &&
               orient2d(at(chain[count - 2]), at(chain[count - 1]), at(chain[i])) <= 0) {
            --count;
        }
        std::swap(chain[count++], chain[i]);
    }
    while (count >= 3 && orient2d(at(chain[count - 2]), at(chain[count - 1]), at(first)) <= 0) {
        --count;
    }
    return count;
}

/// Moves what is inside and items with a NaN or an infinity to the end, then builds the hull of
/// the others.
template <typename Item, typename Items>
hull_result hull_of_finite(std::span<Item> items, Items at) {
    constexpr std::size_t many = 40; // measured: from here on the pass saves more than it costs
    if (items.size() > many) {
        const inner_polygon inside(std::span<const Item>(items), at);
        std::size_t kept = 0;
        for (Item& item : items) {
            const std::size_t step = inside.contains(glm::dvec2(at(item))) ? 0 : 1;
            std::swap(item, items[kept]); // always: no branch to mispredict
            kept += step;
        }
        items = items.first(kept);
    }
    const auto finite = std::partition(items.begin(), items.end(), [&](const Item& item) {
        return std::isfinite(at(item).x) && std::isfinite(at(item).y);
    });
    const auto size = static_cast<std::size_t>(finite - items.begin());
    const status flags = size == items.size() ? status::ok : status::invalid_input;
    if (size == 0) {
        return {0, flags | status::empty_body};
    }
    const std::size_t count = hull_in_place(items.first(size), at);
    return {count, count < 3 ? flags | status::degenerate_extent : flags};
}

} // namespace detail

/// Convex hull of points, in place: reorders the span so that the hull's vertices come first.
///
/// The hull is strictly convex (no duplicates, no three vertices on a line), runs counter-clockwise
/// and starts at the leftmost point, the lowest of those. Every decision is exact, so the vertices
/// are those of the true hull of the numbers given, at any scale and offset. The points behind the
/// hull are the rest of the input in no particular order.
///
/// One distinct point gives 1 vertex and points on one line give 2 (`degenerate_extent`); no
/// point gives 0 (`empty_body`). Points with a NaN or an infinity are left out and reported
/// (`invalid_input`). O(n log n).
template <typename T> hull_result convex_hull(std::span<glm::vec<2, T>> points) {
    return detail::hull_of_finite(points, detail::point_items{});
}

/// Convex hull as indices into points: order[0] to order[count - 1] are the hull's vertices.
///
/// The same hull as the one in place; of equal points the lowest index is taken. What else is in
/// `order` afterwards is unspecified.
/// @param[out] order at least as many elements as points; otherwise nothing is written and the
///                   status is `buffer_too_small`
template <typename T>
hull_result convex_hull(std::span<const glm::vec<2, T>> points, std::span<std::uint32_t> order) {
    if (order.size() < points.size()) {
        return {0, status::buffer_too_small};
    }
    const std::span<std::uint32_t> used = order.first(points.size());
    std::iota(used.begin(), used.end(), 0u);
    return detail::hull_of_finite(used, detail::index_items<T>{points});
}

} // namespace warpshadow
