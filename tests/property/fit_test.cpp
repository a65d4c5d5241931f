// Properties of warpshadow/fit.hpp. u is the unit roundoff of T.
#include "warp_oracle.hpp"

#include <warpshadow/fit.hpp>

#include <catch2/catch.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

template <typename T> using points = std::vector<glm::vec<2, T>>;

template <typename T> std::span<const glm::vec<2, T>> span_of(const points<T>& p) {
    return p;
}

template <typename T> bool inside(T x) {
    return x >= T(0) && x <= T(1);
}

/// A coordinate of [0, 1]: ends, their neighbours, powers of two, or any.
template <typename T> T any_share(dice& d) {
    switch (d.between(0, 4)) {
    case 0:
        return T(d.between(0, 1));
    case 1:
        return d.coin() ? std::nextafter(T(1), T(0)) : std::nextafter(T(0), T(1));
    case 2:
        return static_cast<T>(std::exp2(d.between(-40.0, 0.0)));
    case 3:
        return T(1) - static_cast<T>(std::exp2(d.between(-40.0, 0.0)));
    default:
        return static_cast<T>(d.unit());
    }
}

/// What every desired view is: a rectangle of the map that has a crop.
template <typename T> bool usable(const map_rect<T>& r) {
    return r.lo.x >= T(0) && r.lo.y >= T(0) && r.hi.x <= T(1) && r.hi.y <= T(1) &&
           r.hi.x - r.lo.x >= smallest_desired_extent<T> &&
           r.hi.y - r.lo.y >= smallest_desired_extent<T>;
}

/// A light matrix of any kind: nothing about it matters but that it is finite.
template <typename T> glm::mat<4, 4, T> any_matrix(dice& d) {
    glm::mat<4, 4, T> m(T(0));
    const double size = std::exp2(d.between(-10.0, 10.0));
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            m[column][row] = static_cast<T>(d.between(-size, size));
        }
    }
    if (d.coin()) { // orthographic
        for (int column = 0; column < 4; ++column) {
            m[column].w = column == 3 ? T(1) : T(0);
        }
    }
    return m;
}

template <typename T> bool same_bits(const glm::mat<4, 4, T>& a, const glm::mat<4, 4, T>& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

template <typename T> bool finite(const glm::mat<4, 4, T>& m) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(m[column][row])) {
                return false;
            }
        }
    }
    return true;
}

} // namespace

// ---------------------------------------------------------------------------------- desired view

TEMPLATE_TEST_CASE("desired_view without a margin: the bounds of the samples, to the bit", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        points<T> samples;
        const int count = d.between(2, 100);
        for (int i = 0; i < count; ++i) {
            samples.push_back({static_cast<T>(d.unit()), static_cast<T>(d.unit())});
        }
        const auto by_x = [](const auto& a, const auto& b) { return a.x < b.x; };
        const auto by_y = [](const auto& a, const auto& b) { return a.y < b.y; };
        const auto x = std::minmax_element(samples.begin(), samples.end(), by_x);
        const auto y = std::minmax_element(samples.begin(), samples.end(), by_y);
        const map_rect<T> bounds{{x.first->x, y.first->y}, {x.second->x, y.second->y}};
        RC_PRE(bounds.hi.x - bounds.lo.x >= smallest_desired_extent<T>);
        RC_PRE(bounds.hi.y - bounds.lo.y >= smallest_desired_extent<T>);
        for (int round = 0; round < 2; ++round) {
            const desired_view_result<T> result = desired_view(span_of(samples), T(0));
            RC_ASSERT(result.rect.lo == bounds.lo);
            RC_ASSERT(result.rect.hi == bounds.hi);
            RC_ASSERT(result.counted == samples.size());
            RC_ASSERT(result.rejected == 0u);
            RC_ASSERT(result.flags == status::ok);
            std::shuffle(samples.begin(), samples.end(), std::mt19937_64(d.bits()));
        }
    }));
}

