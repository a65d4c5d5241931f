// Shadow maps with warp tables, drawn texel by texel: exact however the warp bends edges.
#pragma once

#include "gl/objects.hpp"
#include "lab/passes.hpp"
#include "lab/triangle_lists.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lab {

/// Draws triangles without the rasteriser, whose edges are straight.
///
/// Which texels a triangle may cover follows from a box (warped_box.hpp); each asks whether its
/// centre, before the warp, lies in the triangle. Small triangles are drawn as they are sorted.
/// Large ones are spread over blocks of texels first, so that all invocations have about as much
/// to do.
class texel_raster {
  public:
    explicit texel_raster(passes& gpu);

    /// Sorts the triangles of the scene and draws the small ones.
    void sort(const map_resources& maps, std::size_t index);
    /// Draws the others, as many at a time as there is room for their blocks, and writes the map.
    void draw(const map_resources& maps, std::size_t index);

    /// What the passes of the last map counted; of the pairs, the most at a time.
    [[nodiscard]] triangle_counts counts() const;
    /// Doubles the list that may lose something; false if it is as large as it may be.
    bool grow();
    /// Bytes that the map needed of which these are the counts.
    [[nodiscard]] std::size_t bytes(const triangle_counts& counted) const;

  private:
    void make_room_for(int size);
    /// Pairs of some of the sources and of the blocks that these may cover; how many there are.
    std::size_t spread(std::size_t first, std::size_t count, int blocks);
    void sort_into(std::size_t list, std::size_t index, int size, std::size_t triangles);
    void set_up(const gl::program& program, const gl::buffer& list, std::size_t index,
                std::uint32_t count);

    passes& gpu_;
    gl::buffer counters_;
    std::array<gl::buffer, 2> larger_; ///< numbers of triangles that are too large for either sort
    gl::buffer crossing_;              ///< of those that cross the bounds of the map
    gl::buffer sources_, pairs_;
    gl::texture depths_, block_bounds_; ///< bits of the depths; where blocks lie before the warp
    std::array<gl::program, 2> sort_;
    gl::program set_up_within_, set_up_crossing_;
    gl::program bounds_, spread_, cover_, write_;
    gl::vertex_array nothing_;
    int size_ = 0;               ///< of the map that there is room for
    std::size_t most_pairs_ = 0; ///< at a time, of the last map
};

} // namespace lab
