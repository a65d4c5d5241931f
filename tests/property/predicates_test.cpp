// Properties of warpshadow/predicates.hpp, against whole numbers of any size.
#include "exact_geometry.hpp"

#include <warpshadow/predicates.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace warpshadow;

namespace {

template <typename T>
int exact_sign(const glm::vec<2, T>& a, const glm::vec<2, T>& b, const glm::vec<2, T>& c) {
    const std::array<glm::vec<2, T>, 3> points{a, b, c};
    const exact::grid_points grid = exact::on_grid<T>(points);
    return exact::cross(grid.points[0], grid.points[1], grid.points[2]).sign();
}

/// Any finite value: every exponent, subnormal numbers too, is as likely as any other.
template <typename T> T any_finite() {
    using bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    const T x = std::bit_cast<T>(*rc::gen::arbitrary<bits>());
    return std::isfinite(x) ? x : T(0);
}

template <typename T> T between(T lo, T hi) {
    const double t = static_cast<double>(*rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 53));
    return static_cast<T>(double(lo) + (double(hi) - double(lo)) * t * 0x1p-53);
}

template <typename T> T moved_by_ulps(T x) {
    for (int n = *rc::gen::inRange(-2, 3); n != 0; n += n < 0 ? 1 : -1) {
        x = std::nextafter(x, n < 0 ? std::numeric_limits<T>::lowest()
                                    : std::numeric_limits<T>::max());
    }
    return x;
}

/// Three points on a line, rounded, then moved by up to two ulps.
template <typename T> std::array<glm::vec<2, T>, 3> almost_collinear(T reach) {
    const glm::vec<2, T> a(between<T>(-reach, reach), between<T>(-reach, reach));
    const glm::vec<2, T> b(between<T>(-reach, reach), between<T>(-reach, reach));
    const double t = between<double>(-2.0, 2.0);
    volatile T x = static_cast<T>(double(a.x) + t * (double(b.x) - double(a.x)));
    volatile T y = static_cast<T>(double(a.y) + t * (double(b.y) - double(a.y)));
    return {a, b, {moved_by_ulps<T>(x), moved_by_ulps<T>(y)}};
}

template <typename T> void check_exact(const std::array<glm::vec<2, T>, 3>& p) {
    const int sign = exact_sign(p[0], p[1], p[2]);
    RC_ASSERT(orient2d(p[0], p[1], p[2]) == sign);
    // Every order of the points gives the same answer or its opposite.
    RC_ASSERT(orient2d(p[1], p[2], p[0]) == sign);
    RC_ASSERT(orient2d(p[2], p[0], p[1]) == sign);
    RC_ASSERT(orient2d(p[1], p[0], p[2]) == -sign);
    RC_ASSERT(orient2d(p[0], p[2], p[1]) == -sign);
    RC_ASSERT(orient2d(p[2], p[1], p[0]) == -sign);
}

} // namespace

TEMPLATE_TEST_CASE("orient2d is exact", "[predicates]", float, double) {
    using T = TestType;
    REQUIRE(
        rc::check("almost collinear, |x| <= 1", [] { check_exact(almost_collinear<T>(T(1))); }));
    REQUIRE(rc::check("almost collinear, |x| <= 1000",
                      [] { check_exact(almost_collinear<T>(T(1000))); }));
    REQUIRE(rc::check("any finite numbers", [] {
        std::array<glm::vec<2, T>, 3> p;
        for (glm::vec<2, T>& q : p) {
            q = {any_finite<T>(), any_finite<T>()};
        }
        check_exact(p);
    }));
    REQUIRE(rc::check("almost collinear, exponents far apart", [] {
        // b and c are nearly the same direction as seen from a point close to a.
        std::array<glm::vec<2, T>, 3> p = almost_collinear<T>(T(1));
        constexpr int reach = std::numeric_limits<T>::max_exponent - 4;
        const int n = *rc::gen::inRange(-reach, reach);
        for (glm::vec<2, T>& q : p) {
            q = {std::ldexp(q.x, n), std::ldexp(q.y, n)};
        }
        p[0] = {std::ldexp(p[0].x, -60), std::ldexp(p[0].y, -60)};
        check_exact(p);
    }));
}

TEMPLATE_TEST_CASE("J27: the counter-example to plain double", "[predicates]", float, double) {
    using T = TestType;
    const glm::vec<2, T> a(T(1297), T(3409));
    const glm::vec<2, T> b(T(648.5), T(1704.5));
    const glm::vec<2, T> c(T(0x1.444p-19), T(0x1.aa2002p-18));
    REQUIRE(exact_sign(a, b, c) == -1);
    CHECK(orient2d(a, b, c) == -1);
    CHECK(orient2d(b, a, c) == 1);
    CHECK(orient2d(c, a, b) == -1);
}

TEMPLATE_TEST_CASE("J27: exact multiples of a vector are collinear, an ulp off them is not",
                   "[predicates]", float, double) {
    using T = TestType;
    constexpr T top = std::numeric_limits<T>::max();
    REQUIRE(rc::check([] {
        const auto x = static_cast<T>(*rc::gen::inRange(1, 4096));
        const auto y = static_cast<T>(*rc::gen::inRange(1, 4096));
        const auto k = static_cast<T>(*rc::gen::inRange(2, 2048));
        const glm::vec<2, T> o(T(0), T(0));
        const glm::vec<2, T> a(x, y);
        const glm::vec<2, T> b(k * x, k * y);
        RC_ASSERT(orient2d(o, a, b) == 0);
        RC_ASSERT(orient2d(o, a, glm::vec<2, T>(b.x, std::nextafter(b.y, top))) == 1);
        RC_ASSERT(orient2d(o, a, glm::vec<2, T>(b.x, std::nextafter(b.y, T(0)))) == -1);
        RC_ASSERT(orient2d(o, a, glm::vec<2, T>(std::nextafter(b.x, top), b.y)) == -1);
    }));
}

