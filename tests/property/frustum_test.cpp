// Properties of warpshadow/frustum.hpp.
//
// u is the unit roundoff of T. Axes that are stored as T are orthonormal to 4u (float: each of
// three products has two factors off by u, and |a| <= 1 makes that 2 sqrt(3) u; double: a few u of
// arithmetic more, 16u).
#include "camera.hpp"

#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>

#include <catch2/catch.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace warpshadow;
using namespace camera_test;

namespace {

template <typename T> constexpr bool is_float = std::numeric_limits<T>::digits == 24;
template <typename T> constexpr T infinity = std::numeric_limits<T>::infinity();

/// Largest error of a dot product of two axes, in u.
template <typename T> constexpr double axis_error = is_float<T> ? 4.0 : 16.0;

template <typename T>
bool orthonormal(const glm::vec<3, T>& x, const glm::vec<3, T>& y, const glm::vec<3, T>& z,
                 double bound) {
    const real3 axes[] = {exact(x), exact(y), exact(z)};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const real expected = i == j ? 1 : 0;
            if (as_double(abs(dot(axes[i], axes[j]) - expected)) > bound) {
                return false;
            }
        }
    }
    return true;
}

template <typename T> double largest_difference(const glm::vec<3, T>& a, const real3& b) {
    const real3 d = minus(exact(a), b);
    return as_double(std::max({real(abs(d[0])), real(abs(d[1])), real(abs(d[2]))}));
}

template <typename T> view_volume<T> ordinary_volume() {
    return perspective_volume(T(1), T(1.5), T(0.25), T(1000));
}

template <typename T> frustum<T> any_frustum(bool orthographic, double max_ratio, double offset) {
    const glm::vec<3, T> eye = any_direction<T>(offset * 0.5, offset);
    const glm::vec<3, T> forward = any_direction<T>(1e-3, 1e3);
    const glm::vec<3, T> up = any_direction<T>(1e-3, 1e3);
    const frustum_result<T> made =
        make_frustum(eye, forward, up, any_volume<T>(orthographic, max_ratio));
    RC_ASSERT(made.flags == status::ok);
    return made.value;
}

/// The corner `i` of the list, from the parameters as T holds them.
template <typename T> real3 exact_corner(const frustum<T>& camera, std::size_t i) {
    const view_volume<T>& v = camera.volume;
    const real x = i % 4 == 1 || i % 4 == 2 ? v.right : v.left;
    const real y = i % 4 >= 2 ? v.top : v.bottom;
    const real d = i < 4 ? v.near_distance : v.far_distance;
    const real3 across = sum(times(x, exact(camera.right)), times(y, exact(camera.up)));
    return v.orthographic ? sum(times(d, exact(camera.forward)), across)
                          : times(d, sum(exact(camera.forward), across));
}

} // namespace

TEMPLATE_TEST_CASE("make_frustum: the axes are those of exact arithmetic", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<3, T> forward = any_direction<T>(1e-20, 1e20);
        glm::vec<3, T> up = any_direction<T>(1e-20, 1e20);
        if (coin()) {
            // nearly parallel, as far as T can be
            up = forward * log_between<T>(0.1, 10.0);
            const double size = static_cast<double>(glm::length(glm::vec<3, double>(up)));
            up += any_direction<T>(1e-9 * size, size);
        }
        const real3 f = unit(exact(forward));
        const real3 side = cross(f, unit(exact(up)));
        const double sine = as_double(length(side));
        RC_PRE(sine > 0x1p-39);
        const frustum_result<T> made =
            make_frustum(glm::vec<3, T>(T(0)), forward, up, ordinary_volume<T>());
        RC_ASSERT(made.flags == status::ok);
        // rounding to T, and the rounding of two unit vectors in double, amplified
        const double u = roundoff<T>();
        const double bound = (is_float<T> ? u : 0.0) + 8.0 * 0x1p-53 / sine;
        const real3 right = unit(side);
        RC_ASSERT(largest_difference(made.value.forward, f) <= (is_float<T> ? 1.001 : 8.0) * u);
        RC_ASSERT(largest_difference(made.value.right, right) <= bound);
        RC_ASSERT(largest_difference(made.value.up, cross(right, f)) <= bound);
        RC_ASSERT(
            orthonormal(made.value.right, made.value.up, made.value.forward, axis_error<T> * u));
        // the other handedness is the mirror image
        const frustum_result<T> left =
            make_frustum(glm::vec<3, T>(T(0)), forward, up, ordinary_volume<T>(), true);
        RC_ASSERT(left.value.right == -made.value.right);
        RC_ASSERT(left.value.up == made.value.up);
    }));
}

