// The part of report.html about one path of a camera: its table, plots and pictures.
#pragma once

#include "lab/report.hpp"

#include <string>

namespace lab {

/// A section with the means of each method and its values over the frames.
/// @param heading element that the section begins with
std::string path_section(const results& all, const path_pictures& seen, const std::string& heading);

} // namespace lab
