// Rectangles around at most 64 points, one for each of as many directions, in lanes.
#pragma once

#include <warpshadow/detail/lanes.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace warpshadow::detail {

/// A few finite points in arrays of their own.
struct few_points {
    static constexpr std::size_t capacity = 64;
    static constexpr std::size_t padding = 8; // the widest lanes
    static constexpr std::size_t padded = capacity + padding;

    std::array<double, padded> x, y;
    std::size_t size;

    /// Fills up the last lanes with copies of the first point.
    void pad() {
        for (std::size_t i = size; i < size + padding; ++i) {
            x[i] = x[0];
            y[i] = y[0];
        }
    }
};

/// For each of a few points a direction, and the rectangle along it around all points.
struct few_rectangles {
    using values = std::array<double, few_points::padded>;
    values x, y;           // the direction, of any length
    values inverse_square; // 1 / length²
    values reach[4];       // how far the points reach from this one along the direction, to its
                           // left, backwards and to its right, as products with the direction
    values area;           // the largest double where the direction has no length
};

/// A mean of the padded values, which lies strictly between the smallest and the largest.
inline double mean(const few_points& points, const std::array<double, few_points::padded>& values) {
    double sums[4] = {0.0, 0.0, 0.0, 0.0}; // four, so that additions need not wait for each other
    const std::size_t count = (points.size + 3) / 4 * 4;
    for (std::size_t i = 0; i < count; i += 4) {
        for (std::size_t k = 0; k < 4; ++k) {
            sums[k] += values[i + k];
        }
    }
    return ((sums[0] + sums[1]) + (sums[2] + sums[3])) * (1.0 / static_cast<double>(count));
}

/// As each point's direction takes the one to the point that lies most clockwise of all.
///
/// For a vertex of the hull that is the hull's next edge. For any other point it is some direction.
/// So neither a hull nor a sort is needed and no point needs a test. O(n²), but in lanes.
template <typename L> void find_edges(const few_points& points, few_rectangles& out) {
    const double mean_x = mean(points, points.x);
    const double mean_y = mean(points, points.y);
    for (std::size_t first = 0; first < points.size; first += sizeof(L) / sizeof(double)) {
        L pivot_x, pivot_y;
        load(pivot_x, &points.x[first]);
        load(pivot_y, &points.y[first]);
        const auto turn = [](const L& dx, const L& dy, L& x, L& y) {
            const auto clockwise = x * dy < y * dx;
            x = clockwise ? dx : x;
            y = clockwise ? dy : y;
        };
        // Towards the inside: every edge of the hull lies clockwise of this. Two candidates take
        // turns, so that one need not wait for the other.
        L ax = mean_x - pivot_x;
        L ay = mean_y - pivot_y;
        L bx = ax;
        L by = ay;
        for (std::size_t i = 0; i < points.size; i += 2) {
            turn(points.x[i] - pivot_x, points.y[i] - pivot_y, ax, ay);
            turn(points.x[i + 1] - pivot_x, points.y[i + 1] - pivot_y, bx, by);
        }
        turn(bx, by, ax, ay);
        store(&out.x[first], ax);
        store(&out.y[first], ay);
    }
}

/// Measures the rectangle along each direction around all points, and returns the smallest area.
template <typename L> double measure(const few_points& points, few_rectangles& out) {
    const L zero = L{};
    const L one = zero + 1.0;
    const L none = zero + std::numeric_limits<double>::max();
    L smallest = none;
    for (std::size_t first = 0; first < points.size; first += sizeof(L) / sizeof(double)) {
        L pivot_x, pivot_y, x, y;
        load(pivot_x, &points.x[first]);
        load(pivot_y, &points.y[first]);
        load(x, &out.x[first]);
        load(y, &out.y[first]);
        L back = zero;
        L ahead = zero;
        L right = zero;
        L left = zero;
        for (std::size_t i = 0; i < points.size; ++i) {
            const L dx = points.x[i] - pivot_x;
            const L dy = points.y[i] - pivot_y;
            const L u = x * dx + y * dy;
            const L v = x * dy - y * dx;
            back = u < back ? u : back;
            ahead = u > ahead ? u : ahead;
            right = v < right ? v : right;
            left = v > left ? v : left;
        }
        const L squared = x * x + y * y;
        const auto directed = squared > zero + 0x1p-1000; // its inverse is finite
        const L inverse_square = one / (directed ? squared : one);
        // `right` counts twice: a point inside must not tie with an edge parallel to its direction.
        const L area = directed ? (ahead - back) * (left - 2.0 * right) * inverse_square : none;
        smallest = area < smallest ? area : smallest;
        store(&out.inverse_square[first], inverse_square);
        store(&out.reach[0][first], ahead);
        store(&out.reach[1][first], left);
        store(&out.reach[2][first], L(-back));
        store(&out.reach[3][first], L(-right));
        store(&out.area[first], area);
    }
    constexpr std::size_t width = sizeof(L) / sizeof(double);
    std::array<double, width> per_lane;
    store(per_lane.data(), smallest);
    for (std::size_t half = width / 2; half != 0; half /= 2) {
        for (std::size_t k = 0; k < half; ++k) {
            per_lane[k] = std::min(per_lane[k], per_lane[k + half]);
        }
    }
    return per_lane[0];
}

/// Which areas are within a limit: bit i for point i, and none beyond.
template <typename L>
std::uint64_t within(const few_rectangles& rectangles, std::size_t size, double limit) {
    constexpr std::size_t width = sizeof(L) / sizeof(double);
    std::uint64_t result = 0;
    for (std::size_t first = 0; first < size; first += width) {
        for (std::size_t k = 0; k < width; ++k) { // no end to mispredict
            result |= std::uint64_t{rectangles.area[first + k] <= limit} << (first + k);
        }
    }
    return result & (~std::uint64_t{0} >> (few_points::capacity - size));
}

} // namespace warpshadow::detail
