// Casters of point lights: the faces each of them is seen in, and the ones that can shadow a view.
//
// All tests are conservative as those of cull.hpp: in double, relative to the light, kept if they
// come within rounding of the boundary.
#pragma once

#include <warpshadow/cube.hpp>
#include <warpshadow/cull.hpp>
#include <warpshadow/detail/caster_hull.hpp>
#include <warpshadow/detail/direction.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// Faces that a box may be seen in from the light.
///
/// `light`, `box`: world space. `range`: distance the light reaches, may be infinity.
/// Exact up to rounding: of all points of the box the one farthest along the axis of a face is the
/// one to ask. Boxes beyond the range give 0. Inverted boxes, NaN: all faces, `invalid_input`.
template <typename T>
mask_result caster_faces(const glm::vec<3, T>& light, const box3<T>& box,
                         T range = std::numeric_limits<T>::infinity()) {
    using detail::dvec3;
    const dvec3 lo = dvec3(box.lo) - dvec3(light);
    const dvec3 hi = dvec3(box.hi) - dvec3(light);
    if (!(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z) || !(range >= T(0))) {
        return mask_result{all_faces, status::invalid_input};
    }
    // each difference is rounded once, and so is each of the sums below
    const double size = glm::max(detail::max_abs(lo), detail::max_abs(hi));
    const double bound = detail::rounding_unit * size;
    const dvec3 nearest = glm::max(glm::max(lo, -hi), dvec3(0.0));
    if (glm::length(nearest) > static_cast<double>(range) + bound) {
        return mask_result{0u, status::ok};
    }
    std::uint32_t mask = 0u;
    for (glm::length_t a = 0; a < 3; ++a) {
        bool plus = !(hi[a] + bound < 0.0);
        bool minus = !(lo[a] - bound > 0.0);
        for (glm::length_t b = 0; b < 3; ++b) {
            if (b != a) {
                plus = plus && !(hi[a] + hi[b] + bound < 0.0) && !(hi[a] - lo[b] + bound < 0.0);
                minus = minus && !(hi[b] - lo[a] + bound < 0.0) && !(lo[a] + lo[b] - bound > 0.0);
            }
        }
        mask |= (plus ? 1u : 0u) << (2 * a) | (minus ? 1u : 0u) << (2 * a + 1);
    }
    return mask_result{mask, status::ok};
}

/// Faces that a ball may be seen in from the light: those whose pyramid is within its radius.
///
/// `range`: distance the light reaches, may be infinity.
/// Exact up to rounding. Balls beyond the range give 0. NaN, an infinite centre, a negative radius:
/// all faces, `invalid_input`.
template <typename T>
mask_result caster_faces(const glm::vec<3, T>& light, const sphere3<T>& ball,
                         T range = std::numeric_limits<T>::infinity()) {
    using detail::dvec3;
    const dvec3 centre = dvec3(ball.centre) - dvec3(light);
    const double radius = static_cast<double>(ball.radius);
    if (!detail::all_finite(centre) || !(radius >= 0.0) || !(range >= T(0))) {
        return mask_result{all_faces, status::invalid_input};
    }
    const double reach = radius + 2.0 * detail::rounding_unit * (detail::max_abs(centre) + radius);
    if (glm::length(centre) > static_cast<double>(range) + reach) {
        return mask_result{0u, status::ok};
    }
    std::uint32_t mask = 0u;
    for (int face = 0; face < 6; ++face) {
        const glm::length_t a = face / 2;
        const double x = face % 2 == 0 ? centre[a] : -centre[a];
        const double p = std::abs(centre[(a + 1) % 3]);
        const double q = std::abs(centre[(a + 2) % 3]);
        const double y = glm::max(p, q);
        const double z = glm::min(p, q);
        // the pyramid z <= y <= x, mirrored: inside, nearest to the plane x = y, the edge, the apex
        double distance = 0.0;
        const double on_plane = 0.5 * (x + y);
        const double on_edge = (x + y + z) / 3.0;
        if (y > x) {
            if (on_plane >= 0.0 && z <= on_plane) {
                distance = (y - x) * 0.70710678118654752440;
            } else {
                distance = glm::length(dvec3(x, y, z) - dvec3(glm::max(on_edge, 0.0)));
            }
        }
        mask |= (distance > reach ? 0u : 1u) << face;
    }
    return mask_result{mask, status::ok};
}

/// Faces of many casters in one pass, and the faces that any of them needs.
///
/// `bounds`: boxes or balls in world space.
/// `masks`: receives one mask per caster; too small: nothing is written, all faces,
/// `buffer_too_small`.
/// A caster is drawn into those faces of its mask that `face_mask` wants too.
template <typename T, typename Bounds>
mask_result caster_faces(const glm::vec<3, T>& light, std::span<const Bounds> bounds, T range,
                         std::span<std::uint8_t> masks) {
    if (masks.size() < bounds.size()) {
        return mask_result{all_faces, status::buffer_too_small};
    }
    mask_result result{0u, status::ok};
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const mask_result one = caster_faces(light, bounds[i], range);
        masks[i] = static_cast<std::uint8_t>(one.mask);
        result.mask |= one.mask;
        result.flags |= one.flags;
    }
    return result;
}

