// Smallest rectangle around points in the plane, and the rectangle along a given axis.
#pragma once

#include <warpshadow/detail/few_points.hpp>
#include <warpshadow/detail/lanes.hpp>
#include <warpshadow/detail/power_of_two.hpp>
#include <warpshadow/detail/scaled_points.hpp>
#include <warpshadow/hull.hpp>
#include <warpshadow/status.hpp>

#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// `oriented_rectangle::edge` where no edge was looked for or none has a length.
inline constexpr std::uint32_t no_edge = 0xffffffffu;

/// A rectangle at any angle: the points centre ± half_extents.x · axis ± half_extents.y · (-axis.y,
/// axis.x).
template <typename T> struct oriented_rectangle {
    glm::vec<2, T> centre;
    glm::vec<2, T> axis;         ///< unit length, within 45° of +x: axis.x > 0, |axis.y| <= axis.x
    glm::vec<2, T> half_extents; ///< along the axis and across it
    double area;                 ///< of the unrounded rectangle; double, since float's range ends
                                 ///< at the square of 1e19
    std::uint32_t edge;          ///< index of a point at which the edge that lies on a side starts
    status flags;
};

namespace detail {

/// The largest finite T where x is beyond it.
template <typename T> T clamp_to_finite(double x, status& flags) {
    constexpr double largest = double(std::numeric_limits<T>::max());
    if (std::abs(x) > largest) {
        flags |= status::out_of_range;
        return static_cast<T>(std::copysign(largest, x));
    }
    return static_cast<T>(x);
}

/// What there is to say about no points at all.
template <typename T> oriented_rectangle<T> no_rectangle(status flags) {
    oriented_rectangle<T> result{};
    result.axis = {T(1), T(0)};
    result.edge = no_edge;
    result.flags = flags | status::empty_body;
    return result;
}

/// The rectangle with these extents from an origin, along a unit axis and across it, all scaled.
/// Precondition: the axis is the one nearest to +x.
template <typename T>
inline oriented_rectangle<T> unscaled(const scaled_points<T>& points, const glm::dvec2& origin,
                                      const glm::dvec2& axis, const glm::dvec2& lo,
                                      const glm::dvec2& hi) {
    oriented_rectangle<T> result{};
    result.flags = points.all_finite ? status::ok : status::invalid_input;
    glm::dvec2 half = 0.5 * (hi - lo);
    // Below this, a width is rounding error of the length.
    const double least = 0x1p-50 * std::max(half.x, half.y);
    for (glm::length_t k = 0; k < 2; ++k) {
        if (half[k] <= least) {
            half[k] = 0.0;
            result.flags |= status::degenerate_extent;
        }
    }
    const glm::dvec2 middle = 0.5 * (lo + hi);
    const double unit = power_of_two(points.exponent);
    const auto stored = [&](double x) { return clamp_to_finite<T>(x * unit, result.flags); };
    result.centre = {stored(origin.x + (axis.x * middle.x - axis.y * middle.y)),
                     stored(origin.y + (axis.y * middle.x + axis.x * middle.y))};
    result.axis = glm::vec<2, T>(axis);
    result.half_extents = {stored(half.x), stored(half.y)};
    result.area = clamp_to_finite<double>(4.0 * (half.x * unit) * (half.y * unit), result.flags);
    result.edge = no_edge;
    return result;
}

/// The rectangle, with a side along a direction, around all points that are finite.
template <typename T>
oriented_rectangle<T> rectangle_along(const scaled_points<T>& points, const glm::dvec2& direction) {
    std::size_t first = 0;
    while (first < points.size() && points.left_out(first)) {
        ++first;
    }
    if (first == points.size()) {
        return no_rectangle<T>(points.all_finite ? status::ok : status::invalid_input);
    }
    const glm::dvec2 axis = nearest_to_x(direction) / std::sqrt(dot(direction, direction));
    const glm::dvec2 origin = points[first];
    glm::dvec2 lo(0.0);
    glm::dvec2 hi(0.0);
    for (std::size_t i = first + 1; i < points.size(); ++i) {
        if (!points.left_out(i)) {
            const glm::dvec2 p = points[i] - origin;
            const glm::dvec2 q(dot(axis, p), cross(axis, p));
            lo = {std::min(lo.x, q.x), std::min(lo.y, q.y)};
            hi = {std::max(hi.x, q.x), std::max(hi.y, q.y)};
        }
    }
    return unscaled(points, origin, axis, lo, hi);
}

/// Areas and slopes that differ by less than this are taken to be equal: the rounding of the
/// coordinates to T must not choose between the sides of a square or an octagon.
template <typename T>
constexpr double tie_tolerance = 4.0 * double(std::numeric_limits<T>::epsilon());

/// Of sides with equal areas, the one whose slope is nearest to 0; of two slopes that differ in
/// sign alone, the positive one; then the first that was offered.
template <typename T> class side_choice {
  public:
    /// Precondition: the direction of the side is the one nearest to +x.
    void offer(std::size_t edge, const glm::dvec2& side) {
        // Slopes y / x are compared as products.
        const double slack = tie_tolerance<T> * (side.x * best_.x);
        const double excess = std::abs(side.y) * best_.x - std::abs(best_.y) * side.x;
        const bool same_angle = std::abs(excess) <= slack;
        const bool positive = side.y * best_.x > best_.y * side.x + slack;
        if (edge_ == no_edge || (same_angle ? positive : excess < 0.0)) {
            edge_ = static_cast<std::uint32_t>(edge);
            best_ = side;
        }
    }
    std::uint32_t edge() const { return edge_; } // no_edge if none was offered
    const glm::dvec2& direction() const { return best_; }

  private:
    std::uint32_t edge_ = no_edge;
    glm::dvec2 best_{1.0, 0.0};
};

/// Rotating calipers (Shamos 1978, Toussaint 1983): offers each edge of a convex counter-clockwise
/// polygon with the area of the rectangle that lies on it.
template <typename Points, typename Visit> void for_each_edge(const Points& hull, Visit visit) {
    const std::size_t size = hull.size();
    const auto at = [&](std::size_t i) {
        return hull[i < size ? i : i < 2 * size ? i - size : i - 2 * size];
    };
    std::size_t right = 1;
    std::size_t top = 1;
    std::size_t left = 1;
    for (std::size_t i = 0; i < size; ++i) {
        const glm::dvec2 start = at(i);
        const glm::dvec2 direction = at(i + 1) - start;
        // The bounds end the search on a polygon that is not convex.
        while (right < i + size && dot(direction, at(right + 1) - at(right)) > 0.0) {
            ++right;
        }
        top = std::max(top, right);
        while (top < i + size && cross(direction, at(top + 1) - at(top)) > 0.0) {
            ++top;
        }
        left = std::max(left, top);
        while (left < i + size && dot(direction, at(left + 1) - at(left)) < 0.0) {
            ++left;
        }
        const double squared = dot(direction, direction);
        if (squared > 0.0) {
            visit(i, direction,
                  dot(direction, at(right) - at(left)) * cross(direction, at(top) - start) /
                      squared);
        }
    }
}

/// The smallest rectangle around a convex counter-clockwise polygon of many vertices.
template <typename T> oriented_rectangle<T> smallest_by_calipers(const scaled_points<T>& hull) {
    double smallest = std::numeric_limits<double>::max();
    side_choice<T> first_choice;
    for_each_edge(hull, [&](std::size_t edge, const glm::dvec2& direction, double area) {
        if (area < smallest) {
            smallest = area;
            first_choice = {};
            first_choice.offer(edge, nearest_to_x(direction));
        }
    });
    const double limit = smallest * (1.0 + tie_tolerance<T>);
    side_choice<T> choice;
    for_each_edge(hull, [&](std::size_t edge, const glm::dvec2& direction, double area) {
        if (area <= limit) {
            choice.offer(edge, nearest_to_x(direction));
        }
    });
    // A compiler may round an area another way the second time: then there may be no candidate.
    choice = choice.edge() == no_edge ? first_choice : choice;
    oriented_rectangle<T> result = rectangle_along(hull, choice.direction());
    result.edge = choice.edge();
    return result;
}

/// Copies the points that are finite; there must be at most `few_points::capacity` in all.
template <typename T> void copy_finite(const scaled_points<T>& points, few_points& few) {
    std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec2 p = points[i];
        few.x[i] = p.x;
        few.y[i] = p.y;
        few.number[i] = static_cast<std::uint32_t>(i);
    }
    if (!points.all_finite) {
        count = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!points.left_out(i)) {
                few.x[count] = few.x[i];
                few.y[count] = few.y[i];
                few.number[count++] = static_cast<std::uint32_t>(i);
            }
        }
    }
    few.size = count;
    few.pad();
}

