// A body as a light and an eye see it: points, extents, and what can be wrong with them.
#pragma once

#include <warpshadow/conventions.hpp>
#include <warpshadow/detail/direction.hpp>
#include <warpshadow/detail/finite.hpp>
#include <warpshadow/detail/lanes.hpp>
#include <warpshadow/detail/plane_warp.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/status.hpp>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace warpshadow::detail {

/// Sine of the angle by which the nearer of ±u, a unit vector, is outside the four side planes.
template <typename T> double outside_view_cone(const frustum<T>& camera, const dvec3& u) {
    const dvec3 l(glm::dot(dvec3(camera.right), u), glm::dot(dvec3(camera.up), u),
                  glm::dot(dvec3(camera.forward), u));
    const view_volume<double> v = convert<double>(camera.volume);
    const double lo[2] = {smaller(v.left, v.right), smaller(v.bottom, v.top)};
    const double hi[2] = {larger(v.left, v.right), larger(v.bottom, v.top)};
    double ahead = -1.0;
    double behind = -1.0;
    for (glm::length_t i = 0; i < 2; ++i) {
        const double below = (lo[i] * l.z - l[i]) / std::sqrt(1.0 + lo[i] * lo[i]);
        const double above = (l[i] - hi[i] * l.z) / std::sqrt(1.0 + hi[i] * hi[i]);
        ahead = larger(ahead, larger(below, above));
        behind = larger(behind, -smaller(below, above));
    }
    return smaller(ahead, behind);
}

/// Rows of a light matrix: positions relative to the eye to the light's image plane and depth.
struct light_plane {
    glm::dvec4 x, y, z, w;
    double unit;       ///< size of the image to fall back on: 1 for NDC
    double depth_unit; ///< the same for the depth row
    bool orthonormal;  ///< x and y are perpendicular directions of length 1, and w is 1

    bool affine() const { return w == glm::dvec4(0.0, 0.0, 0.0, 1.0); }
    glm::dmat4 matrix() const { return glm::transpose(glm::dmat4(x, y, z, w)); }
};

/// A value of a row at a point.
inline double at(const glm::dvec4& row, const dvec3& p) {
    return row.x * p.x + row.y * p.y + row.z * p.z + row.w;
}

/// Unit vector along `v`, the bits of `unit` without its scaling where that does nothing.
inline dvec3 unit_of(const dvec3& v) {
    const double square = glm::dot(v, v);
    return square > 0x1p-200 && square < 0x1p200 ? v / std::sqrt(square) : unit(v);
}

/// A point as the light and the eye see it.
struct seen_point {
    double x, y;     ///< in the light's image plane
    double z;        ///< the light's depth
    double distance; ///< clip w
    double depth;    ///< along the view
};

/// Some points of a body as the light and the eye see them, for work in lanes.
struct seen_points {
    static constexpr int capacity = 48;
    using lane = lanes<native_lanes>;
    std::array<double, capacity> x, y, z, distance, depth;
    std::array<double, capacity> present; ///< 1, or 0 where the last point fills up the lanes
    int count = 0;                        ///< a multiple of the number of lanes

    static lane get(const std::array<double, capacity>& values, int i) {
        lane v;
        load(v, values.data() + i);
        return v;
    }
};
static_assert(seen_points::capacity % native_lanes == 0);

/// Bounds of numbers in lanes.
struct lane_interval {
    seen_points::lane lo, hi;

    lane_interval() {
        const interval empty;
        double fill[native_lanes];
        for (double& f : fill) {
            f = empty.lo;
        }
        load(lo, fill);
        hi = -lo;
    }
    void add(const seen_points::lane& v) {
        lo = v < lo ? v : lo;
        hi = v > hi ? v : hi;
    }
    interval bounds() const {
        double a[native_lanes];
        double b[native_lanes];
        store(a, lo);
        store(b, hi);
        interval all;
        for (int i = 0; i < native_lanes; ++i) {
            all.lo = a[i] < all.lo ? a[i] : all.lo;
            all.hi = b[i] > all.hi ? b[i] : all.hi;
        }
        return all;
    }
};

