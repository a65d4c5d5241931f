// Maps turned to the principal axis of their importance, see warpshadow/principal_axis.hpp.
#pragma once

#include "lab/light_maps.hpp"
#include "lab/passes.hpp"

#include <warpshadow/principal_axis.hpp>

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace lab {

/// Lengths of a map's sides in the scene, for a light with a position in slopes.
/// @param matrix clip space from the world, of a map without a warp
[[nodiscard]] glm::dvec2 extent_of(const glm::dmat4& matrix);

/// Turns a map towards the axis of its importance; it holds all that it held.
///
/// @param counts importance of the map's cells
/// @param cells  along a side
/// @param angle  of the map's sides to the axes of the light, radians
/// @param state  of the frame before; updated
/// @return       the new angle
double turn_to_importance(passes& gpu, std::size_t index, std::span<const std::uint32_t> counts,
                          int cells, double angle, warpshadow::axis_state& state);

} // namespace lab
