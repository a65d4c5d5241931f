// Properties of warpshadow/light.hpp.
//
// u is the unit roundoff of T, u_d that of double. The frame is computed in double to 4 u_d in each
// component and rounded to T.
#include "camera.hpp"

#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>

#include <catch2/catch.hpp>
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
template <typename T> constexpr T nan_of = std::numeric_limits<T>::quiet_NaN();

/// Error of a component of an axis, as the doc comment of light_frame has it.
template <typename T> constexpr double axis_error = is_float<T> ? 1.001 * 0x1p-24 : 8.0 * 0x1p-53;

struct real_frame {
    real3 right, up, forward;
};

/// The frame by Rodrigues' formula, R = 1 + [v] + [v]^2 / (1 + c), from straight down to f.
real_frame exact_frame(const real3& direction, up_axis vertical) {
    const bool y = vertical == up_axis::y;
    const real3 f = unit(direction);
    const real3 down = y ? real3{real(0), real(-1), real(0)} : real3{real(0), real(0), real(-1)};
    const real3 v = cross(down, f);
    const real c = dot(down, f);
    const auto turned = [&](const real3& a) {
        const real3 once = cross(v, a);
        return sum(a, sum(once, times(1 / (1 + c), cross(v, once))));
    };
    return real_frame{
        turned(real3{real(1), real(0), real(0)}),
        turned(y ? real3{real(0), real(0), real(-1)} : real3{real(0), real(1), real(0)}), f};
}

template <typename T> double difference(const glm::vec<3, T>& a, const real3& b) {
    const real3 d = minus(exact(a), b);
    return as_double(std::max({real(abs(d[0])), real(abs(d[1])), real(abs(d[2]))}));
}

up_axis any_vertical() {
    return coin() ? up_axis::y : up_axis::z;
}

/// A box of which any extent may be small.
template <typename T> box3<T> any_box(double offset) {
    const glm::vec<3, T> lo = any_direction<T>(0.5 * offset, offset);
    box3<T> box{lo, lo};
    for (glm::length_t i = 0; i < 3; ++i) {
        box.hi[i] += log_between<T>(1e-2, 1e2);
    }
    return box;
}

template <typename T> real3 box_corner(const box3<T>& box, int i) {
    return real3{real((i & 1) != 0 ? box.hi.x : box.lo.x), real((i & 2) != 0 ? box.hi.y : box.lo.y),
                 real((i & 4) != 0 ? box.hi.z : box.lo.z)};
}

template <typename T> real4 relative(const real3& p, const glm::vec<3, T>& origin) {
    const real3 q = minus(p, exact(origin));
    return real4{q[0], q[1], q[2], real(1)};
}

} // namespace

TEMPLATE_TEST_CASE("light_frame is the frame carried along a great circle, for every direction", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        glm::vec<3, T> direction = any_direction<T>(1e-20, 1e20);
        const up_axis vertical = any_vertical();
        if (coin()) {
            // near the jump
            const glm::length_t axis = vertical == up_axis::y ? 1 : 2;
            const T s = log_between<T>(1e-12, 1.0);
            direction *= s;
            direction[axis] = std::abs(direction[axis]) / s;
        }
        const real3 f = unit(exact(direction));
        const real up_part = vertical == up_axis::y ? f[1] : f[2];
        RC_PRE(up_part < 1 - real(1e-60));
        const real_frame expected = exact_frame(exact(direction), vertical);
        const light_frame_result<T> found = light_frame(direction, vertical);
        RC_ASSERT(found.flags == status::ok);
        RC_ASSERT(difference(found.forward, expected.forward) <= axis_error<T>);
        RC_ASSERT(difference(found.right, expected.right) <= axis_error<T>);
        RC_ASSERT(difference(found.up, expected.up) <= axis_error<T>);
    }));
}

