// Minimal shadow frustum: the smallest map around what the view sees, in a frame that does not
// jump.
//
// Milet et al. 2015 §3.2. For spot and point lights the rectangle is found in the plane of slopes
// (x / z, y / z): what is a rectangle there is a pyramid from the light, and shares of its area are
// shares of the map, as for directional lights.
#pragma once

#include <warpshadow/calipers.hpp>
#include <warpshadow/detail/light_view.hpp>
#include <warpshadow/focus.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/stable_fit.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace warpshadow {

/// Which way the map's sides run.
enum class fit_frame {
    fixed,          ///< along the axes of `light_frame`
    rotated_minimal ///< along the smallest rectangle, when that pays and no faster than allowed
};

/// What a minimal shadow frustum is asked for.
template <typename T> struct fit_options {
    fit_frame frame = fit_frame::fixed;
    clip_space clip{};
    glm::vec<2, int> map_size{1024, 1024}; ///< texels
    T margin = T(0); ///< texels kept free at each border, for the radius of a filter
    /// Texels on a fixed grid of the light's plane; sizes in steps of 1/8 or less.
    bool snap = false;
    /// Share of the area that turning by 45° must gain; turning by less needs less, down to half.
    T hysteresis = T(0.05);
    T slew = T(0.00436332312998582394); ///< largest rotation per call in radians: 0.25°
    T least_near = T(0); ///< spot, point: casters nearer to the light than that may be cut off
    /// World space; positions given to the matrix are relative to it. Give the eye for T = float
    /// and scenes far from the world's origin.
    glm::vec<3, T> origin{T(0)};
};

/// What is kept from one frame to the next: one per light and view, initially default.
struct fit_state {
    double angle = 0.0; ///< of the map's side to the light's right axis, radians, in [-pi, pi]
    bool started = false;
    bool turning = false;                  ///< on the way to the smallest rectangle
    glm::vec<2, double> snapped{0.0, 0.0}; ///< extents in use for snapping; 0 for none
};

/// A minimal shadow frustum, and what it leaves unused.
template <typename T> struct shadow_fit {
    glm::mat<4, 4, T> matrix; ///< positions relative to `origin` to clip space
    T angle;                  ///< of the map's u axis to the light's right axis, radians
    T wasted_area;            ///< share of the map outside the receivers' footprint, 0 to 1
    T excess_area;            ///< area of the map over that of the smallest rectangle, minus 1
    /// The map's rectangle in the light's plane (see `light_view`), in double: centre and half
    /// sides along the turned axes, relative to the eye or the light.
    glm::vec<2, double> centre, half_extents;
    double near_distance, far_distance; ///< along the light's axis, from the eye or the light
    texel_span x, y;                    ///< the map's place on the grid if snapped
    status flags;
};

namespace detail {

/// Bounds of points along axes turned by an angle.
struct turned_bounds {
    glm::dvec2 lo, hi;
    double area() const { return (hi.x - lo.x) * (hi.y - lo.y); }
};

inline turned_bounds bounds_at(std::span<const glm::dvec2> points, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    turned_bounds b{glm::dvec2(std::numeric_limits<double>::max()),
                    glm::dvec2(-std::numeric_limits<double>::max())};
    for (const glm::dvec2& p : points) {
        const glm::dvec2 q(c * p.x + s * p.y, c * p.y - s * p.x);
        b.lo = glm::min(b.lo, q);
        b.hi = glm::max(b.hi, q);
    }
    return b;
}

inline constexpr double quarter = 1.57079632679489661923;

/// Turns the state towards a smaller rectangle.
///
/// No rule without a memory is continuous: a regular polygon of n corners would need an axis that
/// its rotation by 360° / n maps to itself up to quarters. So the angle is kept while no rectangle
/// gains enough, and turned by the slew at most. Enough is the hysteresis for one that is 45° away,
/// and half of it for one that is near: the way costs area too, and so does turning back. Over yaws
/// of 3600 frames the map exceeds the smallest one by a third less than if it headed for the
/// smallest rectangle, wherever it is, whenever that gains the hysteresis.
inline void turn(fit_state& state, std::span<const glm::dvec2> hull, double hysteresis,
                 double slew) {
    const oriented_rectangle<double> smallest = min_area_rectangle_of_hull(hull);
    const double wanted = std::atan2(smallest.axis.y, smallest.axis.x);
    const double area = bounds_at(hull, state.angle).area();
    if (!state.started) {
        state.angle = area - smallest.area > hysteresis * smallest.area ? wanted : 0.0;
        state.started = true;
        return;
    }
    const double half = 0.5 * hysteresis * smallest.area;
    const auto way_to = [&](double angle) { return std::remainder(angle - state.angle, quarter); };
    double way = way_to(wanted);
    double best = smallest.area + half * std::abs(way) / (0.5 * quarter);
    for (std::size_t i = 0; i < hull.size() && hull.size() > 2; ++i) {
        const glm::dvec2 side = hull[(i + 1) % hull.size()] - hull[i];
        const double angle = std::atan2(side.y, side.x);
        const double cost =
            bounds_at(hull, angle).area() + half * std::abs(way_to(angle)) / (0.5 * quarter);
        if (cost < best) {
            best = cost;
            way = way_to(angle);
        }
    }
    state.turning = state.turning || area - best > half;
    if (state.turning) {
        state.angle = std::remainder(state.angle + glm::clamp(way, -slew, slew), 4.0 * quarter);
        state.turning = std::abs(way) > slew;
    }
}

/// Widens sides to 2^-24 of the larger one, or of what else has a size.
inline status widen(glm::dvec2& half, const light_view& view, double extent) {
    double size = glm::max(half.x, half.y);
    if (!(size > 0.0)) {
        size = view.perspective ? 1.0 : (extent > 0.0 ? relative_floor * extent : 1.0);
        half = glm::dvec2(view.perspective ? relative_floor : size);
        return status::degenerate_extent;
    }
    const double least = relative_floor * size;
    const status flags = half.x < least || half.y < least ? status::degenerate_extent : status::ok;
    half = glm::max(half, glm::dvec2(least));
    return flags;
}

/// Extent to snap with: the one in use while it is large enough and not 4/3 of what is needed.
inline double kept_extent(double in_use, double needed) {
    return needed <= in_use && in_use <= needed * (4.0 / 3.0) ? in_use : quantised_length(needed);
}

} // namespace detail

