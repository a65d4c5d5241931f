#include "lab/scene_detail.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace lab {

void refine(scene& world, std::size_t corners) {
    const auto least = static_cast<double>(3 * world.triangles.size());
    const double wanted = std::sqrt(static_cast<double>(corners) / least);
    // of two neighbouring numbers of parts, the one whose square is closer
    double parts = std::max(std::floor(wanted), 1.0);
    if ((parts + 1.0) * (parts + 1.0) + parts * parts < 2.0 * wanted * wanted) {
        parts += 1.0;
    }
    if (parts == 1.0) {
        return;
    }
    if (least * parts * parts > 3.0 * 0x1p26) {
        throw bad_input("scene '" + world.name + "' would have more than 2^26 triangles");
    }
    const int k = static_cast<int>(parts);
    const std::size_t pieces = static_cast<std::size_t>(k) * static_cast<std::size_t>(k);
    const std::vector<glm::uvec3> triangles = std::move(world.triangles);
    const std::vector<glm::vec3> places = std::move(world.positions);
    const std::vector<std::uint8_t> materials = std::move(world.material_of);
    world.triangles = {};
    world.positions = {};
    world.material_of = {};
    world.triangles.reserve(triangles.size() * pieces);
    world.material_of.reserve(triangles.size() * pieces);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::dvec3 a(places[triangles[i].x]);
        const glm::dvec3 b(places[triangles[i].y]);
        const glm::dvec3 c(places[triangles[i].z]);
        const auto first = static_cast<unsigned>(world.positions.size());
        for (int row = 0; row <= k; ++row) {
            for (int column = 0; column <= row; ++column) {
                // exact in double but for the division: the same from either side of an edge
                const glm::dvec3 sum = static_cast<double>(k - row) * a +
                                       static_cast<double>(row - column) * b +
                                       static_cast<double>(column) * c;
                world.positions.emplace_back(sum / parts);
            }
        }
        const auto at = [&](int row, int column) {
            return first + static_cast<unsigned>(row * (row + 1) / 2 + column);
        };
        for (int row = 0; row < k; ++row) {
            for (int column = 0; column <= row; ++column) {
                world.triangles.emplace_back(at(row, column), at(row + 1, column),
                                             at(row + 1, column + 1));
                if (column < row) {
                    world.triangles.emplace_back(at(row, column), at(row + 1, column + 1),
                                                 at(row, column + 1));
                }
            }
        }
        world.material_of.insert(world.material_of.end(), pieces, materials[i]);
    }
    for (std::size_t& part : world.parts) {
        part *= pieces;
    }
    world.name += ":" + std::to_string(3 * world.triangles.size());
}

} // namespace lab
