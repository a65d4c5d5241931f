#include "lab/methods.hpp"

#include "lab/align.hpp"
#include "lab/bias_passes.hpp"
#include "lab/frame_times.hpp"
#include "lab/light_picture.hpp"
#include "lab/method_table.hpp"
#include "lab/metric_passes.hpp"
#include "lab/omni.hpp"
#include "lab/passes.hpp"
#include "lab/statistics.hpp"
#include "lab/tables.hpp"
#include "lab/volumes.hpp"
#include "lab/warp_pictures.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace lab {

namespace ws = warpshadow;

namespace {

/// Cosine between normal and light, or 0 outside a spot light's cone; as lit_cosine in GLSL.
double lit_cosine(const ws::light<double>& light, glm::dvec3 world, glm::dvec3 normal) {
    if (light.kind == ws::light_kind::directional) {
        return glm::dot(normal, -glm::normalize(light.direction));
    }
    const glm::dvec3 l = glm::normalize(light.position - world);
    const bool in_cone =
        light.kind != ws::light_kind::spot ||
        glm::dot(-l, glm::normalize(light.direction)) >= std::cos(0.5 * light.cone_angle);
    return in_cone ? glm::dot(normal, l) : 0.0;
}

/// Cells along a side of the histogram that a projective warp is fitted to.
constexpr int histogram_cells = 64;

/// Texels along a side of each map: all partitions together have those of one map.
int size_of_maps(const method& how, int map_size) {
    return std::max(1, static_cast<int>(std::lround(map_size / std::sqrt(how.partitions))));
}

/// Maps that a method draws: as many as were chosen, unless its partitions share what was.
std::size_t count_of_maps(const method& how, const light_maps& chosen) {
    return std::max(chosen.maps.size(), static_cast<std::size_t>(how.partitions));
}

map_resources resources(const method& how, const view_request& request, std::size_t maps) {
    const warp_options options = request.tables.over(how.tables);
    const int size = size_of_maps(how, request.map_size);
    const int cells = how.warp ? std::min(options.tables, size) : 0;
    return {size, maps, cells, options.rectilinear ? 1 : cells};
}

/// Whether turning the map makes sense: not one face of several, and not where a matrix warps.
bool can_be_turned(const method& how, const light_maps& chosen) {
    return chosen.choice == map_choice::single && how.base != map_base::lispsm && !how.fitted;
}

/// What a method keeps on the device while a camera moves.
struct moving_resources {
    map_resources maps;
    shadow_memory shadows;
};

/// What a method draws again and again for a camera that stands still.
struct standing_view {
    map_resources maps;
    shadow_memory shadows;
    light_maps chosen;
};

int used_maps(const light_maps& chosen) {
    return static_cast<int>(std::count_if(chosen.maps.begin(), chosen.maps.end(),
                                          [](const light_map& each) { return each.used; }));
}

} // namespace

struct renderer::state {
    state(const scene& world, glm::ivec2 view) : gpu(world, view), seen(view), seen_before(view) {}

    light_maps choose_maps(const method& how, const view_request& request,
                           light_memory& memory) const {
        const scene& world = gpu.world();
        if (how.base == map_base::whole_scene) {
            return whole_scene_maps(world, request.light);
        }
        const ws::frustum<double> camera = camera_frustum(world, request.camera, gpu.view());
        if (how.base == map_base::all_around) {
            return omni_maps(world, std::span(&camera, 1), request.light, how.omni);
        }
        if (how.base == map_base::stable) {
            return stable_maps(world, camera, request.light, request.map_size);
        }
        if (how.base == map_base::cascades) {
            return cascade_maps(world, camera, request.light, how.partitions,
                                size_of_maps(how, request.map_size));
        }
        return how.base == map_base::lispsm
                   ? lispsm_maps(world, camera, request.light)
                   : minimal_maps(world, camera, request.light, request.map_size, memory);
    }

