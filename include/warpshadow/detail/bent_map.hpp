// Fitting a projective warp: the map that a bend stands for, and the search for the best bend.
#pragma once

#include <warpshadow/detail/condensed_histogram.hpp>
#include <warpshadow/detail/plane_warp.hpp>
#include <warpshadow/status.hpp>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace warpshadow::detail {

/// Axes of the fitted map: a rotation, applied to map space with square units.
struct map_axes {
    glm::dvec2 x, y;
};

/// The light's own axes.
inline map_axes upright_axes(double aspect) {
    return map_axes{glm::dvec2(aspect, 0.0), glm::dvec2(0.0, 1.0)};
}

inline map_axes turned_axes(double angle, double aspect) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return map_axes{glm::dvec2(aspect * c, s), glm::dvec2(-aspect * s, c)};
}

/// Axes of which one lies along the bend, by the smaller turn.
inline map_axes axes_along(const glm::dvec2& bend, double aspect) {
    const glm::dvec2 b(bend.x / aspect, bend.y); // w is a function: its slope divides by the unit
    const double length = std::sqrt(b.x * b.x + b.y * b.y);
    if (!(length > 0.0)) {
        return upright_axes(aspect);
    }
    const bool wide = std::abs(b.x) >= std::abs(b.y);
    const double c = std::abs(wide ? b.x : b.y) / length;
    const double s =
        wide ? std::copysign(b.y, b.x * b.y) / length : -std::copysign(b.x, b.x * b.y) / length;
    return map_axes{glm::dvec2(aspect * c, s), glm::dvec2(-aspect * s, c)};
}

/// The map that a bend stands for, over a region.
struct bent_map {
    plane_warp warp;
    map_axes axes;
    interval x, y;
    bool widened = false; ///< the region has no extent: it was given one

    /// sqrt of the area that the fitted image takes, per unit of area where w = 1.
    double scale() const { return std::sqrt(x.length() * y.length() / warp.w(warp.centre)); }
};

inline bent_map bend_map(const glm::dvec2& bend, const map_axes& axes, const map_region& region,
                         const glm::dvec2& centre, double reach) {
    bent_map bent{plane_warp{glm::dvec2(0.0), 1.0, centre}, axes, {}, {}, false};
    const double rho = std::sqrt(bend.x * bend.x + bend.y * bend.y);
    if (rho > 0.0) {
        interval t;
        for (const glm::dvec2& p : region.points()) {
            t.add(bend.x * p.x + bend.y * p.y);
        }
        // a region of no extent has nothing to bend
        if (t.length() > relative_floor * rho) {
            const double k = std::expm1(rho) / t.length();
            bent.warp.slope = k * bend;
            bent.warp.constant = 1.0 - k * (t.lo - reach * (std::abs(bend.x) + std::abs(bend.y)));
        }
    }
    for (const glm::dvec2& p : region.points()) {
        const glm::dvec2 q = bent.warp.image(p);
        bent.x.add(axes.x.x * q.x + axes.x.y * q.y);
        bent.y.add(axes.y.x * q.x + axes.y.y * q.y);
    }
    // what 2^-24 of the map would be at the centre is the least extent
    const double centre_w = bent.warp.w(centre);
    const double least = relative_floor / (centre_w > 0.0 ? centre_w : 1.0);
    const double longer = larger(bent.x.length(), bent.y.length());
    const bool flat_x = bent.x.widen(larger(relative_floor * longer, least * glm::length(axes.x)));
    const bool flat_y = bent.y.widen(larger(relative_floor * longer, least * glm::length(axes.y)));
    bent.widened = flat_x || flat_y;
    return bent;
}

/// Homography of map space that a bent map is: its bounds become the unit square.
inline glm::mat<3, 3, double> map_matrix(const bent_map& bent) {
    const double row2[3] = {bent.warp.slope.x, bent.warp.slope.y, bent.warp.constant};
    const glm::dvec2 x = bent.axes.x / bent.x.length();
    const glm::dvec2 y = bent.axes.y / bent.y.length();
    const glm::dvec2 shift(-bent.x.lo / bent.x.length(), -bent.y.lo / bent.y.length());
    const glm::dvec2& c = bent.warp.centre;
    const glm::dvec2 linear[3] = {glm::dvec2(x.x, y.x), glm::dvec2(x.y, y.y),
                                  -glm::dvec2(x.x * c.x + x.y * c.y, y.x * c.x + y.y * c.y)};
    glm::mat<3, 3, double> m(0.0);
    for (glm::length_t column = 0; column < 3; ++column) {
        const double w = row2[column];
        m[column] = glm::vec<3, double>(linear[column] + shift * w, w);
    }
    return m;
}

/// Largest coordinate that a corner may have: a million maps away is an error.
inline constexpr double farthest_corner = 0x1p20;

