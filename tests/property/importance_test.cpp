// Properties of warpshadow/importance.hpp.
#include "warp_oracle.hpp"

#include <warpshadow/importance.hpp>

#include <catch2/catch.hpp>
#include <glm/vec2.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

template <typename T> using points = std::vector<glm::vec<2, T>>;

template <typename T> std::span<const glm::vec<2, T>> span_of(const points<T>& p) {
    return p;
}

/// A share with few bits, so that its product with a number of cells is exact in T as well.
template <typename T> struct short_share {
    std::uint64_t numerator;
    T value;

    explicit short_share(dice& d)
        : numerator(d.bits() % ((1u << bits) + 1u)), value(T(numerator) / T(1u << bits)) {}

    /// The cell that holds it, in integers.
    [[nodiscard]] int cell(int cells) const {
        const std::uint64_t floor = (numerator * static_cast<std::uint64_t>(cells)) >> bits;
        return static_cast<int>(std::min(floor, static_cast<std::uint64_t>(cells) - 1));
    }

    // 11 bits and the 13 bits of 4096 make the 24 bits of float
    static constexpr unsigned bits = 11;
};

} // namespace

TEMPLATE_TEST_CASE("cell_of finds the cell that holds x, but for one rounding of x times cells", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(4096);
        T x = static_cast<T>(d.unit());
        if (d.coin()) {
            // on an edge or one step beside it
            x = T(d.between(0, cells)) / T(cells);
            x = d.coin() ? x : std::nextafter(x, d.coin() ? T(2) : T(-1));
        }
        const int cell = cell_of(x, cells);
        if (x < T(0) || x > T(1)) {
            RC_ASSERT(cell == -1);
            return;
        }
        RC_ASSERT(cell >= 0);
        RC_ASSERT(cell < cells);
        const rational exact = rational(x) * cells;
        const rational u = rational(roundoff<T>());
        RC_ASSERT(rational(cell) <= exact * (1 + u));
        RC_ASSERT(exact < cell + 1 || (x == T(1) && cell == cells - 1));
    }));
}

TEMPLATE_TEST_CASE("J35, peers 24: 0 and 1 are counted, what lies outside and NaN are rejected", "",
                   float, double) {
    using T = TestType;
    using limits = std::numeric_limits<T>;
    const T counted[] = {
        T(0),          T(-0.0), T(1), std::nextafter(T(1), T(0)), limits::denorm_min(),
        limits::min(), T(0.5)};
    const T rejected[] = {T(-1e-9),
                          std::nextafter(T(0), T(-1)),
                          std::nextafter(T(1), T(2)),
                          T(-1),
                          T(2),
                          limits::quiet_NaN(),
                          -limits::quiet_NaN(),
                          limits::infinity(),
                          -limits::infinity(),
                          limits::max(),
                          limits::lowest()};
    for (const int cells : {1, 2, 3, 1000, 4095, 4096}) {
        CAPTURE(cells);
        for (const T x : counted) {
            CAPTURE(x);
            const int cell = cell_of(x, cells);
            REQUIRE(cell >= 0);
            REQUIRE(cell < cells);
        }
        REQUIRE(cell_of(T(0), cells) == 0);
        REQUIRE(cell_of(T(-0.0), cells) == 0);
        REQUIRE(cell_of(limits::denorm_min(), cells) == 0);
        REQUIRE(cell_of(T(1), cells) == cells - 1);
        REQUIRE(cell_of(std::nextafter(T(1), T(0)), cells) == cells - 1);
        for (const T x : rejected) {
            CAPTURE(x);
            REQUIRE(cell_of(x, cells) == -1);
        }
    }

    owned_counts c(7, 5);
    points<T> samples;
    std::uint64_t good = 0;
    for (const T x : counted) {
        for (const T y : counted) {
            samples.push_back({x, y});
            ++good;
        }
        for (const T y : rejected) {
            samples.push_back({x, y});
            samples.push_back({y, x});
        }
    }
    for (const T x : rejected) {
        for (const T y : rejected) {
            samples.push_back({x, y});
        }
    }
    const splat_result result = splat(span_of(samples), c.map());
    REQUIRE(result.counted == good);
    REQUIRE(result.rejected == samples.size() - good);
    REQUIRE(result.flags == status::samples_rejected);
    std::uint64_t sum = 0;
    for (const std::uint32_t n : c.counts) {
        sum += n;
    }
    REQUIRE(sum == good);
}

