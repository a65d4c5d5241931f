// How warp tables are built, what building them meets, and who builds several rows at once.
#pragma once

#include <warpshadow/smoothing.hpp>
#include <warpshadow/status.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>

namespace warpshadow {

/// How tables are built. The defaults suit outdoor and indoor scenes alike.
template <typename T> struct build_options {
    /// Width of the smoothing window across functions, as a share of their number. Wide windows
    /// make neighbouring functions alike, which the rasteriser's straight edges need; a share of 2
    /// makes all equal (rectilinear warping). Narrow ones follow the samples more closely, and lose
    /// it again where edges are cut no finer than texels.
    T window = T(0.7);
    /// Density floor ε: no part of the map shrinks below this share of its uniform extent.
    T floor = T(0.3);
    /// Weights of the window's rows.
    window_shape shape = window_shape::box;
    /// Half-width of the window in rows, in place of `window`; negative for none.
    int radius = -1;
    /// Shear limit s: each function is mixed with the one that all rows share, all by the same
    /// smallest share λ, so that |∂X/∂y| ≤ s · ∂X/∂x everywhere. Small triangles then rarely turn
    /// over: none of the right triangles of one texel that were tried at s = 1, up to 7 % at s = 2
    /// where every other row pulls the other way. Infinity, the default, is no limit: one steep
    /// place weakens the warp everywhere (λ is 0.99 at s = 2 on clustered samples).
    T shear = std::numeric_limits<T>::infinity();
    /// Warp v first, by one function per column, then u (`build_warp` alone). Evaluate such tables
    /// at (v, u): see `warp_result::v_first`.
    bool v_first = false;
};

/// What building one axis met.
template <typename T> struct build_result {
    std::uint64_t samples = 0; ///< sum of all counts
    int empty_rows = 0;        ///< functions without a sample in their window: the identity
    T floor = T(0);            ///< the density floor that was used
    status flags = status::ok; ///< empty_importance, empty_rows, floor_raised, out_of_range, …
    int radius = 0;            ///< half-width of the window's box in rows
    T mix = T(0);              ///< share λ of the common function that the shear limit took
};

/// Calls a body for 0 to count − 1, one after another: the parallel-for of those who have none.
///
/// One of yours is called in the same way, may call the body for different indices at once, and
/// returns when all have returned.
struct serial_for {
    template <typename Body> void operator()(int count, const Body& body) const {
        for (int i = 0; i < count; ++i) {
            body(i);
        }
    }
};

/// Largest number of bands that are built at once.
inline constexpr int most_bands = 64;

/// Numbers of scratch memory that `build_axis` takes for a map and a number of bands.
///
/// One band takes the width for a box and no shear limit, and up to nine times that.
/// @param width cells of a function, positive
/// @param bands bands built at once, 1 to `most_bands`
template <typename T>
std::size_t scratch_size(int width, const build_options<T>& options, int bands = 1) {
    const std::size_t passes = options.shape == window_shape::box    ? box_sums<1>::memory
                               : options.shape == window_shape::tent ? box_sums<2>::memory
                                                                     : box_sums<3>::memory;
    const bool limited = !(options.shear == std::numeric_limits<T>::infinity());
    const std::size_t band = passes + (limited ? 1 : 0);
    return static_cast<std::size_t>(width) *
           (band * static_cast<std::size_t>(bands) + (limited ? 1 : 0));
}

} // namespace warpshadow
