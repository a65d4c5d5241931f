// Properties of warpshadow/warp_strength.hpp, against sums and products in long double.
#include "warp_oracle.hpp"

#include <warpshadow/warp_strength.hpp>

#include <catch2/catch.hpp>
#include <glm/vec2.hpp>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

/// Nodes of one increasing function.
template <typename T> std::vector<T> any_function(dice& d, int cells) {
    std::vector<double> sum{0.0};
    for (int k = 0; k < cells; ++k) {
        sum.push_back(sum.back() + d.between(0.05, 1.0));
    }
    std::vector<T> nodes;
    for (const double s : sum) {
        nodes.push_back(static_cast<T>(s / sum.back()));
    }
    return nodes;
}

} // namespace

TEMPLATE_TEST_CASE("the side of a texel is that of the cells' slopes", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int across = d.between(1, 40), along = d.between(1, 40);
        const std::vector<T> u = any_function<T>(d, across), v = any_function<T>(d, along);
        const table_view<T> rows{u, across, 1}, columns{v, along, 1};
        long double sum = 0;
        std::vector<glm::vec<2, T>> samples;
        for (int i = 0; i < 20; ++i) {
            const int x = d.between(0, across - 1), y = d.between(0, along - 1);
            const auto at = [](const std::vector<T>& nodes, int k) {
                return static_cast<long double>(nodes[static_cast<std::size_t>(k)]);
            };
            const long double slope_u = (at(u, x + 1) - at(u, x)) * across;
            const long double slope_v = (at(v, y + 1) - at(v, y)) * along;
            const glm::vec<2, T> p((T(x) + T(0.5)) / T(across), (T(y) + T(0.5)) / T(along));
            const long double side = 1 / std::sqrt(slope_u * slope_v);
            // slopes are differences of nodes: rounded by u of 1 times the cells
            const long double rounding =
                static_cast<long double>(std::numeric_limits<T>::epsilon()) *
                (8 + across / slope_u + along / slope_v);
            RC_ASSERT(std::abs(static_cast<long double>(texel_side(rows, columns, p)) - side) <=
                      side * rounding);
            samples.push_back(p);
            sum += static_cast<long double>(texel_side(rows, columns, p));
        }
        const long double mean = sum / 20;
        RC_ASSERT(std::abs(static_cast<long double>(mean_texel_side<T, T>(rows, columns, samples)) -
                           mean) <=
                  4 * mean * static_cast<long double>(std::numeric_limits<T>::epsilon()));
    }));
}

TEMPLATE_TEST_CASE("weakened functions increase, keep their ends and end at the identity", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.between(1, 64);
        const std::vector<T> nodes = any_function<T>(d, cells);
        const T share = static_cast<T>(d.unit());
        T before = T(-1);
        for (int k = 0; k <= cells; ++k) {
            const T node = nodes[static_cast<std::size_t>(k)];
            const T mixed = weakened_node(node, k, cells, share);
            RC_ASSERT(mixed > before);
            before = mixed;
            RC_ASSERT(weakened_node(node, k, cells, T(0)) == node);
            RC_ASSERT(weakened_node(node, k, cells, T(1)) == T(k) / T(cells));
        }
        RC_ASSERT(weakened_node(nodes.front(), 0, cells, share) == T(0));
        RC_ASSERT(weakened_node(nodes.back(), cells, cells, share) == T(1));
    }));
}

TEMPLATE_TEST_CASE("the weaker the gain the weaker the warp", "", float, double) {
    using T = TestType;
    T before = T(0);
    for (int i = 0; i <= 400; ++i) {
        const T share = weakening(T(i) / T(200));
        CHECK(share >= before);
        CHECK(share - before <= T(0.11)); // a step of the side by 1/200
        before = share;
    }
    CHECK(weakening(side_of_full_warp<T>) == T(0));
    CHECK(weakening(T(1)) == T(1));
    CHECK(weakening(std::numeric_limits<T>::quiet_NaN()) == T(1));
    CHECK(weakening(std::numeric_limits<T>::infinity()) == T(1));
    CHECK(weakening(T(0)) == T(0));
    CHECK(mean_texel_side<T, T>(table_view<T>{}, table_view<T>{}, {}) == T(1));
}
