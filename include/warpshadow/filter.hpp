// Percentage closer filtering under a warp: where the taps lie, and how fine the map is there.
//
// A kernel is a square of taps around the receiver. In texels of the warped map it smooths the
// stairs of the map, which are the finer the more important a place is (Rosen 2012, §6.2). In light
// space, before the warp, it is the size of a penumbra: the same in the scene wherever the map is
// stretched. The comparisons are the renderer's: each tap is compared by itself, and the results
// are weighted, not the depths. Biases want the kernel's reach: `kernel_reach`.
#pragma once

#include <warpshadow/bias.hpp>
#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include <limits>

namespace warpshadow {

/// Place of a tap in its kernel, the square from −1 to 1: one in each cell of a grid.
///
/// @param index  number of the tap, 0 ≤ index < across²
/// @param across taps along each side, positive
/// @param jitter place in the tap's cell, −½ to ½ in each coordinate; 0 is its centre
template <typename T> glm::vec<2, T> kernel_tap(int index, int across, glm::vec<2, T> jitter) {
    int row = index / across;
    glm::vec<2, T> cell = glm::vec<2, T>(T(index - row * across), T(row));
    return (cell + T(0.5) + jitter) * (T(2) / T(across)) - T(1);
}

/// Weight of a tap, a Gaussian cut at the kernel's border; 1 at its middle.
///
/// @param tap        from `kernel_tap`
/// @param deviations standard deviations from the middle to the border's nearest point; 0 for a box
/// @return           0 to 1; 0 where the exponent is not a number
template <typename T> T kernel_weight(glm::vec<2, T> tap, T deviations) {
    T squares = glm::dot(tap, tap) * deviations * deviations;
    return squares >= T(0) ? glm::exp(T(-0.5) * squares) : T(0);
}

/// Taps along each side of a kernel so that no two are farther apart than a texel.
///
/// @param reach half the kernel's sides in texels; negative ones count as 0
/// @param most  largest number, positive
template <typename T> int kernel_taps(glm::vec<2, T> reach, int most) {
    T sides = T(2) * glm::max(reach.x, reach.y);
    // raised and compared before it is converted: int holds no -1e33, and NaN is `most`
    return sides <= T(most) - T(1) ? int(glm::ceil(glm::max(sides, T(1)))) : most;
}

/// Half the sides of a kernel of fixed size in the scene, in units of what `axes` span.
///
/// From axes of a texel they are in texels; from axes of the whole map (`texel_axes_at` with a
/// texel of 1 and the identity) they are the radii that `tap_in_light` takes.
/// @param axes   at the receiver
/// @param radius half the kernel's side in the scene, 0 or more
/// @param most   largest result, positive: where the map is edge-on, and for what is not a number
template <typename T> glm::vec<2, T> kernel_radii(const texel_axes<T>& axes, T radius, T most) {
    T u = glm::length(axes.u);
    T v = glm::length(axes.v);
    return glm::vec<2, T>(radius < most * u ? radius / u : most,
                          radius < most * v ? radius / v : most);
}

/// A tap of a kernel of fixed size in texels of the warped map.
///
/// @param q      the receiver in the warped map
/// @param tap    from `kernel_tap`
/// @param radius half the kernel's side in texels
/// @param texel  1 / width and 1 / height of the map
template <typename T>
glm::vec<2, T> tap_in_texels(glm::vec<2, T> q, glm::vec<2, T> tap, T radius, glm::vec<2, T> texel) {
    return q + tap * radius * texel;
}

/// A tap of a kernel of fixed size in light space: moved first, warped at the last moment.
///
/// @param rows,columns tables of the warp
/// @param p     the receiver in map space before the warp
/// @param tap   from `kernel_tap`
/// @param radii half the kernel's sides, in map space before the warp
template <typename T, typename Node>
glm::vec<2, T> tap_in_light(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                            glm::vec<2, T> p, glm::vec<2, T> tap, glm::vec<2, T> radii) {
    return warp(rows, columns, p + tap * radii);
}

/// The same by the warp's Jacobian at the receiver: no look-up per tap.
///
/// Exact while the kernel stays in one cell of either table and between two centres of their rows;
/// beyond, off by the bend of the warp over the kernel.
/// @param q        the receiver in the warped map
/// @param jacobian of the warp at the receiver
/// @param tap      from `kernel_tap`
/// @param radii    half the kernel's sides, in map space before the warp
template <typename T>
glm::vec<2, T> tap_by_jacobian(glm::vec<2, T> q, const glm::mat<2, 2, T>& jacobian,
                               glm::vec<2, T> tap, glm::vec<2, T> radii) {
    glm::vec<2, T> moved = tap * radii;
    return q + glm::vec<2, T>(jacobian[0][0] * moved.x + jacobian[1][0] * moved.y,
                              jacobian[0][1] * moved.x + jacobian[1][1] * moved.y);
}

/// How far the taps of a kernel in light space reach in the warped map, in texels along u and v.
///
/// The larger of both is the `radius` of `bias_settings`; it decides how many taps the kernel
/// wants.
/// @param jacobian of the warp at the receiver
/// @param radii    half the kernel's sides, in map space before the warp
/// @param texel    1 / width and 1 / height of the map
template <typename T>
glm::vec<2, T> kernel_reach(const glm::mat<2, 2, T>& jacobian, glm::vec<2, T> radii,
                            glm::vec<2, T> texel) {
    return glm::vec<2, T>(
        (glm::abs(jacobian[0][0]) * radii.x + glm::abs(jacobian[1][0]) * radii.y) / texel.x,
        (glm::abs(jacobian[0][1]) * radii.x + glm::abs(jacobian[1][1]) * radii.y) / texel.y);
}

/// Share of the light that arrives: the weighted mean of the comparisons of a kernel.
///
/// @param across     taps along each side, at least 1
/// @param deviations of `kernel_weight`
/// @param lit        lit(tap) compares at a tap of the kernel: 0 in shadow to 1 lit, or a bool
/// @return           1 if no tap has a weight
template <typename T, typename Lit> T filtered_light(int across, T deviations, const Lit& lit) {
    T sum = T(0);
    T weights = T(0);
    for (int i = 0; i < across * across; ++i) {
        const glm::vec<2, T> tap = kernel_tap(i, across, glm::vec<2, T>(T(0)));
        const T weight = kernel_weight(tap, deviations);
        sum += weight * T(lit(tap));
        weights += weight;
    }
    return weights > T(0) ? sum / weights : T(1);
}

/// Maximum effective resolution along an axis: texels of the uniform map that would be as fine as
/// the finest part of the warped one (Rosen 2012, §6).
///
/// Attained: blends of rows are no steeper than the steepest of them.
/// @param table  functions of the axis
/// @param texels of the warped map along it, positive
/// @return       at least `texels`; 0 if `fits(table)` is false
template <typename T, typename Node>
T maximum_effective_resolution(const table_view<T, Node>& table, int texels) {
    T steepest = T(0);
    for (int row = 0; fits(table) && row < table.rows; ++row) {
        for (int k = 0; k < table.cells; ++k) {
            const T step = table_node(table, row, k + 1) - table_node(table, row, k);
            steepest = step > steepest ? step : steepest;
        }
    }
    return steepest * T(table.cells) * T(texels);
}

} // namespace warpshadow
