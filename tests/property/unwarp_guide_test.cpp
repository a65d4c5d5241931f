// Properties of warpshadow/unwarp_guide.hpp and warpshadow/warp_points.hpp: many points at once
// give what one gives, to the bit. The tests are built without fused multiplications.
#include "warp_oracle.hpp"

#include <warpshadow/unwarp_guide.hpp>
#include <warpshadow/warp.hpp>
#include <warpshadow/warp_build.hpp>
#include <warpshadow/warp_points.hpp>

#include <catch2/catch.hpp>
#include <glm/vec2.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

/// A table, its guide, and their memory, which has exactly their size.
template <typename T, typename Node> struct guided_table {
    int cells;
    int rows;
    std::vector<Node> nodes;
    int steps;
    std::vector<std::uint16_t> starts;

    guided_table(const owned_counts& counts, build_options<T> options, int guide_steps)
        : cells(counts.width), rows(counts.height),
          nodes((static_cast<std::size_t>(cells) + 1) * static_cast<std::size_t>(rows)),
          steps(guide_steps), starts(guide_size(steps, rows)) {
        std::vector<std::uint64_t> scratch(scratch_size(cells, options));
        build_axis<T, Node>(counts.view(), options, scratch, {nodes, cells, rows});
        build();
    }
    void build() { REQUIRE(build_guide(view(), guide_span{starts, steps, rows}) == status::ok); }
    [[nodiscard]] table_view<T, Node> view() const { return {nodes, cells, rows}; }
    [[nodiscard]] guide_view guide() const { return {starts, steps, rows}; }
};

template <typename T, typename Node>
guided_table<T, Node> any_guided(dice& d, int cells, int rows, T floor) {
    build_options<T> options;
    options.floor = floor;
    options.radius = d.coin() ? 0 : d.between(0, rows);
    return guided_table<T, Node>(any_counts(d, cells, rows), options,
                                 d.coin() ? cells : d.between(1, 2 * cells));
}

/// A floor with which blended nodes increase whatever is rounded.
template <typename T, typename Node> T safe_floor(dice& d, int cells) {
    const T least = T(8) * smallest_floor<T, Node>(cells);
    return std::max(least, static_cast<T>(std::exp2(d.between(-10.0, 0.0))));
}

template <typename T> bool same(T a, T b) {
    return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

template <typename T> bool same(glm::vec<2, T> a, glm::vec<2, T> b) {
    return same(a.x, b.x) && same(a.y, b.y);
}

/// Coordinates where functions and guides have their seams, and any others.
template <typename T> T any_image(dice& d, int cells, int steps) {
    T x = d.coin() ? T(d.between(0, steps)) / T(steps) : T(d.between(0, cells)) / T(cells);
    switch (d.between(0, 3)) {
    case 0:
        return x;
    case 1:
        return std::nextafter(x, d.coin() ? T(2) : T(-1));
    case 2:
        return any_coordinate<T>(d);
    default:
        return static_cast<T>(d.unit());
    }
}

template <typename T_, typename Node_> struct stored {
    using T = T_;
    using Node = Node_;
};

} // namespace

TEMPLATE_TEST_CASE("unwarp with guides is unwarp, to the bit", "", (stored<float, float>),
                   (stored<double, double>), (stored<float, std::uint16_t>),
                   (stored<double, float>)) {
    using T = typename TestType::T;
    using Node = typename TestType::Node;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(d.coin() ? 40 : 600);
        const int rows = d.size(20);
        const auto u = any_guided<T, Node>(d, cells, rows, safe_floor<T, Node>(d, cells));
        const auto v = any_guided<T, Node>(d, rows, cells, safe_floor<T, Node>(d, rows));
        for (int i = 0; i < 40; ++i) {
            const glm::vec<2, T> q(any_image<T>(d, cells, u.steps), any_image<T>(d, rows, v.steps));
            RC_ASSERT(same(unwarp(u.view(), v.view(), u.guide(), v.guide(), q),
                           unwarp(u.view(), v.view(), q)));
        }
    }));
}

TEMPLATE_TEST_CASE("J36: flat floors, steep steps, and neighbours that pull to opposite ends", "",
                   (stored<float, float>), (stored<double, double>),
                   (stored<float, std::uint16_t>)) {
    using T = typename TestType::T;
    using Node = typename TestType::Node;
    dice d(17);
    for (const int cells : {2, 64, 1024, 4096}) {
        const int rows = 6;
        owned_counts counts(cells, rows);
        for (int row = 0; row < rows; ++row) {
            counts.at(row % 2 == 0 ? cells / 20 : cells - 1 - cells / 20, row) = 1000;
        }
        build_options<T> options;
        options.radius = 0;
        options.floor = T(8) * smallest_floor<T, Node>(cells);
        const guided_table<T, Node> table(counts, options, cells);
        for (int i = 0; i < 3000; ++i) {
            const row_blend<T> blend = blend_rows(static_cast<T>(d.unit()), rows);
            const T image = i < cells ? T(i) / T(cells) : static_cast<T>(d.unit());
            REQUIRE(same(axis_inverse_offset(table.view(), table.guide(), blend, image),
                         axis_inverse_offset(table.view(), blend, image)));
        }
    }
}

