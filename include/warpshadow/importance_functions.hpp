// What a seen point is worth to the map: Rosen's importance functions, for host and device.
//
// Rosen 2012, §4.1 and §5. Each function gives a number that is zero where the map is not needed
// and larger where it is needed more. A combination of them is written once, as a function or a
// functor of the user's own, and used by `splat_weighted` on the host and, translated, in a shader.
// Milet et al. 2015 use the number of samples alone: an importance of 1.
//
// Analyse the camera without its sub-pixel jitter: with it the counts, and so the map, would move
// with every frame. Nothing here draws random numbers.
#pragma once

#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace warpshadow {

/// 1 inside the camera's view, 0 outside (Rosen 2012, §5.1).
///
/// @param clip position in the camera's clip space
/// @param near_ndc, far_ndc z/w of the planes that bound the view, in either order (`near_depth`,
///             `far_depth`)
/// @return     0 as well for w ≤ 0 and for NaN
template <typename T> T desired_view_importance(glm::vec<4, T> clip, T near_ndc, T far_ndc) {
    T lo = glm::min(near_ndc, far_ndc);
    T hi = glm::max(near_ndc, far_ndc);
    bool inside = clip.w > T(0) && glm::abs(clip.x) <= clip.w && glm::abs(clip.y) <= clip.w &&
                  clip.z >= lo * clip.w && clip.z <= hi * clip.w;
    return inside ? T(1) : T(0);
}

/// Importance by distance from the eye, from the camera's depth: 1 − z of OpenGL's NDC, for any
/// clip space (Rosen 2012, §5.2).
///
/// @param depth    z/w in the camera's NDC
/// @param near_ndc, far_ndc z/w of the near and the far plane; not equal
/// @return         2 at the near plane, 0 at the far plane, clamped beyond both; proportional to
///                 1/q − 1/f in between; 0 for NaN
template <typename T> T depth_importance(T depth, T near_ndc, T far_ndc) {
    T share = (far_ndc - depth) / (far_ndc - near_ndc);
    return share > T(0) ? T(2) * glm::min(share, T(1)) : T(0);
}

/// The same from the distance itself, which keeps its digits where 1 − z loses them.
///
/// 2 (n/q − n/f) / (1 − n/f). Without a far plane this is 2n/q: the size of a thing in the image.
/// @param eye_distance  q along the direction of view
/// @param near_distance n, positive
/// @param inverse_far   1/f, 0 for a view without a far plane; below 1/n
/// @return              in [0, 2]; distances below n, and NaN, count as n
template <typename T> T distance_importance(T eye_distance, T near_distance, T inverse_far) {
    T least = near_distance * inverse_far;
    T ratio = eye_distance > near_distance ? near_distance / eye_distance : T(1);
    return least < T(1) ? T(2) * glm::clamp((ratio - least) / (T(1) - least), T(0), T(1)) : T(0);
}

/// Whether a texel of a depth image differs from one of its eight neighbours by more than the bias
/// (Rosen 2012, §5.3).
///
/// True on both sides of a discontinuity. Give the texel's own depth for neighbours outside the
/// image. On a shadow mask of 0 and 1 with a bias of ½ it finds the edges of the seen shadows.
/// @param centre depth of the texel
/// @param ring0, ring1 depths of the eight neighbours, in any order; a NaN is no edge
/// @param bias   difference that is no edge yet, in units of the depths
template <typename T>
bool depth_edge(T centre, glm::vec<4, T> ring0, glm::vec<4, T> ring1, T bias) {
    bool first = glm::abs(ring0.x - centre) > bias || glm::abs(ring0.y - centre) > bias ||
                 glm::abs(ring0.z - centre) > bias || glm::abs(ring0.w - centre) > bias;
    bool second = glm::abs(ring1.x - centre) > bias || glm::abs(ring1.y - centre) > bias ||
                  glm::abs(ring1.z - centre) > bias || glm::abs(ring1.w - centre) > bias;
    return first || second;
}

/// Whether a shadow ends at a point, and across which axis of the map, from nine shadow tests.
///
/// The point's plane is compared with the light's depth image in the texel that holds the point and
/// in its eight neighbours (`shadow_end_at`). Where the answers differ a shadow ends, across their
/// gradient, and an axis needs texels only for what changes along it. Unlike an edge of the depth
/// image, an end is found only where the point itself may be tested wrongly: not on the caster that
/// throws the shadow, and not where one caster hides another.
/// @param below, level, above answers of three rows, each along u: 1 lit, 0 dark, or between
/// @return the unit vector along the gradient, without signs; one that is the same along both axes
///         where the answers differ and have no gradient; 0 where all nine agree; finite always
template <typename T>
glm::vec<2, T> shadow_end(glm::vec<3, T> below, glm::vec<3, T> level, glm::vec<3, T> above) {
    glm::vec<3, T> first = glm::clamp(below, T(0), T(1));
    glm::vec<3, T> second = glm::clamp(level, T(0), T(1));
    glm::vec<3, T> third = glm::clamp(above, T(0), T(1));
    glm::vec<3, T> along_u = first + second + third;
    glm::vec<3, T> along_v = third - first;
    T u = glm::abs(along_u.z - along_u.x);
    T v = glm::abs(along_v.x + along_v.y + along_v.z);
    // squares of very small numbers would vanish
    T steepest = glm::max(u, v);
    T scale = steepest > T(0) ? steepest : T(1);
    u = u / scale;
    v = v / scale;
    T slope = glm::sqrt(u * u + v * v);
    if (slope > T(0)) {
        return glm::vec<2, T>(u / slope, v / slope);
    }
    glm::vec<3, T> lo = glm::min(glm::min(first, second), third);
    glm::vec<3, T> hi = glm::max(glm::max(first, second), third);
    bool differ = glm::max(glm::max(hi.x, hi.y), hi.z) > glm::min(glm::min(lo.x, lo.y), lo.z);
    return glm::vec<2, T>(differ ? glm::sqrt(T(0.5)) : T(0));
}

