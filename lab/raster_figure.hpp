// Figure 7 of Rosen 2012: what each way to draw a warped map does to it and to the picture.
#pragma once

#include "lab/figure_matrix.hpp"
#include "lab/methods.hpp"
#include "lab/progress.hpp"
#include "lab/truth.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lab {

/// Whether a preset is figure7.
bool is_raster_figure(const std::string& preset);

figure_defaults defaults_of_raster_figure();

std::size_t runs_of_raster_figure();

/// Marks the texels whose depth differs from that of the ideal map by more than 1/500 of the range
/// that the ideal map holds; empty texels are of no depth, and differ from all others.
std::vector<std::uint8_t> wrong_texels(std::span<const float> depth, std::span<const float> ideal);

/// Runs rtw-backward and notw with every way to draw their map. All cells show the same part of the
/// picture and of the map: where those that do something about bent edges differ most.
figure_pictures run_raster_figure(const options& wanted, const scene& world, renderer& gpu,
                                  const ray_tracer& rays, const camera_view& camera,
                                  const light_view& light, results& all, report_folder& folder,
                                  progress_bar& progress);

/// The figure as a part of report.html.
std::string raster_figure_section(const results& all, const figure_pictures& seen);

} // namespace lab