    /// One frame from the G-buffer to the shadow test.
    light_maps frame(const method& how, const view_request& request, light_memory& memory,
                     map_resources& maps, const shadow_memory& shadows, bool count) {
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
                    gpu.warp_map(i, glm::dmat4(glm::dvec4(0.0, 1.0, 0.0, 0.0),
                                               glm::dvec4(1.0, 0.0, 0.0, 0.0),
                                               glm::dvec4(0.0, 0.0, 1.0, 0.0),
                                               glm::dvec4(0.0, 0.0, 0.0, 1.0)));
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
        gpu.timed_pass("shadow test", [&] {
            if (request.bias) {
                biased.test(maps, chosen, how.warp, *request.bias);
            } else {
                test(how, request.light, maps, chosen);
            }
        });
        return chosen;
    }

    /// Turns the one map there is, and crops it again.
    void align(const method& how, const warp_options& options, const ws::frustum<double>& camera,
               const shadow_memory& shadows, light_memory& memory, map_resources& maps,
               light_maps& chosen) {
        const std::vector<std::uint32_t> counts =
            warps.importance(maps, 0, options, camera, shadows);
        gpu.timed_pass("align", [&] {
            chosen.angle = turn_to_importance(gpu, 0, counts, maps.warps.front().counts.width(),
                                              chosen.angle, memory.turn);
        });
        if (how.desired_view) {
            gpu.timed_pass("desired view", [&] { gpu.crop_to_desired_view(maps, 0); });
        }
    }

    void draw_warped(const method& how, const view_request& request, map_resources& maps,
                     std::size_t index, bool count) {
        if (how.omni.hemispheres) {
            omni.draw_warped(maps, index, request.light, count);
        } else {
            warped.draw_map(maps, index, request.raster, request.rays, count);
        }
    }

    /// Makes the lists of cut triangles long enough; false if they were.
    bool grow_lists(const method& how) {
        return how.warp &&
               (how.omni.hemispheres ? omni.raster().grow_lists() : warped.grow_lists());
    }

    void forget_counts() {
        warped.forget_counts();
        omni.raster().forget_counts();
    }

    const std::vector<triangle_counts>& counted(const method& how) const {
        return how.omni.hemispheres ? omni.raster().counted() : warped.counted();
    }

    /// The shadows that a method is told before its first frame.
    shadow_memory told(const method& how, const view_request& request) {
        shadow_memory result;
        if (how.tables.shadows == known_shadows::truth && request.truth != nullptr) {
            warps.remember(result, camera_frustum(gpu.world(), request.camera, gpu.view()),
                           *request.truth);
        }
        return result;
    }

    /// Keeps the shadows of a frame for the next, for methods that want them.
    void remember(const method& how, const view_request& request, shadow_memory& shadows) {
        if (how.tables.shadows == known_shadows::last_frame) {
            gpu.timed_pass("keep shadows", [&] {
                warps.remember(shadows, camera_frustum(gpu.world(), request.camera, gpu.view()));
            });
        }
    }

    /// One frame of a view that stands still.
    void draw(const method& how, const view_request& request, standing_view& view, bool count) {
        light_memory fresh;
        view.chosen = frame(how, request, fresh, view.maps, view.shadows, count);
        remember(how, request, view.shadows);
    }

