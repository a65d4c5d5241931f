// The edges of a heap of triangles, each with the triangles that run along it: what shadow volumes
// have sides of.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace lab {

/// Edges of triangles, every one once.
struct volume_edges {
    /// Two corners, and which of `runs` are its own: the first and their number. Mirrored in
    /// shaders/volume_edges.comp.
    std::vector<glm::uvec4> edges;
    /// Twice the number of a triangle, plus 1 where it runs from the edge's second corner to its
    /// first.
    std::vector<std::uint32_t> runs;
};

/// Finds the edges of triangles of any kind: open, with more than two at an edge, turned either
/// way.
///
/// Corners at the same place are one, whatever their numbers; an edge is given by the lowest. Sides
/// of no length are left out.
/// @param triangles fewer than 2^31, of corners that `positions` has
volume_edges edges_of(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);

} // namespace lab
