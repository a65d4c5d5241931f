#include "lab/methods.hpp"

#include "lab/frame_times.hpp"
#include "lab/light_picture.hpp"
#include "lab/method_frames.hpp"
#include "lab/method_table.hpp"
#include "lab/statistics.hpp"
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

/// What a method keeps on the device while a camera moves.
struct moving_resources {
    map_resources maps;
    shadow_memory shadows;
};

int used_maps(const light_maps& chosen) {
    return static_cast<int>(std::count_if(chosen.maps.begin(), chosen.maps.end(),
                                          [](const light_map& each) { return each.used; }));
}

} // namespace

std::size_t bytes_of(const standing_view& view) {
    return view.maps.bytes();
}

struct renderer::state : method_frames {
    state(const scene& world, glm::ivec2 view) : method_frames(world, view), seen_before(view) {}

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
                for (named_picture& each : warp_pictures(
                         {maps.size, warp.counts.width(), warp.rows.height(), nodes_of(warp.rows),
                          nodes_of(warp.columns), warp.first_counts, warp.second_counts})) {
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

    g_buffer seen_before;
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

method_result renderer::run(std::string_view name, const view_request& request,
                            std::shared_ptr<standing_view>* kept) {
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

    const auto held = std::make_shared<standing_view>(s.prepare(how, request));
    standing_view& view = *held;
    map_resources& maps = view.maps;
    light_maps& chosen = view.chosen;
    time_frames(
        s.gpu, request.repeat, [&] { s.draw(how, request, view, false); }, result, request.details);
    if (how.fitted) {
        result.cpu_setup_us.emplace_back("fit", median(s.fit_us));
    }
    gl::check("shadow methods");

    result.shadowed = s.gpu.shadowed();
    if (request.bias) {
        result.biases = s.biased.measure(maps, chosen, how.warp, *request.bias);
    }
    if (request.filter.kind != shadow_filter::none && !how.omni.hemispheres) {
        result.light = s.biased.light();
    }
    result.bytes = maps.bytes();
    if (how.warp) {
        result.bytes += how.omni.hemispheres ? s.omni.raster().list_bytes() : s.warped.list_bytes();
        result.bytes += s.warps.light_image_bytes(request.tables.over(how.tables));
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
    if (request.keep_depth) {
        result.depth = maps.depth.read<float>();
    }
    std::vector<glm::vec4> extents; // before the pictures, which draw with a map of everything
    if (!how.omni.hemispheres) {
        extents = s.metric.measure(
            maps, chosen, how.warp,
            camera_matrix(camera_frustum(s.gpu.world(), request.camera, s.gpu.view())));
        result.texels = metric_of(extents, maps.size, s.gpu.view());
        result.texels->finest = finest_of(maps, chosen, request.tables.over(how.tables));
    }
    if (request.details) {
        result.pictures = s.pictures(how, request, chosen, maps);
        if (result.texels) {
            result.pictures.push_back(heat_map(extents, s.gpu.view()));
        }
    }
    if (kept != nullptr) {
        *kept = held;
    }
    return result;
}

std::vector<double> renderer::more_frames(std::string_view name, const view_request& request,
                                          standing_view* kept) {
    state& s = *state_;
    if (!has_maps(name)) {
        const auto frame = [&] { s.volumes.frame(s.seen, request.camera, request.light); };
        frame(); // warms up
        return time_frames(s.gpu, request.repeat, frame);
    }
    const method& how = find_method(name);
    std::optional<standing_view> fresh;
    if (kept == nullptr) {
        kept = &fresh.emplace(s.prepare(how, request));
    }
    return time_frames(s.gpu, request.repeat, [&] { s.draw(how, request, *kept, false); });
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
        moving_resources fresh{resources_for(how, request, count_of_maps(how, first)), {}};
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