TEMPLATE_TEST_CASE("make_frustum: the lengths of forward and up do not matter, to the bit", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<3, T> forward = any_direction<T>(0.5, 1.0);
        const glm::vec<3, T> up = any_direction<T>(0.5, 1.0);
        const T a = std::ldexp(T(1), *rc::gen::inRange(-60, 61));
        const T b = std::ldexp(T(1), *rc::gen::inRange(-60, 61));
        const glm::vec<3, T> eye(T(0));
        const frustum_result<T> one = make_frustum(eye, forward, up, ordinary_volume<T>());
        const frustum_result<T> two = make_frustum(eye, forward * a, up * b, ordinary_volume<T>());
        RC_ASSERT(one.flags == two.flags);
        RC_ASSERT(one.value.right == two.value.right);
        RC_ASSERT(one.value.up == two.value.up);
        RC_ASSERT(one.value.forward == two.value.forward);
    }));
}

TEMPLATE_TEST_CASE("peers 2, 21: an up hint that says nothing is replaced", "", float, double) {
    using T = TestType;
    using vec3 = glm::vec<3, T>;
    const T nan = std::numeric_limits<T>::quiet_NaN();
    REQUIRE(rc::check([nan] {
        vec3 forward = any_direction<T>(1e-3, 1e3);
        if (coin()) {
            const vec3 axes[] = {vec3(T(1), T(0), T(0)), vec3(T(0), T(1), T(0)),
                                 vec3(T(0), T(0), T(1))};
            const std::size_t axis =
                *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(0, 3));
            forward = axes[axis] * (coin() ? T(1) : T(-1));
        }
        const vec3 hints[] = {forward, forward * T(-8), vec3(T(0)), vec3(nan, T(1), T(0)),
                              vec3(T(0), infinity<T>, T(0))};
        const light_frame_result<T> expected = light_frame(forward);
        for (const vec3& hint : hints) {
            const frustum_result<T> made =
                make_frustum(vec3(T(0)), forward, hint, ordinary_volume<T>());
            RC_ASSERT(made.flags == status::up_replaced);
            RC_ASSERT(made.value.right == expected.right);
            RC_ASSERT(made.value.up == expected.up);
            RC_ASSERT(made.value.forward == expected.forward);
            RC_ASSERT(orthonormal(made.value.right, made.value.up, made.value.forward,
                                  axis_error<T> * roundoff<T>()));
        }
    }));
}

TEMPLATE_TEST_CASE("peers 3, 8: an endless orthographic volume is a frustum like any other", "",
                   float, double) {
    using T = TestType;
    using vec3 = glm::vec<3, T>;
    const view_volume<T> v{T(-1), T(1), T(-2), T(2), T(-5), infinity<T>, true};
    const frustum_result<T> made =
        make_frustum(vec3(T(0)), vec3(T(0), T(0), T(-1)), vec3(T(0), T(1), T(0)), v);
    CHECK(made.flags == status::ok);
    const auto corners = frustum_corners(made.value);
    CHECK((corners[0] == glm::vec<4, T>(T(-1), T(-2), T(5), T(1))));
    CHECK((corners[2] == glm::vec<4, T>(T(1), T(2), T(5), T(1))));
    for (std::size_t i = 4; i < 8; ++i) {
        CHECK((corners[i] == glm::vec<4, T>(T(0), T(0), T(-1), T(0))));
    }
}

