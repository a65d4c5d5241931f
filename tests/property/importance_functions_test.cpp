// Properties of warpshadow/importance_functions.hpp: the published formulas in exact arithmetic.
//
// u is half an ulp of 1. A sum, a product or a quotient of T adds a relative error of u.
#include "warp_oracle.hpp"

#include <warpshadow/conventions.hpp>
#include <warpshadow/importance_functions.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace warpshadow;
using namespace warp_test;

namespace {

template <typename T> bool close(T value, const rational& exact, double error) {
    return abs(rational(value) - exact) <= rational(error);
}

template <typename T> T power(dice& d, int lo, int hi) {
    return static_cast<T>(std::exp2(d.between(double(lo), double(hi))));
}

} // namespace

TEMPLATE_TEST_CASE("distance_importance is 1 - z of OpenGL's depth, without its cancellation", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const T n = power<T>(d, -10, 10);
        const T inverse_far = d.between(0, 3) == 0 ? T(0) : T(1) / (n * power<T>(d, 1, 30));
        const T q = n * power<T>(d, -2, 20);
        const rational share = rational(n) * rational(inverse_far);
        rational exact =
            2 * (std::min(rational(n) / rational(q), rational(1)) - share) / (1 - share);
        exact = std::clamp(exact, rational(0), rational(2));
        // n/f, n/q, their difference and 1 - n/f >= 1/2: errors of u each, magnified by two at
        // most; then quotient and product
        RC_ASSERT(close(distance_importance(q, n, inverse_far), exact, 2 * 12 * roundoff<T>()));
    }));
    CHECK(distance_importance(T(1), T(1), T(0.01)) == T(2));
    CHECK(distance_importance(T(64), T(1), T(1) / T(64)) == T(0));
    CHECK(distance_importance(T(1e30), T(1), T(0.25)) == T(0));
    CHECK(distance_importance(T(-1), T(1), T(0.25)) == T(2));
    CHECK(distance_importance(std::numeric_limits<T>::quiet_NaN(), T(1), T(0)) == T(2));
    CHECK(distance_importance(std::numeric_limits<T>::infinity(), T(1), T(0)) == T(0));
    CHECK(distance_importance(T(2), T(1), T(1)) == T(0)); // no depth range: far is near
}

TEMPLATE_TEST_CASE("depth_importance agrees in every clip space, and with the distance", "", float,
                   double) {
    using T = TestType;
    // 1 - z as published
    CHECK(depth_importance(T(-1), T(-1), T(1)) == T(2));
    CHECK(depth_importance(T(0), T(-1), T(1)) == T(1));
    CHECK(depth_importance(T(1), T(-1), T(1)) == T(0));
    CHECK(depth_importance(T(5), T(-1), T(1)) == T(0));
    CHECK(depth_importance(T(-5), T(-1), T(1)) == T(2));
    CHECK(depth_importance(std::numeric_limits<T>::quiet_NaN(), T(0), T(1)) == T(0));
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const T n = T(0.5);
        const T f = T(64);
        const T q = static_cast<T>(d.between(0.5, 64.0));
        const T expected = distance_importance(q, n, T(1) / f);
        const view_volume<T> volume = perspective_volume<T>(T(1), T(1), n, f);
        for (const clip_space& clip :
             {clip::opengl, clip::vulkan, clip::d3d, clip::vulkan.reversed()}) {
            const T depth = ndc_from_eye_depth(q, volume, clip);
            const T importance = depth_importance(depth, near_depth<T>(clip), far_depth<T>(clip));
            // the depth has an absolute error of a few u, as (f + n) / (f - n) is near 1
            RC_ASSERT(std::abs(double(importance) - double(expected)) <= 32 * roundoff<T>());
        }
    }));
}

