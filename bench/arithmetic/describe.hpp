// What the kernels and the envelopes of their inputs are, for the page.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace arithmetic {

inline constexpr double map_size = 2048.0; ///< texels across the map that errors are given in

struct kernel_description {
    std::string name, what;
    std::string unit; ///< of errors
    std::string per;  ///< what the nanoseconds are for
    bool decisions;   ///< right or wrong, so that errors are counted
    std::vector<std::pair<std::string, std::string>> envelopes; ///< name and what is in it
};

/// In the order of the page.
std::vector<kernel_description> describe();

} // namespace arithmetic