TEMPLATE_TEST_CASE("make_frustum and view_matrix agree with GLM's lookAt", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<3, T> eye = any_direction<T>(1.0, 100.0);
        const glm::vec<3, T> forward = any_direction<T>(1.0, 10.0);
        const glm::vec<3, T> up = any_direction<T>(1.0, 10.0);
        const glm::dvec3 f = glm::normalize(glm::dvec3(forward));
        const double sine = glm::length(glm::cross(f, glm::normalize(glm::dvec3(up))));
        RC_PRE(sine > 1e-3);
        const glm::dvec3 target = glm::dvec3(eye) + f;
        for (const bool left_handed : {false, true}) {
            clip_space clip;
            clip.left_handed = left_handed;
            const frustum<T> camera =
                make_frustum(eye, forward, up, ordinary_volume<T>(), left_handed).value;
            const glm::mat<4, 4, T> view = view_matrix(camera, clip);
            const glm::dmat4 expected =
                left_handed ? glm::lookAtLH(glm::dvec3(eye), target, glm::dvec3(up))
                            : glm::lookAtRH(glm::dvec3(eye), target, glm::dvec3(up));
            // target - eye costs GLM 2^-53 * 100 in the direction, amplified by 1 / sine
            const double direction = 2.0 * roundoff<T>() + 0x1p-44 / sine;
            for (glm::length_t row = 0; row < 3; ++row) {
                for (glm::length_t column = 0; column < 4; ++column) {
                    const double bound = direction * (column == 3 ? 400.0 : 1.0);
                    RC_ASSERT(std::abs(static_cast<double>(view[column][row]) -
                                       expected[column][row]) <= bound);
                }
            }
        }
    }));
}

TEMPLATE_TEST_CASE("corners are within 2 ulp of the exact ones of the frustum", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const frustum<T> camera = any_frustum<T>(coin(), 1e7, 1e6);
        const std::array<glm::vec<4, T>, 8> corners = frustum_corners(camera);
        for (std::size_t i = 0; i < 8; ++i) {
            const real3 expected = exact_corner(camera, i);
            RC_ASSERT(corners[i].w == T(1));
            RC_ASSERT(largest_difference(glm::vec<3, T>(corners[i]), expected) <=
                      4.0 * roundoff<T>() * as_double(length(expected)));
        }
    }));
}

TEMPLATE_TEST_CASE("B1: direct corners keep their accuracy at far/near 1e7, 1e6 from the origin",
                   "", float, double) {
    using T = TestType;
    // against the exact corners of the camera as it was given, eye, forward and up included:
    // D (f + x r + y u), each axis off by u and the sum rounded: error / |corner| is at most
    // u (1 + |x| + |y|) / sqrt(1 + x^2 + y^2) + u <= (sqrt(3) + 1) u per component; double adds
    // 4u of arithmetic and turns its axes by 8u / sine
    for (const double ratio : {1e2, 1e4, 1e6, 1e7}) {
        for (const double offset : {1.0, 1e3, 1e6}) {
            REQUIRE(rc::check([ratio, offset] {
                const glm::vec<3, T> eye = any_direction<T>(0.5 * offset, offset);
                const glm::vec<3, T> forward = any_direction<T>(1.0, 2.0);
                const glm::vec<3, T> up = any_direction<T>(1.0, 2.0);
                const real3 f = unit(exact(forward));
                const real3 side = cross(f, unit(exact(up)));
                const double sine = as_double(length(side));
                RC_PRE(sine > 1e-3);
                const real3 r = unit(side);
                const real3 upwards = cross(r, f);
                const T n = log_between<T>(0.01, 10.0);
                const view_volume<T> v = perspective_volume(
                    between<T>(0.3, 2.5), between<T>(0.5, 2.5), n, n * static_cast<T>(ratio));
                const auto corners = frustum_corners(make_frustum(eye, forward, up, v).value);
                const double bound = (is_float<T> ? 2.74 : 8.0 + 14.0 / sine) * roundoff<T>();
                RC_ASSERT(bound <= 1e-6); // what the claim is for float
                const std::size_t any =
                    *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(0, 4));
                for (const std::size_t i : {any, 4 + any}) {
                    const real x = i % 4 == 1 || i % 4 == 2 ? v.right : v.left;
                    const real y = i % 4 >= 2 ? v.top : v.bottom;
                    const real d = i < 4 ? v.near_distance : v.far_distance;
                    const real3 expected = times(d, sum(f, sum(times(x, r), times(y, upwards))));
                    RC_ASSERT(largest_difference(glm::vec<3, T>(corners[i]), expected) <=
                              bound * as_double(length(expected)));
                }
            }));
        }
    }
}