TEMPLATE_TEST_CASE("J27: 2^-100 and 2^100 mixed are exact", "[predicates]", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        std::array<glm::vec<2, T>, 3> p;
        for (glm::vec<2, T>& q : p) {
            q = {std::ldexp(between<T>(T(-1), T(1)), *rc::gen::inRange(-100, 101)),
                 std::ldexp(between<T>(T(-1), T(1)), *rc::gen::inRange(-100, 101))};
        }
        check_exact(p);
    }));
}

TEMPLATE_TEST_CASE("orient2d at the ends of the range", "[predicates]", float, double) {
    using T = TestType;
    constexpr T big = std::numeric_limits<T>::max();
    constexpr T small = std::numeric_limits<T>::denorm_min();
    using P = glm::vec<2, T>;
    CHECK(orient2d(P(-big, -big), P(big, -big), P(big, big)) == 1);
    CHECK(orient2d(P(-big, -big), P(big, big), P(T(0), T(0))) == 0);
    CHECK(orient2d(P(-big, -big), P(big, big), P(T(0), small)) == 1);
    CHECK(orient2d(P(-big, -big), P(big, big), P(small, T(0))) == -1);
    CHECK(orient2d(P(T(0), T(0)), P(small, T(0)), P(T(0), small)) == 1);
    CHECK(orient2d(P(T(0), T(0)), P(small, small), P(T(2) * small, T(2) * small)) == 0);
    CHECK(orient2d(P(T(0), T(0)), P(small, small), P(T(3) * small, T(2) * small)) == -1);
    CHECK(orient2d(P(-small, T(0)), P(big, small), P(T(0), T(0))) == -1);
}

TEMPLATE_TEST_CASE("orient2d of a NaN or an infinity is 0", "[predicates]", float, double) {
    using T = TestType;
    for (const T bad : {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity(),
                        -std::numeric_limits<T>::infinity()}) {
        for (int at = 0; at < 6; ++at) {
            std::array<T, 6> v{T(0), T(0), T(4), T(1), T(1), T(5)};
            v[static_cast<std::size_t>(at)] = bad;
            CHECK(orient2d<T>({v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}) == 0);
        }
    }
}

TEMPLATE_TEST_CASE("J23: scaling by a power of two changes no answer", "[predicates]", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const std::array<glm::vec<2, T>, 3> p = almost_collinear<T>(T(1));
        const T scale = std::ldexp(T(1), *rc::gen::inRange(-20, 21));
        RC_ASSERT(orient2d(p[0], p[1], p[2]) == orient2d(scale * p[0], scale * p[1], scale * p[2]));
    }));
}

TEST_CASE("snapped points are near, and plain double is exact for them", "[predicates]") {
    REQUIRE(rc::check([] {
        const double extent = std::ldexp(between<double>(0.5, 1.0), *rc::gen::inRange(-100, 100));
        const double origin = extent * between<double>(-100.0, 100.0);
        const double step = snap_step(extent);
        RC_ASSERT(step > extent * 0x1p-27);
        RC_ASSERT(step <= extent * 0x1p-25);
        int exponent = 0;
        RC_ASSERT(std::frexp(step, &exponent) == 0.5); // a power of two

        // a, b and a point close to their line, all within the extent
        std::array<glm::dvec2, 3> p;
        p[0] = {between<double>(0.0, 1.0), between<double>(0.0, 1.0)};
        p[1] = {between<double>(0.0, 1.0), between<double>(0.0, 1.0)};
        const double t = between<double>(0.0, 1.0);
        p[2] = (1.0 - t) * p[0] + t * p[1];
        std::array<glm::dvec2, 3> snapped;
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = origin + extent * p[i];
            snapped[i] = snap(p[i], step);
            // Half a step; both points are doubles, so that this difference is exact.
            RC_ASSERT(std::abs(snapped[i].x - p[i].x) <= 0.5 * step);
            RC_ASSERT(std::abs(snapped[i].y - p[i].y) <= 0.5 * step);
            RC_ASSERT(snap(snapped[i], step) == snapped[i]);
        }
        const int sign = exact_sign(snapped[0], snapped[1], snapped[2]);
        RC_ASSERT(orient2d_snapped(snapped[0], snapped[1], snapped[2]) == sign);
        RC_ASSERT(orient2d(snapped[0], snapped[1], snapped[2]) == sign);
    }));
}

TEST_CASE("snapping with no extent changes nothing", "[predicates]") {
    const glm::dvec2 p(0.1, -0.7);
    for (const double extent : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN(), 0x1p-1000}) {
        CHECK(snap_step(extent) == 0.0);
        CHECK(snap(p, snap_step(extent)) == p);
    }
    CHECK(snap_step(1.0) == 0x1p-26);
    CHECK(snap_step(1.5) == 0x1p-25);
}
