// Where shadow edges are: in the light's depth image, and in the shadows that were seen last.
//
// Rosen 2012, §4.1 and §5.3. The edges of the depth image lie in the map where the edges of the
// shadows will be looked up, so they serve forward analysis as they are, and hybrid analysis by
// `edge_at` of a view sample's position. The edges of the last frame's shadows serve backward
// analysis alone, and need no depth image.
#pragma once

#include <warpshadow/bias.hpp>
#include <warpshadow/conventions.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/importance_functions.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace warpshadow {

/// An image of the caller's, row after row from the bottom of map space (or of the view) up.
template <typename Texel> struct image_view {
    std::span<const Texel> texels; ///< at least width · height
    int width = 0;                 ///< texels along u
    int height = 0;                ///< texels along v
};

/// Whether the sizes are positive and the memory holds them.
template <typename Texel> constexpr bool fits(const image_view<Texel>& image) {
    return image.width > 0 && image.height > 0 &&
           image.texels.size() >=
               static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

namespace detail {

/// A texel and its eight neighbours; the texel itself for those outside the image.
template <typename T> struct neighbourhood {
    T centre;
    glm::vec<4, T> ring0;
    glm::vec<4, T> ring1;
};

template <typename T> neighbourhood<T> neighbours_of(const image_view<T>& image, int i, int j) {
    const auto at = [&image](int x, int y) {
        return image.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x)];
    };
    const T centre = at(i, j);
    const auto beside = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < image.width && y < image.height ? at(x, y) : centre;
    };
    return {centre,
            glm::vec<4, T>(beside(i - 1, j - 1), beside(i, j - 1), beside(i + 1, j - 1),
                           beside(i - 1, j)),
            glm::vec<4, T>(beside(i + 1, j), beside(i - 1, j + 1), beside(i, j + 1),
                           beside(i + 1, j + 1))};
}

} // namespace detail

/// Marks the texels of a depth image that differ from a neighbour by more than the bias.
///
/// @param depths light's depth image; texels that nothing was drawn to hold the far depth, so that
///               outlines against the background are edges too
/// @param bias   see `depth_edge`
/// @param edges  receives 1 for an edge and 0 else, width · height of them
/// @return       buffer_too_small, and nothing written, if a size does not fit
template <typename T>
status mark_depth_edges(const image_view<T>& depths, T bias, std::span<std::uint8_t> edges) {
    if (!fits(depths) || edges.size() < static_cast<std::size_t>(depths.width) *
                                            static_cast<std::size_t>(depths.height)) {
        return status::buffer_too_small;
    }
    std::size_t texel = 0;
    for (int j = 0; j < depths.height; ++j) {
        for (int i = 0; i < depths.width; ++i) {
            const detail::neighbourhood<T> n = detail::neighbours_of(depths, i, j);
            edges[texel++] = depth_edge(n.centre, n.ring0, n.ring1, bias) ? 1 : 0;
        }
    }
    return status::ok;
}

/// Where the light's depth image says that a shadow may end at a point, and across which axis.
///
/// Nine tests of the point's plane against the texel that holds the point and its neighbours, each
/// at the texel's own centre, as `plane_depth_step` compares. Texels outside repeat the border. The
/// device does the same in glsl/passes/shadow_end.glsl.
/// @param depths light's depth image over the map: greater is farther from the light
/// @param p      the point in map space before a warp: position in [0, 1]² (clamped to it), depth
/// @param normal of its surface in map space, any length; see `map_normal`
/// @param bias   what a texel may lie before the plane and still be that surface, in units of depth
/// @return       see `shadow_end`; 0 for a NaN in p and for an image that does not hold its size
template <typename T>
glm::vec<2, T> shadow_end_at(const image_view<T>& depths, glm::vec<3, T> p, glm::vec<3, T> normal,
                             T bias) {
    const glm::vec<2, T> at(p);
    if (!fits(depths) || !(p.x - p.x == T(0)) || !(p.y - p.y == T(0))) {
        return glm::vec<2, T>(T(0));
    }
    const glm::vec<2, T> size(static_cast<T>(depths.width), static_cast<T>(depths.height));
    const glm::vec<2, T> corner =
        glm::min(glm::floor(glm::clamp(at, T(0), T(1)) * size), size - T(1));
    glm::vec<3, T> lit[3];
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            const int i = glm::clamp(static_cast<int>(corner.x) + x - 1, 0, depths.width - 1);
            const int j = glm::clamp(static_cast<int>(corner.y) + y - 1, 0, depths.height - 1);
            const glm::vec<2, T> centre =
                (glm::vec<2, T>(static_cast<T>(i), static_cast<T>(j)) + T(0.5)) / size;
            const T plane = p.z + plane_depth_step(normal, at, centre, T(1));
            const std::size_t texel =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(depths.width) +
                static_cast<std::size_t>(i);
            lit[y][x] = depths.texels[texel] < plane - bias ? T(0) : T(1);
        }
    }
    return shadow_end(lit[0], lit[1], lit[2]);
}

