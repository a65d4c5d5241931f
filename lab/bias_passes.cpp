#include "lab/bias_passes.hpp"

#include <warpshadow/bias.hpp>

#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace lab {
namespace {

namespace ws = warpshadow;

/// What shaders/linear_depth.glsl needs; all maps of a light without faces share it.
void set_linear(const gl::program& program, const scene& world, const light_map& map) {
    // sunlight has w = 1, and any range of depths; a light with a position has its NDC
    const bool sun = glm::dvec3(glm::row(map.matrix, 3)) == glm::dvec3(0.0) || map.linear.x != 1.0;
    glm::dvec4 own_w(0.0, 0.0, 0.0, 1.0);
    double lo = -1.0;
    double hi = 1.0;
    if (!sun) {
        own_w = glm::row(map.matrix, 3);
    } else {
        lo = std::numeric_limits<double>::infinity();
        hi = -lo;
        for (const glm::dvec3& corner : corners_of(world.box)) {
            const glm::dvec4 clip = map.matrix * glm::dvec4(corner, 1.0);
            const double depth = ws::linear_depth(clip.z / clip.w, clip.w, map.linear);
            lo = std::min(lo, depth);
            hi = std::max(hi, depth);
        }
    }
    // a depth range of no extent is drawn at 0
    const double scale = hi > lo ? 1.0 / (hi - lo) : 0.0;
    program.set("linear_warp", glm::vec3(map.linear));
    program.set("linear_light", glm::vec4(own_w));
    program.set("linear_range", glm::vec2(glm::dvec2(scale, -lo * scale)));
}

/// Median depth of what is seen: the nearer half is blurred in full.
float full_blur_depth(const std::vector<glm::vec4>& positions, const glm::vec4& depth_plane) {
    std::vector<float> depths;
    for (const glm::vec4& p : positions) {
        if (p.w != 0.0f) {
            depths.push_back(glm::dot(depth_plane, p));
        }
    }
    if (depths.empty()) {
        return 1.0f;
    }
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    return *middle;
}

} // namespace

const gl::program& bias_passes::find(variants& all, const char* file,
                                     const std::vector<std::string>& defines, bool warped,
                                     const bias_choice& how) {
    const bool linear = how.depth == depth_kind::linear;
    std::optional<gl::program>& found = all.programs[warped ? 1 : linear ? 2 : 0];
    if (!found) {
        std::vector<std::string> with = defines;
        if (warped || linear) {
            with.emplace_back(warped ? "WARPED" : "LINEAR");
        }
        found = gpu_.compute(file, with);
        passes::set_units(*found);
    }
    return *found;
}

void bias_passes::draw_map(map_resources& maps, std::size_t index, const light_maps& chosen,
                           const bias_choice& how) {
    if (how.depth == depth_kind::hyperbolic) {
        gpu_.draw_plain_map(maps, index);
        return;
    }
    const bool linear = how.depth == depth_kind::linear;
    std::optional<gl::program>& program = linear ? draw_linear_ : draw_back_;
    if (!program) {
        program =
            gpu_.link("shadow_placed.vert", linear ? "shadow_linear.frag" : "shadow_back.frag");
    }
    program->set("map_index", static_cast<int>(index));
    if (linear) {
        set_linear(*program, gpu_.world(), chosen.maps[index]);
    }
    maps.targets[index].bind();
    glClear(GL_DEPTH_BUFFER_BIT);
    gpu_.face_normal_buffer().bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    program->use();
    gpu_.mesh().draw();
}

