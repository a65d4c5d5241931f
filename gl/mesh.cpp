#include "gl/mesh.hpp"

#include <cstdint>

namespace gl {

mesh::mesh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles)
    : positions_(positions), indices_(triangles), triangles_(triangles.size()) {
    array_.bind();
    positions_.bind(GL_ARRAY_BUFFER);
    indices_.bind(GL_ELEMENT_ARRAY_BUFFER);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    glBindVertexArray(0);
}

void mesh::bind() const {
    array_.bind();
}

void mesh::draw() const {
    draw(GL_TRIANGLES, 0, triangles_);
}

void mesh::draw(GLenum mode, std::size_t first, std::size_t count) const {
    array_.bind();
    if (mode == GL_PATCHES) {
        glPatchParameteri(GL_PATCH_VERTICES, 3);
    }
    const std::uintptr_t offset = first * sizeof(glm::uvec3);
    glDrawElements(mode, static_cast<GLsizei>(count * 3), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(offset));
}

} // namespace gl
