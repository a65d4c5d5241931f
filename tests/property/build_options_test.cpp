// Properties of the options of warpshadow/warp_build.hpp: shear limit, shapes, super-cells, order
// of axes, bands.
#include "warp_oracle.hpp"

#include <warpshadow/build_options.hpp>
#include <warpshadow/rectilinear.hpp>
#include <warpshadow/second_axis.hpp>
#include <warpshadow/warp_build.hpp>

#include <catch2/catch.hpp>
#include <glm/vec2.hpp>
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

template <typename T> const T unlimited = std::numeric_limits<T>::infinity();

template <typename T, typename Node> struct built_axis {
    std::vector<std::uint64_t> scratch;
    std::vector<Node> nodes;
    int cells;
    int rows;
    build_result<T> result;

    template <typename Parallel = serial_for>
    built_axis(const owned_counts& c, const build_options<T>& options, int bands = 1,
               const Parallel& parallel = {})
        : scratch(scratch_size(c.width, options, bands)),
          nodes((static_cast<std::size_t>(c.width) + 1) * static_cast<std::size_t>(c.height)),
          cells(c.width), rows(c.height),
          result(build_axis<T, Node>(c.view(), options, scratch,
                                     table_span<T, Node>{nodes, cells, rows}, parallel)) {}

    [[nodiscard]] Node at(int row, int k) const {
        return nodes[static_cast<std::size_t>(row) * (static_cast<std::size_t>(cells) + 1) +
                     static_cast<std::size_t>(k)];
    }
    [[nodiscard]] table_view<T, Node> view() const { return {nodes, cells, rows}; }
    [[nodiscard]] bool increases() const {
        const Node one = std::is_integral_v<Node> ? std::numeric_limits<Node>::max() : Node(1);
        bool good = true;
        for (int row = 0; row < rows; ++row) {
            good = good && at(row, 0) == Node(0) && at(row, cells) == one;
            for (int k = 0; k < cells; ++k) {
                good = good && at(row, k) < at(row, k + 1);
            }
        }
        return good;
    }
};

/// Calls the body backwards: bands must not depend on each other.
struct backwards {
    template <typename Body> void operator()(int count, const Body& body) const {
        for (int i = count - 1; i >= 0; --i) {
            body(i);
        }
    }
};

/// A sample that is more than its position.
template <typename T> struct weighted { glm::vec<2, T> p; };

window_shape any_shape(dice& d) {
    const window_shape shapes[] = {window_shape::box, window_shape::tent, window_shape::gaussian};
    return shapes[d.between(0, 2)];
}

/// Largest |dX/dy| - s dX/dx of a table, in units of one cell: 0 or less where the limit holds.
template <typename T> double excess_shear(const built_axis<T, T>& axis, double shear) {
    double excess = -std::numeric_limits<double>::infinity();
    for (int row = 0; row + 1 < axis.rows; ++row) {
        for (int k = 0; k < axis.cells; ++k) {
            const double step0 = double(axis.at(row, k + 1)) - double(axis.at(row, k));
            const double step1 = double(axis.at(row + 1, k + 1)) - double(axis.at(row + 1, k));
            for (int end = 0; end < 2; ++end) {
                const double difference =
                    double(axis.at(row + 1, k + end)) - double(axis.at(row, k + end));
                excess = std::max(excess, std::abs(difference) * axis.rows -
                                              shear * axis.cells * std::min(step0, step1));
            }
        }
    }
    return axis.rows < 2 ? 0.0 : excess;
}

/// Rounding of nodes in the two sides of the limit: two nodes each, and 16 roundings in double of
/// their computation and mixture.
template <typename T> double shear_error(const built_axis<T, T>& axis, double shear) {
    const double node = 0.5 * roundoff<T>() * (std::is_same_v<T, float> ? 1.0 : 0.0) + 16 * 0x1p-53;
    return 2.0 * node * (axis.rows + shear * axis.cells);
}

} // namespace

