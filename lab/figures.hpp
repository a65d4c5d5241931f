// Figures of the papers, redone: those of Scherzer 2005 here, that of Rosen 2012 in
// raster_figure.hpp.
#pragma once

#include "lab/figure_matrix.hpp"
#include "lab/methods.hpp"
#include "lab/options.hpp"
#include "lab/progress.hpp"
#include "lab/report_folder.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"
#include "lab/truth.hpp"

#include <cstddef>
#include <string>

namespace lab {

/// @throws bad_input for anything but figure6, figure7, figure8 and the presets of lab/vpl.hpp.
figure_defaults defaults_of_figure(const std::string& name);

/// How many runs a figure takes.
std::size_t runs_of_figure(const std::string& name);

/// Runs all cells, adds their records to `all`, and writes their pictures.
figure_pictures run_figure(const options& wanted, const scene& world, renderer& gpu,
                           const ray_tracer& rays, const camera_view& camera,
                           const light_view& light, results& all, report_folder& folder,
                           progress_bar& progress);

/// A figure as a part of report.html.
std::string figure_section(const results& all, const figure_pictures& seen);

} // namespace lab
