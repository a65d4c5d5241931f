// Importance of a view for the benchmarks of tables, and tables as the papers build them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace warp_inputs {

/// Counts of a view that looks along the map: dense near the eye, some objects, empty corners.
inline std::vector<std::uint32_t> view_counts(int size) {
    const auto w = static_cast<std::size_t>(size);
    std::vector<std::uint32_t> counts(w * w);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (std::size_t i = 0; i < w * w; ++i) {
        double u = unit(random);
        double v = unit(random);
        if (i % 10 < 6) {
            const double depth = 0.02 / (0.02 + 0.98 * v);
            u = 0.5 + (u - 0.5) * (0.05 + 0.9 * depth);
            v = depth;
        } else if (i % 10 < 9) {
            u = 0.3 + 0.05 * static_cast<double>(i % 10 - 6) + 0.02 * (u - 0.5);
            v = 0.2 + 0.2 * static_cast<double>(i % 10 - 6) + 0.03 * (v - 0.5);
        }
        ++counts[static_cast<std::size_t>(v * size) * w + static_cast<std::size_t>(u * size)];
    }
    return counts;
}

/// The map with its axes exchanged.
inline std::vector<std::uint32_t> turned(const std::vector<std::uint32_t>& counts, int size) {
    const auto w = static_cast<std::size_t>(size);
    std::vector<std::uint32_t> result(counts.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        result[i] = counts[i % w * w + i / w];
    }
    return result;
}

/// The published way to build: a function per row, then the weighted mean of those in the window,
/// all in float.
class plain_builder {
  public:
    explicit plain_builder(int size)
        : width_(static_cast<std::size_t>(size)), functions_(width_ * width_), weights_(width_),
          sums_(width_) {}

    /// @param nodes receives size · (size + 1) nodes
    void build(const std::vector<std::uint32_t>& counts, int radius, float floor,
               std::span<float> nodes) {
        const std::size_t w = width_;
        const auto size = static_cast<int>(w);
        for (std::size_t y = 0; y < w; ++y) {
            float sum = 0.0f;
            for (std::size_t x = 0; x < w; ++x) {
                sum += static_cast<float>(counts[y * w + x]);
                functions_[y * w + x] = sum;
            }
            weights_[y] = sum;
        }
        std::fill(sums_.begin(), sums_.end(), 0.0f);
        float weight = 0.0f;
        const auto add = [&](int row, float sign) {
            if (row >= 0 && row < size) {
                const auto y = static_cast<std::size_t>(row);
                weight += sign * weights_[y];
                for (std::size_t x = 0; x < w; ++x) {
                    sums_[x] += sign * functions_[y * w + x];
                }
            }
        };
        for (int row = 0; row < radius; ++row) {
            add(row, 1.0f);
        }
        for (int row = 0; row < size; ++row) {
            add(row + radius, 1.0f);
            add(row - radius - 1, -1.0f);
            float* const out = nodes.data() + static_cast<std::size_t>(row) * (w + 1);
            out[0] = 0.0f;
            for (std::size_t x = 0; x < w; ++x) {
                const float uniform = static_cast<float>(x + 1) / static_cast<float>(w);
                out[x + 1] = floor * uniform +
                             (1.0f - floor) * (weight > 0.0f ? sums_[x] / weight : uniform);
            }
        }
    }

  private:
    std::size_t width_;
    std::vector<float> functions_, weights_, sums_;
};

} // namespace warp_inputs