TEMPLATE_TEST_CASE("peers 3, 7, 8: corners lie on their planes and inside the others", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        frustum<T> camera = any_frustum<T>(coin(), 1e6, 1e4);
        if (coin()) {
            camera.volume.far_distance = infinity<T>;
        }
        const auto corners = frustum_corners(camera);
        const auto planes = frustum_planes(camera);
        // corners off by 4 sqrt(3) u, planes by u (float) or 8u (double) in each component, and
        // axes orthonormal to axis_error: D (1 + 2|l| + l^2 + |y| (1 + |l|)) / sqrt(1 + l^2) is
        // at most 4.5 |corner|
        const double k =
            7.0 + (is_float<T> ? 1.75 : 14.0) + 4.5 * axis_error<T> + (is_float<T> ? 1.0 : 8.0);
        for (std::size_t i = 0; i < 8; ++i) {
            const real3 p = exact(glm::vec<3, T>(corners[i]));
            const double scale = k * roundoff<T>() *
                                 (as_double(length(p)) +
                                  (camera.volume.orthographic
                                       ? std::abs(static_cast<double>(camera.volume.near_distance))
                                       : 0.0));
            const std::size_t x = i % 4 == 1 || i % 4 == 2 ? 1 : 0;
            const std::size_t y = i % 4 >= 2 ? 3 : 2;
            const std::size_t z = i < 4 ? 4 : 5;
            for (std::size_t j = 0; j < 6; ++j) {
                const real value = dot(exact(glm::vec<3, T>(planes[j])), p) +
                                   real(planes[j].w) * real(corners[i].w);
                RC_ASSERT(as_double(value) >= -scale);
                const bool endless = std::isinf(camera.volume.far_distance) && j == 5;
                if ((j == x || j == y || j == z) && !endless) {
                    RC_ASSERT(as_double(value) <= scale);
                }
                if (endless) {
                    RC_ASSERT((planes[j] == glm::vec<4, T>(T(0), T(0), T(0), T(1))));
                } else {
                    const double normal = as_double(length(exact(glm::vec<3, T>(planes[j]))));
                    RC_ASSERT(std::abs(normal - 1.0) <= 4.0 * axis_error<T> * roundoff<T>());
                }
            }
        }
        // the middle is inside, and far from the sides: nothing has been turned round
        const real3 middle =
            times(real(0.5), sum(exact_corner(camera, 0), exact_corner(camera, 2)));
        for (std::size_t j = 0; j < 4; ++j) {
            RC_ASSERT(dot(exact(glm::vec<3, T>(planes[j])), middle) + real(planes[j].w) > 0);
        }
    }));
}

TEMPLATE_TEST_CASE("peers 3: directions of an infinite frustum are the limit of far corners", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        frustum<T> camera = any_frustum<T>(coin(), 100.0, 1e3);
        frustum<T> endless = camera;
        endless.volume.far_distance = infinity<T>;
        camera.volume.far_distance = static_cast<T>(0x1p60);
        const auto corners = frustum_corners(camera);
        const auto directions = frustum_corners(endless);
        for (std::size_t i = 0; i < 8; ++i) {
            RC_ASSERT(directions[i].w == (i < 4 ? T(1) : T(0)));
            if (i < 4) {
                RC_ASSERT(corners[i] == directions[i]);
                continue;
            }
            // an orthographic corner is up to 1e4 off its direction at distance 2^60
            const real3 a = times(real(0x1p-60), exact(glm::vec<3, T>(corners[i])));
            const real3 b = exact(glm::vec<3, T>(directions[i]));
            RC_ASSERT(as_double(length(minus(a, b))) <=
                      (16.0 * roundoff<T>() + 0x1p-45) * as_double(length(b)));
        }
    }));
}

