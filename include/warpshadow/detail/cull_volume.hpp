// Convex volumes with eight corners and six planes, prepared in double for intersection tests, and
// the bounds on the rounding of each.
//
// Bounds, u = 2^-53, to first order in u. R, U, F are the axes, R* = U x F and so on their cross
// products, and |.| the largest component. A corner is d (x R + y U + F) with four roundings, hence
// off by at most 4u C, C = d (|x| |R| + |y| |U| + |F|). The normal of the left plane is R* - x F*,
// also with four roundings: off by at most 4u N, N = 2 |U| (|F| + |x| |R|), and no larger than N.
// An offset n det, det = F* . F, has six: off by 6u P, P = 3 n N |F|. Both axes and distances are
// exact, being inputs; the displacement D of two origins is a difference of inputs, rounded once,
// however far from the origin of the world they are. The value s of a plane at a corner is the sum
// of n . c and of n . D + d. Of the first every term is off by 9u from its factors and product and
// by three sums; of the second by 6u and five sums, d by 6u and three sums. Hence, adding the bound
// to s included, |error of s| <= 14u (3 N (C + |D|)) + 9u P. `tolerance` is 16u (3 N (C + |D|) +
// P), whose own rounding takes less than what is to spare. Contraction to fused multiply-adds
// removes roundings only.
#pragma once

#include <warpshadow/frustum.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace warpshadow::detail {

/// Sixteen units of rounding: what `tolerance` is made of.
inline constexpr double rounding_unit = 0x1p-49;

/// Magnitudes that are neither zero nor within 2^-400 to 2^400 could leave the range of double.
inline constexpr double largest_magnitude = 0x1p400;

inline bool tame(double magnitude) {
    // false for NaN
    return magnitude == 0.0 ||
           (magnitude >= 1.0 / largest_magnitude && magnitude <= largest_magnitude);
}

inline double max_abs(double a, double b) {
    return glm::max(std::abs(a), std::abs(b));
}

} // namespace warpshadow::detail

namespace warpshadow {

/// A frustum or a box, prepared for any number of intersection tests: `make_cull_volume`.
///
/// The same for float and double, and fixed in size; nothing in it needs to be read by users.
struct cull_volume {
    glm::vec<3, double> origin{0.0};          ///< world space: the eye, or the box's lower corner
    std::array<double, 8> x{}, y{}, z{}, w{}; ///< corners relative to origin, as `frustum_corners`
    std::array<double, 6> a{}, b{}, c{}, d{}; ///< planes relative to origin, as `frustum_planes`
    std::array<double, 6> normal_bound{};     ///< N of each plane
    std::array<double, 6> offset_bound{};     ///< P of each plane
    std::array<double, 2> extent{};           ///< C of the near and of the far corners
    double depth_rate = 0.0;                  ///< bound on depth per largest component
    bool sound = false;                       ///< false: too extreme to decide, always kept
    status flags = status::invalid_input;
};

} // namespace warpshadow