TEMPLATE_TEST_CASE("J15: the length of a direction does not matter, to the bit", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<3, T> direction = any_direction<T>(0.5, 1.0);
        const up_axis vertical = any_vertical();
        const T s = std::ldexp(T(1), *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(-66, 67)));
        const light_frame_result<T> one = light_frame(direction, vertical);
        const light_frame_result<T> other = light_frame(direction * s, vertical);
        RC_ASSERT(one.right == other.right);
        RC_ASSERT(one.up == other.up);
        RC_ASSERT(one.forward == other.forward);
    }));
    for (const T length :
         {T(1e-20), T(1e20), std::numeric_limits<T>::denorm_min(), std::numeric_limits<T>::max()}) {
        const light_frame_result<T> found = light_frame(glm::vec<3, T>(T(0), -length, T(0)));
        CHECK(found.flags == status::ok);
        CHECK((found.forward == glm::vec<3, T>(T(0), T(-1), T(0))));
    }
    for (const T bad : {nan_of<T>, infinity<T>, -infinity<T>}) {
        const light_frame_result<T> found = light_frame(glm::vec<3, T>(T(1), bad, T(0)));
        CHECK(found.flags == status::invalid_input);
        CHECK((found.forward == glm::vec<3, T>(T(0), T(-1), T(0))));
        CHECK((found.right == glm::vec<3, T>(T(1), T(0), T(0))));
    }
    CHECK(light_frame(glm::vec<3, T>(T(0))).flags == status::invalid_input);
    CHECK(light_frame(glm::vec<3, T>(T(0), T(-0.0), T(0)), up_axis::z).flags ==
          status::invalid_input);
}

TEMPLATE_TEST_CASE("peers 2: directions along the axes have frames along the axes", "", float,
                   double) {
    using T = TestType;
    using vec3 = glm::vec<3, T>;
    for (const up_axis vertical : {up_axis::y, up_axis::z}) {
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            for (const T sign : {T(-1), T(1)}) {
                vec3 direction(T(0));
                direction[axis] = sign;
                const light_frame_result<T> found = light_frame(direction, vertical);
                CHECK(found.flags == status::ok);
                CHECK((found.forward == direction));
                CHECK((glm::cross(found.right, found.up) == -direction));
                for (const vec3& a : {found.right, found.up}) {
                    CHECK(std::abs(a.x) + std::abs(a.y) + std::abs(a.z) == T(1));
                }
            }
        }
    }
    const light_frame_result<T> noon = light_frame(vec3(T(0), T(-1), T(0)));
    CHECK((noon.right == vec3(T(1), T(0), T(0))));
    CHECK((noon.up == vec3(T(0), T(0), T(-1))));
    const light_frame_result<T> z_up = light_frame(vec3(T(0), T(0), T(-1)), up_axis::z);
    CHECK((z_up.right == vec3(T(1), T(0), T(0))));
    CHECK((z_up.up == vec3(T(0), T(1), T(0))));
}

TEST_CASE("light_frame turns by at most 1 / cos(a / 2) times what the direction does") {
    REQUIRE(rc::check([] {
        using dvec3 = glm::dvec3;
        const up_axis vertical = any_vertical();
        const dvec3 up = vertical == up_axis::y ? dvec3(0, 1, 0) : dvec3(0, 0, 1);
        const dvec3 f = glm::normalize(any_direction<double>(1.0, 1.0));
        const dvec3 side = any_direction<double>(1.0, 1.0);
        const double step = log_between<double>(1e-6, 1e-4);
        const dvec3 g = glm::normalize(f + step * side);
        const double above = 0.5 * (1.0 - std::max(glm::dot(f, up), glm::dot(g, up)));
        RC_PRE(above > 1e-4); // cos^2(a / 2): at least 1.1 degrees from the jump
        const auto a = light_frame(f, vertical);
        const auto b = light_frame(g, vertical);
        const double turned = glm::length(f - g);
        // rotation angle t of R: |R - 1|_F = 2 sqrt(2) sin(t / 2)
        const double frobenius = std::sqrt(glm::dot(a.right - b.right, a.right - b.right) +
                                           glm::dot(a.up - b.up, a.up - b.up) +
                                           glm::dot(a.forward - b.forward, a.forward - b.forward));
        const double angle = 2.0 * std::asin(frobenius / (2.0 * std::sqrt(2.0)));
        // the bound is that of a small step; its own change along the step is below step / above
        RC_ASSERT(angle <= turned / std::sqrt(above) * (1.0 + 2.0 * step / above) + 1e-14);
    }));
}

