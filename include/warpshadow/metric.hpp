// Aliasing of a shadow map, as Lloyd measures it: how many pixels of the image a texel covers.
//
// Lloyd et al. 2006 and 2008: m is the largest extent of a shadow-map texel in the image, in
// pixels. m = 1: a texel for each pixel; beyond it the steps of the shadow's edge can be seen. It
// is the product of what the projections and warps do and of how the surface stands; both are
// given, for it is the first alone that a fit or a warp can change.
#pragma once

#include <warpshadow/bias.hpp>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// How the place in the image changes with the place in the scene, in pixels per scene unit.
template <typename T> struct image_gradients {
    glm::vec<3, T> x; ///< of the pixel column
    glm::vec<3, T> y; ///< of the pixel row
};

/// Extent of a shadow-map texel in the image, in pixels.
template <typename T> struct texel_extent {
    T u;       ///< of the texel's side along the map's u
    T v;       ///< along v
    T largest; ///< Lloyd's m: over all directions in the map, the larger singular value
};

/// Gradients of the place in the image at a point of the scene.
///
/// Zero where clip w is not positive (such a point is not in the image), for a NaN, and where T
/// cannot hold them.
/// @param camera clip space from the scene
/// @param p      position in the camera matrix's space
/// @param size   width and height of the image in pixels
template <typename T>
image_gradients<T> image_gradients_at(const glm::mat<4, 4, T>& camera, glm::vec<3, T> p,
                                      glm::vec<2, T> size) {
    image_gradients<T> image;
    image.x = glm::vec<3, T>(T(0));
    image.y = glm::vec<3, T>(T(0));
    glm::vec<4, T> clip = camera * glm::vec<4, T>(p.x, p.y, p.z, T(1));
    if (clip.w > T(0)) {
        glm::vec<3, T> row_x = glm::vec<3, T>(camera[0][0], camera[1][0], camera[2][0]);
        glm::vec<3, T> row_y = glm::vec<3, T>(camera[0][1], camera[1][1], camera[2][1]);
        glm::vec<3, T> row_w = glm::vec<3, T>(camera[0][3], camera[1][3], camera[2][3]);
        glm::vec<3, T> x = (row_x - row_w * (clip.x / clip.w)) * (T(0.5) * size.x / clip.w);
        glm::vec<3, T> y = (row_y - row_w * (clip.y / clip.w)) * (T(0.5) * size.y / clip.w);
        glm::vec<3, T> both = glm::abs(x) + glm::abs(y);
        if (both.x + both.y + both.z <= std::numeric_limits<T>::max()) { // false for a NaN
            image.x = x;
            image.y = y;
        }
    }
    return image;
}

/// Largest factor by which the linear map with these columns stretches a length: its larger
/// singular value.
///
/// Nothing cancels and no square leaves the range of T: within 8 ulp. Zero for zero columns; a NaN
/// stays one.
/// @param a,b columns, finite
template <typename T> T largest_stretch(glm::vec<3, T> a, glm::vec<3, T> b) {
    glm::vec<3, T> most = glm::max(glm::abs(a), glm::abs(b));
    T size = glm::max(most.x, glm::max(most.y, most.z));
    if (size == T(0)) {
        return T(0);
    }
    glm::vec<3, T> u = a / size;
    glm::vec<3, T> v = b / size;
    T uu = glm::dot(u, u);
    T vv = glm::dot(v, v);
    T uv = glm::dot(u, v);
    return size * glm::sqrt(T(0.5) * (uu + vv + glm::length(glm::vec<2, T>(uu - vv, uv + uv))));
}

/// Extent in the image of a texel on a surface that faces both the light and the eye.
///
/// Projections and warps alone, without the surface: what a fit or a warp can do something about
/// (Lloyd's perspective aliasing).
/// @param axes  of the texel at the point, see `texel_axes_at`
/// @param image at the same point, see `image_gradients_at`
/// @param most  positive and finite; given back where the extent is larger, and for a NaN
template <typename T>
texel_extent<T> facing_extent(const texel_axes<T>& axes, const image_gradients<T>& image, T most) {
    glm::vec<3, T> none = glm::vec<3, T>(T(0));
    T pixels = largest_stretch(image.x, image.y); // per scene unit
    texel_extent<T> extent;
    extent.u = most;
    extent.v = most;
    extent.largest = most;
    T largest = pixels * largest_stretch(axes.u, axes.v);
    if (largest <= most) { // false for a NaN
        T along_u = pixels * largest_stretch(axes.u, none);
        T along_v = pixels * largest_stretch(axes.v, none);
        extent.u = along_u <= most ? along_u : most;
        extent.v = along_v <= most ? along_v : most;
        extent.largest = largest;
    }
    return extent;
}

