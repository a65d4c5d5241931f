// View volumes and their projection matrices in every clip-space convention, and eye-space depth.
#pragma once

#include <warpshadow/clip_space.hpp>
#include <warpshadow/detail/finite.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace warpshadow {

/// What a camera or a light sees, in its own frame: x right, y up, distance along the view.
///
/// Perspective: `left` to `top` are slopes, the offsets at distance 1. Orthographic: lengths.
/// `left` > `right` or `bottom` > `top` is a mirrored image and allowed. `far_distance` may be
/// infinity. Aggregate; nothing is checked before `check_volume`, `make_projection` or
/// `make_frustum` read it.
template <typename T> struct view_volume {
    T left, right, bottom, top;
    T near_distance, far_distance;
    bool orthographic;
};

/// A view volume, and what had to be done to get it.
template <typename T> struct volume_result {
    view_volume<T> volume;
    status flags;
};

/// A projection matrix, the volume it shows, and what had to be done to get it.
template <typename T> struct projection_result {
    glm::mat<4, 4, T> matrix;
    view_volume<T> volume;
    status flags;
};

/// Symmetric perspective volume of a camera.
///
/// `fov_y`: full vertical angle of view in radians, in (0, pi).
/// `aspect`: width over height, positive.
/// Any other angle or aspect gives a volume that is zero throughout, which every function that
/// returns a status reports as `invalid_input`. Slopes are within 2 ulp.
template <typename T>
view_volume<T> perspective_volume(T fov_y, T aspect, T near_distance, T far_distance) {
    const double angle = static_cast<double>(fov_y);
    const double y = std::tan(0.5 * angle);
    const double x = y * static_cast<double>(aspect);
    // the angle is compared, not the tangent: a rounded pi has a huge positive tangent
    const bool valid = angle > 0.0 && angle < 3.14159265358979323846 && y > 0.0 && x > 0.0 &&
                       detail::fits<T>(y) && detail::fits<T>(x);
    if (!valid) {
        return view_volume<T>{};
    }
    const T w = static_cast<T>(x);
    const T h = static_cast<T>(y);
    return view_volume<T>{-w, w, -h, h, near_distance, far_distance, false};
}

/// Symmetric orthographic volume, `width` and `height` in scene units.
template <typename T>
view_volume<T> orthographic_volume(T width, T height, T near_distance, T far_distance) {
    const T w = T(0.5) * width;
    const T h = T(0.5) * height;
    return view_volume<T>{-w, w, -h, h, near_distance, far_distance, true};
}

/// Perspective volume of a calibrated pinhole camera, whose axis need not be in the middle.
///
/// `focal`, `centre`, `size`: focal lengths, principal point and image size, in pixels; pixel rows
/// are counted downwards from the top, as calibration tools do.
/// `focal` and `size` are positive; anything else is found by the functions that check a volume.
template <typename T>
view_volume<T> pinhole_volume(glm::vec<2, T> focal, glm::vec<2, T> centre, glm::vec<2, T> size,
                              T near_distance, T far_distance) {
    const bool valid = focal.x > T(0) && focal.y > T(0) && size.x > T(0) && size.y > T(0);
    if (!valid) {
        return view_volume<T>{};
    }
    const glm::vec<2, T> from = -centre / focal;
    const glm::vec<2, T> to = (size - centre) / focal;
    return view_volume<T>{from.x, to.x, -to.y, -from.y, near_distance, far_distance, false};
}