/// Marks the pixels of a view at which a shadow ends: lit beside dark, on one surface.
///
/// Where an object hides another both may be lit differently without a shadow's edge passing, so a
/// neighbour counts only if its distance from the eye is nearly the same. The edges of the last
/// frame lag behind by one.
/// @param lit       1 for lit, 0 for dark, anything else for pixels that receive no shadow
/// @param distances of the same pixels from the eye, along the direction of view
/// @param tolerance difference of distances on one surface, as a share of the smaller one
/// @param edges     receives 1 for an edge and 0 else, width · height of them
/// @return          buffer_too_small, and nothing written, if a size does not fit
template <typename T>
status mark_seen_edges(const image_view<std::uint8_t>& lit, const image_view<T>& distances,
                       T tolerance, std::span<std::uint8_t> edges) {
    if (!fits(lit) || !fits(distances) || lit.width != distances.width ||
        lit.height != distances.height ||
        edges.size() < static_cast<std::size_t>(lit.width) * static_cast<std::size_t>(lit.height)) {
        return status::buffer_too_small;
    }
    const auto index = [&lit](int i, int j) {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(lit.width) +
               static_cast<std::size_t>(i);
    };
    for (int j = 0; j < lit.height; ++j) {
        for (int i = 0; i < lit.width; ++i) {
            const std::size_t centre = index(i, j);
            bool edge = false;
            for (int y = glm::max(j - 1, 0); y <= glm::min(j + 1, lit.height - 1); ++y) {
                for (int x = glm::max(i - 1, 0); x <= glm::min(i + 1, lit.width - 1); ++x) {
                    const std::size_t other = index(x, y);
                    const T here = distances.texels[centre];
                    const T there = distances.texels[other];
                    edge = edge || (lit.texels[centre] + lit.texels[other] == 1 &&
                                    glm::abs(here - there) <= tolerance * glm::min(here, there));
                }
            }
            edges[centre] = edge ? 1 : 0;
        }
    }
    return status::ok;
}

/// Whether the cell of an edge map that holds a position is marked; false outside and for NaN.
///
/// @param edges from `mark_depth_edges`; `fits(edges)`
/// @param p     position in map space
template <typename T> bool edge_at(const image_view<std::uint8_t>& edges, glm::vec<2, T> p) {
    const int i = cell_of(p.x, edges.width);
    const int j = cell_of(p.y, edges.height);
    return i >= 0 && j >= 0 &&
           edges.texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(edges.width) +
                        static_cast<std::size_t>(i)] != 0;
}

/// How a depth image of the light is analysed.
template <typename T> struct forward_options {
    glm::mat<4, 4, T> camera_from_map{T(1)}; ///< (u, v, depth, 1) to the camera's clip space
    clip_space camera{};                     ///< of the camera's clip space
    T empty_depth = T(1);                    ///< depth of texels that nothing was drawn to
    T bias = T(0);                           ///< see `depth_edge`
    T steps = T(256);                        ///< see `weight_steps`
    importance_options<T> importance;        ///< `normal` is not used: an image has no normals
};

/// Importance of the map from a depth image of the light: forward analysis (Rosen 2012, §4.1).
///
/// Each texel adds its importance to the cell that holds its centre. The image may be larger than
/// the map, or smaller; a map that is larger has empty cells in between, which smoothing fills.
/// @param depths  light's depth image over map space
/// @param options matrices and functions
/// @param rule    what a cell makes of several texels
/// @param map     counters, added to
/// @return        as `splat_weighted`; texels without a surface and those out of view count as
///                weightless; buffer_too_small, and nothing written, if a size does not fit
template <typename T>
splat_result splat_forward(const image_view<T>& depths, const forward_options<T>& options,
                           cell_rule rule, const count_map& map) {
    splat_result result;
    if (!fits(depths) || !fits(map)) {
        result.flags = status::buffer_too_small;
        return result;
    }
    importance_options<T> functions = options.importance;
    functions.normal = false;
    const T near_ndc = near_depth<T>(options.camera);
    const T far_ndc = far_depth<T>(options.camera);
    for (int j = 0; j < depths.height; ++j) {
        const T v = (T(j) + T(0.5)) / T(depths.height);
        for (int i = 0; i < depths.width; ++i) {
            const T u = (T(i) + T(0.5)) / T(depths.width);
            const detail::neighbourhood<T> n = detail::neighbours_of(depths, i, j);
            const bool edge =
                functions.edge && depth_edge(n.centre, n.ring0, n.ring1, options.bias);
            const T share = edge ? T(1) : T(0);
            const glm::vec<4, T> clip =
                options.camera_from_map * glm::vec<4, T>(u, v, n.centre, T(1));
            const T weight =
                n.centre == options.empty_depth
                    ? T(0)
                    : forward_importance(clip, near_ndc, far_ndc, share, T(0), functions);
            const auto cell = static_cast<std::size_t>(cell_of(v, map.height)) *
                                  static_cast<std::size_t>(map.width) +
                              static_cast<std::size_t>(cell_of(u, map.width));
            detail::add_sample(weight, options.steps, rule, cell, map, result);
        }
    }
    return result;
}

} // namespace warpshadow
