// Positions and triangles on the GPU.
#pragma once

#include "gl/objects.hpp"

#include <glm/glm.hpp>

#include <span>

namespace gl {

/// An indexed triangle mesh; attribute 0 is the position.
class mesh {
  public:
    mesh() = default;
    mesh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);

    [[nodiscard]] std::size_t triangle_count() const { return triangles_; }
    [[nodiscard]] std::size_t bytes() const { return positions_.bytes() + indices_.bytes(); }
    [[nodiscard]] const buffer& positions() const { return positions_; }
    [[nodiscard]] const buffer& indices() const { return indices_; }

    void bind() const;
    /// Draws all triangles.
    void draw() const;
    /// Draws `count` triangles from `first` on as `mode` (GL_TRIANGLES or GL_PATCHES of three
    /// vertices), all in one call. Binds its own vertex array.
    void draw(GLenum mode, std::size_t first, std::size_t count) const;

  private:
    vertex_array array_;
    buffer positions_;
    buffer indices_;
    std::size_t triangles_ = 0;
};

} // namespace gl
