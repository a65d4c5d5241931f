// Properties of warpshadow/filter.hpp.
#include "warp_oracle.hpp"

#include <warpshadow/bias.hpp>
#include <warpshadow/filter.hpp>
#include <warpshadow/warp.hpp>
#include <warpshadow/warp_build.hpp>

#include <catch2/catch.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

/// A table and its memory.
template <typename T> struct built_table {
    int cells;
    int rows;
    std::vector<T> nodes;

    built_table(const owned_counts& counts, const build_options<T>& options)
        : cells(counts.width), rows(counts.height),
          nodes((static_cast<std::size_t>(cells) + 1) * static_cast<std::size_t>(rows)) {
        std::vector<std::uint64_t> scratch(scratch_size(cells, options));
        build_axis<T, T>(counts.view(), options, scratch, {nodes, cells, rows});
    }
    [[nodiscard]] table_view<T> view() const { return {nodes, cells, rows}; }
};

template <typename T> built_table<T> any_table(dice& d, int cells, int rows) {
    build_options<T> options;
    options.floor = static_cast<T>(d.between(0.05, 1.0));
    return built_table<T>(any_counts(d, cells, rows), options);
}

template <typename T> glm::vec<2, T> any_point(dice& d) {
    return glm::vec<2, T>(static_cast<T>(d.unit()), static_cast<T>(d.unit()));
}

} // namespace

TEMPLATE_TEST_CASE("kernel_tap: one tap in each cell of the kernel, jittered inside it", "", float,
                   double) {
    using T = TestType;
    CHECK(kernel_tap(0, 1, glm::vec<2, T>(T(0))) == glm::vec<2, T>(T(0)));
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int across = d.between(1, 40);
        std::set<std::pair<int, int>> cells;
        glm::dvec2 sum(0.0);
        for (int i = 0; i < across * across; ++i) {
            const glm::vec<2, T> middle = kernel_tap(i, across, glm::vec<2, T>(T(0)));
            const glm::vec<2, T> tap = kernel_tap(i, across, any_point<T>(d) * T(0.998) - T(0.499));
            const glm::dvec2 cell = (glm::dvec2(tap) + 1.0) * 0.5 * static_cast<double>(across);
            cells.insert(
                {static_cast<int>(std::floor(cell.x)), static_cast<int>(std::floor(cell.y))});
            RC_ASSERT(cell.x > 0.0 && cell.x < across && cell.y > 0.0 && cell.y < across);
            RC_ASSERT(glm::length(glm::dvec2(tap) - glm::dvec2(middle)) <= 1.5 / across);
            sum += glm::dvec2(middle);
        }
        RC_ASSERT(cells.size() ==
                  static_cast<std::size_t>(across) * static_cast<std::size_t>(across));
        // the kernel's centre is the receiver
        RC_ASSERT(glm::length(sum) <= 8.0 * across * across * roundoff<T>());
    }));
}

TEMPLATE_TEST_CASE("kernel_weight: a Gaussian, or a box; finite for any numbers", "", float,
                   double) {
    using T = TestType;
    CHECK(kernel_weight(glm::vec<2, T>(T(1), T(-1)), T(0)) == T(1));
    CHECK(kernel_weight(glm::vec<2, T>(T(0)), T(3)) == T(1));
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const glm::vec<2, T> tap = any_point<T>(d) * T(2) - T(1);
        const T deviations = static_cast<T>(d.between(0.0, 4.0));
        const double exact =
            std::exp(-0.5 * static_cast<double>(deviations) * static_cast<double>(deviations) *
                     glm::dot(glm::dvec2(tap), glm::dvec2(tap)));
        RC_ASSERT(std::abs(static_cast<double>(kernel_weight(tap, deviations)) - exact) <=
                  roundoff<T>() * exact * (4.0 + 100.0));
        const T any = kernel_weight(glm::vec<2, T>(any_coordinate<T>(d), any_coordinate<T>(d)),
                                    any_coordinate<T>(d));
        RC_ASSERT(any >= T(0) && any <= T(1));
    }));
}