TEMPLATE_TEST_CASE("splat counts every sample in its cell, adds, and knows no order", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(4096);
        const int height = d.size(std::clamp((1 << 16) / width, 1, 4096));
        owned_counts actual(width, height);
        owned_counts expected(width, height);
        for (std::size_t i = 0; i < actual.counts.size(); ++i) {
            actual.counts[i] = expected.counts[i] = static_cast<std::uint32_t>(d.between(0, 3));
        }
        points<T> samples;
        for (int i = 0; i < 300; ++i) {
            const short_share<T> x(d);
            const short_share<T> y(d);
            samples.push_back({x.value, y.value});
            ++expected.at(x.cell(width), y.cell(height));
        }
        const splat_result result = splat(span_of(samples), actual.map());
        RC_ASSERT(result.counted == samples.size());
        RC_ASSERT(result.rejected == 0u);
        RC_ASSERT(result.flags == status::ok);
        const bool as_expected = actual.counts == expected.counts;
        RC_ASSERT(as_expected);

        owned_counts once(width, height);
        owned_counts shuffled(width, height);
        splat(span_of(samples), once.map());
        std::shuffle(samples.begin(), samples.end(), std::mt19937_64(d.bits()));
        splat(span_of(samples), shuffled.map());
        const bool same = once.counts == shuffled.counts;
        RC_ASSERT(same);

        clear(once.map());
        RC_ASSERT(std::count(once.counts.begin(), once.counts.end(), 0u) ==
                  static_cast<std::ptrdiff_t>(once.counts.size()));
    }));
}

TEMPLATE_TEST_CASE("every sample is counted or rejected, whatever it is", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        owned_counts c(d.size(64), d.size(64));
        points<T> samples;
        std::uint64_t inside = 0;
        for (int i = 0; i < 200; ++i) {
            const glm::vec<2, T> p(any_coordinate<T>(d), any_coordinate<T>(d));
            samples.push_back(p);
            const auto in = [](T x) { return !std::isnan(x) && !(x < T(0)) && !(x > T(1)); };
            inside += in(p.x) && in(p.y) ? 1u : 0u;
        }
        const splat_result result = splat(span_of(samples), c.map());
        std::uint64_t sum = 0;
        for (const std::uint32_t n : c.counts) {
            sum += n;
        }
        RC_ASSERT(result.counted == inside);
        RC_ASSERT(sum == inside);
        RC_ASSERT(result.rejected == samples.size() - inside);
        RC_ASSERT(any(result.flags, status::samples_rejected) == (result.rejected != 0));
        RC_ASSERT(!any(result.flags, status::count_overflow));
    }));
}

TEMPLATE_TEST_CASE("J33: a counter stops at its largest value and says so", "", float, double) {
    using T = TestType;
    owned_counts c(2, 1);
    c.counts[0] = largest_count - 2;
    const points<T> samples(2, glm::vec<2, T>(T(0.25), T(0.5)));
    splat_result result = splat(span_of(samples), c.map());
    REQUIRE(c.counts[0] == largest_count);
    REQUIRE(result.flags == status::ok);
    REQUIRE(result.counted == 2);
    result = splat(span_of(samples), c.map());
    REQUIRE(c.counts[0] == largest_count);
    REQUIRE(c.counts[1] == 0);
    REQUIRE(result.flags == status::count_overflow);
    REQUIRE(result.counted == 2);
    REQUIRE(result.rejected == 0);
    // the neighbour of a full counter still counts
    const points<T> others(3, glm::vec<2, T>(T(0.75), T(0.5)));
    result = splat(span_of(others), c.map());
    REQUIRE(c.counts[1] == 3);
    REQUIRE(result.flags == status::ok);
}

