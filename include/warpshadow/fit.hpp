// Fitting the map to what is seen: the desired view, and the crop that focuses a light matrix.
#pragma once

#include <warpshadow/detail/finite.hpp>
#include <warpshadow/status.hpp>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <cstdint>
#include <span>

namespace warpshadow {

/// A rectangle of map space.
template <typename T> struct map_rect {
    glm::vec<2, T> lo; ///< least u and v
    glm::vec<2, T> hi; ///< largest u and v
};

/// The rectangle of the view samples and what finding it met.
template <typename T> struct desired_view_result {
    map_rect<T> rect;           ///< [0, 1]² where there is no sample
    std::uint64_t counted = 0;  ///< samples in the map
    std::uint64_t rejected = 0; ///< samples outside the map, or with a NaN
    status flags = status::ok;  ///< samples_rejected, empty_importance, degenerate_extent
};

/// Smallest side of a desired view, as a share of the map it is cut from: 2⁻¹⁶.
///
/// A rectangle of no extent has no crop; smaller ones would magnify the rounding of the light
/// matrix itself.
template <typename T> inline constexpr T smallest_desired_extent = T(1) / T(65536);

/// Widens one side of a desired view by a margin and to the smallest extent, inside [0, 1].
///
/// @param lo            least coordinate
/// @param hi            largest coordinate, not less than lo
/// @param margin        share of the side added at either end, so that no sample lies on the border
/// @param[out] widened_lo  lower end
/// @param[out] widened_hi  upper end
/// @return              whether the side was shorter than `smallest_desired_extent`
template <typename T> bool widen_side(T lo, T hi, T margin, T& widened_lo, T& widened_hi) {
    T least = smallest_desired_extent<T>;
    T extent = hi - lo;
    bool widened = extent < least;
    T grow = (widened ? T(0.5) * (least - extent) : T(0)) + margin * (widened ? least : extent);
    widened_lo = lo - grow > T(0) ? lo - grow : T(0);
    widened_hi = hi + grow < T(1) ? hi + grow : T(1);
    // cut at one border: what is missing grows at the other end
    if (widened_hi - widened_lo < least) {
        if (widened_lo > T(0)) {
            widened_lo = widened_hi - least;
        } else {
            widened_hi = widened_lo + least;
        }
    }
    return widened;
}

/// Bounds of the view samples in map space: the "desired view" of Rosen 2012 and Milet et al. 2015.
///
/// Whatever shadows a sample lies on the same ray of light, hence at the same place of the map: the
/// rectangle loses no caster.
/// @param samples positions in map space; those outside the unit square and NaN are rejected
/// @param margin  share of each side added at either end; half a texel of a map of w texels is
///                0.5 / (w − 1). Negative values and NaN count as 0
template <typename T>
desired_view_result<T> desired_view(std::span<const glm::vec<2, T>> samples, T margin) {
    desired_view_result<T> result;
    glm::vec<2, T> lo(T(1));
    glm::vec<2, T> hi(T(0));
    for (const glm::vec<2, T>& p : samples) {
        if (p.x >= T(0) && p.x <= T(1) && p.y >= T(0) && p.y <= T(1)) {
            lo.x = p.x < lo.x ? p.x : lo.x;
            lo.y = p.y < lo.y ? p.y : lo.y;
            hi.x = p.x > hi.x ? p.x : hi.x;
            hi.y = p.y > hi.y ? p.y : hi.y;
            ++result.counted;
        } else {
            ++result.rejected;
        }
    }
    if (result.rejected != 0) {
        result.flags |= status::samples_rejected;
    }
    if (result.counted == 0) {
        result.rect = {glm::vec<2, T>(T(0)), glm::vec<2, T>(T(1))};
        result.flags |= status::empty_importance;
        return result;
    }
    const T grow = margin > T(0) ? (margin < T(1) ? margin : T(1)) : T(0);
    const bool flat_u = widen_side(lo.x, hi.x, grow, result.rect.lo.x, result.rect.hi.x);
    const bool flat_v = widen_side(lo.y, hi.y, grow, result.rect.lo.y, result.rect.hi.y);
    if (flat_u || flat_v) {
        result.flags |= status::degenerate_extent;
    }
    return result;
}

/// Position inside a rectangle of the map, scaled to the unit square.
///
/// @param rect rectangle with sides of positive length
/// @param p    position in the map that the rectangle was cut from
template <typename T> glm::vec<2, T> crop(const map_rect<T>& rect, glm::vec<2, T> p) {
    return (p - rect.lo) / (rect.hi - rect.lo);
}

/// Light matrix whose map is the given rectangle of the original map, with nothing guarded.
///
/// The map is NDC · ½ + ½; depth is unchanged. For shaders, which crop what they have just found;
/// see `crop_matrix` for everything else.
/// @param light clip-from-world matrix of the light
/// @param lo    least u and v of the rectangle
/// @param hi    largest u and v, above lo
template <typename T>
glm::mat<4, 4, T> cropped(const glm::mat<4, 4, T>& light, glm::vec<2, T> lo, glm::vec<2, T> hi) {
    // NDC' = NDC / extent + (1 − 2 lo) / extent − 1, from map' = (map − lo) / extent
    glm::vec<2, T> scale = T(1) / (hi - lo);
    glm::vec<2, T> shift = (T(1) - T(2) * lo) * scale - T(1);
    glm::mat<4, 4, T> result = light;
    for (int column = 0; column < 4; ++column) {
        result[column].x = scale.x * light[column].x + shift.x * light[column].w;
        result[column].y = scale.y * light[column].y + shift.y * light[column].w;
    }
    return result;
}

/// A cropped light matrix.
template <typename T> struct crop_result {
    glm::mat<4, 4, T> matrix;  ///< crop · light
    status flags = status::ok; ///< invalid_input: the light matrix came back as it was
};

/// Light matrix whose map is the given rectangle of the original map; depth is unchanged.
///
/// The map is NDC · ½ + ½. Built in double and rounded once.
/// @param light clip-from-world matrix of the light
/// @param rect  rectangle of its map; a side of no length, a NaN, or a crop that is not finite in
///              T leaves the matrix as it is
template <typename T>
crop_result<T> crop_matrix(const glm::mat<4, 4, T>& light, const map_rect<T>& rect) {
    const glm::dvec2 lo(rect.lo);
    const glm::dvec2 extent = glm::dvec2(rect.hi) - lo;
    const double largest = 1.0e6; // sides of a million maps are an error, not a wish
    if (!(extent.x > 0.0 && extent.y > 0.0 && extent.x < largest && extent.y < largest) ||
        !(lo.x > -largest && lo.x < largest && lo.y > -largest && lo.y < largest)) {
        return {light, status::invalid_input};
    }
    const glm::dmat4 result = cropped(glm::dmat4(light), lo, glm::dvec2(rect.hi));
    if (!detail::fits<T>(result)) {
        return {light, status::invalid_input};
    }
    return {glm::mat<4, 4, T>(result), status::ok};
}

} // namespace warpshadow
