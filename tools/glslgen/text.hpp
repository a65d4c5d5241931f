// Text work on emitted GLSL that needs no syntax tree.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glslgen {

/// Widest line of emitted code.
inline constexpr std::size_t column_limit = 100;

/// Appends a line of code, broken after commas and before operators where it exceeds the limit.
void append_wrapped(std::vector<std::string>& lines, std::string line);

/// Writes the characters that mathematics in comments uses in ASCII (≤ as <=, ² as ^2 and so on);
/// characters without an agreed spelling stay as they are.
std::string to_ascii(std::string_view text);

/// Shortest decimal text, with point or exponent, that reads back as the same float.
std::string float_literal(float value);

/// 64-bit FNV-1a hash, continued from `state`.
std::uint64_t fnv1a(std::string_view text, std::uint64_t state = 0xcbf29ce484222325u);

/// Replaces whole identifiers: those that begin with `ws_` or `WS_` get the prefix and its
/// upper-case form instead.
std::string with_prefix(std::string_view text, std::string_view prefix);

/// Upper-case form of a prefix, for macros.
std::string upper(std::string_view text);

/// Quotes text as C++ string literals, one per line, with the given indentation.
std::string quoted(std::string_view text, std::string_view indent);

} // namespace glslgen