namespace detail {

/// Volume that stands in for one that means nothing: 90 degrees, distances 1 to 2.
template <typename T> constexpr view_volume<T> neutral_volume() {
    return view_volume<T>{T(-1), T(1), T(-1), T(1), T(1), T(2), false};
}

template <typename To, typename From> view_volume<To> convert(const view_volume<From>& v) {
    return view_volume<To>{
        static_cast<To>(v.left), static_cast<To>(v.right),         static_cast<To>(v.bottom),
        static_cast<To>(v.top),  static_cast<To>(v.near_distance), static_cast<To>(v.far_distance),
        v.orthographic};
}

/// Moves `lo` and `hi` apart by 2^-19 of `size` if they coincide.
inline status separate(double& lo, double& hi, double size) {
    if (lo != hi) {
        return status::ok;
    }
    lo -= 0x1p-20 * size;
    hi += 0x1p-20 * size;
    return status::degenerate_extent;
}

/// The documented repairs of a volume; `volume_result::volume` can be projected if not invalid.
inline volume_result<double> repaired(view_volume<double> v) {
    const volume_result<double> invalid{neutral_volume<double>(), status::invalid_input};
    const double lowest = v.orthographic ? std::numeric_limits<double>::lowest() : 0.0;
    const bool usable = all_finite(glm::vec<4, double>(v.left, v.right, v.bottom, v.top)) &&
                        std::isfinite(v.near_distance) && v.far_distance >= lowest;
    if (!usable || (!v.orthographic && v.far_distance == 0.0)) {
        return invalid;
    }
    status flags = status::ok;
    if (v.far_distance < v.near_distance) {
        std::swap(v.near_distance, v.far_distance);
        flags |= status::out_of_range;
    }
    if (!v.orthographic && !(v.near_distance > 0.0)) {
        if (std::isinf(v.far_distance)) {
            return invalid; // nothing here has a length that the near distance could come from
        }
        v.near_distance = near_floor * v.far_distance;
        flags |= status::near_clamped;
    }
    double size = std::fmax(std::fmax(std::abs(v.left), std::abs(v.right)),
                            std::fmax(std::abs(v.bottom), std::abs(v.top)));
    if (v.orthographic) {
        const bool endless = std::isinf(v.far_distance);
        size = std::fmax(size, std::abs(v.near_distance));
        size = std::fmax(size, endless ? 0.0 : std::abs(v.far_distance));
    }
    if (!(size > 0.0)) {
        if (v.orthographic) {
            return invalid;
        }
        size = 1.0; // slopes have no unit
    }
    flags |= separate(v.left, v.right, size);
    flags |= separate(v.bottom, v.top, size);
    if (v.near_distance == v.far_distance) {
        v.far_distance += near_floor * (v.orthographic ? size : v.near_distance);
        flags |= status::degenerate_extent;
    }
    return volume_result<double>{v, flags};
}

/// Whether a repaired volume is still one when it is rounded to T.
template <typename T> bool representable(const view_volume<double>& v) {
    using dvec4 = glm::vec<4, double>;
    // a far distance at infinity is as good as the near one here
    const double f = std::isinf(v.far_distance) ? v.near_distance : v.far_distance;
    if (!fits<T>(dvec4(v.left, v.right, v.bottom, v.top)) ||
        !fits<T>(dvec4(v.right - v.left, v.top - v.bottom, v.near_distance, f - v.near_distance)) ||
        !fits<T>(f)) {
        return false;
    }
    const view_volume<T> r = convert<T>(v);
    return r.left != r.right && r.bottom != r.top && r.near_distance < r.far_distance &&
           (r.orthographic || r.near_distance > T(0));
}

/// NDC depth is scale + offset / distance (perspective) or scale * distance + offset.
struct depth_row {
    double scale, offset;
};

/// Depth row of a repaired volume.
inline depth_row depth_row_of(const view_volume<double>& v, clip_space clip) {
    const double d0 = near_depth<double>(clip);
    const double d1 = far_depth<double>(clip);
    const double n = v.near_distance;
    const double f = v.far_distance;
    if (v.orthographic) {
        if (std::isinf(f)) {
            return depth_row{0.0, d0}; // the limit of a distant far plane
        }
        return depth_row{(d1 - d0) / (f - n), (d0 * f - d1 * n) / (f - n)};
    }
    if (clip.infinite_far || std::isinf(f)) {
        return depth_row{d1, (d0 - d1) * n};
    }
    // f - n is exact where it would cancel; 1 - n/f would not be
    return depth_row{(d1 * f - d0 * n) / (f - n), (d0 - d1) * n * (f / (f - n))};
}

} // namespace detail

