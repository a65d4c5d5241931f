// Properties of warpshadow/shadow_edges.hpp, against searches that share no code with it.
#include "warp_oracle.hpp"

#include <warpshadow/shadow_edges.hpp>

#include <catch2/catch.hpp>
#include <glm/mat4x4.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

template <typename Texel> struct owned_image {
    int width;
    int height;
    std::vector<Texel> texels;

    owned_image(int w, int h, Texel value)
        : width(w), height(h),
          texels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
    Texel& at(int i, int j) {
        return texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(i)];
    }
    [[nodiscard]] image_view<Texel> view() const { return {texels, width, height}; }
};

/// Flat areas at a few depths, so that edges and plains both occur.
template <typename T> owned_image<T> any_depths(dice& d, int width, int height) {
    owned_image<T> image(width, height, T(1));
    const int boxes = d.between(0, 6);
    for (int box = 0; box < boxes; ++box) {
        const T depth = static_cast<T>(d.between(0, 8)) / T(8);
        const int x = d.between(0, width - 1);
        const int y = d.between(0, height - 1);
        for (int j = y; j < d.between(y, height); ++j) {
            for (int i = x; i < width && i < x + 5; ++i) {
                image.at(i, j) = depth;
            }
        }
    }
    return image;
}

} // namespace

TEMPLATE_TEST_CASE("shadow_end_at asks the nine texels around a point, each at its centre", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        owned_image<T> depths = any_depths<T>(d, d.size(20), d.size(20));
        const glm::vec<3, T> p(static_cast<T>(d.between(-0.1, 1.1)),
                               static_cast<T>(d.between(-0.1, 1.1)),
                               static_cast<T>(d.between(0.0, 1.0)));
        const glm::vec<3, T> normal(static_cast<T>(d.between(-1.0, 1.0)),
                                    static_cast<T>(d.between(-1.0, 1.0)),
                                    static_cast<T>(d.between(0.2, 1.0)));
        const T bias = T(1) / T(1024);
        const int size[2] = {depths.width, depths.height};
        int at[2];
        for (int axis = 0; axis < 2; ++axis) {
            const T along = std::clamp(p[axis], T(0), T(1)) * static_cast<T>(size[axis]);
            at[axis] = std::min(static_cast<int>(along), size[axis] - 1);
        }
        glm::vec<3, T> lit[3];
        for (int y = 0; y < 3; ++y) {
            for (int x = 0; x < 3; ++x) {
                const int i = std::clamp(at[0] + x - 1, 0, size[0] - 1);
                const int j = std::clamp(at[1] + y - 1, 0, size[1] - 1);
                const long double across =
                    static_cast<long double>(normal.x) *
                        ((i + 0.5L) / size[0] - static_cast<long double>(p.x)) +
                    static_cast<long double>(normal.y) *
                        ((j + 0.5L) / size[1] - static_cast<long double>(p.y));
                const long double step = -across / static_cast<long double>(normal.z);
                const long double plane =
                    static_cast<long double>(p.z) + (std::abs(step) <= 1.0L ? step : 0.0L);
                const long double before = plane - static_cast<long double>(bias) -
                                           static_cast<long double>(depths.at(i, j));
                // steps of up to five, of a quotient by 1/5 at least: a dozen roundings
                RC_PRE(std::abs(before) > 100 * roundoff<T>());
                RC_PRE(std::abs(std::abs(step) - 1.0L) > 100 * roundoff<T>());
                lit[y][x] = before > 0.0L ? T(0) : T(1);
            }
        }
        RC_ASSERT(shadow_end_at(depths.view(), p, normal, bias) ==
                  shadow_end(lit[0], lit[1], lit[2]));
    }));
}

TEMPLATE_TEST_CASE("shadow_end_at finds the end of a shadow, not the edge of what throws it", "",
                   float, double) {
    using T = TestType;
    owned_image<T> depths(16, 16, T(0.75)); // a wall before the right half of a floor
    for (int j = 0; j < 16; ++j) {
        for (int i = 8; i < 16; ++i) {
            depths.at(i, j) = T(0.25);
        }
    }
    const glm::vec<3, T> up(T(0), T(0), T(1));
    const T bias = T(0.01);
    const auto at = [&](double u, T depth) {
        return shadow_end_at(depths.view(), glm::vec<3, T>(static_cast<T>(u), T(0.5), depth), up,
                             bias);
    };
    const glm::vec<2, T> none(T(0));
    const glm::vec<2, T> across_u(T(1), T(0));
    CHECK(at(7.9 / 16, T(0.75)) == across_u); // on the floor, beside the wall
    CHECK(at(8.1 / 16, T(0.75)) == across_u); // behind it
    CHECK(at(8.1 / 16, T(0.25)) == none);     // on the wall's own edge
    CHECK(at(6.5 / 16, T(0.75)) == none);     // a texel and a half away
    CHECK(at(9.5 / 16, T(0.75)) == none);
}

