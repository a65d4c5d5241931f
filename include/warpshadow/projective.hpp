// A projective warp fitted to the view samples: one matrix, straight lines, no tessellation.
//
// The family is that of LiSPSM, w(p) = 1 + k·(u·p - min u·p) over the light's map with w running
// from 1 to e^rho, and the map fitted to the samples afterwards. LiSPSM chooses direction and rho
// for the worst case over the whole frustum; here they minimise the mean size of a texel over the
// samples that are there,
//
//     E = mean of weight · |det J|^(-1/2),     det J = det H / w^3 for the homography H,
//
// from a histogram of the samples in map space. E is compared with that of the unwarped map,
// fitted to the same samples, and never larger.
#pragma once

#include <warpshadow/clip_space.hpp>
#include <warpshadow/detail/bent_map.hpp>
#include <warpshadow/detail/finite.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/status.hpp>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// Largest number of cells along a side of a histogram.
inline constexpr int largest_histogram = detail::largest_side;

/// What can be asked of the fit.
template <typename T> struct projective_options {
    T strongest = T(5); ///< largest rho, 0 to 8; e^rho is the ratio of w over the samples
    T margin = T(0);    ///< share of the fitted map left free at each side, for a filter; 0 to 1/4
    /// How far around the samples, in the map before the warp, clip w stays at or above 1 and
    /// casters keep their depth: the reach of the filter and of what moves until the next fit.
    T reach = T(1) / T(64);
    T least_gain = T(1); ///< below this gain the map stays uniform; 1.05 spares what nobody sees
    /// Turn the map's sides along the bend where that gains 5 %: a view that crosses the map at an
    /// angle wastes the corners of its bounding box. Off: the sides stay those of the light's map.
    bool turn = true;
    T aspect = T(1); ///< width of the light's map over its height, as lengths in the scene;
                     ///< 2^-20 to 2^20
    T largest_step = std::numeric_limits<T>::infinity(); ///< change of `bend` since the last state
    T largest_turn = std::numeric_limits<T>::infinity(); ///< change of `angle`, in radians
    /// What the fitted map must hold: the corners of any polygon in map space, a focused body say.
    /// None: all cells with a sample. Their edges step by a cell as samples come and go; a polygon
    /// that moves smoothly makes a map that does.
    std::span<const glm::vec<2, T>> domain = {};
};

/// What the caller keeps from one frame to the next.
template <typename T> struct projective_state {
    glm::vec<2, T> bend{T(0)}; ///< rho times the direction in which w grows, in map space
    T angle = T(0);            ///< by which the map's sides are turned, in radians
    bool turned = false;       ///< whether turning was worth it
    bool started = false;      ///< false: the next fit takes its optimum at once
};

/// A fitted warp of map space.
template <typename T> struct projective_result {
    glm::mat<3, 3, T> map;     ///< homogeneous map position to fitted map position
    projective_state<T> state; ///< for the next frame
    T rho;                     ///< strength, 0 if uniform
    T gain;                    ///< E of the unwarped map over E, at least 1
    status flags;
};

/// Position in the fitted map.
///
/// @param map homography of a `projective_result`
/// @param p   position in map space at which the third row is positive, as it is over the domain
template <typename T>
glm::vec<2, T> fitted_position(const glm::mat<3, 3, T>& map, glm::vec<2, T> p) {
    glm::vec<3, T> q = map * glm::vec<3, T>(p.x, p.y, T(1));
    return glm::vec<2, T>(q.x / q.z, q.y / q.z);
}

