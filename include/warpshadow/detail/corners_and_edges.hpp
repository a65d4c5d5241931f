// Corners and edges of one volume against the planes of another.
#pragma once

#include <warpshadow/detail/cull_volume.hpp>

#include <glm/common.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace warpshadow::detail {

/// The twelve edges of a volume with eight corners.
inline constexpr std::array<std::array<std::uint8_t, 2>, 12> corner_pairs{{{0, 1},
                                                                           {1, 2},
                                                                           {2, 3},
                                                                           {3, 0},
                                                                           {4, 5},
                                                                           {5, 6},
                                                                           {6, 7},
                                                                           {7, 4},
                                                                           {0, 4},
                                                                           {1, 5},
                                                                           {2, 6},
                                                                           {3, 7}}};

/// Values of the corners of one volume on the planes of another, each raised by its bound, and one
/// bit per plane that a corner lies outside of.
struct outcodes {
    std::array<std::array<double, 8>, 6> value;
    std::array<std::uint64_t, 8> code;
    bool contains; ///< some corner is outside of none
};

/// Fills in `out`, or answers false as soon as all corners are outside of one plane.
inline bool corners_against_planes(const cull_volume& planes, const cull_volume& corners,
                                   const dvec3& displacement, outcodes& out) {
    const double away = max_abs(displacement);
    const double weight[2] = {corners.w[0], corners.w[4]};
    const double reach[2] = {3.0 * (corners.extent[0] + weight[0] * away),
                             3.0 * (corners.extent[1] + weight[1] * away)};
    // locals, which cannot alias: the loops over corners become vector instructions at -O2 as well
    const std::array<double, 8> x = corners.x;
    const std::array<double, 8> y = corners.y;
    const std::array<double, 8> z = corners.z;
    std::array<std::uint64_t, 8> code{};
    for (std::size_t p = 0; p < 6; ++p) {
        const double a = planes.a[p];
        const double b = planes.b[p];
        const double c = planes.c[p];
        // the displacement belongs to the plane: one dot product instead of eight sums
        const double offset =
            a * displacement.x + b * displacement.y + c * displacement.z + planes.d[p];
        const double near_offset =
            weight[0] * offset + rounding_unit * (planes.normal_bound[p] * reach[0] +
                                                  weight[0] * planes.offset_bound[p]);
        const double far_offset =
            weight[1] * offset + rounding_unit * (planes.normal_bound[p] * reach[1] +
                                                  weight[1] * planes.offset_bound[p]);
        std::array<double, 8> value;
        for (std::size_t i = 0; i < 4; ++i) {
            value[i] = a * x[i] + b * y[i] + c * z[i] + near_offset;
        }
        for (std::size_t i = 4; i < 8; ++i) {
            value[i] = a * x[i] + b * y[i] + c * z[i] + far_offset;
        }
        // sign bits: no value is -0, the bound being +0 or more
        std::array<std::uint64_t, 4> common;
        for (std::size_t i = 0; i < 4; ++i) {
            common[i] =
                std::bit_cast<std::uint64_t>(value[i]) & std::bit_cast<std::uint64_t>(value[i + 4]);
        }
        if (((common[0] & common[1]) & (common[2] & common[3])) >> 63 != 0) {
            return false;
        }
        for (std::size_t i = 0; i < 8; ++i) {
            code[i] |= (std::bit_cast<std::uint64_t>(value[i]) >> 63) << p;
        }
        out.value[p] = value;
    }
    out.code = code;
    out.contains = false;
    for (const std::uint64_t each : code) {
        out.contains = out.contains || each == 0;
    }
    return true;
}

/// Whether some edge has a point inside all planes.
inline bool edge_meets_planes(const outcodes& corners) {
    for (const auto& edge : corner_pairs) {
        const std::size_t i = edge[0];
        const std::size_t j = edge[1];
        if ((corners.code[i] & corners.code[j]) != 0) {
            continue;
        }
        double enter = 0.0;
        double leave = 1.0;
        for (std::size_t p = 0; p < 6; ++p) {
            const std::uint64_t bit = std::uint64_t(1) << p;
            const double at_i = corners.value[p][i];
            const double at_j = corners.value[p][j];
            if ((corners.code[i] & bit) != 0) {
                enter = glm::max(enter, at_i / (at_i - at_j));
            } else if ((corners.code[j] & bit) != 0) {
                leave = glm::min(leave, at_i / (at_i - at_j));
            }
        }
        // either parameter is off by at most 3u
        if (enter <= leave + rounding_unit) {
            return true;
        }
    }
    return false;
}

/// Displacement from a to b, and whether a test between them can be decided.
inline bool decidable(const cull_volume& a, const cull_volume& b, dvec3& displacement) {
    displacement = b.origin - a.origin;
    return a.sound && b.sound && tame(max_abs(displacement));
}

/// The same volume without its far plane at infinity: complete up to `reach` from its origin, by
/// the largest component.
inline cull_volume bounded(const cull_volume& volume, double reach) {
    cull_volume copy = volume;
    if (volume.w[4] != 0.0) {
        return copy;
    }
    // a power of two, so that no corner is rounded but by the last sum
    int exponent = 0;
    std::frexp(volume.depth_rate * (reach + volume.extent[0]), &exponent);
    const double distance = std::ldexp(1.0, exponent + 1);
    for (std::size_t i = 0; i < 4; ++i) {
        set_corner(copy, i + 4, corner(volume, i) + distance * corner(volume, i + 4), 1.0);
    }
    copy.extent[1] = volume.extent[0] + distance * volume.extent[1];
    return copy;
}

} // namespace warpshadow::detail
