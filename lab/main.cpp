// warpshadow-lab: renders scenes with shadow-mapping methods, counts the pixels that each gets
// wrong against ray tracing, and writes a report.
#include "gl/context.hpp"
#include "gl/timer.hpp"
#include "lab/figures.hpp"
#include "lab/method_table.hpp"
#include "lab/methods.hpp"
#include "lab/options.hpp"
#include "lab/path_runner.hpp"
#include "lab/progress.hpp"
#include "lab/report.hpp"
#include "lab/report_folder.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"
#include "lab/sweep.hpp"
#include "lab/truth.hpp"
#include "lab/view_archive.hpp"
#include "lab/view_arguments.hpp"
#include "lab/view_runner.hpp"
#include "lab/vpl.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

namespace {

void on_signal(int /*number*/) {
    lab::ask_to_stop();
}

/// A scene with the views that were asked for.
struct job {
    lab::scene world;
    std::vector<lab::camera_view> cameras;
    std::vector<lab::light_view> lights;
};

void list_scenes(unsigned seed) {
    for (const lab::scene_summary& summary : lab::builtin_scenes()) {
        const lab::scene world = lab::build_scene(summary.name, seed);
        std::printf("%s: %s\n  %zu triangles\n", world.name.c_str(),
                    std::string(summary.about).c_str(), world.triangles.size());
        for (const lab::camera_view& camera : world.cameras) {
            std::printf("  --camera %s  %s\n", camera.label.c_str(),
                        lab::camera_text(camera).c_str());
        }
        for (const lab::light_view& light : world.lights) {
            std::printf("  --light %s   %s\n", light.label.c_str(), lab::light_text(light).c_str());
        }
    }
}

std::vector<job> open_jobs(const lab::options& wanted) {
    std::vector<job> jobs;
    for (const std::string& name : wanted.scenes) {
        job next{lab::open_scene(name, wanted.seed), {}, {}};
        for (const std::string& camera : wanted.cameras) {
            next.cameras.push_back(lab::resolve_camera(camera, next.world));
        }
        for (const std::string& light : wanted.lights) {
            next.lights.push_back(lab::resolve_light(light, next.world));
        }
        for (const lab::light_of_scene& each : wanted.point_lights) {
            if (each.scene == name) {
                next.lights.push_back(lab::resolve_light(each.light, next.world));
            }
        }
        jobs.push_back(std::move(next));
    }
    return jobs;
}

/// Refuses paths that cannot be gone and lists of methods that have nothing to go, before anything
/// is rendered.
void check_paths(const lab::options& wanted, const std::vector<job>& jobs) {
    if (wanted.path.empty()) {
        return;
    }
    for (const job& work : jobs) {
        for (const lab::camera_view& camera : work.cameras) {
            lab::camera_path(wanted.path, work.world, camera, wanted.frames);
        }
    }
    if (wanted.methods == std::vector<std::string>{"raytraced"}) {
        throw lab::bad_input("--path compares methods with the ray tracer: it cannot go alone");
    }
}

/// Refuses sizes that this OpenGL cannot hold, before anything is rendered.
void check_limits(const lab::options& wanted) {
    GLint side = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    std::array<GLint, 2> viewport{};
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
    // warp tables have one node more than the map has texels
    const int largest_map = std::min({side - 1, viewport[0], viewport[1]});
    for (const int map : wanted.maps) {
        if (map > largest_map) {
            throw lab::bad_input("--map " + std::to_string(map) +
                                 " is too large: this OpenGL takes up to " +
                                 std::to_string(largest_map));
        }
    }
    if (wanted.view.x > std::min(side, viewport[0]) ||
        wanted.view.y > std::min(side, viewport[1])) {
        throw lab::bad_input("--view " + std::to_string(wanted.view.x) + "x" +
                             std::to_string(wanted.view.y) +
                             " is too large: this OpenGL takes up to " +
                             std::to_string(std::min(side, viewport[0])) + "x" +
                             std::to_string(std::min(side, viewport[1])));
    }
}

void run_lab(const lab::options& wanted) {
    const std::vector<job> jobs = open_jobs(wanted);
    check_paths(wanted, jobs);
    const bool sweeps = !wanted.sweep.empty();
    lab::report_folder folder(wanted.out, sweeps);
    const gl::headless_context context;
    check_limits(wanted);

    lab::results all;
    all.command = wanted.command;
    all.renderer = context.info().renderer;
    all.version = context.info().version;
    all.timing = gl::timing_name(gl::best_timing());
    all.view = wanted.view;
    std::size_t steps = 0;
    for (const job& work : jobs) {
        steps += work.cameras.size() * work.lights.size() *
                 (wanted.preset.empty()
                      ? lab::steps_of_view(wanted) *
                            (wanted.path.empty() ? 1 : static_cast<std::size_t>(wanted.frames))
                      : lab::runs_of_figure(wanted.preset));
        if (const auto moves = lab::options_of_motion(wanted, work.lights.front())) {
            steps += moves->methods.size() * static_cast<std::size_t>(moves->frames);
        }
    }
    std::vector<lab::view_pictures> views;
    std::vector<lab::path_pictures> paths;
    std::vector<lab::figure_pictures> figures;
    {
        lab::progress_bar progress(steps);
        for (const job& work : jobs) {
            progress.show(work.world.name);
            lab::renderer renderer(work.world, wanted.view);
            const lab::ray_tracer rays(work.world);
            for (const lab::light_view& light : work.lights) {
                for (const std::string& method : wanted.methods) {
                    if (!wanted.preset.empty()) {
                        break; // a figure has methods of its own
                    }
                    auto reason = lab::why_not(method, light);
                    if (!reason) {
                        reason = lab::why_not(method, wanted.set_up);
                    }
                    if (reason) {
                        all.left_out.push_back({work.world.name, light.label, method, *reason});
                        continue;
                    }
                    for (const lab::bias_choice& bias : wanted.biases) {
                        if (const auto why = lab::why_not(method, light, bias)) {
                            all.left_out.push_back({work.world.name, light.label, method, *why});
                        }
                    }
                }
            }
            for (const lab::camera_view& camera : work.cameras) {
                for (const lab::light_view& light : work.lights) {
                    if (lab::is_vpl(wanted.preset)) {
                        lab::run_vpl(wanted, work.world, all, progress);
                    } else if (!wanted.preset.empty()) {
                        figures.push_back(lab::run_figure(wanted, work.world, renderer, rays,
                                                          camera, light, all, folder, progress));
                    } else if (wanted.path.empty()) {
                        const auto run = sweeps ? lab::resume_view : lab::run_view;
                        views.push_back(run(wanted, work.world, renderer, rays, camera, light, all,
                                            folder, progress));
                    } else {
                        paths.push_back(lab::run_path(wanted, work.world, renderer, rays, camera,
                                                      light, all, folder, progress));
                    }
                }
            }
            if (const auto moves = lab::options_of_motion(wanted, work.lights.front())) {
                paths.push_back(lab::resume_path(*moves, work.world, renderer, rays,
                                                 work.cameras.front(), work.lights.front(), all,
                                                 folder, progress));
            }
        }
        progress.show("report");
        all.matched = wanted.pictured;
        folder.write("results.json", lab::json_of(all));
        std::vector<std::string> sections;
        for (const lab::figure_pictures& each : figures) {
            sections.push_back(lab::figure_section(all, each));
        }
        for (std::size_t i = 0; i < all.vpls.size(); ++i) {
            sections.push_back(lab::vpl_section(all, i));
        }
        if (sweeps) {
            folder.remove(lab::archive_suffix);
        }
        folder.write("report.html", lab::html_of(all, views, paths, sections));
    }
    const std::filesystem::path place = folder.publish();
    std::fputs(lab::table_of(all).c_str(), stdout);
    std::printf("%s\n", (place / "report.html").c_str());
}

int fail(const char* what, int code) {
    std::fprintf(stderr, "warpshadow-lab: %s\n", what);
    return code;
}

} // namespace

int main(int argc, char** argv) {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    try {
        const std::optional<lab::options> wanted =
            lab::parse_options(argc, argv, lab::method_names());
        if (!wanted) {
            return 0;
        }
        if (wanted->list_scenes) {
            list_scenes(wanted->seed);
            return 0;
        }
        run_lab(*wanted);
        return 0;
    } catch (const lab::bad_input& error) {
        return fail(error.what(), 2);
    } catch (const std::bad_alloc&) {
        return fail("out of memory", 1);
    } catch (const std::exception& error) {
        return fail(error.what(), 1);
    }
}
