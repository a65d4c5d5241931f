#include "lab/measure.hpp"

#include <cmath>

namespace lab {

std::optional<double> comparison::ratio(std::size_t part) const {
    if (samples == 0) {
        return std::nullopt;
    }
    return static_cast<double>(part) / static_cast<double>(samples);
}

filter_errors measure_filter(const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                             std::span<const float> light) {
    double sum = 0.0;
    std::size_t wrong = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (samples.position[i].w > 0.5f && samples.n_dot_l[i] > counted_n_dot_l) {
            const double error =
                std::abs(static_cast<double>(light[i]) - (truth[i] != 0 ? 0.0 : 1.0));
            sum += error;
            wrong += error > 0.5 ? 1 : 0;
            ++count;
        }
    }
    if (count == 0) {
        return {};
    }
    const auto all = static_cast<double>(count);
    return {sum / all, static_cast<double>(wrong) / all};
}

comparison compare(const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                   std::span<const std::uint8_t> shadowed) {
    comparison result;
    result.wrong.assign(samples.position.size(), 0);
    for (std::size_t i = 0; i < samples.position.size(); ++i) {
        const float cosine = samples.n_dot_l[i];
        if (samples.position[i].w <= 0.5f || !(cosine > 0.0f)) {
            continue;
        }
        const bool is_dark = shadowed[i] != 0;
        const bool should_be_dark = truth[i] != 0;
        if (cosine > counted_n_dot_l) {
            ++result.samples;
            result.false_shadow += is_dark && !should_be_dark ? 1 : 0;
            result.false_light += !is_dark && should_be_dark ? 1 : 0;
            result.wrong[i] = is_dark != should_be_dark ? 1 : 0;
        } else {
            ++result.grazing_samples;
            result.grazing_wrong += is_dark != should_be_dark ? 1 : 0;
        }
    }
    return result;
}

} // namespace lab
