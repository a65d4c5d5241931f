// Dual paraboloid maps of point lights: projection, its inverse, depth, subdivision, hemispheres.
//
// Positions are relative to the light in its frame: x right, y up, z along the axis of the front
// map (`light_frame` gives such axes). A side s = +1 (front, 0) or -1 (back, 1) sees the hemisphere
// s z >= 0 in the unit disc: uv = (x, y) / (|p| + s z), the stereographic projection of Brabec,
// Annen and Seidel 2002 (Navratil 2012, eq. 1). Both sides use the same x and y, so that they agree
// on the horizon, to the bit: the seam has no gap.
//
// A straight edge seen from the light is an arc of a great circle, and its image an arc of a circle
// of radius 1 or more. Hence `chord_error`, the bound for tessellation.
#pragma once

#include <warpshadow/cull.hpp>
#include <warpshadow/detail/frustum_support.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// Position on a dual paraboloid map.
template <typename T> struct paraboloid_point {
    int side;          ///< 0 front, 1 back, or -1 for no direction
    glm::vec<2, T> uv; ///< in the unit disc; (0, 0) with side -1
};

/// Largest coordinate that `paraboloid_uv` gives, at the pole behind the side: 2^20 radii.
inline constexpr float paraboloid_limit = 1048576.0f;

/// Largest component, by magnitude, of a position; 0 if one of them is not finite.
///
/// A device that does not honour NaN may take one for any value.
template <typename T> T paraboloid_scale(const glm::vec<3, T>& position) {
    glm::vec<3, T> size = glm::abs(position);
    T largest = std::numeric_limits<T>::max();
    T scale = T(0);
    if (size.x <= largest && size.y <= largest && size.z <= largest) {
        scale = glm::max(glm::max(size.x, size.y), size.z);
    }
    return scale;
}

/// Distance from the light, for the depth of each fragment; without overflow or underflow.
///
/// Interpolate positions and take the distance per fragment: distances interpolated along an edge
/// are wrong by a multiple of themselves where its ends are unequally far away.
/// Within 4 ulp. The largest T if the distance exceeds it, 0 for a position that is not finite.
template <typename T> T paraboloid_distance(const glm::vec<3, T>& position) {
    T scale = paraboloid_scale(position);
    T result = T(0);
    if (scale > T(0)) {
        glm::vec<3, T> p = position / scale;
        T ratio = glm::sqrt(glm::dot(p, p));
        T largest = std::numeric_limits<T>::max();
        result = scale <= largest / ratio ? scale * ratio : largest;
    }
    return result;
}

/// Depth in [0, 1] of a fragment: its distance between near and far distance, linear.
///
/// 0 <= `near_distance` < `far_distance`, both finite; otherwise 1.
template <typename T>
T paraboloid_depth(const glm::vec<3, T>& position, T near_distance, T far_distance) {
    T distance = paraboloid_distance(position);
    T depth = far_distance - near_distance;
    T result = T(1);
    if (depth > T(0) && depth <= std::numeric_limits<T>::max()) {
        result = glm::clamp((distance - near_distance) / depth, T(0), T(1));
    }
    return result;
}

/// Position on one side's map of a point anywhere: for vertices, which may lie behind the horizon.
///
/// `side`: 0 front, 1 back.
/// Points of the other hemisphere map outside the unit disc, up to `paraboloid_limit` at its pole,
/// where the direction of uv is arbitrary. Clip by `paraboloid_clip` before rasterising.
/// Within 4 ulp of uv's length at every point, the horizon and the far pole included: behind the
/// horizon the denominator |p| + s z cancels, and uv = (x, y) (|p| - s z) / (x^2 + y^2) is taken.
/// Zero and non-finite positions give (0, 0).
template <typename T> glm::vec<2, T> paraboloid_uv(const glm::vec<3, T>& position, int side) {
    glm::vec<2, T> uv(T(0), T(0));
    T scale = paraboloid_scale(position);
    if (scale > T(0)) {
        glm::vec<3, T> p = position / scale;
        T along = side == 1 ? -p.z : p.z;
        T distance = glm::sqrt(glm::dot(p, p));
        if (along >= T(0)) {
            uv = glm::vec<2, T>(p.x, p.y) / (distance + along);
        } else {
            // scaled once more: x^2 + y^2 underflows close to the pole
            T across = glm::max(glm::abs(p.x), glm::abs(p.y));
            uv = glm::vec<2, T>(T(paraboloid_limit), T(0));
            if (across > T(0)) {
                glm::vec<2, T> q = glm::vec<2, T>(p.x, p.y) / across;
                T square = glm::dot(q, q);
                if (distance - along < T(paraboloid_limit) * (across * glm::sqrt(square))) {
                    uv = q * ((distance - along) / across / square);
                }
            }
        }
    }
    return uv;
}

