// Whether two volumes meet: frusta, boxes, spheres, cones; never a miss that is not one.
//
// All tests are on closed sets: touching counts. They are conservative by the bounds derived in
// detail/cull_volume.hpp: a pair that meets or touches is never reported apart, at any distance
// from the origin of the world, and a pair is reported to meet wrongly only if it comes within
// a few 1e-14 of the extent of the two. What is tested are the very numbers given, float or double.
//
// Frustum against frustum is the test of King and Newhall, "Efficient Omnidirectional Shadow Maps",
// ShaderX3 (2004), as Navratil 2012 §4.1 quotes it: corners and edges against planes, in both
// directions. It is exact in real arithmetic. A common point implies a corner of the intersection,
// where planes of rank three are active; two of them from one volume put the corner on an edge of
// that volume, hence an edge of one volume meets the other. With corners in homogeneous coordinates
// the same holds for far planes at infinity.
#pragma once

#include <warpshadow/detail/corners_and_edges.hpp>
#include <warpshadow/detail/cull_volume.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace warpshadow {

/// Ball in world space; `radius` >= 0.
template <typename T> struct sphere3 {
    glm::vec<3, T> centre;
    T radius;
};

/// What a spot light reaches: the points within `angle` / 2 of the axis and within `range`.
template <typename T> struct cone3 {
    glm::vec<3, T> apex;
    glm::vec<3, T> axis; ///< any length
    T angle;             ///< full angle in radians, 0 to 2 pi
    T range;             ///< may be infinity
};

/// The cone of a spot light.
///
/// `source`: spot; of any other kind the cone is the whole ball.
/// `range`: distance the light reaches; may be infinity.
template <typename T> cone3<T> light_cone(const light<T>& source, T range) {
    const bool spot = source.kind == light_kind::spot;
    return cone3<T>{source.position, spot ? source.direction : glm::vec<3, T>(T(1), T(0), T(0)),
                    spot ? source.cone_angle : T(6.283185307179586477), range};
}

/// Answer of an intersection test.
struct cull_result {
    bool intersects; ///< false only if the two are certainly apart
    status flags;    ///< with `invalid_input` or `out_of_range` the answer is true without a test
};

/// Faces or hemispheres of a map.
struct mask_result {
    std::uint32_t mask; ///< bit i set: i is needed
    status flags;
};

/// Whether two prepared volumes meet or touch.
inline cull_result intersects(const cull_volume& a, const cull_volume& b) {
    detail::dvec3 displacement;
    cull_result result{true, a.flags | b.flags};
    if (!detail::decidable(a, b, displacement)) {
        result.flags |= status::out_of_range;
        return result;
    }
    detail::outcodes b_in_a;
    if (!detail::corners_against_planes(a, b, displacement, b_in_a)) {
        result.intersects = false;
        return result;
    }
    if (b_in_a.contains) {
        return result;
    }
    detail::outcodes a_in_b;
    if (!detail::corners_against_planes(b, a, -displacement, a_in_b)) {
        result.intersects = false;
        return result;
    }
    result.intersects =
        a_in_b.contains || detail::edge_meets_planes(b_in_a) || detail::edge_meets_planes(a_in_b);
    return result;
}

/// Whether two frusta meet or touch; prepare volumes that take part in several tests instead.
template <typename T> cull_result intersects(const frustum<T>& a, const frustum<T>& b) {
    return intersects(make_cull_volume(a), make_cull_volume(b));
}

/// Whether a frustum and an axis-aligned box meet or touch.
template <typename T> cull_result intersects(const frustum<T>& a, const box3<T>& b) {
    return intersects(make_cull_volume(a), make_cull_volume(b));
}