/// Projection matrix of a volume, from view space to clip space, with the guards that fired.
///
/// The matrix is built in double and rounded once: each entry is within 1 ulp for T = float, within
/// 2 ulp for T = double. Scaling an orthographic volume, or the distances of a perspective one, by
/// a power of two scales the matrix entries accordingly and changes no other bit.
///
/// An orthographic projection cannot have its far plane at infinity: `clip.infinite_far` does not
/// apply to it, and an infinite `far_distance` gives the limit, a depth row that is the near depth
/// everywhere (x and y are right, the matrix has no inverse), with status `unbounded`.
///
/// Repairs, all reported: `far_distance` < `near_distance` are exchanged (`out_of_range`); a
/// perspective `near_distance` <= 0 becomes far * 2^-20 (`near_clamped`); equal bounds are moved
/// apart by 2^-19 of the largest bound, far = near by 2^-20 (`degenerate_extent`).
/// NaN, infinite bounds, perspective `far_distance` <= 0, or near <= 0 together with an infinite
/// far plane give the identity and `invalid_input`; entries that T cannot hold give the identity
/// and `out_of_range`. `volume` is then the neutral one (slopes -1..1, distances 1..2).
template <typename T>
projection_result<T> make_projection(const view_volume<T>& volume, clip_space clip) {
    const volume_result<double> checked = detail::repaired(detail::convert<double>(volume));
    projection_result<T> result{glm::mat<4, 4, T>(T(1)), detail::neutral_volume<T>(),
                                checked.flags};
    if (any(checked.flags, status::invalid_input)) {
        return result;
    }
    const view_volume<double>& v = checked.volume;
    if (!detail::representable<T>(v)) {
        result.flags |= status::out_of_range;
        return result;
    }
    const detail::depth_row depth = detail::depth_row_of(v, clip);
    const double width = v.right - v.left;
    const double height = clip.y_down ? v.bottom - v.top : v.top - v.bottom;
    const double shift_x = -(v.right + v.left) / width;
    const double shift_y = -(v.top + v.bottom) / height;
    const double ahead = clip.left_handed ? 1.0 : -1.0;
    glm::mat<4, 4, double> m(0.0);
    m[0][0] = 2.0 / width;
    m[1][1] = 2.0 / height;
    m[2][2] = ahead * depth.scale;
    m[3][2] = depth.offset;
    if (v.orthographic) {
        m[3][0] = shift_x;
        m[3][1] = shift_y;
        m[3][3] = 1.0;
    } else {
        m[2][0] = ahead * shift_x;
        m[2][1] = ahead * shift_y;
        m[2][3] = ahead;
    }
    if (!detail::fits<T>(m)) {
        result.flags |= status::out_of_range;
        return result;
    }
    if (v.orthographic && std::isinf(v.far_distance)) {
        result.flags |= status::unbounded;
    }
    result.matrix = glm::mat<4, 4, T>(m);
    result.volume = detail::convert<T>(v);
    return result;
}

/// Projection matrix of a volume; `make_projection` without its status.
template <typename T>
glm::mat<4, 4, T> projection_matrix(const view_volume<T>& volume, clip_space clip) {
    return make_projection(volume, clip).matrix;
}

/// What `make_projection` and `make_frustum` would have to repair in this volume.
template <typename T> status check_volume(const view_volume<T>& volume, clip_space clip) {
    return make_projection(volume, clip).flags;
}

