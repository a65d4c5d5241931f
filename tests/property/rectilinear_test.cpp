// Properties of warpshadow/rectilinear.hpp, against sums in exact arithmetic.
#include "warp_oracle.hpp"

#include <warpshadow/rectilinear.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

using line = std::vector<std::uint64_t>;

template <typename T, typename Node> struct built_pair {
    std::vector<Node> u;
    std::vector<Node> v;
    build_result<T> result;

    built_pair(const owned_counts& c, const rectilinear_options<T>& options)
        : u(static_cast<std::size_t>(c.width) + 1), v(static_cast<std::size_t>(c.height) + 1) {
        line scratch(rectilinear_scratch(c.width, c.height));
        result = build_rectilinear<T, Node>(c.view(), options, scratch,
                                            table_span<T, Node>{u, c.width, 1},
                                            table_span<T, Node>{v, c.height, 1});
    }
};

template <typename Node> bool increases(const std::vector<Node>& nodes) {
    const Node one = std::is_integral_v<Node> ? std::numeric_limits<Node>::max() : Node(1);
    bool good = nodes.front() == Node(0) && nodes.back() == one;
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        good = good && nodes[k] < nodes[k + 1];
    }
    return good;
}

/// Element of a line that goes on mirrored at both ends.
std::uint64_t mirrored(const line& l, std::int64_t i) {
    const auto n = static_cast<std::int64_t>(l.size());
    while (i < 0 || i >= n) {
        i = i < 0 ? -1 - i : 2 * n - 1 - i;
    }
    return l[static_cast<std::size_t>(i)];
}

} // namespace

TEST_CASE("collapse: sums and largest of all columns and rows") {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const owned_counts c = any_counts(d, d.size(40), d.size(40));
        for (const cell_rule rule : {cell_rule::sum, cell_rule::largest}) {
            line u(static_cast<std::size_t>(c.width));
            line v(static_cast<std::size_t>(c.height));
            RC_ASSERT(collapse(c.view(), rule, u, v) == status::ok);
            line expected_u(u.size(), 0);
            line expected_v(v.size(), 0);
            for (int j = 0; j < c.height; ++j) {
                for (int i = 0; i < c.width; ++i) {
                    const std::uint64_t n = c.at(i, j);
                    for (std::uint64_t* all : {&expected_u[static_cast<std::size_t>(i)],
                                               &expected_v[static_cast<std::size_t>(j)]}) {
                        *all = rule == cell_rule::sum ? *all + n : std::max(*all, n);
                    }
                }
            }
            RC_ASSERT(u == expected_u);
            RC_ASSERT(v == expected_v);
        }
    }));
    owned_counts c(3, 2);
    line u(2);
    line v(2);
    CHECK(collapse(c.view(), cell_rule::sum, u, v) == status::buffer_too_small);
}

TEST_CASE("smooth_line: box and tent are exact, mirrored, and keep mass and uniformity") {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        line l(static_cast<std::size_t>(d.size(50)));
        const bool uniform = d.coin();
        const std::uint64_t value = d.bits() >> 34;
        integer mass = 0;
        for (std::uint64_t& x : l) {
            x = uniform ? value : d.bits() >> d.between(34, 63);
            mass += x;
        }
        const int radius = d.between(0, static_cast<int>(l.size()));
        const bool tent = d.coin();
        line smooth(l.size() + 1, 5);
        RC_ASSERT(smooth_line(std::span<const std::uint64_t>(l),
                              tent ? window_shape::tent : window_shape::box, double(radius),
                              smooth) == status::ok);
        const std::int64_t weight = tent ? std::int64_t(radius + 1) * (radius + 1) : 2 * radius + 1;
        integer all = 0;
        for (std::size_t i = 0; i < l.size(); ++i) {
            integer sum = 0;
            for (int k = -radius; k <= radius; ++k) {
                const integer w = tent ? radius + 1 - std::abs(k) : 1;
                sum += w * integer(mirrored(l, std::int64_t(i) + k));
            }
            RC_ASSERT(integer(smooth[i]) == sum);
            RC_ASSERT(!uniform || integer(smooth[i]) == integer(value) * weight);
            all += sum;
        }
        RC_ASSERT(all == mass * weight);
        RC_ASSERT(smooth.back() == 5);
    }));
}

TEST_CASE("smooth_line: a Gaussian within its whole weights, of exact mass") {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        line l(static_cast<std::size_t>(d.size(200)));
        integer mass = 0;
        double largest = 0.0;
        for (std::uint64_t& x : l) {
            x = d.bits() >> d.between(34, 63);
            mass += x;
            largest = std::max(largest, double(x));
        }
        const double sigma = d.between(0.1, double(l.size()));
        line smooth(l.size());
        RC_ASSERT(smooth_line(std::span<const std::uint64_t>(l), window_shape::gaussian, sigma,
                              smooth) == status::ok);
        integer all = 0;
        const int reach = static_cast<int>(9.0 * sigma) + 2;
        double bell = 0.0;
        for (int k = -reach; k <= reach; ++k) {
            bell += std::exp(-0.5 * k * k / (sigma * sigma));
        }
        // each weight is off by half a step, the centre by as much for each of the others, and
        // beyond 4.86 sigma weights are 0 that together are below 2^-19 of all
        const double error = largest * (2.0 * (4.9 * sigma + 1.0) + 1.0 + 0.125);
        for (std::size_t i = 0; i < l.size(); ++i) {
            double sum = 0.0;
            for (int k = -reach; k <= reach; ++k) {
                sum += std::exp(-0.5 * k * k / (sigma * sigma)) / bell *
                       double(mirrored(l, std::int64_t(i) + k));
            }
            RC_ASSERT(std::abs(double(smooth[i]) - 65536.0 * sum) <= error);
            all += smooth[i];
        }
        RC_ASSERT(all == mass * 65536);
    }));
}