/// 1 on a shadow edge, α without (Rosen 2012, §5.3: α = 0.001), and linear in between.
///
/// @param edge  0 or 1 from `depth_edge` on the light's depths, or on the shadows that were seen
///              last; a component of `shadow_end`; clamped to [0, 1], NaN counts as 0
/// @param alpha importance without an edge, in [0, 1]
template <typename T> T edge_importance(T edge, T alpha) {
    return edge > T(0) ? alpha + (T(1) - alpha) * glm::min(edge, T(1)) : alpha;
}

/// More for surfaces that face the viewer: 1 + β · clamp(−n · v, 0, 1) (Rosen 2012, §5.4: β = 2).
///
/// @param view_cosine −n · v: cosine between normal and the way back to the eye; NaN counts as 0
/// @param beta        what a surface seen head-on gets in addition, not negative
template <typename T> T normal_importance(T view_cosine, T beta) {
    return view_cosine > T(0) ? T(1) + beta * glm::min(view_cosine, T(1)) : T(1);
}

/// 1 for surfaces that face the light, 0 for those that are dark whatever the map says.
///
/// @param light_cosine n · l: cosine between normal and the way to the light; NaN counts as dark
/// @param least        cosine that is still dark, 0 for exactly edge-on
template <typename T> T lit_importance(T light_cosine, T least) {
    return light_cosine > least ? T(1) : T(0);
}

/// A point that the camera sees, as the analysis of a G-buffer knows it.
template <typename T> struct seen_point {
    glm::vec<2, T> p = glm::vec<2, T>(T(0)); ///< position in map space
    T eye_distance = T(1);                   ///< along the direction of view
    T view_cosine = T(1);                    ///< −n · v, see `normal_importance`
    T light_cosine = T(1);                   ///< n · l, see `lit_importance`
    T edge = T(0); ///< whether a shadow edge passes, see `edge_importance`
};

/// Which of the functions are combined, and how. The default is Milet's: count what faces the
/// light.
template <typename T> struct importance_options {
    bool distance = false;  ///< use `distance_importance`
    bool edge = false;      ///< use `edge_importance`
    bool normal = false;    ///< use `normal_importance`
    bool add = false;       ///< sum of those in use instead of their product (Rosen)
    T near_distance = T(1); ///< of the camera, positive
    T inverse_far = T(0);   ///< 1 / far distance of the camera, 0 for none
    T alpha = T(0.001);     ///< importance without an edge
    T beta = T(2);          ///< bonus for facing the viewer
    T least_cosine = T(0);  ///< n · l that still counts as dark; below −1 to count everything
};

/// Product or sum of the functions that are switched on; 1 if there are none.
///
/// @param distance, edge, normal values of the three functions
/// @param options  which of them count
template <typename T>
T combined_importance(T distance, T edge, T normal, const importance_options<T>& options) {
    T product = T(1);
    T sum = T(0);
    if (options.distance) {
        product *= distance;
        sum += distance;
    }
    if (options.edge) {
        product *= edge;
        sum += edge;
    }
    if (options.normal) {
        product *= normal;
        sum += normal;
    }
    bool any_of_them = options.distance || options.edge || options.normal;
    return options.add && any_of_them ? sum : product;
}

/// Importance of a seen point: backward analysis, and hybrid where `edge` comes from the light's
/// depth image (Rosen 2012, §4.1).
///
/// With `shadow_end` a point has an importance for either axis: ask twice.
/// Points that do not face the light get 0, whatever the combination.
/// @param point   the point
/// @param options functions and their constants
template <typename T>
T view_importance(const seen_point<T>& point, const importance_options<T>& options) {
    T distance =
        distance_importance(point.eye_distance, options.near_distance, options.inverse_far);
    T edge = edge_importance(point.edge, options.alpha);
    T normal = normal_importance(point.view_cosine, options.beta);
    return lit_importance(point.light_cosine, options.least_cosine) *
           combined_importance(distance, edge, normal, options);
}

/// Importance of a texel of the light's depth image: forward analysis (Rosen 2012, §4.1).
///
/// A surface hidden from the light is not in that image: a caster over the seen region takes its
/// texels. Backward analysis has no such hole.
/// @param clip     where the texel's surface is in the camera's clip space
/// @param near_ndc, far_ndc z/w of the camera's near and far plane
/// @param edge     0 or 1 from `depth_edge`
/// @param view_cosine −n · v if the normal is known, else 0
/// @param options  functions and their constants; `near_distance`, `inverse_far` and `least_cosine`
///                 are not used
/// @return         0 outside the camera's view
template <typename T>
T forward_importance(glm::vec<4, T> clip, T near_ndc, T far_ndc, T edge, T view_cosine,
                     const importance_options<T>& options) {
    T seen = desired_view_importance(clip, near_ndc, far_ndc);
    if (!(seen > T(0))) {
        return T(0);
    }
    T distance = depth_importance(clip.z / clip.w, near_ndc, far_ndc);
    return combined_importance(distance, edge_importance(edge, options.alpha),
                               normal_importance(view_cosine, options.beta), options);
}

} // namespace warpshadow
