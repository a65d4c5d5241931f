// Draws a hemisphere's paraboloid map with tables: triangles are cut on the device, in space, until
// the arcs that the projection makes of their edges, and what the tables make of those, are
// straight.
#pragma once

#include "gl/objects.hpp"
#include "lab/omni_mesh.hpp"
#include "lab/passes.hpp"
#include "lab/triangle_lists.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace lab {

/// The passes that cut and draw; the tables and the light are those in use.
class hemisphere_raster {
  public:
    explicit hemisphere_raster(passes& gpu);

    /// Expects `passes::use`, and the tables of this map to be built. `count` reads back how many
    /// triangles there were.
    void draw(map_resources& maps, std::size_t side, double far_distance, bool count);

    /// Makes the lists large enough for what was counted since the last call; false if they were.
    bool grow_lists() { return lists_.grow(); }
    void forget_counts() { lists_.forget_counts(); }
    [[nodiscard]] const std::vector<triangle_counts>& counted() const { return lists_.counted(); }
    [[nodiscard]] std::size_t list_bytes() const { return lists_.bytes(); }

  private:
    void cut(const map_resources& maps);

    passes& gpu_;
    gl::program set_up_, cut_, draw_;
    triangle_lists lists_;
};

} // namespace lab
