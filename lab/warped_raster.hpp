// Shadow maps with warp tables: how triangles get into them.
#pragma once

#include "lab/passes.hpp"
#include "lab/texel_raster.hpp"
#include "lab/triangle_lists.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

class ray_tracer;

/// What is done about straight lines that the warp bends.
enum class raster_kind {
    none = 0,     ///< warped corners, everything between interpolated
    fragment = 1, ///< the same, with the depth of the unwarped place per fragment
    rule = 2,     ///< and edges cut down to a share of the map (Rosen 2012, Milet et al. 2015)
    bound = 3,    ///< and edges cut until they depart by no more than is allowed
    hull = 4,     ///< hulls of the curved triangles; depth and coverage per fragment
    exact = 5,    ///< the same without hulls and rasteriser: texel by texel
    ideal = 6     ///< no rasteriser: a ray per texel
};

/// One of them, with its number.
struct raster_choice {
    raster_kind kind = raster_kind::exact;
    double value = 0.0; ///< rule: per cent of the map; bound: texels
};

/// The choice that a text such as "rule:2.5" stands for.
/// @throws bad_input with one line for anything else.
raster_choice parse_raster(const std::string& text);

/// The text of a choice.
std::string raster_name(const raster_choice& choice);

/// Draws maps with tables.
class warped_raster {
  public:
    explicit warped_raster(passes& gpu);

    /// Mixes the tables of a map with the identity as far as they win too little
    /// (warp_strength.hpp).
    /// @return share of the identity
    double weaken(map_resources& maps, std::size_t index);

    /// Draws the scene into one map with its tables; `count` reads back how many triangles.
    /// @param rays for `raster_kind::ideal`
    void draw_map(map_resources& maps, std::size_t index, const raster_choice& choice,
                  const ray_tracer* rays, bool count);

    /// Makes the triangle lists large enough for what was counted since the last call; false if
    /// they were.
    bool grow_lists();
    void forget_counts() { lists_.forget_counts(); }
    [[nodiscard]] const std::vector<triangle_counts>& counted() const { return lists_.counted(); }
    [[nodiscard]] std::size_t list_bytes() const;
    /// What the last tables were predicted to do to the side of the texels in view.
    [[nodiscard]] float mean_side() const { return mean_side_; }

  private:
    /// What turns the scene into triangles for the rasteriser, one way of it.
    struct steps {
        gl::program within;   ///< sets up triangles within the bounds of the map
        gl::program crossing; ///< and those that cross them
        gl::program cut;
        gl::program draw;
    };

    const steps& steps_for(raster_kind kind);
    void prepare(const steps& use, std::size_t index, int size, const raster_choice& choice);
    void set_up(const steps& use);
    void draw_exact(map_resources& maps, std::size_t index);
    void trace_map(map_resources& maps, std::size_t index, const ray_tracer& rays);

    passes& gpu_;
    triangle_lists lists_;
    texel_raster texels_;
    gl::buffer sources_, sides_, crossing_;
    std::array<std::optional<steps>, 5> steps_; ///< by kind, made when first asked for
    gl::program predict_;
    std::array<gl::program, 2> weaken_; ///< by format of the tables
    bool by_texel_ = false;             ///< the last map
    float mean_side_ = 1.0f;
};

} // namespace lab
