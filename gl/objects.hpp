// Thin owners of OpenGL 4.3 objects. Binding happens where it is asked for and nowhere else.
#pragma once

#include "gl/shader_source.hpp"

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace gl {

/// A GL name that is deleted once; the base of the owners below.
template <void (*Delete)(GLuint)> class handle {
  public:
    handle() = default;
    explicit handle(GLuint id) : id_(id) {}
    handle(handle&& other) noexcept : id_(std::exchange(other.id_, 0u)) {}
    handle& operator=(handle&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~handle() {
        if (id_ != 0) {
            Delete(id_);
        }
    }
    [[nodiscard]] GLuint id() const { return id_; }

  private:
    GLuint id_ = 0;
};

namespace detail {
void delete_buffer(GLuint id);
void delete_texture(GLuint id);
void delete_framebuffer(GLuint id);
void delete_vertex_array(GLuint id);
void delete_program(GLuint id);
void delete_query(GLuint id);
} // namespace detail

/// Throws gl::error naming `where` when GL has an error pending or memory ran out.
void check(const char* where);

/// Makes what shaders wrote visible to everything that follows.
void wait_for_writes();

/// A buffer object of fixed size.
class buffer {
  public:
    buffer() = default;
    /// `bytes` of storage, copied from `data` unless that is null (then undefined).
    buffer(std::size_t bytes, const void* data, GLenum usage = GL_STATIC_DRAW);
    template <typename T>
    explicit buffer(std::span<const T> values, GLenum usage = GL_STATIC_DRAW)
        : buffer(values.size_bytes(), values.data(), usage) {}

    [[nodiscard]] GLuint id() const { return handle_.id(); }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    void bind(GLenum target) const;
    void bind_base(GLenum target, GLuint index) const;
    void write(std::size_t offset, std::size_t bytes, const void* data);
    void read(std::size_t offset, std::size_t bytes, void* data) const;
    /// Sets every 32-bit word to `value`.
    void fill(std::uint32_t value);
    template <typename T> [[nodiscard]] std::vector<T> read() const {
        std::vector<T> result(bytes_ / sizeof(T));
        read(0, result.size() * sizeof(T), result.data());
        return result;
    }

  private:
    handle<detail::delete_buffer> handle_;
    std::size_t bytes_ = 0;
};

/// A 2D texture, or an array of them, of immutable storage and one level; nearest filter, clamped
/// to the edge.
class texture {
  public:
    texture() = default;
    texture(GLenum internal_format, int width, int height);
    /// An array of `layers` textures, 1 or more.
    texture(GLenum internal_format, int width, int height, int layers);

    [[nodiscard]] GLuint id() const { return handle_.id(); }
    [[nodiscard]] GLenum format() const { return format_; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int layers() const { return layers_; } ///< 0 for a texture that is no array
    [[nodiscard]] std::size_t bytes() const;             ///< of all layers

    void bind(GLuint unit) const;
    /// All layers of an array.
    void bind_image(GLuint unit, GLenum access) const;
    void set_filter(GLenum filter);
    /// Comparison for shadow samplers, or GL_NONE.
    void set_compare(GLenum function);
    void clear(glm::vec4 value);  ///< float and normalised colour formats
    void clear(glm::uvec4 value); ///< unsigned integer formats
    void clear_depth(float value);
    /// All texels, layer by layer, rows from below, tightly packed, in the client type that fits
    /// the format.
    void write(const void* data);
    void read(void* data, std::size_t bytes) const;
    template <typename T> [[nodiscard]] std::vector<T> read() const {
        std::vector<T> result(bytes() / sizeof(T));
        read(result.data(), result.size() * sizeof(T));
        return result;
    }

  private:
    [[nodiscard]] GLenum target() const {
        return layers_ > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
    }

    handle<detail::delete_texture> handle_;
    GLenum format_ = GL_NONE;
    int width_ = 0;
    int height_ = 0;
    int layers_ = 0;
};

/// A buffer as a texture of one row, for `samplerBuffer` and its like: vectors of invocations fetch
/// its texels faster than they load from storage, on processors at least.
class buffer_texture {
  public:
    buffer_texture() = default;
    /// @param source outlives what reads the texture
    /// @throws gl::error when it has more texels of the format than OpenGL takes.
    buffer_texture(const buffer& source, GLenum internal_format);

    [[nodiscard]] GLuint id() const { return handle_.id(); }
    void bind(GLuint unit) const;

  private:
    handle<detail::delete_texture> handle_;
};

/// A framebuffer over textures that outlive it. Textures may be moved afterwards.
class framebuffer {
  public:
    framebuffer() = default;
    /// @throws gl::error when the attachments do not fit together.
    framebuffer(std::initializer_list<const texture*> colours, const texture* depth);
    /// One layer of an array of depth textures, or all of them for layered drawing.
    static framebuffer of_layer(const texture& depth, int layer);
    static framebuffer of_layers(const texture& depth);
    [[nodiscard]] GLuint id() const { return handle_.id(); }
    /// Makes it the target of drawing and sets the viewport to its size.
    void bind() const;

  private:
    void finish(std::span<const GLenum> colours);

    handle<detail::delete_framebuffer> handle_;
    int width_ = 0;
    int height_ = 0;
};

/// A vertex array object.
class vertex_array {
  public:
    vertex_array();
    [[nodiscard]] GLuint id() const { return handle_.id(); }
    void bind() const;

  private:
    handle<detail::delete_vertex_array> handle_;
};

/// One stage of a program.
struct stage {
    GLenum type;
    shader_source source;
};

/// A linked program. Uniforms are set by name without binding; names the linker dropped are
/// ignored. Samplers and images take their units from `layout(binding = …)`.
class program {
  public:
    program() = default;
    /// @throws gl::error with the compiler's log, file names and source lines put in.
    explicit program(std::initializer_list<stage> stages);
    /// A compute program.
    static program compute(shader_source source) {
        return program({stage{GL_COMPUTE_SHADER, std::move(source)}});
    }

    [[nodiscard]] GLuint id() const { return handle_.id(); }
    void use() const;
    /// Runs a compute program over at least `size` invocations in x, y, z.
    void dispatch(glm::ivec3 size) const;
    void dispatch(int x, int y = 1, int z = 1) const { dispatch(glm::ivec3(x, y, z)); }
    /// Runs a compute program over `count` things in a row, or over as many as OpenGL promises to
    /// take: its invocations step on by gl_NumWorkGroups.x * gl_WorkGroupSize.x.
    void dispatch_over(std::size_t count) const;

    void set(const char* name, int value) const;
    void set(const char* name, unsigned value) const;
    void set(const char* name, float value) const;
    void set(const char* name, glm::ivec2 value) const;
    void set(const char* name, glm::ivec3 value) const;
    void set(const char* name, glm::uvec2 value) const;
    void set(const char* name, glm::vec2 value) const;
    void set(const char* name, glm::vec3 value) const;
    void set(const char* name, glm::vec4 value) const;
    void set(const char* name, const glm::mat3& value) const;
    void set(const char* name, const glm::mat4& value) const;

  private:
    [[nodiscard]] GLint location(const char* name) const;

    handle<detail::delete_program> handle_;
    glm::ivec3 group_size_{1};
    mutable std::unordered_map<std::string, GLint> locations_;
};

} // namespace gl