TEMPLATE_TEST_CASE("desired_view_importance: closed on the planes, nothing behind the eye", "",
                   float, double) {
    using T = TestType;
    using vec4 = glm::vec<4, T>;
    CHECK(desired_view_importance(vec4(1, -1, 1, 1), T(-1), T(1)) == T(1));
    CHECK(desired_view_importance(vec4(1, -1, -1, 1), T(-1), T(1)) == T(1));
    CHECK(desired_view_importance(vec4(1, -1, -1, 1), T(0), T(1)) == T(0));
    CHECK(desired_view_importance(vec4(1, -1, -1, 1), T(1), T(0)) == T(0));
    CHECK(desired_view_importance(vec4(0, 0, 2, 4), T(1), T(0)) == T(1));
    CHECK(desired_view_importance(vec4(0, 0, 0, -1), T(-1), T(1)) == T(0));
    CHECK(desired_view_importance(vec4(0, 0, 0, 0), T(-1), T(1)) == T(0));
    const T nan = std::numeric_limits<T>::quiet_NaN();
    for (int i = 0; i < 4; ++i) {
        vec4 clip(0, 0, 0, 1);
        clip[i] = nan;
        CHECK(desired_view_importance(clip, T(-1), T(1)) == T(0));
        clip[i] = i < 3 ? std::nextafter(T(1), T(2)) : std::nextafter(T(0), T(-1));
        CHECK(desired_view_importance(clip, T(-1), T(1)) == T(0));
    }
}

TEMPLATE_TEST_CASE("depth_edge looks at each of the eight neighbours, both ways", "", float,
                   double) {
    using T = TestType;
    const T nan = std::numeric_limits<T>::quiet_NaN();
    for (int i = 0; i < 8; ++i) {
        for (const T step : {T(0.25), T(-0.25)}) {
            glm::vec<4, T> ring[2] = {glm::vec<4, T>(T(0.5)), glm::vec<4, T>(T(0.5))};
            ring[i / 4][i % 4] = T(0.5) + step;
            CHECK(depth_edge(T(0.5), ring[0], ring[1], T(0.125)));
            CHECK_FALSE(depth_edge(T(0.5), ring[0], ring[1], T(0.25)));
            ring[i / 4][i % 4] = nan;
            CHECK_FALSE(depth_edge(T(0.5), ring[0], ring[1], T(0)));
        }
    }
}

TEMPLATE_TEST_CASE("normal, lit and edge importance as published, at their limits too", "", float,
                   double) {
    using T = TestType;
    const T nan = std::numeric_limits<T>::quiet_NaN();
    CHECK(normal_importance(T(1), T(2)) == T(3));
    CHECK(normal_importance(T(2), T(2)) == T(3));
    CHECK(normal_importance(T(0.5), T(2)) == T(2));
    CHECK(normal_importance(T(0), T(2)) == T(1));
    CHECK(normal_importance(T(-1), T(2)) == T(1));
    CHECK(normal_importance(nan, T(2)) == T(1));
    CHECK(lit_importance(T(0.5), T(0)) == T(1));
    CHECK(lit_importance(T(0), T(0)) == T(0));
    CHECK(lit_importance(T(-0.5), T(-2)) == T(1));
    CHECK(lit_importance(nan, T(-2)) == T(0));
    CHECK(edge_importance(T(1), T(0.001)) == T(1));
    CHECK(edge_importance(T(0), T(0.001)) == T(0.001));
    CHECK(edge_importance(T(0.5), T(0.5)) == T(0.75));
    CHECK(edge_importance(nan, T(0.25)) == T(0.25));
    CHECK(edge_importance(T(-1), T(0.25)) == T(0.25));
    CHECK(edge_importance(std::numeric_limits<T>::infinity(), T(0.25)) == T(1));
}

TEMPLATE_TEST_CASE("shadow_end is across the gradient of all 512 sets of nine answers", "", float,
                   double) {
    using T = TestType;
    for (unsigned lit = 0; lit < 512; ++lit) {
        CAPTURE(lit);
        glm::vec<3, T> rows[3];
        int gradient[2] = {0, 0};
        for (int texel = 0; texel < 9; ++texel) {
            const bool is_lit = (lit >> texel & 1u) != 0;
            rows[texel / 3][texel % 3] = is_lit ? T(1) : T(0);
            gradient[0] += is_lit ? texel % 3 - 1 : 0;
            gradient[1] += is_lit ? texel / 3 - 1 : 0;
        }
        const glm::vec<2, T> end = shadow_end(rows[0], rows[1], rows[2]);
        const double length = std::hypot(double(gradient[0]), double(gradient[1]));
        const bool agree = lit == 0 || lit == 511;
        for (int axis = 0; axis < 2; ++axis) {
            const double expected = length > 0.0 ? std::abs(gradient[axis]) / length
                                    : agree      ? 0.0
                                                 : std::sqrt(0.5);
            // two quotients and a root of a sum, half an ulp of a number below 2 each
            CHECK(std::abs(double(end[axis]) - expected) <= 6 * roundoff<T>());
        }
    }
}

