// Properties of warpshadow/lispsm.hpp. Numbers after J are those of the list of hard cases.
#include "camera.hpp"
#include "lispsm_oracle.hpp"

#include <warpshadow/lispsm.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <span>
#include <vector>

using namespace warpshadow;
using camera_test::between;
using camera_test::coin;
using camera_test::exact;
using camera_test::log_between;
using camera_test::real;

namespace {

using vec2 = glm::vec<2, double>;
using vec3 = glm::vec<3, double>;
using vec4 = glm::vec<4, double>;
using mat4 = glm::mat<4, 4, double>;

constexpr double pi = 3.14159265358979323846;
constexpr double degree = pi / 180.0;

struct no_fade {
    double operator()(double) const { return 1.0; }
};

template <typename T>
frustum<T> camera_of(double fov, double aspect, double zn, double zf,
                     glm::vec<3, T> eye = glm::vec<3, T>(T(0))) {
    return make_frustum<T>(eye, glm::vec<3, T>(T(0), T(0), T(-1)), glm::vec<3, T>(T(0), T(1), T(0)),
                           perspective_volume<T>(T(fov), T(aspect), T(zn), T(zf)))
        .value;
}

template <typename T> std::vector<glm::vec<3, T>> body_of(const frustum<T>& camera) {
    std::vector<glm::vec<3, T>> body;
    for (const glm::vec<4, T>& corner : frustum_corners(camera)) {
        body.push_back(glm::vec<3, T>(corner));
    }
    return body;
}

/// Light that makes an angle with -z, in the plane at `azimuth` around it.
template <typename T> glm::vec<3, T> light_at(double gamma, double azimuth = 0.5 * pi) {
    return glm::vec<3, T>(static_cast<T>(std::sin(gamma) * std::cos(azimuth)),
                          static_cast<T>(std::sin(gamma) * std::sin(azimuth)),
                          static_cast<T>(-std::cos(gamma)));
}

template <typename T> vec3 ndc(const glm::mat<4, 4, T>& matrix, const vec3& p) {
    const vec4 clip = mat4(matrix) * vec4(p, 1.0);
    return vec3(clip) / clip.w;
}

template <typename T> bool same_bits(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

/// Largest extent of a texel in the plane across the light, over eye depth: what Lloyd et al. 2006
/// call the perspective error, up to a factor.
double texel_error(const mat4& m, const light_frame_result<double>& axes, const vec3& view,
                   const vec3& p) {
    const vec4 c = m * vec4(p, 1.0);
    const vec4 r = m * vec4(axes.right, 0.0);
    const vec4 u = m * vec4(axes.up, 0.0);
    const vec2 x = (vec2(r) - vec2(c) / c.w * r.w) / c.w;
    const vec2 y = (vec2(u) - vec2(c) / c.w * u.w) / c.w;
    const double sum = glm::dot(x, x) + glm::dot(y, y);
    const double det = x.x * y.y - x.y * y.x;
    const double least = std::sqrt(
        std::max(0.0, 0.5 * (sum - std::sqrt(std::max(0.0, sum * sum - 4.0 * det * det)))));
    return 1.0 / (least * glm::dot(view, p));
}

/// The largest error over a frustum, on a grid that has its corners, edges and faces.
double largest_error(const mat4& m, const frustum<double>& camera, const vec3& light) {
    const auto axes = light_frame(light);
    const auto& v = camera.volume;
    double worst = 0.0;
    for (int k = 0; k <= 16; ++k) {
        const double z =
            v.near_distance * std::pow(double(v.far_distance) / v.near_distance, k / 16.0);
        for (int i = 0; i <= 6; ++i) {
            for (int j = 0; j <= 6; ++j) {
                const vec3 p = z * (vec3(camera.forward) +
                                    (v.left + (v.right - v.left) * i / 6.0) * vec3(camera.right) +
                                    (v.bottom + (v.top - v.bottom) * j / 6.0) * vec3(camera.up));
                worst = std::max(worst, texel_error(m, axes, camera.forward, p));
            }
        }
    }
    return worst;
}

/// Vertices of the intersection of half-spaces dot(n, p) + d ≥ 0: every triple of planes.
std::vector<vec3> vertices(const std::vector<vec4>& planes) {
    std::vector<vec3> found;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (std::size_t j = i + 1; j < planes.size(); ++j) {
            for (std::size_t k = j + 1; k < planes.size(); ++k) {
                const vec3 a(planes[i]);
                const vec3 b(planes[j]);
                const vec3 c(planes[k]);
                const double det = glm::dot(a, glm::cross(b, c));
                if (std::abs(det) < 1e-12) {
                    continue;
                }
                const vec3 p = -(planes[i].w * glm::cross(b, c) + planes[j].w * glm::cross(c, a) +
                                 planes[k].w * glm::cross(a, b)) /
                               det;
                const bool inside =
                    std::all_of(planes.begin(), planes.end(), [&](const vec4& plane) {
                        return glm::dot(vec3(plane), p) + plane.w >=
                               -1e-9 * (1.0 + std::abs(plane.w));
                    });
                if (inside) {
                    found.push_back(p);
                }
            }
        }
    }
    return found;
}

std::vector<vec3> in_box(const frustum<double>& camera, const vec3& lo, const vec3& hi) {
    std::vector<vec4> planes;
    for (const vec4& plane : frustum_planes(camera)) {
        if (vec3(plane) != vec3(0.0)) {
            planes.push_back(plane);
        }
    }
    for (glm::length_t i = 0; i < 3; ++i) {
        vec4 below(0.0);
        below[i] = 1.0;
        below.w = -lo[i];
        vec4 above(0.0);
        above[i] = -1.0;
        above.w = hi[i];
        planes.push_back(below);
        planes.push_back(above);
    }
    return vertices(planes);
}

template <typename T> frustum<T> any_camera(double max_ratio) {
    const auto volume = camera_test::any_volume<T>(false, max_ratio);
    return make_frustum<T>(camera_test::any_direction<T>(1e-3, 1e3),
                           camera_test::any_direction<T>(0.1, 10.0),
                           camera_test::any_direction<T>(0.1, 10.0), volume)
        .value;
}

/// Points inside the camera's frustum.
template <typename T> std::vector<glm::vec<3, T>> any_body(const frustum<T>& camera) {
    if (coin()) {
        return body_of(camera);
    }
    const auto v = camera.volume;
    std::vector<glm::vec<3, T>> body;
    const int count = *rc::gen::inRange(1, 13);
    for (int i = 0; i < count; ++i) {
        const double z = log_between<double>(double(v.near_distance), double(v.far_distance));
        const double x = between<double>(double(v.left), double(v.right));
        const double y = between<double>(double(v.bottom), double(v.top));
        body.push_back(glm::vec<3, T>(
            z * (vec3(camera.forward) + x * vec3(camera.right) + y * vec3(camera.up))));
    }
    return body;
}

template <typename T> bool finite(const lispsm_result<T>& r) {
    return camera_test::finite(r.matrix) && camera_test::finite(r.warp) && std::isfinite(r.rho) &&
           std::isfinite(r.inverse_near) && std::isfinite(r.fade) && std::isfinite(r.depth_scale) &&
           std::isfinite(r.depth_shift) && std::isfinite(r.depth_centre);
}

} // namespace

