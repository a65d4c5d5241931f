// Command line of the methods with warp tables.
#pragma once

#include "lab/warp_options.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace lab {

/// Heading of their options in --help.
inline constexpr const char* table_group = "Methods with warp tables";

/// What was given, not yet understood.
struct warp_arguments {
    std::vector<std::string> importance;
    std::string tables, window, smooth, floor, shear, order, power, subset, cells, collapse, sigma,
        edge_share, format;
    bool align = false;
};

/// Adds the options to a command line that outlives neither.
void add_warp_arguments(CLI::App& app, warp_arguments& given);

/// What they ask for.
/// @throws bad_input with one line for anything that cannot be understood.
warp_wishes warp_wishes_of(const warp_arguments& given);

} // namespace lab
