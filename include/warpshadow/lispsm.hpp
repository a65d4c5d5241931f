// Light space perspective shadow maps (Wimmer et al. 2004, Scherzer 2005) without a singularity.
//
// A perspective transform of the light's image plane gives texels to what is near the eye. The
// textbooks place its frustum by the distance n to its near plane, which is infinite where view and
// light direction meet, along an axis that has no limit there. Here it is one linear function
//
//     w(p) = 1 + h·p - min over the body of h·p,    h = g·(e^rho - 1) / extent of the body along g,
//     g = L × (V × L),    rho = fade · strength · ½ ln(z1 / z0),
//
// and everything is continuous, 0 and uniform where L and V meet: |h| = 1 / n and rho = ln(f / n).
// w ≥ 1 over the whole body, so no shadow can vanish. rho = 0 is the uniform map, ½ ln(z1 / z0) is
// LiSPSM, ln(z1 / z0) perspective shadow maps (Stamminger and Drettakis 2002).
#pragma once

#include <warpshadow/clip_space.hpp>
#include <warpshadow/detail/direction.hpp>
#include <warpshadow/detail/finite.hpp>
#include <warpshadow/detail/lispsm_solve.hpp>
#include <warpshadow/detail/plane_warp.hpp>
#include <warpshadow/detail/seen_body.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/status.hpp>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <limits>
#include <span>

namespace warpshadow {

/// 1 / n for the best near distance n, n = (z0 + sqrt(z0·z1)) / sin γ (Wimmer et al. 2004).
///
/// The inverse, as n is infinite where light and view direction meet. Accurate to 4 ulp.
/// `z0`, `z1`: eye depths, 0 < z0, at the two ends of the body along the warp's axis: z1 is
/// z0 + d·sin γ for a directional light and a body of extent d (and not z0 + d, as eq. 1 of
/// Scherzer 2005 is easily read).
/// `sin_gamma`: sine of the angle between light and view direction, 0 to 1.
template <typename T> T inverse_n_opt(T z0, T z1, T sin_gamma) {
    return sin_gamma / (z0 + std::sqrt(z0) * std::sqrt(z1));
}

/// The same as 1 / n, n = d / (sqrt(z1 / z0) - 1) (Wimmer and Scherzer 2006), without cancellation.
///
/// Equal to `inverse_n_opt` if z1 = z0 + d·sin γ. Accurate to 5 ulp of z1 - z0.
/// `d`: extent of the body along the warp's axis, d > 0.
template <typename T> T inverse_n_opt_2006(T z0, T z1, T d) {
    return (z1 - z0) / (d * (z0 + std::sqrt(z0) * std::sqrt(z1)));
}

/// rho = ln(1 + d / n) of the best warp, ½ ln(z1·W0² / (z0·W1²)), for lights with a position.
///
/// Equalises texel size over eye depth at the two ends of a receiver line. A length on the line is
/// worth 1 / W² of the image plane at distance W from the light along its axis, so W0 and W1 weigh
/// the depths; with W0 = W1 it is LiSPSM. Negative values are right where the light spends enough
/// texels on the near end by itself.
/// `z0`, `z1`: eye depths at the two ends, positive.
/// `W0`, `W1`: distances from the light along its axis, positive.
template <typename T> T rho_opt(T z0, T z1, T W0, T W1) {
    return detail::rho_of_ends(z0, z1, W0, W1);
}

/// Largest displacement in the map, as a share of it, that a warp of strength rho causes.
template <typename T> T warp_displacement(T rho) {
    return std::tanh(T(0.25) * std::abs(rho));
}

/// Whether a warp moves anything by more than `tolerance` texels of a map of `size`, and gains more
/// than 5 %: texels shrink by the factor e^rho at most.
template <typename T> bool worth_warping(T rho, int size, T tolerance = T(1)) {
    return warp_displacement(rho) * T(size) > tolerance && std::abs(rho) > std::log(T(1.05));
}

/// Default fade: 0 while the light is inside the view cone, 1 from an angle of 12 degrees outside.
///
/// Inside the cone every warp of the family makes the largest texel error larger. The fade acts on
/// rho, so the map moves by a speed that grows with the logarithm of far / near alone.
struct cone_fade {
    double full_sine = 0.20791169081775934; ///< sine of the angle where the warp is complete

