// Rectangles around at most 64 points, one for each of as many directions, in lanes.
#pragma once

#include <warpshadow/detail/lanes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace warpshadow::detail {

/// A few finite points in arrays of their own.
struct few_points {
    static constexpr std::size_t capacity = 64;
    static constexpr std::size_t padding = 8; // the widest lanes
    static constexpr std::size_t padded = capacity + padding;

    std::array<double, padded> x, y;
    std::array<std::uint32_t, capacity> number; // among the points that they were taken from
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

/// Index of a largest or smallest of N values, N a power of two, without a branch.
template <std::size_t N, bool Largest> std::size_t extreme_of(const double* values) {
    if constexpr (N == 1) {
        return 0;
    } else {
        const std::size_t a = extreme_of<N / 2, Largest>(values);
        const std::size_t b = N / 2 + extreme_of<N / 2, Largest>(values + N / 2);
        return a + (b - a) * std::size_t{Largest ? values[b] > values[a] : values[b] < values[a]};
    }
}

/// Drops points that lie inside the polygon of the leftmost, lowest, rightmost and highest one,
/// where no vertex of the hull can be (Akl and Toussaint 1978).
///
/// What is strictly left of all sides of a closed polygon of points is surrounded by it.
template <typename L> void drop_inside(few_points& points) {
    constexpr std::size_t width = sizeof(L) / sizeof(double);
    // right, top, left, bottom: the coordinate that is extreme, and the other one there
    L x, y;
    load(x, &points.x[0]);
    load(y, &points.y[0]);
    L far_along[4] = {x, y, x, y};
    L across[4] = {y, x, y, x};
    for (std::size_t i = width; i < points.size; i += width) {
        load(x, &points.x[i]);
        load(y, &points.y[i]);
        across[0] = x > far_along[0] ? y : across[0];
        across[1] = y > far_along[1] ? x : across[1];
        across[2] = x < far_along[2] ? y : across[2];
        across[3] = y < far_along[3] ? x : across[3];
        far_along[0] = x > far_along[0] ? x : far_along[0];
        far_along[1] = y > far_along[1] ? y : far_along[1];
        far_along[2] = x < far_along[2] ? x : far_along[2];
        far_along[3] = y < far_along[3] ? y : far_along[3];
    }
    double corner_x[5], corner_y[5];
    for (std::size_t side = 0; side < 4; ++side) {
        double value[width], other[width];
        store(value, far_along[side]);
        store(other, across[side]);
        const std::size_t best =
            side < 2 ? extreme_of<width, true>(value) : extreme_of<width, false>(value);
        corner_x[side] = side % 2 == 0 ? value[best] : other[best];
        corner_y[side] = side % 2 == 0 ? other[best] : value[best];
    }
    corner_x[4] = corner_x[0];
    corner_y[4] = corner_y[0];
    if (corner_x[0] == corner_x[2]) {
        return; // no inside
    }
    const double reach_x = std::max(std::abs(corner_x[0]), std::abs(corner_x[2]));
    const double reach_y = std::max(std::abs(corner_y[1]), std::abs(corner_y[3]));
    struct side {
        L x, y, least; // p is left of it if x·p.x + y·p.y > least
    };
    side sides[4];
    for (std::size_t i = 0; i < 4; ++i) {
        const double dx = corner_x[i + 1] - corner_x[i];
        const double dy = corner_y[i + 1] - corner_y[i];
        // 2^-49 (|dy| x + |dx| y) is more than all roundings here and below.
        const double error =
            0x1p-49 * (std::abs(dy) * reach_x + std::abs(dx) * reach_y) + 0x1p-1018;
        sides[i].x = L{} - dy;
        sides[i].y = L{} + dx;
        // a side without a length keeps nothing out
        sides[i].least =
            L{} + (dx != 0.0 || dy != 0.0 ? dx * corner_y[i] - dy * corner_x[i] + error : -1.0);
    }
    std::array<std::int64_t, few_points::padded> inside; // -1 or 0
    for (std::size_t i = 0; i < points.size; i += width) {
        load(x, &points.x[i]);
        load(y, &points.y[i]);
        const auto lower = [&](const side& s, L& least) {
            const L depth = s.x * x + s.y * y - s.least;
            least = depth < least ? depth : least;
        };
        L least = L{} + std::numeric_limits<double>::max();
        lower(sides[0], least);
        lower(sides[1], least);
        lower(sides[2], least);
        lower(sides[3], least);
        const auto mask = least > L{};
        if constexpr (width == 1) {
            inside[i] = mask ? -1 : 0;
        } else {
            std::memcpy(&inside[i], &mask, sizeof mask);
        }
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size; ++i) { // written first: no branch to mispredict
        points.x[count] = points.x[i];
        points.y[count] = points.y[i];
        points.number[count] = points.number[i];
        count += static_cast<std::size_t>(1 + inside[i]);
    }
    points.size = count;
    points.pad();
}

/// Each of a few points, for work with all lanes.
template <typename L> struct spread_points {
    const few_points& points;
    explicit spread_points(const few_points& few) : points(few) {}
    double x(std::size_t i) const { return points.x[i]; }
    double y(std::size_t i) const { return points.y[i]; }
};

#if defined(__GNUC__)
/// With SSE2 it takes as long to put a number in both lanes as to work on it: it is done once.
template <> struct spread_points<lanes<2>> {
    std::array<double, 2 * few_points::padded> xs, ys;
    explicit spread_points(const few_points& few) {
        for (std::size_t i = 0; i <= few.size; ++i) { // and one of the padding
            xs[2 * i] = xs[2 * i + 1] = few.x[i];
            ys[2 * i] = ys[2 * i + 1] = few.y[i];
        }
    }
    lanes<2> x(std::size_t i) const { return at(xs, i); }
    lanes<2> y(std::size_t i) const { return at(ys, i); }

  private:
    static lanes<2> at(const std::array<double, 2 * few_points::padded>& values, std::size_t i) {
        lanes<2> result;
        load(result, &values[2 * i]);
        return result;
    }
};
#endif

/// As each point's direction takes the one to the point that lies most clockwise of all.
///
/// For a vertex of the hull that is the hull's next edge. For any other point it is some direction.
/// So neither a hull nor a sort is needed and no point needs a test. O(n²), but in lanes.
template <typename L>
void find_edges(const few_points& points, const spread_points<L>& all, few_rectangles& out) {
    // Two points that differ, if there are any.
    std::size_t other = 1;
    while (other < points.size && points.x[other] == points.x[0] &&
           points.y[other] == points.y[0]) {
        ++other;
    }
    for (std::size_t first = 0; first < points.size; first += sizeof(L) / sizeof(double)) {
        L pivot_x, pivot_y;
        load(pivot_x, &points.x[first]);
        load(pivot_y, &points.y[first]);
        const auto turn = [](const L& dx, const L& dy, L& x, L& y) {
            const auto clockwise = x * dy < y * dx;
            x = clockwise ? dx : x;
            y = clockwise ? dy : y;
        };
        // Towards any other point: no direction of a point's hull edge lies counter-clockwise of
        // it. Two candidates take turns, so that one need not wait for the other.
        L ax = points.x[0] - pivot_x;
        L ay = points.y[0] - pivot_y;
        const auto here = (ax == L{}) & (ay == L{});
        ax = here ? points.x[other] - pivot_x : ax;
        ay = here ? points.y[other] - pivot_y : ay;
        L bx = ax;
        L by = ay;
        for (std::size_t i = 0; i < points.size; i += 2) {
            turn(all.x(i) - pivot_x, all.y(i) - pivot_y, ax, ay);
            turn(all.x(i + 1) - pivot_x, all.y(i + 1) - pivot_y, bx, by);
        }
        turn(bx, by, ax, ay);
        store(&out.x[first], ax);
        store(&out.y[first], ay);
    }
}

/// Measures the rectangle along each direction around all points, and returns the smallest area.
template <typename L>
double measure(const few_points& points, const spread_points<L>& all, few_rectangles& out) {
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
            const L dx = all.x(i) - pivot_x;
            const L dy = all.y(i) - pivot_y;
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