void bias_passes::dispatch(const gl::program& program, map_resources& maps,
                           const light_maps& chosen, bool warped, const bias_choice& how,
                           float radius) {
    passes::bind_depth(maps);
    program.set("bias_kind", static_cast<int>(how.kind));
    const bool slope = how.kind == bias_kind::slope;
    program.set(
        "bias_value",
        glm::vec2(static_cast<float>(how.value.value_or(
                      slope ? ws::polygon_offset_factor(static_cast<double>(radius)) : 0.0)),
                  static_cast<float>(how.units.value_or(1.0))));
    program.set("bias_radius", radius);
    if (how.depth == depth_kind::linear) {
        set_linear(program, gpu_.world(), chosen.maps.front());
    }
    for (std::size_t i = 0; i < (warped ? chosen.maps.size() : 1); ++i) {
        if (warped) {
            if (!chosen.maps[i].used) {
                continue;
            }
            program.set("map_index", static_cast<int>(i));
            passes::bind_tables(maps, i);
        }
        program.dispatch(gpu_.view().x, gpu_.view().y);
    }
    gl::wait_for_writes();
}

void bias_passes::test(map_resources& maps, const light_maps& chosen, bool warped,
                       const bias_choice& how) {
    gpu_.mask().bind_image(0, GL_WRITE_ONLY);
    if (warped) {
        gpu_.mask().clear(glm::uvec4(1u)); // the background is in no map
    }
    dispatch(find(test_, "bias_test.comp", {}, warped, how), maps, chosen, warped, how, 0.0f);
}

std::vector<bias_sample> bias_passes::measure(map_resources& maps, const light_maps& chosen,
                                              bool warped, const bias_choice& how) {
    gl::texture measured(GL_RGBA32F, gpu_.view().x, gpu_.view().y);
    measured.clear(glm::vec4(0.0f, 0.0f, 0.0f, -1.0f));
    measured.bind_image(0, GL_WRITE_ONLY);
    dispatch(find(measure_, "bias_test.comp", {"MEASURE"}, warped, how), maps, chosen, warped, how,
             0.0f);
    std::vector<bias_sample> result;
    for (const glm::vec4& each : measured.read<glm::vec4>()) {
        result.push_back({each.x, each.y, each.z, each.w});
    }
    return result;
}

void bias_passes::filter(map_resources& maps, const light_maps& chosen, bool warped,
                         const bias_choice& how, const filter_choice& filter, const g_buffer& seen,
                         const ws::frustum<double>& camera, bool fresh) {
    const glm::ivec2 size = gpu_.view();
    if (share_.id() == 0) {
        share_ = gl::texture(GL_R32F, size.x, size.y);
    }
    share_.clear(glm::vec4(0.0f));
    share_.bind_image(0, GL_WRITE_ONLY);
    if (has_kernel(filter.kind)) {
        const gl::program& kernel = find(kernel_, "kernel_light.comp", {"KERNEL"}, warped, how);
        kernel.set("kernel_kind", static_cast<int>(filter.kind));
        kernel.set("kernel_radius", static_cast<float>(filter.radius));
        dispatch(kernel, maps, chosen, warped, how, 0.0f); // the kernel knows how far it reaches
    } else {
        dispatch(find(filter_, "filtered_light.comp", {}, warped, how), maps, chosen, warped, how,
                 0.5f);
    }
    if (filter.kind == shadow_filter::blur && filter.blurs > 0) {
        if (!blur_) {
            blur_ = gpu_.compute("blur.comp");
            passes::set_units(*blur_);
            blurred_ = gl::texture(GL_R32F, size.x, size.y);
        }
        const glm::dvec3 forward = glm::normalize(camera.forward);
        const glm::vec4 plane(glm::dvec4(forward, -glm::dot(forward, camera.eye)));
        if (fresh) { // an engine would keep it from the frame before
            full_blur_depth_ = filter.less_with_depth
                                   ? full_blur_depth(seen.position.read<glm::vec4>(), plane)
                                   : std::numeric_limits<float>::max();
        }
        blur_->set("view_depth_plane", plane);
        blur_->set("ws_blur_edge", 0.01f);
        blur_->set("ws_blur_full_depth", full_blur_depth_);
        for (int i = 0; i < filter.blurs; ++i) {
            for (const glm::ivec2 axis : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
                share_.bind(4);
                blurred_.bind_image(0, GL_WRITE_ONLY);
                blur_->set("ws_blur_axis", axis);
                blur_->dispatch(size.x, size.y);
                gl::wait_for_writes();
                std::swap(share_, blurred_);
            }
        }
    }
}

} // namespace lab
