#include "lab/raster_figure.hpp"

#include "lab/bias_run.hpp"
#include "lab/method_table.hpp"
#include "lab/view_arguments.hpp"
#include "lab/warp_pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace lab {
namespace {

constexpr std::array<const char*, 2> methods{"rtw-backward", "notw"};
constexpr std::array<const char*, 9> ways{"none",      "fragment", "rule:5", "rule:2.5", "rule:1",
                                          "bound:0.5", "hull",     "exact",  "ideal"};
constexpr int zoom = 2;

/// What one cell needs until all have run.
struct seen_cell {
    std::size_t run;
    std::string way;
    std::vector<std::uint8_t> shadowed;
    std::vector<std::uint8_t> wrong;
    std::vector<float> depth;
    std::vector<std::uint8_t> off; ///< texels that are not as in the ideal map
};

/// Runs all ways of one method; none if it cannot do the light.
std::vector<seen_cell> run_ways(const std::string& method, const view_request& request,
                                const scene& world, renderer& gpu, const g_buffer_samples& samples,
                                std::span<const std::uint8_t> truth, results& all,
                                progress_bar& progress) {
    const light_view& light = request.light;
    std::vector<seen_cell> cells;
    if (const std::optional<std::string> reason = why_not(method, light)) {
        all.left_out.push_back({world.name, light.label, method, *reason});
        for (std::size_t i = 0; i < ways.size(); ++i) {
            progress.advance();
        }
        return cells;
    }
    for (const char* const way : ways) {
        stop_if_asked();
        progress.show(world.name + " " + method + " " + way);
        view_request each = request;
        each.raster = parse_raster(way);
        run_record run{world.name, request.camera.label, light.label, method, request.map_size, {},
                       {}};
        run.kind = kind_text(light.light.kind);
        run.raster = raster_name(each.raster);
        if (each.tables.format == table_format::unorm16) {
            run.tables = "unorm16";
        }
        run_method(run, gpu, each, samples, truth);
        cells.push_back({all.runs.size(),
                         way,
                         std::move(run.result.shadowed),
                         std::move(run.against_truth.wrong),
                         std::move(run.result.depth),
                         {}});
        run.result.pictures.clear();
        all.runs.push_back(std::move(run));
        progress.advance();
    }
    return cells;
}

double share_of(const std::vector<std::uint8_t>& marks) {
    return static_cast<double>(std::count(marks.begin(), marks.end(), std::uint8_t{1})) /
           static_cast<double>(std::max<std::size_t>(marks.size(), 1));
}

} // namespace

bool is_raster_figure(const std::string& preset) {
    return preset == "figure7";
}

figure_defaults defaults_of_raster_figure() {
    return {"colonnade", "0", "0", 512, {512, 384}};
}

std::size_t runs_of_raster_figure() {
    return methods.size() * ways.size();
}

std::vector<std::uint8_t> wrong_texels(std::span<const float> depth, std::span<const float> ideal) {
    float lo = std::numeric_limits<float>::infinity();
    float hi = 0.0f;
    for (const float d : ideal) {
        if (d < 1.0f) {
            lo = std::min(lo, d);
            hi = std::max(hi, d);
        }
    }
    const float allowed = hi > lo ? (hi - lo) / 500.0f : 0.0f;
    std::vector<std::uint8_t> wrong(ideal.size());
    for (std::size_t i = 0; i < ideal.size(); ++i) {
        const bool empty = depth[i] >= 1.0f;
        wrong[i] =
            empty != (ideal[i] >= 1.0f) || !(std::abs(depth[i] - ideal[i]) <= allowed) ? 1 : 0;
    }
    return wrong;
}

