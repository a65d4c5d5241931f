// Focus: which receivers the view sees, and which casters can throw a shadow on them.
//
// Wimmer, Scherzer, Purgathofer 2004, Scherzer 2005 §4.1, Milet et al. 2015 §3.2. Everything is in
// double and relative to the eye. Rounding, u = 2^-53: a receiver within 64u of the size of the
// body of the border of view, box or cone may count as inside or outside.
#pragma once

#include <warpshadow/detail/direction.hpp>
#include <warpshadow/detail/focus_planes.hpp>
#include <warpshadow/detail/light_view.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/hull.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/polytope.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// A view, a light, and boxes around what casts and what receives shadows; world space.
///
/// Bounds of the boxes may be infinite.
template <typename T> struct focus_input {
    frustum<T> camera;
    light<T> source;
    box3<T> casters;
    box3<T> receivers;
};

/// The first number of a plane of the caster volume that is parallel to the light or holds it.
inline constexpr std::size_t first_side_plane = receiver_planes;
/// Number of no plane at all.
inline constexpr std::size_t no_plane = 255;

using receiver_body = convex_body<double, receiver_planes>;
using caster_body = convex_body<double, 64>;

/// The convex hull of the receivers' body and the light, as planes: what meets it may cast a
/// shadow into the view, what does not cannot.
struct caster_volume {
    static constexpr std::size_t capacity = receiver_planes + receiver_body::capacity + 4;
    /// Relative to the eye; dot(n, p) + d >= 0 inside, |n| = 1.
    std::array<glm::vec<4, double>, capacity> planes{};
    std::array<std::uint8_t, capacity> number{}; ///< 0 to 19 as above, then the sides
    std::size_t count = 0;
    double extent = 0.0;          ///< largest coordinate of what it was made from
    glm::vec<3, double> eye{0.0}; ///< world space
    bool nothing = false;         ///< no receiver is in view: no caster matters
};

/// What the view and the light make of a scene, with every stage on the way, relative to the eye.
struct focus_result {
    glm::vec<3, double> eye{0.0}; ///< world space: origin of everything below
    light_view view;              ///< the light's axes

    std::array<glm::vec<4, double>, 8> corners{}; ///< of the view, as `frustum_corners`
    receiver_body receivers{};                    ///< view ∩ receiver box ∩ spot cone
    /// Hull of the receivers' body in the light's plane, counter-clockwise; 1 point or 2 if flat.
    std::array<glm::vec<2, double>, receiver_body::capacity> footprint{};
    std::size_t footprint_count = 0; ///< 0 if there is no body, no end, or the light is inside
    caster_volume volume;            ///< receivers' body extended to the light
    caster_body casters{}; ///< volume ∩ caster box; `empty_body`: nothing casts a shadow

    double nearest_caster = 0.0;    ///< distance along the light's axis; of receivers if no caster
    double farthest_receiver = 0.0; ///< distance along the light's axis
    status flags = status::ok;
};

/// Answer of `may_cast`.
struct caster_test {
    bool may_cast;
    std::size_t rejected_by; ///< number of the plane that has the box outside; `no_plane` if none
};