TEMPLATE_TEST_CASE("kernel_taps: no two farther apart than a texel, never more than asked", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int most = d.between(1, 64);
        const T reach = static_cast<T>(std::exp2(d.between(-8.0, 8.0)));
        const int taps = kernel_taps(glm::vec<2, T>(reach, T(0.1) * reach), most);
        RC_ASSERT(taps >= 1 && taps <= most);
        RC_ASSERT(taps == most || T(2) * reach <= T(taps));
        RC_ASSERT(taps == 1 || T(2) * reach > T(taps - 1) || taps == most);
        const int any =
            kernel_taps(glm::vec<2, T>(any_coordinate<T>(d), any_coordinate<T>(d)), most);
        RC_ASSERT(any >= 1 && any <= most);
    }));
    // what int does not hold
    REQUIRE(kernel_taps(glm::vec<2, T>(T(-1e33)), 16) == 1);
    REQUIRE(kernel_taps(glm::vec<2, T>(T(1e33)), 16) == 16);
    REQUIRE(kernel_taps(glm::vec<2, T>(std::numeric_limits<T>::quiet_NaN(), T(0)), 16) == 16);
}

TEMPLATE_TEST_CASE("Rosen 6.2, in texels: taps are the same texels apart wherever the map is "
                   "stretched",
                   "", float, double) {
    using T = TestType;
    dice d(3);
    for (int i = 0; i < 200; ++i) {
        const glm::vec<2, T> q = any_point<T>(d);
        const glm::vec<2, T> tap = any_point<T>(d) * T(2) - T(1);
        const glm::vec<2, T> texel(T(1) / T(512), T(1) / T(256));
        const glm::dvec2 moved =
            (glm::dvec2(tap_in_texels(q, tap, T(2), texel)) - glm::dvec2(q)) / glm::dvec2(texel);
        CHECK(glm::length(moved - 2.0 * glm::dvec2(tap)) <= 2048.0 * roundoff<T>());
    }
}

TEMPLATE_TEST_CASE("Rosen 6.2, in light space: unwarped, the kernel has its size everywhere", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const built_table<T> rows = any_table<T>(d, d.size(60), d.size(20));
        const built_table<T> columns = any_table<T>(d, d.size(60), d.size(20));
        const glm::vec<2, T> p = any_point<T>(d);
        const glm::vec<2, T> tap = any_point<T>(d) * T(2) - T(1);
        const glm::vec<2, T> radii(static_cast<T>(d.between(0.0, 0.1)),
                                   static_cast<T>(d.between(0.0, 0.1)));
        const glm::vec<2, T> q = tap_in_light(rows.view(), columns.view(), p, tap, radii);
        const glm::dvec2 back(unwarp(rows.view(), columns.view(), q));
        const glm::dvec2 wanted = glm::dvec2(p) + glm::dvec2(tap) * glm::dvec2(radii);
        // the floor is 0.05 at least: an error of u/ε along v, and that over ε times the shear,
        // which is at most twice the number of rows, along u
        const double along = 40.0 * roundoff<T>() / 0.05;
        RC_ASSERT(std::abs(back.y - wanted.y) <= along);
        RC_ASSERT(std::abs(back.x - wanted.x) <= along * (1.0 + 40.0 / 0.05));
    }));
}

