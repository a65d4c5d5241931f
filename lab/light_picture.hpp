// The light's view of the scene, with the map that a method made of it.
#pragma once

#include "lab/methods.hpp"

#include <warpshadow/focus.hpp>

#include <glm/glm.hpp>

#include <span>

namespace lab {

/// All that the light sees, as depths.
struct light_depths {
    glm::dmat4 matrix;            ///< clip space (OpenGL) from the world
    std::span<const float> depth; ///< size · size, row 0 at the bottom
    int size;
};

/// The light's matrix, widened to hold the whole of another map of the same light, unless that is
/// more than three times as wide.
glm::dmat4 enclosing(const glm::dmat4& light, const glm::dmat4& map);

/// "light-view": the depths in grey; what the camera can see of the scene in blue, its hull in the
/// light's plane in yellow, and the border of the map (`matrix`: clip space from the world) in red.
named_picture light_picture(const light_depths& all, const glm::dmat4& matrix,
                            const warpshadow::focus_result& focus);

} // namespace lab
