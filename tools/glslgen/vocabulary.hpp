// What GLSL calls things: reserved words, built-in functions, and how C++ names map to them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace glslgen {

/// Whether a version of GLSL, 330 to 460, ES 310 or 320, reserves the word.
bool is_reserved_word(std::string_view name);

/// Whether the word names a built-in function or type: a variable of that name would hide it.
bool is_builtin_name(std::string_view name);

/// How a function of GLM, of std or of the C library is written in GLSL.
struct builtin {
    std::string_view glsl;
    unsigned fewest_arguments;
    unsigned most_arguments;
};

/// The GLSL counterpart of glm::name, std::name or ::name with the same meaning in all profiles.
std::optional<builtin> find_builtin(std::string_view name);

/// Why a known function is refused, or nothing for an unknown one.
std::optional<std::string_view> why_refused(std::string_view name);

} // namespace glslgen