namespace detail {

/// Rounding of a plane's value at a point p: 128u (|p| + E), u = 2^-53, E the largest coordinate
/// of what the plane was made from.
///
/// Vertices of the body are within 4 ulp = 8u·√3·E of the planes that made them. The axes of the
/// light are orthonormal to 8u, which moves a position in the light's plane by 14u·E. A side plane
/// supports the rounded positions to within their evaluation, 6u·E more; its normal has a relative
/// error of 8u, whose effect at p is 14u·|p|; evaluating it at p takes 6u (|p| + E). Their sum is
/// below 60u (|p| + E), with |p| the sum of components at most √3 times the length.
inline constexpr double plane_rounding = 0x1p-46;

inline double sum_abs(const dvec3& v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

/// Whether the light lies in the receivers' body, border included, up to rounding.
inline bool holds_light(const plane_list& list, const dvec3& position, double extent) {
    const double bound = plane_rounding * (sum_abs(position) + extent);
    for (const glm::dvec4& plane : list.planes) {
        if (glm::dot(dvec3(plane), position) + plane.w < -bound) {
            return false;
        }
    }
    return true;
}

inline void add_plane(caster_volume& volume, const glm::dvec4& plane, std::size_t number) {
    volume.planes[volume.count] = plane;
    volume.number[volume.count++] = static_cast<std::uint8_t>(number);
}

/// The plane through a line of the light's plane, with m across it towards the inside.
inline glm::dvec4 side_plane(const light_view& view, const glm::dvec2& m, const glm::dvec2& on) {
    const double offset = glm::dot(m, on);
    if (!view.perspective) {
        return glm::dvec4(m.x * view.right + m.y * view.up, -offset);
    }
    const dvec3 n = (m.x * view.right + m.y * view.up - offset * view.forward) /
                    std::sqrt(1.0 + offset * offset);
    return glm::dvec4(n, -glm::dot(n, view.position));
}

/// Planes of the receivers' body that have the light inside, and those along the footprint.
inline void make_volume(focus_result& r, const plane_list& list) {
    const light_view& view = r.view;
    for (std::size_t k = 0; k < receiver_planes; ++k) {
        const glm::dvec4& plane = list.planes[k];
        const dvec3 n(plane);
        // In doubt a plane is left out: the volume grows, and the sides bound it still.
        const double inside =
            view.perspective ? glm::dot(n, view.position) + plane.w : -glm::dot(n, view.forward);
        const double bound =
            plane_rounding * (view.perspective ? sum_abs(view.position) + r.volume.extent : 1.0);
        if (max_abs(n) > 0.0 && inside > bound) {
            add_plane(r.volume, plane, k);
        }
    }
    const std::size_t count = r.footprint_count;
    std::size_t number = first_side_plane;
    for (std::size_t i = 0; i < count && count > 1; ++i) {
        const glm::dvec2 a = r.footprint[i];
        // `unit` scales before it squares: the square of a short edge would underflow
        const dvec3 edge(r.footprint[(i + 1) % count] - a, 0.0);
        const dvec3 along = unit(edge);
        add_plane(r.volume, side_plane(view, {-along.y, along.x}, a), number++);
        if (count == 2) { // the end of the line
            add_plane(r.volume, side_plane(view, {along.x, along.y}, a), number++);
        }
    }
    if (count == 1) {
        for (const glm::dvec2& m : {glm::dvec2(1.0, 0.0), glm::dvec2(-1.0, 0.0),
                                    glm::dvec2(0.0, 1.0), glm::dvec2(0.0, -1.0)}) {
            add_plane(r.volume, side_plane(view, m, r.footprint[0]), number++);
        }
    }
}

/// Hull of the receivers' body in the light's plane, and its far end.
inline void make_footprint(focus_result& r) {
    std::size_t count = 0;
    const double apex = 0x1p-42 * r.volume.extent;
    r.nearest_caster = std::numeric_limits<double>::max();
    r.farthest_receiver = -std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < r.receivers.count; ++i) {
        const dvec3 q = in_light_axes(r.view, dvec3(r.receivers.vertices[i]));
        r.nearest_caster = glm::min(r.nearest_caster, q.z);
        r.farthest_receiver = glm::max(r.farthest_receiver, q.z);
        // A vertex at the light, to rounding, has no direction; its neighbours have those of the
        // edges that lead to it.
        if (!r.view.perspective || q.z > apex) {
            r.footprint[count++] = in_light_plane(r.view, q);
        }
    }
    r.footprint_count = convex_hull(std::span<glm::dvec2>(r.footprint.data(), count)).count;
}

/// Volume ∩ caster box, and the near end.
///
/// Infinite bounds of the box are replaced by those of the receivers' body extended to the light.
inline void make_casters(focus_result& r, box3<double> box) {
    const light_view& view = r.view;
    for (glm::length_t k = 0; k < 3; ++k) {
        double lo = view.perspective ? view.position[k] : r.receivers.vertices[0][k];
        double hi = lo;
        for (std::size_t i = 0; i < r.receivers.count; ++i) {
            lo = glm::min(lo, r.receivers.vertices[i][k]);
            hi = glm::max(hi, r.receivers.vertices[i][k]);
        }
        const bool endless_lo = !view.perspective && view.forward[k] > 0.0;
        const bool endless_hi = !view.perspective && view.forward[k] < 0.0;
        box.lo[k] = std::isinf(box.lo[k]) && !endless_lo ? glm::min(lo, box.hi[k]) : box.lo[k];
        box.hi[k] = std::isinf(box.hi[k]) && !endless_hi ? glm::max(hi, box.lo[k]) : box.hi[k];
    }
    if (!all_finite(box.lo) || !all_finite(box.hi)) {
        r.casters.flags = status::unbounded;
        r.flags |= status::unbounded;
        return;
    }
    r.casters = body_from_corners<double, 64>(corners_of(box));
    if (!(box.lo.x < box.hi.x && box.lo.y < box.hi.y && box.lo.z < box.hi.z)) {
        r.casters.flags |= status::degenerate_extent;
    }
    const double size = glm::max(sum_abs(box.lo), sum_abs(box.hi)) + r.volume.extent;
    for (std::size_t k = 0; k < r.volume.count; ++k) {
        glm::dvec4 plane = r.volume.planes[k];
        plane.w += plane_rounding * size; // so that a flat volume is not lost
        clip_body(r.casters, plane);
    }
    r.flags |= r.casters.flags & status::capacity_reached;
    double nearest = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < r.casters.count; ++i) {
        const double z = in_light_axes(view, dvec3(r.casters.vertices[i])).z;
        nearest = glm::min(nearest, z);
        // no caster is behind the last receiver, but for the rounding allowed for above
        r.farthest_receiver = glm::max(r.farthest_receiver, z);
    }
    if (r.casters.count > 0) {
        r.nearest_caster = nearest;
    }
}

} // namespace detail

