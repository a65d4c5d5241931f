// Frames of any shadow method, from the G-buffer to the shadow test.
#pragma once

#include "lab/bias_passes.hpp"
#include "lab/light_maps.hpp"
#include "lab/method_table.hpp"
#include "lab/methods.hpp"
#include "lab/metric_passes.hpp"
#include "lab/omni.hpp"
#include "lab/passes.hpp"
#include "lab/tables.hpp"
#include "lab/volumes.hpp"
#include "lab/warped_raster.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

namespace lab {

/// Textures and buffers for so many maps of a method.
map_resources resources_for(const method& how, const view_request& request, std::size_t maps);

/// Maps that a method draws: as many as were chosen, unless its partitions share what was.
std::size_t count_of_maps(const method& how, const light_maps& chosen);

/// What a method draws again and again for a camera that stands still.
struct standing_view {
    map_resources maps;
    shadow_memory shadows;
    light_maps chosen;
};

/// All passes over one scene, and the methods' ways through them.
struct method_frames {
    method_frames(const scene& world, glm::ivec2 view);

    /// Matrices of the maps before anything is known about what is seen.
    light_maps choose_maps(const method& how, const view_request& request,
                           light_memory& memory) const;

    /// One frame from the G-buffer to the shadow test.
    light_maps frame(const method& how, const view_request& request, light_memory& memory,
                     map_resources& maps, const shadow_memory& shadows, bool count);

    /// Makes the lists of triangles long enough; false if they were.
    bool grow_lists(const method& how);

    void forget_counts();
    /// Triangles of the frames that were drawn to be counted.
    const std::vector<triangle_counts>& counted(const method& how) const;

    /// The shadows that a method is told before its first frame.
    shadow_memory told(const method& how, const view_request& request);

    /// Keeps the shadows of a frame for the next, for methods that want them.
    void remember(const method& how, const view_request& request, shadow_memory& shadows);

    /// One frame of a view that stands still.
    void draw(const method& how, const view_request& request, standing_view& view, bool count);

    /// Makes what a view needs. The first frame warms up and, with tables, finds how long the lists
    /// must be.
    standing_view prepare(const method& how, const view_request& request);

    /// Shadow test of the samples in use.
    void test(const method& how, const light_view& light, map_resources& maps,
              const light_maps& chosen);

    passes gpu;
    warped_raster warped{gpu};
    omni_passes omni{gpu};
    bias_passes biased{gpu};
    metric_passes metric{gpu};
    table_passes warps{gpu};
    volume_passes volumes{gpu};
    g_buffer seen;
    std::vector<double> fit_us;     ///< times of the projective fit alone
    std::vector<double> culling_us; ///< times of sorting objects to the maps of a point light
    double weakened = 0.0;          ///< share of the identity in the last tables

  private:
    /// Turns the one map there is, and crops it again.
    void align(const method& how, const warp_options& options,
               const warpshadow::frustum<double>& camera, const shadow_memory& shadows,
               light_memory& memory, map_resources& maps, light_maps& chosen);

    /// Draws one map with tables.
    void draw_warped(const method& how, const view_request& request, map_resources& maps,
                     std::size_t index, bool count);

    /// Splits the depths of the lit samples in equal ratios (practical split of quality alone).
    void split(const method& how, const warpshadow::frustum<double>& camera, light_maps& chosen);

    /// Fits a projective warp to the lit samples of one map.
    void fit(warpshadow::light_kind kind, std::size_t index,
             warpshadow::projective_state<double>& bend, light_maps& chosen);
    template <typename T>
    void fit_at(warpshadow::light_kind kind, std::size_t index,
                warpshadow::projective_state<double>& bend, light_maps& chosen);
};

} // namespace lab
