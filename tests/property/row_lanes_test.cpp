// Properties of warpshadow/detail/row_lanes.hpp: vectors do what one count at a time does.
//
// Built twice, for any machine and for this one: the vectors differ.
#include "warp_oracle.hpp"

#include <warpshadow/detail/row_lanes.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

using namespace warpshadow::detail;
using namespace warp_test;

namespace {

using numbers = std::vector<std::uint32_t>;

numbers any_row(dice& d, std::size_t width) {
    numbers row(width);
    const int kind = d.between(0, 3);
    for (std::uint32_t& n : row) {
        n = kind == 0   ? largest_count
            : kind == 1 ? static_cast<std::uint32_t>(d.between(0, 3))
            : kind == 2 ? static_cast<std::uint32_t>(d.bits()) >> d.between(0, 31)
                        : 0u;
    }
    if (kind == 3) {
        row[static_cast<std::size_t>(d.between(0, static_cast<int>(width) - 1))] = largest_count;
    }
    return row;
}

/// Sums of a window whose total is below 2^31.
numbers any_window(dice& d, std::size_t width) {
    numbers sums(width);
    std::uint32_t left = (std::uint32_t(1) << 31) - 1;
    for (std::uint32_t& n : sums) {
        n = std::min(left, static_cast<std::uint32_t>(d.bits()) >> d.between(1, 31));
        left -= n;
    }
    return sums;
}

template <bool Write, bool Add, bool Remove> void check_step() {
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const auto width = static_cast<std::size_t>(d.between(1, d.coin() ? 100 : 600));
        const numbers before = any_window(d, width);
        const numbers in = any_row(d, width);
        const numbers out = any_row(d, width);
        std::uint64_t total = 0;
        for (const std::uint32_t n : before) {
            total += n;
        }
        const double floor = d.coin() ? d.unit() : static_cast<double>(width) * 0x1p-23;
        const double a = total == 0 ? 0.0 : (1.0 - floor) / static_cast<double>(total);
        const double b = (total == 0 ? 1.0 : floor) / static_cast<double>(width);
        numbers sums = before;
        std::vector<float> nodes(width + 3, -1.0f);
        const moved_row moved = step_row<Write, Add, Remove>(
            sums.data(), width, {in.data(), out.data(), a, b, nodes.data() + 1});

        std::uint64_t added = 0;
        std::uint32_t left = 0;
        for (std::size_t i = 0; i < width; ++i) {
            const std::uint32_t sum = before[i] + (Add ? in[i] : 0u) - (Remove ? out[i] : 0u);
            RC_ASSERT(sums[i] == sum);
            added += Add ? in[i] : 0u;
            left += sum;
        }
        RC_ASSERT(moved.added == added);
        RC_ASSERT(moved.total == left);
        RC_ASSERT(nodes.front() == -1.0f && nodes.back() == -1.0f);
        if (!Write) {
            return;
        }
        RC_ASSERT(nodes[1] == 0.0f && nodes[width + 1] == 1.0f);
        std::uint64_t upto = 0;
        for (std::size_t k = 1; k < width; ++k) {
            upto += before[k - 1];
            // in 64 bits of mantissa; what is rounded before is at most four steps of double
            const long double exact = static_cast<long double>(upto) * static_cast<long double>(a) +
                                      static_cast<long double>(k) * static_cast<long double>(b);
            const auto node = static_cast<long double>(nodes[k + 1]);
            int exponent = 0;
            std::frexp(static_cast<double>(exact), &exponent);
            RC_ASSERT(std::abs(node - exact) <=
                      static_cast<long double>(std::ldexp(1.0, exponent - 25)) +
                          4.0L * exact * 0x1p-53L);
            RC_ASSERT(nodes[k + 1] > nodes[k]);
        }
    }));
}

} // namespace

TEST_CASE("step_row: nodes of the window as it was, rounded once, and the window moved on") {
    SECTION("a row comes and a row goes") {
        check_step<true, true, true>();
    }
    SECTION("a row comes") {
        check_step<true, true, false>();
    }
    SECTION("a row goes") {
        check_step<true, false, true>();
    }
    SECTION("the last row of a band") {
        check_step<true, false, false>();
    }
    SECTION("before the first row of a band") {
        check_step<false, true, false>();
    }
}

TEST_CASE("step_row: the sum of a row of full counters is exact, at every width") {
    for (std::size_t width = 1; width <= 4096; width += width < 70 ? 1 : 503) {
        const numbers in(width, largest_count);
        numbers sums(width, 0);
        const moved_row moved = step_row<false, true, false>(
            sums.data(), width, {in.data(), nullptr, 0.0, 0.0, nullptr});
        INFO(width);
        CHECK(moved.added == std::uint64_t(width) * largest_count);
        // just below what makes the lanes overflow, and at it
        for (const std::uint64_t bound :
             {(std::uint64_t(1) << 32) / width - 1,
              std::min<std::uint64_t>((std::uint64_t(1) << 32) / width, largest_count)}) {
            const numbers row(width, static_cast<std::uint32_t>(bound));
            CHECK(step_row<false, true, false>(sums.data(), width,
                                               {row.data(), nullptr, 0.0, 0.0, nullptr})
                      .added == width * bound);
        }
    }
}
