// Cascaded shadow maps: where to split the view, and the slices between the splits.
//
// Zhang et al. 2006 (parallel-split shadow maps), Lauritzen et al. 2011 (sample distribution shadow
// maps). A slice is an ordinary frustum: any fit of this library makes its map, `stable_fit` for
// maps that hold still, `minimal_shadow_frustum` or `desired_view` for small ones.
#pragma once

#include <warpshadow/detail/finite.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/stable_fit.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// Distance at which a cascade ends, between even and logarithmic splits: Zhang et al. 2006, eq. 5.
///
/// λ n (f/n)^s + (1 − λ) (n + (f − n) s) for the share s = number / count; near and far exactly at
/// the ends. For a perspective camera logarithmic splits spread the aliasing evenly over the
/// cascades and give most of them to the first metres; the practical split lies between.
/// @param near_distance,far_distance of what is to be split, 0 < near < far, far / near finite
/// @param number 0 to count
/// @param count  number of cascades, positive
/// @param lambda 0 for even splits, 1 for logarithmic ones
template <typename T>
T split_distance(T near_distance, T far_distance, int number, int count, T lambda) {
    if (number <= 0) {
        return near_distance;
    }
    if (number >= count) {
        return far_distance;
    }
    T share = T(number) / T(count);
    T logarithmic = near_distance * glm::pow(far_distance / near_distance, share);
    T even = near_distance + (far_distance - near_distance) * share;
    // as a sum of positive terms: even - logarithmic would cost the small splits their digits
    T between = lambda * logarithmic + (T(1) - lambda) * even;
    // rounding must not carry a split past its ends
    return glm::clamp(between, near_distance, far_distance);
}

/// Number of the cascade that a depth belongs to, 0 to 3.
///
/// A depth at a border belongs to the cascade behind it, one beyond the last border to the last; a
/// NaN to 0.
/// @param depth along the view axis
/// @param ends  depths at which cascades 0, 1, 2 and 3 end, growing; unused ones +infinity or the
///              last depth
template <typename T> int cascade_of(T depth, glm::vec<4, T> ends) {
    return (depth >= ends.x ? 1 : 0) + (depth >= ends.y ? 1 : 0) + (depth >= ends.z ? 1 : 0);
}

/// Share of the next cascade in a blend across a border: 0 until the band begins, 1 at the border.
///
/// The next cascade must reach back over the band: slices take the same `overlap`.
/// @param depth   along the view axis
/// @param end     where the cascade ends
/// @param overlap length of the band as a share of `end`, 0 to 1; 0: none
template <typename T> T cascade_blend(T depth, T end, T overlap) {
    T band = end * overlap;
    if (band > T(0)) {
        return glm::clamp((depth - (end - band)) / band, T(0), T(1));
    }
    return depth >= end ? T(1) : T(0);
}

/// What splitting a depth range met.
struct split_result {
    std::size_t count = 0; ///< cascades; splits written is one more
    status flags = status::ok;
};

/// Splits a range of depths along the view axis into cascades.
///
/// Near and far distances of cascade i are splits[i] and splits[i + 1]; they never decrease, and
/// strictly grow as long as T holds numbers between.
/// - near ≤ 0, or a ratio that T cannot hold: near is raised to far·2^-20, `near_clamped`;
/// - far at or below near: far = near·(1 + 2^-10), `out_of_range`;
/// - infinite far: `unbounded`, far = near·2^20: give the distance up to which shadows are wanted;
/// - NaN, or nothing positive: one range 1 to 2, `invalid_input`;
/// - λ outside [0, 1] or NaN: clamped, NaN to ½: `out_of_range`;
/// - fewer than two splits: nothing is written, `buffer_too_small`.
/// @param near_distance,far_distance of the camera (parallel-split), or of the nearest and farthest
///               sample seen (sample distribution), see `sample_range`
/// @param lambda see `split_distance`
/// @param splits one more than the number of cascades
template <typename T>
split_result split_depths(T near_distance, T far_distance, T lambda, std::span<T> splits) {
    split_result result;
    if (splits.size() < 2 || splits.size() > std::size_t(1) << 20) {
        result.flags = status::buffer_too_small;
        return result;
    }
    result.count = splits.size() - 1;
    T lo = near_distance;
    T hi = far_distance;
    if (!(hi > T(0)) || std::isnan(lo) || std::isinf(lo)) {
        lo = T(1);
        hi = T(2);
        result.flags |= status::invalid_input;
    }
    if (std::isinf(hi)) {
        result.flags |= status::unbounded;
        hi = lo > T(0) && lo < std::numeric_limits<T>::max() / T(0x1p20)
                 ? lo * T(0x1p20)
                 : std::numeric_limits<T>::max();
    }
    if (!(lo > T(0)) || !(hi / lo <= std::numeric_limits<T>::max())) {
        lo = hi * static_cast<T>(detail::near_floor);
        lo = lo > T(0) ? lo : hi; // the least numbers of T have no smaller ones
        result.flags |= status::near_clamped;
    }
    if (!(hi > lo)) {
        hi = lo + lo * T(0x1p-10);
        hi = hi <= std::numeric_limits<T>::max() ? hi : lo;
        result.flags |= status::out_of_range;
    }
    T weight = lambda;
    if (!(weight >= T(0) && weight <= T(1))) {
        weight = weight < T(0) ? T(0) : weight > T(1) ? T(1) : T(0.5);
        result.flags |= status::out_of_range;
    }
    const int count = static_cast<int>(result.count);
    for (int i = 0; i <= count; ++i) {
        T split = split_distance(lo, hi, i, count, weight);
        const auto at = static_cast<std::size_t>(i);
        splits[at] = i > 0 && split < splits[at - 1] ? splits[at - 1] : split;
    }
    return result;
}