figure_pictures run_raster_figure(const options& wanted, const scene& world, renderer& gpu,
                                  const ray_tracer& rays, const camera_view& camera,
                                  const light_view& light, results& all, report_folder& folder,
                                  progress_bar& progress) {
    const g_buffer_samples samples = gpu.samples(camera, light);
    const std::vector<std::uint8_t> truth = rays.shadows(samples, light).shadowed;
    const shader shades(world, rays, samples, camera, light);
    const int map = wanted.maps.front();
    view_request request{camera, light, map, wanted.seed, wanted.repeat};
    request.rays = &rays;
    request.tables = wanted.tables;
    request.truth = &truth;
    request.keep_depth = true;
    std::vector<std::pair<std::string, std::vector<seen_cell>>> rows;
    for (const char* const method : methods) {
        rows.emplace_back(method,
                          run_ways(method, request, world, gpu, samples, truth, all, progress));
    }
    // where no edge is cut, much is wrong anywhere: that would say nothing about the rest
    std::vector<std::span<const std::uint8_t>> marks;
    std::vector<std::span<const std::uint8_t>> map_marks;
    for (auto& [method, cells] : rows) {
        for (seen_cell& cell : cells) {
            cell.off = wrong_texels(cell.depth, cells.back().depth);
            if (cell.way != "none" && cell.way != "fragment") {
                marks.emplace_back(cell.wrong);
                map_marks.emplace_back(cell.off);
            }
        }
    }
    const glm::ivec2 window = glm::max(samples.size / 4, glm::ivec2(1));
    const glm::ivec2 corner = window_of_difference(marks, samples.size, window);
    const glm::ivec2 map_window(std::max(map / 4, 1));
    const glm::ivec2 map_corner = window_of_difference(map_marks, glm::ivec2(map), map_window);

    const auto write = [&](const std::string& kind, const picture& source) {
        return write_figure_picture(wanted, world, camera, light, folder, kind, source);
    };
    figure_record record{wanted.preset, world.name, camera.label, light.label, {}};
    const picture reference = shades.shade(truth);
    figure_pictures seen{all.figures.size(),
                         camera_text(camera),
                         light_text(light),
                         write("raytraced", reference),
                         {},
                         {}};
    write("raytraced-detail", cropped(reference, corner, window, zoom));
    for (const auto& [method, cells] : rows) {
        for (const seen_cell& cell : cells) {
            figure_record::cell entry{method, cell.way, cell.run, {}, {}, {}};
            entry.wrong_texels = share_of(cell.off);
            const std::string name = method + "-" + cell.way;
            picture shown = shades.shade(cell.shadowed);
            paint_red(shown, cell.wrong);
            seen.cells.push_back(write(name, cropped(shown, corner, window, zoom)));
            named_picture depth = depth_picture(cell.depth, map, name);
            picture of_map{depth.width, depth.height, std::move(depth.rgb)};
            paint_red(of_map, cell.off);
            seen.maps.push_back(
                write(name + "-map", cropped(of_map, map_corner, map_window, zoom)));
            record.cells.push_back(std::move(entry));
        }
    }
    all.figures.push_back(std::move(record));
    return seen;
}

std::string raster_figure_section(const results& all, const figure_pictures& seen) {
    return matrix_section(
        all, seen,
        {"figure 7 of Rosen 2012",
         "The same part of the picture and of the map, drawn in every way of --raster, where those "
         "that do something about bent edges differ most. Red: pixels whose shadow is wrong, and "
         "texels "
         "whose depth is not that of the ideal map. Shares are of the whole picture and the whole "
         "map.",
         256, [](const figure_record::cell& cell, const run_record& run) {
             const comparison& c = run.against_truth;
             return "wrong&nbsp;pixels&nbsp;" +
                    percent_text(c.ratio(c.false_shadow + c.false_light)) +
                    "&nbsp;%, wrong&nbsp;texels&nbsp;" + percent_text(cell.wrong_texels) +
                    "&nbsp;%" +
                    (cell.column == "ideal"
                         ? ", a&nbsp;ray&nbsp;per&nbsp;texel"
                         : ", triangles&nbsp;" + std::to_string(run.result.triangles) +
                               ", frame&nbsp;" + ms_text(run.result.frame_ms_median) + "&nbsp;ms");
         }});
}

} // namespace lab