TEST_CASE("light_frame has its jump at light that travels straight up, and nowhere else") {
    const double e = 1e-9;
    const auto a = light_frame(glm::dvec3(e, 1.0, 0.0));
    const auto b = light_frame(glm::dvec3(-e, 1.0, 0.0));
    const auto c = light_frame(glm::dvec3(0.0, 1.0, e));
    CHECK(glm::length(a.right - c.right) > 1.9); // turned by half a circle
    CHECK(glm::length(a.right - b.right) < 4.0 * e);
    // around every other axis direction nothing jumps
    for (const glm::dvec3& f : {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, -1, 0),
                                glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)}) {
        for (int k = 0; k < 16; ++k) {
            const double angle = 0.39269908169872414 * k;
            const auto at = light_frame(f);
            const glm::dvec3 near_by =
                f + e * (std::cos(angle) * at.right + std::sin(angle) * at.up);
            CHECK(glm::length(light_frame(near_by).right - at.right) < 2.0 * e);
        }
    }
}

TEMPLATE_TEST_CASE("a directional map spans its box from edge to edge in every convention", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        light<T> source = sun(any_direction<T>(1e-3, 1e3));
        source.vertical = any_vertical();
        const box3<T> box = any_box<T>(log_between<double>(1.0, 1e6));
        const glm::vec<3, T> origin = coin() ? box.lo : glm::vec<3, T>(T(0));
        const real_frame frame = exact_frame(exact(source.direction), source.vertical);
        const real3 axes[] = {frame.right, frame.up, frame.forward};
        std::array<real, 3> lo{};
        std::array<real, 3> hi{};
        std::array<std::array<real, 3>, 8> light_space{};
        for (int i = 0; i < 8; ++i) {
            for (std::size_t a = 0; a < 3; ++a) {
                const real x = dot(axes[a], box_corner(box, i));
                light_space[static_cast<std::size_t>(i)][a] = x;
                lo[a] = i == 0 ? x : std::min(lo[a], x);
                hi[a] = i == 0 ? x : std::max(hi[a], x);
            }
        }
        const bool thin = hi[0] - lo[0] < 1e-5 || hi[1] - lo[1] < 1e-5 || hi[2] - lo[2] < 1e-5;
        RC_PRE(!thin); // 2^-24 of the largest extent, 200: another test
        for (const clip_space clip : some_conventions(2)) {
            const light_matrix_result<T> found =
                directional_light_matrix(source, box, clip, origin);
            RC_ASSERT(found.flags == status::ok);
            for (int i = 0; i < 8; ++i) {
                const real4 p = relative(box_corner(box, i), origin);
                const real4 q = multiply(found.matrix, p);
                const real4 terms = magnitudes(found.matrix, p);
                RC_ASSERT(q[3] == 1);
                for (std::size_t a = 0; a < 3; ++a) {
                    const real share =
                        (light_space[static_cast<std::size_t>(i)][a] - lo[a]) / (hi[a] - lo[a]);
                    real expected = 2 * share - 1;
                    if (a == 1 && clip.y_down) {
                        expected = -expected;
                    }
                    if (a == 2) {
                        const real d0 = near_depth<double>(clip);
                        expected = d0 + share * (far_depth<double>(clip) - d0);
                    }
                    // entries rounded once; and double: axes off by 8 u_d against positions of
                    // length |p|, three products, two sums and the quotient: 16 u_d |p| / reach
                    const double reach = as_double(hi[a] - lo[a]) * 0.5;
                    const double size =
                        std::sqrt(as_double(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
                    const double extent = std::sqrt(as_double(dot(
                        minus(exact(box.hi), exact(box.lo)), minus(exact(box.hi), exact(box.lo)))));
                    const double bound = roundoff<T>() * as_double(terms[a]) +
                                         32.0 * 0x1p-53 * (size + extent) / reach;
                    RC_ASSERT(as_double(abs(q[a] - expected)) <= bound);
                }
            }
        }
    }));
}

