// What accuracy costs in time, as a part of report.html and of results.json.
#pragma once

#include "lab/results.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace lab {

/// The answer in one screen, scores, and what each method needs to be as good as others.
/// @param all results of a sweep
std::string accuracy_section(const results& all);

/// The same for programs.
nlohmann::ordered_json accuracy_json(const results& all);

} // namespace lab
