// A map turned to the principal axis of its importance: what Rosen 2012 leaves open.
//
// Tables warp along the map's sides. Importance that lies across them, a strip along the diagonal
// say, is spread over every row and every column, and a rectilinear warp gains nothing. So the
// frame is turned until the sides run along the axes of the importance's second moments. That axis
// is worth nothing where the importance is as wide as it is long, and jumps there; hence the angle
// is kept while little is gained, and never turned faster than the slew.
#pragma once

#include <warpshadow/detail/finite.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <cmath>
#include <cstddef>

namespace warpshadow {

/// Direction in which importance is spread most.
template <typename T> struct principal_axis_result {
    T angle;      ///< to the map's u axis, in (−π/2, π/2]; 0 where there is no direction
    T elongation; ///< difference of the variances along and across over their sum, 0 to 1
    glm::vec<2, T> centre; ///< mean position in map space; (½, ½) without importance
    status flags;
};

/// How the frame follows the axis.
template <typename T> struct axis_options {
    /// Turning begins when elongation · |sin 2δ| exceeds this, δ the angle between frame and axis:
    /// 0 always turns, 1 never does.
    T hysteresis = T(0.1);
    T slew = T(0.00436332312998582394); ///< largest rotation per call in radians: 0.25°
};

/// What is kept from one frame to the next: one per light, initially default.
struct axis_state {
    double angle = 0.0; ///< of the frame to the light's right axis, radians, in [−π, π]
    bool started = false;
    int way = 0; ///< 1 or −1 while turning, else 0
};

namespace detail {

/// Axis of the second moments (uu, uv, vv), all divided by the same positive number.
inline void axis_of_moments(double uu, double uv, double vv, double& angle, double& elongation) {
    const double along = uu - vv;
    const double across = 2.0 * uv;
    const double spread = uu + vv;
    const double difference = std::sqrt(along * along + across * across);
    if (!(spread > 0.0) || !(difference > 0.0)) {
        return;
    }
    // twice the angle has one direction where the axis has two
    angle = 0.5 * std::atan2(across, along);
    elongation = difference < spread ? difference / spread : 1.0;
}

} // namespace detail

/// Principal axis of a map of importance, in the proportions of the scene.
///
/// Each cell counts at its centre. Errors of the angle are those of the moments, about
/// 2⁻⁵⁰ / elongation. Turning the map by a quarter turns the axis by one.
/// @param counts importance; `fits(counts)`
/// @param extent lengths of the map's sides in the scene, for spot and point lights in slopes;
///               positive and finite, else (1, 1) and `invalid_input`
/// @return       elongation 0 and `empty_importance` for a map of zeros; `buffer_too_small` if the
///               map does not fit its memory
template <typename T>
principal_axis_result<T> principal_axis(const count_view& counts, glm::vec<2, T> extent) {
    principal_axis_result<T> result{T(0), T(0), glm::vec<2, T>(T(0.5)), status::ok};
    if (!fits(counts)) {
        result.flags = status::buffer_too_small;
        return result;
    }
    glm::dvec2 side(extent);
    if (!(side.x > 0.0 && side.y > 0.0) || !detail::all_finite(side)) {
        side = glm::dvec2(1.0);
        result.flags |= status::invalid_input;
    }
    side /= glm::max(side.x, side.y);
    // in cells from the middle of the map, doubled: whole numbers, so that a mirrored map has
    // mirrored sums
    const auto from_middle = [](int i, int cells) { return double(2 * i + 1 - cells); };
    double weight = 0.0;
    glm::dvec2 first(0.0);
    std::size_t cell = 0;
    for (int j = 0; j < counts.height; ++j) {
        double row = 0.0;
        double along = 0.0;
        for (int i = 0; i < counts.width; ++i, ++cell) {
            const double n = double(counts.counts[cell]);
            row += n;
            along += n * from_middle(i, counts.width);
        }
        weight += row;
        first.x += along;
        first.y += row * from_middle(j, counts.height);
    }
    if (!(weight > 0.0)) {
        result.flags |= status::empty_importance;
        return result;
    }
    const glm::dvec2 mean = first / weight;
    const glm::dvec2 size(double(counts.width), double(counts.height));
    result.centre = glm::vec<2, T>(mean / size * 0.5 + 0.5);

    double uu = 0.0;
    double uv = 0.0;
    double vv = 0.0;
    cell = 0;
    for (int j = 0; j < counts.height; ++j) {
        double row = 0.0;
        double along = 0.0;
        for (int i = 0; i < counts.width; ++i, ++cell) {
            const double n = double(counts.counts[cell]);
            const double x = from_middle(i, counts.width) - mean.x;
            row += n;
            along += n * x;
            uu += n * x * x;
        }
        const double y = from_middle(j, counts.height) - mean.y;
        uv += along * y;
        vv += row * y * y;
    }
    const glm::dvec2 scale = side / size;
    double angle = 0.0;
    double elongation = 0.0;
    detail::axis_of_moments(uu * scale.x * scale.x / weight, uv * scale.x * scale.y / weight,
                            vv * scale.y * scale.y / weight, angle, elongation);
    result.angle = static_cast<T>(angle);
    result.elongation = static_cast<T>(elongation);
    return result;
}

/// Turns a frame towards an axis, the short way to the next quarter, no faster than the slew.
///
/// The sides of a map are alike, so axes that differ by 90° ask for the same frame: an axis that
/// jumps by 90° or 180° does not move it. Half-way between two quarters the way that was begun is
/// kept. The first call that is given an axis takes it at once if that pays.
/// @param axis    in the light's own frame: an angle that was found in a turned map plus that of
///                the map; NaN turns nothing
/// @param elongation of `principal_axis`; what is not positive turns nothing
/// @param options negative numbers and NaN count as 0
/// @param state   of the previous frame; updated
/// @return        the frame's angle, `state.angle`
template <typename T>
T turn_to_axis(T axis, T elongation, const axis_options<T>& options, axis_state& state) {
    const double quarter = 1.57079632679489661923;
    const double hysteresis = options.hysteresis > T(0) ? double(options.hysteresis) : 0.0;
    const double slew = options.slew > T(0) ? double(options.slew) : 0.0;
    const double strength = elongation > T(0) ? glm::min(double(elongation), 1.0) : 0.0;
    double way = std::remainder(double(axis) - state.angle, quarter);
    if (!(std::abs(way) <= quarter) || !(strength > 0.0)) {
        // no axis: at rest until there is one
        state.way = 0;
        return static_cast<T>(state.angle);
    }
    const double gain = strength * std::abs(std::sin(2.0 * way));
    if (!state.started) {
        state.started = true;
        state.angle =
            gain > hysteresis ? std::remainder(state.angle + way, 4.0 * quarter) : state.angle;
        return static_cast<T>(state.angle);
    }
    if (state.way == 0) {
        state.way = gain > hysteresis ? (way < 0.0 ? -1 : 1) : 0;
    } else if (way * state.way < 0.0 && std::abs(way) > 0.25 * quarter) {
        way += state.way * quarter; // on, rather than back
    }
    if (state.way != 0) {
        state.angle = std::remainder(state.angle + glm::clamp(way, -slew, slew), 4.0 * quarter);
        state.way = std::abs(way) > slew ? (way < 0.0 ? -1 : 1) : 0;
    }
    return static_cast<T>(state.angle);
}

/// A turned map and the lengths of its sides.
template <typename T> struct turned_map {
    glm::mat<4, 4, T> matrix;
    glm::vec<2, T> extent;
    status flags;
};

/// Light matrix with the map turned about its centre: the smallest that holds the whole old map.
///
/// Crop it to what is seen afterwards (`desired_view`, `cropped`). Depth does not change.
/// @param light  clip space from the scene
/// @param extent lengths of the map's sides in the scene, positive and finite
/// @param angle  of the new u axis to the old one, radians, against the clock where v points up
/// @return       `light` as it was, and invalid_input, for an extent or angle that is none;
///               the same and out_of_range if T cannot hold the result
template <typename T>
turned_map<T> turned(const glm::mat<4, 4, T>& light, glm::vec<2, T> extent, T angle) {
    turned_map<T> result{light, extent, status::ok};
    const glm::dvec2 old(extent);
    if (!(old.x > 0.0 && old.y > 0.0) || !detail::all_finite(old) ||
        !std::isfinite(double(angle))) {
        result.flags = status::invalid_input;
        return result;
    }
    const double c = std::cos(double(angle));
    const double s = std::sin(double(angle));
    const double longer = glm::max(old.x, old.y);
    const glm::dvec2 from = old / longer;
    const glm::dvec2 to(std::abs(c) * from.x + std::abs(s) * from.y,
                        std::abs(s) * from.x + std::abs(c) * from.y);
    glm::mat<4, 4, double> matrix(light);
    for (glm::length_t k = 0; k < 4; ++k) {
        const glm::dvec2 p(matrix[k].x * from.x, matrix[k].y * from.y);
        matrix[k].x = (c * p.x + s * p.y) / to.x;
        matrix[k].y = (c * p.y - s * p.x) / to.y;
    }
    if (!detail::fits<T>(matrix) || !detail::fits<T>(to * longer)) {
        result.flags = status::out_of_range;
        return result;
    }
    return {glm::mat<4, 4, T>(matrix), glm::vec<2, T>(to * longer), status::ok};
}

} // namespace warpshadow
