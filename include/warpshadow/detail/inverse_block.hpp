// Several inverses at once: one waits for memory while the others do, and none for a branch.
#pragma once

#include <warpshadow/unwarp_guide.hpp>
#include <warpshadow/warp.hpp>

#include <glm/common.hpp>

#include <cstddef>
#include <cstdint>

namespace warpshadow::detail {

/// Points that are unwarped at once.
inline constexpr std::size_t inverse_block = 16;

/// `axis_inverse_offset` of several points.
///
/// @param table  `fits(table)`
/// @param guide  `fits(guide, table)`
/// @param count  number of points, at most `inverse_block`
/// @param across coordinates across the rows
/// @param image  values of the functions
/// @param offset receives F⁻¹(X) − X
template <typename T, typename Node>
void inverse_offsets(const table_view<T, Node>& table, const guide_view& guide, std::size_t count,
                     const T* across, const T* image, T* offset) {
    const int cells = table.cells;
    const std::size_t stride = static_cast<std::size_t>(cells) + 1;
    const std::size_t guide_stride = static_cast<std::size_t>(guide.steps) + 1;
    row_blend<T> blend[inverse_block];
    const Node* first[inverse_block];
    const Node* second[inverse_block];
    T clamped[inverse_block];
    int below[inverse_block];
    const auto node = [&](std::size_t i, int k) {
        const T node0 = node_value<T>(first[i][k]);
        const T node1 = node_value<T>(second[i][k]);
        return node0 + blend[i].weight * (node1 - node0);
    };

    // halves what is left to search, `size` cells from below[i], by what a branch would choose if
    // processors could foresee it
    const auto halve = [&](std::size_t i, int size) {
        const int half = size / 2;
        const int low = node(i, below[i] + half) <= clamped[i] ? 1 : 0;
        below[i] += -low & half;
    };

    std::size_t wide[inverse_block]; // points with more than a few cells to search
    std::size_t wide_count = 0;
    int widest = 1;
    const int few = cells < 4 ? cells : 4;
    for (std::size_t i = 0; i < count; ++i) {
        blend[i] = blend_rows(across[i], table.rows);
        const auto row0 = static_cast<std::size_t>(blend[i].row0);
        const auto row1 = static_cast<std::size_t>(blend[i].row1);
        first[i] = table.nodes.data() + row0 * stride;
        second[i] = table.nodes.data() + row1 * stride;
        clamped[i] = clamp_to_unit(image[i]);
        const auto step = static_cast<std::size_t>(
            glm::clamp(int(clamped[i] * T(guide.steps)), 0, guide.steps - 1));
        const std::uint16_t* const cell0 = guide.cells.data() + row0 * guide_stride + step;
        const std::uint16_t* const cell1 = guide.cells.data() + row1 * guide_stride + step;
        below[i] = glm::min(glm::min(int(cell0[0]), int(cell1[0])), cells - 1);
        const int above = glm::min(glm::max(int(cell0[1]), int(cell1[1])) + 1, cells);
        widest = glm::max(widest, above - below[i]);
        wide[wide_count] = i;
        wide_count += above - below[i] > few ? 1 : 0;
    }
    // as many cells for each, so that all are found in the same number of steps
    for (std::size_t n = 0; n < wide_count; ++n) {
        below[wide[n]] = glm::min(below[wide[n]], cells - widest);
    }
    for (; widest > few; widest -= widest / 2) {
        for (std::size_t n = 0; n < wide_count; ++n) {
            halve(wide[n], widest);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        below[i] = glm::min(below[i], cells - widest);
    }
    for (; widest > 1; widest -= widest / 2) {
        for (std::size_t i = 0; i < count; ++i) {
            halve(i, widest);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const T node0 = node(i, below[i]);
        const int above = below[i] + 1;
        const T node1 = node(i, above);
        // not so by rounding of the step, or with a guide that is not the table's
        const bool found =
            (node0 <= clamped[i] || below[i] == 0) && (node1 > clamped[i] || above == cells);
        if (!found) {
            offset[i] = axis_inverse_offset(table, guide, blend[i], image[i]);
            continue;
        }
        offset[i] = inverse_offset_in_cell(node0, node1, below[i], cells, clamped[i]);
    }
}

} // namespace warpshadow::detail
