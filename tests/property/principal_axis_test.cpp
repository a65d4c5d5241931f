// Properties of warpshadow/principal_axis.hpp.
#include "warp_oracle.hpp"

#include <warpshadow/principal_axis.hpp>

#include <catch2/catch.hpp>
#include <glm/vec4.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace warpshadow;
using namespace warp_test;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// How far two axes, or with a quarter two frames, are apart.
double apart(double a, double b, double period = pi) {
    return std::abs(std::remainder(a - b, period));
}

/// Variance of the importance along a direction, in exact numbers but for the direction itself.
double variance(const owned_counts& c, glm::dvec2 extent, double angle) {
    const rational ux(std::cos(angle) * extent.x);
    const rational uy(std::sin(angle) * extent.y);
    rational weight = 0;
    rational sum = 0;
    rational squares = 0;
    for (int j = 0; j < c.height; ++j) {
        for (int i = 0; i < c.width; ++i) {
            const rational n = c.at(i, j);
            const rational at =
                ux * rational(2 * i + 1, 2 * c.width) + uy * rational(2 * j + 1, 2 * c.height);
            weight += n;
            sum += n * at;
            squares += n * at * at;
        }
    }
    const rational mean = sum / weight;
    return static_cast<double>(squares / weight - mean * mean);
}

/// A strip of importance along a direction, cells of which the strip's middle line is near.
owned_counts strip(int size, double angle, double half_width) {
    owned_counts c(size, size);
    for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; ++i) {
            const double x = (i + 0.5) / size - 0.5;
            const double y = (j + 0.5) / size - 0.5;
            const bool on = std::abs(y * std::cos(angle) - x * std::sin(angle)) < half_width &&
                            x * x + y * y < 0.25;
            c.at(i, j) = on ? 3 : 0;
        }
    }
    return c;
}

/// The same map seen after a quarter turn of its frame: (u, v) becomes (v, 1 − u).
owned_counts quarter_turned(const owned_counts& c) {
    owned_counts turned(c.height, c.width);
    for (int j = 0; j < c.height; ++j) {
        for (int i = 0; i < c.width; ++i) {
            turned.at(j, c.width - 1 - i) = c.at(i, j);
        }
    }
    return turned;
}

} // namespace

TEMPLATE_TEST_CASE("principal_axis has the largest variance of all directions", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const owned_counts c = any_counts(d, d.between(1, 12), d.between(1, 12));
        const glm::vec<2, T> extent(static_cast<T>(std::exp2(d.between(-4.0, 4.0))),
                                    static_cast<T>(std::exp2(d.between(-4.0, 4.0))));
        const principal_axis_result<T> axis = principal_axis(c.view(), extent);
        if (any(axis.flags, status::empty_importance)) {
            RC_ASSERT(axis.elongation == T(0) && axis.angle == T(0));
            return;
        }
        const glm::dvec2 e(extent);
        const double angle = static_cast<double>(axis.angle);
        const double along = variance(c, e, angle);
        const double across = variance(c, e, angle + 0.5 * pi);
        const double spread = along + across;
        const double error = (1e-13 + 4.0 * roundoff<T>()) * spread;
        RC_ASSERT(std::abs(along - across - static_cast<double>(axis.elongation) * spread) <=
                  error);
        for (int k = 0; k < 8; ++k) {
            RC_ASSERT(variance(c, e, d.between(0.0, pi)) <= along + error);
        }
    }));
}

TEMPLATE_TEST_CASE("a strip has the direction it was drawn in", "", float, double) {
    using T = TestType;
    for (const double angle : {0.0, 0.2, 0.25 * pi, 1.2, 0.5 * pi, 2.0, 3.0}) {
        const owned_counts c = strip(128, angle, 0.05);
        const principal_axis_result<T> axis = principal_axis(c.view(), glm::vec<2, T>(T(2)));
        INFO(angle);
        CHECK(axis.flags == status::ok);
        // cells are 1/128 of the map, a strip 1/10: its sides are ragged by less than a cell
        CHECK(apart(static_cast<double>(axis.angle), angle) < 0.01);
        CHECK(axis.elongation > T(0.9));
        CHECK(std::abs(axis.centre.x - T(0.5)) < T(0.01));
    }
}

