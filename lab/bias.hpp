// Biases to compare, and what is measured of them.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lab {

struct g_buffer_samples;

/// How the depth of a receiver and that of a texel are compared; mirrored in
/// shaders/receiver.glsl.
enum class bias_kind {
    plane = 0,    ///< the receiver's plane at the texel's centre: needs no bias
    none = 1,     ///< the receiver's own depth as it is
    constant = 2, ///< less the same everywhere
    slope = 3,    ///< less the slope times a factor, as graphics APIs have it
    footprint = 4 ///< less what the texel's footprint takes
};

/// What the map holds.
enum class depth_kind {
    hyperbolic, ///< depth as the matrix makes it
    linear,     ///< the light's own depth, per fragment
    back_faces  ///< the nearest face that looks away from the light
};

/// A way to keep surfaces from shadowing themselves.
struct bias_choice {
    std::string label = "plane";
    bias_kind kind = bias_kind::plane;
    depth_kind depth = depth_kind::hyperbolic;
    /// The constant, in units of stored depth (0 to 1), or the factor of the slope; nothing: the
    /// least without acne on the view, or the least that is never too little.
    std::optional<double> value = std::nullopt;
    std::optional<double> units = std::nullopt; ///< added to the slope's bias, in roundings
};

/// Reads plane, none, constant, constant:VALUE, slope, slope:FACTOR, slope:FACTOR:UNITS, footprint;
/// but for plane with +linear or +back-face, which alone stand for none.
/// @throws bad_input
bias_choice parse_bias(const std::string& text);

/// What is shown instead of hard shadows; nothing that is counted depends on it. Kernels are
/// mirrored in shaders/kernel.glsl.
enum class shadow_filter {
    none = 0,
    pcf = 1,          ///< 2 × 2 texels
    blur = 2,         ///< the same, blurred in the picture
    pcf_texels = 3,   ///< a kernel of fixed size in texels (Rosen 2012, §6.2)
    pcf_light = 4,    ///< one of fixed size in the scene: each tap is moved, then warped
    pcf_footprint = 5 ///< the same by the warp's Jacobian at the receiver
};

/// A filter with its strength.
struct filter_choice {
    shadow_filter kind = shadow_filter::none;
    int blurs = 4;               ///< iterations of the blur
    bool less_with_depth = true; ///< beyond the median depth; else the same everywhere
    double radius = 0.0;         ///< half the side of a kernel, in texels or in scene units
};

/// Reads none, pcf, blur, pcf-texels:R, pcf-light:R and pcf-footprint:R.
/// @throws bad_input
filter_choice parse_filter(const std::string& text);

/// Its name as parse_filter takes it.
std::string filter_name(const filter_choice& filter);

/// Whether a filter has a kernel of a size of its own.
[[nodiscard]] bool has_kernel(shadow_filter kind);

/// What a bias did to one view sample that faces the light.
struct bias_sample {
    float excess;       ///< depth of the sample over that of its texel, without a bias
    float bias;         ///< in units of stored depth
    float displacement; ///< the bias along the light ray, in sides of the texel
    float before;       ///< 1: the texel holds a surface before the sample's plane; 0: it does not;
                        ///< -1: the sample does not face the light
};

/// Shares of the counted samples, and a mean over them; nothing without samples.
struct bias_measures {
    double value = 0.0; ///< constant or factor that was used, else 0
    /// Lit samples that are dark although their texel holds nothing before their own plane.
    std::optional<double> acne_ratio = std::nullopt;
    /// Samples in shadow that are lit although their texel holds a surface before their own plane.
    std::optional<double> leak_ratio = std::nullopt;
    /// Mean distance by which shadows recede where they touch their caster.
    std::optional<double> displacement_texels = std::nullopt;
};

bias_measures measure_bias(const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                           std::span<const std::uint8_t> shadowed,
                           std::span<const bias_sample> biases);

/// The smallest constant bias without acne on a view, to the rounding of a depth.
double least_constant(const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                      std::span<const bias_sample> biases);

} // namespace lab