/// Fits the warp to a histogram of the lit-facing view samples in map space.
///
/// `weights`: width · height cells, row after row, as in `count_map`; counts, or for a light with a
/// position the sum over the samples of their distance along the light's axis, so that E is a
/// length in the scene. NaN, infinite and negative weights count as none.
/// `width`, `height`: 1 to `largest_histogram`; 64 × 64 does. Samples that crowd in a single cell
/// are not told apart: fit again in the fitted map, with the weights times w^(3/2), and multiply.
/// `previous`: the state of the last frame, of the same light and a map fitted in the same way. The
/// bend then moves by `largest_step` and the sides by `largest_turn` at most, unless that would be
/// worse than the unwarped map: the bend is shortened until it is not. Without a state each fit is
/// the best for its samples alone, and the sides may change by a quarter turn from one to the next.
///
/// Deterministic; scaling all weights by a power of two changes no bit. Casters need no margin of
/// their own: a caster lies on the light ray of the sample that it shades, hence at the same place
/// of the map.
/// No sample gives the identity and `empty_importance`; sizes out of range or too few weights the
/// identity and `invalid_input`. Where no warp gains anything the map is fitted but not bent:
/// `stayed_uniform`. Samples on a line or in a point are given an extent (`degenerate_extent`).
template <typename T, typename Weight>
projective_result<T> fit_projective(std::span<const Weight> weights, int width, int height,
                                    const projective_options<T>& options = {},
                                    const projective_state<T>& previous = {}) {
    projective_result<T> result{glm::mat<3, 3, T>(T(1)), previous, T(0), T(1), status::ok};
    if (width < 1 || height < 1 || width > largest_histogram || height > largest_histogram ||
        weights.size() < static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
        result.flags = status::invalid_input | status::stayed_uniform;
        return result;
    }
    const detail::histogram<Weight> histogram{weights, width, height};
    detail::condensed samples;
    detail::condense(histogram, samples);
    if (!(samples.total > 0.0)) {
        result.flags = status::empty_importance | status::stayed_uniform;
        return result;
    }
    detail::restrict_region(options.domain, samples.region, samples.centre, result.flags);

    const double most = std::numeric_limits<double>::max();
    const double strongest = detail::bounded(options.strongest, 0.0, 8.0);
    const double aspect =
        options.aspect > T(0) ? detail::bounded(options.aspect, 0x1p-20, 0x1p20) : 1.0;
    const detail::texel_objective objective{samples, detail::bounded(options.reach, 0.0, 1.0),
                                            aspect, options.turn};
    const auto size = [&](const detail::bent_map& bent) {
        return bent.scale() * detail::mean_shrinkage(histogram, bent.warp, samples);
    };
    const detail::map_axes upright = detail::upright_axes(aspect);
    const double uniform = size(objective.map(glm::dvec2(0.0), upright));
    glm::dvec2 bend = detail::best_bend(objective, strongest);
    double angle = 0.0;
    const detail::bent_map straight = objective.map(bend, upright);
    const double shrinkage = detail::mean_shrinkage(histogram, straight.warp, samples);
    double value = straight.scale() * shrinkage;
    bool turned = false;
    if (options.turn) {
        const detail::map_axes along = detail::axes_along(bend, aspect);
        // once turned the map stays so while that gains anything
        const double demand = previous.started && previous.turned ? 1.0 : 1.05;
        const double size_along = objective.map(bend, along).scale() * shrinkage;
        if (size_along * demand < value) {
            turned = true;
            value = size_along;
            angle = std::atan2(along.x.y, along.y.y);
        }
    }
    if (!(value * std::fmax(static_cast<double>(options.least_gain), 1.0) < uniform)) {
        bend = glm::dvec2(0.0);
        angle = 0.0;
        turned = false;
        value = uniform;
    }
    detail::bent_map bent = objective.map(bend, detail::turned_axes(angle, aspect));
    const glm::dvec2 last(previous.bend);
    const double last_angle = static_cast<double>(previous.angle);
    if (previous.started && detail::all_finite(last) && std::isfinite(last_angle)) {
        const double step = detail::bounded(options.largest_step, 0.0, most);
        const double turn = detail::bounded(options.largest_turn, 0.0, most);
        bend = detail::shortened(last + detail::shortened(bend - last, step), strongest);
        // the sides of a rectangle: a quarter turn is no turn
        const double target = detail::nearest_turn(angle, detail::quarter_turn, last_angle);
        angle = last_angle + std::fmin(std::fmax(target - last_angle, -turn), turn);
        angle = detail::nearest_turn(angle, 4.0 * detail::quarter_turn, 0.0);
        const detail::map_axes axes = detail::turned_axes(angle, aspect);
        bent = objective.map(bend, axes);
        value = size(bent);
        if (!(value <= uniform)) {
            // the longest bend of this direction that is no worse than none
            double share = 0.0;
            for (double half = 0.5; half > 0x1p-12; half *= 0.5) {
                const bool good = size(objective.map(bend * (share + half), axes)) <= uniform;
                share = good ? share + half : share;
            }
            bend *= share;
            bent = objective.map(bend, axes);
            value = size(bent);
        }
        if (!(value <= uniform)) {
            angle = 0.0;
            turned = false;
            bent = objective.map(bend, upright);
            value = uniform;
        }
    }

    const double margin = detail::bounded(options.margin, 0.0, 0.25);
    bent.x.grow(margin / (1.0 - 2.0 * margin));
    bent.y.grow(margin / (1.0 - 2.0 * margin));
    result.flags |= bent.widened ? status::degenerate_extent : status::ok;
    result.map = glm::mat<3, 3, T>(detail::map_matrix(bent));
    result.state = projective_state<T>{glm::vec<2, T>(bend), static_cast<T>(angle), turned, true};
    result.rho = static_cast<T>(std::sqrt(bend.x * bend.x + bend.y * bend.y));
    result.gain = static_cast<T>(value > 0.0 ? std::fmax(uniform / value, 1.0) : 1.0);
    result.flags |= bend == glm::dvec2(0.0) && angle == 0.0 ? status::stayed_uniform : status::ok;
    return result;
}