TEMPLATE_TEST_CASE("a search from any cell is the bisection, to the bit, and says where it ended",
                   "", (stored<float, float>), (stored<double, double>),
                   (stored<float, std::uint16_t>)) {
    using T = typename TestType::T;
    using Node = typename TestType::Node;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(2000);
        const int rows = d.between(1, 6);
        const auto table = any_guided<T, Node>(d, cells, rows, safe_floor<T, Node>(d, cells));
        int cell = d.coin() ? static_cast<int>(d.bits()) : d.between(-1, cells);
        for (int i = 0; i < 40; ++i) {
            const row_blend<T> blend = blend_rows(static_cast<T>(d.unit()), rows);
            const T image = any_image<T>(d, cells, table.steps);
            RC_ASSERT(same(axis_inverse_offset_near(table.view(), blend, image, cell),
                           axis_inverse_offset(table.view(), blend, image)));
            RC_ASSERT(cell >= 0 && cell < cells);
            const T inside = clamp_to_unit(image);
            RC_ASSERT(blended_node(table.view(), blend, cell) <= inside);
            RC_ASSERT(cell + 1 == cells || blended_node(table.view(), blend, cell + 1) > inside);
            if (d.between(0, 3) == 0) {
                cell = static_cast<int>(d.bits());
            }
        }
    }));
}

TEMPLATE_TEST_CASE("at the smallest floor, where blends may tie, the answer is an inverse", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(2000);
        const int rows = d.between(1, 4);
        const auto table = any_guided<T, T>(d, cells, rows, T(0));
        for (int i = 0; i < 40; ++i) {
            const row_blend<T> blend = blend_rows(static_cast<T>(d.unit()), rows);
            const T image = any_image<T>(d, cells, table.steps);
            const T guided = axis_inverse_offset(table.view(), table.guide(), blend, image);
            const T plain = axis_inverse_offset(table.view(), blend, image);
            if (!same(guided, plain) && std::isfinite(image)) {
                const T x = std::clamp(image, T(0), T(1)) + guided;
                const T back = x + axis_offset(table.view(), blend, x);
                const T y = std::clamp(image, T(0), T(1)) + plain;
                const T other = y + axis_offset(table.view(), blend, y);
                RC_ASSERT(std::abs(back - other) <= T(8) * std::numeric_limits<T>::epsilon());
            }
        }
    }));
}

TEMPLATE_TEST_CASE("a guide of another table, or of no table, costs time and changes nothing", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(300);
        const int rows = d.between(1, 20);
        auto table = any_guided<T, T>(d, cells, rows, safe_floor<T, T>(d, cells));
        for (std::uint16_t& start : table.starts) {
            start = static_cast<std::uint16_t>(d.bits());
        }
        std::vector<T> across(23);
        std::vector<T> image(23);
        std::vector<T> offset(16);
        for (std::size_t i = 0; i < across.size(); ++i) {
            across[i] = any_coordinate<T>(d);
            image[i] = any_image<T>(d, cells, table.steps);
            const row_blend<T> blend = blend_rows(across[i], rows);
            RC_ASSERT(same(axis_inverse_offset(table.view(), table.guide(), blend, image[i]),
                           axis_inverse_offset(table.view(), blend, image[i])));
        }
        detail::inverse_offsets(table.view(), table.guide(), 16, across.data(), image.data(),
                                offset.data());
        for (std::size_t i = 0; i < 16; ++i) {
            const row_blend<T> blend = blend_rows(across[i], rows);
            RC_ASSERT(same(offset[i], axis_inverse_offset(table.view(), blend, image[i])));
        }
    }));
}

