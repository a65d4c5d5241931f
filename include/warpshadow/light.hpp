// Lights, their frames, and the uniform shadow-map matrix of each: the baseline that warps improve.
#pragma once

#include <warpshadow/conventions.hpp>
#include <warpshadow/detail/direction.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/status.hpp>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace warpshadow {

enum class light_kind { directional, spot, point };

/// The world's vertical axis; it decides where the light frame has its one jump.
enum class up_axis { y, z };

/// A light in world space; which members count depends on `kind`.
template <typename T> struct light {
    light_kind kind;
    glm::vec<3, T> position;  ///< spot and point
    glm::vec<3, T> direction; ///< directional and spot: the way the light travels, any length
    T cone_angle;             ///< spot: full angle in radians
    up_axis vertical = up_axis::y;
};

/// Sunlight that travels along `direction`, of any length.
///
/// Zero or non-finite directions are stored as zero, which the matrix functions report.
template <typename T> light<T> sun(const glm::vec<3, T>& direction) {
    const bool valid = detail::is_direction(detail::dvec3(direction));
    return light<T>{light_kind::directional, glm::vec<3, T>(T(0)),
                    valid ? direction : glm::vec<3, T>(T(0)), T(0)};
}

/// Spot light at `position` that points at `target`.
///
/// `cone_angle`: full angle in radians; checked by `spot_light_matrix`.
/// The direction has length 1; it is zero, which the matrix functions report, if `target` is at
/// `position` or one of them is not finite.
template <typename T>
light<T> spot_light(const glm::vec<3, T>& position, const glm::vec<3, T>& target, T cone_angle) {
    // halved, so that the difference of two finite positions is finite
    const detail::dvec3 ahead = 0.5 * detail::dvec3(target) - 0.5 * detail::dvec3(position);
    const bool valid = detail::is_direction(ahead);
    return light<T>{light_kind::spot, position,
                    valid ? glm::vec<3, T>(detail::unit(ahead)) : glm::vec<3, T>(T(0)), cone_angle};
}

/// Light that shines from `position` all around.
template <typename T> light<T> point_light(const glm::vec<3, T>& position) {
    return light<T>{light_kind::point, position, glm::vec<3, T>(T(0)), T(0)};
}

/// Orthonormal axes of a light: map right, map up, and the way the light travels.
template <typename T> struct light_frame_result {
    glm::vec<3, T> right, up, forward;
    status flags;
};

/// Frame of a light that travels along `direction`; right x up = -forward.
///
/// `direction`: world space, any length; a power of two as a factor changes no bit.
/// `vertical`: the world's vertical axis.
///
/// (+x, -z, -y), or (+x, +y, -z) if z is vertical, is the frame of light that falls straight down;
/// it is carried along the great circle to `direction`. No frame can be continuous over all
/// directions; this one has a single jump, at light that travels straight up, which sunlight never
/// does. Directions along the axes give frames along the axes, exactly.
/// Turning the direction by a small angle turns the frame by at most 1 / cos(a / 2) times that, a
/// being the angle to straight down: by at most 1.42 times for light from above the horizon.
/// Each component of an axis is within 1 ulp of 1 (T = float; 4 ulp for double).
/// A zero or non-finite direction gives the frame of light straight down and `invalid_input`.
template <typename T>
light_frame_result<T> light_frame(const glm::vec<3, T>& direction, up_axis vertical = up_axis::y) {
    detail::dvec3 f(direction);
    status flags = status::ok;
    if (!detail::is_direction(f)) {
        f = vertical == up_axis::y ? detail::dvec3(0.0, -1.0, 0.0) : detail::dvec3(0.0, 0.0, -1.0);
        flags = status::invalid_input;
    }
    f = detail::unit(f);
    const detail::frame axes =
        vertical == up_axis::y ? detail::frame_from_unit(f) : detail::frame_from_unit_z_up(f);
    return light_frame_result<T>{glm::vec<3, T>(axes.right), glm::vec<3, T>(axes.up),
                                 glm::vec<3, T>(axes.forward), flags};
}