namespace warpshadow::detail {

/// Bound on the rounding of plane p of `volume` at a corner with extent `extent` and weight `w`
/// (1 a point, 0 a direction) that belongs to a volume displaced by at most `away` per axis.
inline double tolerance(const cull_volume& volume, std::size_t p, double extent, double w,
                        double away) {
    return rounding_unit *
           (3.0 * volume.normal_bound[p] * (extent + w * away) + w * volume.offset_bound[p]);
}

inline void set_corner(cull_volume& volume, std::size_t i, const dvec3& position, double w) {
    volume.x[i] = position.x;
    volume.y[i] = position.y;
    volume.z[i] = position.z;
    volume.w[i] = w;
}

inline void set_plane(cull_volume& volume, std::size_t p, const dvec3& normal, double offset,
                      double normal_bound, double offset_bound) {
    volume.a[p] = normal.x;
    volume.b[p] = normal.y;
    volume.c[p] = normal.z;
    volume.d[p] = offset;
    volume.normal_bound[p] = normal_bound;
    volume.offset_bound[p] = offset_bound;
}

inline dvec3 corner(const cull_volume& volume, std::size_t i) {
    return dvec3(volume.x[i], volume.y[i], volume.z[i]);
}

inline dvec3 normal(const cull_volume& volume, std::size_t p) {
    return dvec3(volume.a[p], volume.b[p], volume.c[p]);
}

/// Whether every bound allows the tests to decide; sets `sound` and the matching status.
inline void check_bounds(cull_volume& volume) {
    bool sound = tame(volume.extent[0]) && tame(volume.extent[1]);
    sound = sound && max_abs(volume.origin) <= largest_magnitude;
    for (std::size_t p = 0; p < 6; ++p) {
        const dvec3 n = normal(volume, p);
        const double bound = volume.normal_bound[p];
        sound = sound && tame(bound) && volume.offset_bound[p] <= largest_magnitude;
        // axes so oblique that a plane is lost in rounding
        sound = sound && max_abs(n) * 0x1p12 >= bound;
    }
    volume.sound = sound;
    volume.flags |= sound ? status::ok : status::out_of_range;
}

/// What a frustum means once its bounds are put in order.
struct ordered_volume {
    view_volume<double> v;
    bool usable;
    status flags;
};

inline ordered_volume ordered(view_volume<double> v) {
    status flags = status::ok;
    bool usable = std::isfinite(v.left) && std::isfinite(v.right) && std::isfinite(v.bottom) &&
                  std::isfinite(v.top) && std::isfinite(v.near_distance) &&
                  v.far_distance > -std::numeric_limits<double>::infinity();
    if (v.left > v.right) {
        v = view_volume<double>{v.right,         v.left,         v.bottom,      v.top,
                                v.near_distance, v.far_distance, v.orthographic};
    }
    if (v.bottom > v.top) {
        v = view_volume<double>{v.left,          v.right,        v.top,         v.bottom,
                                v.near_distance, v.far_distance, v.orthographic};
    }
    if (usable && v.far_distance < v.near_distance) {
        const double from = v.far_distance;
        v.far_distance = v.near_distance;
        v.near_distance = from;
        flags |= status::out_of_range;
    }
    if (!v.orthographic) {
        usable = usable && v.far_distance > 0.0;
        if (v.near_distance < 0.0) {
            v.near_distance = 0.0;
            flags |= status::near_clamped;
        } else if (v.near_distance < 1.0 / largest_magnitude) {
            v.near_distance = 0.0; // a larger volume, and no underflow
        }
    }
    return ordered_volume{v, usable, flags};
}

} // namespace warpshadow::detail

