// What the generator writes: GLSL files, the C++ header that holds the same text, and lists for the
// parity tests.
#pragma once

#include "translator.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace glslgen {

/// A file by name, and its whole text.
struct output_file {
    std::string path;
    std::string text;
};

/// GLSL of one topic: header line, guard, prologue where tables are used, and its entities.
std::string topic_text(const translation& source, std::string_view topic, std::string_view prefix);

/// GLSL of all topics in one file, each in its own guard.
std::string complete_text(const translation& source, std::string_view prefix);

/// include/warpshadow/detail/glsl_text.hpp.
std::string text_header(const translation& source);

/// Signatures of all functions and members of all structs, as calls of macros.
std::string parity_list(const translation& source);

} // namespace glslgen