    /// `outside`: sine of the angle by which the light, or the point opposite to it, whichever is
    /// nearer, lies outside the view cone; 0 or less inside.
    double operator()(double outside) const {
        // a ramp with its ends rounded off: its slope, the speed of the map, is 5/4 where that of
        // the usual cubic is 3/2
        const double t = detail::bounded(outside / full_sine, 0.0, 1.0);
        const double end = 0.2;
        const double slope = 1.0 / (1.0 - end);
        if (t < end) {
            return 0.5 * slope / end * t * t;
        }
        if (t > 1.0 - end) {
            return 1.0 - 0.5 * slope / end * (1.0 - t) * (1.0 - t);
        }
        return slope * (t - 0.5 * end);
    }
};

/// Where the axis of the warp comes from.
enum class lispsm_axis {
    view,  ///< the view direction
    middle ///< Scherzer's middle vector, from the eye to the mean of the body's points
};

/// What can be asked of LiSPSM; the defaults need no tuning.
template <typename T> struct lispsm_options {
    T strength = T(1); ///< factor on rho, clamped to 0..2: 0 uniform, 1 LiSPSM, 2 perspective maps
    lispsm_axis axis = lispsm_axis::view;
    /// Farthest visible depth, from a visibility algorithm (Scherzer 2005, §4.4): it chooses the
    /// strength but does not cut the body, so that casters beyond it keep their shadows.
    T visible_far = std::numeric_limits<T>::infinity();
    T margin = T(0); ///< share of the map left free at each side, for a filter; 0 to 1/4
    /// Points that the depth range must hold besides the body: casters towards the light, on the
    /// light rays through the body. Relative to the eye.
    std::span<const glm::vec<3, T>> casters = {};
};

/// A warped light matrix and how it came about.
template <typename T> struct lispsm_result {
    glm::mat<4, 4, T> matrix; ///< positions relative to the eye to clip space: warp · light
    glm::mat<4, 4, T> warp;   ///< to be multiplied from the left to the light's matrix
    T rho;                    ///< strength, 0 if uniform; w runs from 1 to e^|rho| over the body
    T inverse_near;           ///< 1 / n of the textbooks for directional lights, 0 if uniform
    T fade;                   ///< 0 to 1: what the fade left of the strength
    T depth_scale;            ///< NDC depth is depth_scale · (z - depth_centre) / w + depth_shift
    T depth_shift;            ///< for the light's own NDC depth z and the warp's w: see
    T depth_centre;           ///< `linear_depth`
    status flags;
};

namespace detail {

/// No warp: the light's matrix as it is, or the identity if T cannot hold it.
template <typename T> lispsm_result<T> no_warp(const glm::dmat4& light_matrix, status flags) {
    const glm::mat<4, 4, T> identity(T(1));
    return lispsm_result<T>{fits<T>(light_matrix) ? glm::mat<4, 4, T>(light_matrix) : identity,
                            identity,
                            T(0),
                            T(0),
                            T(0),
                            T(1),
                            T(0),
                            T(0),
                            flags | status::stayed_uniform};
}

/// The map of a light with these rows, rounded once.
template <typename T, typename Fade>
lispsm_result<T> warp_light(const frustum<T>& camera, const light<T>& source,
                            const light_plane& plane, const dvec3& mean,
                            std::span<const glm::vec<3, T>> body, clip_space clip,
                            const lispsm_options<T>& options, const Fade& fade) {
    const lispsm_solution map =
        solve_lispsm(lispsm_request<T>{camera, source, plane, mean, body, options.casters, clip,
                                       options.strength, options.visible_far, options.margin,
                                       options.axis == lispsm_axis::middle},
                     fade);
    if (!map.found) {
        return no_warp<T>(plane.matrix(), map.flags);
    }
    const glm::dvec4 numbers(map.depth.scale, map.depth.shift, map.depth.centre, map.inverse_near);
    if (!fits<T>(map.warp) || !fits<T>(map.matrix) || !fits<T>(numbers)) {
        return no_warp<T>(plane.matrix(), map.flags | status::out_of_range);
    }
    return lispsm_result<T>{glm::mat<4, 4, T>(map.matrix),
                            glm::mat<4, 4, T>(map.warp),
                            static_cast<T>(map.rho),
                            static_cast<T>(map.inverse_near),
                            static_cast<T>(map.fade),
                            static_cast<T>(map.depth.scale),
                            static_cast<T>(map.depth.shift),
                            static_cast<T>(map.depth.centre),
                            map.flags};
}

} // namespace detail

/// Warps the map of any light: LiSPSM as one matrix, to be multiplied from the left to the light's.
///
/// `camera`: from `make_frustum`.
/// `source`: world space; its direction may have any length. The direction of a spot light does not
/// matter here, a point light is a spot light that fills one face.
/// `light_matrix`: clip space from positions relative to the eye, made for `clip`: focused, rotated
/// or cropped as you like. For `float` and a directional light it costs accuracy to round it first:
/// `lispsm` does not.
/// `body`: points whose hull is the body to cover, relative to the eye: frustum and scene and what
/// else bounds the receivers.
/// `fade`: fade(s) is 0 to 1 for the sine s of the angle by which the light is outside the view
/// cone; see `cone_fade`.
///
/// The result covers the body: its bounds in the warped map are NDC -1..1 in x and y and the depth
/// range in z, and clip w has one sign over it, w ≥ 1 times the light's w. Depth stays monotone
/// along every light ray.
/// Light or its opposite in the view cone (`light_in_view`), an orthographic camera
/// (`no_perspective`) or a body without extent along the axis (`degenerate_extent`) give the
/// uniform map fitted to the body, `stayed_uniform`. A body at or behind the eye: z0 is the
/// camera's near distance, `near_clamped`. Extents below 2^-24 are widened, `degenerate_extent`.
/// No points (`empty_body`), infinite ones (`unbounded`), NaN or a zero direction
/// (`invalid_input`), a body that the light's plane w = 0 touches (`light_inside_body`), or entries
/// beyond T (`out_of_range`): `warp` is the identity and `matrix` the light's own.
///
/// For sunlight the default fade keeps the largest texel error over the view at or below that of
/// the uniform map, but for rare wide views with the light just outside them. For lights with a
/// position only the two ends of the body are weighed against each other: mostly a gain, but no
/// promise; `fit_projective` makes one.
/// Scaling all lengths by a power of two scales the columns of `matrix` and changes no bit.
template <typename T, typename Fade = cone_fade>
lispsm_result<T> lispsm_warp(const frustum<T>& camera, const light<T>& source,
                             const glm::mat<4, 4, T>& light_matrix,
                             std::span<const glm::vec<3, T>> body, clip_space clip,
                             const lispsm_options<T>& options = {}, const Fade& fade = {}) {
    const glm::dmat4 m(light_matrix);
    const status wrong = detail::check_scene(camera, source);
    if (!detail::fits<T>(m)) {
        lispsm_result<T> result = detail::no_warp<T>(m, wrong | status::invalid_input);
        result.matrix = light_matrix;
        return result;
    }
    if (wrong != status::ok || body.empty()) {
        return detail::no_warp<T>(m, body.empty() ? wrong | status::empty_body : wrong);
    }
    const glm::dmat4 rows = glm::transpose(m);
    const detail::light_plane plane{rows[0], rows[1], rows[2], rows[3], 1.0, 1.0, false};
    const detail::dvec3 mean = source.kind == light_kind::directional
                                   ? detail::dvec3(0.0)
                                   : detail::sum_of(body) / static_cast<double>(body.size());
    return detail::warp_light(camera, source, plane, mean, body, clip, options, fade);
}

/// The same with the axes of `light_frame`: a light matrix from nothing but the light and the body.
///
/// Built in double and rounded once. `float` matrix and arithmetic place a point within 0.01 texel
/// of a map of 2048 texels, at any angle between light and view.
/// A spot light's image plane is perpendicular to its axis, a point light's to the line from the
/// light to the mean of the body's points. `warp` applies to the matrix of those axes, which is not
/// fitted to anything; for a matrix of your own use `lispsm_warp`.
/// Where `lispsm_warp` returns the light's matrix, this returns that of the axes, or the identity
/// if there are none.
/// @see lispsm_warp for everything else
template <typename T, typename Fade = cone_fade>
lispsm_result<T> lispsm(const frustum<T>& camera, const light<T>& source,
                        std::span<const glm::vec<3, T>> body, clip_space clip,
                        const lispsm_options<T>& options = {}, const Fade& fade = {}) {
    using detail::dvec3;
    const status wrong = detail::check_scene(camera, source);
    if (wrong != status::ok || body.empty()) {
        return detail::no_warp<T>(glm::dmat4(1.0),
                                  body.empty() ? wrong | status::empty_body : wrong);
    }
    const bool directional = source.kind == light_kind::directional;
    const dvec3 position = dvec3(source.position) - dvec3(camera.eye);
    dvec3 mean(0.0);
    dvec3 ahead(source.direction);
    if (!directional) {
        mean = detail::sum_of(body) / static_cast<double>(body.size());
        ahead = source.kind == light_kind::point ? mean - position : ahead;
    }
    if (!detail::is_direction(ahead)) {
        const status flags =
            detail::all_finite(ahead) ? status::light_inside_body : detail::check_points(body);
        return detail::no_warp<T>(glm::dmat4(1.0), flags);
    }
    const dvec3 forward = detail::unit_of(ahead);
    const detail::frame axes = source.vertical == up_axis::y
                                   ? detail::frame_from_unit(forward)
                                   : detail::frame_from_unit_z_up(forward);
    const dvec3 up = clip.y_down ? -axes.up : axes.up;
    const double sign = clip.reversed_z ? -1.0 : 1.0;
    detail::light_plane plane{glm::dvec4(axes.right, 0.0),
                              glm::dvec4(up, 0.0),
                              glm::dvec4(sign * forward, 0.0),
                              glm::dvec4(0.0, 0.0, 0.0, 1.0),
                              1.0,
                              0.0,
                              directional};
    if (directional) {
        // a body that is a point needs a length from somewhere
        const double reach = detail::max_abs(dvec3(body[0]));
        const double least = static_cast<double>(camera.volume.near_distance);
        plane.unit = reach > 0.0 ? reach : (least > 0.0 ? least : 1.0);
        plane.depth_unit = plane.unit;
    } else {
        plane.x.w = -glm::dot(axes.right, position);
        plane.y.w = -glm::dot(up, position);
        plane.z = glm::dvec4(0.0, 0.0, 0.0, -sign); // z / w = -1 / distance
        plane.w = glm::dvec4(forward, -glm::dot(forward, position));
    }
    return detail::warp_light(camera, source, plane, mean, body, clip, options, fade);
}

} // namespace warpshadow