TEMPLATE_TEST_CASE("J13: relative to the eye a float map is good 1e6 from the origin", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<3, T> eye(T(1e6), T(2e6), T(-1e6));
        box3<T> box{eye, eye};
        for (glm::length_t i = 0; i < 3; ++i) {
            box.lo[i] -= between<T>(10.0, 200.0);
            box.hi[i] += between<T>(10.0, 200.0);
        }
        const light<T> source = sun(any_direction<T>(1.0, 2.0));
        const light_matrix_result<T> near_by =
            directional_light_matrix(source, box, clip::opengl, eye);
        const light_matrix_result<T> world = directional_light_matrix(source, box, clip::opengl);
        RC_ASSERT(near_by.flags == status::ok);
        const real_frame frame = exact_frame(exact(source.direction), up_axis::y);
        const glm::vec<3, T> offset(between<T>(-10.0, 10.0), between<T>(-10.0, 10.0),
                                    between<T>(-10.0, 10.0));
        // an exact map of the box's centre and reach
        const real3 centre = times(real(0.5), sum(exact(box.lo), exact(box.hi)));
        const real3 half = times(real(0.5), minus(exact(box.hi), exact(box.lo)));
        const real3 p = sum(exact(eye), exact(offset));
        const double texels = 2048.0;
        const real3 axes[] = {frame.right, frame.up};
        const glm::vec<4, T> q = near_by.matrix * glm::vec<4, T>(offset, T(1));
        const glm::vec<4, T> far_off = world.matrix * glm::vec<4, T>(eye + offset, T(1));
        double worst_world = 0.0;
        for (glm::length_t a = 0; a < 2; ++a) {
            const real3& axis = axes[a];
            const real reach =
                abs(axis[0]) * half[0] + abs(axis[1]) * half[1] + abs(axis[2]) * half[2];
            const real ndc = dot(axis, minus(p, centre)) / reach;
            const double error = as_double(abs(q[a] - ndc)) * 0.5 * texels;
            // terms below 3 in all: entries, products and sums, 5u each
            RC_ASSERT(error <= 0.5 * texels * 15.0 * roundoff<T>() + 1e-9);
            RC_ASSERT(error <= 1e-3);
            worst_world = std::max(worst_world, as_double(abs(far_off[a] - ndc)) * 0.5 * texels);
        }
        // the documented limit of world-space matrices: 5u of terms of 3e6 / reach
        RC_ASSERT(worst_world <= 0.5 * texels * 5.0 * 4.5e6 / 10.0 * roundoff<T>());
    }));
}

TEMPLATE_TEST_CASE("J23, peers 5: powers of two scale light matrices to the bit", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const light<T> source = sun(any_direction<T>(1e-3, 1e3));
        box3<T> box = any_box<T>(log_between<double>(1.0, 1e4));
        if (coin()) {
            box.hi.y = box.lo.y; // flat boxes too
        }
        const glm::vec<3, T> origin = coin() ? box.lo : any_direction<T>(1.0, 100.0);
        const T s = std::ldexp(T(1), *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(-20, 21)));
        const clip_space clip = any_convention();
        const box3<T> scaled{box.lo * s, box.hi * s};
        const light_matrix_result<T> a = directional_light_matrix(source, box, clip, origin);
        light_matrix_result<T> b = directional_light_matrix(source, scaled, clip, origin * s);
        for (glm::length_t column = 0; column < 3; ++column) {
            b.matrix[column] *= s;
        }
        RC_ASSERT(a.flags == b.flags);
        RC_ASSERT(a.matrix == b.matrix);

        const glm::vec<3, T> target = box.lo + any_direction<T>(1.0, 10.0);
        const light<T> lamp = spot_light(box.lo, target, between<T>(0.1, 3.0));
        const light<T> scaled_lamp = spot_light(box.lo * s, target * s, lamp.cone_angle);
        const T n = log_between<T>(0.01, 1.0);
        const T f = coin() ? infinity<T> : n * log_between<T>(2.0, 1e4);
        const light_matrix_result<T> c = spot_light_matrix(lamp, n, f, clip, origin);
        light_matrix_result<T> d = spot_light_matrix(scaled_lamp, n * s, f * s, clip, origin * s);
        d.matrix[3] /= s; // clip x, y, z and w of a perspective map are lengths
        RC_ASSERT(c.flags == d.flags);
        RC_ASSERT(c.matrix == d.matrix);
    }));
}