/// Extent in the image of a texel as it lies on the receiver: the surface counts too.
///
/// The texel is carried along its light ray to the surface and from there to the image. A receiver
/// that is parallel to the light has texels without end: `most`, in all three; so have a texel and
/// an image that are not known (zero axes, zero gradients of a point that is not in the image).
/// @param axes   of the texel at the point, see `texel_axes_at`
/// @param image  at the same point, see `image_gradients_at`
/// @param normal of the receiver, any length; scene space
/// @param most   positive and finite; given back where the extent is larger, and for a NaN
template <typename T>
texel_extent<T> surface_extent(const texel_axes<T>& axes, const image_gradients<T>& image,
                               glm::vec<3, T> normal, T most) {
    texel_extent<T> extent;
    extent.u = most;
    extent.v = most;
    extent.largest = most;
    // lengths near 1 keep the products below in range, whatever the unit of the scene is
    T size = largest_stretch(axes.u, axes.v);
    T pixels = largest_stretch(image.x, image.y);
    if (size > T(0) && pixels > T(0)) {
        glm::vec<3, T> u = axes.u / size;
        glm::vec<3, T> v = axes.v / size;
        glm::vec<3, T> x = image.x / pixels;
        glm::vec<3, T> y = image.y / pixels;
        glm::vec<3, T> ray = glm::cross(u, v); // both axes are perpendicular to the light ray
        T facing = glm::dot(normal, ray);
        glm::vec<3, T> on_u = u * facing - ray * glm::dot(normal, u);
        glm::vec<3, T> on_v = v * facing - ray * glm::dot(normal, v);
        glm::vec<3, T> a = glm::vec<3, T>(glm::dot(x, on_u), glm::dot(y, on_u), T(0));
        glm::vec<3, T> b = glm::vec<3, T>(glm::dot(x, on_v), glm::dot(y, on_v), T(0));
        T stretch = largest_stretch(a, b);
        T scale = size * pixels;
        T height = glm::abs(facing);
        // multiplied, not divided, before it is known to fit; false for a NaN
        if (height > T(0) && stretch * scale <= most * height) {
            glm::vec<3, T> none = glm::vec<3, T>(T(0));
            T along_u = largest_stretch(a, none) * scale / height;
            T along_v = largest_stretch(b, none) * scale / height;
            T largest = stretch * scale / height;
            extent.u = along_u <= most ? along_u : most;
            extent.v = along_v <= most ? along_v : most;
            extent.largest = largest <= most ? largest : most;
        }
    }
    return extent;
}

/// What the extents of many samples come to.
template <typename T> struct metric_summary {
    T max = T(0);               ///< largest m
    T p99 = T(0);               ///< m that 99 % of the samples do not exceed
    T p50 = T(0);               ///< median
    T share_above_1 = T(0);     ///< share of samples with m > 1
    T storage_factor = T(0);    ///< texels that m ≤ 1 along u and v would take, over the pixels
    std::uint64_t counted = 0;  ///< samples with a finite m
    std::uint64_t rejected = 0; ///< NaN, infinite or negative: not counted
    status flags = status::ok;  ///< samples_rejected, empty_importance
};

/// Largest, percentiles and share above one pixel of the m of many samples.
///
/// Percentiles are samples: the smallest m that at least that share of the samples does not exceed.
/// The storage factor is Lloyd's: the map's size along u times the largest extent along u, the same
/// along v, over the size of the image; the number of texels per pixel with which no sample would
/// have a side above 1. No sample that counts: zeros and `empty_importance`.
/// @param extents of the samples; their order is changed
/// @param texels  width and height of the map
/// @param pixels  width and height of the image, positive
template <typename T>
metric_summary<T> summarise(std::span<texel_extent<T>> extents, glm::vec<2, T> texels,
                            glm::vec<2, T> pixels) {
    metric_summary<T> summary;
    const auto counts = [](const texel_extent<T>& each) {
        return each.largest >= T(0) && each.largest <= std::numeric_limits<T>::max();
    };
    const auto end = std::partition(extents.begin(), extents.end(), counts);
    const auto count = static_cast<std::size_t>(end - extents.begin());
    summary.counted = count;
    summary.rejected = extents.size() - count;
    summary.flags |= summary.rejected > 0 ? status::samples_rejected : status::ok;
    if (count == 0) {
        summary.flags |= status::empty_importance;
        return summary;
    }
    const auto smaller = [](const texel_extent<T>& a, const texel_extent<T>& b) {
        return a.largest < b.largest;
    };
    const auto at_share = [&](std::size_t hundredths) {
        // the rank-th smallest, rank = ⌈share · count⌉, without rounding the product
        const std::size_t rank =
            (count / 100) * hundredths + ((count % 100) * hundredths + 99) / 100;
        const auto place = extents.begin() + static_cast<std::ptrdiff_t>(rank - 1);
        std::nth_element(extents.begin(), place, end, smaller);
        return place->largest;
    };
    summary.p50 = at_share(50);
    summary.p99 = at_share(99);
    std::size_t above = 0;
    T most_u(0);
    T most_v(0);
    for (const texel_extent<T>& each : extents.first(count)) {
        summary.max = glm::max(summary.max, each.largest);
        above += each.largest > T(1) ? 1 : 0;
        most_u = each.u > most_u ? each.u : most_u;
        most_v = each.v > most_v ? each.v : most_v;
    }
    summary.share_above_1 = static_cast<T>(static_cast<double>(above) / static_cast<double>(count));
    const double needed = static_cast<double>(most_u) * static_cast<double>(texels.x) *
                          static_cast<double>(most_v) * static_cast<double>(texels.y);
    const double has = static_cast<double>(pixels.x) * static_cast<double>(pixels.y);
    const double factor = needed / has;
    summary.storage_factor = factor < static_cast<double>(std::numeric_limits<T>::max())
                                 ? static_cast<T>(factor)
                                 : std::numeric_limits<T>::max();
    return summary;
}

} // namespace warpshadow