TEMPLATE_TEST_CASE("shear limit: holds on the whole table, takes no more than it must", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const owned_counts c = any_counts(d, d.size(60), d.size(40));
        build_options<T> options;
        options.window = static_cast<T>(d.between(0.0, 0.3));
        options.floor = d.coin() ? T(0) : static_cast<T>(d.between(0.0, 0.5));
        options.shape = any_shape(d);
        const double shear = d.between(0, 4) == 0 ? 0.0 : std::exp2(d.between(-2.0, 5.0));
        options.shear = static_cast<T>(shear);
        const double limit = double(options.shear);
        const built_axis<T, T> limited(c, options);
        RC_ASSERT(limited.increases());
        RC_ASSERT(excess_shear(limited, limit) <= shear_error(limited, limit));
        const T mix = limited.result.mix;
        RC_ASSERT(mix >= T(0));
        RC_ASSERT(mix <= T(1));

        options.shear = unlimited<T>;
        options.floor = limited.result.floor; // twice the least for double
        const built_axis<T, T> free(c, options);
        if (!(mix > T(0))) {
            RC_ASSERT(excess_shear(free, limit) <= shear_error(free, limit));
            return;
        }
        // the same mixture, done here; and one of a thousandth less no longer keeps the limit
        RC_ASSERT(excess_shear(free, limit) > -shear_error(free, limit));
        options.window = T(2);
        const built_axis<T, T> shared(c, options);
        built_axis<T, T> weaker = free;
        for (std::size_t i = 0; i < free.nodes.size(); ++i) {
            const double f = double(free.nodes[i]);
            const double all = double(shared.nodes[i]);
            const double expected = f + double(mix) * (all - f);
            RC_ASSERT(std::abs(double(limited.nodes[i]) - expected) <=
                      3.0 * roundoff<T>() + 16 * 0x1p-53);
            weaker.nodes[i] = static_cast<T>(f + 0.999 * double(mix) * (all - f));
        }
        RC_ASSERT(excess_shear(weaker, limit) > -shear_error(weaker, limit));
    }));
}

TEMPLATE_TEST_CASE("shear limit 0 makes all functions equal; options that are none are reported",
                   "", float, double) {
    using T = TestType;
    dice d(21);
    owned_counts c(31, 17);
    for (std::uint32_t& n : c.counts) {
        n = static_cast<std::uint32_t>(d.between(0, 9));
    }
    build_options<T> options;
    options.shear = T(0);
    const built_axis<T, T> equal(c, options);
    CHECK(equal.result.mix == T(1));
    for (int row = 1; row < 17; ++row) {
        for (int k = 0; k <= 31; ++k) {
            REQUIRE(equal.at(row, k) == equal.at(0, k));
        }
    }
    options.shear = T(-1);
    CHECK(built_axis<T, T>(c, options).nodes == equal.nodes);
    CHECK(any(built_axis<T, T>(c, options).result.flags, status::out_of_range));
    const built_axis<T, T> free(c, build_options<T>{});
    options.shear = std::numeric_limits<T>::quiet_NaN();
    CHECK(built_axis<T, T>(c, options).nodes == free.nodes);
    CHECK(any(built_axis<T, T>(c, options).result.flags, status::invalid_input));
    // empty importance needs no mixture
    options.shear = T(2);
    CHECK(built_axis<T, T>(owned_counts(8, 8), options).result.mix == T(0));
    // too little memory: nothing written
    std::vector<std::uint64_t> scratch(scratch_size(31, options) - 1);
    std::vector<T> nodes(32 * 17, T(7));
    CHECK(build_axis<T, T>(c.view(), options, scratch, table_span<T, T>{nodes, 31, 17}).flags ==
          status::buffer_too_small);
    CHECK(nodes == std::vector<T>(32 * 17, T(7)));
}

// Vertex warping draws the triangle of the warped corners. J36 is the worst importance there is.
TEMPLATE_TEST_CASE("J36: rows that pull apart: at s = 1 no triangle of one texel flips", "", float,
                   double) {
    using T = TestType;
    const int size = 128;
    owned_counts c(size, size);
    for (int j = 0; j < size; ++j) {
        c.at(j % 2 == 0 ? size / 20 : size - 1 - size / 20, j) = 1000;
    }
    const auto flips = [&](T shear) {
        build_options<T> options;
        options.window = T(0);
        options.floor = T(0.02);
        options.shear = shear;
        const built_axis<T, T> rows(c, options);
        const table_view<T, T> columns = identity_table<T>();
        dice d(5);
        int flipped = 0;
        for (int i = 0; i < 40000; ++i) {
            const glm::vec<2, T> p(static_cast<T>(d.between(0.0, 0.99)),
                                   static_cast<T>(d.between(0.0, 0.99)));
            const double angle = d.between(0.0, 6.283185307179586);
            const double side = 1.0 / size;
            const glm::vec<2, T> e0(static_cast<T>(side * std::cos(angle)),
                                    static_cast<T>(side * std::sin(angle)));
            const glm::vec<2, T> e1(-e0.y, e0.x);
            const glm::vec<2, T> q = warp(rows.view(), columns, p);
            const glm::vec<2, T> a = warp(rows.view(), columns, p + e0) - q;
            const glm::vec<2, T> b = warp(rows.view(), columns, p + e1) - q;
            flipped += double(a.x) * double(b.y) - double(a.y) * double(b.x) <= 0.0 ? 1 : 0;
        }
        return flipped;
    };
    CHECK(flips(unlimited<T>) > 4000); // the test would see a flip
    CHECK(flips(T(1)) == 0);
}

