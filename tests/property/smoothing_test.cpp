// Properties of warpshadow/smoothing.hpp.
#include "warp_oracle.hpp"

#include <warpshadow/smoothing.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

/// Half-widths from 0 to far beyond the map.
int any_radius(dice& d, int rows) {
    const int special[] = {-5,
                           0,
                           1,
                           rows - 1,
                           rows,
                           rows + 1,
                           3 * rows,
                           std::numeric_limits<int>::max(),
                           std::numeric_limits<int>::min()};
    const int i = d.between(0, 17);
    return i < 9 ? special[i] : d.between(0, rows);
}

/// Whether row y is in the window of row `centre`, with integers that cannot overflow.
bool in_window(int y, int centre, int radius) {
    return std::abs(std::int64_t(y) - centre) <= std::max(radius, 0);
}

} // namespace

TEST_CASE("peers 28: row_window is the direct sum of the rows in reach, at borders too") {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(64);
        const int height = d.size(48);
        const owned_counts c = any_counts(d, width, height);
        const int radius = any_radius(d, height);
        const std::size_t n = static_cast<std::size_t>(width);
        // more memory than needed: what is behind must stay
        std::vector<std::uint64_t> memory(n + 2, 99u);
        row_window window(c.view(), radius, memory);
        for (int row = 0; row < height; ++row) {
            RC_ASSERT(window.row() == row);
            RC_ASSERT(window.sums().size() == n);
            std::uint64_t total = 0;
            for (int i = 0; i < width; ++i) {
                std::uint64_t sum = 0;
                for (int y = 0; y < height; ++y) {
                    sum += in_window(y, row, radius) ? c.at(i, y) : 0u;
                }
                RC_ASSERT(window.sums()[static_cast<std::size_t>(i)] == sum);
                total += sum;
            }
            RC_ASSERT(window.total() == total);
            if (row + 1 < height) {
                window.advance();
            }
        }
        RC_ASSERT(memory[n] == 99u);
        RC_ASSERT(memory[n + 1] == 99u);
    }));
}

// Milet et al. 2015, §3.1: the functions of neighbouring rows are averaged, weighted by the number
// of view samples of each. The literal average is taken here, in rational numbers, and compared
// with the prefix sum of the summed counts: they are equal, not merely close.
TEST_CASE("the average of row functions weighted by samples is the scan of the summed counts") {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(24);
        const int height = d.size(16);
        const owned_counts c = any_counts(d, width, height);
        const int radius = any_radius(d, height);

        // functions of the single rows, F_y(k) = g_y(k) / N(y); a row without samples has none
        std::vector<std::uint64_t> row_total(static_cast<std::size_t>(height), 0u);
        std::vector<std::vector<rational>> function(static_cast<std::size_t>(height));
        for (int y = 0; y < height; ++y) {
            const auto row = static_cast<std::size_t>(y);
            for (int i = 0; i < width; ++i) {
                row_total[row] += c.at(i, y);
            }
            std::uint64_t before = 0;
            for (int k = 0; k <= width && row_total[row] != 0; ++k) {
                function[row].push_back(rational(integer(before), integer(row_total[row])));
                before += k < width ? c.at(k, y) : 0u;
            }
        }

        std::vector<std::uint64_t> memory(static_cast<std::size_t>(width));
        row_window window(c.view(), radius, memory);
        for (int centre = 0; centre < height; ++centre) {
            std::uint64_t before = 0;
            for (int k = 0; k <= width; ++k) {
                rational weighted = 0;
                integer weights = 0;
                for (int y = 0; y < height; ++y) {
                    const auto row = static_cast<std::size_t>(y);
                    if (in_window(y, centre, radius) && row_total[row] != 0) {
                        weighted += function[row][static_cast<std::size_t>(k)] * row_total[row];
                        weights += row_total[row];
                    }
                }
                RC_ASSERT(weights == window.total());
                if (weights != 0) {
                    RC_ASSERT(weighted / weights == rational(integer(before), weights));
                }
                before += k < width ? window.sums()[static_cast<std::size_t>(k)] : 0u;
            }
            if (centre + 1 < height) {
                window.advance();
            }
        }
    }));
}