TEMPLATE_TEST_CASE("J19, peers 18: flat boxes, lines and points are widened", "", float, double) {
    using T = TestType;
    using vec3 = glm::vec<3, T>;
    REQUIRE(rc::check([] {
        const vec3 lo = any_direction<T>(1.0, 10.0);
        box3<T> box{lo, lo};
        const int kind = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 4));
        for (glm::length_t i = 0; i < 3; ++i) {
            box.hi[i] += i < kind ? T(1) : T(0); // point, line, plane, box
        }
        const vec3 directions[] = {vec3(T(1), T(0), T(0)), vec3(T(0), T(1), T(0)),
                                   vec3(T(0), T(0), T(1)), any_direction<T>(1.0, 2.0)};
        for (const vec3& direction : directions) {
            const light_matrix_result<T> found =
                directional_light_matrix(sun(direction), box, clip::opengl, lo);
            RC_ASSERT(finite(found.matrix));
            // seen along an axis a point, a line and a plane lack an extent; seen askew the line
            // and the plane have all three
            const bool along_an_axis = direction != directions[3];
            if (kind == 0 || (kind < 3 && along_an_axis)) {
                RC_ASSERT(found.flags == status::degenerate_extent);
            }
            if (kind == 3) {
                RC_ASSERT(found.flags == status::ok);
            }
            for (int i = 0; i < 8; ++i) {
                const real4 p = relative(box_corner(box, i), lo);
                const real4 q = multiply(found.matrix, p);
                const real4 terms = magnitudes(found.matrix, p);
                for (std::size_t a = 0; a < 3; ++a) {
                    // entries rounded once; in double 32 u_d |p| / reach as above, reach being
                    // 2^-24 of the largest or more
                    const double slack =
                        roundoff<T>() * as_double(terms[a]) + 64.0 * 0x1p-53 * 0x1p24;
                    RC_ASSERT(as_double(abs(q[a])) <= 1.0 + slack);
                }
            }
        }
    }));
    // no length anywhere: the unit is 1
    const box3<T> nothing{vec3(T(0)), vec3(T(0))};
    const auto found =
        directional_light_matrix(sun(vec3(T(0), T(-1), T(0))), nothing, clip::opengl);
    CHECK(found.flags == status::degenerate_extent);
    CHECK(found.matrix[0][0] == T(1));
}

TEMPLATE_TEST_CASE("J20: inverted boxes and values that are none", "", float, double) {
    using T = TestType;
    using vec3 = glm::vec<3, T>;
    const light<T> source = sun(vec3(T(1), T(-2), T(0.5)));
    for (glm::length_t i = 0; i < 3; ++i) {
        box3<T> box{vec3(T(-1)), vec3(T(1))};
        CHECK(directional_light_matrix(source, box, clip::opengl).flags == status::ok);
        box.lo[i] = T(2);
        const auto inverted = directional_light_matrix(source, box, clip::opengl);
        CHECK(inverted.flags == status::invalid_input);
        CHECK((inverted.matrix == identity<T>()));
        for (const T bad : {nan_of<T>, infinity<T>, -infinity<T>}) {
            box3<T> broken{vec3(T(-1)), vec3(T(1))};
            broken.hi[i] = bad;
            const auto found = directional_light_matrix(source, broken, clip::opengl);
            CHECK(found.flags == status::invalid_input);
            CHECK((found.matrix == identity<T>()));
        }
    }
    const box3<T> box{vec3(T(-1)), vec3(T(1))};
    for (const vec3& direction : {vec3(T(0)), vec3(nan_of<T>), vec3(infinity<T>, T(0), T(0))}) {
        CHECK(directional_light_matrix(sun(direction), box, clip::opengl).flags ==
              status::invalid_input);
    }
    // the wrong kind of light
    const light<T> lamp = spot_light(vec3(T(0)), vec3(T(1)), T(1));
    CHECK(directional_light_matrix(lamp, box, clip::opengl).flags == status::invalid_input);
    CHECK(spot_light_matrix(source, T(1), T(2), clip::opengl).flags == status::invalid_input);
    CHECK(spot_light_matrix(point_light(vec3(T(0))), T(1), T(2), clip::opengl).flags ==
          status::invalid_input);
    // a target at the light
    CHECK(spot_light_matrix(spot_light(vec3(T(3)), vec3(T(3)), T(1)), T(1), T(2), clip::opengl)
              .flags == status::invalid_input);
}

