// What figures of the papers have in common: pictures in rows and columns with numbers under each.
#pragma once

#include "lab/options.hpp"
#include "lab/picture.hpp"
#include "lab/report_folder.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace lab {

/// What a figure shows where nothing else is asked for.
struct figure_defaults {
    const char* scene;
    const char* camera;
    const char* light;
    int map;
    glm::ivec2 view;
};

/// Pictures of a figure; its numbers are in results::figures.
struct figure_pictures {
    std::size_t figure; ///< index into results::figures
    std::string camera_text;
    std::string light_text;
    png_file reference; ///< ray traced
    std::vector<png_file> cells;
    std::vector<png_file> maps; ///< of the cells, for figures that show them
};

/// Writes a picture of the figure that was asked for, and returns it.
/// @param kind what it shows, as the end of the file's name
png_file write_figure_picture(const options& wanted, const scene& world, const camera_view& camera,
                              const light_view& light, report_folder& folder,
                              const std::string& kind, const picture& source);

/// What a figure's part of report.html says and how it looks.
struct matrix_texts {
    std::string source;      ///< the paper and its figure
    std::string explanation; ///< of the pictures and of the numbers
    int cell_pixels;         ///< least width of a cell
    /// What stands under a cell, after the name of its column.
    std::function<std::string(const figure_record::cell& cell, const run_record& run)> caption;
};

/// A figure as a part of report.html.
std::string matrix_section(const results& all, const figure_pictures& seen,
                           const matrix_texts& texts);

} // namespace lab