TEST_CASE("smooth_line: sums beyond 2^63 are divided first, and reported") {
    line l(4, std::numeric_limits<std::uint64_t>::max() / 8);
    line smooth(4);
    CHECK(smooth_line(std::span<const std::uint64_t>(l), window_shape::gaussian, 3.0, smooth) ==
          status::out_of_range);
    CHECK(smooth[0] > 0);
    CHECK(smooth == line(4, smooth[0]));
    CHECK(smooth_line(std::span<const std::uint64_t>(l), window_shape::gaussian, std::nan(""),
                      std::span(smooth).first(3)) == status::buffer_too_small);
    CHECK(smooth_line(std::span<const std::uint64_t>(line{1, 2, 3}), window_shape::gaussian,
                      std::nan(""), smooth) == status::ok);
    CHECK(smooth[1] == 2);
}

TEMPLATE_TEST_CASE(
    "rectilinear tables: exact sums, ends exact, strictly increasing, any importance", "", float,
    double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const owned_counts c = any_counts(d, d.size(300), d.size(60));
        rectilinear_options<T> options;
        options.collapse = d.coin() ? cell_rule::sum : cell_rule::largest;
        options.shape = d.coin() ? window_shape::gaussian : window_shape::tent;
        options.width = static_cast<T>(d.between(0, 40));
        options.floor = d.coin() ? T(0) : static_cast<T>(d.unit());
        const built_pair<T, T> built(c, options);
        RC_ASSERT(increases(built.u));
        RC_ASSERT(increases(built.v));
        const built_pair<T, std::uint16_t> coarse(c, options);
        RC_ASSERT(increases(coarse.u));
        RC_ASSERT(increases(coarse.v));

        line lines[2] = {line(static_cast<std::size_t>(c.width)),
                         line(static_cast<std::size_t>(c.height))};
        RC_ASSERT(collapse(c.view(), options.collapse, lines[0], lines[1]) == status::ok);
        for (int axis = 0; axis < 2; ++axis) {
            const std::vector<T>& nodes = axis == 0 ? built.u : built.v;
            line smooth(lines[axis].size());
            smooth_line(std::span<const std::uint64_t>(lines[axis]), options.shape, options.width,
                        smooth);
            integer total = 0;
            for (const std::uint64_t x : smooth) {
                total += x;
            }
            const T floor =
                std::max(options.floor, smallest_floor<T, T>(static_cast<int>(smooth.size())));
            integer before = 0;
            for (std::size_t k = 0; k <= smooth.size(); ++k) {
                const rational x(integer(k), integer(smooth.size()));
                const rational exact =
                    total == 0
                        ? x
                        : rational(floor) * x + (1 - rational(floor)) * rational(before, total);
                // nine roundings in double (see warp_build_test.cpp), one to T
                RC_ASSERT(abs(rational(nodes[k]) - exact) <= rational(9 * 0x1p-53 + roundoff<T>()));
                before += k < smooth.size() ? integer(smooth[k]) : integer(0);
            }
            RC_ASSERT((total == 0) == any(built.result.flags, status::empty_importance));
        }
    }));
}

TEMPLATE_TEST_CASE("peers 25, J31: uniform and empty importance give the identity to the bit", "",
                   float, double) {
    using T = TestType;
    for (const std::uint32_t count : {0u, 1u, 7u, largest_count}) {
        owned_counts c(37, 11);
        std::fill(c.counts.begin(), c.counts.end(), count);
        for (const window_shape shape :
             {window_shape::box, window_shape::tent, window_shape::gaussian}) {
            rectilinear_options<T> options;
            options.shape = shape;
            const built_pair<T, T> built(c, options);
            for (int k = 0; k <= 37; ++k) {
                REQUIRE(built.u[static_cast<std::size_t>(k)] == T(k) / T(37));
            }
            for (int k = 0; k <= 11; ++k) {
                REQUIRE(built.v[static_cast<std::size_t>(k)] == T(k) / T(11));
            }
            CHECK(any(built.result.flags, status::empty_importance) == (count == 0));
        }
    }
}

TEMPLATE_TEST_CASE("rectilinear options out of range, and sizes that do not match, are reported",
                   "", float, double) {
    using T = TestType;
    dice d(3);
    const owned_counts c = any_counts(d, 8, 8);
    rectilinear_options<T> options = rosen_rectilinear<T>();
    CHECK(any(built_pair<T, T>(c, options).result.flags, status::floor_raised));
    options.width = std::numeric_limits<T>::quiet_NaN();
    CHECK(any(built_pair<T, T>(c, options).result.flags, status::invalid_input));
    options.width = std::numeric_limits<T>::infinity();
    CHECK(any(built_pair<T, T>(c, options).result.flags, status::out_of_range));
    CHECK(increases(built_pair<T, T>(c, options).u));

    std::vector<T> u(9, T(7));
    std::vector<T> v(9, T(7));
    line scratch(32);
    const auto build = [&](int cells, int rows, std::size_t memory) {
        return build_rectilinear<T, T>(c.view(), options, std::span(scratch).first(memory),
                                       table_span<T, T>{u, cells, rows}, table_span<T, T>{v, 8, 1})
            .flags;
    };
    CHECK(build(7, 1, 32) == status::buffer_too_small);
    CHECK(build(8, 2, 32) == status::buffer_too_small);
    CHECK(build(8, 1, 31) == status::buffer_too_small);
    CHECK(u == std::vector<T>(9, T(7)));
    CHECK(v == std::vector<T>(9, T(7)));
}