TEMPLATE_TEST_CASE("corners project to the corners of the NDC cube in every convention", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const frustum<T> camera = any_frustum<T>(coin(), 1e5, 1e5);
        const view_volume<T>& v = camera.volume;
        const auto corners = frustum_corners(camera);
        const double u = roundoff<T>();
        for (const clip_space clip : some_conventions(2)) {
            const glm::mat<4, 4, T> view = view_matrix(camera, clip, camera.eye);
            const glm::mat<4, 4, T> projection = projection_matrix(v, clip);
            for (std::size_t i = 0; i < 8; ++i) {
                const real3 c = exact(glm::vec<3, T>(corners[i]));
                const real4 in_view = multiply(view, real4{c[0], c[1], c[2], real(1)});
                const real4 q = multiply(projection, in_view);
                const real4 terms = magnitudes(projection, in_view);
                const double w = as_double(q[3]);
                const double reach = as_double(length(c));
                // view coordinates: the corner is off by 4u in each component, the axes are
                // orthonormal to axis_error; then the entries of the projection, 4u
                const double moved = (7.0 + 3.0 * axis_error<T>)*u * reach;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const bool upper = axis == 0   ? i % 4 == 1 || i % 4 == 2
                                       : axis == 1 ? i % 4 >= 2
                                                   : i >= 4;
                    double expected = upper ? 1.0 : -1.0;
                    double slope = 0.0; // of NDC by view coordinate, and by w
                    if (axis == 0) {
                        slope = std::abs(static_cast<double>(projection[0][0]));
                    } else if (axis == 1) {
                        slope = std::abs(static_cast<double>(projection[1][1]));
                        expected = clip.y_down ? -expected : expected;
                    } else {
                        slope = std::abs(static_cast<double>(projection[2][2]));
                        expected = upper ? far_depth<double>(clip) : near_depth<double>(clip);
                        if (upper && clip.infinite_far && !v.orthographic) {
                            // the far corners are short of infinity by n / f
                            expected -= (far_depth<double>(clip) - near_depth<double>(clip)) *
                                        static_cast<double>(v.near_distance) /
                                        static_cast<double>(v.far_distance);
                        }
                    }
                    const double shift =
                        v.orthographic ? 0.0
                                       : std::abs(as_double(q[axis] / q[3])) +
                                             std::abs(static_cast<double>(
                                                 projection[2][static_cast<glm::length_t>(axis)]));
                    const double bound = moved * (slope + shift) / w +
                                         4.0 * u * as_double(terms[axis]) / w + 2.0 * u;
                    RC_ASSERT(std::abs(as_double(q[axis] / q[3]) - expected) <= bound);
                }
            }
        }
    }));
}

TEMPLATE_TEST_CASE("peers 40: a world position has one map position in every convention", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const frustum<T> camera = any_frustum<T>(coin(), 1e4, 1e6);
        const view_volume<T>& v = camera.volume;
        const auto corners = frustum_corners(camera);
        glm::vec<3, T> p(T(0));
        for (const auto& corner : corners) {
            p += glm::vec<3, T>(corner) * (T(0.125) * between<T>(0.0, 1.0)); // inside, if convex:
        }
        const real3 e = exact(p);
        const real d = dot(exact(camera.forward), e);
        RC_PRE(d >= real(v.near_distance) && d <= real(v.far_distance));
        const real w = v.orthographic ? real(1) : d;
        const real x = dot(exact(camera.right), e) / w;
        const real y = dot(exact(camera.up), e) / w;
        const real map_x = (x - v.left) / (real(v.right) - v.left);
        const real map_y = (y - v.bottom) / (real(v.top) - v.bottom);
        const double u = roundoff<T>();
        // view: 3 products and 2 sums, 4u |p|, each way across and along; projection: entry,
        // product, sum, quotient, map: 10u of each term
        const double reach = as_double(length(e) / abs(w));
        const auto bound = [&](const real& slope, T lo, T hi) {
            const double width = std::abs(static_cast<double>(hi) - static_cast<double>(lo));
            const double s = std::abs(as_double(slope));
            const double middle = std::abs(static_cast<double>(hi) + static_cast<double>(lo));
            return (4.0 * u * reach * (1.0 + s + middle) + 5.0 * u * (2.0 * s + middle)) / width +
                   2.0 * u;
        };
        for (const clip_space clip : all_conventions()) {
            const glm::vec<4, T> q =
                projection_matrix(v, clip) *
                (view_matrix(camera, clip, camera.eye) * glm::vec<4, T>(p, T(1)));
            const glm::vec<2, T> map = map_from_ndc(glm::vec<2, T>(q) / q.w, clip);
            RC_ASSERT(std::abs(as_double(map.x - map_x)) <= bound(x, v.left, v.right));
            RC_ASSERT(std::abs(as_double(map.y - map_y)) <= bound(y, v.bottom, v.top));
        }
    }));
}