// --- the textbooks' formulas ---------------------------------------------------------------------

TEMPLATE_TEST_CASE("peers 22: both textbook forms of n_opt agree with 100 digits", "", float,
                   double) {
    REQUIRE(rc::check([] {
        const TestType z0 = log_between<TestType>(1e-3, 1e3);
        const TestType d = log_between<TestType>(1e-6, 1e6);
        const TestType sine = log_between<TestType>(1e-6, 1.0);
        const TestType z1 = static_cast<TestType>(double(z0) + double(d) * double(sine));
        const real r0(z0);
        // n = (z0 + sqrt(z0 z1)) / sin γ, with the z1 that is given
        const real n = (r0 + sqrt(r0 * real(z1))) / real(sine);
        const double u = camera_test::roundoff<TestType>();
        // two square roots, a product, a sum, a quotient: 5 roundings, some of them halved
        RC_ASSERT(abs(real(inverse_n_opt(z0, z1, sine)) * n - 1) <= 8 * u);
        // 2006: n = d / (sqrt(z1 / z0) - 1) with z1 - z0 exact; equal to it only up to z1's
        // rounding
        if (z1 > z0) {
            const real m = real(d) / (sqrt(real(z1) / r0) - 1);
            RC_ASSERT(abs(real(inverse_n_opt_2006(z0, z1, d)) * m - 1) <= 10 * u);
            // with d sin γ = z1 - z0 in exact arithmetic the two are one formula
            const real exact_sine = (real(z1) - r0) / real(d);
            const real other = (r0 + sqrt(r0 * real(z1))) / exact_sine;
            // 100 digits less the 16 that cancel in sqrt(z1 / z0) - 1 at z1 = z0 + ulp
            RC_ASSERT(abs(m / other - 1) < real("1e-80"));
        }
    }));
}

TEST_CASE("J6: light at right angles, near 1, far 101") {
    const auto camera = camera_of<double>(60 * degree, 1.0, 1.0, 101.0);
    const auto body = body_of(camera);
    const auto r = lispsm<double>(camera, sun(vec3(0, -1, 0)), body, clip::opengl);
    CHECK(r.flags == status::ok);
    CHECK(1.0 / r.inverse_near == Approx(1.0 + std::sqrt(101.0)).epsilon(1e-12)); // 11.0499
    CHECK(std::expm1(r.rho) == Approx(std::sqrt(101.0) - 1.0).epsilon(1e-12));    // 9.0499
}

TEST_CASE("J7: n_opt at 30 degrees divides the swept depth by sin, not the extent") {
    CHECK(1.0 / inverse_n_opt(1.0, 1.0 + 100.0 * 0.5, 0.5) == Approx(16.2828568570857));
    CHECK(1.0 / inverse_n_opt_2006(1.0, 51.0, 100.0) == Approx(16.2828568570857));
    CHECK(1.0 / inverse_n_opt(1.0, 101.0, 0.5) > 22.0); // eq. 1 of Scherzer 2005, read literally
}

TEST_CASE("peers 22: the warp's strength is at most far / near and goes to none") {
    const auto camera = camera_of<double>(60 * degree, 1.0, 1.0, 100.0);
    const auto body = body_of(camera);
    double previous = std::numeric_limits<double>::infinity();
    for (int i = 90; i >= 0; --i) {
        const auto r =
            lispsm<double>(camera, sun(light_at<double>(i * degree)), body, clip::opengl);
        CAPTURE(i);
        CHECK(std::exp(r.rho) <= 100.0);
        // n_opt alone has its largest value near 70 degrees; the fade is monotone below 45
        if (i < 45) {
            CHECK(r.rho <= previous);
        }
        previous = r.rho;
    }
    CHECK(previous == 0.0);
}

TEST_CASE("rho for a light with a position: the formula and its limits") {
    REQUIRE(rc::check([] {
        const double z0 = log_between<double>(1e-3, 1e3);
        const double z1 = z0 * log_between<double>(1.0, 1e6);
        const double W0 = log_between<double>(1e-3, 1e3);
        const double W1 = W0 * log_between<double>(1e-3, 1e3);
        const real truth = log(sqrt(real(z1) / real(z0)) * real(W0) / real(W1));
        const real size = 1 + abs(log(real(z1) / real(z0))) + abs(log(real(W1) / real(W0)));
        RC_ASSERT(abs(real(rho_opt(z0, z1, W0, W1)) - truth) <= 4e-16 * size);
        RC_ASSERT(rho_opt(z0, z0, W0, W0) == 0.0);
    }));
    CHECK(rho_opt(1.0, 1.0 + 1e-12, 1.0, 1.0) == Approx(0.5e-12).epsilon(1e-4));
}

TEST_CASE("skip rule: displacement of the group of warps") {
    // s = (1 + b) t / (1 + b t): the largest |s - t| over t, by search
    for (const double rho : {0.01, 0.5, 2.0, 6.0}) {
        const double b = std::expm1(rho);
        double largest = 0.0;
        for (int i = 0; i <= 100000; ++i) {
            const double t = i / 100000.0;
            largest = std::max(largest, (1.0 + b) * t / (1.0 + b * t) - t);
        }
        CHECK(warp_displacement(rho) == Approx(largest).epsilon(1e-6));
        CHECK(warp_displacement(-rho) == warp_displacement(rho));
    }
    CHECK_FALSE(worth_warping(0.0, 2048));
    CHECK_FALSE(worth_warping(0.04, 1 << 20)); // less than 5 % to gain
    CHECK(worth_warping(0.1, 2048));
    CHECK_FALSE(worth_warping(0.1, 32)); // less than a texel
}

// --- parallel light, fade, continuity ------------------------------------------------------------

TEMPLATE_TEST_CASE("J1, J2, peers 1: light along and against the view is uniform", "", float,
                   double) {
    using T = TestType;
    const auto camera = camera_of<T>(60 * degree, 1.0, 1.0, 100.0);
    const auto body = body_of(camera);
    for (const T z : {T(-1), T(1)}) {
        const auto light = sun(glm::vec<3, T>(T(0), T(0), z));
        const auto r = lispsm<T>(camera, light, body, clip::opengl);
        lispsm_options<T> off;
        off.strength = T(0);
        const auto uniform = lispsm<T>(camera, light, body, clip::opengl, off);
        CHECK(r.flags == (status::stayed_uniform | status::light_in_view));
        CHECK(r.rho == T(0));
        CHECK(r.inverse_near == T(0));
        CHECK(same_bits(r.matrix, uniform.matrix));
        CHECK(glm::vec<4, T>(r.matrix[0][3], r.matrix[1][3], r.matrix[2][3], r.matrix[3][3]) ==
              glm::vec<4, T>(T(0), T(0), T(0), T(1)));
    }
}

