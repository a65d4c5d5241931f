#include "lab/bias.hpp"

#include "lab/measure.hpp"
#include "lab/numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string_view>

namespace lab {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw bad_input("--bias wants plane, none, constant[:VALUE], slope[:FACTOR[:UNITS]] or "
                    "footprint, all but plane with +linear or +back-face, not '" +
                    text + "'");
}

struct filter_kind {
    std::string_view name;
    shadow_filter kind;
    double most; ///< largest radius of a kernel; 0 for filters without
};
constexpr std::array filter_kinds{
    filter_kind{"none", shadow_filter::none, 0.0},
    filter_kind{"pcf", shadow_filter::pcf, 0.0},
    filter_kind{"blur", shadow_filter::blur, 0.0},
    filter_kind{"pcf-texels", shadow_filter::pcf_texels, 64.0},
    filter_kind{"pcf-light", shadow_filter::pcf_light, 1e6},
    filter_kind{"pcf-footprint", shadow_filter::pcf_footprint, 1e6},
};

double number_of(std::string_view part, double most, const std::string& text) {
    const std::optional<double> value = number_in(part, 0.0, most);
    if (!value) {
        refuse(text);
    }
    return *value;
}

bool counts(const g_buffer_samples& samples, std::size_t i) {
    return samples.position[i].w > 0.5f && samples.n_dot_l[i] > counted_n_dot_l;
}

} // namespace

bias_choice parse_bias(const std::string& text) {
    bias_choice result{text};
    result.kind = bias_kind::none;
    bool has_kind = false;
    bool has_depth = false;
    for (const std::string& part : split(text, '+')) {
        if (part == "linear" || part == "back-face") {
            if (has_depth) {
                refuse(text);
            }
            has_depth = true;
            result.depth = part == "linear" ? depth_kind::linear : depth_kind::back_faces;
            continue;
        }
        const std::vector<std::string> words = split(part, ':');
        constexpr std::array<std::string_view, 5> names{"plane", "none", "constant", "slope",
                                                        "footprint"};
        const auto* const found = std::find(names.begin(), names.end(), words.front());
        if (has_kind || found == names.end()) {
            refuse(text);
        }
        has_kind = true;
        result.kind = static_cast<bias_kind>(found - names.begin());
        const std::size_t most = result.kind == bias_kind::slope      ? 3
                                 : result.kind == bias_kind::constant ? 2
                                                                      : 1;
        if (words.size() > most) {
            refuse(text);
        }
        if (words.size() > 1) {
            result.value =
                number_of(words[1], result.kind == bias_kind::constant ? 1.0 : 1e6, text);
        }
        if (words.size() > 2) {
            result.units = number_of(words[2], 1e6, text);
        }
    }
    if (result.kind == bias_kind::plane && has_depth) {
        refuse(text);
    }
    return result;
}

filter_choice parse_filter(const std::string& text) {
    const std::vector<std::string> words = split(text, ':');
    for (const filter_kind& each : filter_kinds) {
        if (each.name != words.front() || words.size() != (each.most > 0.0 ? 2u : 1u)) {
            continue;
        }
        filter_choice result{each.kind};
        if (each.most > 0.0) {
            result.radius = number_in(words[1], 0.0, each.most).value_or(0.0);
        }
        if (result.radius > 0.0 || each.most == 0.0) {
            return result;
        }
    }
    throw bad_input("--filter wants none, pcf, blur, pcf-texels:RADIUS (to 64), pcf-light:RADIUS "
                    "or pcf-footprint:RADIUS, not '" +
                    text + "'");
}

bool has_kernel(shadow_filter kind) {
    return kind >= shadow_filter::pcf_texels;
}

std::string filter_name(const filter_choice& filter) {
    std::string name(filter_kinds[static_cast<std::size_t>(filter.kind)].name);
    if (has_kernel(filter.kind)) {
        char number[32];
        std::snprintf(number, sizeof number, ":%g", filter.radius);
        name += number;
    }
    return name;
}

bias_measures measure_bias(const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                           std::span<const std::uint8_t> shadowed,
                           std::span<const bias_sample> biases) {
    std::size_t count = 0;
    std::size_t acne = 0;
    std::size_t leaks = 0;
    double sum = 0.0;
    bool finite = true;
    for (std::size_t i = 0; i < biases.size(); ++i) {
        if (!counts(samples, i)) {
            continue;
        }
        ++count;
        const bool before = biases[i].before > 0.5f;
        acne += truth[i] == 0 && shadowed[i] != 0 && !before ? 1u : 0u;
        leaks += truth[i] != 0 && shadowed[i] == 0 && before ? 1u : 0u;
        // a map that cannot be inverted has no texels to count in
        finite = finite && std::isfinite(biases[i].displacement);
        sum += static_cast<double>(biases[i].displacement);
    }
    bias_measures result;
    if (count > 0) {
        const auto all = static_cast<double>(count);
        result.acne_ratio = static_cast<double>(acne) / all;
        result.leak_ratio = static_cast<double>(leaks) / all;
        if (finite) {
            result.displacement_texels = sum / all;
        }
    }
    return result;
}

double least_constant(const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                      std::span<const bias_sample> biases) {
    float most = 0.0f;
    for (std::size_t i = 0; i < biases.size(); ++i) {
        if (counts(samples, i) && truth[i] == 0 && biases[i].before < 0.5f) {
            most = std::max(most, biases[i].excess);
        }
    }
    // the device rounds the depth less the constant once
    return static_cast<double>(most) + 0x1p-23;
}

} // namespace lab
