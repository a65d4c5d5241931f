// LiSPSM by the textbook in 100 digits: the oracle of the tests and of the accuracy table.
#pragma once

#include "camera.hpp"

#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>

#include <boost/math/constants/constants.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lispsm_test {

using camera_test::cross;
using camera_test::dot;
using camera_test::exact;
using camera_test::real;
using camera_test::real3;
using camera_test::times;
using camera_test::unit;

/// A directional light's warped map with depth -1..1, from n_opt, V_P and sin γ as in the papers,
/// with the fade of the library's default on ln(f / n), or without it.
class oracle {
  public:
    template <typename T>
    oracle(const warpshadow::frustum<T>& camera, const glm::vec<3, T>& direction,
           std::span<const glm::vec<3, T>> body, bool faded = true) {
        const real3 light = unit(exact(direction));
        const real3 view = unit(exact(camera.forward));
        make_frame(light);
        const real sin_gamma = camera_test::length(cross(view, light));
        const real near_distance(camera.volume.near_distance);

        // centre of the map that is not sheared: mean of the points weighted by 1 / depth
        real z0 = dot(view, exact(body[0]));
        real weights = 0;
        real3 sum{};
        for (const glm::vec<3, T>& point : body) {
            const real3 p = exact(point);
            const real z = dot(view, p);
            z0 = std::min(z0, z);
            const real weight = 1 / std::max(z, near_distance);
            weights += weight;
            sum = camera_test::sum(sum, times(weight, p));
        }
        z0 = std::max(z0, near_distance);
        centre_ = {dot(right_, sum) / weights, dot(up_, sum) / weights};

        h_ = {real(0), real(0), real(0)};
        if (sin_gamma > 0) {
            const real3 axis = unit(cross(cross(light, view), light));
            real first = dot(axis, exact(body[0]));
            real last = first;
            for (const glm::vec<3, T>& p : body) {
                first = std::min(first, dot(axis, exact(p)));
                last = std::max(last, dot(axis, exact(p)));
            }
            const real d = last - first;
            const real z1 = z0 + d * sin_gamma;
            const real n = (z0 + sqrt(z0 * z1)) / sin_gamma; // Wimmer et al. 2004
            rho_ = (faded ? fade(camera, light) : real(1)) * log((n + d) / n);
            h_ = times((exp(rho_) - 1) / d, axis);
        }
        least_ = dot(h_, exact(body[0]));
        for (const glm::vec<3, T>& p : body) {
            least_ = std::min(least_, dot(h_, exact(p)));
        }
        lo_ = hi_ = image(exact(body[0]));
        for (const glm::vec<3, T>& p : body) {
            const real3 q = image(exact(p));
            for (std::size_t i = 0; i < 3; ++i) {
                lo_[i] = std::min(lo_[i], q[i]);
                hi_[i] = std::max(hi_[i], q[i]);
            }
        }
    }

    /// NDC of a point relative to the eye.
    real3 ndc(const real3& p) const {
        real3 q = image(p);
        for (std::size_t i = 0; i < 3; ++i) {
            q[i] = (2 * q[i] - lo_[i] - hi_[i]) / (hi_[i] - lo_[i]);
        }
        return q;
    }
    real w(const real3& p) const { return 1 + dot(h_, p) - least_; }
    const real& rho() const { return rho_; }

  private:
    /// The frame of light that falls straight down, turned along a great circle (Rodrigues).
    void make_frame(const real3& light) {
        const real3 down{real(0), real(-1), real(0)};
        const real3 axis = cross(down, light);
        const real c = dot(down, light);
        const auto turned = [&](const real3& v) {
            // v cos + (k × v) sin + k (k·v)(1 - cos), with |axis| = sin
            const real3 a = camera_test::sum(times(c, v), cross(axis, v));
            return camera_test::sum(a, times(dot(axis, v) / (1 + c), axis));
        };
        right_ = turned({real(1), real(0), real(0)});
        up_ = turned({real(0), real(0), real(-1)});
        forward_ = light;
    }

    template <typename T>
    static real fade(const warpshadow::frustum<T>& camera, const real3& light) {
        const real pi = boost::math::constants::pi<real>();
        const real3 axes[2] = {exact(camera.right), exact(camera.up)};
        const real3 forward = exact(camera.forward);
        const real bounds[2][2] = {{real(camera.volume.left), real(camera.volume.right)},
                                   {real(camera.volume.bottom), real(camera.volume.top)}};
        real outside = 1;
        for (int sign = -1; sign <= 1; sign += 2) {
            real farthest = -1;
            for (std::size_t i = 0; i < 2; ++i) {
                for (std::size_t side = 0; side < 2; ++side) {
                    // outward normal of the plane through the eye at this slope
                    const real out = side == 0 ? -1 : 1;
                    const real3 normal = unit(camera_test::sum(
                        times(out, axes[i]), times(-out * bounds[i][side], forward)));
                    farthest = std::max(farthest, real(sign) * dot(normal, light));
                }
            }
            outside = std::min(outside, farthest);
        }
        const real t = std::clamp(real(outside / sin(pi / 15)), real(0), real(1)); // 12 degrees
        // rounded off over a fifth at either end: the integral of a trapezoid of slopes
        const real end = real(1) / 5;
        const real slope = real(5) / 4;
        const auto rise = [&](const real& x) { return slope * x * x / (2 * end); };
        return t < end
                   ? rise(t)
                   : (t > 1 - end ? real(1 - rise(1 - t)) : real(rise(end) + slope * (t - end)));
    }