TEMPLATE_TEST_CASE("powers of two scale corners, planes and view matrix to the bit", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<3, T> eye = any_direction<T>(1.0, 1e4);
        const glm::vec<3, T> forward = any_direction<T>(0.1, 10.0);
        const glm::vec<3, T> up = any_direction<T>(0.1, 10.0);
        const view_volume<T> v = any_volume<T>(coin(), 1e5);
        const T s = std::ldexp(T(1), *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(-20, 21)));
        view_volume<T> scaled = v;
        scaled.near_distance *= s;
        scaled.far_distance *= s;
        if (v.orthographic) {
            scaled.left *= s;
            scaled.right *= s;
            scaled.bottom *= s;
            scaled.top *= s;
        }
        const frustum<T> a = make_frustum(eye, forward, up, v).value;
        const frustum<T> b = make_frustum(eye * s, forward, up, scaled).value;
        const auto corners_a = frustum_corners(a);
        const auto corners_b = frustum_corners(b);
        for (std::size_t i = 0; i < 8; ++i) {
            RC_ASSERT((glm::vec<3, T>(corners_a[i]) * s == glm::vec<3, T>(corners_b[i])));
        }
        const auto planes_a = frustum_planes(a);
        const auto planes_b = frustum_planes(b);
        for (std::size_t i = 0; i < 6; ++i) {
            RC_ASSERT((glm::vec<3, T>(planes_a[i]) == glm::vec<3, T>(planes_b[i])));
            RC_ASSERT(planes_a[i].w * s == planes_b[i].w);
        }
        glm::mat<4, 4, T> view = view_matrix(b, clip::opengl);
        view[3] = glm::vec<4, T>(glm::vec<3, T>(view[3]) / s, T(1));
        RC_ASSERT(view == view_matrix(a, clip::opengl));
        // an engine's two matrices scale as well
        const auto c = frustum_from_matrices(view_matrix(a, clip::opengl),
                                             projection_matrix(v, clip::opengl), clip::opengl);
        const auto d = frustum_from_matrices(view_matrix(b, clip::opengl),
                                             projection_matrix(scaled, clip::opengl), clip::opengl);
        RC_ASSERT(c.flags == d.flags);
        RC_ASSERT(c.value.eye * s == d.value.eye);
        RC_ASSERT(c.value.right == d.value.right);
        RC_ASSERT(c.value.volume.near_distance * s == d.value.volume.near_distance);
        RC_ASSERT(c.value.volume.far_distance * s == d.value.volume.far_distance);
    }));
}

