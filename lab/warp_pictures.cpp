#include "lab/warp_pictures.hpp"

#include "lab/canvas.hpp"

#include <warpshadow/warp.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace lab {

namespace ws = warpshadow;

namespace {

constexpr int grid_lines = 24;

/// Black over blue and orange to white: dark where no view sample falls.
glm::vec3 heat(float t) {
    return glm::clamp(
        glm::vec3(2.2f * t - 0.25f, 1.8f * t - 0.55f, 1.2f * std::sqrt(t) * (1.0f - t) + t * t),
        0.0f, 1.0f);
}

std::vector<float> shades(const std::vector<std::uint32_t>& counts) {
    std::uint32_t most = 1;
    for (const std::uint32_t count : counts) {
        most = std::max(most, count);
    }
    const float scale = 1.0f / std::log1p(static_cast<float>(most));
    std::vector<float> result;
    result.reserve(counts.size());
    for (const std::uint32_t count : counts) {
        result.push_back(std::log1p(static_cast<float>(count)) * scale);
    }
    return result;
}

/// Functions of u in orange and of v in blue, nine of each at most.
named_picture function_picture(const ws::table_view<float>& rows,
                               const ws::table_view<float>& columns, int size) {
    constexpr int most = 9;
    canvas result("warp-functions", size);
    result.line({0.0, 0.0}, {1.0, 1.0}, glm::vec3(0.35f)); // the identity
    for (const ws::table_view<float>* table : {&rows, &columns}) {
        const glm::vec3 colour =
            table == &rows ? glm::vec3(0.95f, 0.6f, 0.2f) : glm::vec3(0.3f, 0.6f, 0.95f);
        const int shown = std::min(table->rows, most);
        for (int i = 0; i < shown; ++i) {
            const int row = (2 * i + 1) * table->rows / (2 * shown);
            const std::size_t first =
                static_cast<std::size_t>(row) * (static_cast<std::size_t>(table->cells) + 1);
            const auto node = [&](int k) {
                return glm::dvec2(
                    static_cast<double>(k) / table->cells,
                    static_cast<double>(table->nodes[first + static_cast<std::size_t>(k)]));
            };
            for (int k = 0; k < table->cells; ++k) {
                result.line(node(k), node(k + 1), colour);
            }
        }
    }
    return std::move(result.picture);
}

/// Texels for an area of the unwarped map against those of a map without a warp: red for more, blue
/// for less, full at 16 times and a sixteenth.
named_picture resolution_picture(const ws::table_view<float>& rows,
                                 const ws::table_view<float>& columns, int size) {
    canvas result("effective-resolution", size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::vec2 p = (glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) /
                                static_cast<float>(size);
            const float density = glm::determinant(ws::jacobian(rows, columns, p));
            const float t = std::clamp(std::log2(std::max(density, 1e-6f)) / 4.0f, -1.0f, 1.0f);
            result.set(x, y,
                       t > 0.0f ? glm::vec3(1.0f, 1.0f - 0.8f * t, 1.0f - 0.9f * t)
                                : glm::vec3(1.0f + 0.9f * t, 1.0f + 0.8f * t, 1.0f));
        }
    }
    return std::move(result.picture);
}

} // namespace

std::vector<named_picture> warp_pictures(const warp_readback& warp) {
    const int size = warp.size;
    const auto at = [size](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
               static_cast<std::size_t>(x);
    };
    const ws::table_view<float> rows{warp.rows, warp.cells, warp.functions};
    const ws::table_view<float> columns{warp.columns, warp.cells, warp.functions};
    const std::vector<float> importance = shades(warp.importance);
    const std::vector<float> half_warped = shades(warp.half_warped);
    // shade of the cell around a place of the map
    const auto cell_of = [&](const std::vector<float>& shade, int x, int y) {
        const glm::ivec2 cell = glm::ivec2(x, y) * warp.cells / size;
        return shade[static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(warp.cells) +
                     static_cast<std::size_t>(cell.x)];
    };

    canvas before("importance", size);
    canvas between("importance-rows-warped", size);
    canvas grid("warp-grid", size);
    std::vector<glm::ivec2> cell(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            before.set(x, y, heat(cell_of(importance, x, y)));
            if (!half_warped.empty()) {
                between.set(x, y, heat(cell_of(half_warped, y, x)));
            }
            const glm::vec2 q = (glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) /
                                static_cast<float>(size);
            const glm::vec2 p = glm::clamp(ws::unwarp(rows, columns, q), 0.0f, 1.0f);
            cell[at(x, y)] = glm::ivec2(p * static_cast<float>(grid_lines));
            const glm::ivec2 texel = glm::min(glm::ivec2(p * static_cast<float>(size)), size - 1);
            grid.set(x, y, heat(cell_of(importance, texel.x, texel.y)));
        }
    }
    for (int y = 0; y + 1 < size; ++y) {
        for (int x = 0; x + 1 < size; ++x) {
            if (cell[at(x, y)] != cell[at(x + 1, y)] || cell[at(x, y)] != cell[at(x, y + 1)]) {
                grid.set(x, y, glm::vec3(0.25f, 0.85f, 0.55f));
            }
        }
    }
    std::vector<named_picture> result;
    result.push_back(std::move(before.picture));
    if (!half_warped.empty()) {
        result.push_back(std::move(between.picture));
    }
    result.push_back(std::move(grid.picture));
    result.push_back(function_picture(rows, columns, size));
    result.push_back(resolution_picture(rows, columns, size));
    return result;
}

named_picture depth_picture(std::span<const float> depth, int size, std::string name) {
    float lo = std::numeric_limits<float>::infinity();
    float hi = 0.0f;
    for (const float d : depth) {
        if (d < 1.0f) {
            lo = std::min(lo, d);
            hi = std::max(hi, d);
        }
    }
    const float scale = hi > lo ? 0.9f / (hi - lo) : 0.0f;
    canvas result(std::move(name), size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const float d = depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
                                  static_cast<std::size_t>(x)];
            result.set(x, y, glm::vec3(d < 1.0f ? 0.05f + (d - lo) * scale : 1.0f));
        }
    }
    return std::move(result.picture);
}

} // namespace lab