TEMPLATE_TEST_CASE(
    "shapes: functions are the scan of the weighted sums, to the bit of a box on them", "", float,
    double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(40);
        const int height = d.size(30);
        owned_counts c(width, height);
        for (std::uint32_t& n : c.counts) {
            n = d.coin() ? 0u : static_cast<std::uint32_t>(d.between(0, 200));
        }
        build_options<T> options;
        options.shape = d.coin() ? window_shape::tent : window_shape::gaussian;
        options.radius = d.between(0, height + 1);
        const built_axis<T, T> built(c, options);
        RC_ASSERT(built.result.radius == options.radius);
        RC_ASSERT(built.increases());

        // weighted sums, box by box, as the counts of another map
        owned_counts weighted = c;
        for (int pass = 0; pass < box_passes(options.shape); ++pass) {
            const owned_counts before = weighted;
            for (int j = 0; j < height; ++j) {
                for (int i = 0; i < width; ++i) {
                    weighted.at(i, j) = 0;
                    for (int y = std::max(0, j - options.radius);
                         y <= std::min(height - 1, j + options.radius); ++y) {
                        weighted.at(i, j) += before.at(i, y);
                    }
                }
            }
        }
        options.shape = window_shape::box;
        options.radius = 0;
        const built_axis<T, T> expected(weighted, options);
        for (std::size_t i = 0; i < built.nodes.size(); ++i) {
            // two ways to compute a node, nine roundings each (see warp_build_test.cpp)
            RC_ASSERT(std::abs(double(built.nodes[i]) - double(expected.nodes[i])) <=
                      18 * 0x1p-53 + 2.0 * roundoff<T>());
        }
        RC_ASSERT(built.result.empty_rows == expected.result.empty_rows);
    }));
}

TEMPLATE_TEST_CASE("J40: the wide limit of every shape is the function that all rows share", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const owned_counts c = any_counts(d, d.size(60), d.size(40));
        {
            build_options<T> options;
            options.window = T(2);
            options.shape = any_shape(d);
            const built_axis<T, T> built(c, options);
            rectilinear_options<T> flat;
            flat.shape = window_shape::box;
            flat.width = T(0);
            std::vector<T> u(static_cast<std::size_t>(c.width) + 1);
            std::vector<T> v(static_cast<std::size_t>(c.height) + 1);
            std::vector<std::uint64_t> scratch(rectilinear_scratch(c.width, c.height));
            build_rectilinear<T, T>(c.view(), flat, scratch, table_span<T, T>{u, c.width, 1},
                                    table_span<T, T>{v, c.height, 1});
            // counts divided by a power of two lose that much of a cell's share of the sum
            if (any(built.result.flags, status::out_of_range)) {
                return;
            }
            for (int row = 0; row < c.height; ++row) {
                for (int k = 0; k <= c.width; ++k) {
                    RC_ASSERT(std::abs(double(built.at(row, k)) -
                                       double(u[static_cast<std::size_t>(k)])) <=
                              18 * 0x1p-53 + 2.0 * roundoff<T>());
                    RC_ASSERT(built.at(row, k) == built.at(0, k));
                }
            }
        }
    }));
}

TEMPLATE_TEST_CASE("bands: any number, in any order, gives the serial result to the bit", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const owned_counts c = any_counts(d, d.size(70), d.size(70));
        build_options<T> options;
        options.window = static_cast<T>(d.between(0.0, 2.0));
        options.shape = any_shape(d);
        options.shear = d.coin() ? unlimited<T> : T(2);
        const built_axis<T, T> serial(c, options);
        const built_axis<T, T> banded(c, options, d.between(1, 70), backwards{});
        RC_ASSERT(serial.nodes == banded.nodes);
        RC_ASSERT(serial.result.samples == banded.result.samples);
        RC_ASSERT(serial.result.empty_rows == banded.result.empty_rows);
        RC_ASSERT(serial.result.mix == banded.result.mix);
        RC_ASSERT(serial.result.flags == banded.result.flags);
        const built_axis<T, std::uint16_t> coarse(c, options);
        const built_axis<T, std::uint16_t> coarse_banded(c, options, 7, backwards{});
        RC_ASSERT(coarse.nodes == coarse_banded.nodes);
    }));
}

