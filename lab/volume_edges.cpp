#include "lab/volume_edges.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace lab {
namespace {

/// Per corner the lowest number of all corners at its place.
std::vector<std::uint32_t> welded(std::span<const glm::vec3> positions) {
    std::vector<std::uint32_t> by_place(positions.size());
    std::iota(by_place.begin(), by_place.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const glm::vec3& p = positions[i];
        return std::tuple(p.x, p.y, p.z, i);
    };
    std::sort(by_place.begin(), by_place.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> result(positions.size());
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < by_place.size(); ++i) {
        if (i == 0 || positions[by_place[i]] != positions[first]) {
            first = by_place[i];
        }
        result[by_place[i]] = first;
    }
    return result;
}

/// One side of one triangle, its corners in order of their numbers.
struct triangle_side {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t run;
};

bool same_edge(const triangle_side& a, const triangle_side& b) {
    return a.low == b.low && a.high == b.high;
}

} // namespace

volume_edges edges_of(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
    const std::vector<std::uint32_t> places = welded(positions);
    std::vector<triangle_side> all;
    all.reserve(3 * triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::array<std::uint32_t, 3> corners{places[triangles[i].x], places[triangles[i].y],
                                                   places[triangles[i].z]};
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const std::uint32_t from = corners[k];
            const std::uint32_t to = corners[(k + 1) % corners.size()];
            if (from != to) {
                all.push_back({std::min(from, to), std::max(from, to),
                               2 * static_cast<std::uint32_t>(i) + (from > to ? 1u : 0u)});
            }
        }
    }
    std::sort(all.begin(), all.end(), [](const triangle_side& a, const triangle_side& b) {
        return std::tie(a.low, a.high, a.run) < std::tie(b.low, b.high, b.run);
    });
    volume_edges result;
    result.runs.reserve(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i == 0 || !same_edge(all[i], all[i - 1])) {
            result.edges.emplace_back(all[i].low, all[i].high, static_cast<std::uint32_t>(i), 0u);
        }
        ++result.edges.back().w;
        result.runs.push_back(all[i].run);
    }
    return result;
}

} // namespace lab
