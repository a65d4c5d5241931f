// How a light looks at a body: its axes, positions in its plane, and the axis of a point light.
#pragma once

#include <warpshadow/detail/direction.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/polytope.hpp>
#include <warpshadow/status.hpp>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace warpshadow {

/// A light's axes and where it is, in double, relative to the eye of the camera.
///
/// The light's plane is (right, up) for a directional light, in scene units, and the plane of
/// slopes (x / z, y / z) for the others.
struct light_view {
    glm::vec<3, double> right{1.0, 0.0, 0.0}, up{0.0, 0.0, -1.0}, forward{0.0, -1.0, 0.0};
    glm::vec<3, double> position{0.0}; ///< relative to the eye; the eye itself if directional
    bool perspective = false;          ///< spot and point
    bool in_front = false; ///< the whole receivers' body lies in front of the light's plane
    double widest_slope = std::numeric_limits<double>::infinity(); ///< that the spot's cone reaches
};

/// Coordinates of a point in the light's axes: right, up, distance along the light.
///
/// `p`: relative to the eye.
inline glm::vec<3, double> in_light_axes(const light_view& view, const glm::vec<3, double>& p) {
    const glm::vec<3, double> q = p - view.position;
    return {glm::dot(view.right, q), glm::dot(view.up, q), glm::dot(view.forward, q)};
}

} // namespace warpshadow

namespace warpshadow::detail {

/// Smallest cosine between a perspective light's axis and a point of the body: 2^-12. Slopes
/// beyond its inverse are no map any more.
inline constexpr double least_cosine = 0x1p-12;

/// Widest full angle of a spot whose cone is convex enough to clip by and to look along.
inline constexpr double widest_cone = 3.14159265358979323846 - 0x1p-11;

/// Magnitudes above 2^400 leave the range of double in products of four.
inline constexpr double largest_coordinate = 0x1p400;

/// Centre of the smallest cap of the unit sphere that holds all of some unit vectors.
///
/// Welzl's incremental algorithm for circles, on the sphere. If the vectors lie in no open half
/// space the answer is any unit vector: the caller measures the angles.
/// Precondition: at least one vector.
inline dvec3 cap_centre(std::span<const dvec3> u) {
    const double slack = 0x1p-40; // what the rounding of a cosine can make of a vector on the rim
    dvec3 centre = u[0];
    double cosine = 1.0;
    const auto outside = [&](std::size_t i) { return glm::dot(centre, u[i]) < cosine - slack; };
    const auto take = [&](const dvec3& axis, std::size_t on_rim) {
        if (is_direction(axis)) {
            centre = unit(axis);
            centre = glm::dot(centre, u[on_rim]) < 0.0 ? -centre : centre;
        } else {
            centre = u[on_rim];
        }
        cosine = glm::dot(centre, u[on_rim]);
    };
    for (std::size_t i = 1; i < u.size(); ++i) {
        if (!outside(i)) {
            continue;
        }
        take(u[i], i);
        for (std::size_t j = 0; j < i; ++j) {
            if (!outside(j)) {
                continue;
            }
            take(u[i] + u[j], i);
            for (std::size_t k = 0; k < j; ++k) {
                if (outside(k)) {
                    take(glm::cross(u[j] - u[i], u[k] - u[i]), i);
                }
            }
        }
    }
    return centre;
}

/// Position in the light's plane of a point in its axes with z > 0 (perspective) or any z.
///
/// Slopes that rounding carries out of a spot's cone are put back on it.
inline glm::dvec2 in_light_plane(const light_view& view, const dvec3& q) {
    if (!view.perspective) {
        return {q.x, q.y};
    }
    const glm::dvec2 slope(q.x / q.z, q.y / q.z);
    const double length = std::sqrt(glm::dot(slope, slope));
    return length > view.widest_slope ? slope * (view.widest_slope / length) : slope;
}

/// Sets the axes of the light; false if it is not a light.
template <typename T>
bool make_light_view(const light<T>& source, const dvec3& eye, light_view& view, bool& clips) {
    const double angle = static_cast<double>(source.cone_angle);
    view.perspective = source.kind != light_kind::directional;
    clips = source.kind == light_kind::spot && angle <= widest_cone;
    if (view.perspective) {
        view.position = dvec3(source.position) - eye;
        if (!all_finite(view.position) || max_abs(view.position) > largest_coordinate) {
            return false;
        }
    }
    if (source.kind == light_kind::point) {
        return true; // the axis follows from the body
    }
    const light_frame_result<double> axes = light_frame(dvec3(source.direction), source.vertical);
    view.right = axes.right;
    view.up = axes.up;
    view.forward = axes.forward;
    return axes.flags == status::ok && (source.kind == light_kind::directional || angle > 0.0);
}

/// For lights without a usable axis of their own: the one from which the body looks smallest.
template <std::size_t Planes>
void choose_axis(light_view& view, const convex_body<double, Planes>& body, up_axis vertical) {
    std::array<dvec3, convex_body<double, Planes>::capacity> towards;
    view.in_front = body.count > 0;
    for (std::size_t i = 0; i < body.count; ++i) {
        const dvec3 q = dvec3(body.vertices[i]) - view.position;
        if (!is_direction(q)) {
            view.in_front = false;
            return;
        }
        towards[i] = unit(q);
    }
    if (body.count == 0) {
        return;
    }
    const std::span<const dvec3> all(towards.data(), body.count);
    const light_frame_result<double> axes = light_frame(cap_centre(all), vertical);
    view.right = axes.right;
    view.up = axes.up;
    view.forward = axes.forward;
    for (const dvec3& u : all) {
        view.in_front = view.in_front && glm::dot(u, view.forward) >= least_cosine;
    }
}

} // namespace warpshadow::detail