/// Whether a prepared volume and a ball meet or touch: the distance to the volume, not to its
/// planes, so that nothing near an edge or a corner is kept in vain.
///
/// A NaN or infinite centre, a NaN or negative radius: true and `invalid_input`.
template <typename T> cull_result intersects(const cull_volume& a, const sphere3<T>& b) {
    using detail::dvec3;
    const dvec3 centre = dvec3(b.centre) - a.origin;
    const double radius = static_cast<double>(b.radius);
    cull_result result{true, a.flags};
    if (!detail::all_finite(centre) || !(radius >= 0.0)) {
        result.flags |= status::invalid_input;
        return result;
    }
    const double away = detail::max_abs(centre);
    if (!a.sound || !detail::tame(away) || !detail::tame(radius)) {
        result.flags |= status::out_of_range;
        return result;
    }
    const cull_volume volume = detail::bounded(a, away + radius);
    const double extent = volume.extent[1] + away + radius;
    std::array<double, 6> side;
    bool inside = true;
    for (std::size_t p = 0; p < 6; ++p) {
        const dvec3 n = detail::normal(volume, p);
        side[p] = glm::dot(n, centre) + volume.d[p];
        const double bound = detail::tolerance(volume, p, extent, 1.0, 0.0);
        if (side[p] + radius * glm::length(n) + bound < 0.0) {
            result.intersects = false;
            return result;
        }
        inside = inside && side[p] >= 0.0;
    }
    if (inside) {
        return result;
    }
    // the nearest point lies within a face, which the planes above have not ruled out ...
    for (std::size_t p = 0; p < 6; ++p) {
        const dvec3 n = detail::normal(volume, p);
        const double square = glm::dot(n, n);
        if (side[p] >= 0.0 || !(square > 0.0)) {
            continue;
        }
        const dvec3 foot = centre - n * (side[p] / square);
        // the foot is as far off as the plane that it was dropped on
        const double slack = 4.0 * (1.0 + volume.normal_bound[p] / std::sqrt(square));
        bool within = true;
        for (std::size_t q = 0; q < 6; ++q) {
            const double bound = slack * detail::tolerance(volume, q, extent, 1.0, 0.0);
            within =
                within &&
                (q == p || glm::dot(detail::normal(volume, q), foot) + volume.d[q] + bound >= 0.0);
        }
        if (within) {
            return result;
        }
    }
    // ... or on an edge
    const double reach = radius + 8.0 * detail::rounding_unit * extent;
    for (const auto& edge : detail::corner_pairs) {
        const dvec3 from = detail::corner(volume, edge[0]);
        const dvec3 along = detail::corner(volume, edge[1]) - from;
        const double square = glm::dot(along, along);
        const double t =
            square > 0.0 ? glm::clamp(glm::dot(centre - from, along) / square, 0.0, 1.0) : 0.0;
        const dvec3 gap = centre - from - t * along;
        if (glm::dot(gap, gap) <= reach * reach) {
            return result;
        }
    }
    result.intersects = false;
    return result;
}

/// Whether a frustum and a ball meet or touch.
template <typename T> cull_result intersects(const frustum<T>& a, const sphere3<T>& b) {
    return intersects(make_cull_volume(a), b);
}

/// Whether a prepared volume and a spot light's cone meet or touch.
///
/// Exact up to rounding if the range is infinite. With a finite range the ball of that radius must
/// be met as well: a volume that meets cone and ball in different places is kept.
/// The smallest angle to the axis over a convex body is zero, or it is found on an edge: a face has
/// no other stationary point.
/// A zero or non-finite axis, a NaN anywhere, a negative range or angle: true and `invalid_input`.
template <typename T> cull_result intersects(const cull_volume& a, const cone3<T>& b) {
    using detail::dvec3;
    const dvec3 offset = a.origin - dvec3(b.apex);
    const double angle = 0.5 * static_cast<double>(b.angle);
    const double range = static_cast<double>(b.range);
    cull_result result{true, a.flags};
    if (!detail::is_direction(dvec3(b.axis)) || !detail::all_finite(offset) || !(range >= 0.0) ||
        !(angle >= 0.0)) {
        result.flags |= status::invalid_input;
        return result;
    }
    const double away = detail::max_abs(offset);
    if (!a.sound || !detail::tame(away)) {
        result.flags |= status::out_of_range;
        return result;
    }
    if (!std::isinf(range)) {
        result = intersects(a, sphere3<double>{dvec3(b.apex), range});
        if (!result.intersects || any(result.flags, status::out_of_range)) {
            return result;
        }
    }
    if (angle >= 3.14159265358979323846) {
        return result;
    }
    const dvec3 axis = detail::unit(dvec3(b.axis));
    // the axis as a ray from the apex against the planes
    double enter = 0.0;
    double leave = 1.0;
    bool missed = false;
    for (std::size_t p = 0; p < 6; ++p) {
        const dvec3 n = detail::normal(a, p);
        const double start = a.d[p] - glm::dot(n, offset) + detail::tolerance(a, p, 0.0, 1.0, away);
        const double end = glm::dot(n, axis) + detail::tolerance(a, p, 1.0, 0.0, 0.0);
        missed = missed || (start < 0.0 && end < 0.0);
        if (start < 0.0 && end >= 0.0) {
            enter = glm::max(enter, start / (start - end));
        } else if (start >= 0.0 && end < 0.0) {
            leave = glm::min(leave, start / (start - end));
        }
    }
    if (!missed && enter <= leave + detail::rounding_unit) {
        return result;
    }
    const double cosine = std::cos(angle);
    // axis . x - cosine |x| changes by no more than twice what x does
    const auto within = [&](const dvec3& x, double bound) {
        return glm::dot(axis, x) - cosine * glm::length(x) + bound >= 0.0;
    };
    for (const auto& edge : detail::corner_pairs) {
        const double w0 = a.w[edge[0]];
        const double w1 = a.w[edge[1]];
        const dvec3 from = detail::corner(a, edge[0]) + w0 * offset;
        const dvec3 to = detail::corner(a, edge[1]) + w1 * offset;
        const dvec3 along = w0 == w1 ? to - from : to;
        const std::size_t end0 = edge[0] < 4 ? 0 : 1;
        const std::size_t end1 = edge[1] < 4 ? 0 : 1;
        const double bound0 = 8.0 * detail::rounding_unit * (a.extent[end0] + w0 * away);
        const double bound1 = 8.0 * detail::rounding_unit * (a.extent[end1] + w1 * away);
        if (within(from, bound0) || within(to, bound1)) {
            return result;
        }
        // the one stationary point of the angle along the line from + t * along
        const double square = glm::dot(along, along);
        if (!(square > 0.0)) {
            continue;
        }
        const double nearest = -glm::dot(from, along) / square;
        const dvec3 foot = from + nearest * along;
        const double slope = glm::dot(axis, along) / square;
        const double height = glm::dot(axis, foot);
        if (!(height > 0.0)) {
            continue;
        }
        double t = nearest + slope * glm::dot(foot, foot) / height;
        t = w0 == w1 ? glm::clamp(t, 0.0, 1.0) : glm::max(t, 0.0);
        const dvec3 x = from + t * along;
        const double bound =
            8.0 * detail::rounding_unit * (a.extent[end0] + w0 * away + t * detail::max_abs(along));
        if (within(x, glm::max(bound, w0 == w1 ? bound1 : 0.0))) {
            return result;
        }
    }
    result.intersects = false;
    return result;
}