/// The volume that a projection matrix shows.
///
/// `matrix`: view space to clip space, perspective (off-centre, reversed, infinite) or
/// orthographic, times any positive factor.
/// `clip`: the convention the matrix was made for; with `infinite_far` the far distance of a
/// perspective matrix is infinity and not looked for.
///
/// Accuracy, u = half an ulp of 1: bounds to 3u (of the larger bound of a pair). Perspective
/// distances: reversed depth 0..1 near to 2u and far to 3u at any ratio; otherwise near to about
/// 3u, far to about u * far / near, so that a float matrix of ratio 1e6 holds far to a few per
/// cent only and above 2^24 not at all. Give standard depth in double, or the parameters.
///
/// Oblique depth planes (x or y in the depth row): the smallest upright volume that holds the
/// oblique one, `out_of_range`. Near and far exchanged against `clip.reversed_z`: put right,
/// `out_of_range`. Far plane beyond infinity (Lengyel's epsilon): infinity, `out_of_range`.
/// A singular matrix gives the neutral volume and `not_invertible`; one that is no view volume
/// under `clip` (rotated, sheared, centre of projection not at the origin, looking backwards, near
/// plane not in front of the eye) or holds a NaN or infinity: the neutral volume, `invalid_input`.
template <typename T>
volume_result<T> volume_from_projection(const glm::mat<4, 4, T>& matrix, clip_space clip) {
    const glm::mat<4, 4, double> m(matrix);
    const volume_result<T> invalid{detail::neutral_volume<T>(), status::invalid_input};
    const volume_result<T> singular{detail::neutral_volume<T>(), status::not_invertible};
    if (!detail::fits<double>(m)) {
        return invalid;
    }
    const double ahead = clip.left_handed ? 1.0 : -1.0;
    const bool orthographic = m[2][3] == 0.0;
    const double w = orthographic ? m[3][3] : ahead * m[2][3];
    const glm::vec<2, double> skew(orthographic ? m[2] : m[3]); // where a volume has zeros
    const glm::vec<2, double> shift(orthographic ? m[3] : ahead * m[2]);
    if (m[0][0] == 0.0 || m[1][1] == 0.0 || w == 0.0) {
        return glm::determinant(m) == 0.0 ? singular : invalid;
    }
    const bool upright = m[0][1] == 0.0 && m[1][0] == 0.0 && m[0][3] == 0.0 && m[1][3] == 0.0 &&
                         skew.x == 0.0 && skew.y == 0.0 && (orthographic || m[3][3] == 0.0);
    if (!upright || w < 0.0) {
        return invalid;
    }
    const double up = clip.y_down ? -1.0 : 1.0;
    view_volume<double> v{(-w - shift.x) / m[0][0],
                          (w - shift.x) / m[0][0],
                          (-w - up * shift.y) / (up * m[1][1]),
                          (w - up * shift.y) / (up * m[1][1]),
                          std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity(),
                          orthographic};
    status flags = status::ok;
    const double d0 = near_depth<double>(clip) * w;
    const double d1 = far_depth<double>(clip) * w;
    const bool oblique = m[0][2] != 0.0 || m[1][2] != 0.0;
    const bool no_far = clip.infinite_far && !orthographic;
    // along each corner ray depth is that of an upright volume; the four agree unless oblique
    for (int corner = 0; corner < (oblique ? 4 : 1); ++corner) {
        const double x = (corner & 1) != 0 ? v.right : v.left;
        const double y = (corner & 2) != 0 ? v.top : v.bottom;
        const double slant = oblique ? m[0][2] * x + m[1][2] * y : 0.0;
        const double slope = ahead * m[2][2];
        double from = 0.0;
        double to = 0.0;
        if (orthographic) {
            if (slope == 0.0) {
                return singular;
            }
            from = (d0 - m[3][2] - slant) / slope;
            to = (d1 - m[3][2] - slant) / slope;
        } else {
            if (m[3][2] == 0.0) {
                return singular;
            }
            const double scale = slope + slant;
            from = scale == d0 ? std::numeric_limits<double>::infinity() : m[3][2] / (d0 - scale);
            to = no_far || scale == d1 ? std::numeric_limits<double>::infinity()
                                       : m[3][2] / (d1 - scale);
            if (to < 0.0 && from > 0.0) {
                to = std::numeric_limits<double>::infinity();
                flags |= status::out_of_range;
            }
            if (!(from > 0.0) || (no_far && std::isinf(from))) {
                return invalid;
            }
        }
        flags |= from > to || oblique ? status::out_of_range : status::ok;
        v.near_distance = std::fmin(v.near_distance, std::fmin(from, to));
        v.far_distance = std::fmax(v.far_distance, std::fmax(from, to));
    }
    if (!detail::representable<T>(v)) {
        return volume_result<T>{detail::neutral_volume<T>(), status::out_of_range};
    }
    return volume_result<T>{detail::convert<T>(v), flags};
}