TEMPLATE_TEST_CASE("a map that does not fit its memory is not written", "", float, double) {
    using T = TestType;
    const points<T> samples(3, glm::vec<2, T>(T(0.5), T(0.5)));
    const int huge = std::numeric_limits<int>::max();
    const struct {
        int width, height;
    } sizes[] = {{3, 2},       {5, 1},    {1, 5},   {0, 4},         {4, 0},
                 {0, 0},       {-1, 4},   {4, -1},  {-2, -2},       {huge, 1},
                 {huge, huge}, {1, huge}, {-1, -1}, {65536, 65536}, {-huge - 1, 2}};
    for (const auto& size : sizes) {
        CAPTURE(size.width, size.height);
        std::vector<std::uint32_t> memory(4, 77u);
        const count_map map{memory, size.width, size.height};
        REQUIRE_FALSE(fits(map));
        const splat_result result = splat(span_of(samples), map);
        REQUIRE(result.flags == status::buffer_too_small);
        REQUIRE(result.counted == 0);
        REQUIRE(result.rejected == samples.size());
        clear(map);
        REQUIRE(concentration(map) == 0.0);
        REQUIRE(memory == std::vector<std::uint32_t>(4, 77u));
    }
    // more memory than the map needs is left alone behind it
    std::vector<std::uint32_t> memory(6, 77u);
    const count_map map{memory, 2, 2};
    REQUIRE(fits(map));
    clear(map);
    REQUIRE(splat(span_of(samples), map).flags == status::ok);
    REQUIRE(memory == std::vector<std::uint32_t>{0u, 0u, 0u, 3u, 77u, 77u});
    REQUIRE(splat(std::span<const glm::vec<2, T>>(), map).flags == status::ok);
}

TEST_CASE("concentration is cells times the sum of squares over the square of the sum") {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(256);
        const owned_counts c = any_counts(d, width, d.size(std::max(1, 2048 / width)));
        integer sum = 0;
        integer squares = 0;
        for (const std::uint32_t n : c.counts) {
            sum += n;
            squares += integer(n) * n;
        }
        const double actual = concentration(c.view());
        if (sum == 0) {
            RC_ASSERT(actual == 0.0);
            return;
        }
        const auto cells = static_cast<double>(c.counts.size());
        const rational exact = rational(squares * c.counts.size(), sum * sum);
        // Each square is rounded once and each partial sum of squares once; Σn is exact below 2^53.
        // Behind the sums: one square, one product, one quotient.
        const double bound = (cells + 4.0) * roundoff<double>();
        RC_ASSERT(abs(rational(actual) - exact) <= exact * rational(bound));
        // by Cauchy and Schwarz
        RC_ASSERT(actual >= 1.0 - bound);
        RC_ASSERT(actual <= cells * (1.0 + bound));
    }));
    // its two ends
    owned_counts even(8, 4);
    std::fill(even.counts.begin(), even.counts.end(), largest_count);
    REQUIRE(concentration(even.view()) == 1.0);
    owned_counts one(8, 4);
    one.at(3, 2) = 12345;
    REQUIRE(concentration(one.view()) == 32.0);
}

namespace {

/// A sample with an importance of its own.
template <typename T> struct weighted_point {
    glm::vec<2, T> p;
    T weight;
};

template <typename T> struct stored_weight {
    T operator()(const weighted_point<T>& point) const { return point.weight; }
};

/// Steps of an importance as a whole number: the exact product, rounded up and cut.
template <typename T> std::uint32_t exact_steps(T weight, T steps) {
    if (!(weight > T(0))) {
        return 0;
    }
    if (std::isinf(weight)) {
        return 1u << 24;
    }
    // one rounding of the product, then whole numbers
    const rational product = rational(T(weight * steps));
    const integer limit = 1 << 24;
    integer whole =
        boost::multiprecision::numerator(product) / boost::multiprecision::denominator(product);
    whole += rational(whole) < product ? 1 : 0;
    return whole > limit ? (1u << 24) : whole.convert_to<std::uint32_t>();
}

} // namespace