TEMPLATE_TEST_CASE("build_guide: sizes that do not match are reported, and nothing is written", "",
                   float, double) {
    using T = TestType;
    const std::vector<T> nodes{T(0), T(0.5), T(1), T(0), T(0.25), T(1)};
    const table_view<T> table{nodes, 2, 2};
    std::vector<std::uint16_t> starts(6, 77);
    CHECK(build_guide(table, {std::span(starts).first(5), 2, 2}) == status::buffer_too_small);
    CHECK(build_guide(table, {starts, 0, 2}) == status::buffer_too_small);
    CHECK(build_guide(table, {starts, -1, 2}) == status::buffer_too_small);
    CHECK(build_guide(table, {starts, 2, 1}) == status::buffer_too_small);
    CHECK(build_guide(table_view<T>{nodes, 3, 2}, {starts, 2, 2}) == status::buffer_too_small);
    const std::vector<T> wide(65538);
    CHECK(build_guide(table_view<T>{wide, 65537, 1}, {starts, 2, 1}) == status::out_of_range);
    CHECK(std::count(starts.begin(), starts.end(), 77) == 6);
    CHECK(build_guide(table, {starts, 2, 2}) == status::ok);
    CHECK(starts == std::vector<std::uint16_t>{0, 1, 1, 0, 1, 1});
}

TEMPLATE_TEST_CASE("warp_points and unwarp_points: each point as if alone, in place too", "",
                   (stored<float, float>), (stored<double, double>),
                   (stored<float, std::uint16_t>)) {
    using T = typename TestType::T;
    using Node = typename TestType::Node;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(200);
        const int rows = d.size(50);
        const auto u = any_guided<T, Node>(d, cells, rows, safe_floor<T, Node>(d, cells));
        const auto v = any_guided<T, Node>(d, rows, cells, safe_floor<T, Node>(d, rows));
        std::vector<glm::vec<2, T>> points(static_cast<std::size_t>(d.between(0, 50)));
        for (glm::vec<2, T>& p : points) {
            p = {any_image<T>(d, cells, u.steps), any_image<T>(d, rows, v.steps)};
        }
        std::vector<glm::vec<2, T>> warped(points.size());
        std::vector<glm::vec<2, T>> unwarped(points.size());
        const std::span<const glm::vec<2, T>> from(points);
        RC_ASSERT(warp_points(u.view(), v.view(), from, std::span(warped)) == status::ok);
        RC_ASSERT(unwarp_points(u.view(), v.view(), u.guide(), v.guide(), from,
                                std::span(unwarped)) == status::ok);
        for (std::size_t i = 0; i < points.size(); ++i) {
            RC_ASSERT(same(warped[i], warp(u.view(), v.view(), points[i])));
            RC_ASSERT(same(unwarped[i], unwarp(u.view(), v.view(), points[i])));
        }
        std::vector<glm::vec<2, T>> in_place = points;
        warp_points(u.view(), v.view(), std::span<const glm::vec<2, T>>(in_place),
                    std::span(in_place));
        for (std::size_t i = 0; i < points.size(); ++i) {
            RC_ASSERT(same(in_place[i], warped[i]));
        }
        in_place = points;
        unwarp_points(u.view(), v.view(), u.guide(), v.guide(),
                      std::span<const glm::vec<2, T>>(in_place), std::span(in_place));
        for (std::size_t i = 0; i < points.size(); ++i) {
            RC_ASSERT(same(in_place[i], unwarped[i]));
        }
    }));
}

TEMPLATE_TEST_CASE("points: sizes that do not match are reported, and nothing is written", "",
                   float, double) {
    using T = TestType;
    const std::vector<T> nodes{T(0), T(1)};
    const table_view<T> table{nodes, 1, 1};
    const std::vector<std::uint16_t> starts{0, 0};
    const guide_view guide{starts, 1, 1};
    const std::vector<glm::vec<2, T>> from(5, glm::vec<2, T>(T(0.5)));
    std::vector<glm::vec<2, T>> to(5, glm::vec<2, T>(T(9)));
    const std::span<const glm::vec<2, T>> in(from);
    const std::span<glm::vec<2, T>> out(to);
    const table_view<T> none;
    CHECK(warp_points(table, table, in, out.first(4)) == status::buffer_too_small);
    CHECK(warp_points(none, table, in, out) == status::buffer_too_small);
    CHECK(warp_points(table, none, in, out) == status::buffer_too_small);
    CHECK(unwarp_points(table, table, guide, guide, in, out.first(4)) == status::buffer_too_small);
    CHECK(unwarp_points(none, table, guide, guide, in, out) == status::buffer_too_small);
    CHECK(unwarp_points(table, table, guide_view{}, guide, in, out) == status::buffer_too_small);
    CHECK(unwarp_points(table, table, guide, guide_view{}, in, out) == status::buffer_too_small);
    for (const glm::vec<2, T>& p : to) {
        CHECK(p == glm::vec<2, T>(T(9)));
    }
    CHECK(unwarp_points(table, table, guide, guide, in, out) == status::ok);
    CHECK(to == from);
}
