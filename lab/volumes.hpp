// Shadow volumes: shadows of the geometry itself, without a map.
//
// Crow 1977, silhouettes of any triangles after Kim et al. 2008, counted from infinity towards what
// is seen (z-fail: Bilodeau and Songy 1999, Carmack 2000), so that the eye may be in shadow. Counts
// are kept in float: no number of volumes overflows them, as it would a stencil.
#pragma once

#include "lab/methods.hpp"
#include "lab/passes.hpp"
#include "lab/volume_edges.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lab {

/// `sv` on the scene of some passes.
class volume_passes {
  public:
    explicit volume_passes(passes& gpu) : gpu_(gpu) {}

    /// As `renderer::run`.
    method_result run(g_buffer& seen, const view_request& request);

    /// As `renderer::next_frame`.
    /// @param before the camera of the frame before, or nothing
    moving_frame next_frame(g_buffer& seen, const view_request& request,
                            const std::optional<camera_view>& before);

    /// Draws the view and tests all of its samples for shadow.
    void frame(g_buffer& seen, const camera_view& camera, const light_view& light);

    /// Triangles that the sides of the last frame's volumes are made of.
    [[nodiscard]] std::size_t side_triangles() const;
    /// Counts of the last frame per view sample: 0 where it is in no volume.
    [[nodiscard]] std::vector<float> counts() const { return device_->counts.read<float>(); }

  private:
    /// What is made once for a scene and a view.
    struct device {
        device(passes& gpu, const volume_edges& found);

        std::uint32_t edge_count;
        gl::buffer facing, edges, runs, sides, arguments;
        gl::texture counts;
        gl::framebuffer target;
        gl::vertex_array nothing;
        gl::program set_up, find_sides, draw_caps, draw_sides, test;
        [[nodiscard]] std::size_t bytes() const;
    };

    device& ready();
    void find_sides(bool sun);
    void draw_volumes(bool sun);

    passes& gpu_;
    std::optional<device> device_;
    double edges_ms_ = 0.0; ///< that finding the edges took
};

} // namespace lab
