// Lists on the device in which triangles are cut until they can be drawn.
#pragma once

#include "gl/objects.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lab {

/// Mirror of `triangle_counts` in shaders/triangle_counts.glsl.
struct triangle_counts {
    std::uint32_t vertex_count = 0;
    std::uint32_t instance_count = 1;
    std::uint32_t first_vertex = 0;
    std::uint32_t base_instance = 0;
    std::array<std::uint32_t, 2> waiting{};
    std::uint32_t sources = 0;
    std::uint32_t lost = 0;
    std::uint32_t crowded = 0;
    std::uint32_t uncut = 0;
    std::uint32_t crossing = 0;
    std::uint32_t pairs = 0;
    std::array<std::uint32_t, 2> larger{};
};

/// Pieces that wait to be cut, pieces that are ready, and how many there are of each.
class triangle_lists {
  public:
    explicit triangle_lists(std::size_t piece_bytes);

    /// Room for the triangles of a scene and some cuts.
    void make_room_for(std::size_t triangles);
    [[nodiscard]] bool empty() const { return ready_.bytes() == 0; }

    /// Empties the lists and binds them for the pass that fills them.
    void begin();
    /// What the passes since then counted; waits for them.
    [[nodiscard]] triangle_counts counts() const;
    /// Halves edges, one round after the other, until nothing waits or the rounds are over.
    ///
    /// @param cut reads the list `list`, writes the other, and draws all in the `last_round`
    void cut(const gl::program& cut, int rounds);
    /// Draws what is ready with the program in use.
    void draw();

    /// Keeps how many there were, for `grow`.
    void count(const triangle_counts& counts) { counted_.push_back(counts); }
    void forget_counts();
    /// Of the maps drawn since they were last forgotten.
    [[nodiscard]] const std::vector<triangle_counts>& counted() const { return counted_; }
    /// What `grow` would find too small.
    [[nodiscard]] bool lost_some() const;
    /// Doubles the lists that were too small for what was counted; false if none was, or if they
    /// are as large as they may be.
    bool grow();
    /// Bytes that the maps drawn since then needed, one after the other; other maps before may have
    /// made the lists longer.
    [[nodiscard]] std::size_t bytes() const;

  private:
    void set_capacity(std::size_t ready, std::size_t waiting);

    std::size_t piece_bytes_;
    gl::buffer counters_, ready_;
    std::array<gl::buffer, 2> waiting_;
    gl::vertex_array nothing_;
    std::vector<triangle_counts> counted_;
    std::uint32_t most_waiting_ = 0; ///< at once, since counts were forgotten
};

} // namespace lab