/// Receivers in the view and the casters that can shadow them: everything a fitted map must hold.
///
/// The receivers' body is the view ∩ the receiver box ∩ the cone of a spot light (its eight
/// touching planes; a cone of 180° or more does not clip). The casters' body is the hull of the
/// receivers' body and the light ∩ the caster box: casters outside the view are in it.
///
/// Planes of the hull are found by number and from the footprint, never from edges of the body: a
/// light on a plane of the view, in line with one of its edges, or straight above, is no special
/// case.
///
/// Result and status:
/// - `empty_body`: no receiver is in view; no caster matters;
/// - `degenerate_extent`: the receivers' body is flat, an edge or a point: usable;
/// - `unbounded`: an infinite view and no box that bounds it: no footprint, and the caster volume
///   is larger than need be; or directional light and casters without end towards it;
/// - `light_inside_body`: a point light, or a spot of 180° or more, in or on the receivers' body or
///   so near that one map cannot see it all (cosine below 2^-12): no footprint;
/// - `invalid_input`: a NaN, an inverted box, a zero direction, a cone angle that is not positive,
/// a
///   coordinate above 2^400. No bodies; every caster is kept.
/// Repairs of the view's volume are reported as by `make_frustum`.
/// Scaling all lengths by a power of two scales the result and changes no other bit.
template <typename T> focus_result focus(const focus_input<T>& scene) {
    using detail::dvec3;
    focus_result r;
    r.eye = dvec3(scene.camera.eye);
    r.volume.eye = r.eye;
    volume_result<double> seen = detail::repaired(detail::convert<double>(scene.camera.volume));
    if (seen.volume.far_distance > detail::largest_coordinate) {
        seen.volume.far_distance = std::numeric_limits<double>::infinity();
    }
    const frustum<double> camera{dvec3(0.0), dvec3(scene.camera.right), dvec3(scene.camera.up),
                                 dvec3(scene.camera.forward), seen.volume};
    const box3<double> receivers = detail::relative_box(scene.receivers, r.eye);
    const box3<double> casters = detail::relative_box(scene.casters, r.eye);
    r.flags = seen.flags;
    bool clips_by_cone = false;
    const bool lit = detail::make_light_view(scene.source, r.eye, r.view, clips_by_cone);
    if (!lit || any(seen.flags, status::invalid_input) || !detail::all_finite(r.eye) ||
        !detail::all_finite(camera.right) || !detail::all_finite(camera.up) ||
        !detail::all_finite(camera.forward) || !detail::usable_box(receivers) ||
        !detail::usable_box(casters)) {
        r.flags |= status::invalid_input;
        r.receivers.flags = r.casters.flags = status::invalid_input | status::empty_body;
        return r;
    }
    r.corners = frustum_corners(camera);
    detail::plane_list list;
    const std::array<glm::dvec4, 6> planes = frustum_planes(camera);
    std::copy(planes.begin(), planes.end(), list.planes.begin());
    for (std::size_t k = 0; k < 6; ++k) {
        const auto axis = static_cast<glm::length_t>(k / 2);
        const double bound = k % 2 == 0 ? receivers.lo[axis] : receivers.hi[axis];
        if (std::isfinite(bound)) {
            glm::dvec4 plane(0.0, 0.0, 0.0, k % 2 == 0 ? -bound : bound);
            plane[axis] = k % 2 == 0 ? 1.0 : -1.0;
            list.planes[6 + k] = plane;
        }
    }
    // A far plane behind the whole box is left out: an edge that ends far away has vertices that
    // are only as exact as its end, one without an end has not.
    std::array<glm::dvec4, 8> clipped = r.corners;
    if (detail::farthest(receivers, camera.forward) < camera.volume.far_distance) {
        frustum<double> endless = camera;
        endless.volume.far_distance = std::numeric_limits<double>::infinity();
        clipped = frustum_corners(endless);
    }
    r.receivers = body_from_corners<double, receiver_planes>(clipped);
    clip_body(r.receivers, receivers);
    if (clips_by_cone) {
        const double half = 0.5 * static_cast<double>(scene.source.cone_angle);
        detail::add_cone(list, r.view, half);
        r.view.widest_slope = std::tan(half) * 1.08239220029239396880; // corner of the octagon
        for (std::size_t k = 12; k < receiver_planes; ++k) {
            clip_body(r.receivers, list.planes[k]);
        }
    }
    r.flags |= r.receivers.flags & (status::empty_body | status::degenerate_extent |
                                    status::capacity_reached | status::invalid_input);
    r.volume.nothing = r.receivers.count == 0;
    if (r.receivers.count == 0) {
        r.casters.flags = status::empty_body;
        return r;
    }
    bool endless = false;
    r.volume.extent = detail::max_abs(r.view.position);
    for (const glm::dvec4& corner : clipped) {
        const double size = corner.w == 0.0 ? 0.0 : detail::max_abs(dvec3(corner));
        r.volume.extent = glm::max(r.volume.extent, size);
    }
    for (std::size_t i = 0; i < r.receivers.count; ++i) {
        endless = endless || r.receivers.vertices[i].w == 0.0;
        r.volume.extent =
            glm::max(r.volume.extent, detail::max_abs(dvec3(r.receivers.vertices[i])));
    }
    if (endless) {
        r.flags |= status::unbounded;
        r.casters.flags = status::unbounded;
        detail::make_volume(r, list);
        return r;
    }
    r.view.in_front = !r.view.perspective || clips_by_cone;
    if (!r.view.in_front) {
        detail::choose_axis(r.view, r.receivers, scene.source.vertical);
        if (!r.view.in_front || detail::holds_light(list, r.view.position, r.volume.extent)) {
            r.view.in_front = false;
            r.flags |= status::light_inside_body;
        }
    }
    if (r.view.in_front) {
        detail::make_footprint(r);
    }
    detail::make_volume(r, list);
    detail::make_casters(r, casters);
    return r;
}