    /// Makes what a view needs. The first frame warms up and, with tables, finds how long the lists
    /// must be.
    standing_view prepare(const method& how, const view_request& request) {
        light_memory memory;
        light_maps chosen = choose_maps(how, request, memory);
        map_resources maps = resources(how, request, count_of_maps(how, chosen));
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

    /// Shadow test of the samples in use.
    void test(const method& how, const light_view& light, map_resources& maps,
              const light_maps& chosen) {
        if (how.omni.hemispheres) {
            omni.test_hemispheres(maps, chosen, light, how.warp);
        } else {
            gpu.test_shadows(maps, chosen, how.warp);
        }
    }

    /// Splits the depths of the lit samples in equal ratios (practical split of quality alone).
    void split(const method& how, const ws::frustum<double>& camera, light_maps& chosen) {
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

    /// Fits a projective warp to the lit samples of one map.
    void fit(ws::light_kind kind, std::size_t index, ws::projective_state<double>& bend,
             light_maps& chosen) {
        const std::vector<std::uint32_t> counts = gpu.histogram(index, histogram_cells);
        const auto begin = std::chrono::steady_clock::now();
        const ws::projective_result<double> fitted = ws::fit_projective<double>(
            std::span<const std::uint32_t>(counts), histogram_cells, histogram_cells, {}, bend);
        const std::chrono::duration<double, std::micro> elapsed =
            std::chrono::steady_clock::now() - begin;
        fit_us.push_back(elapsed.count());
        bend = fitted.state;
        chosen.flags |= fitted.flags;
        gpu.warp_map(index, ws::projective_matrix(fitted.map, ws::clip::opengl, kind));
        const auto centre = ws::projective_depth<double>(kind, ws::clip::opengl);
        chosen.maps[index].linear = {1.0, centre, centre};
    }

    /// Guards of all steps of the last frame.
    std::vector<std::string> guards(const method& how, const light_maps& chosen,
                                    const map_resources& maps) const {
        ws::status flags = chosen.flags;
        for (std::size_t i = 0; how.desired_view && i < chosen.maps.size(); ++i) {
            const std::vector<std::uint32_t> bits = maps.desired[i].read<std::uint32_t>();
            if (chosen.maps[i].used && bits[0] > bits[2]) {
                flags |= ws::status::empty_importance;
            }
        }
        for (const triangle_counts& each : counted(how)) {
            flags |= each.lost > 0 ? ws::status::capacity_reached : ws::status::ok;
            flags |= each.uncut > 0 ? ws::status::bound_missed : ws::status::ok;
        }
        std::vector<std::string> result;
        for (unsigned bit = 0; bit < 32; ++bit) {
            const auto one = static_cast<ws::status>(1u << bit);
            if (ws::any(flags, one)) {
                result.emplace_back(ws::status_name(one));
            }
        }
        return result;
    }

    std::vector<named_picture> pictures(const method& how, const view_request& request,
                                        const light_maps& chosen, const map_resources& maps) {
        std::vector<named_picture> result;
        const bool single = chosen.maps.size() == 1;
        const std::vector<float> depths = maps.depth.read<float>();
        const std::size_t texels =
            static_cast<std::size_t>(maps.size) * static_cast<std::size_t>(maps.size);
        std::vector<glm::mat4> in_use;
        for (std::size_t i = 0; i < chosen.maps.size(); ++i) {
            in_use.push_back(gpu.matrix_in_use(i));
        }
        for (std::size_t i = 0; i < chosen.maps.size(); ++i) {
            if (!chosen.maps[i].used) {
                continue;
            }
            const std::string suffix = single ? "" : "-" + std::to_string(i);
            if (how.warp) {
                const map_resources::tables& warp = maps.warps[i];
                for (named_picture& each :
                     warp_pictures({maps.size, warp.counts.width(), warp.rows.height(),
                                    warp.rows.read<float>(), warp.columns.read<float>(),
                                    warp.first_counts, warp.second_counts})) {
                    each.name += suffix;
                    result.push_back(std::move(each));
                }
            }
            result.push_back(depth_picture(std::span(depths).subspan(i * texels, texels), maps.size,
                                           "shadow-map" + suffix));
        }
        if (single && follows_the_view(how)) {
            const scene& world = gpu.world();
            constexpr int size = 512;
            const glm::dmat4 whole =
                enclosing(whole_scene_maps(world, request.light).maps.front().matrix,
                          glm::dmat4(in_use.front()));
            const std::vector<float> depth = gpu.draw_depths(whole, size);
            const ws::focus_result focus = focus_on(
                world, camera_frustum(world, request.camera, gpu.view()), request.light.light);
            result.push_back(
                light_picture({whole, depth, size}, glm::dmat4(in_use.front()), focus));
        }
        return result;
    }

    passes gpu;
    warped_raster warped{gpu};
    omni_passes omni{gpu};
    bias_passes biased{gpu};
    metric_passes metric{gpu};
    table_passes warps{gpu};
    volume_passes volumes{gpu};
    g_buffer seen, seen_before;
    std::vector<double> fit_us;        ///< times of the projective fit alone
    std::vector<double> culling_us;    ///< times of sorting objects to the maps of a point light
    double weakened = 0.0;             ///< share of the identity in the last tables
    std::optional<camera_view> before; ///< the camera of `seen_before`
    // kept while a camera moves, so that frames do not begin with allocations
    std::map<std::string, moving_resources, std::less<>> moving;
};

void add_times(method_result& result, std::span<const double> frame_ms) {
    result.frame_ms.insert(result.frame_ms.end(), frame_ms.begin(), frame_ms.end());
    if (result.frame_ms.empty()) {
        return;
    }
    const auto [least, most] = std::minmax_element(result.frame_ms.begin(), result.frame_ms.end());
    result.frame_ms_min = *least;
    result.frame_ms_max = *most;
    result.frame_ms_median = median(result.frame_ms);
}

renderer::renderer(const scene& world, glm::ivec2 view)
    : state_(std::make_unique<state>(world, view)) {}

renderer::~renderer() = default;

g_buffer_samples renderer::samples(const camera_view& camera, const light_view& light) {
    state& s = *state_;
    const glm::mat4 matrix = camera_matrix(camera_frustum(s.gpu.world(), camera, s.gpu.view()));
    s.gpu.draw_view(s.seen, matrix, glm::vec3(camera.eye)); // warms up
    s.gpu.watch().start();
    s.gpu.draw_view(s.seen, matrix, glm::vec3(camera.eye));
    g_buffer_samples result;
    result.draw_ms = s.gpu.watch().stop();
    result.size = s.gpu.view();
    result.position = s.seen.position.read<glm::vec4>();
    for (const glm::vec4& n : s.seen.normal.read<glm::vec4>()) {
        result.normal.emplace_back(n);
    }
    result.n_dot_l.resize(result.position.size(), 0.0f);
    for (std::size_t i = 0; i < result.position.size(); ++i) {
        if (result.position[i].w != 0.0f) {
            result.n_dot_l[i] = static_cast<float>(lit_cosine(
                light.light, glm::dvec3(result.position[i]), glm::dvec3(result.normal[i])));
        }
    }
    return result;
}

method_result renderer::run(std::string_view name, const view_request& request) {
    state& s = *state_;
    if (!has_maps(name)) {
        return s.volumes.run(s.seen, request);
    }
    const method& how = find_method(name);
    method_result result{};

    constexpr int set_ups = 31;
    std::vector<double> set_up_us;
    for (int i = 0; i < set_ups; ++i) {
        light_memory memory;
        const auto begin = std::chrono::steady_clock::now();
        const light_maps chosen = s.choose_maps(how, request, memory);
        const std::chrono::duration<double, std::micro> elapsed =
            std::chrono::steady_clock::now() - begin;
        set_up_us.push_back(elapsed.count());
    }
    result.cpu_setup_us.emplace_back("light matrix", median(set_up_us));

    standing_view view = s.prepare(how, request);
    map_resources& maps = view.maps;
    light_maps& chosen = view.chosen;
    time_frames(
        s.gpu, request.repeat, [&] { s.draw(how, request, view, false); }, result);
    if (how.fitted) {
        result.cpu_setup_us.emplace_back("fit", median(s.fit_us));
    }
    gl::check("shadow methods");

    result.shadowed = s.gpu.shadowed();
    if (request.bias) {
        result.biases = s.biased.measure(maps, chosen, how.warp, *request.bias);
    }
    if (request.filter.kind != shadow_filter::none && !how.omni.hemispheres) {
        result.light = s.biased.light(maps, chosen, how.warp, request.bias.value_or(bias_choice{}),
                                      request.filter, s.seen,
                                      camera_frustum(s.gpu.world(), request.camera, s.gpu.view()));
    }
    result.bytes = maps.bytes();
    if (how.warp) {
        result.bytes += how.omni.hemispheres ? s.omni.raster().list_bytes() : s.warped.list_bytes();
    }
    result.maps = used_maps(chosen);
    result.angle = chosen.angle;
    result.triangles = s.gpu.world().triangles.size() * static_cast<std::size_t>(result.maps);
    if (how.warp) {
        result.triangles = 0;
        for (const triangle_counts& each : s.counted(how)) {
            result.triangles += each.vertex_count / 3;
        }
    }
    if (!drawn_one_by_one(how)) {
        result.triangles = s.omni.triangles();
        result.bytes += s.omni.bytes();
        if (how.omni.cull_objects) {
            result.cpu_setup_us.emplace_back("objects to maps", median(s.culling_us));
        }
        if (how.omni.hemispheres) {
            result.cpu_setup_us.emplace_back("cut triangles, once per light",
                                             1e3 * s.omni.cutting_ms());
        }
    }
    if (how.warp && !how.omni.hemispheres) {
        result.weakened = s.weakened;
        result.mean_side = static_cast<double>(s.warped.mean_side());
    }
    result.status = s.guards(how, chosen, maps);
    std::vector<glm::vec4> extents; // before the pictures, which draw with a map of everything
    if (!how.omni.hemispheres) {
        extents = s.metric.measure(
            maps, chosen, how.warp,
            camera_matrix(camera_frustum(s.gpu.world(), request.camera, s.gpu.view())));
        result.texels = metric_of(extents, maps.size, s.gpu.view());
        result.texels->finest = finest_of(maps, chosen, request.tables.over(how.tables));
    }
    result.pictures = s.pictures(how, request, chosen, maps);
    if (result.texels) {
        result.pictures.push_back(heat_map(extents, s.gpu.view()));
    }
    return result;
}

std::vector<double> renderer::more_frames(std::string_view name, const view_request& request) {
    state& s = *state_;
    if (!has_maps(name)) {
        const auto frame = [&] { s.volumes.frame(s.seen, request.camera, request.light); };
        frame(); // warms up
        return time_frames(s.gpu, request.repeat, frame);
    }
    const method& how = find_method(name);
    standing_view view = s.prepare(how, request);
    return time_frames(s.gpu, request.repeat, [&] { s.draw(how, request, view, false); });
}

moving_frame renderer::next_frame(std::string_view name, const view_request& request,
                                  method_memory& memory) {
    state& s = *state_;
    if (!has_maps(name)) {
        return s.volumes.next_frame(s.seen, request, s.before);
    }
    const method& how = find_method(name);
    const std::string key = std::string(name) + " " + std::to_string(request.map_size);
    auto found = s.moving.find(key);
    if (found == s.moving.end()) {
        light_memory unused;
        const light_maps first = s.choose_maps(how, request, unused);
        moving_resources fresh{resources(how, request, count_of_maps(how, first)), {}};
        found = s.moving.emplace(key, std::move(fresh)).first;
        light_memory copy = memory.light;
        s.frame(how, request, copy, found->second.maps, found->second.shadows, false); // warms up
    }
    map_resources& maps = found->second.maps;
    shadow_memory& shadows = found->second.shadows;
    const light_memory before = memory.light;
    moving_frame result{};
    light_maps chosen;
    do {
        memory.light = before;
        s.forget_counts();
        s.gpu.watch().start();
        chosen = s.frame(how, request, memory.light, maps, shadows, true);
        result.frame_ms = s.gpu.watch().stop();
    } while (s.grow_lists(how));
    result.shadowed = s.gpu.shadowed();
    result.maps = used_maps(chosen);
    result.angle = chosen.angle;
    light_memory copy = before; // the same frame once more, pass by pass
    result.shadow_map_ms = time_shadow_passes(s.gpu, [&] {
        s.frame(how, request, copy, maps, shadows, false);
        s.remember(how, request, shadows);
    });
    if (s.before) {
        s.gpu.use(s.seen_before);
        s.test(how, request.light, maps, chosen);
        result.shadowed_before = s.gpu.shadowed();
    }
    return result;
}

void renderer::remember_view(const std::optional<camera_view>& camera) {
    state& s = *state_;
    s.before = camera;
    if (!camera) {
        s.moving.clear(); // another light may have another number of maps
    } else {
        s.gpu.draw_view(s.seen_before,
                        camera_matrix(camera_frustum(s.gpu.world(), *camera, s.gpu.view())),
                        glm::vec3(camera->eye));
    }
}

} // namespace lab
