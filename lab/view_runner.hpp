// All methods on one view: measured, compared with the truth, and kept as pictures.
#pragma once

#include "lab/methods.hpp"
#include "lab/options.hpp"
#include "lab/progress.hpp"
#include "lab/report.hpp"
#include "lab/report_folder.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"
#include "lab/truth.hpp"

#include <cstddef>

namespace lab {

/// How often progress advances in `run_view`, at most.
std::size_t steps_of_view(const options& wanted);

/// Runs everything that was asked for on one view, adds the records to `all` and writes the
/// pictures.
///
/// Where frames are timed in rounds, each round runs all methods once.
view_pictures run_view(const options& wanted, const scene& world, renderer& gpu,
                       const ray_tracer& rays, const camera_view& camera, const light_view& light,
                       results& all, report_folder& folder, progress_bar& progress);

} // namespace lab