    real3 image(const real3& p) const {
        const real weight = w(p);
        return {(dot(right_, p) - centre_[0]) / weight, (dot(up_, p) - centre_[1]) / weight,
                dot(forward_, p) / weight};
    }

    real3 right_, up_, forward_, h_, lo_, hi_;
    std::array<real, 2> centre_;
    real rho_ = 0;
    real least_ = 0;
};

/// One of the 63 configurations of the accuracy table.
struct configuration {
    double gamma;    ///< angle between light and view, radians
    double ratio;    ///< far / near
    double distance; ///< of the eye from the world's origin, near distances
};

inline std::vector<configuration> configurations() {
    std::vector<configuration> all;
    for (const double gamma : {1.2, 0.8, 1e-2, 1e-3, 1e-4, 1e-6, 0.0}) {
        for (const double ratio : {1e2, 1e4, 1e7}) {
            for (const double distance : {0.0, 1e3, 1e6}) {
                all.push_back({gamma, ratio, distance});
            }
        }
    }
    return all;
}

/// Camera, light and points of a configuration; all of it exact in T.
template <typename T> struct scene {
    warpshadow::frustum<T> camera;
    glm::vec<3, T> direction;
    std::vector<glm::vec<3, T>> body;   ///< the frustum's corners relative to the eye
    std::vector<glm::vec<3, T>> points; ///< inside it, at all depths
};

template <typename T> scene<T> make_scene(const configuration& c, int points_per_depth = 4) {
    using vec3 = glm::vec<3, T>;
    using dvec3 = glm::vec<3, double>;
    const vec3 eye(static_cast<T>(c.distance), static_cast<T>(2.0 * c.distance),
                   static_cast<T>(-c.distance));
    const vec3 forward(T(0.36), T(-0.48), T(-0.8));
    const double fov = 1.0471975511965976;
    scene<T> s{warpshadow::make_frustum<T>(
                   eye, forward, vec3(T(0), T(1), T(0)),
                   warpshadow::perspective_volume<T>(T(fov), T(1.5), T(1), static_cast<T>(c.ratio)))
                   .value,
               {},
               {},
               {}};
    // across the view, on a diagonal of the image
    const dvec3 view(s.camera.forward);
    const dvec3 across = glm::normalize(0.8 * dvec3(s.camera.up) + 0.6 * dvec3(s.camera.right));
    s.direction = c.gamma == 0.0 ? s.camera.forward
                                 : vec3(std::cos(c.gamma) * view + std::sin(c.gamma) * across);
    for (const glm::vec<4, T>& corner : warpshadow::frustum_corners(s.camera)) {
        s.body.push_back(vec3(corner));
    }
    for (int depth = 0; depth <= 8; ++depth) {
        const double z = std::pow(c.ratio, depth / 8.0);
        for (int i = 0; i < points_per_depth; ++i) {
            // a fixed spiral: evenly spread without a generator
            const double x = std::fmod(0.754877666 * (i + 7 * depth), 1.0) * 2.0 - 1.0;
            const double y = std::fmod(0.569840291 * (i + 7 * depth), 1.0) * 2.0 - 1.0;
            const dvec3 p = view + x * double(s.camera.volume.right) * dvec3(s.camera.right) +
                            y * double(s.camera.volume.top) * dvec3(s.camera.up);
            s.points.push_back(vec3(0.999 * z * p));
        }
    }
    return s;
}

/// Positions of points along the warp's axis, 0 to 1 over the body, without a fade: n_opt of Wimmer
/// et al. 2004. They do not depend on how the map is turned; none if light and view are parallel.
template <typename T>
std::vector<real> textbook_positions(const scene<T>& s, std::span<const glm::vec<3, T>> points) {
    const real3 light = unit(exact(s.direction));
    const real3 view = unit(exact(s.camera.forward));
    const real sine = camera_test::length(cross(view, light));
    std::vector<real> positions;
    if (sine == 0) {
        return positions;
    }
    const real3 axis = unit(cross(cross(light, view), light));
    real first = dot(axis, exact(s.body[0]));
    real last = first;
    real z0 = dot(view, exact(s.body[0]));
    for (const glm::vec<3, T>& p : s.body) {
        first = std::min(first, dot(axis, exact(p)));
        last = std::max(last, dot(axis, exact(p)));
        z0 = std::min(z0, dot(view, exact(p)));
    }
    const real d = last - first;
    const real n = (z0 + sqrt(z0 * (z0 + d * sine))) / sine;
    for (const glm::vec<3, T>& p : points) {
        const real t = dot(axis, exact(p)) - first;
        positions.push_back((n + d) * t / (d * (n + t)));
    }
    return positions;
}

/// Largest distance, in texels of a map of `size`, between where the matrix puts the points in
/// arithmetic of T and where they belong.
template <typename T>
double texel_error(const glm::mat<4, 4, T>& matrix, const oracle& truth, const scene<T>& s,
                   int size) {
    double worst = 0.0;
    for (const std::vector<glm::vec<3, T>>* set : {&s.body, &s.points}) {
        for (const glm::vec<3, T>& p : *set) {
            const glm::vec<4, T> clip = matrix * glm::vec<4, T>(p, T(1));
            const T x = clip.x / clip.w;
            const T y = clip.y / clip.w;
            const real3 ndc = truth.ndc(exact(p));
            const real dx = real(x) - ndc[0];
            const real dy = real(y) - ndc[1];
            const double error = camera_test::as_double(sqrt(dx * dx + dy * dy)) * 0.5 * size;
            // a NaN or an infinity is the worst error of all
            worst = error <= worst ? worst : error;
        }
    }
    return worst;
}

} // namespace lispsm_test