/// A matrix and what had to be done to get it.
template <typename T> struct light_matrix_result {
    glm::mat<4, 4, T> matrix;
    status flags;
};

namespace detail {

/// Matrix with clip rows (across, across_0) and so on, rounded to T; the identity if T is too
/// small.
template <typename T>
light_matrix_result<T> matrix_from_rows(const glm::vec<4, double> (&rows)[4], status flags) {
    glm::mat<4, 4, double> m(0.0);
    for (glm::length_t row = 0; row < 4; ++row) {
        for (glm::length_t column = 0; column < 4; ++column) {
            m[column][row] = rows[row][column];
        }
    }
    if (!fits<T>(m)) {
        return light_matrix_result<T>{glm::mat<4, 4, T>(T(1)), flags | status::out_of_range};
    }
    return light_matrix_result<T>{glm::mat<4, 4, T>(m), flags};
}

} // namespace detail

/// Uniform map of a whole box lit by a directional light: positions relative to `origin` to clip
/// space.
///
/// `source`: directional.
/// `scene`: world space; holds casters and receivers.
/// `clip`: `left_handed` and `infinite_far` do not matter here.
/// `origin`: subtracted in double before anything is rounded; positions given to the matrix are
/// then relative to it. For T = float and a scene far from the world's origin choose a point near
/// the scene (or the eye): against world positions a float matrix is good to an ulp of that
/// distance only, whatever else is done.
///
/// The eight corners of the box span NDC in the axes of `light_frame`: x and y from edge to edge,
/// near plane where the box begins as seen from the light, far plane where it ends.
/// Entries are within 1 ulp of the exact matrix of the given box (T = float; 16 for double).
/// Extents below 2^-24 of the largest one are widened to that; a single point takes 2^-24 of its
/// largest coordinate, or 1 at the origin: `degenerate_extent`.
/// Another kind of light, a zero direction, an inverted box (`lo` > `hi`), NaN or infinity: the
/// identity and `invalid_input`. Entries that T cannot hold: the identity and `out_of_range`.
template <typename T>
light_matrix_result<T>
directional_light_matrix(const light<T>& source, const box3<T>& scene, clip_space clip,
                         const glm::vec<3, T>& origin = glm::vec<3, T>(T(0))) {
    using dvec3 = detail::dvec3;
    const light_matrix_result<T> invalid{glm::mat<4, 4, T>(T(1)), status::invalid_input};
    const light_frame_result<double> axes = light_frame(dvec3(source.direction), source.vertical);
    const dvec3 lo = dvec3(scene.lo) - dvec3(origin);
    const dvec3 hi = dvec3(scene.hi) - dvec3(origin);
    const bool upright = lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z; // false for NaN
    if (source.kind != light_kind::directional || axes.flags != status::ok || !upright ||
        !detail::all_finite(lo) || !detail::all_finite(hi)) {
        return invalid;
    }
    const dvec3 centre = 0.5 * lo + 0.5 * hi;
    const dvec3 half = 0.5 * hi - 0.5 * lo;
    status flags = status::ok;
    dvec3 middle(glm::dot(axes.right, centre), glm::dot(axes.up, centre),
                 glm::dot(axes.forward, centre));
    dvec3 reach(glm::dot(glm::abs(axes.right), half), glm::dot(glm::abs(axes.up), half),
                glm::dot(glm::abs(axes.forward), half));
    double size = detail::max_abs(reach);
    if (!(size > 0.0)) {
        const double away = detail::max_abs(centre);
        size = away > 0.0 ? detail::relative_floor * away : 1.0;
        reach = dvec3(size);
        flags |= status::degenerate_extent;
    }
    const double least = detail::relative_floor * size;
    for (glm::length_t i = 0; i < 3; ++i) {
        if (reach[i] < least) {
            reach[i] = least;
            flags |= status::degenerate_extent;
        }
    }
    const double d0 = near_depth<double>(clip);
    const double d1 = far_depth<double>(clip);
    const double slope = 0.5 * (d1 - d0) / reach.z;
    const double vertical = (clip.y_down ? -1.0 : 1.0) / reach.y;
    const glm::vec<4, double> rows[4] = {
        glm::vec<4, double>(axes.right / reach.x, -middle.x / reach.x),
        glm::vec<4, double>(axes.up * vertical, -middle.y * vertical),
        glm::vec<4, double>(axes.forward * slope, 0.5 * (d0 + d1) - middle.z * slope),
        glm::vec<4, double>(0.0, 0.0, 0.0, 1.0)};
    return detail::matrix_from_rows<T>(rows, flags);
}

