// A histogram condensed to a few weighted points, and the region of its samples.
#pragma once

#include <warpshadow/detail/lanes.hpp>
#include <warpshadow/detail/plane_warp.hpp>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace warpshadow::detail {

/// Largest number of cells along a side of a histogram.
inline constexpr int largest_side = 256;

/// Weighted points that stand for a histogram.
struct weighted_points {
    static constexpr int capacity = 1280;
    static_assert(capacity % native_lanes == 0);
    std::array<double, capacity> x, y, weight;
    int count = 0;

    void add(const glm::dvec2& p, double w) {
        const auto i = static_cast<std::size_t>(count);
        x[i] = p.x;
        y[i] = p.y;
        weight[i] = w;
        ++count;
    }
    /// Fills up the last lanes with points of no weight.
    void pad() {
        for (auto i = static_cast<std::size_t>(count); i % native_lanes != 0; ++i) {
            x[i] = x[0];
            y[i] = y[0];
            weight[i] = 0.0;
        }
    }
    /// Sum of weight · w^(3/2), of padded points.
    double sum(const plane_warp& warp) const {
        using lane = lanes<native_lanes>;
        lane total = {};
        const lane zero = {};
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += native_lanes) {
            lane px;
            lane py;
            lane mass;
            load(px, x.data() + i);
            load(py, y.data() + i);
            load(mass, weight.data() + i);
            const lane at = warp.constant + warp.slope.x * px + warp.slope.y * py;
            const lane w = at > zero ? at : zero; // a caller's region need not hold all samples
            total += mass * (w * square_roots(w));
        }
        return sum_of(total);
    }

  private:
    static double sum_of(const lanes<native_lanes>& parts) {
        double each[native_lanes];
        store(each, parts);
        double all = 0.0;
        for (const double part : each) {
            all += part;
        }
        return all;
    }
};

/// Corners of the region that the map must hold.
struct map_region {
    static constexpr int capacity = 256;
    std::array<glm::dvec2, capacity> corners;
    int count = 0;

    void add(const glm::dvec2& p) {
        corners[static_cast<std::size_t>(count)] = p;
        ++count;
    }
    std::span<const glm::dvec2> points() const {
        return std::span<const glm::dvec2>(corners).first(static_cast<std::size_t>(count));
    }
};

/// Largest weight of a cell that counts: sums of all cells times w^(3/2) stay finite.
inline constexpr double largest_weight = 0x1p960;

/// A histogram as it is read: NaN, negative and infinite weights, or nearly so, count as none.
template <typename Weight> struct histogram {
    std::span<const Weight> weights;
    int width, height;

    double at(int i, int j) const {
        const Weight w = weights[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                                 static_cast<std::size_t>(i)];
        const double value = static_cast<double>(w);
        return value > 0.0 && value <= largest_weight ? value : 0.0;
    }
    glm::dvec2 centre(int i, int j) const {
        return glm::dvec2((i + 0.5) / width, (j + 0.5) / height);
    }
};

/// One side of the convex hull of the cells that have a sample, row by row: x is the leftmost edge
/// of each row times `side`, 1 for the left side and -1 for the right.
class hull_side {
  public:
    void add(int x, int y) {
        // exact: the coordinates are small integers
        while (count_ >= 2 && turn(x, y) >= 0) {
            --count_;
        }
        points_[static_cast<std::size_t>(count_)] = {x, y};
        ++count_;
    }
    int count() const { return count_; }
    glm::vec<2, int> point(int i) const { return points_[static_cast<std::size_t>(i)]; }

  private:
    int turn(int x, int y) const {
        const glm::vec<2, int> a = point(count_ - 2);
        const glm::vec<2, int> b = point(count_ - 1);
        return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    }

    // a convex chain in a lattice of 257 rows has fewer than 1.8 · 257^(2/3) = 73 corners
    std::array<glm::vec<2, int>, 96> points_{};
    int count_ = 0;
};

/// A histogram condensed, and the region of its cells that hold something.
struct condensed {
    weighted_points blocks; ///< 16 × 16 blocks at their centres of gravity
    weighted_points cells;  ///< the same, but the cells themselves of every block that holds
                            ///< more than 1/64 of everything
    std::array<int, largest_side> first, last; ///< cells of each row that hold something
    map_region region;
    glm::dvec2 centre{0.0}; ///< of gravity
    double total = 0.0;
};

template <typename Weight> void condense(const histogram<Weight>& h, condensed& out) {
    const int columns = (h.width + 15) / 16;
    const int rows = (h.height + 15) / 16;
    std::array<int, largest_side>& first = out.first;
    std::array<int, largest_side>& last = out.last;
    for (std::size_t j = 0; j < static_cast<std::size_t>(h.height); ++j) {
        first[j] = h.width;
        last[j] = -1;
    }
    for (int y0 = 0; y0 < h.height; y0 += rows) {
        for (int x0 = 0; x0 < h.width; x0 += columns) {
            double sum = 0.0;
            glm::dvec2 moment(0.0);
            for (int j = y0; j < y0 + rows && j < h.height; ++j) {
                const auto row = static_cast<std::size_t>(j);
                for (int i = x0; i < x0 + columns && i < h.width; ++i) {
                    const double w = h.at(i, j);
                    if (w > 0.0) {
                        sum += w;
                        moment += w * h.centre(i, j);
                        first[row] = i < first[row] ? i : first[row];
                        last[row] = i > last[row] ? i : last[row];
                    }
                }
            }
            if (sum > 0.0) {
                out.blocks.add(moment / sum, sum);
                out.total += sum;
                out.centre += moment;
            }
        }
    }
    if (!(out.total > 0.0)) {
        return;
    }
    out.centre /= out.total;
    for (int b = 0; b < out.blocks.count; ++b) {
        const auto k = static_cast<std::size_t>(b);
        const glm::dvec2 p(out.blocks.x[k], out.blocks.y[k]);
        const int room = weighted_points::capacity - out.cells.count - (out.blocks.count - b);
        if (!(out.blocks.weight[k] > out.total / 64.0) || room < rows * columns) {
            out.cells.add(p, out.blocks.weight[k]);
            continue;
        }
        const int x0 = static_cast<int>(p.x * h.width) / columns * columns;
        const int y0 = static_cast<int>(p.y * h.height) / rows * rows;
        for (int j = y0; j < y0 + rows && j < h.height; ++j) {
            for (int i = x0; i < x0 + columns && i < h.width; ++i) {
                if (const double w = h.at(i, j); w > 0.0) {
                    out.cells.add(h.centre(i, j), w);
                }
            }
        }
    }
    out.blocks.pad();
    out.cells.pad();
    hull_side left;
    hull_side right;
    for (int j = 0; j < h.height; ++j) {
        const auto row = static_cast<std::size_t>(j);
        if (last[row] >= 0) {
            for (int y = j; y <= j + 1; ++y) {
                left.add(first[row], y);
                right.add(-(last[row] + 1), y);
            }
        }
    }
    for (int i = 0; i < left.count(); ++i) {
        out.region.add(glm::dvec2(left.point(i)) / glm::dvec2(h.width, h.height));
    }
    for (int i = 0; i < right.count(); ++i) {
        out.region.add(glm::dvec2(-right.point(i).x, right.point(i).y) /
                       glm::dvec2(h.width, h.height));
    }
}

} // namespace warpshadow::detail
