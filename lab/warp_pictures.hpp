// Pictures that explain a warp: importance before and after, and what the tables make of the map.
#pragma once

#include "lab/methods.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lab {

/// Tables and counts of one warp, as read from the device; row 0 at the bottom.
struct warp_readback {
    int size;                               ///< texels of the map along either axis
    int cells;                              ///< of a function, and of the counts along either axis
    int functions;                          ///< of either axis
    std::vector<float> rows;                ///< functions · (cells + 1) nodes
    std::vector<float> columns;             ///< functions · (cells + 1) nodes
    std::vector<std::uint32_t> importance;  ///< counts in the unwarped map
    std::vector<std::uint32_t> half_warped; ///< counts after the rows, transposed; or none
};

/// "importance", "importance-rows-warped" (Milet et al. 2015, figure 4), "warp-grid" (figure 5),
/// "warp-functions" and "effective-resolution".
std::vector<named_picture> warp_pictures(const warp_readback& warp);

/// Depth, contrast stretched to what is there, near is dark.
named_picture depth_picture(std::span<const float> depth, int size, std::string name);

} // namespace lab
