// The lab's own shader files, embedded by lab/CMakeLists.txt under "lab/".
#pragma once

#include "gl/shader_source.hpp"

#include <span>

namespace lab {

std::span<const gl::shader_file> lab_shaders();

} // namespace lab
