// Figures of the papers, redone as matrices of pictures with numbers under each: those of Scherzer
// 2005 here, that of Rosen 2012 in raster_figure.hpp.
#pragma once

#include "lab/methods.hpp"
#include "lab/options.hpp"
#include "lab/picture.hpp"
#include "lab/progress.hpp"
#include "lab/report_folder.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"
#include "lab/truth.hpp"

#include <glm/glm.hpp>

#include <cstddef>
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

/// @throws bad_input for anything but figure6, figure7, figure8 and the presets of lab/vpl.hpp.
figure_defaults defaults_of_figure(const std::string& name);

/// How many runs a figure takes.
std::size_t runs_of_figure(const std::string& name);

/// Pictures of a figure; its numbers are in results::figures.
struct figure_pictures {
    std::size_t figure; ///< index into results::figures
    std::string camera_text;
    std::string light_text;
    png_file reference; ///< ray traced
    std::vector<png_file> cells;
    std::vector<png_file> maps; ///< of the cells, for figures that show them
};

/// Runs all cells, adds their records to `all`, and writes their pictures.
figure_pictures run_figure(const options& wanted, const scene& world, renderer& gpu,
                           const ray_tracer& rays, const camera_view& camera,
                           const light_view& light, results& all, report_folder& folder,
                           progress_bar& progress);

/// A figure as a part of report.html.
std::string figure_section(const results& all, const figure_pictures& seen);

} // namespace lab