/// Nearest and farthest depth among samples, for splits that follow what is seen.
template <typename T> struct sample_range_result {
    T nearest = T(0);
    T farthest = T(0);
    std::uint64_t counted = 0;
    status flags = status::ok; ///< samples_rejected, empty_importance
};

/// Range of the depths of the view samples that a light can reach (Lauritzen et al. 2011).
///
/// @param depths along the view axis; those that are not positive and finite do not count
template <typename T> sample_range_result<T> sample_range(std::span<const T> depths) {
    sample_range_result<T> range;
    for (const T depth : depths) {
        if (depth > T(0) && depth <= std::numeric_limits<T>::max()) {
            range.nearest = range.counted == 0 || depth < range.nearest ? depth : range.nearest;
            range.farthest = depth > range.farthest ? depth : range.farthest;
            ++range.counted;
        }
    }
    range.flags |= range.counted < depths.size() ? status::samples_rejected : status::ok;
    range.flags |= range.counted == 0 ? status::empty_importance : status::ok;
    return range;
}

/// The part of a view between two distances, reaching back for a blend with the part before.
///
/// The near distance of the view bounds it from below; an overlap outside [0, 1) counts as 0.
/// @param camera    the whole view
/// @param nearest,farthest two neighbouring splits, along the view axis
/// @param overlap   share of `nearest` that the slice begins earlier, as `cascade_blend` has it
template <typename T>
frustum<T> cascade_slice(const frustum<T>& camera, T nearest, T farthest, T overlap) {
    frustum<T> slice = camera;
    const T back = overlap >= T(0) && overlap < T(1) ? nearest * (T(1) - overlap) : nearest;
    slice.volume.near_distance = glm::max(back, camera.volume.near_distance);
    slice.volume.far_distance = farthest;
    return slice;
}

/// What stable cascades are asked for.
template <typename T> struct cascade_options {
    T lambda = T(0.5);                                      ///< of `split_distance`
    T overlap = T(0);                                       ///< see `cascade_blend`
    T shadow_distance = std::numeric_limits<T>::infinity(); ///< shadows end here, or at far
    stable_options<T> fit{};                                ///< of each cascade
};

/// One cascade: its slice of the view, and its map.
template <typename T> struct cascade {
    T nearest;            ///< of the slice, along the view axis, overlap included
    T farthest;           ///< where it ends
    stable_result<T> fit; ///< see `stable_fit`
};

/// Fits stable maps to the cascades of a view: practical splits, texels that hold still.
///
/// Splits depend on the camera's volume alone, so turning and moving changes no texel's size. Each
/// cascade carries the flags of its fit; what splitting met is returned and described at
/// `split_depths`.
/// @param camera  world space
/// @param source  directional
/// @param scene   world space: casters and receivers
/// @param options see there
/// @param splits  scratch, one more than cascades; holds the splits afterwards
/// @param[out] cascades one for each slice, nearest first
template <typename T>
split_result fit_cascades(const frustum<T>& camera, const light<T>& source, const box3<T>& scene,
                          const cascade_options<T>& options, std::span<T> splits,
                          std::span<cascade<T>> cascades) {
    split_result result;
    if (cascades.empty() || splits.size() != cascades.size() + 1) {
        result.flags = status::buffer_too_small;
        return result;
    }
    const T limit = options.shadow_distance > T(0) ? options.shadow_distance
                                                   : std::numeric_limits<T>::infinity();
    const T end = glm::min(camera.volume.far_distance, limit);
    result = split_depths(camera.volume.near_distance, end, options.lambda, splits);
    for (std::size_t i = 0; i < result.count; ++i) {
        frustum<T> slice =
            cascade_slice(camera, splits[i], splits[i + 1], i == 0 ? T(0) : options.overlap);
        cascades[i].nearest = slice.volume.near_distance;
        cascades[i].farthest = slice.volume.far_distance;
        cascades[i].fit = stable_fit(slice, source, scene, options.fit);
    }
    return result;
}

} // namespace warpshadow