/// Side and position on the map of a direction of any length: for look-ups.
///
/// The horizon, z = 0, belongs to the front. uv lies in the unit disc, within 4 ulp of its length.
/// Zero and non-finite directions give side -1.
template <typename T> paraboloid_point<T> paraboloid_lookup(const glm::vec<3, T>& direction) {
    paraboloid_point<T> result;
    result.side = -1;
    result.uv = glm::vec<2, T>(T(0), T(0));
    if (paraboloid_scale(direction) > T(0)) {
        result.side = direction.z >= T(0) ? 0 : 1;
        result.uv = paraboloid_uv(direction, result.side);
    }
    return result;
}

/// Unit direction of a position on one side's map; inside the unit disc or beyond it.
///
/// `side`: 0 front, 1 back. `uv`: clamped to twice `paraboloid_limit`.
template <typename T> glm::vec<3, T> paraboloid_unproject(const glm::vec<2, T>& uv, int side) {
    T limit = T(2) * T(paraboloid_limit);
    glm::vec<2, T> q(uv.x > T(0) ? limit : -limit, uv.y > T(0) ? limit : -limit);
    // also where a comparison with NaN is true or false as the device pleases
    q.x = glm::abs(uv.x) <= limit ? uv.x : q.x;
    q.y = glm::abs(uv.y) <= limit ? uv.y : q.y;
    T square = glm::dot(q, q);
    T z = (T(1) - square) / (T(1) + square);
    return glm::vec<3, T>(T(2) * q.x / (T(1) + square), T(2) * q.y / (T(1) + square),
                          side == 1 ? -z : z);
}

/// Position in map space, the unit square, of a position in the disc.
template <typename T> glm::vec<2, T> paraboloid_map(const glm::vec<2, T>& uv) {
    return T(0.5) * uv + T(0.5);
}

/// Signed distance of a position to the horizon of one side, positive where the side sees it: for
/// a clip distance, with an overlap for filters that read across the seam.
///
/// `side`: 0 front, 1 back.
/// `overlap`: sine of the angle behind the horizon that is still drawn, 0 to 1.
template <typename T> T paraboloid_clip(const glm::vec<3, T>& position, int side, T overlap) {
    T along = side == 1 ? -position.z : position.z;
    return overlap > T(0) ? along + overlap * paraboloid_distance(position) : along;
}

/// Largest distance between a chord of that length in the map and the arc that it stands for:
/// 1 - sqrt(1 - L^2 / 4), both in radii of the disc.
///
/// `chord`: 0 to 2, clamped. Reached by edges along the horizon.
template <typename T> T chord_error(T chord) {
    T half_chord = glm::clamp(T(0.5) * chord, T(0), T(1));
    T square = half_chord * half_chord;
    return square / (T(1) + glm::sqrt(T(1) - square));
}

/// Longest chord, in radii of the disc, whose arc is nowhere more than `texels` away.
///
/// `size`: texels across the map, that is across two radii. `texels`: positive.
template <typename T> T longest_chord(T texels, T size) {
    T deviation = glm::clamp(T(2) * texels / size, T(0), T(1));
    return T(2) * glm::sqrt(deviation * (T(2) - deviation));
}

