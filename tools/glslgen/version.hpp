#pragma once

/// Raised when the same C++ gives other GLSL.
#define GLSLGEN_VERSION "1.0"
