#include "lab/method_frames.hpp"

#include "lab/align.hpp"

#include <warpshadow/projective.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace lab {

namespace ws = warpshadow;

namespace {

/// Cells along a side of the histogram that a projective warp is fitted to.
constexpr int histogram_cells = 64;

/// Texels along a side of each map: all partitions together have those of one map.
int size_of_maps(const method& how, int map_size) {
    return std::max(1, static_cast<int>(std::lround(map_size / std::sqrt(how.partitions))));
}

/// Whether turning the map makes sense: not one face of several, and not where a matrix warps.
bool can_be_turned(const method& how, const light_maps& chosen) {
    return chosen.choice == map_choice::single && how.base != map_base::lispsm && !how.fitted;
}

} // namespace

std::size_t count_of_maps(const method& how, const light_maps& chosen) {
    return std::max(chosen.maps.size(), static_cast<std::size_t>(how.partitions));
}

map_resources resources_for(const method& how, const view_request& request, std::size_t maps) {
    const warp_options options = request.tables.over(how.tables);
    const int size = size_of_maps(how, request.map_size);
    const int cells = how.warp ? std::min(options.tables, size) : 0;
    return {size, maps, cells, options.rectilinear ? 1 : cells, options.format};
}

method_frames::method_frames(const scene& world, glm::ivec2 view) : gpu(world, view), seen(view) {}

light_maps method_frames::choose_maps(const method& how, const view_request& request,
                                      light_memory& memory) const {
    const scene& world = gpu.world();
    if (how.base == map_base::whole_scene) {
        return whole_scene_maps(world, request.light, request.set_up);
    }
    const ws::frustum<double> camera = camera_frustum(world, request.camera, gpu.view());
    if (how.base == map_base::all_around) {
        return omni_maps(world, std::span(&camera, 1), request.light, how.omni);
    }
    if (how.base == map_base::stable) {
        return stable_maps(world, camera, request.light, request.map_size, request.set_up);
    }
    if (how.base == map_base::cascades) {
        return cascade_maps(world, camera, request.light, how.partitions,
                            size_of_maps(how, request.map_size), request.set_up);
    }
    return how.base == map_base::lispsm ? lispsm_maps(world, camera, request.light, request.set_up)
                                        : minimal_maps(world, camera, request.light,
                                                       request.map_size, memory, request.set_up);
}

light_maps method_frames::frame(const method& how, const view_request& request,
                                light_memory& memory, map_resources& maps,
                                const shadow_memory& shadows, bool count) {
    const ws::frustum<double> camera = camera_frustum(gpu.world(), request.camera, gpu.view());
    light_maps chosen = choose_maps(how, request, memory);
    gpu.timed_pass("g-buffer", [&] {
        gpu.draw_view(seen, camera_matrix(camera), glm::vec3(request.camera.eye));
    });
    gpu.use(seen, chosen, request.light.light);
    if (chosen.maps.size() < count_of_maps(how, chosen)) {
        gpu.timed_pass("depth range", [&] { split(how, camera, chosen); });
        gpu.use(seen, chosen, request.light.light);
    }
    if (!drawn_one_by_one(how)) {
        gpu.timed_pass("shadow map", [&] { omni.draw(maps, chosen, request.light, how.omni); });
        culling_us.push_back(omni.culling_us());
    }
    memory.bends.resize(chosen.maps.size());
    for (std::size_t i = 0; i < chosen.maps.size(); ++i) {
        if (!chosen.maps[i].used || !drawn_one_by_one(how)) {
            continue;
        }
        if (how.desired_view) {
            gpu.timed_pass("desired view", [&] { gpu.crop_to_desired_view(maps, i); });
        }
        if (how.fitted) {
            gpu.timed_pass("fit",
                           [&] { fit(request.light.light.kind, i, memory.bends[i], chosen); });
            // the fit knows the samples to a cell of its histogram; the crop knows them exactly
            gpu.timed_pass("desired view", [&] { gpu.crop_to_desired_view(maps, i); });
        }
        if (how.warp) {
            const warp_options options = request.tables.over(how.tables);
            if (options.align && can_be_turned(how, chosen)) {
                align(how, options, camera, shadows, memory, maps, chosen);
            }
            if (options.build.v_first) {
                gpu.warp_map(
                    i, glm::dmat4(glm::dvec4(0.0, 1.0, 0.0, 0.0), glm::dvec4(1.0, 0.0, 0.0, 0.0),
                                  glm::dvec4(0.0, 0.0, 1.0, 0.0), glm::dvec4(0.0, 0.0, 0.0, 1.0)));
            }
            warps.build(maps, i, options, camera, shadows, count);
            if (!how.omni.hemispheres) {
                weakened = warped.weaken(maps, i);
            }
            draw_warped(how, request, maps, i, count);
        } else {
            gpu.timed_pass("shadow map", [&] {
                if (request.bias) {
                    biased.draw_map(maps, i, chosen, *request.bias);
                } else {
                    gpu.draw_plain_map(maps, i);
                }
            });
        }
    }
    const bool filters = request.filter.kind != shadow_filter::none && !how.omni.hemispheres;
    // a filter takes the place of the test, whose answers stay, unless the next frame asks for them
    if (!filters || count || how.tables.shadows == known_shadows::last_frame) {
        gpu.timed_pass("shadow test", [&] {
            if (request.bias) {
                biased.test(maps, chosen, how.warp, *request.bias);
            } else {
                test(how, request.light, maps, chosen);
            }
        });
    }
    if (filters) {
        gpu.timed_pass("filter", [&] {
            biased.filter(maps, chosen, how.warp, request.bias.value_or(bias_choice{}),
                          request.filter, seen, camera, count);
        });
    }
    return chosen;
}

