// A header of a user's: an importance function, and what it makes of the library's functions.
#pragma once

#include <warpshadow/warp.hpp>

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace mine {

/// Importance that falls off with the distance from a silhouette.
struct silhouette {
    glm::vec2 centre; ///< in map space
    float sharpness;  ///< per unit of the map

    /// Importance at a point of the map.
    float operator()(glm::vec2 p) const { return glm::exp(-sharpness * glm::length(p - centre)); }
};

/// Importance seen through a warp.
///
/// @param rows, columns tables of `warpshadow::warp`
/// @param f             importance
/// @param p             position in map space
inline float warped_importance(const warpshadow::table_view<float>& rows,
                               const warpshadow::table_view<float>& columns, const silhouette& f,
                               glm::vec2 p) {
    return f(warpshadow::warp(rows, columns, p));
}

} // namespace mine