TEMPLATE_TEST_CASE("desired_view with a margin: each end moves by its share, cut at the map", "",
                   float, double) {
    using T = TestType;
    const double u = roundoff<T>();
    REQUIRE(rc::check([u] {
        dice d = any_dice();
        const T lo = static_cast<T>(d.between(0.0, 0.9));
        const T hi = static_cast<T>(double(lo) + d.between(0.001, 1.0) * (1.0 - double(lo)));
        const T margin = static_cast<T>(d.between(0.0, 1.0));
        const points<T> samples = {{lo, hi}, {hi, lo}};
        const desired_view_result<T> result = desired_view(span_of(samples), margin);
        RC_ASSERT(result.flags == status::ok);
        const rational grow = (rational(hi) - rational(lo)) * rational(margin);
        const rational expected_lo = std::max(rational(0), rational(rational(lo) - grow));
        const rational expected_hi = std::min(rational(1), rational(rational(hi) + grow));
        // extent, product and sum are rounded, each a number of at most 2
        const rational bound(4.0 * u);
        RC_ASSERT(abs(rational(result.rect.lo.x) - expected_lo) <= bound);
        RC_ASSERT(abs(rational(result.rect.hi.x) - expected_hi) <= bound);
        RC_ASSERT(result.rect.lo.x == result.rect.lo.y);
        RC_ASSERT(result.rect.hi.x == result.rect.hi.y);
        RC_ASSERT(result.rect.lo.x <= lo);
        RC_ASSERT(result.rect.hi.x >= hi);
    }));
    // margins that are none
    const points<T> samples = {{T(0.25), T(0.25)}, {T(0.5), T(0.5)}};
    const auto rect = [&](T margin) { return desired_view(span_of(samples), margin).rect; };
    for (const T none : {T(0), T(-0.0), T(-1), std::numeric_limits<T>::quiet_NaN(),
                         -std::numeric_limits<T>::infinity()}) {
        REQUIRE(rect(none).lo == samples[0]);
        REQUIRE(rect(none).hi == samples[1]);
    }
    for (const T all : {T(1), T(2), std::numeric_limits<T>::infinity()}) {
        REQUIRE(rect(all).lo == glm::vec<2, T>(T(0)));
        REQUIRE(rect(all).hi == glm::vec<2, T>(T(0.75)));
    }
}

TEMPLATE_TEST_CASE("no sample gives the whole map, one sample the smallest view around it", "",
                   float, double) {
    using T = TestType;
    const desired_view_result<T> empty = desired_view(std::span<const glm::vec<2, T>>(), T(0.1));
    REQUIRE(empty.flags == status::empty_importance);
    REQUIRE(empty.counted == 0);
    REQUIRE(empty.rect.lo == glm::vec<2, T>(T(0)));
    REQUIRE(empty.rect.hi == glm::vec<2, T>(T(1)));
    const points<T> outside = {{T(-1e-9), T(0.5)}, {T(0.5), T(2)}};
    const desired_view_result<T> rejected = desired_view(span_of(outside), T(0));
    REQUIRE(rejected.flags == (status::empty_importance | status::samples_rejected));
    REQUIRE(rejected.rejected == 2);
    REQUIRE(rejected.rect.lo == glm::vec<2, T>(T(0)));
    REQUIRE(rejected.rect.hi == glm::vec<2, T>(T(1)));

    for (const T x : {T(0), T(-0.0), T(1), T(0.5), T(1e-30), std::nextafter(T(1), T(0)), T(0x1p-17),
                      std::nextafter(T(0x1p-17), T(1)), T(0.3)}) {
        for (const T y : {T(0), T(1), T(0.7)}) {
            const points<T> one = {{x, y}};
            const desired_view_result<T> result = desired_view(span_of(one), T(0));
            CAPTURE(x, y, result.rect.lo.x, result.rect.hi.x);
            REQUIRE(result.flags == status::degenerate_extent);
            REQUIRE(usable(result.rect));
            REQUIRE(result.rect.lo.x <= x);
            REQUIRE(result.rect.hi.x >= x);
            REQUIRE(result.rect.lo.y <= y);
            REQUIRE(result.rect.hi.y >= y);
            // the smallest side, but for the rounding of its ends
            REQUIRE(double(result.rect.hi.x) - double(result.rect.lo.x) <=
                    0x1p-16 + 4.0 * roundoff<T>());
            const glm::vec<2, T> cropped = crop(result.rect, one[0]);
            REQUIRE(inside(cropped.x));
            REQUIRE(inside(cropped.y));
        }
    }
    // flat in one direction only
    const points<T> flat = {{T(0.25), T(0.5)}, {T(0.75), T(0.5)}};
    const desired_view_result<T> line = desired_view(span_of(flat), T(0));
    REQUIRE(line.flags == status::degenerate_extent);
    REQUIRE(line.rect.lo.x == T(0.25));
    REQUIRE(line.rect.hi.x == T(0.75));
    REQUIRE(line.rect.lo.y == T(0.5) - T(0x1p-17));
    REQUIRE(line.rect.hi.y == T(0.5) + T(0x1p-17));
}