TEMPLATE_TEST_CASE("shadow_end_at is total", "", float, double) {
    using T = TestType;
    const T nan = std::numeric_limits<T>::quiet_NaN();
    const T inf = std::numeric_limits<T>::infinity();
    owned_image<T> depths(2, 1, T(0.5));
    depths.at(1, 0) = nan;
    const glm::vec<2, T> none(T(0));
    const glm::vec<3, T> up(T(0), T(0), T(1));
    for (const T bad : {nan, inf, -inf}) {
        CHECK(shadow_end_at(depths.view(), glm::vec<3, T>(bad, T(0.5), T(1)), up, T(0)) == none);
        CHECK(shadow_end_at(depths.view(), glm::vec<3, T>(T(0.5), bad, T(1)), up, T(0)) == none);
        // the depth, the surface and the bias: any answers, but finite ones
        const glm::vec<3, T> p(T(0.5), T(0.5), T(0.75));
        for (const glm::vec<2, T> end :
             {shadow_end_at(depths.view(), glm::vec<3, T>(T(0.5), T(0.5), bad), up, T(0)),
              shadow_end_at(depths.view(), p, glm::vec<3, T>(bad), T(0)),
              shadow_end_at(depths.view(), p, up, bad)}) {
            CHECK((end.x >= T(0) && end.x <= T(1) && end.y >= T(0) && end.y <= T(1)));
        }
    }
    image_view<T> too_large{depths.texels, 3, 1};
    CHECK(shadow_end_at(too_large, glm::vec<3, T>(T(0.5)), up, T(0)) == none);
    CHECK(shadow_end_at(image_view<T>{}, glm::vec<3, T>(T(0.5)), up, T(0)) == none);
}

TEMPLATE_TEST_CASE("mark_depth_edges marks what differs from one of the eight neighbours", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        owned_image<T> depths = any_depths<T>(d, d.size(20), d.size(20));
        const T bias = static_cast<T>(d.between(0, 4)) / T(16);
        std::vector<std::uint8_t> edges(depths.texels.size(), 7);
        RC_ASSERT(mark_depth_edges(depths.view(), bias, std::span(edges)) == status::ok);
        for (int j = 0; j < depths.height; ++j) {
            for (int i = 0; i < depths.width; ++i) {
                bool edge = false;
                for (int y = 0; y < depths.height; ++y) {
                    for (int x = 0; x < depths.width; ++x) {
                        const bool beside = std::abs(x - i) <= 1 && std::abs(y - j) <= 1;
                        edge =
                            edge || (beside && std::abs(depths.at(x, y) - depths.at(i, j)) > bias);
                    }
                }
                const std::size_t index = static_cast<std::size_t>(j * depths.width + i);
                RC_ASSERT((edges[index] == 1) == edge);
                RC_ASSERT(edges[index] <= 1);
            }
        }
    }));
    std::vector<std::uint8_t> few(3, 9);
    CHECK(mark_depth_edges(owned_image<T>(2, 2, T(0)).view(), T(0), std::span(few)) ==
          status::buffer_too_small);
    CHECK(few == std::vector<std::uint8_t>(3, 9));
}

TEMPLATE_TEST_CASE("mark_seen_edges marks lit beside dark on one surface, on both sides", "", float,
                   double) {
    using T = TestType;
    owned_image<std::uint8_t> lit(6, 3, 1);
    owned_image<T> distances(6, 3, T(10));
    for (int j = 0; j < 3; ++j) {
        for (int i = 3; i < 6; ++i) {
            lit.at(i, j) = 0;
        }
    }
    std::vector<std::uint8_t> edges(18, 7);
    REQUIRE(mark_seen_edges(lit.view(), distances.view(), T(0.01), std::span(edges)) == status::ok);
    for (std::size_t i = 0; i < 18; ++i) {
        CHECK(edges[i] == (i % 6 == 2 || i % 6 == 3 ? 1 : 0));
    }
    // the same where the dark half belongs to something nearer: not an edge of a shadow
    for (int j = 0; j < 3; ++j) {
        for (int i = 3; i < 6; ++i) {
            distances.at(i, j) = T(5);
        }
    }
    REQUIRE(mark_seen_edges(lit.view(), distances.view(), T(0.01), std::span(edges)) == status::ok);
    CHECK(edges == std::vector<std::uint8_t>(18, 0));
    // and where there is no receiver
    owned_image<std::uint8_t> sky(6, 3, 255);
    for (int j = 0; j < 3; ++j) {
        sky.at(0, j) = 1;
    }
    REQUIRE(mark_seen_edges(sky.view(), owned_image<T>(6, 3, T(10)).view(), T(0.01),
                            std::span(edges)) == status::ok);
    CHECK(edges == std::vector<std::uint8_t>(18, 0));
    std::vector<std::uint8_t> few(17, 9);
    CHECK(mark_seen_edges(lit.view(), distances.view(), T(0.01), std::span(few)) ==
          status::buffer_too_small);
    CHECK(few == std::vector<std::uint8_t>(17, 9));
}