TEMPLATE_TEST_CASE("by the Jacobian: exact inside a cell, and off by the bend beyond it", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        // one function: no bend across rows, and straight inside a cell
        const built_table<T> rows = any_table<T>(d, d.between(2, 40), 1);
        const built_table<T> columns = any_table<T>(d, d.between(2, 40), 1);
        const glm::dvec2 cell(1.0 / rows.cells, 1.0 / columns.cells);
        const glm::dvec2 middle((d.between(0, rows.cells - 1) + 0.5) * cell.x,
                                (d.between(0, columns.cells - 1) + 0.5) * cell.y);
        const glm::vec<2, T> p(middle);
        const glm::vec<2, T> radii(cell * 0.49);
        const glm::vec<2, T> tap = any_point<T>(d) * T(2) - T(1);
        const glm::mat<2, 2, T> j = jacobian(rows.view(), columns.view(), p);
        const glm::vec<2, T> q = warp(rows.view(), columns.view(), p);
        const glm::dvec2 near(tap_by_jacobian(q, j, tap, radii));
        const glm::dvec2 exact(tap_in_light(rows.view(), columns.view(), p, tap, radii));
        // a slope is a difference of nodes, an ulp of 1 off, over a cell; up to one cell is walked
        RC_ASSERT(glm::length(near - exact) <= 40.0 * roundoff<T>());
        // the reach holds every tap
        const glm::vec<2, T> reach = kernel_reach(j, radii, glm::vec<2, T>(T(1)));
        RC_ASSERT(std::abs(near.x - static_cast<double>(q.x)) <=
                  static_cast<double>(reach.x) * (1.0 + 8.0 * roundoff<T>()) + 2.0 * roundoff<T>());
        RC_ASSERT(std::abs(near.y - static_cast<double>(q.y)) <=
                  static_cast<double>(reach.y) * (1.0 + 8.0 * roundoff<T>()) + 2.0 * roundoff<T>());
    }));
}

TEMPLATE_TEST_CASE("kernel_reach is attained at a corner of the kernel", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        glm::mat<2, 2, T> j;
        for (int k = 0; k < 4; ++k) {
            j[k / 2][k % 2] = static_cast<T>(d.between(-3.0, 3.0));
        }
        const glm::vec<2, T> radii = any_point<T>(d);
        const glm::vec<2, T> texel(T(1) / T(64), T(1) / T(128));
        glm::vec<2, T> farthest(T(0));
        for (int corner = 0; corner < 4; ++corner) {
            const glm::vec<2, T> tap(corner % 2 == 0 ? T(-1) : T(1), corner < 2 ? T(-1) : T(1));
            farthest = glm::max(
                farthest, glm::abs(tap_by_jacobian(glm::vec<2, T>(T(0)), j, tap, radii)) / texel);
        }
        const glm::vec<2, T> reach = kernel_reach(j, radii, texel);
        RC_ASSERT(glm::length(glm::dvec2(reach) - glm::dvec2(farthest)) <=
                  16.0 * roundoff<T>() * 600.0);
    }));
}

TEMPLATE_TEST_CASE("peers 38: a kernel of fixed size in the scene keeps it, whatever the warp", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const built_table<T> rows = any_table<T>(d, 32, 8);
        const built_table<T> columns = any_table<T>(d, 32, 8);
        // an orthographic light along z whose map is 10 wide and 4 high
        glm::mat<4, 4, T> light(T(1));
        light[0][0] = T(2) / T(10);
        light[1][1] = T(2) / T(4);
        const glm::vec<3, T> place(static_cast<T>(d.between(-4.0, 4.0)),
                                   static_cast<T>(d.between(-1.5, 1.5)), T(0));
        const T radius = static_cast<T>(d.between(0.01, 0.3));
        const texel_axes<T> whole =
            texel_axes_at(light, glm::mat<2, 2, T>(T(1)), place, glm::vec<2, T>(T(1)));
        const glm::vec<2, T> radii = kernel_radii(whole, radius, T(1));
        const double error = 32.0 * roundoff<T>();
        RC_ASSERT(std::abs(static_cast<double>(radii.x) * 10.0 - static_cast<double>(radius)) <=
                  error);
        RC_ASSERT(std::abs(static_cast<double>(radii.y) * 4.0 - static_cast<double>(radius)) <=
                  error);
        // the border of the kernel, carried through map and warp and back, is `radius` away
        const glm::vec<2, T> p(place.x / T(10) + T(0.5), place.y / T(4) + T(0.5));
        const glm::vec<2, T> q =
            tap_in_light(rows.view(), columns.view(), p, glm::vec<2, T>(T(0), T(1)), radii);
        const glm::dvec2 back(unwarp(rows.view(), columns.view(), q));
        RC_ASSERT(std::abs((back.y - static_cast<double>(p.y)) * 4.0 -
                           static_cast<double>(radius)) <= 4.0 * 60.0 * roundoff<T>() / 0.05);
    }));
}