/// The casters that matter to one view: `make_caster_filter`, `casts_into_view`.
struct caster_filter {
    glm::vec<3, double> light{0.0};
    double range = 0.0;
    detail::hull_of_view_and_light hull;
    bool sound = false;
    status flags = status::invalid_input;
};

/// Prepares the test of casters against a view: inside or outside of it, what can shadow it?
///
/// `light`, `view`: world space. `range`: distance the light reaches, may be infinity.
/// King and Newhall 2004 (Navratil 2012, §4.1) project each caster away from the light and test the
/// frustum of its shadow against the view. A point v of the view is in that shadow exactly if the
/// caster meets the segment from the light to v: the casters that matter are those that meet the
/// hull of the view and the light. That is the same set, prepared once for all casters.
/// NaN, infinities but for far plane and range: every caster matters, `invalid_input`.
template <typename T>
caster_filter make_caster_filter(const glm::vec<3, T>& light, const frustum<T>& view,
                                 T range = std::numeric_limits<T>::infinity()) {
    using detail::dvec3;
    caster_filter filter;
    filter.light = dvec3(light);
    filter.range = static_cast<double>(range);
    const cull_volume volume = make_cull_volume(view);
    filter.flags = volume.flags;
    const dvec3 offset = volume.origin - filter.light;
    if (!detail::all_finite(filter.light) || !(filter.range >= 0.0)) {
        filter.flags |= status::invalid_input;
        return filter;
    }
    const double away = detail::max_abs(offset);
    if (!volume.sound || !detail::tame(away)) {
        filter.flags |= status::out_of_range;
        return filter;
    }
    for (std::size_t i = 0; i < 8; ++i) {
        filter.hull.corners[i] = detail::corner(volume, i) + volume.w[i] * offset;
        filter.hull.weights[i] = volume.w[i];
    }
    filter.hull.weights[detail::light_corner] = 1.0;
    filter.hull.extent = glm::max(volume.extent[0], volume.w[4] * volume.extent[1]) + away;
    detail::make_axes(filter.hull, volume);
    filter.sound = true;
    return filter;
}

/// Whether a box can cast a shadow into the view, or be seen in it: exact up to rounding, but for
/// the range, which is tested against the whole box. Kept if it cannot be decided.
template <typename T> bool casts_into_view(const caster_filter& filter, const box3<T>& box) {
    using detail::dvec3;
    const dvec3 lo = dvec3(box.lo) - filter.light;
    const dvec3 hi = dvec3(box.hi) - filter.light;
    const double size = glm::max(detail::max_abs(lo), detail::max_abs(hi));
    if (!filter.sound || !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z) || !detail::tame(size)) {
        return true;
    }
    const dvec3 nearest = glm::max(glm::max(lo, -hi), dvec3(0.0));
    return glm::length(nearest) <= filter.range + detail::rounding_unit * size &&
           detail::box_meets_hull(filter.hull, lo, hi);
}

/// Whether a ball can cast a shadow into the view, or be seen in it; as for boxes.
template <typename T> bool casts_into_view(const caster_filter& filter, const sphere3<T>& ball) {
    using detail::dvec3;
    const dvec3 centre = dvec3(ball.centre) - filter.light;
    const double radius = static_cast<double>(ball.radius);
    const double size = detail::max_abs(centre);
    if (!filter.sound || !(radius >= 0.0) || !detail::tame(size) || !detail::tame(radius)) {
        return true;
    }
    return glm::length(centre) <= filter.range + radius + detail::rounding_unit * (size + radius) &&
           detail::ball_meets_hull(filter.hull, centre, radius);
}

/// Volume around the shadow of a ball, as King and Newhall build it: a frustum, for `intersects`.
///
/// `range`: distance the light reaches, may be infinity.
/// Holds every point that the ball shadows within the range, and more: its cross section is the
/// square around the circle of the shadow. Bounds are moved outwards by 2^-24 of their size, above
/// all rounding. `casts_into_view` answers the same question without the excess.
/// The light within the ball or almost: a volume that intersects everything, `light_inside_body`.
/// NaN, infinities but for the range, a negative radius: the same, `invalid_input`.
template <typename T>
cull_volume shadow_volume(const glm::vec<3, T>& light, const sphere3<T>& ball,
                          T range = std::numeric_limits<T>::infinity()) {
    using detail::dvec3;
    const dvec3 eye(light);
    const dvec3 towards = dvec3(ball.centre) - eye;
    const double radius = static_cast<double>(ball.radius);
    cull_volume everything;
    if (!detail::all_finite(eye) || !detail::all_finite(towards) || !(radius >= 0.0) ||
        !(range >= T(0))) {
        return everything;
    }
    const double distance = glm::length(towards);
    // what cancels in distance - radius stays below the margin
    if (!(distance * (1.0 - 0x1p-20) > radius)) {
        everything.flags = status::light_inside_body;
        return everything;
    }
    const double margin = 0x1p-24;
    const double half_width = radius / std::sqrt((distance - radius) * (distance + radius));
    const double slope = half_width * (1.0 + margin) + margin * margin;
    const double start = (distance - radius) * (1.0 - margin);
    const detail::frame axes = detail::frame_from_unit(detail::unit(towards));
    return make_cull_volume(frustum<double>{
        eye, axes.right, axes.up, axes.forward,
        view_volume<double>{-slope, slope, -slope, slope, start,
                            glm::max(static_cast<double>(range) * (1.0 + margin), start), false}});
}

} // namespace warpshadow