TEST_CASE("no decreasing step at any size to 4096, at any floor, in any storage") {
    const int sizes[][2] = {{4096, 3}, {4095, 2}, {4096, 64}, {1000, 100}, {3, 4096}, {2047, 40}};
    dice d(31);
    for (const auto& size : sizes) {
        for (int turn = 0; turn < 10; ++turn) {
            const owned_counts c = any_counts(d, size[0], size[1]);
            build_options<double> options;
            options.window = d.between(0.0, 0.5);
            options.floor = turn % 3 == 0 ? 0.0 : std::exp2(d.between(-30.0, 0.0));
            options.shape = any_shape(d);
            options.shear = d.coin() ? 2.0 : unlimited<double>;
            REQUIRE(built_axis<double, double>(c, options).increases());
            REQUIRE(built_axis<double, float>(c, options).increases());
            REQUIRE(built_axis<double, std::uint16_t>(c, options).increases());
        }
    }
}

TEMPLATE_TEST_CASE(
    "super-cells: any number of cells and functions, and the warp goes there and back", "", float,
    double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int size = d.size(64);
        const int functions = d.size(64);
        std::vector<glm::vec<2, T>> samples;
        for (int i = 0; i < 500; ++i) {
            const T u = static_cast<T>(d.unit());
            samples.push_back({u * u, static_cast<T>(d.unit()) * u});
        }
        build_options<T> options;
        options.shear = d.coin() ? T(2) : unlimited<T>;
        options.v_first = d.coin();
        const auto cells = static_cast<std::size_t>(size);
        const auto count = static_cast<std::size_t>(functions);
        std::vector<std::uint32_t> counts(cells * count);
        std::vector<std::uint64_t> scratch(scratch_size(size, options));
        std::vector<T> rows((cells + 1) * count);
        std::vector<T> columns((cells + 1) * count);
        const warp_result<T> built =
            build_warp<T, T>(std::span<const glm::vec<2, T>>(samples), options,
                             {size, counts, scratch, rows, columns, functions});
        RC_ASSERT(!any(built.flags, status::buffer_too_small));
        RC_ASSERT(built.rows.cells == size);
        RC_ASSERT(built.rows.rows == functions);
        RC_ASSERT(built.columns.rows == functions);
        RC_ASSERT(built.v_first == options.v_first);

        // the other order is this one on exchanged samples
        for (glm::vec<2, T>& p : samples) {
            p = glm::vec<2, T>(p.y, p.x);
        }
        options.v_first = !options.v_first;
        std::vector<T> rows2(rows.size());
        std::vector<T> columns2(columns.size());
        build_warp<T, T>(std::span<const glm::vec<2, T>>(samples), options,
                         {size, counts, scratch, rows2, columns2, functions});
        RC_ASSERT(rows == rows2);
        RC_ASSERT(columns == columns2);

        for (int i = 0; i < 20; ++i) {
            const glm::vec<2, T> p(static_cast<T>(d.unit()), static_cast<T>(d.unit()));
            const glm::vec<2, T> back =
                unwarp(built.rows, built.columns, warp(built.rows, built.columns, p));
            // see `unwarp`: (1 + s / 0.2) u / 0.2 with s no larger than rows of a table allow
            const double error = 64.0 * roundoff<T>() * (1.0 + 5.0 * functions);
            RC_ASSERT(std::abs(double(back.x) - double(p.x)) <= error);
            RC_ASSERT(std::abs(double(back.y) - double(p.y)) <= error);
        }
    }));
}

TEMPLATE_TEST_CASE("splat_columns_weighted: an importance of 1 is splat_columns", "", float,
                   double) {
    using T = TestType;
    dice d(41);
    std::vector<glm::vec<2, T>> samples;
    std::vector<weighted<T>> points;
    for (int i = 0; i < 2000; ++i) {
        samples.push_back({any_coordinate<T>(d), any_coordinate<T>(d)});
        points.push_back({samples.back()});
    }
    const owned_counts importance = any_counts(d, 16, 16);
    const built_axis<T, T> rows(importance, build_options<T>{});
    owned_counts a(16, 12);
    owned_counts b(16, 12);
    const splat_result plain =
        splat_columns(std::span<const glm::vec<2, T>>(samples), rows.view(), a.map());
    const splat_result result = splat_columns_weighted(
        std::span<const weighted<T>>(points), rows.view(), [](const weighted<T>&) { return T(1); },
        T(1), cell_rule::sum, b.map());
    CHECK(a.counts == b.counts);
    CHECK(plain.counted == result.counted);
    CHECK(plain.rejected == result.rejected);
    CHECK(plain.flags == result.flags);
    CHECK(result.weight == result.counted);
}