TEST_CASE("J3, J10: angle 1e-7, far / near 1e7, float") {
    const auto camera = camera_of<float>(60 * degree, 1.0, 0.1, 1e6);
    const auto body = body_of(camera);
    for (const double gamma : {1e-7, 1.2}) {
        const glm::vec3 light = light_at<float>(gamma, 1.0);
        const auto r = lispsm<float>(camera, sun(light), body, clip::opengl);
        lispsm_test::scene<float> s{camera, light, body, {}};
        const lispsm_test::oracle truth(camera, light, std::span<const glm::vec3>(body));
        CAPTURE(gamma);
        CHECK(finite(r));
        CHECK((r.rho == 0.0f) == (gamma < 1.0));
        CHECK(lispsm_test::texel_error(r.matrix, truth, s, 2048) <= 0.01);
    }
}

TEST_CASE("J4: 20 degrees, far / near 1e4: w positive at the corners, no worse than uniform") {
    const auto camera = camera_of<double>(60 * degree, 1.0, 0.1, 1000.0);
    const auto body = body_of(camera);
    const vec3 light = light_at<double>(20 * degree);
    const auto r = lispsm<double>(camera, sun(light), body, clip::opengl, {}, no_fade{});
    for (const vec3& p : body) {
        CHECK((r.matrix * vec4(p, 1.0)).w >= 1.0 - 1e-12);
    }
    // Scherzer's eq. 2 puts the near plane at the eye instead: behind it lies a part of the body
    const double n = 1.0 / r.inverse_near;
    const vec3 axis = glm::normalize(glm::cross(light, glm::cross(vec3(0, 0, -1), light)));
    double least = 1.0;
    for (const vec3& p : body) {
        least = std::min(least, 1.0 + (glm::dot(axis, p) - 0.1) / n);
    }
    CHECK(least < 0.0);

    const auto faded = lispsm<double>(camera, sun(light), body, clip::opengl);
    lispsm_options<double> off;
    off.strength = 0.0;
    const auto uniform = lispsm<double>(camera, sun(light), body, clip::opengl, off);
    CHECK(largest_error(faded.matrix, camera, light) <=
          largest_error(uniform.matrix, camera, light) * (1.0 + 1e-12));
}

TEST_CASE("J5: at the edge of the view cone the map moves like the uniform one") {
    const auto camera = camera_of<double>(60 * degree, 1.0, 1.0, 1000.0);
    const auto body = body_of(camera);
    lispsm_options<double> off;
    off.strength = 0.0;
    const auto map = [&](double gamma, const lispsm_options<double>& options) {
        return lispsm<double>(camera, sun(light_at<double>(gamma)), body, clip::opengl, options);
    };
    const auto edge = map(30 * degree, {});
    CHECK(edge.fade < 1e-14); // 30 degrees are not exact in binary
    for (const double step : {-1e-6, 1e-6}) {
        for (const vec3& p : body) {
            const vec3 moved = ndc(map(30 * degree + step, {}).matrix, p) - ndc(edge.matrix, p);
            const vec3 by_itself =
                ndc(map(30 * degree + step, off).matrix, p) - ndc(map(30 * degree, off).matrix, p);
            // half of NDC is the map; 2048 texels
            CHECK(glm::length(vec2(moved - by_itself)) * 1024.0 <= 1e-4);
        }
    }
}

TEST_CASE("never worse than uniform over angle, azimuth and near distance") {
    lispsm_options<double> off;
    off.strength = 0.0;
    double at_right_angles = 1.0;
    for (const double zn : {1.0, 0.1}) {
        const auto camera = camera_of<double>(60 * degree, 1.0, zn, 1000.0);
        const auto body = body_of(camera);
        for (const double gamma :
             {90.0, 60.0, 45.0, 36.0, 33.0, 31.0, 30.0, 20.0, 10.0, 1.0, 0.0}) {
            for (int azimuth = 0; azimuth <= 180; azimuth += 15) {
                const vec3 light = light_at<double>(gamma * degree, azimuth * degree);
                const auto warped = lispsm<double>(camera, sun(light), body, clip::opengl);
                const auto uniform = lispsm<double>(camera, sun(light), body, clip::opengl, off);
                const double ratio = largest_error(warped.matrix, camera, light) /
                                     largest_error(uniform.matrix, camera, light);
                CAPTURE(zn, gamma, azimuth);
                CHECK(ratio <= 1.0 + 1e-12);
                if (gamma == 90.0 && zn == 1.0) {
                    at_right_angles = std::min(at_right_angles, ratio);
                }
            }
        }
    }
    // 1 / sqrt(1000) = 0.0316 of the uniform map's error
    CHECK(at_right_angles == Approx(std::sqrt(1e-3)).epsilon(0.02));
}

TEST_CASE("J16: a sweep of the light through or past the view never jumps") {
    struct sweep {
        const char* name;
        double azimuth; ///< of the plane of the sweep
        double aspect;  ///< of the view
        double miss;    ///< angle at which it passes the view direction
        double bound;   ///< map widths per radian
    };
    // 45 degrees: through a corner of the view, as in the table that the bound of 10 comes from
    const sweep sweeps[] = {{"diagonal", 0.25 * pi, 1.0, 0.0, 10.0},
                            {"in the plane of the image's up", 0.5 * pi, 1.0, 0.0, 50.0},
                            {"skew, wide view", pi / 3.0, 1.5, 0.0, 50.0},
                            {"past at 0.3", 0.5 * pi, 1.0, 0.3, 50.0}};
    for (const double ratio : {116.0, 1156.0, 1.2e4, 1.2e5}) {
        for (const sweep& s : sweeps) {
            const auto camera = camera_of<double>(60 * degree, s.aspect, 1.0, ratio);
            const auto body = body_of(camera);
            std::vector<vec3> points = body;
            for (int depth = 0; depth <= 6; ++depth) {
                const double z = std::pow(ratio, depth / 6.0);
                points.push_back(z * vec3(0.0, 0.0, -1.0));
                points.push_back(z * vec3(0.5, -0.4, -1.0));
                points.push_back(z * vec3(-0.3, -0.5, -1.0));
            }
            const double step = 1e-4;
            double fastest = 0.0;
            std::vector<vec2> last;
            for (int i = -14000; i <= 14000; ++i) {
                // dense where it matters: near the view direction and in the fade
                const double gamma = i * step;
                const double inside = std::abs(gamma);
                const bool dense = inside < 0.002;
                if (!dense && i % 40 != 0 && (i + 39) % 40 != 0) {
                    last.clear();
                    continue;
                }
                const vec3 across(std::cos(s.azimuth), std::sin(s.azimuth), 0.0);
                const vec3 aside(-across.y, across.x, 0.0);
                const vec3 light = std::cos(s.miss) * (std::cos(gamma) * vec3(0, 0, -1) +
                                                       std::sin(gamma) * across) +
                                   std::sin(s.miss) * aside;
                const auto r = lispsm<double>(camera, sun(light), body, clip::opengl);
                REQUIRE(finite(r));
                std::vector<vec2> now;
                for (const vec3& p : points) {
                    now.push_back(0.5 * vec2(ndc(r.matrix, p)));
                }
                for (std::size_t k = 0; k < last.size(); ++k) {
                    const vec2 moved = glm::abs(now[k] - last[k]) / step;
                    fastest = std::max(fastest, std::max(moved.x, moved.y));
                }
                last = now;
            }
            CAPTURE(ratio, s.name, fastest);
            CHECK(fastest <= s.bound);
            CHECK(fastest > 0.1); // something moved
        }
    }
}

