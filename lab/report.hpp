// report.html: everything that was measured and seen, in one file.
#pragma once

#include "lab/picture.hpp"
#include "lab/results.hpp"

#include <string>
#include <utility>
#include <vector>

namespace lab {

/// What one run looks like.
struct run_pictures {
    std::size_t run; ///< index into results::runs
    png_file marked; ///< the view with wrong pixels in red
    png_file detail; ///< enlarged part, as it looks
    png_file detail_marked;
    std::vector<std::pair<std::string, png_file>> explanations; ///< with their names
};

/// One scene, camera and light.
struct view_pictures {
    std::string scene;
    std::string camera;
    std::string light;
    std::string camera_text;
    std::string light_text;
    png_file reference; ///< ray traced
    png_file reference_detail;
    std::vector<run_pictures> runs;
};

/// One scene, camera, light and path.
struct path_pictures {
    std::size_t first; ///< of its records in results::paths
    std::size_t count;
    bool one_size; ///< all records have maps of one size
    std::string camera_text;
    std::string light_text;
    std::vector<std::pair<std::string, png_file>> pictures; ///< with their captions
};

/// A page that needs nothing but itself: pictures and plots are inside.
std::string html_of(const results& all, const std::vector<view_pictures>& views,
                    const std::vector<path_pictures>& paths,
                    const std::vector<std::string>& figures = {});

} // namespace lab