/// Equal parts into which an edge is to be cut so that no part is longer than a chord.
///
/// `from`, `to`: ends of the edge, relative to the light, finite.
/// `side`: of the map it is drawn to, 0 front, 1 back. `chord`: from `longest_chord`.
/// The image moves at |from x to| / (|p| (|p| + s z)) along the edge; the least of either factor
/// is taken. At least 1; compare with what the device can do: an edge that passes the light or the
/// far pole asks for any number, up to 2^20.
template <typename T>
T paraboloid_segments(const glm::vec<3, T>& from, const glm::vec<3, T>& to, int side, T chord) {
    T most = T(paraboloid_limit);
    T scale = glm::max(paraboloid_scale(from), paraboloid_scale(to));
    T result = T(1);
    if (scale > T(0)) {
        glm::vec<3, T> a = from / scale;
        glm::vec<3, T> along = (to - from) / scale;
        glm::vec<3, T> normal = glm::cross(a, along);
        T square = glm::dot(along, along);
        T speed = glm::sqrt(glm::dot(normal, normal));
        // nearest point of the line to the light
        T foot = square > T(0) ? -glm::dot(a, along) / square : T(0);
        if (speed > T(0)) {
            T facing = side == 1 ? T(-1) : T(1);
            // and the least of |p| + s z along it
            T apart = speed / glm::sqrt(square);
            T slope = facing * along.z / glm::sqrt(square);
            T sine = glm::sqrt(glm::max(T(1) - slope * slope, T(0)));
            T lowest = most;
            if (sine > T(0)) {
                lowest = foot - slope / sine * apart / glm::sqrt(square);
            } else if (slope > T(0)) {
                lowest = -most;
            }
            glm::vec<3, T> p = a + glm::clamp(foot, T(0), T(1)) * along;
            glm::vec<3, T> q = a + glm::clamp(lowest, T(0), T(1)) * along;
            T nearest = glm::sqrt(glm::dot(p, p));
            T height = facing * q.z;
            T distance = glm::sqrt(glm::dot(q, q));
            T sum =
                height >= T(0) ? distance + height : (q.x * q.x + q.y * q.y) / (distance - height);
            // each of the three may be off by a few roundings of numbers as large as 4
            T margin = T(16) * std::numeric_limits<T>::epsilon();
            T wanted = speed + margin * glm::sqrt(square);
            T part = glm::max(nearest - margin, T(0)) * glm::max(sum - margin, T(0)) * chord;
            result = wanted < most * part ? glm::max(glm::ceil(wanted / part), T(1)) : most;
        } else if (foot > T(0) && foot < T(1)) {
            result = most; // through the light
        }
    }
    return result;
}

/// Bit 0: front, bit 1: back.
inline constexpr std::uint32_t both_sides = 0x3u;

/// Hemispheres of a dual paraboloid map that a set of views needs: those on whose side of the plane
/// through the light a view has a point.
///
/// `light`, `axis`, `views`: world space; `axis` of any length is the front's direction.
/// `overlap`: as in `paraboloid_clip`, 0 to 1: a side is needed up to that much behind its horizon.
/// Exact up to rounding, and conservative; touching counts. No views: mask 0. A map that outlives
/// the frame, or that others read, needs both sides.
/// NaN, infinities but for far planes, a zero axis: both sides, `invalid_input`; magnitudes beyond
/// 2^400: both sides, `out_of_range`.
template <typename T>
mask_result side_mask(const glm::vec<3, T>& light, const glm::vec<3, T>& axis,
                      std::span<const frustum<T>> views, T overlap = T(0)) {
    using detail::dvec3;
    mask_result result{0u, status::ok};
    if (!detail::all_finite(light) || !detail::is_direction(dvec3(axis)) ||
        !(overlap >= T(0) && overlap <= T(1))) {
        return mask_result{both_sides, status::invalid_input};
    }
    const dvec3 g = detail::scaled_to_one(dvec3(axis));
    const double size = std::abs(g.x) + std::abs(g.y) + std::abs(g.z);
    for (const frustum<T>& view : views) {
        const detail::frustum_terms f = detail::make_terms(view, dvec3(light));
        result.flags |= f.flags;
        const detail::support_interval along =
            detail::support(f, glm::dot(g, f.offset), glm::dot(g, f.right), glm::dot(g, f.up),
                            glm::dot(g, f.forward), size);
        // a sphere around the light that holds the view, or no bound at all
        const double reach = 2.0 * (f.near_bound + f.far_bound) / detail::rounding_unit;
        const double behind =
            overlap > T(0)
                ? static_cast<double>(overlap) * glm::length(g) *
                      (f.far_weight == 0.0 ? std::numeric_limits<double>::infinity() : reach)
                : 0.0;
        const bool front = !f.sound || !(along.hi + behind < 0.0);
        const bool back = !f.sound || !(along.lo - behind > 0.0);
        result.mask |= (front ? 1u : 0u) | (back ? 2u : 0u);
    }
    return result;
}