// --- the body is covered, whatever it is ---------------------------------------------------------

TEMPLATE_TEST_CASE("w is positive and the body covered for any camera, light and body", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const auto camera = any_camera<T>(1e6);
        const auto body = any_body(camera);
        const auto light = sun(camera_test::any_direction<T>(1e-3, 1e3));
        lispsm_options<T> options;
        options.strength = between<T>(0.0, 2.0);
        options.axis = coin() ? lispsm_axis::view : lispsm_axis::middle;
        options.visible_far =
            coin() ? std::numeric_limits<T>::infinity() : log_between<T>(1e-3, 1e6);
        const clip_space clip = camera_test::any_convention();
        const auto r = coin() ? lispsm<T>(camera, light, body, clip, options)
                              : lispsm<T>(camera, light, body, clip, options, no_fade{});
        RC_ASSERT(finite(r));
        RC_ASSERT(!any(r.flags, status::invalid_input | status::unbounded | status::out_of_range));
        const double u = camera_test::roundoff<T>();
        for (const glm::vec<3, T>& p : body) {
            const auto p4 = camera_test::real4{real(p.x), real(p.y), real(p.z), real(1)};
            const auto clip_position = camera_test::multiply(r.matrix, p4);
            const auto terms = camera_test::magnitudes(r.matrix, p4);
            // w ≥ 1 before rounding; the entries carry a few roundings each (double: of the whole
            // computation, float: of the last step)
            const double slack = 64.0 * u * camera_test::as_double(terms[3]);
            RC_ASSERT(camera_test::as_double(clip_position[3]) >= 1.0 - slack);
            for (std::size_t i = 0; i < 2; ++i) {
                const double c = camera_test::as_double(clip_position[i]);
                const double w = camera_test::as_double(clip_position[3]);
                const double rounding = 64.0 * u * camera_test::as_double(terms[i] + terms[3]);
                RC_ASSERT(std::abs(c) <= w + rounding);
            }
        }
    }));
}

TEST_CASE("depth is in range over the body and monotone along light rays, in every convention") {
    REQUIRE(rc::check([] {
        const auto camera = any_camera<double>(1e4);
        const auto body = any_body(camera);
        const vec3 direction = camera_test::any_direction<double>(0.5, 2.0);
        const clip_space clip = camera_test::any_convention();
        const auto r = lispsm<double>(camera, sun(direction), body, clip);
        const double lowest = clip.depth == depth_range::zero_to_one ? 0.0 : -1.0;
        double size = 0.0;
        for (const vec3& p : body) {
            size = std::max(size, glm::length(p));
        }
        for (const vec3& p : body) {
            const double z = ndc(r.matrix, p).z;
            const double terms = std::abs(r.matrix[0][2] * p.x) + std::abs(r.matrix[1][2] * p.y) +
                                 std::abs(r.matrix[2][2] * p.z) + std::abs(r.matrix[3][2]);
            const double slack = 1e-14 * (1.0 + terms);
            RC_ASSERT(z >= lowest - slack);
            RC_ASSERT(z <= 1.0 + slack);
            const double deeper = ndc(r.matrix, p + size * glm::normalize(direction)).z;
            RC_ASSERT((clip.reversed_z ? deeper < z : deeper > z));
        }
    }));
}

TEST_CASE("peers 40: one map of the world in every convention") {
    const auto camera = camera_of<double>(60 * degree, 1.5, 1.0, 100.0);
    const auto body = body_of(camera);
    for (const bool spot : {false, true}) {
        const auto light =
            spot ? spot_light(vec3(0, 80, -40), vec3(0, 0, -50), 2.5) : sun(vec3(0.3, -1, 0.2));
        const auto reference = lispsm<double>(camera, light, body, clip::opengl);
        for (const clip_space& clip : camera_test::all_conventions()) {
            const auto r = lispsm<double>(camera, light, body, clip);
            CHECK(r.flags == reference.flags);
            CHECK(r.rho == reference.rho);
            for (const vec3& p : body) {
                const vec2 expected = map_from_ndc(vec2(ndc(reference.matrix, p)), clip::opengl);
                const vec2 found = map_from_ndc(vec2(ndc(r.matrix, p)), clip);
                CHECK(glm::length(found - expected) <= 1e-12);
                const double near_z = near_depth<double>(clip);
                const double far_z = far_depth<double>(clip);
                const double depth = (ndc(r.matrix, p).z - near_z) / (far_z - near_z);
                const double truth = 0.5 * ndc(reference.matrix, p).z + 0.5;
                // reversed -1/distance is fitted from its other end: the same up to rounding
                CHECK(depth == Approx(truth).margin(1e-12));
            }
        }
    }
}

TEMPLATE_TEST_CASE("J23, peers 5: scaling by a power of two changes no bit", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        auto camera = any_camera<T>(1e4);
        auto body = any_body(camera);
        const int kind = *rc::gen::inRange(0, 3);
        auto light = sun(camera_test::any_direction<T>(1e-3, 1e3));
        light.kind = kind == 0 ? light_kind::directional
                               : (kind == 1 ? light_kind::spot : light_kind::point);
        light.position = camera_test::any_direction<T>(1e-1, 1e4);
        lispsm_options<T> options;
        options.axis = coin() ? lispsm_axis::view : lispsm_axis::middle;
        options.visible_far = log_between<T>(1.0, 1e6);
        options.casters = body;
        const clip_space clip = camera_test::any_convention();
        const auto before = lispsm<T>(camera, light, body, clip, options);

        const int exponent = *rc::gen::inRange(-20, 21);
        const T s = std::ldexp(T(1), exponent);
        camera.eye *= s;
        camera.volume.near_distance *= s;
        camera.volume.far_distance *= s;
        light.position *= s;
        options.visible_far *= s;
        std::vector<glm::vec<3, T>> scaled = body;
        for (auto& p : scaled) {
            p *= s;
        }
        options.casters = scaled;
        auto after = lispsm<T>(camera, light, scaled, clip, options);
        RC_ASSERT(after.flags == before.flags);
        RC_ASSERT(after.rho == before.rho);
        RC_ASSERT(after.fade == before.fade);
        RC_ASSERT(after.inverse_near * s == before.inverse_near);
        // columns 0 to 2 take positions; clip w of a light with a position is a length as well
        const T row = kind == 0 || any(before.flags, status::light_inside_body) ? T(1) : T(1) / s;
        bool equal = true;
        if (!any(before.flags, status::light_inside_body)) {
            for (glm::length_t c = 0; c < 4; ++c) {
                for (glm::length_t i = 0; i < 4; ++i) {
                    equal = equal &&
                            after.matrix[c][i] * (c < 3 ? s : T(1)) * row == before.matrix[c][i];
                }
            }
        }
        RC_ASSERT(equal);
    }));
}

