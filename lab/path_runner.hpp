// Methods along the path of a moving camera.
#pragma once

#include "lab/methods.hpp"
#include "lab/options.hpp"
#include "lab/progress.hpp"
#include "lab/report.hpp"
#include "lab/report_folder.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"
#include "lab/truth.hpp"

namespace lab {

/// Runs all methods frame by frame, adds their records to `all`, and writes the pictures of the
/// first, the middle and the last frame.
path_pictures run_path(const options& wanted, const scene& world, renderer& gpu,
                       const ray_tracer& rays, const camera_view& start, const light_view& light,
                       results& all, report_folder& folder, progress_bar& progress);

} // namespace lab
