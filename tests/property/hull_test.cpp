// Properties of warpshadow/hull.hpp, against gift wrapping in whole numbers of any size.
#include "exact_geometry.hpp"
#include "point_sets.hpp"

#include <warpshadow/hull.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace warpshadow;

namespace {

template <typename T> using points = point_sets::points<T>;

template <typename T> bool is_finite(const glm::vec<2, T>& p) {
    return std::isfinite(p.x) && std::isfinite(p.y);
}

/// Indices of the true hull of the finite points.
template <typename T> std::vector<std::uint32_t> exact_hull(const points<T>& set) {
    points<T> finite;
    std::vector<std::uint32_t> index;
    for (std::size_t i = 0; i < set.size(); ++i) {
        if (is_finite(set[i])) {
            finite.push_back(set[i]);
            index.push_back(static_cast<std::uint32_t>(i));
        }
    }
    std::vector<std::uint32_t> result;
    for (const std::size_t i : exact::hull(exact::on_grid<T>(finite).points)) {
        result.push_back(index[i]);
    }
    return result;
}

template <typename T> std::vector<std::uint32_t> hull_indices(const points<T>& set, status& flags) {
    std::vector<std::uint32_t> order(set.size());
    const hull_result result = convex_hull<T>(set, order);
    flags = result.flags;
    order.resize(result.count);
    return order;
}

template <typename T> void check_hull(const points<T>& set) {
    const std::vector<std::uint32_t> expected = exact_hull(set);
    status flags{};
    REQUIRE(hull_indices(set, flags) == expected);
    const bool bad = !std::all_of(set.begin(), set.end(), is_finite<T>);
    CHECK(any(flags, status::invalid_input) == bad);
    CHECK(any(flags, status::degenerate_extent) == (!expected.empty() && expected.size() < 3));
    CHECK(any(flags, status::empty_body) == expected.empty());

    points<T> in_place = set;
    const hull_result result = convex_hull(std::span(in_place));
    REQUIRE(result.count == expected.size());
    CHECK(result.flags == flags);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CHECK(in_place[i] == set[expected[i]]);
    }
    // What comes after the hull is the rest of the input.
    if (!bad) {
        const auto before = [](const auto& a, const auto& b) {
            return a.x != b.x ? a.x < b.x : a.y < b.y;
        };
        points<T> sorted = set;
        std::sort(sorted.begin(), sorted.end(), before);
        std::sort(in_place.begin(), in_place.end(), before);
        CHECK(sorted == in_place);
    }
}

} // namespace

TEMPLATE_TEST_CASE("the hull is the exact hull, for every class of points", "[hull]", float,
                   double) {
    for (const point_sets::kind& kind : point_sets::kinds) {
        DYNAMIC_SECTION(std::string(kind.name)) {
            for (std::uint64_t seed = 0; seed < point_sets::sets_of(kind); ++seed) {
                INFO("seed " << seed);
                check_hull(point_sets::make<TestType>(kind.name, seed));
            }
        }
    }
}

TEMPLATE_TEST_CASE("the hull of many points is the exact hull", "[hull]", float, double) {
    // More than the number from which interior points are discarded first.
    using T = TestType;
    for (const auto* name :
         {"random", "integer grid 6x6", "rounded collinear", "rectangles jittered by ulps",
          "mixed scales", "huge 1e20", "one NaN", "one infinity", "tiny 1e-22", "offset 1e8",
          "end of the range", "sliver 1e-5 to 1e-8", "a few ulps off a line", "regular polygons",
          "integer contour"}) {
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            INFO(name << ", seed " << seed);
            points<T> set;
            for (std::uint64_t part = 0; set.size() < 300; ++part) {
                for (const auto& p : point_sets::make<T>(name, 1000 * seed + part)) {
                    set.push_back(p);
                }
            }
            check_hull(set);
        }
    }
}

