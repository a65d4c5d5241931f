// Shader files embedded at build time, with #include resolved.
#pragma once

#include "gl/error.hpp"

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gl {

/// A file that was embedded by `warpshadow_embed_shaders` (gl/EmbedShaders.cmake).
struct shader_file {
    std::string_view name;
    std::string_view text;
};

/// Text ready for glShaderSource; `files[i]` is what source string number i of `#line` stands for.
struct shader_source {
    std::string text;
    std::vector<std::string> files;
};

/// Everything below glsl/, by its path from there: "warpshadow/warp.glsl", "passes/x.glsl".
std::span<const shader_file> glsl_files();

/// A set of shader files that can include each other.
///
/// `#include "name"` takes a file of the library by its full name; each file is taken once. After
/// it, and after the `#version` line, `#line` directives keep messages of the compiler true.
class shader_library {
  public:
    shader_library(std::initializer_list<std::span<const shader_file>> sets);

    /// The file `name` with its includes. Each define is "NAME" or "NAME VALUE" and is written
    /// after the `#version` line; a file without one gets `#version 430 core`.
    /// @throws gl::error for a name that is not in the library, with the including file and line.
    [[nodiscard]] shader_source load(std::string_view name,
                                     std::span<const std::string> defines = {}) const;

    /// The same for text that is not in the library; `name` is used in messages.
    [[nodiscard]] shader_source compose(std::string_view text, std::string_view name,
                                        std::span<const std::string> defines = {}) const;

  private:
    void append(shader_source& out, std::string_view text, std::size_t file,
                std::span<const std::string> defines) const;

    std::vector<shader_file> files_;
};

} // namespace gl