TEMPLATE_TEST_CASE("kernel_radii is finite for any axes", "", float, double) {
    using T = TestType;
    const T most = T(64);
    const glm::vec<3, T> none(T(0));
    CHECK(kernel_radii(texel_axes<T>{none, none}, T(1), most) == glm::vec<2, T>(most));
    REQUIRE(rc::check([] {
        dice d = any_dice();
        texel_axes<T> axes;
        for (glm::length_t k = 0; k < 3; ++k) {
            axes.u[k] = any_coordinate<T>(d);
            axes.v[k] = any_coordinate<T>(d);
        }
        const T any = any_coordinate<T>(d);
        const glm::vec<2, T> radii = kernel_radii(axes, any > T(0) ? any : T(0), T(64));
        RC_ASSERT(radii.x >= T(0) && radii.x <= T(64));
        RC_ASSERT(radii.y >= T(0) && radii.y <= T(64));
    }));
}

TEMPLATE_TEST_CASE("filtered_light: lit is 1, dark is 0, a straight edge its share", "", float,
                   double) {
    using T = TestType;
    const auto none = [](glm::vec<2, T>) { return false; };
    const auto all = [](glm::vec<2, T>) { return true; };
    for (int across = 1; across < 12; ++across) {
        for (const T deviations : {T(0), T(2), std::numeric_limits<T>::infinity()}) {
            // no weight at all, as at an infinite number of deviations, is lit
            const bool weighs = std::isfinite(deviations);
            CHECK(filtered_light(across, deviations, none) == (weighs ? T(0) : T(1)));
            CHECK(std::abs(filtered_light(across, deviations, all) - T(1)) <=
                  T(4) * std::numeric_limits<T>::epsilon());
        }
        const T half = filtered_light(
            2 * across, T(2), [](glm::vec<2, T> tap) { return tap.x > T(0) ? T(1) : T(0); });
        CHECK(std::abs(half - T(0.5)) <= T(100) * std::numeric_limits<T>::epsilon());
    }
}

TEMPLATE_TEST_CASE("MER: the texels of the identity, and the largest stretch of any table", "",
                   float, double) {
    using T = TestType;
    const std::vector<T> identity{T(0), T(0.25), T(0.5), T(0.75), T(1)};
    CHECK(maximum_effective_resolution(table_view<T>{identity, 4, 1}, 2048) == T(2048));
    // half of the map for an eighth of it
    const std::vector<T> steep{T(0),    T(0.5),   T(0.6), T(0.7), T(0.75), T(0.8),
                               T(0.85), T(0.925), T(1),   T(0),   T(0.1),  T(0.2),
                               T(0.3),  T(0.4),   T(0.5), T(0.7), T(0.8),  T(1)};
    CHECK(maximum_effective_resolution(table_view<T>{steep, 8, 2}, 2048) == T(4 * 2048));
    CHECK(maximum_effective_resolution(table_view<T>{steep, 8, 3}, 2048) == T(0));
    CHECK(maximum_effective_resolution(table_view<T>{}, 2048) == T(0));
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const built_table<T> table = any_table<T>(d, d.size(60), d.size(20));
        const T mer = maximum_effective_resolution(table.view(), 1);
        RC_ASSERT(mer >= T(1) - T(table.cells) * std::numeric_limits<T>::epsilon());
        for (int i = 0; i < 50; ++i) {
            const glm::vec<2, T> p = any_point<T>(d);
            const T slope = axis_slope(table.view(), blend_rows(p.y, table.rows), p.x);
            RC_ASSERT(slope <= mer + T(4 * table.cells) * std::numeric_limits<T>::epsilon());
        }
    }));
}