TEST_CASE("J40: a window over all rows has the same sums at every row") {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int height = d.size(40);
        const owned_counts c = any_counts(d, d.size(64), height);
        const int radius = height - 1 + d.between(0, 2) * d.between(0, 1000);
        std::vector<std::uint64_t> memory(static_cast<std::size_t>(c.width));
        row_window window(c.view(), radius, memory);
        const std::vector<std::uint64_t> first(window.sums().begin(), window.sums().end());
        for (int row = 1; row < height; ++row) {
            window.advance();
            RC_ASSERT(std::equal(first.begin(), first.end(), window.sums().begin()));
        }
    }));
}

TEST_CASE("J33: sums of full counters are exact") {
    // 4096 rows of counters at 2^32 - 1: sums of 2^44, which neither 32 bits nor float hold
    owned_counts c(3, 4096);
    std::fill(c.counts.begin(), c.counts.end(), largest_count);
    std::vector<std::uint64_t> memory(3);
    row_window window(c.view(), 4096, memory);
    for (int row = 0; row < 4096; ++row) {
        for (const std::uint64_t sum : window.sums()) {
            REQUIRE(sum == 4096ull * largest_count);
        }
        REQUIRE(window.total() == 3ull * 4096ull * largest_count);
        if (row < 4095) {
            window.advance();
        }
    }
    // a window that has moved over all of them holds what its last rows hold
    row_window narrow(c.view(), 1, memory);
    for (int row = 0; row < 4095; ++row) {
        narrow.advance();
    }
    REQUIRE(narrow.total() == 3ull * 2ull * largest_count);
}

TEMPLATE_TEST_CASE("window_radius is half the share of the rows, within [0, rows]", "", float,
                   double) {
    using T = TestType;
    using limits = std::numeric_limits<T>;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int rows = d.coin() ? d.size(4096) : d.between(1, std::numeric_limits<int>::max());
        const T share = any_coordinate<T>(d);
        const int radius = window_radius(share, rows);
        RC_ASSERT(radius >= 0);
        RC_ASSERT(radius <= rows);
        if (share >= T(0) && share <= T(2)) {
            const rational exact = rational(share) * rows / 2;
            // the floor of a product that is rounded once, in double
            RC_ASSERT(rational(radius) <= exact * (1 + rational(roundoff<double>())));
            RC_ASSERT(exact < radius + 1);
        }
    }));
    for (const int rows : {1, 2, 1000, 4096}) {
        CAPTURE(rows);
        REQUIRE(window_radius(T(0), rows) == 0);
        REQUIRE(window_radius(T(-1), rows) == 0);
        REQUIRE(window_radius(limits::quiet_NaN(), rows) == 0);
        REQUIRE(window_radius(-limits::infinity(), rows) == 0);
        REQUIRE(window_radius(T(2), rows) == rows);
        REQUIRE(window_radius(T(3), rows) == rows);
        REQUIRE(window_radius(limits::infinity(), rows) == rows);
        REQUIRE(window_radius(limits::max(), rows) == rows);
        REQUIRE(window_radius(T(1), rows) == rows / 2);
    }
    REQUIRE(window_radius(T(0.12), 512) == 30);
}

namespace {

/// Weight of row y in the window of row `centre`: ways to get there by steps of at most `radius`
/// that stay on the map.
integer window_weight(int y, int centre, int radius, int rows, int passes) {
    if (passes == 1) {
        return in_window(y, centre, radius) ? 1 : 0;
    }
    integer weight = 0;
    for (int z = 0; z < rows; ++z) {
        if (in_window(z, centre, radius)) {
            weight += window_weight(y, z, radius, rows, passes - 1);
        }
    }
    return weight;
}

template <int Passes> void check_box_sums() {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(12);
        const int height = d.size(14);
        const owned_counts c = any_counts(d, width, height);
        const int radius = std::max(any_radius(d, height), 0);
        const int shift = d.coin() ? 0 : d.between(0, 31);
        const int first = d.between(0, height - 1);
        const auto n = static_cast<std::size_t>(width);
        std::vector<std::uint64_t> memory(n * box_sums<Passes>::memory + 2, 99u);
        box_sums<Passes> window(c.view(), radius, shift, first,
                                std::span(memory).first(n * box_sums<Passes>::memory));
        for (int row = first; row < height; ++row) {
            RC_ASSERT(window.row() == row);
            integer total = 0;
            for (int i = 0; i < width; ++i) {
                integer sum = 0;
                for (int y = 0; y < height; ++y) {
                    sum += window_weight(y, row, radius, height, Passes) *
                           integer(c.at(i, y) >> shift);
                }
                RC_ASSERT(integer(window.sums()[static_cast<std::size_t>(i)]) == sum);
                total += sum;
            }
            RC_ASSERT(integer(window.total()) == total);
            if (row + 1 < height) {
                window.advance();
            }
        }
        RC_ASSERT(memory[memory.size() - 2] == 99u);
        RC_ASSERT(memory[memory.size() - 1] == 99u);
    }));
}

} // namespace

