// The sweep: every method at every size on every scene, interrupted and resumed at will.
#pragma once

#include "lab/methods.hpp"
#include "lab/options.hpp"
#include "lab/progress.hpp"
#include "lab/report.hpp"
#include "lab/report_folder.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"
#include "lab/truth.hpp"

#include <optional>
#include <string>

namespace lab {

/// Puts what a sweep runs in place of the defaults of the command line.
/// @param name "short" or "full"
/// @throws bad_input for any other name
options options_of_sweep(const std::string& name);

/// The size at which a sweep shows pictures and matches qualities: 512, or the smallest asked for.
int pictured_size(const options& wanted);

/// Leaves variants and moves of no other methods than the sweep runs, at the size of its pictures.
void settle_sweep(options& wanted);

/// What of a sweep is its moving camera, as options of a path; nothing where no method of it can do
/// the light.
std::optional<options> options_of_motion(const options& wanted, const light_view& light);

/// `run_view`, unless the folder holds that view already, with the same options, from a sweep that
/// did not end; finished views are kept there.
view_pictures resume_view(const options& wanted, const scene& world, renderer& gpu,
                          const ray_tracer& rays, const camera_view& camera,
                          const light_view& light, results& all, report_folder& folder,
                          progress_bar& progress);

/// `run_path` of such options, kept and taken from there in the same way.
path_pictures resume_path(const options& wanted, const scene& world, renderer& gpu,
                          const ray_tracer& rays, const camera_view& camera,
                          const light_view& light, results& all, report_folder& folder,
                          progress_bar& progress);

} // namespace lab