/// Whether a frustum and a spot light's cone meet or touch.
template <typename T> cull_result intersects(const frustum<T>& a, const cone3<T>& b) {
    return intersects(make_cull_volume(a), b);
}

/// A direction along which two volumes are apart, for those who want to know why a test failed.
struct separation_result {
    glm::vec<3, double> axis; ///< from a towards b, not normalised; zero if none was found
    double gap;               ///< width of the empty slab: certain, up to rounding; 0 if none
    status flags;
};

/// Looks for a separating axis among the face normals of both volumes and the cross products of
/// their edges, and gives the one with the widest gap.
///
/// For volumes with finite far planes this finds an axis exactly if they are apart (separating axis
/// theorem; Gottschalk 1996), and so agrees with `intersects`, at ten to twenty times its cost.
/// An infinite far plane is cut off where the other volume ends; two of them give no axis.
inline separation_result separating_axis(const cull_volume& a, const cull_volume& b) {
    using detail::dvec3;
    dvec3 displacement;
    separation_result result{dvec3(0.0), 0.0, a.flags | b.flags};
    if (!detail::decidable(a, b, displacement)) {
        result.flags |= status::out_of_range;
        return result;
    }
    if (a.w[4] == 0.0 && b.w[4] == 0.0) {
        result.flags |= status::unbounded;
        return result;
    }
    const double away = detail::max_abs(displacement);
    const cull_volume first = detail::bounded(a, away + b.extent[1] + b.extent[0]);
    const cull_volume second = detail::bounded(b, away + a.extent[1] + a.extent[0]);
    const double extent = glm::max(first.extent[0], first.extent[1]) +
                          glm::max(second.extent[0], second.extent[1]) + away;
    const auto try_axis = [&](const dvec3& n) {
        const double length = glm::length(n);
        if (!(length > 0.0)) {
            return;
        }
        double lo[2] = {0.0, 0.0};
        double hi[2] = {0.0, 0.0};
        for (std::size_t i = 0; i < 8; ++i) {
            const double s = glm::dot(n, detail::corner(first, i));
            const double t = glm::dot(n, detail::corner(second, i) + displacement);
            lo[0] = i == 0 ? s : glm::min(lo[0], s);
            hi[0] = i == 0 ? s : glm::max(hi[0], s);
            lo[1] = i == 0 ? t : glm::min(lo[1], t);
            hi[1] = i == 0 ? t : glm::max(hi[1], t);
        }
        const double bound = 3.0 * detail::rounding_unit * detail::max_abs(n) * extent;
        const double above = (lo[1] - hi[0] - bound) / length;
        const double below = (lo[0] - hi[1] - bound) / length;
        if (above > result.gap || below > result.gap) {
            result.gap = glm::max(above, below);
            result.axis = above > below ? n : -n;
        }
    };
    std::array<std::array<dvec3, 6>, 2> along;
    for (std::size_t side = 0; side < 2; ++side) {
        const cull_volume& volume = side == 0 ? first : second;
        for (std::size_t p = 0; p < 6; ++p) {
            try_axis(detail::normal(volume, p));
        }
        // across, upwards, and the four edges from the near to the far plane
        along[side][0] = detail::corner(volume, 5) - detail::corner(volume, 4);
        along[side][1] = detail::corner(volume, 6) - detail::corner(volume, 5);
        for (std::size_t i = 0; i < 4; ++i) {
            along[side][i + 2] = detail::corner(volume, i + 4) - detail::corner(volume, i);
        }
    }
    for (const dvec3& u : along[0]) {
        for (const dvec3& v : along[1]) {
            try_axis(glm::cross(u, v));
        }
    }
    return result;
}

} // namespace warpshadow