TEMPLATE_TEST_CASE("shadow_end is finite and in [0, 1] for any answers, NaN and infinity too", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const T odd[] = {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity(),
                         -std::numeric_limits<T>::infinity(), std::numeric_limits<T>::max(),
                         std::numeric_limits<T>::denorm_min()};
        glm::vec<3, T> rows[3];
        for (int texel = 0; texel < 9; ++texel) {
            rows[texel / 3][texel % 3] =
                d.between(0, 9) == 0 ? odd[d.between(0, 4)] : static_cast<T>(d.between(0.0, 1.0));
        }
        const glm::vec<2, T> end = shadow_end(rows[0], rows[1], rows[2]);
        RC_ASSERT(end.x >= T(0) && end.x <= T(1) && end.y >= T(0) && end.y <= T(1));
    }));
    // squares that a T does not hold
    const glm::vec<3, T> none(T(0));
    for (const T tiny : {std::sqrt(std::numeric_limits<T>::denorm_min()),
                         std::numeric_limits<T>::min(), std::numeric_limits<T>::denorm_min()}) {
        CHECK(shadow_end(none, glm::vec<3, T>(T(0), T(0), tiny), none) ==
              glm::vec<2, T>(T(1), T(0)));
    }
}

TEMPLATE_TEST_CASE("combinations: any subset, by product and by sum, gated by light and view", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        importance_options<T> options;
        options.distance = d.coin();
        options.edge = d.coin();
        options.normal = d.coin();
        options.add = d.coin();
        options.near_distance = T(0.5);
        options.inverse_far = T(0.015625);
        seen_point<T> point;
        point.eye_distance = static_cast<T>(d.between(0.1, 80.0));
        point.view_cosine = static_cast<T>(d.between(-1.0, 1.0));
        point.light_cosine = static_cast<T>(d.between(-1.0, 1.0));
        point.edge = static_cast<T>(d.coin() ? d.between(0.0, 1.0) : double(d.between(0, 1)));

        double product = 1.0;
        double sum = 0.0;
        const std::array<std::pair<bool, double>, 3> functions{
            {{options.distance,
              double(distance_importance(point.eye_distance, options.near_distance,
                                         options.inverse_far))},
             {options.edge,
              double(point.edge) + (1.0 - double(point.edge)) * double(options.alpha)},
             {options.normal, 1.0 + 2.0 * std::max(0.0, double(point.view_cosine))}}};
        bool used = false;
        for (const auto& [on, value] : functions) {
            used = used || on;
            product *= on ? value : 1.0;
            sum += on ? value : 0.0;
        }
        const double expected = options.add && used ? sum : product;
        const double lit = point.light_cosine > T(0) ? 1.0 : 0.0;
        // at most 2 · 1 · 3: three products or sums, and at most three operations in a factor
        const double error = 6.0 * 8.0 * roundoff<T>();
        RC_ASSERT(std::abs(double(view_importance(point, options)) - lit * expected) <= error);
        options.least_cosine = T(-2);
        RC_ASSERT(std::abs(double(view_importance(point, options)) - expected) <= error);

        // forward: the same functions of a texel's surface
        const T depth = static_cast<T>(d.between(-1.5, 1.5));
        const T w = static_cast<T>(d.between(0.5, 8.0));
        const glm::vec<4, T> clip(T(0), T(0), depth * w, w);
        const T z = clip.z / clip.w;
        const bool inside = clip.z >= -w && clip.z <= w;
        const T forward =
            forward_importance(clip, T(-1), T(1), point.edge, point.view_cosine, options);
        const T expected_forward = combined_importance(
            depth_importance(z, T(-1), T(1)), edge_importance(point.edge, options.alpha),
            normal_importance(point.view_cosine, options.beta), options);
        RC_ASSERT(forward == (inside ? expected_forward : T(0)));
    }));
}