TEMPLATE_TEST_CASE("a quarter turn of the map turns the axis by a quarter, to the bit or nearly",
                   "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const owned_counts c = any_counts(d, d.size(64), d.size(64));
        const glm::vec<2, T> extent(static_cast<T>(d.between(0.5, 2.0)),
                                    static_cast<T>(d.between(0.5, 2.0)));
        const principal_axis_result<T> axis = principal_axis(c.view(), extent);
        const principal_axis_result<T> other =
            principal_axis(quarter_turned(c).view(), glm::vec<2, T>(extent.y, extent.x));
        const auto elongation = static_cast<double>(axis.elongation);
        RC_ASSERT(std::abs(elongation - static_cast<double>(other.elongation)) <=
                  1e-12 + 2.0 * roundoff<T>());
        if (elongation > 1e-6) {
            RC_ASSERT(apart(static_cast<double>(axis.angle),
                            static_cast<double>(other.angle) + 0.5 * pi) <=
                      1e-12 / elongation + 4.0 * roundoff<T>());
        }
    }));
}

TEMPLATE_TEST_CASE("scenes in other units have the same axis to the bit", "", float, double) {
    using T = TestType;
    dice d(3);
    const owned_counts c = any_counts(d, 20, 30);
    const glm::vec<2, T> extent(T(3), T(5));
    const principal_axis_result<T> axis = principal_axis(c.view(), extent);
    for (const int exponent : {-100, -3, 7, 100}) {
        const principal_axis_result<T> other =
            principal_axis(c.view(), glm::vec<2, T>(std::ldexp(extent.x, exponent),
                                                    std::ldexp(extent.y, exponent)));
        CHECK(axis.angle == other.angle);
        CHECK(axis.elongation == other.elongation);
    }
}

TEMPLATE_TEST_CASE("importance without a direction: no elongation, and the frame stays", "", float,
                   double) {
    using T = TestType;
    owned_counts none(8, 8);
    owned_counts point(8, 8);
    point.at(2, 5) = largest_count;
    owned_counts square(8, 8);
    std::fill(square.counts.begin(), square.counts.end(), 7u);
    owned_counts cross(9, 9); // equal eigenvalues, and nothing uniform
    for (int i = 0; i < 9; ++i) {
        cross.at(i, i) = 5;
        cross.at(i, 8 - i) = 5;
    }
    for (const owned_counts* c : {&none, &point, &square, &cross}) {
        const principal_axis_result<T> axis = principal_axis(c->view(), glm::vec<2, T>(T(3)));
        CHECK(axis.elongation == T(0));
        axis_state state;
        state.started = true;
        state.angle = 0.3;
        for (int i = 0; i < 5; ++i) {
            CHECK(turn_to_axis(axis.angle, axis.elongation, axis_options<T>{}, state) == T(0.3));
        }
        CHECK(state.way == 0);
    }
}

TEMPLATE_TEST_CASE("principal_axis is total", "", float, double) {
    using T = TestType;
    const owned_counts c = strip(16, 0.5, 0.2);
    for (const double bad : {0.0, -1.0, no_number, infinity, -infinity}) {
        const principal_axis_result<T> axis =
            principal_axis(c.view(), glm::vec<2, T>(static_cast<T>(bad), T(1)));
        CHECK(any(axis.flags, status::invalid_input));
        CHECK(std::isfinite(axis.angle));
        CHECK(axis.elongation > T(0));
    }
    const principal_axis_result<T> largest =
        principal_axis(c.view(), glm::vec<2, T>(std::numeric_limits<T>::max(),
                                                std::numeric_limits<T>::denorm_min()));
    CHECK(largest.angle == T(0));
    CHECK(largest.elongation == T(1));
    const principal_axis_result<T> small =
        principal_axis(count_view(c.counts, 17, 16), glm::vec<2, T>(T(1)));
    CHECK(small.flags == status::buffer_too_small);
    CHECK(small.elongation == T(0));

    owned_counts full(64, 64);
    for (int i = 0; i < 64; ++i) {
        full.at(i, i) = largest_count;
        full.at(0, i) = largest_count;
    }
    CHECK(std::isfinite(principal_axis(full.view(), glm::vec<2, T>(T(1))).angle));
}

