// Importance maps, points and their exact images.
#include "exact_map.hpp"
#include "frustum_pairs.hpp"
#include "inputs.hpp"
#include "warp_inputs.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace arithmetic {

namespace {

using frustum_pairs::random;

constexpr int cells = 512;
constexpr std::size_t point_count = 4096;

/// A few samples everywhere, none of them special.
std::vector<std::uint32_t> even_counts(random& r) {
    std::vector<std::uint32_t> counts(std::size_t(cells) * cells);
    for (std::uint32_t& n : counts) {
        n = static_cast<std::uint32_t>(r.integer(0, 9));
    }
    return counts;
}

/// Rows that pull to the left and to the right in turn: the largest shear there is.
std::vector<std::uint32_t> opposed_counts(random& r) {
    std::vector<std::uint32_t> counts(std::size_t(cells) * cells);
    for (std::size_t y = 0; y < cells; ++y) {
        const int at = y % 2 == 0 ? cells / 20 : cells - cells / 20;
        for (int i = 0; i < 1000; ++i) {
            ++counts[y * cells + static_cast<std::size_t>(at + r.integer(-3, 3))];
        }
    }
    return counts;
}

void add_truth(warp_case& to, random& r) {
    const exact_axis rows(to.row_counts, to.cells, to.radius, to.floor);
    const exact_axis columns(to.column_counts, to.cells, to.radius, to.floor);
    for (std::size_t i = 0; i < point_count; ++i) {
        const float x = static_cast<float>(r.uniform(0.0, 1.0));
        const float y = static_cast<float>(r.uniform(0.0, 1.0));
        const real u = rows.value(real(y), real(x));
        const real v = columns.value(u, real(y));
        to.points.emplace_back(x, y);
        to.warped.push_back({to_wide(u), to_wide(v)});
        // where samples land: an even share of the warped map
        const glm::vec2 q(static_cast<float>(r.uniform(0.0, 1.0)),
                          static_cast<float>(r.uniform(0.0, 1.0)));
        const real below = columns.inverse(real(q.x), real(q.y));
        const real before = rows.inverse(below, real(q.x));
        to.images.push_back(q);
        to.unwarped.push_back({to_wide(before), to_wide(below)});
    }
}

} // namespace

const std::vector<warp_case>& warp_cases() {
    static const std::vector<warp_case> made = [] {
        random r(1);
        std::vector<warp_case> cases;
        const std::vector<std::uint32_t> even = even_counts(r);
        cases.push_back({"even", cells, 0.25, cells / 4, even, even, {}, {}, {}, {}});
        const std::vector<std::uint32_t> view = warp_inputs::view_counts(cells);
        cases.push_back({"view",
                         cells,
                         0.25,
                         cells / 4,
                         view,
                         warp_inputs::turned(view, cells),
                         {},
                         {},
                         {},
                         {}});
        const std::vector<std::uint32_t> opposed = opposed_counts(r);
        cases.push_back({"sheared", cells, 0x1p-6, 0, opposed, opposed, {}, {}, {}, {}});
        for (warp_case& each : cases) {
            add_truth(each, r);
        }
        return cases;
    }();
    return made;
}

const std::vector<build_case>& build_cases() {
    static const std::vector<build_case> made = [] {
        random r(2);
        std::vector<build_case> cases;
        cases.push_back({"view", cells, 0.25, 20, warp_inputs::view_counts(cells), {}, {}});
        std::vector<std::uint32_t> heavy(std::size_t(cells) * cells, 1u);
        for (std::size_t y = 0; y < cells; ++y) {
            heavy[y * cells + static_cast<std::size_t>(r.integer(0, cells - 1))] = 1u << 25;
        }
        cases.push_back({"heavy cells", cells, 0x1p-6, 20, heavy, {}, {}});
        std::vector<std::uint32_t> full(heavy.size());
        for (std::uint32_t& n : full) {
            n = r.integer(0, 1) == 0 ? std::numeric_limits<std::uint32_t>::max() : 0u;
        }
        cases.push_back({"full counters", cells, 0x1p-6, 20, full, {}, {}});
        for (build_case& each : cases) {
            const exact_axis axis(each.counts, each.cells, each.radius, each.floor);
            for (int row = 0; row < each.cells; row += 31) {
                each.rows.push_back(row);
                for (int k = 0; k <= each.cells; ++k) {
                    each.nodes.push_back(to_wide(axis.node(row, k)));
                }
            }
        }
        return cases;
    }();
    return made;
}

} // namespace arithmetic
