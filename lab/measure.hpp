// How many view samples a method gets wrong.
#pragma once

#include "lab/methods.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lab {

/// Cosine between normal and light above which a sample counts; below it, errors are those of the
/// bias at grazing light and are counted apart.
inline constexpr float counted_n_dot_l = 0.1f;

/// Differences between a method's shadows and the true ones.
struct comparison {
    std::size_t samples = 0;         ///< receivers with n·l > counted_n_dot_l
    std::size_t false_shadow = 0;    ///< of those, lit but in the method's shadow
    std::size_t false_light = 0;     ///< of those, in shadow but lit by the method
    std::size_t grazing_samples = 0; ///< receivers with 0 < n·l <= counted_n_dot_l
    std::size_t grazing_wrong = 0;
    std::vector<std::uint8_t> wrong; ///< per view sample: 1 = counted and wrong

    /// Part of the samples; nothing when there are none.
    [[nodiscard]] std::optional<double> ratio(std::size_t part) const;
};

/// What a filter leaves wrong, over the samples that `compare` counts; nothing when there are none.
struct filter_errors {
    std::optional<double> mean_light; ///< light that is missing or too much
    std::optional<double> wrong;      ///< samples that are wrong by more than half of the light
};

filter_errors measure_filter(const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                             std::span<const float> light);

comparison compare(const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                   std::span<const std::uint8_t> shadowed);

} // namespace lab