TEST_CASE("box_sums<1> from any row is the direct sum") {
    check_box_sums<1>();
}
TEST_CASE("box_sums<2> from any row is the sum weighted by a tent, cut at the border") {
    check_box_sums<2>();
}
TEST_CASE("box_sums<3> from any row is the sum weighted by three boxes, cut at the border") {
    check_box_sums<3>();
}

TEST_CASE("a tent and a bell away from the border are what their names say") {
    owned_counts c(1, 41);
    c.at(0, 20) = 1;
    std::vector<std::uint64_t> memory(7);
    box_sums<2> tent(c.view(), 3, 0, 0, memory);
    for (int y = 0; y < 41; ++y) {
        CHECK(tent.sums()[0] == static_cast<std::uint64_t>(std::max(7 - std::abs(y - 20), 0)));
        if (y < 40) {
            tent.advance();
        }
    }
    // the standard deviation asked for, within the step of a whole radius
    for (const window_shape shape :
         {window_shape::box, window_shape::tent, window_shape::gaussian}) {
        for (double deviation = 0.0; deviation < 50.0; deviation += 0.37) {
            const double r = radius_for_deviation(deviation, shape);
            const auto variance = [&](double radius) {
                return box_passes(shape) * radius * (radius + 1.0) / 3.0;
            };
            CHECK(variance(r - 0.5) <= deviation * deviation + 1e-9);
            CHECK(variance(r + 0.5) >= deviation * deviation - 1e-9);
        }
        CHECK(radius_for_deviation(-1.0, shape) == 0);
        CHECK(radius_for_deviation(std::nan(""), shape) == 0);
        CHECK(radius_for_deviation(1e300, shape) == 1 << 30);
    }
}

TEST_CASE("J40: every shape ends at the sums that all rows share, times a constant") {
    dice d(11);
    const owned_counts c = any_counts(d, 9, 13);
    std::vector<std::uint64_t> memory(9 * 7);
    std::vector<std::uint64_t> once(9);
    row_window all(c.view(), 13, once);
    box_sums<3> bell(c.view(), 12, 0, 0, memory);
    for (int y = 0; y < 13; ++y) {
        for (std::size_t i = 0; i < 9; ++i) {
            REQUIRE(bell.sums()[i] == 169 * all.sums()[i]);
        }
        if (y < 12) {
            bell.advance();
        }
    }
}

TEST_CASE("window_shift keeps weighted sums in their bits, and is 0 for all counts of a box") {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int bits = d.between(0, 1) == 0 ? 32 : 63;
        const std::uint64_t samples = d.bits() >> d.between(64 - bits, 63);
        const int rows = d.size(32768);
        const int radius = any_radius(d, rows) < 0 ? 0 : any_radius(d, rows) & 0x7fffffff;
        for (const window_shape shape :
             {window_shape::box, window_shape::tent, window_shape::gaussian}) {
            const int shift = window_shift(samples, radius, rows, shape, bits);
            const integer widest = std::min(2 * integer(radius) + 1, integer(rows));
            integer weight = 1;
            for (int pass = 1; pass < box_passes(shape); ++pass) {
                weight *= widest;
            }
            const integer limit = integer(1) << bits;
            RC_ASSERT(integer(samples >> shift) * weight <= limit);
            if (shift > 0) {
                RC_ASSERT(integer(samples >> (shift - 1)) * weight > limit / 2);
            }
        }
    }));
    CHECK(window_shift(std::uint64_t(1) << 28, 4096, 4096, window_shape::tent) == 0);
}