TEMPLATE_TEST_CASE("peers 40: a spot light's map is the same in every convention", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<3, T> position = any_direction<T>(1.0, 1e5);
        light<T> source =
            spot_light(position, position + any_direction<T>(1.0, 10.0), between<T>(0.05, 3.1));
        source.vertical = any_vertical();
        RC_PRE((source.direction != glm::vec<3, T>(T(0))));
        const T n = log_between<T>(1e-2, 1.0);
        const T f = n * log_between<T>(2.0, 1e5);
        const real_frame frame = exact_frame(exact(source.direction), source.vertical);
        const real slope = tan(real(source.cone_angle) / 2);
        const real d = log_between<double>(static_cast<double>(n), static_cast<double>(f));
        // on the cone, and inside it
        const double angle = between<double>(0.0, 6.283185307179586);
        const real radius = coin() ? real(1) : real(between<double>(0.0, 1.0));
        const real x = radius * real(std::cos(angle));
        const real y = radius * real(std::sin(angle));
        const real3 p = times(
            d, sum(frame.forward, times(slope, sum(times(x, frame.right), times(y, frame.up)))));
        const glm::vec<3, T> origin =
            coin() ? source.position : source.position + any_direction<T>(1.0, 100.0);
        const real4 q_in = relative(sum(exact(source.position), p), origin);
        for (const clip_space clip : some_conventions(8)) {
            const light_matrix_result<T> found = spot_light_matrix(source, n, f, clip, origin);
            RC_ASSERT(found.flags == status::ok);
            const real4 q = multiply(found.matrix, q_in);
            const real4 terms = magnitudes(found.matrix, q_in);
            const double u = roundoff<T>();
            // entries rounded (float: once; double: axis 8u, tangent and quotient 4u); the quotient
            // by w carries the error of w, whose terms are |p|
            const double k = is_float<T> ? 1.01 : 14.0;
            const double w = as_double(q[3]);
            const double bad_w = k * u * as_double(terms[3]) / w;
            const double size =
                as_double(length(p)) +
                2.0 * as_double(length(minus(exact(source.position), exact(origin))));
            // double: axis errors are absolute, not relative to the entry
            const double axes = is_float<T> ? 1e-14 : 16.0 * u;
            const auto close = [&](std::size_t a, double expected, double gain) {
                const double bound = k * u * as_double(terms[a]) / w +
                                     bad_w * (1.0 + std::abs(expected)) +
                                     axes * size * (gain + std::abs(expected)) / w;
                return std::abs(as_double(q[a] / q[3]) - expected) <= bound * 1.01;
            };
            const double gain = 1.0 / as_double(slope);
            RC_ASSERT(std::abs(w - as_double(d)) <= k * u * as_double(terms[3]) + axes * size);
            RC_ASSERT(close(0, as_double(x), gain));
            RC_ASSERT(close(1, clip.y_down ? -as_double(y) : as_double(y), gain));
            const real d0 = near_depth<double>(clip);
            const real d1 = far_depth<double>(clip);
            const real r = clip.infinite_far ? real(0) : real(n) / f;
            const double depth = as_double(d0 + (d1 - d0) * (1 - real(n) / d) / (1 - r));
            RC_ASSERT(close(2, depth, 2.0));
        }
    }));
}

