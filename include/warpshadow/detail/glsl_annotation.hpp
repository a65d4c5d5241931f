// Annotations read by warpshadow-glslgen; they expand to nothing in every other build.
#pragma once

#if defined(WARPSHADOW_GLSLGEN)
/// The type stands for this GLSL type (a sampler, or a macro that the shader defines).
#define WS_GLSL_TYPE(name) [[clang::annotate("glsl_type:" name)]]
/// A call of the function becomes this GLSL expression; $0, $1 … are the arguments.
#define WS_GLSL_CALL(snippet) [[clang::annotate("glsl:" snippet)]]
#else
#define WS_GLSL_TYPE(name)
#define WS_GLSL_CALL(snippet)
#endif