/// Whether a box can throw a shadow on a receiver in view, and the plane that says no.
///
/// `volume`: of a `focus_result`. `box`: world space, one caster or a group of them.
/// Conservative: a box that meets any segment from a receiver in view to the light is kept; of the
/// others those outside one plane are rejected, beyond rounding (128u of the coordinates). A volume
/// without planes, a NaN or an inverted box: kept.
template <typename T> caster_test may_cast(const caster_volume& volume, const box3<T>& box) {
    using detail::dvec3;
    if (volume.nothing) {
        return {false, no_plane};
    }
    const dvec3 lo = dvec3(box.lo) - volume.eye;
    const dvec3 hi = dvec3(box.hi) - volume.eye;
    if (!(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z)) {
        return {true, no_plane};
    }
    const double size = glm::max(detail::sum_abs(lo), detail::sum_abs(hi)) + volume.extent;
    for (std::size_t k = 0; k < volume.count; ++k) {
        const glm::dvec4& p = volume.planes[k];
        const double value = glm::max(p.x * lo.x, p.x * hi.x) + glm::max(p.y * lo.y, p.y * hi.y) +
                             glm::max(p.z * lo.z, p.z * hi.z) + p.w;
        if (value < -detail::plane_rounding * size) { // false for NaN
            return {false, volume.number[k]};
        }
    }
    return {true, no_plane};
}

} // namespace warpshadow