TEMPLATE_TEST_CASE("an importance in steps is rounded up, at most 2^24, and never lost", "", float,
                   double) {
    using T = TestType;
    using limits = std::numeric_limits<T>;
    CHECK(weight_in_steps(limits::quiet_NaN(), T(256)) == 0u);
    CHECK(weight_in_steps(T(0), T(256)) == 0u);
    CHECK(weight_in_steps(T(-1), T(256)) == 0u);
    CHECK(weight_in_steps(limits::min(), T(256)) == 1u);
    CHECK(weight_in_steps(T(0.001), T(256)) == 1u); // the published alpha
    CHECK(weight_in_steps(T(1), T(256)) == 256u);
    CHECK(weight_in_steps(limits::max(), T(256)) == 1u << 24);
    CHECK(weight_in_steps(limits::infinity(), T(1)) == 1u << 24);
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const T weight = static_cast<T>(std::exp2(d.between(-40.0, 30.0)));
        const T steps = static_cast<T>(std::exp2(d.between(0, 16)));
        RC_ASSERT(weight_in_steps(weight, steps) == exact_steps(weight, steps));
    }));
}

TEMPLATE_TEST_CASE("weight_steps is the largest power of two whose sum stays below 2^32", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const std::uint64_t samples = d.bits() >> d.between(24, 63);
        const T largest = static_cast<T>(std::exp2(d.between(-3, 6))); // exact in T
        const T steps = weight_steps(samples, largest);
        int exponent = 0;
        RC_ASSERT(std::frexp(steps, &exponent) == T(0.5));
        RC_ASSERT(steps >= T(1));
        RC_ASSERT(steps <= T(65536));
        const rational limit = rational(integer(1) << 32);
        const auto sum = [&](T s) {
            return rational(integer(samples)) * (rational(s) * rational(largest) + 1);
        };
        RC_ASSERT(sum(steps) < limit || steps == T(1));
        RC_ASSERT(steps == T(65536) || sum(T(2) * steps) >= limit);
    }));
}

TEMPLATE_TEST_CASE("splat_weighted adds or keeps the largest, in any order, and accounts for all",
                   "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(40);
        const int height = d.size(40);
        const T steps = static_cast<T>(1 << d.between(0, 10));
        std::vector<weighted_point<T>> points;
        const int count = d.between(0, 400);
        for (int i = 0; i < count; ++i) {
            const T special[] = {T(0), T(-1), std::numeric_limits<T>::quiet_NaN(),
                                 std::numeric_limits<T>::infinity(), T(1e-30)};
            const T weight = d.between(0, 9) == 0 ? special[d.between(0, 4)]
                                                  : static_cast<T>(d.between(0.0, 6.0));
            points.push_back({{any_coordinate<T>(d), any_coordinate<T>(d)}, weight});
        }
        const cell_rule rule = d.coin() ? cell_rule::sum : cell_rule::largest;

        owned_counts expected(width, height);
        std::uint64_t inside = 0;
        std::uint64_t weight = 0;
        std::uint64_t weightless = 0;
        for (const weighted_point<T>& point : points) {
            const int i = cell_of(point.p.x, width);
            const int j = cell_of(point.p.y, height);
            if (i < 0 || j < 0 || std::isnan(point.weight)) {
                continue;
            }
            const std::uint32_t amount = exact_steps(point.weight, steps);
            ++inside;
            weight += amount;
            weightless += amount == 0 ? 1 : 0;
            std::uint32_t& cell = expected.at(i, j);
            const std::uint64_t sum = std::uint64_t(cell) + amount;
            cell = rule == cell_rule::largest
                       ? std::max(cell, amount)
                       : static_cast<std::uint32_t>(std::min<std::uint64_t>(sum, largest_count));
        }
        for (int turn = 0; turn < 2; ++turn) {
            owned_counts counts(width, height);
            const splat_result result =
                splat_weighted(std::span<const weighted_point<T>>(points), stored_weight<T>{},
                               steps, rule, counts.map());
            RC_ASSERT(counts.counts == expected.counts);
            RC_ASSERT(result.counted == inside);
            RC_ASSERT(result.rejected == points.size() - inside);
            RC_ASSERT(result.weight == weight);
            RC_ASSERT(result.weightless == weightless);
            RC_ASSERT(any(result.flags, status::samples_rejected) == (inside != points.size()));
            std::shuffle(points.begin(), points.end(), std::mt19937(7));
        }
    }));
}