TEMPLATE_TEST_CASE("J35, peers 24: any samples: those in the map are counted and inside the view",
                   "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        points<T> samples;
        std::uint64_t good = 0;
        const int count = d.between(0, 12);
        for (int i = 0; i < count; ++i) {
            glm::vec<2, T> p(any_coordinate<T>(d), any_coordinate<T>(d));
            if (d.coin()) {
                p = glm::vec<2, T>(any_share<T>(d), any_share<T>(d));
            }
            samples.push_back(p);
            good += inside(p.x) && inside(p.y) ? 1u : 0u;
        }
        const T margin = any_coordinate<T>(d);
        const desired_view_result<T> result = desired_view(span_of(samples), margin);
        RC_ASSERT(result.counted == good);
        RC_ASSERT(result.rejected == samples.size() - good);
        RC_ASSERT(any(result.flags, status::samples_rejected) == (result.rejected != 0));
        RC_ASSERT(any(result.flags, status::empty_importance) == (good == 0));
        RC_ASSERT(usable(result.rect));
        for (const glm::vec<2, T>& p : samples) {
            if (inside(p.x) && inside(p.y)) {
                RC_ASSERT(p.x >= result.rect.lo.x);
                RC_ASSERT(p.y >= result.rect.lo.y);
                RC_ASSERT(p.x <= result.rect.hi.x);
                RC_ASSERT(p.y <= result.rect.hi.y);
                // differences and quotients of ordered numbers keep their order when rounded
                const glm::vec<2, T> q = crop(result.rect, p);
                RC_ASSERT(inside(q.x));
                RC_ASSERT(inside(q.y));
            }
        }
    }));
}

TEMPLATE_TEST_CASE("widen_side: any side of [0, 1] grows to a usable one inside [0, 1]", "", float,
                   double) {
    using T = TestType;
    const T least = smallest_desired_extent<T>;
    dice d(31);
    for (int i = 0; i < 20000; ++i) {
        T lo = any_share<T>(d);
        T hi = any_share<T>(d);
        if (d.coin()) { // short sides, of about the smallest extent and less
            hi = lo + static_cast<T>(std::exp2(d.between(-40.0, -15.0)));
            hi = hi < T(1) ? hi : T(1);
        }
        if (lo > hi) {
            std::swap(lo, hi);
        }
        const T margin = d.coin() ? T(0) : any_share<T>(d);
        T wide_lo = T(-7);
        T wide_hi = T(-7);
        const bool widened = widen_side(lo, hi, margin, wide_lo, wide_hi);
        CAPTURE(lo, hi, margin, wide_lo, wide_hi);
        REQUIRE(widened == (hi - lo < least));
        REQUIRE(wide_lo >= T(0));
        REQUIRE(wide_hi <= T(1));
        REQUIRE(wide_lo <= lo);
        REQUIRE(wide_hi >= hi);
        REQUIRE(wide_hi - wide_lo >= least);
    }
}

// ---------------------------------------------------------------------------------------- crop