TEMPLATE_TEST_CASE("of many points in a disk most are inside for certain", "[hull]", float,
                   double) {
    using T = TestType;
    for (const double scale : {1e-30, 1.0, 1e30}) {
        for (const double offset : {0.0, 100.0}) {
            points<T> set;
            for (int i = 0; i < 1000; ++i) { // a spiral, evenly spread
                const double radius = scale * std::sqrt(i / 1000.0);
                set.push_back({T(scale * offset + radius * std::cos(2.4 * i)),
                               T(radius * std::sin(2.4 * i) - scale * offset)});
            }
            const detail::inner_polygon inside(std::span<const glm::vec<2, T>>(set),
                                               detail::point_items{});
            const auto count = std::count_if(set.begin(), set.end(), [&](const auto& p) {
                return inside.contains(glm::dvec2(p));
            });
            CAPTURE(scale, offset);
            CHECK(count > 800);
            check_hull(set);
        }
    }
}

TEMPLATE_TEST_CASE("J26: one point, two points, 24 on a line, all equal", "[hull]", float, double) {
    using T = TestType;
    using P = glm::vec<2, T>;
    points<T> one{P(T(3), T(-2))};
    CHECK(convex_hull(std::span(one)).count == 1);
    points<T> two{P(T(3), T(-2)), P(T(1), T(5))};
    CHECK(convex_hull(std::span(two)).count == 2);
    CHECK(two[0] == P(T(1), T(5)));
    points<T> line;
    for (int i = 0; i < 24; ++i) {
        line.push_back(P(T((i * 7) % 24), T(3 * ((i * 7) % 24))));
    }
    const hull_result on_line = convex_hull(std::span(line));
    CHECK(on_line.count == 2);
    CHECK(on_line.flags == status::degenerate_extent);
    CHECK(line[0] == P(T(0), T(0)));
    CHECK(line[1] == P(T(23), T(69)));
    points<T> equal(24, P(T(1), T(1)));
    CHECK(convex_hull(std::span(equal)).count == 1);
    points<T> none;
    const hull_result nothing = convex_hull(std::span(none));
    CHECK(nothing.count == 0);
    CHECK(nothing.flags == status::empty_body);
}

TEMPLATE_TEST_CASE("the hull does not depend on the order of the points", "[hull]", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const auto seed = *rc::gen::arbitrary<std::uint64_t>();
        const auto& kind = *rc::gen::elementOf(
            std::vector<point_sets::kind>(point_sets::kinds.begin(), point_sets::kinds.end()));
        points<T> a = point_sets::make<T>(kind.name, seed);
        points<T> b = a;
        std::mt19937_64 bits(seed);
        std::shuffle(b.begin(), b.end(), bits);
        const hull_result ra = convex_hull(std::span(a));
        const hull_result rb = convex_hull(std::span(b));
        RC_ASSERT(ra.count == rb.count);
        RC_ASSERT(
            std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(ra.count), b.begin()));
    }));
}

TEMPLATE_TEST_CASE("J23: the hull of scaled points is the scaled hull", "[hull]", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const auto seed = *rc::gen::arbitrary<std::uint64_t>();
        points<T> a = point_sets::make<T>("rectangles jittered by ulps", seed);
        const T scale = std::ldexp(T(1), *rc::gen::inRange(-20, 21));
        points<T> b = a;
        for (auto& p : b) {
            p *= scale;
        }
        const hull_result ra = convex_hull(std::span(a));
        const hull_result rb = convex_hull(std::span(b));
        RC_ASSERT(ra.count == rb.count);
        for (std::size_t i = 0; i < ra.count; ++i) {
            RC_ASSERT(a[i] * scale == b[i]);
        }
    }));
}

TEST_CASE("a short index buffer is reported and left alone", "[hull]") {
    const std::vector<glm::vec2> set{{0, 0}, {1, 0}, {0, 1}};
    std::array<std::uint32_t, 2> order{7, 7};
    const hull_result result = convex_hull<float>(set, order);
    CHECK(result.count == 0);
    CHECK(result.flags == status::buffer_too_small);
    CHECK(order == std::array<std::uint32_t, 2>{7, 7});
}
