// Builds the warp tables of a map on the device: importance, and the functions of both axes.
#pragma once

#include "lab/axis_passes.hpp"
#include "lab/passes.hpp"
#include "lab/warp_options.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lab {

/// Shadows of the view samples that are known before this frame's are.
struct shadow_memory {
    gl::texture shadowed; ///< per pixel of the view: 1 in shadow
    glm::mat4 camera{1.0f};
    bool known = false;
};

/// The passes that make tables.
class table_passes {
  public:
    explicit table_passes(passes& gpu);

    /// Importance of one map, and the functions of both axes.
    ///
    /// @param before shadows for methods that want to know some; may be empty else
    void build(map_resources& maps, std::size_t index, const warp_options& options,
               const warpshadow::frustum<double>& camera, const shadow_memory& before,
               bool keep_counts);

    /// Importance of one map as the first axis sees it, row by row.
    /// @param before as of `build`
    std::vector<std::uint32_t> importance(map_resources& maps, std::size_t index,
                                          const warp_options& options,
                                          const warpshadow::frustum<double>& camera,
                                          const shadow_memory& before);

    /// Memory of the light's depth image, and of its edges, where tables with these options need
    /// one.
    [[nodiscard]] std::size_t light_image_bytes(const warp_options& options) const;

    /// Keeps the shadows that were tested last.
    void remember(shadow_memory& memory, const warpshadow::frustum<double>& camera);
    /// Keeps shadows of the caller's, one per pixel.
    void remember(shadow_memory& memory, const warpshadow::frustum<double>& camera,
                  const std::vector<std::uint8_t>& shadowed);

  private:
    struct splat_programs {
        gl::program rows, columns;
    };
    void prepare(map_resources& maps, std::size_t index, const warp_options& options,
                 const warpshadow::frustum<double>& camera, const shadow_memory& before);
    void look_from_the_light(std::size_t index, bool mark_edges);
    void splat(map_resources& maps, std::size_t index, const warp_options& options, bool columns);
    void build_axis(map_resources& maps, std::size_t index, const warp_options& options,
                    bool columns, bool keep_counts);
    void build_lines(map_resources& maps, std::size_t index, const warp_options& options,
                     bool keep_counts);
    splat_programs& programs(const warp_options& options);
    [[nodiscard]] std::uint64_t sample_count(const warp_options& options) const;
    [[nodiscard]] float steps(const warp_options& options, int cells) const;
    [[nodiscard]] std::uint64_t most_counts(const warp_options& options) const;

    passes& gpu_;
    std::map<std::vector<std::string>, splat_programs> splats_;
    axis_passes axes_;
    gl::program weigh_cells_, mark_edges_;
    std::array<gl::program, 2> build_line_; ///< by format of the tables
    std::map<std::string, gl::program> collapse_;
    std::optional<map_resources> seen_by_light_; ///< depth image of forward and hybrid analysis
    gl::texture light_edges_;
    shadow_memory none_;
};

} // namespace lab
