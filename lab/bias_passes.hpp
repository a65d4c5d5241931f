// Shadow maps and shadow tests with a bias, and filtered shadows for pictures.
#pragma once

#include "gl/objects.hpp"
#include "lab/bias.hpp"
#include "lab/light_maps.hpp"
#include "lab/passes.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace lab {

/// Steps of a frame that take the place of those of `passes` when a bias is compared.
class bias_passes {
  public:
    explicit bias_passes(passes& gpu) : gpu_(gpu) {}

    /// Draws a map without tables: rasterised depth of all faces, or what the choice asks for.
    void draw_map(map_resources& maps, std::size_t index, const light_maps& chosen,
                  const bias_choice& how);
    /// Shadow test of all samples in use, into the mask of `passes`.
    void test(map_resources& maps, const light_maps& chosen, bool warped, const bias_choice& how);
    /// What the bias does to each sample.
    std::vector<bias_sample> measure(map_resources& maps, const light_maps& chosen, bool warped,
                                     const bias_choice& how);
    /// Filters the shadows of all samples; samples and camera as in use.
    /// @param fresh the view is another than that of the last call: a blur reads its depths
    void filter(map_resources& maps, const light_maps& chosen, bool warped, const bias_choice& how,
                const filter_choice& filter, const g_buffer& seen,
                const warpshadow::frustum<double>& camera, bool fresh);
    /// Share of the light that reaches each sample, as it was filtered last.
    [[nodiscard]] std::vector<float> light() const { return share_.read<float>(); }

  private:
    /// Programs with and without tables and linear depth; linked when they are first used.
    struct variants {
        std::array<std::optional<gl::program>, 3> programs;
    };
    const gl::program& find(variants& all, const char* file,
                            const std::vector<std::string>& defines, bool warped,
                            const bias_choice& how);
    /// Runs a program over the samples, for each map that has tables.
    void dispatch(const gl::program& program, map_resources& maps, const light_maps& chosen,
                  bool warped, const bias_choice& how, float radius);

    passes& gpu_;
    gl::texture share_, blurred_;
    float full_blur_depth_ = 1.0f;
    std::optional<gl::program> draw_linear_, draw_back_, blur_;
    variants test_, measure_, filter_, kernel_;
};

} // namespace lab
