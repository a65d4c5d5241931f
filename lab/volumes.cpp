#include "lab/volumes.hpp"

#include "lab/frame_times.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace lab {

namespace ws = warpshadow;

namespace {

/// As in the shaders.
enum binding : GLuint {
    on_positions = 0,
    on_indices = 1,
    on_facing = 2,
    on_sides = 3,
    on_edges = 5,
    on_runs = 6,
    on_arguments = 7
};

/// Of glDrawArraysIndirect; mirror of `draw_arguments` in shaders/volume_edges.comp.
constexpr std::array<std::uint32_t, 4> no_vertices{0, 1, 0, 0};

/// Mirror of `volume_side` in shaders/volume_sides.glsl.
constexpr std::size_t side_bytes = 3 * sizeof(std::uint32_t);

bool is_sun(const light_view& light) {
    return light.light.kind == ws::light_kind::directional;
}

} // namespace

volume_passes::device::device(passes& gpu, const volume_edges& found)
    : edge_count(static_cast<std::uint32_t>(found.edges.size())),
      facing(gpu.world().triangles.size() * sizeof(std::int32_t), nullptr, GL_DYNAMIC_COPY),
      edges(std::span<const glm::uvec4>(found.edges)),
      runs(std::span<const std::uint32_t>(found.runs)),
      sides(found.edges.size() * side_bytes, nullptr, GL_DYNAMIC_COPY),
      arguments(sizeof no_vertices, no_vertices.data(), GL_DYNAMIC_DRAW),
      counts(GL_R32F, gpu.view().x, gpu.view().y), target({&counts}, nullptr),
      set_up(gpu.compute("volume_setup.comp")), find_sides(gpu.compute("volume_edges.comp")),
      draw_caps(gpu.link("volume_cap.vert", "volume_cap.frag")),
      draw_sides(gpu.link("volume_side.vert", "volume_side.frag")),
      test(gpu.compute("volume_test.comp")) {
    passes::set_units(draw_sides);
    passes::set_units(test);
}

std::size_t volume_passes::device::bytes() const {
    return facing.bytes() + edges.bytes() + runs.bytes() + sides.bytes() + arguments.bytes() +
           counts.bytes();
}

volume_passes::device& volume_passes::ready() {
    if (!device_) {
        const auto begin = std::chrono::steady_clock::now();
        const volume_edges found = edges_of(gpu_.world().positions, gpu_.world().triangles);
        const std::chrono::duration<double, std::milli> elapsed =
            std::chrono::steady_clock::now() - begin;
        edges_ms_ = elapsed.count();
        device_.emplace(gpu_, found);
    }
    return *device_;
}

std::size_t volume_passes::side_triangles() const {
    std::array<std::uint32_t, 4> arguments = no_vertices;
    device_->arguments.read(0, sizeof arguments, arguments.data());
    return arguments[0] / 3;
}

void volume_passes::find_sides(bool sun) {
    device& d = *device_;
    const std::size_t triangles = gpu_.world().triangles.size();
    gpu_.mesh().positions().bind_base(GL_SHADER_STORAGE_BUFFER, on_positions);
    gpu_.mesh().indices().bind_base(GL_SHADER_STORAGE_BUFFER, on_indices);
    d.facing.bind_base(GL_SHADER_STORAGE_BUFFER, on_facing);
    d.set_up.set("triangle_count", static_cast<unsigned>(triangles));
    d.set_up.dispatch_over(triangles);
    gl::wait_for_writes();
    d.arguments.write(0, sizeof no_vertices, no_vertices.data());
    d.sides.bind_base(GL_SHADER_STORAGE_BUFFER, on_sides);
    d.edges.bind_base(GL_SHADER_STORAGE_BUFFER, on_edges);
    d.runs.bind_base(GL_SHADER_STORAGE_BUFFER, on_runs);
    d.arguments.bind_base(GL_SHADER_STORAGE_BUFFER, on_arguments);
    d.find_sides.set("edge_count", d.edge_count);
    d.find_sides.set("vertices_per_side", sun ? 3u : 6u);
    d.find_sides.dispatch_over(d.edge_count);
    gl::wait_for_writes();
}

void volume_passes::draw_volumes(bool sun) {
    device& d = *device_;
    d.counts.clear(glm::vec4(0.0f));
    d.target.bind();
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
    d.draw_caps.use();
    d.draw_caps.set("far_end", 0);
    gpu_.mesh().draw();
    if (!sun) { // the sun's volumes end in one point
        d.draw_caps.set("far_end", 1);
        gpu_.mesh().draw();
    }
    d.draw_sides.use();
    d.nothing.bind();
    d.arguments.bind(GL_DRAW_INDIRECT_BUFFER);
    glDrawArraysIndirect(GL_TRIANGLES, nullptr);
    glDisable(GL_BLEND);
}

void volume_passes::frame(g_buffer& seen, const camera_view& camera, const light_view& light) {
    device& d = ready();
    const bool sun = is_sun(light);
    const ws::frustum<double> view = camera_frustum(gpu_.world(), camera, gpu_.view());
    const glm::mat4 matrix = camera_matrix(view);
    gpu_.timed_pass("g-buffer", [&] { gpu_.draw_view(seen, matrix, glm::vec3(camera.eye)); });
    gpu_.use(seen, {}, light.light);
    gpu_.timed_pass("silhouettes", [&] { find_sides(sun); });
    for (const gl::program* program : {&d.draw_caps, &d.draw_sides}) {
        program->set("camera", matrix);
        program->set("near_distance", static_cast<float>(view.volume.near_distance));
    }
    gpu_.timed_pass("shadow volumes", [&] { draw_volumes(sun); });
    gpu_.timed_pass("shadow test", [&] {
        gpu_.mask().bind_image(0, GL_WRITE_ONLY);
        d.counts.bind_image(1, GL_READ_ONLY);
        gl::wait_for_writes();
        d.test.dispatch(gpu_.view().x, gpu_.view().y);
        gl::wait_for_writes();
    });
}

method_result volume_passes::run(g_buffer& seen, const view_request& request) {
    method_result result{};
    const auto draw = [&] { frame(seen, request.camera, request.light); };
    draw(); // warms up
    glFinish();
    time_frames(gpu_, request.repeat, draw, result, request.details);
    gl::check("shadow volumes");
    result.cpu_setup_us.emplace_back("edges, once per scene", 1e3 * edges_ms_);
    result.shadowed = gpu_.shadowed();
    result.bytes = device_->bytes();
    const std::size_t ends = is_sun(request.light) ? 1 : 2;
    result.triangles = ends * gpu_.world().triangles.size() + side_triangles();
    return result;
}

moving_frame volume_passes::next_frame(g_buffer& seen, const view_request& request,
                                       const std::optional<camera_view>& before) {
    moving_frame result{};
    const auto draw = [&] { frame(seen, request.camera, request.light); };
    if (!device_) {
        draw(); // warms up
    }
    if (before) {
        frame(seen, *before, request.light);
        result.shadowed_before = gpu_.shadowed();
    }
    gpu_.watch().start();
    draw();
    result.frame_ms = gpu_.watch().stop();
    result.shadowed = gpu_.shadowed();
    result.shadow_map_ms = time_shadow_passes(gpu_, draw);
    return result;
}

} // namespace lab
