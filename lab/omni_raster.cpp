#include "lab/omni_raster.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lab {

namespace {

/// When an edge is cut, as for the maps of matrices: always above this share of the map, never
/// below so many texels, and in between when it bends by more than the last. Longer edges would
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
constexpr std::size_t most_pieces = std::size_t{1} << 22;

/// As in the shaders.
enum binding : GLuint {
    on_positions = 0,
    on_indices = 1,
    on_normals = 2,
    on_counts = 6,
    on_ready = 7,
    on_waiting = 8,
    on_next = 9
};

} // namespace

hemisphere_raster::hemisphere_raster(passes& gpu)
    : gpu_(gpu), set_up_(gpu.compute("half_setup.comp")), cut_(gpu.compute("half_cut.comp")),
      draw_(gpu.link("half_warped.vert", "half_warped.frag")),
      counters_(sizeof(triangle_counts), nullptr, GL_DYNAMIC_DRAW) {}

void hemisphere_raster::set_capacity(std::size_t ready_count, std::size_t waiting_count) {
    ready_ = gl::buffer(ready_count * piece_bytes, nullptr, GL_DYNAMIC_COPY);
    for (gl::buffer& list : waiting_) {
        list = gl::buffer(waiting_count * piece_bytes, nullptr, GL_DYNAMIC_COPY);
    }
}

void hemisphere_raster::cut(const map_resources& maps) {
    const triangle_counts none;
    counters_.write(0, sizeof none, &none);
    gpu_.mesh().positions().bind_base(GL_SHADER_STORAGE_BUFFER, on_positions);
    gpu_.mesh().indices().bind_base(GL_SHADER_STORAGE_BUFFER, on_indices);
    waiting_[0].bind_base(GL_SHADER_STORAGE_BUFFER, on_waiting);
    const double shortest = never_cut_texels / maps.size;
    for (const gl::program* program : {&set_up_, &cut_}) {
        program->set("longest", static_cast<float>(always_cut_share));
        program->set("shortest", static_cast<float>(shortest));
        program->set("deviation", static_cast<float>(bend_texels / maps.size));
        program->set("overlap", static_cast<float>(std::min(overlap_in_texels / maps.size, 1.0)));
    }
    const int triangles = static_cast<int>(gpu_.world().triangles.size());
    set_up_.set("triangle_count", triangles);
    set_up_.dispatch(triangles);
    gl::wait_for_writes();
    const int rounds =
        3 * (static_cast<int>(std::ceil(std::log2(std::sqrt(2.0) / shortest))) + halvings_to_crop);
    for (int round = 0; round < rounds; ++round) {
        const std::size_t source = static_cast<std::size_t>(round % 2);
        const std::uint32_t zero = 0;
        counters_.write(offsetof(triangle_counts, waiting) + (1 - source) * sizeof zero,
                        sizeof zero, &zero);
        waiting_[source].bind_base(GL_SHADER_STORAGE_BUFFER, on_waiting);
        waiting_[1 - source].bind_base(GL_SHADER_STORAGE_BUFFER, on_next);
        cut_.set("list", static_cast<int>(source));
        cut_.set("last_round", static_cast<int>(round + 1 == rounds));
        cut_.dispatch(64 * 64);
        gl::wait_for_writes();
    }
}

void hemisphere_raster::draw(map_resources& maps, std::size_t side, double far_distance,
                             bool count) {
    if (ready_.bytes() == 0) {
        set_capacity(2 * gpu_.world().triangles.size() + 65536, 65536);
    }
    for (const gl::program* program : {&set_up_, &cut_, &draw_}) {
        program->set("map_index", static_cast<int>(side));
    }
    gpu_.face_normal_buffer().bind_base(GL_SHADER_STORAGE_BUFFER, on_normals);
    counters_.bind_base(GL_SHADER_STORAGE_BUFFER, on_counts);
    ready_.bind_base(GL_SHADER_STORAGE_BUFFER, on_ready);
    passes::bind_tables(maps, side);
    gpu_.timed_pass("cut triangles", [&] { cut(maps); });
    gpu_.timed_pass("shadow map", [&] {
        maps.targets[side].bind();
        glClear(GL_DEPTH_BUFFER_BIT);
        draw_.set("far_distance", static_cast<float>(far_distance));
        draw_.use();
        nothing_.bind();
        counters_.bind(GL_DRAW_INDIRECT_BUFFER);
        glDrawArraysIndirect(GL_TRIANGLES, nullptr);
        gl::wait_for_writes();
    });
    if (count) {
        counted_.push_back(counters_.read<triangle_counts>().front());
    }
}

bool hemisphere_raster::grow_lists() {
    const std::size_t ready_count = ready_.bytes() / piece_bytes;
    const std::size_t waiting_count = waiting_[0].bytes() / piece_bytes;
    const bool lost = std::any_of(counted_.begin(), counted_.end(),
                                  [](const triangle_counts& each) { return each.lost > 0; });
    const bool crowded = std::any_of(counted_.begin(), counted_.end(),
                                     [](const triangle_counts& each) { return each.crowded > 0; });
    if ((!lost && !crowded) || ready_count > most_pieces || waiting_count > most_pieces) {
        return false;
    }
    counted_.clear();
    set_capacity(lost ? 2 * ready_count : ready_count, crowded ? 2 * waiting_count : waiting_count);
    return true;
}

std::size_t hemisphere_raster::list_bytes() const {
    return ready_.bytes() + waiting_[0].bytes() + waiting_[1].bytes();
}

} // namespace lab