/// Sum of the lanes.
inline double sum_of_lanes(const seen_points::lane& v) {
    double a[native_lanes];
    store(a, v);
    double sum = 0.0;
    for (const double x : a) {
        sum += x;
    }
    return sum;
}

/// What the light and the eye see of a body, computed once if its points fit into one block.
template <typename T> class seen_body {
  public:
    seen_body(std::span<const glm::vec<3, T>> body, const light_plane& plane, const dvec3& view)
        : body_(body), plane_(plane), view_(view), affine_(plane.affine()) {}

    seen_point see(const dvec3& p) const {
        const double w = at(plane_.w, p);
        return seen_point{at(plane_.x, p) / w, at(plane_.y, p) / w, at(plane_.z, p) / w, w,
                          glm::dot(view_, p)};
    }
    /// visit(points) for every block of points.
    template <typename Visit> void for_each(Visit visit) {
        for (std::size_t start = 0; start < body_.size(); start += seen_points::capacity) {
            if (start != loaded_) {
                look(start);
                loaded_ = start;
            }
            visit(points_);
        }
    }
    /// visit(point, seen) for every point, those beyond the last visible depth drawn to where their
    /// line of sight ends.
    template <typename Visit> void for_each_visible(double last, Visit visit) {
        for (const glm::vec<3, T>& point : body_) {
            const dvec3 p(point);
            const double depth = glm::dot(view_, p);
            const dvec3 visible = depth > last ? p * (last / depth) : p;
            visit(visible, see(visible));
        }
    }

  private:
    using lane = seen_points::lane;

    static lane row(const glm::dvec4& r, const lane& x, const lane& y, const lane& z) {
        return r.x * x + r.y * y + r.z * z + r.w;
    }
    void look(std::size_t start) {
        const std::size_t left = body_.size() - start;
        const std::size_t full = seen_points::capacity;
        const std::size_t count = left < full ? left : full;
        const glm::dvec4 view(view_, 0.0);
        std::size_t i = 0;
        for (; i < count; i += native_lanes) {
            // put together in registers: several doubles at once cannot be read from where they
            // were just written one by one
            double one[4][native_lanes];
            for (std::size_t k = 0; k < native_lanes; ++k) {
                const std::size_t at = i + k < count ? i + k : count - 1;
                const glm::vec<3, T>& p = body_[start + at];
                one[0][k] = static_cast<double>(p.x);
                one[1][k] = static_cast<double>(p.y);
                one[2][k] = static_cast<double>(p.z);
                one[3][k] = i + k < count ? 1.0 : 0.0;
            }
            const lane a = lane_of(one[0]);
            const lane b = lane_of(one[1]);
            const lane c = lane_of(one[2]);
            lane x = row(plane_.x, a, b, c);
            lane y = row(plane_.y, a, b, c);
            lane z = row(plane_.z, a, b, c);
            lane w = 0.0 * a + 1.0; // NaN and infinity stay to be found
            if (!affine_) {
                w = row(plane_.w, a, b, c);
                const lane scale = 1.0 / w;
                x = x * scale;
                y = y * scale;
                z = z * scale;
            }
            store(points_.x.data() + i, x);
            store(points_.y.data() + i, y);
            store(points_.z.data() + i, z);
            store(points_.distance.data() + i, w);
            store(points_.depth.data() + i, row(view, a, b, c));
            store(points_.present.data() + i, lane_of(one[3]));
        }
        points_.count = static_cast<int>(i);
    }

    std::span<const glm::vec<3, T>> body_;
    const light_plane& plane_;
    dvec3 view_;
    bool affine_;
    seen_points points_;
    std::size_t loaded_ = static_cast<std::size_t>(-1);
};