/// Uniform map of a spot light's cone: positions relative to `origin` to clip space.
///
/// `source`: spot; the cone touches the four sides of the map.
/// `near_distance`, `far_distance`: along the light's axis; far may be infinity.
/// `clip`: `left_handed` does not matter here; `infinite_far` puts the far plane at infinity.
/// `origin`: as in `directional_light_matrix`.
///
/// Clip w is the distance from the light along its axis.
/// A cone angle outside [2^-20, pi - 2^-12] is clamped: `out_of_range`. near <= 0 becomes
/// far * 2^-20: `near_clamped`. far < near and far = near are repaired as in `make_projection`.
/// Another kind of light, a zero direction, NaN, an infinite position, or near <= 0 with an
/// infinite far distance: the identity and `invalid_input`. Entries that T cannot hold: the
/// identity and `out_of_range`.
template <typename T>
light_matrix_result<T> spot_light_matrix(const light<T>& source, T near_distance, T far_distance,
                                         clip_space clip,
                                         const glm::vec<3, T>& origin = glm::vec<3, T>(T(0))) {
    using dvec3 = detail::dvec3;
    const light_matrix_result<T> invalid{glm::mat<4, 4, T>(T(1)), status::invalid_input};
    const light_frame_result<double> axes = light_frame(dvec3(source.direction), source.vertical);
    const dvec3 position = dvec3(source.position) - dvec3(origin);
    double angle = static_cast<double>(source.cone_angle);
    if (source.kind != light_kind::spot || axes.flags != status::ok || !std::isfinite(angle) ||
        !detail::all_finite(position)) {
        return invalid;
    }
    status flags = status::ok;
    const double narrowest = 0x1p-20;
    const double widest = 3.14159265358979323846 - 0x1p-12;
    if (angle < narrowest || angle > widest) {
        angle = angle < narrowest ? narrowest : widest;
        flags |= status::out_of_range;
    }
    const double slope = std::tan(0.5 * angle);
    const volume_result<double> checked = detail::repaired(
        view_volume<double>{-slope, slope, -slope, slope, static_cast<double>(near_distance),
                            static_cast<double>(far_distance), false});
    if (any(checked.flags, status::invalid_input)) {
        return invalid;
    }
    flags |= checked.flags;
    if (!detail::representable<T>(checked.volume)) {
        return light_matrix_result<T>{invalid.matrix, flags | status::out_of_range};
    }
    const detail::depth_row depth = detail::depth_row_of(checked.volume, clip);
    const double across = 1.0 / slope;
    const double upwards = clip.y_down ? -across : across;
    const double ahead = glm::dot(axes.forward, position);
    const glm::vec<4, double> rows[4] = {
        glm::vec<4, double>(axes.right * across, -glm::dot(axes.right, position) * across),
        glm::vec<4, double>(axes.up * upwards, -glm::dot(axes.up, position) * upwards),
        glm::vec<4, double>(axes.forward * depth.scale, depth.offset - ahead * depth.scale),
        glm::vec<4, double>(axes.forward, -ahead)};
    return detail::matrix_from_rows<T>(rows, flags);
}

} // namespace warpshadow