TEMPLATE_TEST_CASE("crop scales a rectangle to the unit square, within three roundings", "", float,
                   double) {
    using T = TestType;
    const double u = roundoff<T>();
    REQUIRE(rc::check([u] {
        dice d = any_dice();
        map_rect<T> rect{};
        for (int axis = 0; axis < 2; ++axis) {
            rect.lo[axis] = any_share<T>(d);
            rect.hi[axis] = rect.lo[axis] + static_cast<T>(std::exp2(d.between(-16.0, 0.0)));
        }
        const glm::vec<2, T> p(static_cast<T>(d.between(-1.0, 2.0)),
                               static_cast<T>(d.between(-1.0, 2.0)));
        const glm::vec<2, T> actual = crop(rect, p);
        for (int axis = 0; axis < 2; ++axis) {
            const rational expected = (rational(p[axis]) - rational(rect.lo[axis])) /
                                      (rational(rect.hi[axis]) - rational(rect.lo[axis]));
            // two differences and a quotient, each off by a factor of 1 + u at most
            RC_ASSERT(abs(rational(actual[axis]) - expected) <= abs(expected) * rational(3.01 * u));
        }
        RC_ASSERT(crop(rect, rect.lo) == (glm::vec<2, T>(T(0))));
        RC_ASSERT(crop(rect, rect.hi) == (glm::vec<2, T>(T(1))));
    }));
}

TEMPLATE_TEST_CASE("crop_matrix projects a point to where crop puts its projection", "", float,
                   double) {
    using T = TestType;
    // an entry is built by at most six operations in double and rounded once to T
    const double entry_error = (std::is_same_v<T, float> ? roundoff<float>() : 0.0) + 7.0 * 0x1p-53;
    REQUIRE(rc::check([entry_error] {
        dice d = any_dice();
        const glm::mat<4, 4, T> light = any_matrix<T>(d);
        map_rect<T> rect{};
        for (int axis = 0; axis < 2; ++axis) {
            rect.lo[axis] = static_cast<T>(d.between(-0.5, 1.0));
            rect.hi[axis] = rect.lo[axis] + static_cast<T>(std::exp2(d.between(-16.0, 1.0)));
        }
        const crop_result<T> result = crop_matrix(light, rect);
        RC_ASSERT(result.flags == status::ok);
        const rational p[] = {rational(d.between(-10.0, 10.0)), rational(d.between(-10.0, 10.0)),
                              rational(d.between(-10.0, 10.0)), rational(1)};
        const auto project = [&p](const glm::mat<4, 4, T>& m, int row) {
            rational sum = 0;
            for (int column = 0; column < 4; ++column) {
                sum += rational(m[column][row]) * p[column];
            }
            return sum;
        };
        // depth is unchanged, and so is w
        for (int column = 0; column < 4; ++column) {
            RC_ASSERT(result.matrix[column].z == light[column].z);
            RC_ASSERT(result.matrix[column].w == light[column].w);
        }
        const rational w = project(light, 3);
        RC_PRE(w != 0);
        for (int axis = 0; axis < 2; ++axis) {
            const rational lo(rect.lo[axis]);
            const rational extent = rational(rect.hi[axis]) - lo;
            const rational map = (project(light, axis) / w + 1) / 2;
            const rational expected = (map - lo) / extent; // crop, without a rounding
            const rational actual = (project(result.matrix, axis) / w + 1) / 2;
            // each entry is a sum of two terms; their sizes, carried to the map
            rational terms = 0;
            for (int column = 0; column < 4; ++column) {
                terms += (abs(rational(light[column][axis])) / extent +
                          abs(rational(light[column].w)) * ((1 + 2 * abs(lo)) / extent + 1)) *
                         abs(p[column]);
            }
            RC_ASSERT(abs(actual - expected) <= rational(0.5 * entry_error) * terms / abs(w));
        }
    }));
}

