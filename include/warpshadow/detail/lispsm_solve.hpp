// The numbers of a LiSPSM map, in double: axis, strength, w over the body, and the fit.
#pragma once

#include <warpshadow/clip_space.hpp>
#include <warpshadow/detail/direction.hpp>
#include <warpshadow/detail/lanes.hpp>
#include <warpshadow/detail/plane_warp.hpp>
#include <warpshadow/detail/seen_body.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/status.hpp>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <span>

namespace warpshadow::detail {

/// rho is kept within this: e^24 is more than any depth buffer or float resolves.
inline constexpr double largest_rho = 24.0;

/// ln(a / b) of positive numbers, accurate where they nearly agree.
template <typename T> T log_ratio(T a, T b) {
    return a >= b ? std::log1p((a - b) / b) : -std::log1p((b - a) / a);
}

/// See `rho_opt`.
template <typename T> T rho_of_ends(T z0, T z1, T W0, T W1) {
    return T(0.5) * log_ratio(z1, z0) - log_ratio(W1, W0);
}

/// What a map is wanted of.
template <typename T> struct lispsm_request {
    const frustum<T>& camera;
    const light<T>& source;
    const light_plane& plane;
    dvec3 mean; ///< of the points, for lights with a position
    std::span<const glm::vec<3, T>> body, casters;
    clip_space clip;
    T strength, visible_far, margin;
    bool middle; ///< whether the axis is Scherzer's middle vector
};

/// A map in double; with `flags` of `no_solution` there is none.
struct lispsm_solution {
    glm::dmat4 matrix, warp;
    double rho, inverse_near, fade;
    depth_warp depth;
    status flags;
    bool found = true;
};

inline lispsm_solution no_solution(status flags) {
    return lispsm_solution{glm::dmat4(1.0),           glm::dmat4(1.0), 0.0,  0.0, 0.0,
                           depth_warp{1.0, 0.0, 0.0}, flags,           false};
}

template <typename T, typename Fade>
lispsm_solution solve_lispsm(const lispsm_request<T>& request, const Fade& fade) {
    status flags = status::ok;
    const light_plane& plane = request.plane;
    const bool directional = request.source.kind == light_kind::directional;
    const bool orthographic = request.camera.volume.orthographic;
    const dvec3 position = dvec3(request.source.position) - dvec3(request.camera.eye);
    const dvec3 view(request.camera.forward);
    const dvec3 travel = directional ? dvec3(request.source.direction) : request.mean - position;
    seen_body<T> seen(request.body, plane, view);

    // bounds, and a centre for the fit: the mean of the points over their eye depth
    using lane = seen_points::lane;
    const double nearest = static_cast<double>(request.camera.volume.near_distance);
    lane_interval depths;
    lane_interval distances;
    lane sums[6] = {};
    seen.for_each([&](const seen_points& p) {
        for (int i = 0; i < p.count; i += native_lanes) {
            const lane depth = seen_points::get(p.depth, i);
            const lane distance = seen_points::get(p.distance, i);
            depths.add(depth);
            distances.add(distance);
            lane weight = seen_points::get(p.present, i);
            if (!orthographic) {
                weight = weight * nearest / (depth > nearest ? depth : nearest + 0.0 * depth);
            }
            const lane share = weight * distance;
            sums[0] += share * seen_points::get(p.x, i);
            sums[1] += share * seen_points::get(p.y, i);
            sums[2] += share * seen_points::get(p.z, i);
            sums[3] += share;
            sums[4] += weight;
            sums[5] += 0.0 * depth;
        }
    });
    const interval depth = depths.bounds();
    const interval distance = distances.bounds();
    const double weights = sum_of_lanes(sums[4]);
    const glm::dvec4 sum(sum_of_lanes(sums[0]), sum_of_lanes(sums[1]), sum_of_lanes(sums[2]),
                         sum_of_lanes(sums[3]));
    if (!std::isfinite(sum_of_lanes(sums[5]))) {
        return no_solution(check_points(request.body));
    }
    // the light's plane must not cut the body
    if (!(distance.lo > relative_floor * distance.hi) || !is_direction(travel)) {
        return no_solution(status::light_inside_body);
    }
    if (!std::isfinite(sum.x + sum.y + sum.z + sum.w)) {
        return no_solution(check_points(request.body));
    }
    plane_warp warp{glm::dvec2(0.0), 1.0, glm::dvec2(sum) / sum.w};
    const double middle_depth = sum.z / sum.w;
    if (!orthographic && !(depth.lo > 0.0)) {
        flags |= status::near_clamped;
    }

    // axis: across the light, along the view or Scherzer's middle vector
    const dvec3 l = unit_of(travel);
    dvec3 axis = view;
    if (request.middle) {
        const dvec3 towards_body = sum_of(request.body);
        axis = is_direction(towards_body) ? unit_of(towards_body) : view;
    }
    const dvec3 g = glm::cross(l, glm::cross(axis, l));
    const double gg = glm::dot(g, g);
    const double sine = std::sqrt(gg);
    double outside = 0.0;
    if (directional) {
        outside = smaller(outside_view_cone(request.camera, l), sine);
    } else if (is_direction(position)) {
        outside = smaller(outside_view_cone(request.camera, unit_of(position)), sine);
    }
    const double kept = bounded(fade(outside), 0.0, 1.0);

    // extent along the axis, as far as it is visible: in the image plane and in the scene
    const glm::dvec2 slope = image_slope(plane, warp.centre, sum.w / weights, g);
    const double z0 = larger(depth.lo, nearest);
    const double last = larger(static_cast<double>(request.visible_far), z0);
    interval t;
    double extent = 0.0;
    if (depth.hi <= last && plane.affine()) {
        lane_interval across;
        seen.for_each([&](const seen_points& p) {
            for (int i = 0; i < p.count; i += native_lanes) {
                across.add(slope.x * seen_points::get(p.x, i) + slope.y * seen_points::get(p.y, i));
            }
        });
        t = across.bounds();
        extent = t.length();
    } else {
        interval swept;
        seen.for_each_visible(last, [&](const dvec3& p, const seen_point& q) {
            t.add(slope.x * q.x + slope.y * q.y);
            swept.add(glm::dot(g, p));
        });
        extent = swept.length();
    }
    const double reach = larger(std::abs(depth.lo), std::abs(depth.hi));
    const bool flat = !(extent > 0x1p-40 * sine * reach) || !(t.length() > 0.0);

    // strength
    double rho = 0.0;
    double inverse_near = 0.0;
    if (orthographic) {
        flags |= status::no_perspective;
    } else if (!(kept > 0.0)) {
        flags |= status::light_in_view;
    } else if (flat) {
        flags |= status::degenerate_extent;
    } else {
        // eye depth gained along the axis, per unit of g
        const double along = request.middle ? larger(glm::dot(view, g) / gg, 0.0) : 1.0;
        const double share = kept * bounded(request.strength, 0.0, 2.0);
        const double q = along * extent / z0;
        const double best = directional
                                ? 0.5 * std::log1p(q)
                                : rho_between_ends(seen, slope, last, z0, t, rho_of_ends<double>);
        rho = larger(smaller(share * best, largest_rho), -largest_rho);
        // e^|rho| - 1; sqrt(1 + q) - 1 where nothing weakens it
        const double growth = directional && share == 1.0 && rho < largest_rho
                                  ? q / (1.0 + std::sqrt(1.0 + q))
                                  : std::expm1(std::abs(rho));
        const double k = std::copysign(growth / t.length(), rho);
        warp.slope = k * slope;
        inverse_near = std::abs(k) * sine;
        // the near plane of the textbooks' P lies at the body: w = 1 there, never at the eye
        lane_interval h;
        seen.for_each([&](const seen_points& p) {
            for (int i = 0; i < p.count; i += native_lanes) {
                h.add(warp.slope.x * seen_points::get(p.x, i) +
                      warp.slope.y * seen_points::get(p.y, i));
            }
        });
        warp.constant = 1.0 - h.bounds().lo;
    }
    flags |= rho == 0.0 ? status::stayed_uniform : status::ok;

    // the fit
    lane_interval xs;
    lane_interval ys;
    lane_interval zs;
    seen.for_each([&](const seen_points& p) {
        for (int i = 0; i < p.count; i += native_lanes) {
            const lane px = seen_points::get(p.x, i);
            const lane py = seen_points::get(p.y, i);
            const lane scale = 1.0 / (warp.constant + warp.slope.x * px + warp.slope.y * py);
            xs.add((px - warp.centre.x) * scale);
            ys.add((py - warp.centre.y) * scale);
            zs.add((seen_points::get(p.z, i) - middle_depth) * scale);
        }
    });
    interval x = xs.bounds();
    interval y = ys.bounds();
    interval z = zs.bounds();
    for (const glm::vec<3, T>& point : request.casters) {
        const seen_point p = seen.see(dvec3(point));
        const double deep = (p.z - middle_depth) / larger(warp.w(glm::dvec2(p.x, p.y)), 1.0);
        if (p.distance > 0.0 && std::isfinite(deep)) {
            z.add(deep);
        }
    }
    double side = larger(x.length(), y.length());
    side = side > 0.0 ? side : plane.unit;
    const bool widened_x = x.widen(relative_floor * side);
    const bool widened_y = y.widen(relative_floor * side);
    const double deep = larger(larger(std::abs(z.lo), std::abs(z.hi)),
                               larger(std::abs(middle_depth), plane.depth_unit));
    const bool widened_z = z.widen(relative_floor * deep);
    if (widened_x || widened_y || widened_z) {
        flags |= status::degenerate_extent;
    }
    const double margin = bounded(request.margin, 0.0, 0.25);
    if (margin > 0.0) {
        x.grow(margin / (1.0 - 2.0 * margin));
        y.grow(margin / (1.0 - 2.0 * margin));
    }
    const depth_warp fitted = depth_fit(z, middle_depth, request.clip);
    const fitted_warp done(warp, x, y, fitted);
    return lispsm_solution{done.rows_of(plane.x, plane.y, plane.z, plane.w),
                           done.matrix(),
                           rho,
                           inverse_near,
                           kept,
                           fitted,
                           flags};
}

} // namespace warpshadow::detail