// --- composition ---------------------------------------------------------------------------------

TEST_CASE("the warp multiplies any light matrix from the left and gives the same map") {
    REQUIRE(rc::check([] {
        const auto camera = any_camera<double>(1e3);
        const auto body = body_of(camera);
        const auto light = sun(camera_test::any_direction<double>(0.5, 2.0));
        const auto alone = lispsm<double>(camera, light, body, clip::opengl);
        // any fit in the same axes: scales, shifts, even a mirror
        const auto axes = light_frame(light.direction);
        mat4 m(1.0);
        double size = 0.0;
        for (const vec3& p : body) {
            size = std::max(size, glm::length(p));
        }
        const vec3 rows[3] = {axes.right * log_between<double>(1e-2, 1e2) / size,
                              axes.up * log_between<double>(1e-2, 1e2) / size,
                              axes.forward * log_between<double>(1e-2, 1e2) / size};
        for (glm::length_t i = 0; i < 3; ++i) {
            for (glm::length_t c = 0; c < 3; ++c) {
                m[c][i] = rows[i][c];
            }
            m[3][i] = between<double>(-2.0, 2.0);
        }
        const auto on_top = lispsm_warp<double>(camera, light, m, body, clip::opengl);
        RC_ASSERT(on_top.flags == alone.flags);
        RC_ASSERT(std::abs(on_top.rho - alone.rho) <= 1e-9 * (1.0 + alone.rho));
        const mat4 product = on_top.warp * m;
        for (const vec3& p : body) {
            RC_ASSERT(glm::length(ndc(on_top.matrix, p) - ndc(alone.matrix, p)) <= 1e-8);
            RC_ASSERT(glm::length(ndc(on_top.matrix, p) - ndc(product, p)) <= 1e-8);
        }
    }));
}

TEST_CASE("the warp keeps what it left: the light's own depth comes back") {
    const auto camera = camera_of<double>(60 * degree, 1.5, 1.0, 100.0);
    const auto body = body_of(camera);
    const auto light = sun(vec3(0.3, -1, 0.2));
    const mat4 m =
        directional_light_matrix(light, box3<double>{vec3(-150), vec3(150)}, clip::opengl).matrix;
    const auto r = lispsm_warp<double>(camera, light, m, body, clip::opengl);
    REQUIRE(r.rho > 1.0);
    for (const vec3& p : body) {
        const vec4 c = r.matrix * vec4(p, 1.0);
        const double own = (m * vec4(p, 1.0)).z;
        CHECK((c.z / c.w - r.depth_shift) * c.w / r.depth_scale + r.depth_centre ==
              Approx(own).epsilon(1e-9));
    }
}

TEST_CASE("margin leaves a border, casters extend the depth range") {
    const auto camera = camera_of<double>(60 * degree, 1.5, 1.0, 100.0);
    const auto body = body_of(camera);
    const auto light = sun(vec3(0.3, -1, 0.2));
    lispsm_options<double> options;
    options.margin = 0.01;
    std::vector<vec3> casters;
    for (const vec3& p : body) {
        casters.push_back(p - 50.0 * glm::normalize(vec3(light.direction)));
    }
    options.casters = casters;
    const auto r = lispsm<double>(camera, light, body, clip::d3d, options);
    vec2 largest(0.0);
    double least_depth = 1.0;
    for (const vec3& p : body) {
        largest = glm::max(largest, glm::abs(vec2(ndc(r.matrix, p))));
        least_depth = std::min(least_depth, ndc(r.matrix, p).z);
    }
    CHECK(largest.x == Approx(0.98).epsilon(1e-9));
    CHECK(largest.y == Approx(0.98).epsilon(1e-9));
    CHECK(least_depth > 1e-3);
    double least = 1.0;
    for (const vec3& p : casters) {
        const double z = ndc(r.matrix, p).z;
        CHECK(z >= -1e-12);
        least = std::min(least, z);
    }
    CHECK(least == Approx(0.0).margin(1e-12));
}

// --- what the caller can choose ------------------------------------------------------------------

TEST_CASE("strength, fade, visible far and middle vector") {
    const auto camera = camera_of<double>(60 * degree, 1.5, 1.0, 1000.0);
    const auto body = body_of(camera);
    const auto light = sun(vec3(0, -1, 0));
    const auto normal = lispsm<double>(camera, light, body, clip::opengl);

    SECTION("strength is a factor on rho: 2 gives perspective shadow maps") {
        lispsm_options<double> options;
        options.strength = 2.0;
        const auto psm = lispsm<double>(camera, light, body, clip::opengl, options);
        CHECK(psm.rho == Approx(std::log(1000.0)));
        options.strength = 1e30;
        CHECK(lispsm<double>(camera, light, body, clip::opengl, options).rho == psm.rho);
        options.strength = std::numeric_limits<double>::quiet_NaN();
        CHECK(finite(lispsm<double>(camera, light, body, clip::opengl, options)));
    }
    SECTION("a fade of one's own, asked with the sine of the angle outside the cone") {
        double asked = 0.0;
        const auto r = lispsm<double>(camera, light, body, clip::opengl, {}, [&](double s) {
            asked = s;
            return 0.25;
        });
        CHECK(asked == Approx(std::cos(30 * degree))); // straight down: 60 degrees off the cone
        CHECK(r.rho == Approx(0.25 * normal.rho));
        CHECK(r.fade == 0.25);
        const auto bad = lispsm<double>(camera, light, body, clip::opengl, {},
                                        [](double) { return std::nan(""); });
        CHECK(finite(bad));
    }
    SECTION("a nearer visible far weakens the warp and cuts nothing off") {
        lispsm_options<double> options;
        options.visible_far = 100.0;
        const auto r = lispsm<double>(camera, light, body, clip::opengl, options);
        CHECK(r.rho == Approx(0.5 * std::log(100.0)));
        for (const vec3& p : body) {
            const vec3 q = ndc(r.matrix, p);
            CHECK(std::abs(q.x) <= 1.0 + 1e-12);
            CHECK(std::abs(q.y) <= 1.0 + 1e-12);
            CHECK((r.matrix * vec4(p, 1.0)).w >= 1.0 - 1e-12);
        }
        // more of the map for what is near
        const auto share = [&](const lispsm_result<double>& map) {
            const vec3 step = ndc(map.matrix, vec3(0, 0, -1.1)) - ndc(map.matrix, vec3(0, 0, -1));
            return glm::length(vec2(step));
        };
        CHECK(share(r) > share(normal));
        options.visible_far = 0.1; // nearer than the near plane: nothing is left to warp
        CHECK(lispsm<double>(camera, light, body, clip::opengl, options).rho == 0.0);
    }
    SECTION("the middle vector is the view axis for a symmetric body, and follows a lopsided one") {
        lispsm_options<double> options;
        options.axis = lispsm_axis::middle;
        const auto same = lispsm<double>(camera, light, body, clip::opengl, options);
        CHECK(same.rho == Approx(normal.rho));
        for (const vec3& p : body) {
            CHECK(glm::length(ndc(same.matrix, p) - ndc(normal.matrix, p)) <= 1e-9);
        }
        std::vector<vec3> lopsided = body;
        lopsided[5].x = lopsided[6].x = -100.0; // the right far corners
        const auto r = lispsm<double>(camera, light, lopsided, clip::opengl, options);
        // w grows towards the middle of this body
        vec3 sum(0.0);
        for (const vec3& p : lopsided) {
            sum += p;
        }
        const vec3 slope(r.matrix[0][3], r.matrix[1][3], r.matrix[2][3]);
        CHECK(glm::length(glm::cross(glm::normalize(slope),
                                     glm::normalize(vec3(sum.x, 0.0, sum.z)))) <= 1e-9);
        for (const vec3& p : lopsided) {
            CHECK((r.matrix * vec4(p, 1.0)).w >= 1.0 - 1e-12);
        }
    }
}

