// What the parts of report.html are made of: pictures, cells of tables, names and colours of runs.
#pragma once

#include "lab/picture.hpp"
#include "lab/results.hpp"

#include <cstddef>
#include <string>

namespace lab {

/// A picture as an element of a page that holds it.
/// @param more attributes, each with a space before it
std::string png_image(const png_file& source, const std::string& what,
                      const std::string& more = "");

/// A cell of a table; numbers stand at its right.
std::string cell(const std::string& text, bool number = true);

/// A method with its bias, if that was measured.
std::string label_of(const run_record& run);

/// Rank of a method in the order of first appearance; it decides the colour.
/// @param method as `label_of` a run, or as along a path
std::size_t rank_of(const results& all, const std::string& method);

/// The colour of a method as a dot before its name.
std::string dot_of(const results& all, const std::string& method);

} // namespace lab
