// The map that a count map stands for, in 100 digits: window sums in integers, nothing rounded.
#pragma once

#include "measure.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace arithmetic {

using real = boost::multiprecision::cpp_bin_float_100;

inline wide to_wide(const real& x) {
    const auto hi = static_cast<double>(x);
    return {hi, static_cast<double>(real(x - hi))};
}

/// Functions of one axis, blended linearly between the centres of the rows as `warp` does.
class exact_axis {
  public:
    exact_axis(const std::vector<std::uint32_t>& counts, int cells, int radius, double floor)
        : cells_(cells), floor_(floor) {
        const auto w = static_cast<std::size_t>(cells);
        before_.resize(w * (w + 1));
        // columns of sums first, then what is left of each node
        std::vector<std::uint64_t> above(w * (w + 1), 0);
        for (std::size_t y = 0; y < w; ++y) {
            for (std::size_t x = 0; x < w; ++x) {
                above[(y + 1) * w + x] = above[y * w + x] + counts[y * w + x];
            }
        }
        for (int row = 0; row < cells; ++row) {
            const auto first = static_cast<std::size_t>(std::max(row - radius, 0));
            const auto end = static_cast<std::size_t>(std::min(row + radius + 1, cells));
            std::uint64_t* const out = &before_[static_cast<std::size_t>(row) * (w + 1)];
            for (std::size_t x = 0; x < w; ++x) {
                out[x + 1] = out[x] + (above[end * w + x] - above[first * w + x]);
            }
        }
    }

    /// F(k / cells) of one row.
    [[nodiscard]] real node(int row, int k) const {
        const std::size_t start =
            static_cast<std::size_t>(row) * (static_cast<std::size_t>(cells_) + 1);
        const std::uint64_t total = before_[start + static_cast<std::size_t>(cells_)];
        const real x = real(k) / cells_;
        if (total == 0) {
            return x;
        }
        return floor_ * x +
               (1 - real(floor_)) * real(before_[start + static_cast<std::size_t>(k)]) / total;
    }

    [[nodiscard]] real value(const real& across, const real& x) const {
        const blend b = blend_at(across);
        const int k = std::clamp(static_cast<int>(x * cells_), 0, cells_ - 1);
        const real from = node(b, k);
        return from + (x * cells_ - k) * (node(b, k + 1) - from);
    }

    [[nodiscard]] real inverse(const real& across, const real& image) const {
        const blend b = blend_at(across);
        int below = 0;
        int above = cells_;
        while (above - below > 1) {
            const int middle = (below + above) / 2;
            (node(b, middle) <= image ? below : above) = middle;
        }
        const real from = node(b, below);
        return (below + (image - from) / (node(b, above) - from)) / cells_;
    }

  private:
    struct blend {
        int row0, row1;
        real weight;
    };
    [[nodiscard]] blend blend_at(const real& across) const {
        const real position =
            std::clamp(real(across * cells_ - real(0.5)), real(0), real(cells_ - 1));
        const int row = static_cast<int>(position);
        return {row, std::min(row + 1, cells_ - 1), position - row};
    }
    [[nodiscard]] real node(const blend& b, int k) const {
        const real node0 = node(b.row0, k);
        return node0 + b.weight * (node(b.row1, k) - node0);
    }

    int cells_;
    double floor_;
    std::vector<std::uint64_t> before_; ///< exclusive sums over each window
};

} // namespace arithmetic