TEMPLATE_TEST_CASE("turn_to_axis: whatever the numbers, the angle moves by the slew at most", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        axis_state state;
        axis_options<T> options;
        options.hysteresis = d.coin() ? static_cast<T>(d.unit()) : any_coordinate<T>(d);
        options.slew = d.coin() ? static_cast<T>(0.1 * d.unit()) : any_coordinate<T>(d);
        double before = 0.0;
        for (int i = 0; i < 30; ++i) {
            const T axis = d.coin() ? static_cast<T>(d.between(-7.0, 7.0)) : any_coordinate<T>(d);
            const T elongation = d.coin() ? static_cast<T>(d.unit()) : any_coordinate<T>(d);
            const bool started = state.started;
            const T angle = turn_to_axis(axis, elongation, options, state);
            RC_ASSERT(angle == static_cast<T>(state.angle));
            RC_ASSERT(std::abs(state.angle) <= pi);
            const double most = options.slew > T(0) ? static_cast<double>(options.slew) : 0.0;
            if (started) {
                RC_ASSERT(apart(state.angle, before, 2.0 * pi) <= most + 1e-15);
            } else {
                RC_ASSERT(apart(state.angle, before, 2.0 * pi) <= 0.25 * pi + 1e-15);
            }
            before = state.angle;
        }
    }));
}

TEMPLATE_TEST_CASE("an axis that jumps by 90 or 180 degrees does not move the frame", "", float,
                   double) {
    using T = TestType;
    axis_state state;
    const axis_options<T> options;
    const T first = turn_to_axis(T(0.4), T(0.9), options, state);
    CHECK(first == T(0.4));
    for (int i = 0; i < 100; ++i) {
        const double axis = 0.4 + 0.5 * pi * ((i * 7) % 5 - 2);
        const T angle = turn_to_axis(static_cast<T>(axis), T(0.9), options, state);
        CHECK(std::abs(angle - first) <= T(4) * std::numeric_limits<T>::epsilon());
    }
}

TEMPLATE_TEST_CASE("an axis that goes round is followed within slew and hysteresis", "", float,
                   double) {
    using T = TestType;
    axis_state state;
    const axis_options<T> options;
    const double step = 0.5 * static_cast<double>(options.slew);
    // at rest up to elongation |sin 2δ| = hysteresis
    const double slack = 0.5 * std::asin(static_cast<double>(options.hysteresis) / 0.8);
    for (int i = 0; i * step < 2.0 * pi; ++i) {
        turn_to_axis(static_cast<T>(i * step), T(0.8), options, state);
        REQUIRE(apart(state.angle, i * step, 0.5 * pi) <= slack + 2.0 * step);
    }
    // far enough away it is reached, and the frame rests
    for (int i = 0; i < 400; ++i) {
        turn_to_axis(T(1), T(0.8), options, state);
    }
    CHECK(apart(state.angle, 1.0, 0.5 * pi) < 1e-6);
    CHECK(state.way == 0);
}