void method_frames::align(const method& how, const warp_options& options,
                          const ws::frustum<double>& camera, const shadow_memory& shadows,
                          light_memory& memory, map_resources& maps, light_maps& chosen) {
    const std::vector<std::uint32_t> counts = warps.importance(maps, 0, options, camera, shadows);
    gpu.timed_pass("align", [&] {
        chosen.angle = turn_to_importance(gpu, 0, counts, maps.warps.front().counts.width(),
                                          chosen.angle, memory.turn);
    });
    if (how.desired_view) {
        gpu.timed_pass("desired view", [&] { gpu.crop_to_desired_view(maps, 0); });
    }
}

void method_frames::draw_warped(const method& how, const view_request& request, map_resources& maps,
                                std::size_t index, bool count) {
    if (how.omni.hemispheres) {
        omni.draw_warped(maps, index, request.light, count);
    } else {
        warped.draw_map(maps, index, request.raster, request.rays, count);
    }
}

bool method_frames::grow_lists(const method& how) {
    return how.warp && (how.omni.hemispheres ? omni.raster().grow_lists() : warped.grow_lists());
}

void method_frames::forget_counts() {
    warped.forget_counts();
    omni.raster().forget_counts();
}

const std::vector<triangle_counts>& method_frames::counted(const method& how) const {
    return how.omni.hemispheres ? omni.raster().counted() : warped.counted();
}

shadow_memory method_frames::told(const method& how, const view_request& request) {
    shadow_memory result;
    if (how.tables.shadows == known_shadows::truth && request.truth != nullptr) {
        warps.remember(result, camera_frustum(gpu.world(), request.camera, gpu.view()),
                       *request.truth);
    }
    return result;
}

void method_frames::remember(const method& how, const view_request& request,
                             shadow_memory& shadows) {
    if (how.tables.shadows == known_shadows::last_frame) {
        gpu.timed_pass("keep shadows", [&] {
            warps.remember(shadows, camera_frustum(gpu.world(), request.camera, gpu.view()));
        });
    }
}

void method_frames::draw(const method& how, const view_request& request, standing_view& view,
                         bool count) {
    light_memory fresh;
    view.chosen = frame(how, request, fresh, view.maps, view.shadows, count);
    remember(how, request, view.shadows);
}

standing_view method_frames::prepare(const method& how, const view_request& request) {
    light_memory memory;
    light_maps chosen = choose_maps(how, request, memory);
    map_resources maps = resources_for(how, request, count_of_maps(how, chosen));
    standing_view view{std::move(maps), {}, std::move(chosen)};
    fit_us.clear();
    culling_us.clear();
    bool grown = false;
    do {
        view.shadows = told(how, request);
        forget_counts();
        draw(how, request, view, true);
        grown = grow_lists(how);
        if (!grown && how.tables.shadows == known_shadows::last_frame) {
            // the shadows of a first frame make another warp, which may need more
            forget_counts();
            draw(how, request, view, true);
            grown = grow_lists(how);
        }
    } while (grown);
    glFinish();
    return view;
}

void method_frames::test(const method& how, const light_view& light, map_resources& maps,
                         const light_maps& chosen) {
    if (how.omni.hemispheres) {
        omni.test_hemispheres(maps, chosen, light, how.warp);
    } else {
        gpu.test_shadows(maps, chosen, how.warp);
    }
}

void method_frames::split(const method& how, const ws::frustum<double>& camera,
                          light_maps& chosen) {
    const glm::dvec2 range = gpu.depth_range(camera).value_or(
        glm::dvec2(camera.volume.near_distance, camera.volume.far_distance));
    const double nearest = std::max(range.x, camera.volume.near_distance);
    std::vector<double> splits;
    for (int i = 1; i < how.partitions; ++i) {
        splits.push_back(nearest * std::pow(std::max(range.y / nearest, 1.0),
                                            static_cast<double>(i) / how.partitions));
    }
    split_by_depth(chosen, camera, std::move(splits));
}

void method_frames::fit(ws::light_kind kind, std::size_t index, ws::projective_state<double>& bend,
                        light_maps& chosen) {
    if (chosen.at == precision::in_float) {
        fit_at<float>(kind, index, bend, chosen);
    } else {
        fit_at<double>(kind, index, bend, chosen);
    }
}

template <typename T>
void method_frames::fit_at(ws::light_kind kind, std::size_t index,
                           ws::projective_state<double>& bend, light_maps& chosen) {
    const std::vector<std::uint32_t> counts = gpu.histogram(index, histogram_cells);
    const auto begin = std::chrono::steady_clock::now();
    const ws::projective_result<T> fitted = ws::fit_projective<T>(
        std::span<const std::uint32_t>(counts), histogram_cells, histogram_cells, {},
        {glm::vec<2, T>(bend.bend), static_cast<T>(bend.angle), bend.turned, bend.started});
    const std::chrono::duration<double, std::micro> elapsed =
        std::chrono::steady_clock::now() - begin;
    fit_us.push_back(elapsed.count());
    const ws::projective_state<T>& next = fitted.state;
    bend = {glm::dvec2(next.bend), static_cast<double>(next.angle), next.turned, next.started};
    chosen.flags |= fitted.flags;
    gpu.warp_map(index, glm::dmat4(ws::projective_matrix(fitted.map, ws::clip::opengl, kind)));
    const auto centre = ws::projective_depth<double>(kind, ws::clip::opengl);
    chosen.maps[index].linear = {1.0, centre, centre};
}

} // namespace lab