/// The smallest of a few rectangles that are measured already.
template <typename T>
oriented_rectangle<T> smallest_of(const scaled_points<T>& points, const few_points& few,
                                  const few_rectangles& rectangles, double smallest) {
    if (!(smallest < std::numeric_limits<double>::max())) {
        return rectangle_along(points, {1.0, 0.0}); // one distinct point, or none
    }
    const double limit = smallest * (1.0 + tie_tolerance<T>);
    std::uint64_t tied = within<lanes<native_lanes>>(rectangles, few.size, limit);
    auto edge = static_cast<std::size_t>(std::countr_zero(tied));
    if (!std::has_single_bit(tied)) {
        side_choice<T> choice;
        for (; tied != 0; tied &= tied - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(tied));
            choice.offer(i, nearest_to_x({rectangles.x[i], rectangles.y[i]}));
        }
        edge = choice.edge();
    }
    const glm::dvec2 direction(rectangles.x[edge], rectangles.y[edge]);
    const double unit = std::sqrt(rectangles.inverse_square[edge]);
    const std::size_t turns = turns_towards_x(direction);
    const auto reach = [&](std::size_t side) { // turned as well
        return unit * rectangles.reach[(side + 4 - turns) % 4][edge];
    };
    oriented_rectangle<T> result =
        unscaled(points, {few.x[edge], few.y[edge]}, unit * turned(direction, turns),
                 {-reach(2), -reach(3)}, {reach(0), reach(1)});
    result.edge = few.number[edge];
    return result;
}