TEMPLATE_TEST_CASE("crop_matrix: the whole map is the same matrix; the crops of halves are exact",
                   "", float, double) {
    using T = TestType;
    dice d(3);
    const glm::mat<4, 4, T> light = any_matrix<T>(d);
    const map_rect<T> all{glm::vec<2, T>(T(0)), glm::vec<2, T>(T(1))};
    REQUIRE(crop_matrix(light, all).matrix == light);
    REQUIRE(crop_matrix(light, all).flags == status::ok);
    const glm::mat<4, 4, T> one(T(1));
    const map_rect<T> half{glm::vec<2, T>(T(0), T(0.5)), glm::vec<2, T>(T(0.5), T(1))};
    const glm::mat<4, 4, T> cropped = crop_matrix(one, half).matrix;
    // NDC -1 to 0 in x and 0 to 1 in y
    REQUIRE(cropped * glm::vec<4, T>(T(-1), T(0), T(0.3), T(1)) ==
            glm::vec<4, T>(T(-1), T(-1), T(0.3), T(1)));
    REQUIRE(cropped * glm::vec<4, T>(T(0), T(1), T(0.3), T(1)) ==
            glm::vec<4, T>(T(1), T(1), T(0.3), T(1)));
}

TEMPLATE_TEST_CASE("crop_matrix: a rectangle without a crop leaves the matrix as it is", "", float,
                   double) {
    using T = TestType;
    using limits = std::numeric_limits<T>;
    dice d(5);
    const glm::mat<4, 4, T> light = any_matrix<T>(d);
    const auto refused = [&](T lo, T hi) {
        for (const map_rect<T>& rect :
             {map_rect<T>{{lo, T(0)}, {hi, T(1)}}, map_rect<T>{{T(0), lo}, {T(1), hi}}}) {
            const crop_result<T> result = crop_matrix(light, rect);
            CAPTURE(lo, hi);
            REQUIRE(result.flags == status::invalid_input);
            REQUIRE(same_bits(result.matrix, light));
        }
    };
    refused(T(0.5), T(0.5));
    refused(T(0.6), T(0.5));
    refused(limits::quiet_NaN(), T(1));
    refused(T(0), limits::quiet_NaN());
    refused(-limits::infinity(), T(1));
    refused(T(0), limits::infinity());
    refused(-limits::infinity(), limits::infinity());
    refused(T(0), limits::max());
    refused(limits::lowest(), limits::max());
    // so short that its reciprocal is not finite in T
    refused(T(0), limits::denorm_min());
}

TEMPLATE_TEST_CASE("crop_matrix: nothing that is not finite comes out of a finite matrix", "",
                   float, double) {
    using T = TestType;
    using limits = std::numeric_limits<T>;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const T numbers[] = {T(0),
                             T(1),
                             T(-1),
                             limits::max(),
                             limits::min(),
                             limits::lowest(),
                             limits::denorm_min(),
                             T(1e30),
                             limits::max() / T(4)};
        glm::mat<4, 4, T> light(T(1));
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row) {
                if (d.between(0, 3) == 0) {
                    light[column][row] = numbers[d.between(0, 8)];
                }
            }
        }
        map_rect<T> rect{};
        for (int axis = 0; axis < 2; ++axis) {
            rect.lo[axis] = any_coordinate<T>(d);
            rect.hi[axis] = d.coin()
                                ? any_coordinate<T>(d)
                                : rect.lo[axis] + static_cast<T>(std::exp2(d.between(-60.0, 21.0)));
        }
        const crop_result<T> result = crop_matrix(light, rect);
        RC_ASSERT(finite(result.matrix));
        RC_ASSERT(result.flags == status::ok || same_bits(result.matrix, light));
    }));
    // a matrix that is not finite comes back as it is
    for (const T bad : {limits::quiet_NaN(), limits::infinity()}) {
        glm::mat<4, 4, T> light(T(1));
        light[2].x = bad;
        const map_rect<T> rect{glm::vec<2, T>(T(0.25)), glm::vec<2, T>(T(0.5))};
        const crop_result<T> result = crop_matrix(light, rect);
        REQUIRE(result.flags == status::invalid_input);
        REQUIRE(same_bits(result.matrix, light));
    }
}
