// warpshadow-lab: renders scenes with shadow-mapping methods, counts the pixels that each gets
// wrong against ray tracing, and writes a report.
#include "gl/context.hpp"
#include "gl/timer.hpp"
#include "lab/bias_run.hpp"
#include "lab/figures.hpp"
#include "lab/measure.hpp"
#include "lab/method_table.hpp"
#include "lab/methods.hpp"
#include "lab/options.hpp"
#include "lab/path_runner.hpp"
#include "lab/picture.hpp"
#include "lab/progress.hpp"
#include "lab/report.hpp"
#include "lab/report_folder.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"
#include "lab/statistics.hpp"
#include "lab/truth.hpp"
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

/// The ray tracer as a method: its own truth, timed.
lab::method_result run_ray_tracer(const lab::ray_tracer& rays, const lab::scene& world,
                                  const lab::g_buffer_samples& samples,
                                  const lab::light_view& light, int repeat) {
    lab::method_result result{};
    std::vector<double> times;
    for (int i = 0; i < repeat; ++i) {
        lab::traced_shadows traced = rays.shadows(samples, light);
        times.push_back(traced.ms);
        result.shadowed = std::move(traced.shadowed);
    }
    const double median = lab::median(times);
    result.frame_ms_median = samples.draw_ms + median;
    result.frame_ms_min = samples.draw_ms + *std::min_element(times.begin(), times.end());
    result.frame_ms_max = samples.draw_ms + *std::max_element(times.begin(), times.end());
    result.frames = repeat;
    result.passes = {{"g-buffer", samples.draw_ms}, {"rays", median}};
    result.bytes = rays.bytes();
    result.triangles = world.triangles.size();
    return result;
}

/// Runs everything on one view and keeps its pictures.
class view_runner {
  public:
    view_runner(const lab::options& wanted, lab::results& all, lab::report_folder& folder,
                lab::progress_bar& progress)
        : wanted_(wanted), all_(all), folder_(folder), progress_(progress) {}

    lab::view_pictures run(const job& work, lab::renderer& renderer, const lab::ray_tracer& rays,
                           const lab::camera_view& camera, const lab::light_view& light) {
        const lab::g_buffer_samples samples = renderer.samples(camera, light);
        const lab::traced_shadows truth = rays.shadows(samples, light);
        const std::size_t first = all_.runs.size();
        for (const int map : wanted_.maps) {
            for (const std::string& method : wanted_.methods) {
                const bool traces = method == "raytraced";
                if ((traces && map != wanted_.maps.front()) || lab::why_not(method, light)) {
                    continue;
                }
                for (const auto& [bias, raster] : variants(method)) {
                    if (bias && lab::why_not(method, light, *bias)) {
                        continue;
                    }
                    lab::stop_if_asked();
                    progress_.show(
                        work.world.name + " " + method +
                        (traces ? std::string() : std::string(" ") + std::to_string(map)));
                    lab::run_record record{work.world.name,  camera.label, light.label, method,
                                           traces ? 0 : map, {},           {}};
                    if (traces) {
                        record.result =
                            run_ray_tracer(rays, work.world, samples, light, wanted_.repeat);
                        record.against_truth =
                            lab::compare(samples, truth.shadowed, record.result.shadowed);
                    } else {
                        lab::run_method(record, renderer,
                                        {camera, light, map, wanted_.seed, wanted_.repeat, bias,
                                         wanted_.filter, raster.value_or(lab::raster_choice{}),
                                         &rays, wanted_.tables, &truth.shadowed},
                                        samples, truth.shadowed);
                        if (raster) {
                            record.raster = lab::raster_name(*raster);
                        }
                        if (!record.result.light.empty()) {
                            record.filter = lab::filter_name(wanted_.filter.kind);
                        }
                    }
                    all_.runs.push_back(std::move(record));
                    progress_.advance();
                    if (traces) {
                        break;
                    }
                }
            }
        }
        return pictures(work, rays, samples, truth, camera, light, first);
    }

  private:
    struct variant {
        std::optional<lab::bias_choice> bias;
        std::optional<lab::raster_choice> raster;
    };

    /// What one method is run with.
    std::vector<variant> variants(const std::string& method) const {
        std::vector<std::optional<lab::raster_choice>> rasters;
        if (lab::has_tables(method)) {
            rasters.assign(wanted_.rasters.begin(), wanted_.rasters.end());
        }
        if (rasters.empty()) {
            rasters.emplace_back();
        }
        std::vector<variant> result;
        for (const std::optional<lab::bias_choice>& bias : biases()) {
            for (const std::optional<lab::raster_choice>& raster : rasters) {
                result.push_back({bias, raster});
            }
        }
        return result;
    }

    /// Nothing where no bias was asked for.
    std::vector<std::optional<lab::bias_choice>> biases() const {
        std::vector<std::optional<lab::bias_choice>> result(wanted_.biases.begin(),
                                                            wanted_.biases.end());
        if (result.empty()) {
            result.emplace_back();
        }
        return result;
    }

