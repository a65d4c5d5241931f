// The projective warp of a light's image plane, fitted to a region of it.
#pragma once

#include <warpshadow/clip_space.hpp>
#include <warpshadow/detail/finite.hpp>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <limits>

namespace warpshadow::detail {

/// Bounds of numbers; empty before the first one.
struct interval {
    double lo = std::numeric_limits<double>::infinity();
    double hi = -std::numeric_limits<double>::infinity();

    void add(double x) {
        lo = x < lo ? x : lo;
        hi = x > hi ? x : hi;
    }
    double length() const { return hi - lo; }
    /// Moves the ends apart to at least this length, keeping the middle.
    bool widen(double least) {
        if (length() >= least) {
            return false;
        }
        const double middle = 0.5 * lo + 0.5 * hi;
        lo = middle - 0.5 * least;
        hi = middle + 0.5 * least;
        return true;
    }
    /// Adds a share of the length at either end.
    void grow(double share) {
        const double more = share * length();
        lo -= more;
        hi += more;
    }
};

/// w = constant + dot(slope, p) over an image plane p; the image is (p - centre) / w, fitted.
///
/// w and p / w have the same straight lines whatever the centre is. Where the map is fitted to a
/// rectangle the centre matters: there the image is not sheared.
struct plane_warp {
    glm::dvec2 slope;
    double constant;
    glm::dvec2 centre;

    double w(const glm::dvec2& p) const { return constant + slope.x * p.x + slope.y * p.y; }
    glm::dvec2 image(const glm::dvec2& p) const { return (p - centre) / w(p); }
};

/// What becomes of depth: scale · (z - centre) / w + shift.
///
/// z / w alone would spend the depth range on w where z is large all over.
struct depth_warp {
    double scale, shift, centre;
};

/// The warp with its image fitted: x and y of the region to -1..1, depth as `depth` says.
struct fitted_warp {
    plane_warp warp;
    depth_warp depth;
    glm::dvec2 scale, shift;

    fitted_warp(const plane_warp& w, const interval& x, const interval& y, const depth_warp& z)
        : warp(w), depth(z) {
        const glm::dvec2 inverse(1.0 / x.length(), 1.0 / y.length());
        scale = 2.0 * inverse;
        shift = -glm::dvec2(x.lo + x.hi, y.lo + y.hi) * inverse;
    }
    /// Applied to the rows of a light matrix.
    glm::dmat4 rows_of(const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& z,
                       const glm::dvec4& w) const {
        const glm::dvec4 h = warp.slope.x * x + warp.slope.y * y + warp.constant * w;
        return glm::transpose(glm::dmat4(scale.x * (x - warp.centre.x * w) + shift.x * h,
                                         scale.y * (y - warp.centre.y * w) + shift.y * h,
                                         depth.scale * (z - depth.centre * w) + depth.shift * h,
                                         h));
    }
    /// By itself: `rows_of` the identity.
    glm::dmat4 matrix() const {
        const glm::dvec4 of_w(shift, depth.shift, 1.0);
        glm::dmat4 m(warp.slope.x * of_w, warp.slope.y * of_w,
                     glm::dvec4(0.0, 0.0, depth.scale, 0.0), warp.constant * of_w);
        m[0].x += scale.x;
        m[1].y += scale.y;
        m[3] -= glm::dvec4(scale * warp.centre, depth.scale * depth.centre, 0.0);
        return m;
    }
};

/// Carries the interval of (z - centre) / w to the depth range, its lower end to the lower depth.
inline depth_warp depth_fit(const interval& z, double centre, clip_space clip) {
    const double lowest = clip.depth == depth_range::zero_to_one ? 0.0 : -1.0;
    const double scale = (1.0 - lowest) / z.length();
    return depth_warp{scale, lowest - scale * z.lo, centre};
}

/// The larger and the smaller of two numbers; the second if the first is NaN.
inline double larger(double a, double b) {
    return a > b ? a : b;
}
inline double smaller(double a, double b) {
    return a < b ? a : b;
}

/// A number within bounds; NaN gives the lower one.
template <typename T> double bounded(T x, double lo, double hi) {
    const double value = static_cast<double>(x);
    return value > lo ? (value < hi ? value : hi) : lo;
}

} // namespace warpshadow::detail