// --- degenerate input ----------------------------------------------------------------------------

TEMPLATE_TEST_CASE("J8, peers 18: bodies without extent", "", float, double) {
    using T = TestType;
    using v3 = glm::vec<3, T>;
    const auto camera = camera_of<T>(60 * degree, 1.0, 1.0, 100.0);
    const auto light = sun(v3(T(0), T(-1), T(0)));
    const std::vector<v3> point = {v3(T(1), T(2), T(-10))};
    const std::vector<v3> plane = {v3(T(-1), T(-1), T(-10)), v3(T(1), T(-1), T(-10)),
                                   v3(T(1), T(1), T(-10)), v3(T(-1), T(1), T(-10))};
    const std::vector<v3> edge = {v3(T(0), T(-1), T(-10)), v3(T(0), T(1), T(-10))};
    const std::vector<v3> eye = {v3(T(0))};
    for (const auto& body : {point, plane, edge, eye}) {
        const auto r = lispsm<T>(camera, light, body, clip::opengl);
        CHECK(any(r.flags, status::degenerate_extent));
        CHECK(any(r.flags, status::stayed_uniform));
        CHECK(r.rho == T(0));
        CHECK(finite(r));
        for (const v3& p : body) {
            const vec3 q = ndc(r.matrix, vec3(p));
            // a scale of 2^24 on rounded positions
            CHECK(std::abs(q.x) <= 2.0);
            CHECK(std::abs(q.y) <= 2.0);
        }
    }
    // flat, but not across the axis: a ground plane is the best of bodies
    const std::vector<v3> ground = {v3(T(-1), T(-1), T(-2)), v3(T(1), T(-1), T(-2)),
                                    v3(T(1), T(-1), T(-90)), v3(T(-1), T(-1), T(-90))};
    CHECK(lispsm<T>(camera, light, ground, clip::opengl).rho > T(1));
}

TEMPLATE_TEST_CASE("J9, peers 19: body at or behind the eye", "", float, double) {
    using T = TestType;
    using v3 = glm::vec<3, T>;
    const auto camera = camera_of<T>(60 * degree, 1.0, 1.0, 100.0);
    const auto light = sun(v3(T(0), T(-1), T(0)));
    for (const T z : {T(0), T(5), T(1000)}) {
        const std::vector<v3> body = {v3(T(-1), T(0), z), v3(T(1), T(0), z),
                                      v3(T(0), T(5), T(-100)), v3(T(0), T(-5), T(-100))};
        const auto r = lispsm<T>(camera, light, body, clip::opengl);
        CHECK(any(r.flags, status::near_clamped));
        CHECK(finite(r));
        // as if it began at the near distance
        CHECK(double(r.rho) == Approx(0.5 * std::log1p(100.0 + double(z))).epsilon(1e-6));
    }
    // z1 ≤ z0: all of it behind the eye
    const std::vector<v3> behind = {v3(T(-1), T(0), T(3)), v3(T(1), T(1), T(9))};
    CHECK(finite(lispsm<T>(camera, light, behind, clip::opengl)));
}

TEST_CASE("J11, peers 3: infinite far plane") {
    const double inf = std::numeric_limits<double>::infinity();
    const auto endless = camera_of<double>(60 * degree, 1.0, 1.0, inf);
    const auto distant = camera_of<double>(60 * degree, 1.0, 1.0, 1e6);
    const vec3 lo(-500, -20, -800);
    const vec3 hi(400, 30, 100);
    const auto a = in_box(endless, lo, hi);
    const auto b = in_box(distant, lo, hi);
    REQUIRE(a.size() == b.size());
    REQUIRE(a.size() >= 8);
    const auto light = sun(vec3(0.3, -1, 0.2));
    const auto ra = lispsm<double>(endless, light, a, clip::opengl.infinite());
    const auto rb = lispsm<double>(distant, light, b, clip::opengl);
    CHECK(ra.flags == status::ok);
    CHECK(ra.rho == Approx(rb.rho).epsilon(1e-6));
    for (const vec3& p : a) {
        CHECK(glm::length(ndc(ra.matrix, p) - ndc(rb.matrix, p)) <= 1e-6);
    }
    std::vector<vec3> unbounded = a;
    unbounded.push_back(vec3(0, 0, -inf));
    const auto r = lispsm<double>(endless, light, unbounded, clip::opengl);
    CHECK(any(r.flags, status::unbounded));
    CHECK(any(r.flags, status::stayed_uniform));
    CHECK(finite(r));
}

TEST_CASE("J12: reversed and standard depth of the same camera give the same map") {
    const auto volume = camera_of<double>(60 * degree, 1.5, 0.5, 2000.0).volume;
    const auto light = sun(vec3(0.3, -1, 0.2));
    mat4 maps[2];
    for (int i = 0; i < 2; ++i) {
        const clip_space clip = i == 0 ? clip::opengl : clip::vulkan.reversed();
        const mat4 projection = projection_matrix(volume, clip);
        const auto seen = volume_from_projection(projection, clip);
        REQUIRE(seen.flags == status::ok);
        const auto camera =
            make_frustum<double>(vec3(0), vec3(0, 0, -1), vec3(0, 1, 0), seen.volume).value;
        const auto body = body_of(camera);
        maps[i] = lispsm<double>(camera, light, body, clip::opengl).matrix;
    }
    // the far distance comes back from the standard matrix to u · far / near: 4000 · 1e-16
    for (const vec3& p : {vec3(0, 0, -1), vec3(2, 1, -50), vec3(-100, 20, -1500)}) {
        CHECK(glm::length(ndc(maps[0], p) - ndc(maps[1], p)) <= 1e-11);
    }
}

