// Maps that hold still: texels on a fixed grid, and a fit that no rotation of the view can change.
#pragma once

#include <warpshadow/detail/direction.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/hull.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace warpshadow {

/// A length rounded up to four significant bits: at most 1/8 longer.
///
/// `length`: positive and finite. Lengths in between give the same bits, and a length times a power
/// of two gives the result times that power. Zero, negative lengths, infinity and NaN come back as
/// they are.
inline double quantised_length(double length) {
    if (!(length > 0.0) || std::isinf(length)) {
        return length;
    }
    int exponent = 0;
    const double fraction = std::frexp(length, &exponent);
    return std::ldexp(std::ceil(fraction * 16.0), exponent - 4);
}

/// Texels along one side of a map, on a grid that starts at coordinate 0.
struct texel_span {
    double texel; ///< length of a texel
    double first; ///< number of the first texel, a whole number: the map begins at first · texel
    status flags; ///< `out_of_range`: the grid is finer than rounding there, nothing is repeated
};

/// Smallest texel of a map of `texels` that holds an extent wherever it lies on the grid.
///
/// `margin`: whole texels kept free at either end. One texel is given away for the position on the
/// grid. No texel left over: 0.
inline double texel_for(double extent, int texels, int margin) {
    const int free = texels - 1 - 2 * margin;
    return free > 0 ? extent / static_cast<double>(free) : 0.0;
}

/// Span of texels on the grid that begins with the margin, then the texel that holds lo.
///
/// Precondition: `texel` is positive. With at least `texel_for(extent, texels, margin)`, the span
/// of `texels` holds lo to lo + extent and the margin at the other end. The number of the first
/// texel is all that depends on lo: as long as lo stays within one texel of the grid the span is
/// the same to the bit, and when it moves on, it moves by whole texels.
inline texel_span snap_to_texels(double lo, double texel, int margin) {
    const double first = std::floor(lo / texel) - static_cast<double>(margin);
    const bool fine = !(std::abs(first) < 0x1p48);
    return {texel, fine && !std::isfinite(first) ? 0.0 : first,
            fine ? status::out_of_range : status::ok};
}

/// A ball around what a camera sees: from the eye, `distance` along forward (and `across` it for an
/// orthographic volume off centre).
struct view_ball {
    double distance;
    glm::vec<2, double> across; ///< along right and up
    double radius;
    status flags;
};

/// Ball around a view, from its volume alone: turning or moving the camera changes no bit of it.
///
/// The smallest one with its centre on the axis of view; for symmetric and orthographic volumes the
/// smallest of all. Enlarged by 2^-40 for rounding. An infinite far distance counts as the near
/// one, `unbounded`; repairs of the volume are reported as by `make_projection`.
template <typename T> view_ball bounding_ball(const view_volume<T>& volume) {
    const volume_result<double> checked = detail::repaired(detail::convert<double>(volume));
    const view_volume<double>& v = checked.volume;
    status flags = checked.flags;
    const double n = v.near_distance;
    const bool endless = std::isinf(v.far_distance);
    const double f = endless ? n : v.far_distance;
    flags |= endless ? status::unbounded : status::ok;
    const double larger = 1.0 + 0x1p-40;
    if (v.orthographic) {
        const glm::dvec3 half(0.5 * (v.right - v.left), 0.5 * (v.top - v.bottom), 0.5 * (f - n));
        return {0.5 * (n + f),
                {0.5 * (v.left + v.right), 0.5 * (v.bottom + v.top)},
                larger * std::sqrt(glm::dot(half, half)),
                flags};
    }
    const double x = glm::max(std::abs(v.left), std::abs(v.right));
    const double y = glm::max(std::abs(v.bottom), std::abs(v.top));
    const double slope = x * x + y * y;
    // as far from the near corners as from the far ones, unless the far plane holds the centre
    const double centre = glm::min(f, 0.5 * (n + f) * (1.0 + slope));
    const double to_near = slope * n * n + (n - centre) * (n - centre);
    const double to_far = slope * f * f + (f - centre) * (f - centre);
    return {centre, {0.0, 0.0}, larger * std::sqrt(glm::max(to_near, to_far)), flags};
}

/// What a stable fit is asked for.
template <typename T> struct stable_options {
    int map_size = 1024; ///< texels along each side
    int margin = 1;      ///< texels kept free at each border, for the filter
    clip_space clip{};
    /// World space; subtracted in double before anything is rounded. Keep it: a new origin is a
    /// new matrix.
    glm::vec<3, T> origin{T(0)};
};

/// A stable fit, and what it costs.
template <typename T> struct stable_result {
    glm::mat<4, 4, T> matrix; ///< positions relative to `origin` to clip space
    T texel;                  ///< side of a texel in scene units
    T wasted_area;            ///< share of the map outside the view's projection along the light
    texel_span x, y;          ///< the map's place on the grid
    status flags;
};