/// With more points, dropping those inside saves more than it costs (measured with 2 and 4 lanes).
inline constexpr std::size_t filter_pays = native_lanes >= 8 ? 28 : native_lanes >= 4 ? 18 : 12;

/// The smallest rectangle around a few points, without their hull.
template <typename T> oriented_rectangle<T> smallest_by_pivots(const scaled_points<T>& points) {
    using L = lanes<native_lanes>;
    few_points few;
    few_rectangles rectangles;
    copy_finite(points, few);
    if (few.size == 0) {
        return rectangle_along(points, {1.0, 0.0});
    }
    if (few.size > filter_pays) {
        drop_inside<L>(few);
    }
    const spread_points<L> all(few);
    find_edges<L>(few, all, rectangles);
    const double smallest = measure<L>(few, all, rectangles);
    return smallest_of(points, few, rectangles, smallest);
}

/// The smallest rectangle around a convex polygon of a few vertices: every edge against all.
template <typename T> oriented_rectangle<T> smallest_by_edges(const scaled_points<T>& hull) {
    using L = lanes<native_lanes>;
    few_points few;
    few_rectangles rectangles;
    copy_finite(hull, few);
    for (std::size_t i = 0; i < few.size + few_points::padding; ++i) { // the last edge closes it
        rectangles.x[i] = few.x[i + 1 < few.size ? i + 1 : 0] - few.x[i];
        rectangles.y[i] = few.y[i + 1 < few.size ? i + 1 : 0] - few.y[i];
    }
    const double smallest = measure<L>(few, spread_points<L>(few), rectangles);
    return smallest_of(hull, few, rectangles, smallest);
}

} // namespace detail