TEMPLATE_TEST_CASE("frustum_from_matrices finds the camera again in every convention", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const bool orthographic = coin();
        const frustum<T> camera = any_frustum<T>(orthographic, 1e3, 1e3);
        const view_volume<T>& v = camera.volume;
        const double u = roundoff<T>();
        for (const clip_space clip : some_conventions(4)) {
            const auto found =
                frustum_from_matrices(view_matrix(camera, clip), projection_matrix(v, clip), clip);
            RC_ASSERT(found.flags == status::ok);
            const frustum<T>& c = found.value;
            // the axes are made unit again: they were off by axis_error; the eye solves
            // R eye = -t with t rounded to u |eye| and R orthonormal to axis_error
            const double turned = (2.0 + axis_error<T>)*u;
            RC_ASSERT(largest_difference(c.right, exact(camera.right)) <= turned);
            RC_ASSERT(largest_difference(c.up, exact(camera.up)) <= turned);
            RC_ASSERT(largest_difference(c.forward, exact(camera.forward)) <= turned);
            RC_ASSERT(largest_difference(c.eye, exact(camera.eye)) <=
                      (8.0 + axis_error<T>)*u * as_double(length(exact(camera.eye))));
            // bounds and distances: 12u as from the matrix alone, and the lengths of the rows
            const double k = (12.0 + 2.0 * axis_error<T>)*u;
            const double x = static_cast<double>(std::max(std::abs(v.left), std::abs(v.right)));
            const double y = static_cast<double>(std::max(std::abs(v.bottom), std::abs(v.top)));
            RC_ASSERT(std::abs(static_cast<double>(c.volume.left - v.left)) <= k * x);
            RC_ASSERT(std::abs(static_cast<double>(c.volume.right - v.right)) <= k * x);
            RC_ASSERT(std::abs(static_cast<double>(c.volume.bottom - v.bottom)) <= k * y);
            RC_ASSERT(std::abs(static_cast<double>(c.volume.top - v.top)) <= k * y);
            if (!orthographic) {
                RC_ASSERT(std::abs(static_cast<double>(c.volume.near_distance - v.near_distance)) <=
                          k * static_cast<double>(v.near_distance));
                RC_ASSERT(std::isinf(c.volume.far_distance) == clip.infinite_far);
            }
        }
    }));
}

TEMPLATE_TEST_CASE("a scaled or mirrored view space gives the same frustum", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const bool orthographic = coin();
        const frustum<T> camera = any_frustum<T>(orthographic, 1e3, 1e3);
        const clip_space clip = any_convention();
        const T s = T(4);
        view_volume<T> scaled = camera.volume;
        scaled.near_distance *= s;
        scaled.far_distance *= s;
        if (orthographic) {
            scaled.left *= s;
            scaled.right *= s;
            scaled.bottom *= s;
            scaled.top *= s;
        }
        const glm::mat<4, 4, T> view = view_matrix(camera, clip);
        glm::mat<4, 4, T> view_scaled = view * s;
        for (glm::length_t column = 0; column < 4; ++column) {
            view_scaled[column][3] = view[column][3];
        }
        const auto a = frustum_from_matrices(view, projection_matrix(camera.volume, clip), clip);
        const auto b = frustum_from_matrices(view_scaled, projection_matrix(scaled, clip), clip);
        RC_ASSERT(a.flags == b.flags);
        RC_ASSERT(a.value.eye == b.value.eye);
        RC_ASSERT(a.value.up == b.value.up);
        const auto corners_a = frustum_corners(a.value);
        const auto corners_b = frustum_corners(b.value);
        RC_ASSERT(corners_a == corners_b);

        // x mirrored in view and in projection: the same corners, with left and right exchanged
        glm::mat<4, 4, T> mirrored = view;
        for (glm::length_t column = 0; column < 4; ++column) {
            mirrored[column][0] = -view[column][0];
        }
        view_volume<T> other = camera.volume;
        other.left = -camera.volume.right;
        other.right = -camera.volume.left;
        const auto c = frustum_from_matrices(mirrored, projection_matrix(other, clip), clip);
        RC_ASSERT(c.flags == a.flags);
        RC_ASSERT(c.value.right == -a.value.right);
        const auto corners_c = frustum_corners(c.value);
        RC_ASSERT(corners_c[0] == corners_a[1]);
        RC_ASSERT(corners_c[7] == corners_a[6]);
    }));
}

