// Largest and smallest value of a linear function over a frustum, from its parameters alone.
//
// The maximum over the eight corners of a frustum separates: that of the four near corners is
// g(D) + n m, with m = g(F) + max(l g(R), r g(R)) + max(b g(U), t g(U)), and likewise for far and
// for the minimum. No corner is formed. With the notation of cull_volume.hpp each value takes at
// most nine roundings of terms that sum to |g| (C + |D|), |g| the sum of the magnitudes of g's
// coefficients; the bound allows sixteen.
#pragma once

#include <warpshadow/detail/cull_volume.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <limits>

namespace warpshadow::detail {

/// A frustum relative to a point, ready for `support`.
struct frustum_terms {
    dvec3 offset; ///< from the point to the eye
    dvec3 right, up, forward;
    double left, rightmost, bottom, top;
    double near_scale, far_scale; ///< distances; the far one is 1 for a direction
    double far_weight;            ///< 1, or 0 for far corners at infinity
    double near_bound, far_bound; ///< rounding per unit of |g|
    bool orthographic;
    bool sound;
    status flags;
};

template <typename T> frustum_terms make_terms(const frustum<T>& camera, const dvec3& point) {
    const ordered_volume seen = ordered(convert<double>(camera.volume));
    const view_volume<double>& v = seen.v;
    frustum_terms terms{};
    terms.right = dvec3(camera.right);
    terms.up = dvec3(camera.up);
    terms.forward = dvec3(camera.forward);
    terms.offset = dvec3(camera.eye) - point;
    terms.left = v.left;
    terms.rightmost = v.right;
    terms.bottom = v.bottom;
    terms.top = v.top;
    const bool endless = std::isinf(v.far_distance);
    terms.near_scale = v.near_distance;
    terms.far_scale = endless ? 1.0 : v.far_distance;
    terms.far_weight = endless ? 0.0 : 1.0;
    terms.orthographic = v.orthographic;
    const double across = max_abs(v.left, v.right) * max_abs(terms.right) +
                          max_abs(v.bottom, v.top) * max_abs(terms.up);
    const double ahead = max_abs(terms.forward);
    const double away = max_abs(terms.offset);
    double near_extent = v.near_distance * (across + ahead);
    double far_extent = terms.far_scale * (across + ahead);
    if (v.orthographic) {
        near_extent = across + std::abs(v.near_distance) * ahead;
        far_extent = terms.far_weight * across + std::abs(terms.far_scale) * ahead;
    }
    terms.near_bound = rounding_unit * (near_extent + away);
    terms.far_bound = rounding_unit * (far_extent + terms.far_weight * away);
    terms.flags = seen.flags;
    const bool finite = seen.usable && all_finite(terms.offset) && all_finite(terms.right) &&
                        all_finite(terms.up) && all_finite(terms.forward);
    const bool in_range = tame(near_extent) && tame(far_extent) && tame(away);
    terms.sound = finite && in_range;
    terms.flags |= finite ? status::ok : status::invalid_input;
    terms.flags |= in_range ? status::ok : status::out_of_range;
    return terms;
}

/// Bounds of a linear function: not inside what is true (closed), or not outside of it (open).
struct support_interval {
    double lo, hi;
};

/// Bounds of g over the frustum, g being given by its values on the offset and on the three axes.
///
/// `size`: |g|; negated, the support_interval is narrowed by the rounding instead of widened.
inline support_interval support(const frustum_terms& f, double on_offset, double on_right,
                                double on_up, double on_forward, double size) {
    const double x0 = f.left * on_right;
    const double x1 = f.rightmost * on_right;
    const double y0 = f.bottom * on_up;
    const double y1 = f.top * on_up;
    const double side_hi = glm::max(x0, x1) + glm::max(y0, y1);
    const double side_lo = glm::min(x0, x1) + glm::min(y0, y1);
    const double near_bound = f.near_bound * size;
    const double far_bound = f.far_bound * size;
    double near_hi;
    double near_lo;
    double far_hi;
    double far_lo;
    if (f.orthographic) {
        near_hi = f.near_scale * on_forward + side_hi;
        near_lo = f.near_scale * on_forward + side_lo;
        far_hi = f.far_scale * on_forward + f.far_weight * side_hi;
        far_lo = f.far_scale * on_forward + f.far_weight * side_lo;
    } else {
        near_hi = f.near_scale * (on_forward + side_hi);
        near_lo = f.near_scale * (on_forward + side_lo);
        far_hi = f.far_scale * (on_forward + side_hi);
        far_lo = f.far_scale * (on_forward + side_lo);
    }
    near_hi += on_offset + near_bound;
    near_lo += on_offset - near_bound;
    far_hi += f.far_weight * on_offset + far_bound;
    far_lo += f.far_weight * on_offset - far_bound;
    if (f.far_weight == 0.0) {
        // directions: the function grows without end along them, or they do not count
        const double infinity = std::numeric_limits<double>::infinity();
        return support_interval{far_lo <= 0.0 ? -infinity : near_lo,
                                far_hi >= 0.0 ? infinity : near_hi};
    }
    return support_interval{glm::min(near_lo, far_lo), glm::max(near_hi, far_hi)};
}

} // namespace warpshadow::detail