namespace detail {

/// Area of a convex polygon, from its first corner so that nothing cancels far from the origin.
inline double polygon_area(std::span<const glm::dvec2> hull) {
    double twice = 0.0;
    for (std::size_t i = 2; i < hull.size(); ++i) {
        const glm::dvec2 a = hull[i - 1] - hull[0];
        const glm::dvec2 b = hull[i] - hull[0];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * glm::max(twice, 0.0);
}

/// Moves the ends of a depth range apart to 2^-24 of a size that goes with it.
inline status separate_depths(double& lo, double& hi, double size) {
    const double least = relative_floor * glm::max(size, glm::max(std::abs(lo), std::abs(hi)));
    if (hi - lo >= least && hi > lo) {
        return status::ok;
    }
    const double grow = least > 0.0 ? least : 1.0;
    lo -= 0.5 * grow;
    hi += 0.5 * grow;
    return status::degenerate_extent;
}

} // namespace detail

/// Uniform map of a directional light around a view that does not flicker when the camera moves.
///
/// `camera`: world space; give it the far distance up to which shadows are wanted.
/// `source`: directional. `scene`: world space, finite; casters and receivers: near and far plane.
///
/// The map is a square around the view's bounding ball, its texels on a grid through the world's
/// origin. The texel's size depends on the view's volume alone, so no rotation changes it, and a
/// camera that moves by less than a texel gives the same matrix to the bit until it crosses the
/// grid; then the map moves by whole texels: a fixed point falls into the same texel of the grid,
/// unless it lies within rounding of a texel's border.
///
/// The price is `wasted_area`: two thirds of the map and more for common views.
/// An infinite far distance: the identity, `unbounded`. A light of another kind, a zero direction,
/// NaN, an inverted or infinite scene box: the identity, `invalid_input`. Fewer than
/// 2 + 2·margin texels, entries that T cannot hold, a grid finer than rounding (2^48 texels from
/// the origin): `out_of_range`, the first two with the identity.
template <typename T>
stable_result<T> stable_fit(const frustum<T>& camera, const light<T>& source, const box3<T>& scene,
                            const stable_options<T>& options) {
    using detail::dvec3;
    stable_result<T> result{glm::mat<4, 4, T>(T(1)), T(0), T(1), {}, {}, status::ok};
    const light_frame_result<double> axes = light_frame(dvec3(source.direction), source.vertical);
    const view_ball ball = bounding_ball(camera.volume);
    const dvec3 lo(scene.lo);
    const dvec3 hi(scene.hi);
    const dvec3 eye(camera.eye);
    const dvec3 origin(options.origin);
    const dvec3 centre = eye + ball.distance * dvec3(camera.forward) +
                         ball.across.x * dvec3(camera.right) + ball.across.y * dvec3(camera.up);
    result.flags = ball.flags;
    if (source.kind != light_kind::directional || axes.flags != status::ok ||
        !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z) || !detail::all_finite(lo) ||
        !detail::all_finite(hi) || !detail::all_finite(centre) || !detail::all_finite(origin)) {
        result.flags |= status::invalid_input;
    }
    if (any(result.flags, status::invalid_input | status::unbounded)) {
        return result;
    }
    const int margin = options.margin > 0 ? options.margin : 0;
    const double texel = options.map_size > 2 * margin
                             ? texel_for(2.0 * ball.radius, options.map_size, margin)
                             : 0.0;
    if (!(texel > 0.0)) {
        result.flags |= status::out_of_range;
        return result;
    }
    result.x = snap_to_texels(glm::dot(axes.right, centre) - ball.radius, texel, margin);
    result.y = snap_to_texels(glm::dot(axes.up, centre) - ball.radius, texel, margin);
    result.flags |= result.x.flags | result.y.flags;

    const dvec3 middle = 0.5 * lo + 0.5 * hi;
    const double reach = glm::dot(glm::abs(axes.forward), 0.5 * hi - 0.5 * lo);
    double begin = glm::dot(axes.forward, middle - origin) - reach;
    double end = begin + 2.0 * reach;
    result.flags |= detail::separate_depths(begin, end, ball.radius);
    const clip_space clip = options.clip;
    const double d0 = near_depth<double>(clip);
    const double depth_scale = (far_depth<double>(clip) - d0) / (end - begin);
    const double side = static_cast<double>(options.map_size) * texel;
    const double across = 2.0 / side;
    const double upwards = clip.y_down ? -across : across;
    const double centre_x = result.x.first * texel + 0.5 * side;
    const double centre_y = result.y.first * texel + 0.5 * side;
    const glm::dvec4 rows[4] = {
        glm::dvec4(axes.right * across, (glm::dot(axes.right, origin) - centre_x) * across),
        glm::dvec4(axes.up * upwards, (glm::dot(axes.up, origin) - centre_y) * upwards),
        glm::dvec4(axes.forward * depth_scale, d0 - begin * depth_scale),
        glm::dvec4(0.0, 0.0, 0.0, 1.0)};
    const light_matrix_result<T> made = detail::matrix_from_rows<T>(rows, result.flags);
    result.matrix = made.matrix;
    result.flags = made.flags;
    result.texel = static_cast<T>(texel);

    std::array<glm::dvec2, 8> seen;
    const frustum<double> from_eye{dvec3(0.0), dvec3(camera.right), dvec3(camera.up),
                                   dvec3(camera.forward),
                                   detail::repaired(detail::convert<double>(camera.volume)).volume};
    const auto corners = frustum_corners(from_eye);
    for (std::size_t i = 0; i < 8; ++i) {
        const dvec3 p(corners[i]);
        seen[i] = glm::dvec2(glm::dot(axes.right, p), glm::dot(axes.up, p));
    }
    const std::size_t count = convex_hull(std::span<glm::dvec2>(seen)).count;
    const double used = detail::polygon_area(std::span<const glm::dvec2>(seen.data(), count));
    result.wasted_area = static_cast<T>(1.0 - used / (side * side));
    return result;
}

} // namespace warpshadow
