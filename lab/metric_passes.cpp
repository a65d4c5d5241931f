#include "lab/metric_passes.hpp"

#include "lab/measure.hpp"

#include <warpshadow/filter.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lab {
namespace {

namespace ws = warpshadow;

/// More than any image has pixels: receivers along the light.
constexpr float most = 1.0e6f;

ws::metric_summary<double> summary_of(std::vector<ws::texel_extent<double>>& extents, int map_size,
                                      glm::ivec2 view) {
    return ws::summarise(std::span(extents), glm::dvec2(map_size), glm::dvec2(view));
}

} // namespace

std::vector<glm::vec4> metric_passes::measure(const map_resources& maps, const light_maps& chosen,
                                              bool warped, const glm::mat4& camera) {
    std::optional<gl::program>& program = warped ? warped_ : plain_;
    if (!program) {
        program = warped ? gpu_.compute("texel_extent.comp", {"WARPED"})
                         : gpu_.compute("texel_extent.comp");
        passes::set_units(*program);
    }
    gl::texture extents(GL_RGBA32F, gpu_.view().x, gpu_.view().y);
    extents.clear(glm::vec4(-1.0f));
    extents.bind_image(0, GL_WRITE_ONLY);
    program->set("camera", camera);
    program->set("most", most);
    program->set("least_cosine", counted_n_dot_l);
    passes::bind_depth(maps);
    for (std::size_t i = 0; i < (warped ? chosen.maps.size() : 1); ++i) {
        if (warped) {
            if (!chosen.maps[i].used) {
                continue;
            }
            program->set("map_index", static_cast<int>(i));
            passes::bind_tables(maps, i);
        }
        program->dispatch(gpu_.view().x, gpu_.view().y);
    }
    gl::wait_for_writes();
    return extents.read<glm::vec4>();
}

texel_metric metric_of(const std::vector<glm::vec4>& extents, int map_size, glm::ivec2 view) {
    std::vector<ws::texel_extent<double>> on_receivers;
    std::vector<ws::texel_extent<double>> facing;
    for (const glm::vec4& each : extents) {
        if (each.z >= 0.0f) {
            const glm::dvec4 m(each);
            on_receivers.push_back({m.x, m.y, m.z});
            facing.push_back({m.w, m.w, m.w});
        }
    }
    return {summary_of(on_receivers, map_size, view), summary_of(facing, map_size, view)};
}

glm::dvec2 finest_of(const map_resources& maps, const light_maps& chosen,
                     const warp_options& options) {
    glm::dvec2 finest(maps.size);
    const auto along = [&](const gl::texture& table) {
        const std::vector<float> nodes = nodes_of(table);
        const ws::table_view<float> view{nodes, table.width() - 1, table.height()};
        return static_cast<double>(ws::maximum_effective_resolution(view, maps.size));
    };
    for (std::size_t i = 0; i < maps.warps.size(); ++i) {
        if (chosen.maps[i].used) {
            const glm::dvec2 found(along(maps.warps[i].rows), along(maps.warps[i].columns));
            finest = glm::max(finest, options.build.v_first ? glm::dvec2(found.y, found.x) : found);
        }
    }
    return finest;
}

named_picture heat_map(const std::vector<glm::vec4>& extents, glm::ivec2 view) {
    constexpr glm::vec3 spare(0.13f, 0.36f, 0.72f);
    constexpr glm::vec3 even(0.97f);
    constexpr glm::vec3 coarse(0.75f, 0.1f, 0.12f);
    constexpr glm::vec3 nothing(0.35f);
    named_picture picture{"texel-extent", view.x, view.y, {}};
    picture.rgb.reserve(3 * extents.size());
    for (int y = view.y - 1; y >= 0; --y) { // pictures start at the top
        for (int x = 0; x < view.x; ++x) {
            const float m = extents[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.x) +
                                    static_cast<std::size_t>(x)]
                                .z;
            glm::vec3 colour = nothing;
            if (m >= 0.0f) {
                const float octaves = std::clamp(std::log2(std::max(m, 1.0e-6f)), -3.0f, 3.0f);
                colour = glm::mix(even, octaves < 0.0f ? spare : coarse, std::abs(octaves) / 3.0f);
            }
            for (glm::length_t i = 0; i < 3; ++i) {
                picture.rgb.push_back(static_cast<std::uint8_t>(colour[i] * 255.0f + 0.5f));
            }
        }
    }
    return picture;
}

} // namespace lab