/// Smallest rectangle, with a side along `axis` or across it, that encloses the points.
///
/// @param points in any order; those with a NaN or an infinity are left out (`invalid_input`)
/// @param axis   any length; zero or not finite gives (1, 0) and `invalid_input`
/// @return       errors as for `min_area_rectangle`; `edge` is `no_edge`
template <typename T>
oriented_rectangle<T> enclosing_rectangle(std::span<const glm::vec<2, T>> points,
                                          const glm::vec<2, T>& axis) {
    const bool usable =
        std::isfinite(axis.x) && std::isfinite(axis.y) && (axis.x != T(0) || axis.y != T(0));
    glm::dvec2 direction(1.0, 0.0);
    if (usable) { // any length: its square need not fit a double
        const double largest = std::max(std::abs(double(axis.x)), std::abs(double(axis.y)));
        const double scale = detail::power_of_two(-detail::exponent_of(largest));
        direction = detail::nearest_to_x(scale * glm::dvec2(axis));
    }
    oriented_rectangle<T> result =
        detail::rectangle_along(detail::scaled_points<T>(points), direction);
    if (!usable) {
        result.flags |= status::invalid_input;
    }
    return result;
}

/// Rectangle of smallest area around a convex polygon, by rotating calipers in O(n).
///
/// Precondition: `hull` is strictly convex and counter-clockwise, as `convex_hull` leaves it. Of
/// any other polygon the result is a rectangle that encloses the points but need not be smallest.
///
/// Ties, guarantees and degenerate input as for `min_area_rectangle`; `edge` is an index into
/// `hull`, of the vertex where the edge starts.
template <typename T>
oriented_rectangle<T> min_area_rectangle_of_hull(std::span<const glm::vec<2, T>> hull) {
    const detail::scaled_points<T> points(hull);
    if (!points.all_finite || hull.size() < 2) {
        return detail::rectangle_along(points, {1.0, 0.0});
    }
    return hull.size() <= detail::few_points::capacity ? detail::smallest_by_edges(points)
                                                       : detail::smallest_by_calipers(points);
}

/// Rectangle of smallest area around any points.
///
/// One of its sides lies on an edge of the convex hull (Freeman and Shapira 1975). Small sets are
/// solved without a hull, larger ones by `convex_hull` and rotating calipers.
///
/// Of sides whose areas agree within 4 epsilon of T (relative), the one at the smallest angle to
/// ±x or ±y is taken; of two such angles that differ in sign alone, the positive one; then the
/// first. So a square or an octagon gives the same rectangle however its corners were rounded.
///
/// Computed in double and rounded once. With the diameter D of the points and u = 2^-53:
/// - every point is within 16 u D of the unrounded rectangle; rounding to T adds epsilon(T)·D
///   for axis and extents and epsilon(T)/2 of each coordinate of the centre;
/// - the area is at most that of the exact smallest rectangle times 1 + 4 epsilon(T), plus 16 u D².
///
/// One distinct point gives extents of zero, points on one line give a width of zero, as does any
/// width below 2^-50 of the length (`degenerate_extent`).
/// No point gives zeros (`empty_body`). Points with a NaN or an infinity are left out
/// (`invalid_input`). Results beyond the range of T are clamped (`out_of_range`).
/// @param points  in any order
/// @param scratch used for more than 64 points: at least as many elements as `points`, overwritten
///                (its first elements become the hull); too few give the axis-aligned rectangle
///                and `buffer_too_small`
template <typename T>
oriented_rectangle<T> min_area_rectangle(std::span<const glm::vec<2, T>> points,
                                         std::span<glm::vec<2, T>> scratch = {}) {
    const detail::scaled_points<T> scaled(points);
    if (points.size() <= detail::few_points::capacity) { // faster than hull and calipers (measured)
        return detail::smallest_by_pivots(scaled);
    }
    if (scratch.size() < points.size()) {
        oriented_rectangle<T> result = detail::rectangle_along(scaled, {1.0, 0.0});
        result.flags |= status::buffer_too_small;
        return result;
    }
    const std::span<glm::vec<2, T>> work = scratch.first(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        work[i] = points[i];
    }
    const hull_result hull = convex_hull(work);
    const std::span<const glm::vec<2, T>> vertices = work.first(hull.count);
    oriented_rectangle<T> result = min_area_rectangle_of_hull(vertices);
    result.flags |= hull.flags & status::invalid_input;
    if (result.edge != no_edge) {
        const auto start = std::find(points.begin(), points.end(), vertices[result.edge]);
        result.edge = static_cast<std::uint32_t>(start - points.begin());
    }
    return result;
}

} // namespace warpshadow