TEMPLATE_TEST_CASE("peers 14: cones close to a half space, and beyond", "", float, double) {
    using T = TestType;
    using vec3 = glm::vec<3, T>;
    const auto flags_of = [](T angle, T n, T f) {
        const light_matrix_result<T> found = spot_light_matrix(
            spot_light(vec3(T(1)), vec3(T(2)), angle), n, f, clip::vulkan.reversed());
        CHECK(finite(found.matrix));
        return found.flags;
    };
    CHECK(flags_of(T(3.14), T(1), T(10)) == status::ok);
    for (const T wide : {T(3.1415926535897931), T(3.5), T(7), T(1e10)}) {
        CHECK(flags_of(wide, T(1), T(10)) == status::out_of_range);
    }
    for (const T narrow : {T(0), T(-1), T(1e-10)}) {
        CHECK(flags_of(narrow, T(1), T(10)) == status::out_of_range);
    }
    CHECK(flags_of(T(1e-5), T(1), T(10)) == status::ok);
    CHECK(flags_of(nan_of<T>, T(1), T(10)) == status::invalid_input);
    CHECK(flags_of(infinity<T>, T(1), T(10)) == status::invalid_input);
    CHECK(flags_of(T(1), T(0), T(10)) == status::near_clamped);
    CHECK(flags_of(T(1), T(-3), T(10)) == status::near_clamped);
    CHECK(flags_of(T(1), T(1), infinity<T>) == status::ok);
    CHECK(flags_of(T(1), T(0), infinity<T>) == status::invalid_input);
    CHECK(flags_of(T(1), T(10), T(1)) == status::out_of_range);
    CHECK(flags_of(T(1), nan_of<T>, T(1)) == status::invalid_input);
    // w = 1 at the near plane that was raised to 2^-20 of far: its depth is that of the near plane
    const light<T> down = spot_light(vec3(T(0)), vec3(T(0), T(-1), T(0)), T(1));
    const auto raised = spot_light_matrix(down, T(0), T(1024), clip::opengl);
    const real4 q = multiply(raised.matrix, real4{real(0), real(-0x1p-10), real(0), real(1)});
    CHECK(as_double(abs(q[2] / q[3] + 1)) <= 4.0 * roundoff<T>());
}

TEMPLATE_TEST_CASE("lights are total", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<3, T> a = any_numbers<T>();
        const glm::vec<3, T> b = any_numbers<T>();
        const glm::vec<3, T> c = any_numbers<T>();
        const glm::vec<3, T> origin = coin() ? glm::vec<3, T>(T(0)) : any_numbers<T>();
        const clip_space clip = any_convention();
        const up_axis vertical = any_vertical();
        const light_frame_result<T> frame = light_frame(a, vertical);
        const bool direction = finite(a) && a != glm::vec<3, T>(T(0));
        RC_ASSERT((frame.flags == status::ok) == direction);
        const real3 axes[] = {exact(frame.right), exact(frame.up), exact(frame.forward)};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                // two factors, each within axis_error sqrt(3) of a unit vector
                RC_ASSERT(std::abs(as_double(dot(axes[i], axes[j])) - (i == j ? 1.0 : 0.0)) <=
                          4.0 * axis_error<T>);
            }
        }
        light<T> source = sun(a);
        RC_ASSERT(finite(source.direction));
        source.vertical = vertical;
        const auto parallel = directional_light_matrix(source, box3<T>{b, c}, clip, origin);
        RC_ASSERT(finite(parallel.matrix));
        if (!direction || !finite(b) || !finite(c) || !finite(origin)) {
            RC_ASSERT(parallel.flags == status::invalid_input);
            RC_ASSERT((parallel.matrix == identity<T>()));
        }
        // sorted boxes come through more often
        const auto sorted =
            directional_light_matrix(source, box3<T>{glm::min(b, c), glm::max(b, c)}, clip, origin);
        RC_ASSERT(finite(sorted.matrix));
        const light<T> lamp = spot_light(a, b, any_number<T>());
        RC_ASSERT(finite(lamp.direction));
        const auto spot = spot_light_matrix(lamp, any_number<T>(), any_number<T>(), clip, origin);
        RC_ASSERT(finite(spot.matrix));
        if (spot.matrix == identity<T>()) {
            RC_ASSERT(any(spot.flags, status::invalid_input | status::out_of_range));
        }
    }));
}
