// The camera's frustum from its parameters: corners, planes and view matrix, relative to the eye.
#pragma once

#include <warpshadow/conventions.hpp>
#include <warpshadow/detail/direction.hpp>
#include <warpshadow/status.hpp>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cmath>
#include <cstddef>

namespace warpshadow {

/// Axis-aligned box in world space; `lo` <= `hi` in each component.
template <typename T> struct box3 { glm::vec<3, T> lo, hi; };

/// A camera in world space: an orthonormal frame at the eye and the volume it sees.
///
/// `right` and `up` are those of the image, so right x up = -forward in a right-handed world and
/// +forward in a left-handed one. Made by `make_frustum` or `frustum_from_matrices`.
template <typename T> struct frustum {
    glm::vec<3, T> eye, right, up, forward;
    view_volume<T> volume;
};

/// A frustum and what had to be done to get it.
template <typename T> struct frustum_result {
    frustum<T> value;
    status flags;
};

/// Frustum of a camera that stands at `eye` and looks along `forward`.
///
/// `eye`: world space.
/// `forward`, `up_hint`: world space, any length; they need not be perpendicular.
/// `volume`: what the camera sees, see `make_projection` for what is repaired and how.
/// `left_handed_world`: the world's axes are left-handed (x right, y up, z ahead), which decides
/// where right is; the clip space has no part in it.
///
/// An up hint that is zero, not finite, or parallel to `forward` (angle below 2^-40 rad) is
/// replaced by the up axis of `light_frame(forward)`, a function of `forward` alone that is
/// continuous except at forward = +y: `up_replaced`. A zero or non-finite `forward` becomes -z, a
/// non-finite eye the origin, an unusable volume the neutral one: `invalid_input`.
/// Each component of an axis is within 1 ulp of 1 (T = float) or 4 ulp / sin(angle to the hint)
/// (double).
template <typename T>
frustum_result<T> make_frustum(const glm::vec<3, T>& eye, const glm::vec<3, T>& forward,
                               const glm::vec<3, T>& up_hint, const view_volume<T>& volume,
                               bool left_handed_world = false) {
    using dvec3 = detail::dvec3;
    const projection_result<T> projection = make_projection(volume, clip_space{});
    // an endless orthographic volume is a frustum like any other: only its projection is a problem
    const bool endless = any(projection.flags, status::unbounded);
    status flags = endless ? status::ok : projection.flags;
    dvec3 ahead(forward);
    if (!detail::is_direction(ahead)) {
        ahead = dvec3(0.0, 0.0, -1.0);
        flags |= status::invalid_input;
    }
    const dvec3 f = detail::unit(ahead);
    const dvec3 hint(up_hint);
    detail::frame axes = detail::frame_from_unit(f);
    if (!detail::is_direction(hint) || !detail::frame_from_up(f, hint, axes)) {
        flags |= status::up_replaced;
    }
    const dvec3 right = left_handed_world ? -axes.right : axes.right;
    frustum_result<T> result{frustum<T>{eye, glm::vec<3, T>(right), glm::vec<3, T>(axes.up),
                                        glm::vec<3, T>(f), projection.volume},
                             flags};
    if (!detail::all_finite(eye)) {
        result.value.eye = glm::vec<3, T>(T(0));
        result.flags |= status::invalid_input;
    }
    return result;
}

/// Frustum of a camera that is known by its two matrices.
///
/// `view`: world space to view space, affine; rows perpendicular to 2^-10, of any length (a scaled
/// view space is turned back into world units), right- or left-handed.
/// `projection`: view space to clip space, see `volume_from_projection` for what it may be.
/// `clip`: the convention both were made for.
///
/// The eye is that of the matrix as given. A float view matrix far from the origin holds it only to
/// an ulp of its translation: give double, or a view matrix relative to a point nearby.
/// A `view` that is not such a matrix gives the canonical camera (eye at the origin, looking along
/// -z) and `invalid_input`, or `not_invertible` if it is singular; what is wrong with `projection`
/// is reported as by `volume_from_projection`.
template <typename T>
frustum_result<T> frustum_from_matrices(const glm::mat<4, 4, T>& view,
                                        const glm::mat<4, 4, T>& projection, clip_space clip) {
    using dvec3 = detail::dvec3;
    const volume_result<T> seen = volume_from_projection(projection, clip);
    const glm::mat<4, 4, double> m(view);
    frustum_result<T> result{frustum<T>{glm::vec<3, T>(T(0)), glm::vec<3, T>(T(1), T(0), T(0)),
                                        glm::vec<3, T>(T(0), T(1), T(0)),
                                        glm::vec<3, T>(T(0), T(0), T(-1)), seen.volume},
                             seen.flags};
    const bool affine = detail::fits<double>(m) && m[0][3] == 0.0 && m[1][3] == 0.0 &&
                        m[2][3] == 0.0 && m[3][3] != 0.0;
    if (!affine) {
        result.flags |= status::invalid_input;
        return result;
    }
    const double w = m[3][3];
    const dvec3 rows[3] = {dvec3(m[0][0], m[1][0], m[2][0]) / w,
                           dvec3(m[0][1], m[1][1], m[2][1]) / w,
                           dvec3(m[0][2], m[1][2], m[2][2]) / w};
    for (const dvec3& row : rows) {
        if (!detail::is_direction(row)) {
            result.flags |= status::not_invertible;
            return result;
        }
    }
    const dvec3 x = detail::unit(rows[0]);
    const dvec3 y = detail::unit(rows[1]);
    const dvec3 z = detail::unit(rows[2]);
    const double lengths[3] = {glm::dot(rows[0], x), glm::dot(rows[1], y), glm::dot(rows[2], z)};
    const double tolerance = 0x1p-10;
    if (std::abs(glm::dot(x, y)) > tolerance || std::abs(glm::dot(y, z)) > tolerance ||
        std::abs(glm::dot(z, x)) > tolerance) {
        result.flags |= std::abs(glm::dot(x, glm::cross(y, z))) > tolerance
                            ? status::invalid_input
                            : status::not_invertible;
        return result;
    }
    // the exact inverse, not the transpose: far from the origin even a rounded rotation moves it
    const dvec3 offset = dvec3(m[3]) / w / dvec3(lengths[0], lengths[1], lengths[2]);
    const dvec3 eye =
        -(offset.x * glm::cross(y, z) + offset.y * glm::cross(z, x) + offset.z * glm::cross(x, y)) /
        glm::dot(x, glm::cross(y, z));
    view_volume<double> v = detail::convert<double>(seen.volume);
    const double across = v.orthographic ? 1.0 / lengths[0] : lengths[2] / lengths[0];
    const double upwards = v.orthographic ? 1.0 / lengths[1] : lengths[2] / lengths[1];
    v.left *= across;
    v.right *= across;
    v.bottom *= upwards;
    v.top *= upwards;
    v.near_distance /= lengths[2];
    v.far_distance /= lengths[2];
    if (!detail::fits<T>(eye) || !detail::representable<T>(v)) {
        result.flags |= status::out_of_range;
        return result;
    }
    result.value = frustum<T>{glm::vec<3, T>(eye), glm::vec<3, T>(x), glm::vec<3, T>(y),
                              glm::vec<3, T>(clip.left_handed ? z : -z), detail::convert<T>(v)};
    return result;
}

/// The eight corners relative to the eye: near (left bottom, right bottom, right top, left top),
/// then far in the same order.
///
/// w = 1 for a point; w = 0 for a direction (not normalised), as all four far corners are when
/// `far_distance` is infinity and any corner too far away for T.
/// Built from the parameters, never by inverting a matrix: each component within 2 ulp of |corner|
/// of the given frustum's exact corner, at any far / near and at any distance from the origin.
/// A NaN in the frustum gives the eye, (0, 0, 0, 1).
template <typename T> std::array<glm::vec<4, T>, 8> frustum_corners(const frustum<T>& camera) {
    using dvec3 = detail::dvec3;
    const view_volume<double> v = detail::convert<double>(camera.volume);
    const dvec3 right(camera.right);
    const dvec3 up(camera.up);
    const dvec3 forward(camera.forward);
    std::array<glm::vec<4, T>, 8> corners{};
    for (std::size_t i = 0; i < 8; ++i) {
        const double x = i % 4 == 1 || i % 4 == 2 ? v.right : v.left;
        const double y = i % 4 >= 2 ? v.top : v.bottom;
        const double distance = i < 4 ? v.near_distance : v.far_distance;
        const dvec3 across = x * right + y * up;
        const dvec3 direction = v.orthographic ? forward : forward + across;
        const dvec3 point = v.orthographic ? forward * distance + across : direction * distance;
        if (detail::fits<T>(point)) {
            corners[i] = glm::vec<4, T>(glm::vec<3, T>(point), T(1));
        } else if (distance > 0.0 && detail::fits<T>(direction)) {
            corners[i] = glm::vec<4, T>(glm::vec<3, T>(direction), T(0));
        } else {
            corners[i] = glm::vec<4, T>(T(0), T(0), T(0), T(1));
        }
    }
    return corners;
}

/// The six planes (n, d) relative to the eye, dot(n, p) + d >= 0 inside; left, right, bottom, top,
/// near, far.
///
/// |n| = 1, so that the value is a distance; built from the same parameters as the corners.
/// An infinite far plane is (0, 0, 0, 1), which has everything inside, and so is a plane that
/// holds a NaN.
template <typename T> std::array<glm::vec<4, T>, 6> frustum_planes(const frustum<T>& camera) {
    using dvec3 = detail::dvec3;
    const view_volume<double> v = detail::convert<double>(camera.volume);
    const dvec3 forward(camera.forward);
    const dvec3 axes[2] = {dvec3(camera.right), dvec3(camera.up)};
    const double lo[2] = {v.left, v.bottom};
    const double hi[2] = {v.right, v.top};
    std::array<glm::vec<4, double>, 6> planes{};
    for (std::size_t i = 0; i < 2; ++i) {
        const double inwards = hi[i] < lo[i] ? -1.0 : 1.0; // a mirrored image
        for (std::size_t side = 0; side < 2; ++side) {
            const double sign = side == 0 ? inwards : -inwards;
            const double bound = side == 0 ? lo[i] : hi[i];
            planes[2 * i + side] =
                v.orthographic ? glm::vec<4, double>(sign * axes[i], -sign * bound)
                               : glm::vec<4, double>((sign * axes[i] - sign * bound * forward) /
                                                         std::sqrt(1.0 + bound * bound),
                                                     0.0);
        }
    }
    planes[4] = glm::vec<4, double>(forward, -v.near_distance);
    planes[5] = glm::vec<4, double>(-forward, v.far_distance);
    std::array<glm::vec<4, T>, 6> rounded{};
    for (std::size_t i = 0; i < 6; ++i) {
        rounded[i] = detail::fits<T>(planes[i]) ? glm::vec<4, T>(planes[i])
                                                : glm::vec<4, T>(T(0), T(0), T(0), T(1));
    }
    return rounded;
}

/// View matrix of a frustum: positions relative to `origin` to view space.
///
/// View space is x right, y up and z backwards, or forwards if `clip.left_handed`.
/// `origin`: subtracted from the eye in double before anything is rounded; give the eye itself and
/// the matrix is a pure rotation for eye-relative positions.
/// For T = float and an eye far from `origin` the translation is good to an ulp of that distance
/// and no better: world-space matrices far from the origin need double.
/// A NaN, or a translation that T cannot hold, gives the identity.
template <typename T>
glm::mat<4, 4, T> view_matrix(const frustum<T>& camera, clip_space clip,
                              const glm::vec<3, T>& origin = glm::vec<3, T>(T(0))) {
    using dvec3 = detail::dvec3;
    const dvec3 eye = dvec3(camera.eye) - dvec3(origin);
    const dvec3 forward(camera.forward);
    const dvec3 rows[3] = {dvec3(camera.right), dvec3(camera.up),
                           clip.left_handed ? forward : -forward};
    glm::mat<4, 4, double> m(1.0);
    for (glm::length_t row = 0; row < 3; ++row) {
        for (glm::length_t column = 0; column < 3; ++column) {
            m[column][row] = rows[row][column];
        }
        m[3][row] = -glm::dot(rows[row], eye);
    }
    return detail::fits<T>(m) ? glm::mat<4, 4, T>(m) : glm::mat<4, 4, T>(T(1));
}

} // namespace warpshadow