TEMPLATE_TEST_CASE("J12: standard and reversed depth have the same corners to 4 ulp", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        // matrices in double, as the doc comment asks for; far / near keeps double's own loss,
        // 8u far / near, below the 4 ulp of T
        const double ratio = is_float<T> ? 1e6 : 1.5;
        const frustum<double> camera = any_frustum<double>(false, ratio, 10.0);
        const clip_space zo{depth_range::zero_to_one};
        const glm::dmat4 view = view_matrix(camera, zo);
        const auto a = frustum_from_matrices(view, projection_matrix(camera.volume, zo), zo).value;
        const auto b = frustum_from_matrices(view, projection_matrix(camera.volume, zo.reversed()),
                                             zo.reversed())
                           .value;
        const auto corners_a = frustum_corners(a);
        const auto corners_b = frustum_corners(b);
        const double loss = 16.0 * roundoff<double>() * ratio;
        for (std::size_t i = 0; i < 8; ++i) {
            const glm::dvec3 p(corners_a[i]);
            const glm::dvec3 q(corners_b[i]);
            RC_ASSERT(glm::length(p - q) <= (8.0 * roundoff<T>() + loss) * glm::length(p));
        }
    }));
}

TEMPLATE_TEST_CASE("frusta are total", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<3, T> eye = any_numbers<T>();
        const glm::vec<3, T> forward = any_numbers<T>();
        const glm::vec<3, T> up = any_numbers<T>();
        const view_volume<T> v{any_number<T>(), any_number<T>(), any_number<T>(), any_number<T>(),
                               any_number<T>(), any_number<T>(), coin()};
        const frustum_result<T> made = make_frustum(eye, forward, up, v, coin());
        const frustum<T>& c = made.value;
        RC_ASSERT(finite(c.eye));
        RC_ASSERT(usable(c.volume));
        RC_ASSERT(orthonormal(c.right, c.up, c.forward, axis_error<T> * roundoff<T>()));
        if (!finite(eye) || !finite(forward) || forward == glm::vec<3, T>(T(0))) {
            RC_ASSERT(any(made.flags, status::invalid_input));
        }
        if (!finite(up) || up == glm::vec<3, T>(T(0))) {
            RC_ASSERT(any(made.flags, status::up_replaced));
        }
        for (const auto& corner : frustum_corners(c)) {
            RC_ASSERT(finite(corner));
            RC_ASSERT((corner.w == T(0) || corner.w == T(1)));
        }
        for (const auto& plane : frustum_planes(c)) {
            RC_ASSERT(finite(plane));
        }
        const clip_space clip = any_convention();
        RC_ASSERT(finite(view_matrix(c, clip)));
        RC_ASSERT(finite(view_matrix(c, clip, any_numbers<T>())));
        // frusta that nobody checked
        const frustum<T> raw{eye, forward, up, any_numbers<T>(), v};
        for (const auto& corner : frustum_corners(raw)) {
            RC_ASSERT(finite(corner));
        }
        for (const auto& plane : frustum_planes(raw)) {
            RC_ASSERT(finite(plane));
        }
        RC_ASSERT(finite(view_matrix(raw, clip)));
    }));
}

TEMPLATE_TEST_CASE("frustum_from_matrices is total", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const clip_space clip = any_convention();
        const frustum<T> camera = any_frustum<T>(coin(), 1e3, 1e3);
        glm::mat<4, 4, T> view = view_matrix(camera, clip);
        glm::mat<4, 4, T> projection = projection_matrix(camera.volume, clip);
        for (int k = 0; k < 2; ++k) {
            glm::mat<4, 4, T>& m = coin() ? view : projection;
            const auto column = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 4));
            const auto row = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 4));
            m[column][row] = any_number<T>();
        }
        const frustum_result<T> found = frustum_from_matrices(view, projection, clip);
        const frustum<T>& c = found.value;
        RC_ASSERT(finite(c.eye));
        RC_ASSERT(usable(c.volume));
        // rows perpendicular to 2^-10 are accepted
        RC_ASSERT(orthonormal(c.right, c.up, c.forward, 0x1p-9));
        if (!finite(view) || !finite(projection)) {
            RC_ASSERT(any(found.flags, status::invalid_input));
        }
    }));
}
