#include "lab/align.hpp"

#include <glm/gtc/matrix_access.hpp>

namespace lab {

namespace ws = warpshadow;

glm::dvec2 extent_of(const glm::dmat4& matrix) {
    const glm::dvec3 depth(glm::row(matrix, 3)); // none for sunlight
    const double square = glm::dot(depth, depth);
    const auto side = [&](int axis) {
        glm::dvec3 along(glm::row(matrix, axis));
        if (square > 0.0) {
            along -= depth * (glm::dot(along, depth) / square);
        }
        return 2.0 * (square > 0.0 ? glm::length(depth) : 1.0) / glm::length(along);
    };
    return {side(0), side(1)};
}

double turn_to_importance(passes& gpu, std::size_t index, std::span<const std::uint32_t> counts,
                          int cells, double angle, ws::axis_state& state) {
    const glm::dvec2 extent = extent_of(glm::dmat4(gpu.matrix_in_use(index)));
    const ws::principal_axis_result<double> axis =
        ws::principal_axis<double>(ws::count_view(counts, cells, cells), extent);
    if (!state.started) {
        state.angle = angle; // a map that is fitted has reasons to lie as it does
    }
    const double turned = ws::turn_to_axis(axis.angle + angle, axis.elongation, {}, state);
    gpu.warp_map(index, ws::turned(glm::dmat4(1.0), extent, turned - angle).matrix);
    return turned;
}

} // namespace lab