/// Smallest map around the receivers in view: light matrix, frame, and the area it wastes.
///
/// `scene`: from `focus`. `options`: see there. `state`: of the previous frame; updated.
///
/// x and y hold the receivers' body, near the first caster that matters, far the last receiver:
/// receivers before the first caster have depths beyond near and are lit. Directional lights give
/// an orthographic matrix; spot and point lights a perspective one whose w is the distance along
/// the light's axis, for which the body must lie in front of the light.
///
/// Frame: `fixed`, or `rotated_minimal` with hysteresis and slew (see `fit_options`); the angle of
/// the first call is the one of the smallest rectangle if that pays, else 0. Equal areas are told
/// apart as by `min_area_rectangle`.
/// Snapping: as long as the sizes stay within their step, a point keeps its texel of the grid of
/// the light's plane (`stable_fit.hpp`); the frame must be at rest for that.
///
/// No footprint (`empty_body`, `unbounded`, `light_inside_body`, `invalid_input`: as `focus` says):
/// the identity and those flags; the state is left alone.
/// - `degenerate_extent`: the body or a side of it was widened to 2^-24 of the largest;
/// - `near_clamped`: a caster at or behind the light, or nearer than `least_near` or far·2^-20;
/// - `out_of_range`: a margin or map size without a texel left over: the margin is ignored or cut;
///   or entries that T cannot hold: the identity.
/// Entries are within a few ulp of T of those of the rectangle and distances that are returned; the
/// last column within a few ulp of the distance from `origin` to the eye or the light.
template <typename T>
shadow_fit<T> minimal_shadow_frustum(const focus_result& scene, const fit_options<T>& options,
                                     fit_state& state) {
    using detail::dvec3;
    const light_view& view = scene.view;
    shadow_fit<T> fit{glm::mat<4, 4, T>(T(1)),
                      T(0),
                      T(1),
                      T(0),
                      glm::dvec2(0.0),
                      glm::dvec2(1.0),
                      0.0,
                      1.0,
                      {},
                      {},
                      scene.flags};
    const dvec3 origin(options.origin);
    if (!detail::all_finite(origin)) {
        fit.flags |= status::invalid_input;
    }
    if (scene.footprint_count == 0 || any(fit.flags, status::invalid_input)) {
        return fit;
    }
    const std::span<const glm::dvec2> hull(scene.footprint.data(), scene.footprint_count);
    if (options.frame == fit_frame::rotated_minimal) {
        const double hysteresis = static_cast<double>(options.hysteresis);
        const double slew = static_cast<double>(options.slew);
        detail::turn(state, hull, hysteresis >= 0.0 ? hysteresis : 0.0, slew >= 0.0 ? slew : 0.0);
    } else {
        state.angle = 0.0;
        state.started = true;
        state.turning = false;
    }
    const double c = std::cos(state.angle);
    const double s = std::sin(state.angle);
    const dvec3 axes[2] = {c * view.right + s * view.up, c * view.up - s * view.right};
    const detail::turned_bounds bounds = detail::bounds_at(hull, state.angle);
    fit.centre = 0.5 * bounds.lo + 0.5 * bounds.hi;
    fit.half_extents = 0.5 * bounds.hi - 0.5 * bounds.lo;
    const double used = detail::polygon_area(hull);
    const double least = min_area_rectangle_of_hull(hull).area;
    fit.flags |= detail::widen(fit.half_extents, view, scene.volume.extent);

    // from the light, or from the eye for a directional light, to the origin of the matrix
    const dvec3 to_origin = (origin - scene.eye) - view.position;
    double margin = static_cast<double>(options.margin);
    if (!(margin >= 0.0)) {
        margin = 0.0;
        fit.flags |= status::out_of_range;
    }
    glm::dvec2 from_origin(0.0); // the centre, as seen from the origin
    for (glm::length_t k = 0; k < 2; ++k) {
        const int texels = options.map_size[k];
        const double size = static_cast<double>(texels);
        double free = margin;
        if (texels < 1 || 2.0 * margin > size - 1.0) {
            free = texels < 1 ? 0.0 : 0.5 * (size - 1.0);
            fit.flags |= margin > 0.0 || texels < 1 ? status::out_of_range : status::ok;
        }
        const double shift = view.perspective ? 0.0 : glm::dot(axes[k], to_origin);
        const bool snaps = options.snap && size - 1.0 - 2.0 * std::ceil(free) >= 1.0;
        if (options.snap && !snaps) {
            fit.flags |= status::out_of_range;
        }
        if (!snaps) {
            fit.half_extents[k] *= texels < 1 ? 1.0 : size / (size - 2.0 * free);
            from_origin[k] = fit.centre[k] - shift;
            continue;
        }
        const int border = static_cast<int>(std::ceil(free));
        state.snapped[k] = detail::kept_extent(state.snapped[k], 2.0 * fit.half_extents[k]);
        const double texel = texel_for(state.snapped[k], texels, border);
        // the grid begins at the world's origin, or at the light's axis
        const double eye_at = view.perspective ? 0.0 : glm::dot(axes[k], scene.eye);
        const texel_span span =
            snap_to_texels(fit.centre[k] - fit.half_extents[k] + eye_at, texel, border);
        fit.flags |= span.flags;
        fit.half_extents[k] = 0.5 * size * texel;
        const double centre = span.first * texel + fit.half_extents[k];
        fit.centre[k] = centre - eye_at;
        from_origin[k] = view.perspective ? centre : centre - glm::dot(axes[k], origin);
        (k == 0 ? fit.x : fit.y) = span;
    }
    const double area = 4.0 * fit.half_extents.x * fit.half_extents.y;
    fit.angle = static_cast<T>(state.angle);
    fit.wasted_area = static_cast<T>(glm::clamp(1.0 - used / area, 0.0, 1.0));
    fit.excess_area = least > 0.0 && detail::fits<T>(area / least - 1.0)
                          ? static_cast<T>(area / least - 1.0)
                          : std::numeric_limits<T>::max();

    double begin = scene.nearest_caster;
    double end = scene.farthest_receiver;
    const double signs[2] = {1.0, options.clip.y_down ? -1.0 : 1.0};
    glm::dvec4 rows[4];
    if (!view.perspective) {
        fit.flags |= detail::separate_depths(begin, end, 0.0);
        for (glm::length_t k = 0; k < 2; ++k) {
            const double scale = signs[k] / fit.half_extents[k];
            rows[k] = glm::dvec4(axes[k] * scale, -from_origin[k] * scale);
        }
        const double d0 = near_depth<double>(options.clip);
        const double scale = (far_depth<double>(options.clip) - d0) / (end - begin);
        rows[2] = glm::dvec4(view.forward * scale,
                             d0 + (glm::dot(view.forward, to_origin) - begin) * scale);
        rows[3] = glm::dvec4(0.0, 0.0, 0.0, 1.0);
    } else {
        const double wanted = static_cast<double>(options.least_near);
        const double lowest =
            glm::max(detail::near_floor * end, wanted > 0.0 ? glm::min(wanted, end) : 0.0);
        if (!(begin >= lowest)) {
            begin = lowest;
            fit.flags |= status::near_clamped;
        }
        const volume_result<double> repaired =
            detail::repaired(view_volume<double>{-1.0, 1.0, -1.0, 1.0, begin, end, false});
        begin = repaired.volume.near_distance;
        end = repaired.volume.far_distance;
        fit.flags |= repaired.flags;
        const detail::depth_row depth = detail::depth_row_of(repaired.volume, options.clip);
        for (glm::length_t k = 0; k < 2; ++k) {
            const dvec3 row =
                (axes[k] - fit.centre[k] * view.forward) * (signs[k] / fit.half_extents[k]);
            rows[k] = glm::dvec4(row, glm::dot(row, to_origin));
        }
        const double ahead = glm::dot(view.forward, to_origin);
        rows[2] = glm::dvec4(view.forward * depth.scale, depth.offset + ahead * depth.scale);
        rows[3] = glm::dvec4(view.forward, ahead);
    }
    fit.near_distance = begin;
    fit.far_distance = end;
    const light_matrix_result<T> made = detail::matrix_from_rows<T>(rows, fit.flags);
    fit.matrix = made.matrix;
    fit.flags = made.flags;
    return fit;
}

/// The same for a single frame, with nothing kept.
template <typename T>
shadow_fit<T> minimal_shadow_frustum(const focus_result& scene, const fit_options<T>& options) {
    fit_state state;
    return minimal_shadow_frustum(scene, options, state);
}

} // namespace warpshadow