/// Hemispheres that a caster may be seen in from the light.
///
/// `bounds`: box or ball in world space. `range`: distance the light reaches, may be infinity.
/// Exact up to rounding. Casters beyond the range give 0. NaN, inverted boxes, a negative radius, a
/// zero axis: both sides, `invalid_input`.
template <typename T>
mask_result caster_sides(const glm::vec<3, T>& light, const glm::vec<3, T>& axis,
                         const box3<T>& bounds, T range = std::numeric_limits<T>::infinity()) {
    using detail::dvec3;
    const dvec3 lo = dvec3(bounds.lo) - dvec3(light);
    const dvec3 hi = dvec3(bounds.hi) - dvec3(light);
    if (!(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z) || !(range >= T(0)) ||
        !detail::is_direction(dvec3(axis))) {
        return mask_result{both_sides, status::invalid_input};
    }
    const dvec3 g = detail::scaled_to_one(dvec3(axis));
    const double size = glm::max(detail::max_abs(lo), detail::max_abs(hi));
    const double bound = 3.0 * detail::rounding_unit * size;
    const dvec3 nearest = glm::max(glm::max(lo, -hi), dvec3(0.0));
    if (glm::length(nearest) > static_cast<double>(range) + bound) {
        return mask_result{0u, status::ok};
    }
    const dvec3 least = glm::min(g * lo, g * hi);
    const dvec3 most = glm::max(g * lo, g * hi);
    const bool front = !(most.x + most.y + most.z + bound < 0.0);
    const bool back = !(least.x + least.y + least.z - bound > 0.0);
    return mask_result{(front ? 1u : 0u) | (back ? 2u : 0u), status::ok};
}

/// The same for a ball.
template <typename T>
mask_result caster_sides(const glm::vec<3, T>& light, const glm::vec<3, T>& axis,
                         const sphere3<T>& bounds, T range = std::numeric_limits<T>::infinity()) {
    using detail::dvec3;
    const dvec3 centre = dvec3(bounds.centre) - dvec3(light);
    const double radius = static_cast<double>(bounds.radius);
    if (!detail::all_finite(centre) || !(radius >= 0.0) || !(range >= T(0)) ||
        !detail::is_direction(dvec3(axis))) {
        return mask_result{both_sides, status::invalid_input};
    }
    const dvec3 g = detail::scaled_to_one(dvec3(axis));
    const double bound = 3.0 * detail::rounding_unit * (detail::max_abs(centre) + radius);
    if (glm::length(centre) > static_cast<double>(range) + radius + bound) {
        return mask_result{0u, status::ok};
    }
    const double along = glm::dot(g, centre);
    const double reach = radius * glm::length(g) + bound;
    const bool front = !(along + reach < 0.0);
    const bool back = !(along - reach > 0.0);
    return mask_result{(front ? 1u : 0u) | (back ? 2u : 0u), status::ok};
}

} // namespace warpshadow