namespace warpshadow {

/// Prepares a frustum: corners and planes of exactly the numbers given, in double.
///
/// `camera`: world space; axes about perpendicular, right- or left-handed, of any length;
/// `far_distance` may be infinity.
/// Bounds in the wrong order are exchanged, a perspective near distance below zero becomes zero
/// (`out_of_range`, `near_clamped`). NaN, infinities elsewhere, and axes in one plane give a volume
/// that intersects everything (`invalid_input`), and so do magnitudes beyond 2^400
/// (`out_of_range`).
template <typename T> cull_volume make_cull_volume(const frustum<T>& camera) {
    using detail::dvec3;
    const detail::ordered_volume seen = detail::ordered(detail::convert<double>(camera.volume));
    const view_volume<double>& v = seen.v;
    const dvec3 right(camera.right);
    const dvec3 up(camera.up);
    const dvec3 forward(camera.forward);
    cull_volume volume;
    volume.origin = dvec3(camera.eye);
    if (!seen.usable || !detail::all_finite(volume.origin) || !detail::all_finite(right) ||
        !detail::all_finite(up) || !detail::all_finite(forward)) {
        return volume;
    }
    const double r = detail::max_abs(right);
    const double u = detail::max_abs(up);
    const double f = detail::max_abs(forward);
    const bool tame = detail::tame(r * u * f);
    const dvec3 across = glm::cross(up, forward);
    const dvec3 upwards = glm::cross(forward, right);
    const dvec3 ahead = glm::cross(right, up);
    const double determinant = glm::dot(forward, ahead);
    if (!tame || !(std::abs(determinant) * 0x1p12 > r * u * f)) {
        return volume;
    }
    volume.flags = seen.flags;

    const bool endless = std::isinf(v.far_distance);
    const double x = detail::max_abs(v.left, v.right);
    const double y = detail::max_abs(v.bottom, v.top);
    const double w[2] = {1.0, endless ? 0.0 : 1.0};
    const double distance[2] = {v.near_distance, endless ? 1.0 : v.far_distance};
    const double xs[4] = {v.left, v.right, v.right, v.left};
    const double ys[4] = {v.bottom, v.bottom, v.top, v.top};
    for (std::size_t end = 0; end < 2; ++end) {
        const double side = v.orthographic ? w[end] : 1.0;
        for (std::size_t i = 0; i < 4; ++i) {
            const dvec3 offset = xs[i] * right + ys[i] * up;
            detail::set_corner(volume, 4 * end + i,
                               v.orthographic ? side * offset + distance[end] * forward
                                              : distance[end] * (offset + forward),
                               w[end]);
        }
        volume.extent[end] = v.orthographic ? side * (x * r + y * u) + std::abs(distance[end]) * f
                                            : distance[end] * (x * r + y * u + f);
    }

    const double s = determinant < 0.0 ? -1.0 : 1.0; // a left-handed frame
    const double size = 6.0 * r * u * f;             // bounds the determinant's terms
    if (v.orthographic) {
        detail::set_plane(volume, 0, s * across, -v.left * (s * determinant), 2.0 * u * f,
                          std::abs(v.left) * size);
        detail::set_plane(volume, 1, -s * across, v.right * (s * determinant), 2.0 * u * f,
                          std::abs(v.right) * size);
        detail::set_plane(volume, 2, s * upwards, -v.bottom * (s * determinant), 2.0 * r * f,
                          std::abs(v.bottom) * size);
        detail::set_plane(volume, 3, -s * upwards, v.top * (s * determinant), 2.0 * r * f,
                          std::abs(v.top) * size);
    } else {
        detail::set_plane(volume, 0, s * (across - v.left * ahead), 0.0,
                          2.0 * u * (f + std::abs(v.left) * r), 0.0);
        detail::set_plane(volume, 1, s * (v.right * ahead - across), 0.0,
                          2.0 * u * (f + std::abs(v.right) * r), 0.0);
        detail::set_plane(volume, 2, s * (upwards - v.bottom * ahead), 0.0,
                          2.0 * r * (f + std::abs(v.bottom) * u), 0.0);
        detail::set_plane(volume, 3, s * (v.top * ahead - upwards), 0.0,
                          2.0 * r * (f + std::abs(v.top) * u), 0.0);
    }
    detail::set_plane(volume, 4, s * ahead, -v.near_distance * (s * determinant), 2.0 * r * u,
                      std::abs(v.near_distance) * size);
    if (endless) {
        detail::set_plane(volume, 5, -s * ahead, 0.0, 2.0 * r * u, 0.0);
    } else {
        detail::set_plane(volume, 5, -s * ahead, v.far_distance * (s * determinant), 2.0 * r * u,
                          std::abs(v.far_distance) * size);
    }
    volume.depth_rate = size / (f * std::abs(determinant));
    detail::check_bounds(volume);
    if (endless) {
        // the plane at infinity: everything is inside
        detail::set_plane(volume, 5, dvec3(0.0), 1.0, 0.0, 0.0);
    }
    return volume;
}

/// Prepares an axis-aligned box.
///
/// An inverted, infinite or NaN box intersects everything: `invalid_input`.
template <typename T> cull_volume make_cull_volume(const box3<T>& box) {
    using detail::dvec3;
    cull_volume volume;
    volume.origin = dvec3(box.lo);
    const dvec3 size = dvec3(box.hi) - dvec3(box.lo);
    const bool upright = size.x >= 0.0 && size.y >= 0.0 && size.z >= 0.0; // false for NaN
    if (!upright || !detail::all_finite(volume.origin) || !detail::all_finite(size)) {
        return volume;
    }
    volume.flags = status::ok;
    const double xs[4] = {0.0, size.x, size.x, 0.0};
    const double ys[4] = {0.0, 0.0, size.y, size.y};
    for (std::size_t i = 0; i < 8; ++i) {
        detail::set_corner(volume, i, dvec3(xs[i % 4], ys[i % 4], i < 4 ? 0.0 : size.z), 1.0);
    }
    const double extent = detail::max_abs(size);
    volume.extent = {extent, extent};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        dvec3 n(0.0);
        n[static_cast<glm::length_t>(axis)] = 1.0;
        detail::set_plane(volume, 2 * axis, n, 0.0, 1.0, 0.0);
        detail::set_plane(volume, 2 * axis + 1, -n, size[static_cast<glm::length_t>(axis)], 1.0,
                          extent);
    }
    volume.depth_rate = 1.0;
    detail::check_bounds(volume);
    return volume;
}

} // namespace warpshadow