TEST_CASE("J13, peers 6: eye far from the origin, float") {
    const glm::vec3 eye(1e6f, 2e6f, -1e6f);
    const auto camera = camera_of<float>(60 * degree, 1.0, 1.0, 100.0, eye);
    const auto body = body_of(camera);
    const glm::vec3 light = light_at<float>(1.2, 1.0);
    const lispsm_test::scene<float> s{camera, light, body, {}};
    const lispsm_test::oracle truth(camera, light, std::span<const glm::vec3>(body));
    const auto r = lispsm<float>(camera, sun(light), body, clip::opengl);
    CHECK(r.rho > 1.0f);
    CHECK(lispsm_test::texel_error(r.matrix, truth, s, 2048) <= 1e-3);
    // and the eye does not matter at all for sunlight
    const auto at_origin = lispsm<float>(camera_of<float>(60 * degree, 1.0, 1.0, 100.0), sun(light),
                                         body, clip::opengl);
    CHECK(same_bits(r.matrix, at_origin.matrix));
}

TEMPLATE_TEST_CASE("J15, peers 21: light of any length; zero, NaN and infinite ones", "", float,
                   double) {
    using T = TestType;
    using v3 = glm::vec<3, T>;
    const auto camera = camera_of<T>(60 * degree, 1.0, 1.0, 100.0);
    const auto body = body_of(camera);
    const v3 direction(T(0.25), T(-1), T(0.5));
    const auto one = lispsm<T>(camera, sun(direction), body, clip::opengl);
    for (const int exponent : {-66, 66}) { // 1e-20 and 1e20
        const v3 scaled = direction * std::ldexp(T(1), exponent);
        CHECK(same_bits(lispsm<T>(camera, sun(scaled), body, clip::opengl).matrix, one.matrix));
    }
    for (const T length : {T(1e-20), T(1e20)}) {
        const auto r = lispsm<T>(camera, sun(direction * length), body, clip::opengl);
        CHECK(double(r.rho) == Approx(double(one.rho)).epsilon(1e-6));
    }
    const T inf = std::numeric_limits<T>::infinity();
    const T nan = std::numeric_limits<T>::quiet_NaN();
    for (const v3& bad : {v3(T(0)), v3(nan, T(0), T(1)), v3(inf, T(0), T(0))}) {
        light<T> source = sun(direction);
        source.direction = bad;
        const auto r = lispsm<T>(camera, source, body, clip::opengl);
        CHECK(any(r.flags, status::invalid_input));
        CHECK(any(r.flags, status::stayed_uniform));
        CHECK(r.matrix == glm::mat<4, 4, T>(T(1)));
    }
}

TEST_CASE("peers 2: light straight down, straight up, along the axes") {
    const auto camera = camera_of<double>(60 * degree, 1.5, 1.0, 100.0);
    const auto body = body_of(camera);
    for (const vec3& l : {vec3(0, -1, 0), vec3(0, 1, 0), vec3(1, 0, 0), vec3(-1, 0, 0)}) {
        const auto r = lispsm<double>(camera, sun(l), body, clip::opengl);
        CHECK(r.flags == status::ok);
        CHECK(r.rho == Approx(0.5 * std::log(100.0)).epsilon(0.35)); // d depends on the aspect
        // w does not change along the light
        const vec3 slope(r.matrix[0][3], r.matrix[1][3], r.matrix[2][3]);
        CHECK(glm::dot(slope, l) == Approx(0.0).margin(1e-15));
    }
}

TEST_CASE("peers 8: an orthographic camera has no perspective") {
    auto camera = camera_of<double>(60 * degree, 1.0, 1.0, 100.0);
    camera.volume = view_volume<double>{-10, 10, -10, 10, 0.0, 100.0, true};
    const auto body = body_of(camera);
    const auto r = lispsm<double>(camera, sun(vec3(0, -1, 0)), body, clip::opengl);
    CHECK(r.flags == (status::no_perspective | status::stayed_uniform));
    for (const vec3& p : body) {
        CHECK(std::abs(ndc(r.matrix, p).x) <= 1.0 + 1e-12);
        CHECK(std::abs(ndc(r.matrix, p).y) <= 1.0 + 1e-12);
    }
}

TEST_CASE("no points, points at infinity, a broken camera") {
    const auto camera = camera_of<double>(60 * degree, 1.0, 1.0, 100.0);
    const auto light = sun(vec3(0, -1, 0));
    const std::vector<vec3> none;
    CHECK(lispsm<double>(camera, light, none, clip::opengl).flags ==
          (status::empty_body | status::stayed_uniform));
    auto broken = camera;
    broken.forward = vec3(0.0);
    CHECK(any(lispsm<double>(broken, light, body_of(camera), clip::opengl).flags,
              status::invalid_input));
    const mat4 m =
        directional_light_matrix(light, box3<double>{vec3(-9), vec3(9)}, clip::d3d).matrix;
    const auto kept = lispsm_warp<double>(camera, light, m, none, clip::d3d);
    CHECK(kept.matrix == m);
    CHECK(kept.warp == mat4(1.0));
}

TEMPLATE_TEST_CASE("any numbers at all give a finite result", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        using camera_test::any_number;
        using camera_test::any_numbers;
        frustum<T> camera{any_numbers<T>(), any_numbers<T>(), any_numbers<T>(), any_numbers<T>(),
                          view_volume<T>{any_number<T>(), any_number<T>(), any_number<T>(),
                                         any_number<T>(), any_number<T>(), any_number<T>(),
                                         coin()}};
        if (coin()) {
            camera = any_camera<T>(1e6);
        }
        light<T> source = sun(any_numbers<T>());
        source.direction = any_numbers<T>();
        source.position = any_numbers<T>();
        source.kind =
            coin() ? light_kind::directional : (coin() ? light_kind::spot : light_kind::point);
        std::vector<glm::vec<3, T>> body;
        const int count = *rc::gen::inRange(0, 9);
        const bool wild = coin();
        for (int i = 0; i < count; ++i) {
            body.push_back(wild ? any_numbers<T>() : camera_test::any_direction<T>(1e-3, 1e3));
        }
        lispsm_options<T> options;
        options.strength = any_number<T>();
        options.margin = any_number<T>();
        options.visible_far = any_number<T>();
        options.casters = body;
        glm::mat<4, 4, T> m(T(1));
        for (glm::length_t c = 0; c < 4; ++c) {
            for (glm::length_t r = 0; r < 4; ++r) {
                m[c][r] = coin() ? m[c][r] : any_number<T>();
            }
        }
        const clip_space clip = camera_test::any_convention();
        const auto alone = lispsm<T>(camera, source, body, clip, options);
        RC_ASSERT(finite(alone));
        const auto on_top = lispsm_warp<T>(camera, source, m, body, clip, options);
        // the light's matrix is handed back as it came where it cannot be used
        RC_ASSERT(finite(on_top) ||
                  (any(on_top.flags, status::invalid_input) && same_bits(on_top.matrix, m)));
    }));
}