TEST_CASE("splat_weighted: an importance of 1 in one step is splat, and guards are reported") {
    dice d(4);
    points<double> plain;
    std::vector<weighted_point<double>> weighted;
    for (int i = 0; i < 1000; ++i) {
        plain.push_back({any_coordinate<double>(d), any_coordinate<double>(d)});
        weighted.push_back({plain.back(), 1.0});
    }
    owned_counts a(17, 9);
    owned_counts b(17, 9);
    const splat_result plainly = splat(span_of(plain), a.map());
    const splat_result result =
        splat_weighted(std::span<const weighted_point<double>>(weighted), stored_weight<double>{},
                       1.0, cell_rule::sum, b.map());
    CHECK(a.counts == b.counts);
    CHECK(result.counted == plainly.counted);
    CHECK(result.rejected == plainly.rejected);
    CHECK(result.flags == plainly.flags);

    // peers 26: a counter near 2^32, and an importance beyond all steps
    owned_counts full(1, 1);
    full.at(0, 0) = largest_count - 10;
    const weighted_point<double> heavy[] = {{{0.5, 0.5}, 1e300}};
    const splat_result stopped =
        splat_weighted(std::span<const weighted_point<double>>(heavy), stored_weight<double>{}, 1.0,
                       cell_rule::sum, full.map());
    CHECK(full.at(0, 0) == largest_count);
    CHECK(stopped.flags == (status::count_overflow | status::out_of_range));
    const splat_result none =
        splat_weighted(std::span<const weighted_point<double>>(heavy), stored_weight<double>{}, 1.0,
                       cell_rule::sum, count_map{{}, 1, 1});
    CHECK(none.flags == status::buffer_too_small);
    CHECK(none.rejected == 1);
}

TEST_CASE("a blended count goes its share of the way, rounded up, and arrives") {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        std::uint32_t previous = static_cast<std::uint32_t>(d.bits()) >> d.between(0, 31);
        const std::uint32_t current = static_cast<std::uint32_t>(d.bits()) >> d.between(0, 31);
        const auto share = static_cast<std::uint32_t>(d.between(0, 65536));
        const integer way = integer(current) - integer(previous);
        const integer step = (abs(way) * share + 65535) / 65536;
        const integer expected = way > 0 ? integer(previous) + step : integer(previous) - step;
        const std::uint32_t blended = blended_count(previous, current, share);
        RC_ASSERT(integer(blended) == expected);
        RC_ASSERT(blended_count(previous, previous, share) == previous);
        RC_ASSERT(blended_count(previous, current, 65536u) == current);
        RC_ASSERT(blended_count(previous, current, 0u) == previous);
        // the way is a share of itself until a step is one: 2^32 (1 - 2^-4)^n < 16, n < 302
        if (share >= 4096) {
            for (int frame = 0; frame < 320; ++frame) {
                previous = blended_count(previous, current, share);
            }
            RC_ASSERT(previous == current);
        }
    }));
}

TEST_CASE("blend: cell by cell, shares are clamped, sizes must agree") {
    dice d(5);
    owned_counts current = any_counts(d, 13, 7);
    owned_counts map(13, 7);
    for (std::uint32_t& n : map.counts) {
        n = static_cast<std::uint32_t>(d.bits());
    }
    const owned_counts before = map;
    CHECK(blend(current.view(), -1, map.map()) == status::out_of_range);
    CHECK(map.counts == before.counts);
    CHECK(blend(current.view(), 20000, map.map()) == status::ok);
    for (std::size_t i = 0; i < map.counts.size(); ++i) {
        REQUIRE(map.counts[i] == blended_count(before.counts[i], current.counts[i], 20000u));
    }
    CHECK(blend(current.view(), 70000, map.map()) == status::out_of_range);
    CHECK(map.counts == current.counts);
    owned_counts other(7, 13);
    CHECK(blend(current.view(), 70000, other.map()) == status::buffer_too_small);
    CHECK(other.counts == owned_counts(7, 13).counts);
}
