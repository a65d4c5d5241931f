// The part of report.html about one view: its plots and its pictures.
#pragma once

#include "lab/report.hpp"

#include <string>

namespace lab {

/// A section with the plots of a view, two of its pictures over each other, and a card per run.
/// @param heading element that the section begins with
std::string view_section(const results& all, const view_pictures& view, const std::string& heading);

} // namespace lab
