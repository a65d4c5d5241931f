// Parts of a scene that are culled as one.
#pragma once

#include "lab/scene.hpp"

#include <warpshadow/frustum.hpp>

#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

namespace lab {

/// Consecutive triangles.
struct triangle_range {
    std::size_t first;
    std::size_t count;
};

/// A scene as objects; the triangles of each follow one another.
struct scene_objects {
    std::vector<glm::uvec3> triangles; ///< all of the scene, reordered within its parts
    std::vector<triangle_range> ranges;
    std::vector<warpshadow::box3<double>> boxes; ///< of the ranges
};

/// A part with more triangles than this is split.
inline constexpr std::size_t largest_object = 1000;

/// The objects of a scene: its parts, and large ones split at the median of their triangles'
/// centres along the longest side of the box around these, until no piece is too large.
scene_objects make_objects(const scene& world);

} // namespace lab
