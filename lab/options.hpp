// Command line of warpshadow-lab.
#pragma once

#include "lab/bias.hpp"
#include "lab/light_maps.hpp"
#include "lab/scene.hpp"
#include "lab/warp_options.hpp"
#include "lab/warped_raster.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/// One method at one size with something else than all others have.
struct run_variant {
    std::string method;
    std::string name; ///< of what differs
    int map;
    warp_wishes tables = {}; ///< in place of those of the command line, as is what follows
    std::optional<raster_choice> raster = std::nullopt;
    std::optional<filter_choice> filter = std::nullopt;
    std::optional<precision> set_up = std::nullopt;
};

/// A camera that moves, besides those that stand still: of a sweep, for each scene.
struct motion {
    std::string path; ///< see lab/path.hpp
    std::vector<std::string> methods;
    int map;
    int frames;
};

/// A light of one scene alone.
struct light_of_scene {
    std::string scene;
    std::string light;
};

/// What the user asked for; cameras and lights are resolved per scene.
struct options {
    std::vector<std::string> scenes{"outdoor", "interior"};
    std::vector<std::string> cameras{"0"};
    std::vector<std::string> lights{"0"};
    std::vector<std::string> methods{"sm",           "min-sm", "dv",          "fitted",
                                     "rtw-backward", "notw",   "notw-hybrid", "raytraced"};
    std::vector<int> maps{512};
    glm::ivec2 view{1024, 768};
    int repeat = 5;
    std::vector<bias_choice> biases;    ///< to be compared; none: the exact test, not measured
    filter_choice filter;               ///< of the shadows in pictures
    std::vector<raster_choice> rasters; ///< of maps with tables, to be compared; none: the default
    warp_wishes tables;                 ///< for methods with warp tables
    std::string command;                ///< that asks for this, as a shell takes it; without --out
    std::string sweep;                  ///< "short" or "full", see lab/sweep.hpp, or none
    int rounds = 1;                     ///< in which frames are timed, all methods in each
    precision set_up = precision::in_double;  ///< of matrices and fits on the host
    std::vector<run_variant> variants;        ///< to be run besides the methods
    std::vector<light_of_scene> point_lights; ///< besides the lights
    std::optional<motion> moves; ///< of the first camera and the first light, in a sweep
    int pictured = 0;            ///< size of the maps whose pictures are kept; 0: all
    std::string preset;          ///< a figure to redo, see lab/figures.hpp, or none
    std::string path; ///< a moving camera, see lab/path.hpp; empty for cameras that stand still
    int frames = 60;  ///< along the path
    unsigned seed = 1;
    std::string out = "warpshadow-report";
    bool list_scenes = false;
};

/// The first way to draw maps with tables that was asked for, or the default.
raster_choice raster_of(const options& wanted);

/// Reads the command line; nothing when help was asked for and printed.
/// @throws bad_input with one line for anything that cannot be understood.
std::optional<options> parse_options(int argc, const char* const* argv,
                                     std::span<const std::string_view> methods);

} // namespace lab