/// near / far of a perspective projection; 0 if the far plane is at infinity.
template <typename T> T near_over_far(const view_volume<T>& volume, clip_space clip) {
    return clip.infinite_far ? T(0) : volume.near_distance / volume.far_distance;
}

/// Distance from the eye, along the view, of an NDC depth.
///
/// `depth`: NDC depth, kept within near and far plane; NaN counts as the far plane.
/// `volume`: not NaN, near < far and, if perspective, near > 0 (`check_volume` says ok).
/// On a device whose arithmetic has no infinities set `clip.infinite_far` and any large
/// `far_distance`: the answer is never above `far_distance`, which stands for infinity.
/// At most 4 ulp from the exact distance of the given depth, in every convention; orthographic:
/// 4 ulp of the larger of |near| and |far|.
template <typename T> T eye_depth_from_ndc(T depth, const view_volume<T>& volume, clip_space clip) {
    const T d0 = near_depth<T>(clip);
    const T d1 = far_depth<T>(clip);
    T to_near = (d1 - depth) / (d1 - d0);
    T to_far = (depth - d0) / (d1 - d0);
    to_near = to_near > T(0) ? glm::min(to_near, T(1)) : T(0);
    to_far = to_far < T(1) ? glm::max(to_far, T(0)) : T(1);
    if (volume.orthographic) {
        // not a sum when to_far is 0: the far distance may be infinite
        return to_far > T(0) ? to_near * volume.near_distance + to_far * volume.far_distance
                             : volume.near_distance;
    }
    if (!(to_near > T(0))) {
        return volume.far_distance;
    }
    const T ratio = to_near + to_far * near_over_far(volume, clip);
    return glm::min(volume.near_distance / ratio, volume.far_distance);
}

/// NDC depth of a distance from the eye along the view; the inverse of `eye_depth_from_ndc`.
///
/// `distance`: kept within near and far distance; NaN counts as the near distance.
/// `volume`: as for `eye_depth_from_ndc`.
/// With c = 1 / (1 - near / far): the depth is within 4c ulp of 1; in reversed depth 0..1 it is
/// moreover that of a distance at most 6c ulp from the given one.
template <typename T>
T ndc_from_eye_depth(T distance, const view_volume<T>& volume, clip_space clip) {
    const T d0 = near_depth<T>(clip);
    const T d1 = far_depth<T>(clip);
    T d = distance > volume.near_distance ? distance : volume.near_distance;
    d = d < volume.far_distance ? d : volume.far_distance;
    if (volume.orthographic) {
        // halved, so that no difference overflows
        const T passed = T(0.5) * d - T(0.5) * volume.near_distance;
        const T length = T(0.5) * volume.far_distance - T(0.5) * volume.near_distance;
        const T to_far = d < volume.far_distance ? passed / length : T(1);
        return (T(1) - to_far) * d0 + to_far * d1;
    }
    const T ratio = near_over_far(volume, clip);
    const T to_near = (volume.near_distance / d - ratio) / (T(1) - ratio);
    const T to_far = (T(1) - volume.near_distance / d) / (T(1) - ratio);
    return to_near * d0 + to_far * d1;
}

} // namespace warpshadow
