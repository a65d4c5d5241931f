// A scene cut finely enough for dual paraboloid maps, where straight edges are arcs.
#pragma once

#include "lab/objects.hpp"
#include "lab/scene.hpp"

#include <warpshadow/status.hpp>

#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

namespace lab {

/// Where the maps of both hemispheres look.
struct hemisphere_frame {
    glm::dvec3 light;
    glm::dmat3 axes;     ///< columns: right, up, and the axis of the front, in the world
    double far_distance; ///< no point of the scene is farther from the light
};

/// The frame of a light: the front looks along `axis`, any length.
hemisphere_frame make_hemisphere_frame(const scene& world, glm::dvec3 light, glm::dvec3 axis);

/// How far edges may be off the arcs that they stand for, in texels.
inline constexpr double arc_texels = 0.5;

/// Sine of the angle behind the horizon that a hemisphere's map holds: the centre of a texel on
/// its rim may lie 0.71 texels, 1.42 of the radius over the size, beyond; the arcs take as much.
double horizon_overlap(int map_size);

/// A corner of a triangle, relative to the light, in its frame.
struct hemisphere_vertex {
    glm::vec3 position;
    glm::vec4 plane; ///< dot(plane.xyz, p) = plane.w on the triangle
    glm::vec2 reach; ///< least and largest distance of the triangle from the light
};

/// Triangles, three corners each.
struct hemisphere_mesh {
    std::vector<hemisphere_vertex> vertices;
    std::vector<triangle_range> ranges; ///< per object
    warpshadow::status flags = warpshadow::status::ok;
};

/// Halves edges until the library's bound on chords passes all that a map shows.
///
/// What is cut depends on an edge alone: triangles on both of its sides agree. Parts of a cut
/// triangle that no side shows are gone; whole triangles stay, as the passes have to deal with
/// them.
hemisphere_mesh cut_for_hemispheres(const scene& world, const scene_objects& objects,
                                    const hemisphere_frame& frame, int map_size);

} // namespace lab
