// What the tests of the passes begin with.
#pragma once

#include "gl/objects.hpp"
#include "gl/shader_source.hpp"

#include <cstddef>
#include <string>

/// A program of GLSL that includes passes.
inline gl::program pass(const std::string& text) {
    static const gl::shader_library library{gl::glsl_files()};
    return gl::program::compute(library.compose("#version 430 core\n" + text, "pass"));
}

/// Cells of a square grid.
inline std::size_t squared(int cells) {
    return static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
}