    lab::view_pictures pictures(const job& work, const lab::ray_tracer& rays,
                                const lab::g_buffer_samples& samples,
                                const lab::traced_shadows& truth, const lab::camera_view& camera,
                                const lab::light_view& light, std::size_t first) {
        progress_.show(work.world.name + " pictures");
        const lab::shader shader(work.world, rays, samples, camera, light);
        std::vector<std::span<const std::uint8_t>> marks;
        for (std::size_t i = first; i < all_.runs.size(); ++i) {
            if (all_.runs[i].map != 0) {
                marks.emplace_back(all_.runs[i].against_truth.wrong);
            }
        }
        constexpr int zoom = 3;
        const glm::ivec2 window = glm::max(samples.size / 4, glm::ivec2(1));
        const glm::ivec2 corner = lab::window_of_difference(marks, samples.size, window);

        const std::string c = std::string("c") + camera.label;
        const std::string l = std::string("l") + light.label;
        const lab::picture reference = shader.shade(truth.shadowed);
        lab::view_pictures view{
            work.world.name,        camera.label, light.label, lab::camera_text(camera),
            lab::light_text(light), {},           {},          {}};
        view.reference = write(lab::picture_name({work.world.name, c, l, "raytraced"}), reference);
        view.reference_detail = lab::png_of(lab::cropped(reference, corner, window, zoom));
        for (std::size_t i = first; i < all_.runs.size(); ++i) {
            lab::run_record& run = all_.runs[i];
            lab::run_pictures seen{i, {}, {}, {}, {}};
            if (run.map != 0) {
                const std::string map = std::string("m") + std::to_string(run.map);
                const auto name = [&](const std::string& kind) {
                    return lab::picture_name(
                        {work.world.name, c, l, map,
                         run.method + (run.bias ? "-" + *run.bias : std::string()) +
                             (run.raster ? "-" + *run.raster : std::string()) + kind});
                };
                const lab::picture plain = run.result.light.empty()
                                               ? shader.shade(run.result.shadowed)
                                               : shader.shade(run.result.light);
                lab::picture marked = plain;
                lab::paint_red(marked, run.against_truth.wrong);
                write(name(""), plain);
                seen.marked = write(name("-wrong"), marked);
                seen.detail = write(name("-detail"), lab::cropped(plain, corner, window, zoom));
                seen.detail_marked =
                    write(name("-detail-wrong"), lab::cropped(marked, corner, window, zoom));
                for (lab::named_picture& each : run.result.pictures) {
                    lab::png_file file = write(name(std::string("-") + each.name),
                                               {each.width, each.height, std::move(each.rgb)});
                    seen.explanations.emplace_back(each.name, std::move(file));
                }
            }
            view.runs.push_back(std::move(seen));
            // one value per pixel, which nothing needs any more
            run.result.pictures.clear();
            run.result.shadowed = {};
            run.result.biases = {};
            run.result.light = {};
            run.against_truth.wrong = {};
        }
        return view;
    }

    lab::png_file write(const std::string& name, const lab::picture& source) {
        lab::png_file file = lab::png_of(source);
        folder_.write(name, file.bytes);
        return file;
    }

    const lab::options& wanted_;
    lab::results& all_;
    lab::report_folder& folder_;
    lab::progress_bar& progress_;
};

void run_lab(const lab::options& wanted) {
    const std::vector<job> jobs = open_jobs(wanted);
    check_paths(wanted, jobs);
    lab::report_folder folder(wanted.out);
    const gl::headless_context context;
    check_limits(wanted);

    lab::results all;
    all.renderer = context.info().renderer;
    all.version = context.info().version;
    all.timing = gl::timing_name(gl::best_timing());
    all.view = wanted.view;
    std::size_t steps = 0;
    for (const job& work : jobs) {
        steps += work.cameras.size() * work.lights.size() *
                 (wanted.preset.empty()
                      ? wanted.methods.size() * wanted.maps.size() *
                            std::max<std::size_t>(wanted.biases.size(), 1) *
                            std::max<std::size_t>(wanted.rasters.size(), 1) *
                            (wanted.path.empty() ? 1 : static_cast<std::size_t>(wanted.frames))
                      : lab::runs_of_figure(wanted.preset));
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
                    if (const auto reason = lab::why_not(method, light)) {
                        all.left_out.push_back({work.world.name, light.label, method, *reason});
                        continue;
                    }
                    for (const lab::bias_choice& bias : wanted.biases) {
                        if (const auto reason = lab::why_not(method, light, bias)) {
                            all.left_out.push_back({work.world.name, light.label, method, *reason});
                        }
                    }
                }
            }
            view_runner runner(wanted, all, folder, progress);
            for (const lab::camera_view& camera : work.cameras) {
                for (const lab::light_view& light : work.lights) {
                    if (lab::is_vpl(wanted.preset)) {
                        lab::run_vpl(wanted, work.world, all, progress);
                    } else if (!wanted.preset.empty()) {
                        figures.push_back(lab::run_figure(wanted, work.world, renderer, rays,
                                                          camera, light, all, folder, progress));
                    } else if (wanted.path.empty()) {
                        views.push_back(runner.run(work, renderer, rays, camera, light));
                    } else {
                        paths.push_back(lab::run_path(wanted, work.world, renderer, rays, camera,
                                                      light, all, folder, progress));
                    }
                }
            }
        }
        progress.show("report");
        folder.write("results.json", lab::json_of(all));
        std::vector<std::string> sections;
        for (const lab::figure_pictures& each : figures) {
            sections.push_back(lab::figure_section(all, each));
        }
        for (std::size_t i = 0; i < all.vpls.size(); ++i) {
            sections.push_back(lab::vpl_section(all, i));
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
