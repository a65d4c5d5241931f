#include "lab/path_runner.hpp"

#include "lab/light_maps.hpp"
#include "lab/method_table.hpp"
#include "lab/view_arguments.hpp"

#include <algorithm>

namespace lab {
namespace {

/// One method at one map size while the camera moves.
struct mover {
    std::string method;
    int map; ///< 0 for a method without
    std::size_t record;
    method_memory memory;
    std::vector<std::uint8_t> shadowed; ///< of the last frame
};

} // namespace

path_pictures run_path(const options& wanted, const scene& world, renderer& gpu,
                       const ray_tracer& rays, const camera_view& start, const light_view& light,
                       results& all, report_folder& folder, progress_bar& progress) {
    const std::vector<camera_view> cameras = camera_path(wanted.path, world, start, wanted.frames);
    path_pictures seen{all.paths.size(),  0, wanted.maps.size() == 1, camera_text(start),
                       light_text(light), {}};
    std::vector<mover> movers;
    for (const int map : wanted.maps) {
        for (const std::string& method : wanted.methods) {
            // the ray tracer is what the others are compared with
            if (method == "raytraced" || why_not(method, light) || why_not(method, wanted.set_up) ||
                (!has_maps(method) && map != wanted.maps.front())) {
                continue;
            }
            const int own_map = has_maps(method) ? map : 0;
            movers.push_back({method, own_map, all.paths.size(), {}, {}});
            all.paths.push_back(
                {world.name, start.label, light.label, wanted.path, method, own_map, {}});
        }
    }
    seen.count = movers.size();

    g_buffer_samples before;
    gpu.remember_view(std::nullopt);
    for (std::size_t frame = 0; frame < cameras.size(); ++frame) {
        const camera_view& camera = cameras[frame];
        const g_buffer_samples samples = gpu.samples(camera, light);
        const std::vector<std::uint8_t> truth = rays.shadows(samples, light).shadowed;
        const glm::mat4 matrix = camera_matrix(camera_frustum(world, camera, samples.size));
        const bool is_pictured =
            wanted.sweep.empty() && // whose views have pictures enough
            (frame == 0 || frame == cameras.size() / 2 || frame + 1 == cameras.size());
        const std::optional<shader> shades =
            is_pictured ? std::optional<shader>(std::in_place, world, rays, samples, camera, light)
                        : std::nullopt;
        for (mover& each : movers) {
            stop_if_asked();
            progress.show(world.name + " " + each.method + " frame " + std::to_string(frame));
            moving_frame moved = gpu.next_frame(each.method,
                                                {camera,
                                                 light,
                                                 each.map,
                                                 wanted.seed,
                                                 1,
                                                 std::nullopt,
                                                 {},
                                                 raster_of(wanted),
                                                 &rays,
                                                 wanted.tables,
                                                 &truth,
                                                 wanted.set_up},
                                                each.memory);
            const comparison against_truth = compare(samples, truth, moved.shadowed);
            path_frame row{};
            row.wrong_ratio =
                against_truth.ratio(against_truth.false_shadow + against_truth.false_light);
            if (frame > 0) {
                row.flip_ratio =
                    flip_ratio(before, each.shadowed, moved.shadowed_before, samples, matrix);
            }
            row.angle = moved.angle;
            row.frame_ms = moved.frame_ms;
            row.shadow_map_ms = moved.shadow_map_ms;
            row.maps = moved.maps;
            all.paths[each.record].frames.push_back(row);
            each.shadowed = std::move(moved.shadowed);
            if (shades) {
                picture marked = shades->shade(each.shadowed);
                paint_red(marked, against_truth.wrong);
                const std::string size = each.map == 0 ? "" : std::to_string(each.map);
                const std::string caption = each.method +
                                            (size.empty() ? "" : " at " + size + "²") + ", frame " +
                                            std::to_string(frame);
                png_file file = png_of(marked);
                folder.write(picture_name({world.name, "c" + camera.label, "l" + light.label,
                                           (size.empty() ? "" : "m" + size + "-") + each.method,
                                           "frame", std::to_string(frame)}),
                             file.bytes);
                seen.pictures.emplace_back(caption, std::move(file));
            }
            progress.advance();
        }
        before = samples;
        gpu.remember_view(camera);
    }
    return seen;
}

} // namespace lab