TEMPLATE_TEST_CASE("half-way between two quarters a noisy axis does not turn the frame to and fro",
                   "", float, double) {
    using T = TestType;
    dice d(8);
    for (const double noise : {1e-6, 0.02, 0.2}) {
        axis_state state;
        const axis_options<T> options;
        turn_to_axis(T(0), T(1), options, state);
        double travelled = 0.0;
        double before = 0.0;
        for (int i = 0; i < 400; ++i) {
            const double axis = 0.25 * pi + d.between(-noise, noise);
            turn_to_axis(static_cast<T>(axis), T(1), options, state);
            travelled += apart(state.angle, before, 2.0 * pi);
            before = state.angle;
        }
        INFO(noise);
        CHECK(apart(state.angle, 0.25 * pi, 0.5 * pi) <= 2.0 * noise + 1e-6);
        // there and no farther; the rest is noise that is followed at the end
        CHECK(std::abs(state.angle) >= 0.25 * pi - 2.0 * noise - 1e-6);
        CHECK(travelled <= 0.25 * pi + 2.0 * noise + 220 * static_cast<double>(options.slew));
    }
}

TEMPLATE_TEST_CASE("elongation that is too small to pay leaves the frame alone", "", float,
                   double) {
    using T = TestType;
    axis_state state;
    const axis_options<T> options;
    CHECK(turn_to_axis(T(0.7), options.hysteresis, options, state) == T(0));
    for (int i = 0; i < 100; ++i) {
        CHECK(turn_to_axis(T(0.7), options.hysteresis, options, state) == T(0));
    }
}

TEMPLATE_TEST_CASE("turned: a map about its centre, in the scene's proportions, nothing lost", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const glm::dvec2 extent(std::exp2(d.between(-3.0, 3.0)), std::exp2(d.between(-3.0, 3.0)));
        const double angle = d.between(-4.0, 4.0);
        glm::mat<4, 4, T> light;
        for (glm::length_t i = 0; i < 4; ++i) {
            for (glm::length_t j = 0; j < 4; ++j) {
                light[i][j] = static_cast<T>(d.between(-1.0, 1.0));
            }
        }
        const turned_map<T> map = turned(light, glm::vec<2, T>(extent), static_cast<T>(angle));
        RC_ASSERT(map.flags == status::ok);
        const double error = 40.0 * roundoff<T>();
        for (glm::length_t k = 0; k < 4; ++k) {
            RC_ASSERT(map.matrix[k].z == light[k].z && map.matrix[k].w == light[k].w);
            // lengths in the scene do not change
            const glm::dvec2 p = glm::dvec2(light[k]) * extent;
            const glm::dvec2 q = glm::dvec2(map.matrix[k]) * glm::dvec2(map.extent);
            const double length = std::hypot(p.x, p.y);
            RC_ASSERT(std::abs(std::hypot(q.x, q.y) - length) <= error * length);
            if (length > 0.0) {
                RC_ASSERT(apart(std::atan2(q.y, q.x), std::atan2(p.y, p.x) - angle, 2.0 * pi) <=
                          error * 4.0);
            }
        }
        // the corners of the old map are inside, and one of them is on each side
        for (const glm::dvec2 corner : {glm::dvec2(1, 1), glm::dvec2(1, -1)}) {
            const double c = std::cos(angle);
            const double s = std::sin(angle);
            const glm::dvec2 p = corner * extent;
            const glm::dvec2 q = glm::dvec2(c * p.x + s * p.y, c * p.y - s * p.x);
            RC_ASSERT(std::abs(q.x) <= static_cast<double>(map.extent.x) * (1.0 + error));
            RC_ASSERT(std::abs(q.y) <= static_cast<double>(map.extent.y) * (1.0 + error));
        }
    }));
    const glm::mat<4, 4, T> light(T(1));
    for (const double bad : {0.0, -1.0, no_number, infinity}) {
        const glm::vec<2, T> extent(static_cast<T>(bad), T(1));
        CHECK(turned(light, extent, T(1)).flags == status::invalid_input);
        CHECK(turned(light, extent, T(1)).matrix == light);
    }
    CHECK(turned(light, glm::vec<2, T>(T(1)), static_cast<T>(infinity)).flags ==
          status::invalid_input);
    const glm::vec<2, T> huge(std::numeric_limits<T>::max());
    CHECK(turned(light, huge, T(0.5)).flags == status::out_of_range);
}
