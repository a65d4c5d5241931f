// How coarse a method's maps are, sample by sample: measured once, outside of what is timed.
#pragma once

#include "gl/objects.hpp"
#include "lab/light_maps.hpp"
#include "lab/methods.hpp"
#include "lab/passes.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <vector>

namespace lab {

/// Measures `warpshadow/metric.hpp` on the device.
class metric_passes {
  public:
    explicit metric_passes(passes& gpu) : gpu_(gpu) {}

    /// Texel extents of the samples in use that count (n·l > counted_n_dot_l), as the last frame
    /// left the maps.
    /// @return per view sample: along u, along v, largest on the receiver, largest facing; negative
    ///         where there is no sample
    std::vector<glm::vec4> measure(const map_resources& maps, const light_maps& chosen, bool warped,
                                   const glm::mat4& camera);

  private:
    passes& gpu_;
    std::optional<gl::program> plain_, warped_;
};

/// What the extents of all samples come to.
texel_metric metric_of(const std::vector<glm::vec4>& extents, int map_size, glm::ivec2 view);

/// Maximum effective resolution of the maps in use (Rosen 2012, §6) along u and v; without tables
/// that is their size.
glm::dvec2 finest_of(const map_resources& maps, const light_maps& chosen,
                     const warp_options& options);

/// "texel-extent": blue where a pixel has texels to spare, white where it has one, red where a
/// texel covers eight pixels or more, in steps of the logarithm; grey where nothing is measured.
named_picture heat_map(const std::vector<glm::vec4>& extents, glm::ivec2 view);

} // namespace lab
