// What was measured, as results.json and as the table on the terminal.
#pragma once

#include "lab/measure.hpp"
#include "lab/methods.hpp"
#include "lab/path.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lab {

/// One method on one view at one map size.
struct run_record {
    std::string scene;
    std::string camera;
    std::string light;
    std::string method;
    int map = 0; ///< texels along a side; 0 for a method without a map
    comparison against_truth;
    method_result result;
    std::optional<std::string> bias = std::nullopt; ///< as it was asked for; none: not measured
    bias_measures bias_effect = {};
    std::string filter = "none";                       ///< of the shadows in the pictures
    filter_errors filtered = {};                       ///< what that filter leaves
    std::optional<std::string> tables = std::nullopt;  ///< how they are stored, if not as floats
    std::optional<std::string> set_up = std::nullopt;  ///< its type on the host, if not double
    std::optional<std::string> raster = std::nullopt;  ///< as it was asked for, of maps with tables
    std::optional<std::string> variant = std::nullopt; ///< what a sweep varies, see `run_variant`
    std::string kind = "sun";                          ///< of light: sun, spot or point
};

/// Runs in rows and columns.
struct figure_record {
    std::string name;
    std::string scene;
    std::string camera;
    std::string light;
    /// One cell, by its place and its run.
    struct cell {
        std::string row;
        std::string column;
        std::size_t run;                        ///< index into results::runs
        std::optional<double> filtered_acne;    ///< acne that is left after the filter
        std::optional<double> mean_light_error; ///< of the filtered light, against the ray tracer
        std::optional<double> wrong_texels =
            std::nullopt; ///< share that is not as in the ideal map
    };
    std::vector<cell> cells;
};

/// Shadow maps of virtual point lights, one light after the other.
struct vpl_record {
    std::string scene;
    std::size_t points;
    std::size_t groups; ///< of points, culled as one
    int map;
    /// One way to draw them; per light.
    struct way_record {
        std::string way;
        std::vector<double> ms;
        std::vector<int> maps;
    };
    std::vector<way_record> ways;
};

/// A method that was asked for and cannot do the light.
struct not_applicable {
    std::string scene;
    std::string light;
    std::string method;
    std::string reason;
};

/// Everything that a report is made of.
struct results {
    std::string command; ///< that makes them again
    std::string renderer;
    std::string version;
    std::string timing; ///< "timer_query" or "glfinish"
    glm::ivec2 view{0};
    std::vector<run_record> runs;
    std::vector<path_record> paths;
    std::vector<not_applicable> left_out;
    std::vector<figure_record> figures;
    std::vector<vpl_record> vpls;
    int matched = 0; ///< in a sweep, the size at which qualities are matched; else 0
};

/// The text of results.json, schema 1.
std::string json_of(const results& all);

/// A table for a terminal, one line per run, or per method along a path.
std::string table_of(const results& all);

/// What was left out and why, one line for all methods with the same reason.
std::vector<std::string> left_out_lines(const results& all);

/// A method with its way to rasterise or what else varies, if that was asked for.
std::string method_text(const run_record& run);

/// A share as per cent, "-" when there is none.
std::string percent_text(std::optional<double> ratio);

/// A mean displacement, "-" when there is none.
std::string texels_text(std::optional<double> texels);

/// Maximum effective resolution of a method's maps, "-" where there is none.
std::string finest_text(const method_result& result);

/// "4.0 MiB" and the like.
std::string bytes_text(std::size_t bytes);

/// Milliseconds with three digits.
std::string ms_text(double ms);

} // namespace lab