TEMPLATE_TEST_CASE("edge_at finds the texel that holds a position, and nothing outside", "", float,
                   double) {
    using T = TestType;
    owned_image<std::uint8_t> edges(4, 2, 0);
    edges.at(3, 1) = 1;
    CHECK(edge_at(edges.view(), glm::vec<2, T>(1, 1)));
    CHECK(edge_at(edges.view(), glm::vec<2, T>(T(0.75), T(0.5))));
    CHECK_FALSE(edge_at(edges.view(), glm::vec<2, T>(T(0.74), T(0.5))));
    CHECK_FALSE(edge_at(edges.view(), glm::vec<2, T>(std::nextafter(T(1), T(2)), T(1))));
    CHECK_FALSE(edge_at(edges.view(), glm::vec<2, T>(std::numeric_limits<T>::quiet_NaN(), T(1))));
}

TEMPLATE_TEST_CASE("splat_forward gives each texel of the image its importance, in the map's cell",
                   "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        owned_image<T> depths = any_depths<T>(d, d.size(12), d.size(12));
        forward_options<T> options;
        options.bias = T(0.0625);
        options.steps = T(64);
        options.camera = d.coin() ? clip::opengl : clip::vulkan;
        options.importance.distance = d.coin();
        options.importance.edge = d.coin();
        options.importance.normal = d.coin(); // must not matter
        options.importance.add = d.coin();
        // the camera looks along the light's depth: w = 1, so that depths stay what they are
        options.camera_from_map[0][0] = T(2);
        options.camera_from_map[3][0] = T(-0.75);
        owned_counts map(d.size(6), d.size(6));
        const splat_result result =
            splat_forward(depths.view(), options, cell_rule::sum, map.map());

        std::vector<std::uint8_t> edges(depths.texels.size());
        RC_ASSERT(mark_depth_edges(depths.view(), options.bias, std::span(edges)) == status::ok);
        owned_counts expected(map.width, map.height);
        std::uint64_t weightless = 0;
        for (int j = 0; j < depths.height; ++j) {
            for (int i = 0; i < depths.width; ++i) {
                const T u = (T(i) + T(0.5)) / T(depths.width);
                const T v = (T(j) + T(0.5)) / T(depths.height);
                const T depth = depths.at(i, j);
                const T x = T(2) * u - T(0.75);
                const bool gl = options.camera.depth == depth_range::minus_one_to_one;
                const T distance = gl ? T(1) - depth : T(2) * (T(1) - depth);
                const bool edge = edges[static_cast<std::size_t>(j * depths.width + i)] != 0;
                const T edge_value = edge ? T(1) : options.importance.alpha;
                T value = T(0);
                if (depth != T(1) && std::abs(x) <= T(1)) {
                    const importance_options<T>& f = options.importance;
                    const T a = f.distance ? distance : (f.add ? T(0) : T(1));
                    const T b = f.edge ? edge_value : (f.add ? T(0) : T(1));
                    value = f.add ? (f.distance || f.edge ? a + b : T(1)) : a * b;
                }
                const auto amount = static_cast<std::uint32_t>(std::ceil(value * T(64)));
                weightless += amount == 0 ? 1 : 0;
                expected.at(cell_of(u, map.width), cell_of(v, map.height)) += amount;
            }
        }
        RC_ASSERT(map.counts == expected.counts);
        RC_ASSERT(result.weightless == weightless);
        RC_ASSERT(result.counted == depths.texels.size());
        RC_ASSERT(result.flags == status::ok);
    }));
    owned_counts map(2, 2);
    CHECK(splat_forward(image_view<T>{{}, 1, 1}, forward_options<T>{}, cell_rule::sum, map.map())
              .flags == status::buffer_too_small);
}