/// Linear function over the image plane whose slope at an image position is, in world space, as
/// near to g as the plane has it; zero if the plane has none.
inline glm::dvec2 image_slope(const light_plane& plane, const glm::dvec2& image, double distance,
                              const dvec3& g) {
    if (plane.orthonormal) {
        return glm::dvec2(glm::dot(dvec3(plane.x), g), glm::dot(dvec3(plane.y), g));
    }
    const dvec3 across = (dvec3(plane.x) - image.x * dvec3(plane.w)) / distance;
    const dvec3 upwards = (dvec3(plane.y) - image.y * dvec3(plane.w)) / distance;
    const double xx = glm::dot(across, across);
    const double xy = glm::dot(across, upwards);
    const double yy = glm::dot(upwards, upwards);
    const double det = xx * yy - xy * xy;
    if (!(det > 0x1p-80 * xx * yy)) {
        return glm::dvec2(0.0);
    }
    const double gx = glm::dot(across, g);
    const double gy = glm::dot(upwards, g);
    return glm::dvec2(yy * gx - xy * gy, xx * gy - xy * gx) / det;
}

/// rho of the receiver line between a body's two ends, for a light with a position.
///
/// The ends are means over the points with weights that grow towards either end of `t`, so that
/// nothing jumps where another point becomes the last.
/// @param rho_of rho_of(z0, z1, W0, W1)
template <typename T, typename RhoOf>
double rho_between_ends(seen_body<T>& body, const glm::dvec2& slope, double last, double nearest,
                        const interval& t, RhoOf rho_of) {
    double depth[2] = {0.0, 0.0};
    double distance[2] = {0.0, 0.0};
    double sum[2] = {0.0, 0.0};
    body.for_each_visible(last, [&](const dvec3&, const seen_point& p) {
        const double s = (slope.x * p.x + slope.y * p.y - t.lo) / t.length();
        const double away[2] = {1.0 - s, s};
        for (int i = 0; i < 2; ++i) {
            const double weight = away[i] * away[i] * away[i] * away[i];
            depth[i] += weight * p.depth;
            distance[i] += weight * p.distance;
            sum[i] += weight;
        }
    });
    for (int i = 0; i < 2; ++i) {
        depth[i] = larger(depth[i] / sum[i], nearest);
        distance[i] /= sum[i];
    }
    return rho_of(depth[0], depth[1], distance[0], distance[1]);
}

/// 0, or a NaN if a component is not finite.
inline double zero_if_finite(const dvec3& v) {
    return 0.0 * v.x + 0.0 * v.y + 0.0 * v.z;
}

/// What is wrong with the camera or the light: `invalid_input` or nothing.
template <typename T> status check_scene(const frustum<T>& camera, const light<T>& source) {
    const view_volume<double> v = convert<double>(camera.volume);
    const dvec3 forward(camera.forward);
    const dvec3 direction(source.direction);
    const bool positioned = source.kind != light_kind::directional;
    const bool directed = source.kind != light_kind::point;
    double zero = zero_if_finite(forward) + zero_if_finite(dvec3(camera.right)) +
                  zero_if_finite(dvec3(camera.up)) + zero_if_finite(dvec3(camera.eye)) +
                  zero_if_finite(dvec3(v.left, v.right, v.bottom)) +
                  zero_if_finite(dvec3(v.top, v.near_distance, 0.0));
    zero += positioned ? zero_if_finite(dvec3(source.position)) : 0.0;
    zero += directed ? zero_if_finite(direction) : 0.0;
    const bool ok = zero == 0.0 && forward != dvec3(0.0) &&
                    (!directed || direction != dvec3(0.0)) &&
                    (v.orthographic || v.near_distance > 0.0);
    return ok ? status::ok : status::invalid_input;
}

/// What is wrong with the points of a body from which no finite number could be made.
template <typename T> status check_points(std::span<const glm::vec<3, T>> body) {
    status flags = status::ok;
    for (const glm::vec<3, T>& point : body) {
        const dvec3 p(point);
        const bool nan = p.x != p.x || p.y != p.y || p.z != p.z;
        flags |= nan ? status::invalid_input : (all_finite(p) ? status::ok : status::unbounded);
    }
    return flags == status::ok ? status::out_of_range : flags;
}

/// Sum of the points.
template <typename T> dvec3 sum_of(std::span<const glm::vec<3, T>> body) {
    dvec3 sum(0.0);
    for (const glm::vec<3, T>& p : body) {
        sum += dvec3(p);
    }
    return sum;
}

} // namespace warpshadow::detail
