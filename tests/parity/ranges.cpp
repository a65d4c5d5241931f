// Which whole numbers the shared functions take. Where a function documents a condition on an int
// or an enumeration, the condition stands here.
#include "harness.hpp"

namespace parity {

whole_range range_of(std::string_view function, std::string_view parameter,
                     std::string_view member) {
    // members of structs
    if (member == "row0" || member == "row1") {
        return {0, 3}; // every table has at least four rows
    }
    if (member == "depth") {
        return {0, 1}; // depth_range
    }
    if (member == "side") {
        return {-1, 1};
    }
    // parameters
    if (function == "ws_any") {
        return {0, 0xffffffff};
    }
    if (function == "ws_warp_node" && (parameter == "before" || parameter == "total")) {
        return {0, 0xffffff};
    }
    if (function == "ws_blended_count") {
        return parameter == "share" ? whole_range{0, 65536} : whole_range{0, 0xffffffff};
    }
    if (parameter == "i" || parameter == "j") {
        return {0, 8}; // shift by it
    }
    if (parameter == "k") {
        return {0, 4}; // a node; every table has at least four cells
    }
    if (parameter == "face") {
        return {-1, 6};
    }
    if (parameter == "side") {
        return {0, 1};
    }
    if (parameter == "texel") {
        return {0, 63};
    }
    if (parameter == "bits") {
        return {1, 32};
    }
    return {1, 64};
}

float_range float_range_of(std::string_view function, std::string_view parameter,
                           std::string_view member) {
    if (member == "texel" || (parameter == "texel" && function != "ws_cube_texel_direction")) {
        return {1.0f / 16384.0f, 1.0f}; // one over the size of a map
    }
    // bias_settings
    if (member == "radius" || member == "slope_ratio") {
        return {0.5f, 64.0f};
    }
    if (member == "quantum" || member == "deviation") {
        return {1.0e-8f, 1.0f / 256.0f};
    }
    if (member == "largest") {
        return {1.0f / 1024.0f, 1.0f};
    }
    // a position is in the map; beyond it has fewer digits than the map has texels
    if (function == "ws_corner_bias" && parameter == "p") {
        return {0.0f, 1.0f};
    }
    if (parameter == "plane" || parameter == "planes") {
        return {-1.0e18f, 1.0e18f}; // products of two must not overflow
    }
    // a matrix of numbers of all sizes is singular in float, whatever it is in double
    if (function == "ws_texel_axes_at") {
        return {-8.0f, 8.0f};
    }
    if (parameter == "size" && (function == "ws_settings_for" || function == "ws_longest_chord")) {
        return {1.0f, 16384.0f};
    }
    if (function == "ws_split_distance") {
        return parameter == "lambda" ? float_range{0.0f, 1.0f}
                                     : float_range{1.0f / 1024.0f, 1.0e6f};
    }
    return {0.0f, 0.0f};
}

} // namespace parity