/// Replaces the region by the corners that the caller gave, if any; `centre` is kept inside.
template <typename T>
void restrict_region(std::span<const glm::vec<2, T>> domain, map_region& region, glm::dvec2& centre,
                     status& flags) {
    map_region given;
    interval x;
    interval y;
    for (const glm::vec<2, T>& corner : domain) {
        const glm::dvec2 p(corner);
        // far from the map, infinite or NaN
        if (!(std::abs(p.x) <= farthest_corner && std::abs(p.y) <= farthest_corner)) {
            flags |= status::samples_rejected;
            continue;
        }
        x.add(p.x);
        y.add(p.y);
        if (given.count < map_region::capacity) {
            given.add(p);
        }
    }
    if (given.count == map_region::capacity) {
        given.count = 0;
        given.add(glm::dvec2(x.lo, y.lo));
        given.add(glm::dvec2(x.hi, y.lo));
        given.add(glm::dvec2(x.lo, y.hi));
        given.add(glm::dvec2(x.hi, y.hi));
        flags |= status::capacity_reached;
    }
    if (given.count == 0) {
        return;
    }
    region = given;
    // the mean of the corners is inside whatever their order is; the samples' centre need not be
    glm::dvec2 mean(0.0);
    for (const glm::dvec2& p : given.points()) {
        mean += p;
    }
    mean /= given.count;
    const bool inside =
        centre.x >= x.lo && centre.x <= x.hi && centre.y >= y.lo && centre.y <= y.hi;
    centre = inside ? centre : mean;
}

/// Mean texel size, up to a factor, of the samples under a bend.
struct texel_objective {
    const condensed& samples;
    double reach;
    double aspect;
    bool turn; ///< whether the sides lie along the bend

    bent_map map(const glm::dvec2& bend, const map_axes& axes) const {
        return bend_map(bend, axes, samples.region, samples.centre, reach);
    }
    double operator()(const glm::dvec2& bend, const weighted_points& points) const {
        const bent_map bent = map(bend, turn ? axes_along(bend, aspect) : upright_axes(aspect));
        return bent.scale() * points.sum(bent.warp);
    }
};

/// Mean of w^(3/2) over every cell: times the scale of the map it is the true objective.
template <typename Weight>
double mean_shrinkage(const histogram<Weight>& h, const plane_warp& warp,
                      const condensed& samples) {
    if (warp.slope == glm::dvec2(0.0)) {
        return 1.0;
    }
    double sum = 0.0;
    weighted_points some; // in portions, so that roots are taken several at a time
    for (int j = 0; j < h.height; ++j) {
        const auto row = static_cast<std::size_t>(j);
        for (int i = samples.first[row]; i <= samples.last[row]; ++i) {
            if (const double weight = h.at(i, j); weight > 0.0) {
                some.add(h.centre(i, j), weight);
            }
        }
        if (some.count > weighted_points::capacity - largest_side || j + 1 == h.height) {
            some.pad();
            sum += some.sum(warp);
            some.count = 0;
        }
    }
    return sum / samples.total;
}

/// `v`, no longer than `longest`.
inline glm::dvec2 shortened(const glm::dvec2& v, double longest) {
    const double length = std::sqrt(v.x * v.x + v.y * v.y);
    return length > longest ? v * (longest / length) : v;
}

/// Bend of least mean texel size: eight directions with two strengths each on the blocks, then
/// steps along and across the best, halved in each round, with the cells in the last two.
inline glm::dvec2 best_bend(const texel_objective& objective, double strongest) {
    glm::dvec2 best(0.0);
    double least = objective(best, objective.samples.blocks);
    for (int strength = 1; strength <= 2; ++strength) {
        const double rho = (0.35 * strength - 0.15) * strongest;
        const double diagonal = rho * 0.70710678118654752;
        const glm::dvec2 starts[8] = {glm::dvec2(rho, 0.0),  glm::dvec2(diagonal, diagonal),
                                      glm::dvec2(0.0, rho),  glm::dvec2(-diagonal, diagonal),
                                      glm::dvec2(-rho, 0.0), glm::dvec2(-diagonal, -diagonal),
                                      glm::dvec2(0.0, -rho), glm::dvec2(diagonal, -diagonal)};
        for (const glm::dvec2& start : starts) {
            const double value = objective(start, objective.samples.blocks);
            if (value < least) {
                least = value;
                best = start;
            }
        }
    }
    double step = 0.15 * strongest;
    for (int round = 0; round < 6; ++round) {
        const bool fine = round >= 4;
        const weighted_points& points = fine ? objective.samples.cells : objective.samples.blocks;
        least = round == 4 ? objective(best, points) : least;
        for (int tries = 0; tries < (fine ? 1 : 3); ++tries) {
            const double length = std::sqrt(best.x * best.x + best.y * best.y);
            const glm::dvec2 along = length > 0.0 ? best * (step / length) : glm::dvec2(step, 0.0);
            const glm::dvec2 moves[4] = {along, -along, glm::dvec2(-along.y, along.x),
                                         glm::dvec2(along.y, -along.x)};
            const glm::dvec2 from = best;
            for (const glm::dvec2& move : moves) {
                const glm::dvec2 bend = shortened(from + move, strongest);
                const double value = objective(bend, points);
                if (value < least) {
                    least = value;
                    best = bend;
                }
            }
            if (best == from) {
                break;
            }
        }
        step *= 0.5;
    }
    return best;
}

/// A right angle in radians.
inline constexpr double quarter_turn = 1.57079632679489662;

/// `angle`, moved by multiples of `period` to be nearest to `to`.
inline double nearest_turn(double angle, double period, double to) {
    return angle + period * std::floor((to - angle) / period + 0.5);
}

} // namespace warpshadow::detail
