// How much a warp wins, and how to weaken it where it wins too little.
//
// The share of wrong pixels goes with the side of the texels where the view looks. What tables do
// to that side is known from them alone: det J is the area of map that a unit of area receives, so
// the side shrinks by det J^(-1/2). Its mean over the view samples predicts the gain before a
// triangle is drawn. Where little is won the warp is not worth its price, and noise may turn the
// little into a loss: functions are mixed with the identity, continuously, down to none. A mix of
// increasing functions increases; the map stays one to one.
#pragma once

#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include <cstddef>
#include <span>

namespace warpshadow {

/// Side of a texel at a place relative to a map without tables: det J^(-1/2).
///
/// @param rows, columns tables of `warp`
/// @param p             position in map space
/// @return              above 0; at most 1 / ε for a density floor ε
template <typename T, typename Node>
T texel_side(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
             glm::vec<2, T> p) {
    T area = glm::determinant(jacobian(rows, columns, p));
    return area > T(0) ? T(1) / glm::sqrt(area) : T(1);
}

/// Mean of `texel_side` over view samples; 1 where there are none.
///
/// @param rows, columns tables of `warp`
/// @param samples       positions of lit-facing view samples in map space
template <typename T, typename Node>
T mean_texel_side(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                  std::span<const glm::vec<2, T>> samples) {
    double sum = 0.0;
    for (const glm::vec<2, T>& p : samples) {
        sum += static_cast<double>(texel_side(rows, columns, p));
    }
    return samples.empty() ? T(1) : static_cast<T>(sum / static_cast<double>(samples.size()));
}

/// Mean side up to which a warp is left as it is, and from which on there is none.
template <typename T> inline constexpr T side_of_full_warp = T(0.95);
template <typename T> inline constexpr T side_of_no_warp = T(1);

/// Share λ of the identity to be mixed into tables.
///
/// @param mean_side of `mean_texel_side`; NaN counts as no gain
/// @return          0 to 1, continuous and increasing
template <typename T> T weakening(T mean_side) {
    T share = (mean_side - side_of_full_warp<T>) / (side_of_no_warp<T> - side_of_full_warp<T>);
    return share < T(1) ? glm::max(share, T(0)) : T(1);
}

/// Node k of a function after the mix.
///
/// F(0) = 0 and F(1) = 1 stay, and equal nodes of different functions stay equal.
/// @param node  F(k / cells)
/// @param k     node, 0 ≤ k ≤ cells
/// @param cells cells of the function, positive
/// @param share λ of `weakening`
template <typename T> T weakened_node(T node, int k, int cells, T share) {
    T x = T(k) / T(cells);
    // exact at both ends of the mix
    return share < T(1) ? node + share * (x - node) : x;
}

} // namespace warpshadow