/// The same from a count map.
template <typename T>
projective_result<T> fit_projective(const count_view& counts,
                                    const projective_options<T>& options = {},
                                    const projective_state<T>& previous = {}) {
    return fit_projective<T>(counts.counts, counts.width, counts.height, options, previous);
}

/// The same from samples in map space: a histogram of 64 × 64 cells on the stack, 16 KiB.
///
/// `samples`: lit-facing view samples; those outside the map and NaN are not counted
/// (`samples_rejected`).
template <typename T>
projective_result<T> fit_projective(std::span<const glm::vec<2, T>> samples,
                                    const projective_options<T>& options = {},
                                    const projective_state<T>& previous = {}) {
    std::array<std::uint32_t, 64 * 64> counts{};
    const count_map map{counts, 64, 64};
    const splat_result counted = splat(samples, map);
    projective_result<T> result = fit_projective<T>(count_view(map), options, previous);
    result.flags |= counted.flags;
    return result;
}

/// NDC depth that `projective_matrix` leaves where it is, and towards which it draws all others.
///
/// For a light with a position the far plane: its depths crowd there, and what they keep between
/// them is their distance to it. A warp towards any other depth would bury that under the change of
/// w: receivers would become steep, and want far more bias than a caster is away. For sunlight the
/// middle of the range.
template <typename T> constexpr T projective_depth(light_kind kind, clip_space clip) {
    const T farthest = far_depth<T>(clip);
    return kind == light_kind::directional ? T(0.5) * (near_depth<T>(clip) + farthest) : farthest;
}

/// The fitted warp as a matrix to be multiplied from the left to the light's matrix.
///
/// `map`: of a `projective_result`.
/// `clip`: the convention of the light's matrix.
/// `kind`: of the light; a point light's faces are of its kind too.
///
/// Clip w becomes w(p) ≥ 1 times what it was over the domain and its reach, and depth c + (z - c) /
/// w(p) for the light's own z and c of `projective_depth`: monotone along every light ray and
/// inside the depth range, for orthographic and perspective lights, reversed, infinite or not.
/// Where w is large depths crowd together towards c by that factor; the footprint bias knows. The
/// light's own depth comes back from `linear_depth` with (1, c, c).
template <typename T>
glm::mat<4, 4, T> projective_matrix(const glm::mat<3, 3, T>& map, clip_space clip,
                                    light_kind kind) {
    const glm::mat<3, 3, double> h(map);
    const double up = clip.y_down ? -1.0 : 1.0;
    const double centre = projective_depth<double>(kind, clip);
    // map = ½ ndc + ½ on the right, ndc = 2 map - 1 on the left
    glm::mat<4, 4, double> m(0.0);
    const glm::vec<3, double> columns[3] = {0.5 * h[0], 0.5 * up * h[1],
                                            h[2] + 0.5 * h[0] + 0.5 * h[1]};
    const glm::length_t to[3] = {0, 1, 3};
    for (int i = 0; i < 3; ++i) {
        const glm::vec<3, double>& c = columns[i];
        // of depth the warp's w less the light's own, times the centre
        const double own = i == 2 ? 1.0 : 0.0;
        m[to[i]] =
            glm::vec<4, double>(2.0 * c.x - c.z, up * (2.0 * c.y - c.z), centre * (c.z - own), c.z);
    }
    m[2][2] = 1.0;
    return glm::mat<4, 4, T>(m);
}

} // namespace warpshadow