// --- lights with a position ----------------------------------------------------------------------

TEST_CASE("J14: a tilted spot light with q < 1 bends the other way and wins") {
    // eye 2 above the ground, the lamp 3 above it and tilted by 30 degrees away from the eye
    const auto camera = camera_of<double>(70 * degree, 1.5, 1.0, 50.0);
    const vec3 lamp(0.0, 1.0, 0.0);
    const vec3 axis(0.0, -std::cos(30 * degree), -std::sin(30 * degree));
    const std::vector<vec3> body = {vec3(-1, -2, -4), vec3(1, -2, -4), vec3(1, -2, -12),
                                    vec3(-1, -2, -12)};
    const auto light = spot_light(lamp, lamp + axis, 120 * degree);
    const auto warped = lispsm<double>(camera, light, body, clip::opengl);
    lispsm_options<double> off;
    off.strength = 0.0;
    const auto uniform = lispsm<double>(camera, light, body, clip::opengl, off);
    CHECK_FALSE(any(warped.flags, status::stayed_uniform));
    CHECK(warped.rho < 0.0);
    const auto error = [&](const lispsm_result<double>& r, double z) {
        const double step = 1e-6;
        const vec3 moved =
            ndc(r.matrix, vec3(0, -2, z - step)) - ndc(r.matrix, vec3(0, -2, z + step));
        return 2.0 * step / (glm::length(vec2(moved)) * -z);
    };
    double largest[2] = {0.0, 0.0};
    for (double z = -4.0; z >= -12.0; z -= 0.25) {
        CHECK((warped.matrix * vec4(0, -2, z, 1)).w > 0.0);
        largest[0] = std::max(largest[0], error(warped, z));
        largest[1] = std::max(largest[1], error(uniform, z));
    }
    CHECK(largest[0] <= largest[1]);
}

TEST_CASE("a distant spot light is sunlight") {
    const auto camera = camera_of<double>(60 * degree, 1.5, 1.0, 100.0);
    const auto body = body_of(camera);
    const vec3 l = glm::normalize(vec3(0.3, -1, 0.2));
    const vec3 far_away = vec3(0, 0, -50) - 1e7 * l;
    const auto spot =
        lispsm<double>(camera, spot_light(far_away, vec3(0, 0, -50), 1e-4), body, clip::opengl);
    const auto sunlight = lispsm<double>(camera, sun(l), body, clip::opengl);
    // the receiver line is that between the body's ends instead of one across the light: nearly
    // the same strength, and the same map once the strength is
    CHECK(spot.rho == Approx(sunlight.rho).epsilon(0.1));
    lispsm_options<double> equal;
    equal.strength = sunlight.rho / spot.rho;
    const auto adjusted = lispsm<double>(camera, spot_light(far_away, vec3(0, 0, -50), 1e-4), body,
                                         clip::opengl, equal);
    for (const vec3& p : body) {
        CHECK(glm::length(vec2(ndc(adjusted.matrix, p)) - vec2(ndc(sunlight.matrix, p))) <= 1e-4);
    }
}

TEMPLATE_TEST_CASE("peers 11, 15, J24: lights among and behind the body", "", float, double) {
    using T = TestType;
    using v3 = glm::vec<3, T>;
    const auto camera = camera_of<T>(60 * degree, 1.0, 1.0, 100.0);
    const auto body = body_of(camera);
    // inside the body, on a vertex of it, and with the body on both sides of the light's plane
    for (const v3& position : {v3(T(0), T(0), T(-50)), body[4], v3(T(0), T(0.5), T(-20))}) {
        for (const bool spot : {true, false}) {
            const auto light = spot ? spot_light(position, position + v3(T(0), T(-1), T(0)), T(1))
                                    : point_light(position);
            const auto r = lispsm<T>(camera, light, body, clip::opengl);
            CHECK(any(r.flags, status::light_inside_body));
            CHECK(any(r.flags, status::stayed_uniform));
            CHECK(r.rho == T(0));
            CHECK(finite(r));
        }
    }
    // in view, but with a plane that separates it from what it shines on
    const std::vector<v3> beyond = {v3(T(-5), T(-5), T(-60)), v3(T(5), T(-5), T(-60)),
                                    v3(T(0), T(5), T(-90))};
    const auto r = lispsm<T>(camera, point_light(v3(T(0), T(0), T(-40))), beyond, clip::opengl);
    CHECK(r.flags == (status::light_in_view | status::stayed_uniform));
    CHECK(lispsm<T>(camera, point_light(v3(T(0))), body, clip::opengl).rho == T(0)); // at the eye
}

TEST_CASE("any spot or point light that has a plane covers its body with w > 0") {
    REQUIRE(rc::check([] {
        const auto camera = any_camera<double>(1e3);
        const auto body = any_body(camera);
        const vec3 position = vec3(camera.eye) + camera_test::any_direction<double>(0.1, 1e4);
        const vec3 target = vec3(camera.eye) + body[0];
        const auto light = coin() ? point_light(position) : spot_light(position, target, 2.0);
        const auto r = lispsm<double>(camera, light, body, clip::opengl);
        RC_ASSERT(finite(r));
        if (any(r.flags, status::light_inside_body)) {
            return;
        }
        for (const vec3& p : body) {
            const vec4 c = r.matrix * vec4(p, 1.0);
            RC_ASSERT(c.w > 0.0);
            // rounding grows with the ratio of w at the two ends
            RC_ASSERT(std::abs(c.x) <= c.w * (1.0 + 1e-6));
            RC_ASSERT(std::abs(c.y) <= c.w * (1.0 + 1e-6));
        }
    }));
}

// --- accuracy ------------------------------------------------------------------------------------

TEMPLATE_TEST_CASE("63 configurations: at most 1e-2 texel of 2048 against 100 digits", "", float,
                   double) {
    using T = TestType;
    double worst = 0.0;
    for (const auto& c : lispsm_test::configurations()) {
        const auto s = lispsm_test::make_scene<T>(c, 1);
        const lispsm_test::oracle truth(s.camera, s.direction,
                                        std::span<const glm::vec<3, T>>(s.body));
        const auto r = lispsm<T>(s.camera, sun(s.direction), s.body, clip::opengl);
        const double error = lispsm_test::texel_error(r.matrix, truth, s, 2048);
        CAPTURE(c.gamma, c.ratio, c.distance);
        CHECK(error <= 1e-2);
        CHECK(camera_test::as_double(abs(real(r.rho) - truth.rho())) <=
              4.0 * camera_test::roundoff<T>() * (1.0 + double(r.rho)) + 1e-12);
        worst = std::max(worst, error);
    }
    // the bound of the documentation for double: rounding of about 1e4 operations' worth of 2^-53
    CHECK((sizeof(T) == 4 || worst <= 1e-9));
}
