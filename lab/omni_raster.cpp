#include "lab/omni_raster.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lab {

namespace {

/// When an edge is cut: always above this share of the map (the finest of Rosen 2012), never below
/// so many texels, and in between when it bends by more than the last. Longer edges would
/// hide bends that their parts show, and triangles beside them would be cut without end.
constexpr double always_cut_share = 0.01;
constexpr double never_cut_texels = 0.5;
constexpr double bend_texels = 1.0;

/// A map may be a part of the disc: so many halvings more than the map's side asks for.
constexpr int halvings_to_crop = 16;

/// Places of texels' centres may lie behind the horizon by several texels, where the tables are
/// sparse.
constexpr double overlap_in_texels = 16.0;

constexpr std::size_t piece_bytes = 48;

/// As in the shaders.
enum binding : GLuint { on_positions = 0, on_indices = 1, on_normals = 2 };

} // namespace

hemisphere_raster::hemisphere_raster(passes& gpu)
    : gpu_(gpu), set_up_(gpu.compute("half_setup.comp")), cut_(gpu.compute("half_cut.comp")),
      draw_(gpu.link("half_warped.vert", "half_warped.frag")), lists_(piece_bytes) {}

void hemisphere_raster::cut(const map_resources& maps) {
    lists_.begin();
    gpu_.mesh().positions().bind_base(GL_SHADER_STORAGE_BUFFER, on_positions);
    gpu_.mesh().indices().bind_base(GL_SHADER_STORAGE_BUFFER, on_indices);
    const double shortest = never_cut_texels / maps.size;
    for (const gl::program* program : {&set_up_, &cut_}) {
        program->set("longest", static_cast<float>(always_cut_share));
        program->set("shortest", static_cast<float>(shortest));
        program->set("deviation", static_cast<float>(bend_texels / maps.size));
        program->set("overlap", static_cast<float>(std::min(overlap_in_texels / maps.size, 1.0)));
    }
    const std::size_t triangles = gpu_.world().triangles.size();
    set_up_.set("triangle_count", static_cast<unsigned>(triangles));
    set_up_.dispatch_over(triangles);
    gl::wait_for_writes();
    const int rounds =
        3 * (static_cast<int>(std::ceil(std::log2(std::sqrt(2.0) / shortest))) + halvings_to_crop);
    lists_.cut(cut_, rounds);
}

void hemisphere_raster::draw(map_resources& maps, std::size_t side, double far_distance,
                             bool count) {
    if (lists_.empty()) {
        lists_.make_room_for(gpu_.world().triangles.size());
    }
    for (const gl::program* program : {&set_up_, &cut_, &draw_}) {
        program->set("map_index", static_cast<int>(side));
    }
    gpu_.face_normal_buffer().bind_base(GL_SHADER_STORAGE_BUFFER, on_normals);
    passes::bind_tables(maps, side);
    gpu_.timed_pass("cut triangles", [&] { cut(maps); });
    gpu_.timed_pass("shadow map", [&] {
        maps.targets[side].bind();
        glClear(GL_DEPTH_BUFFER_BIT);
        draw_.set("far_distance", static_cast<float>(far_distance));
        draw_.use();
        lists_.draw();
    });
    if (count) {
        lists_.count(lists_.counts());
    }
}

} // namespace lab
