#include "lab/methods.hpp"

#include "gl/mesh.hpp"
#include "gl/objects.hpp"
#include "gl/timer.hpp"
#include "lab/shaders.hpp"
#include "lab/warp_pictures.hpp"

#include <warpshadow/fit.hpp>
#include <warpshadow/smoothing.hpp>
#include <warpshadow/warp_build.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>

namespace lab {

namespace ws = warpshadow;

namespace {

constexpr std::array<std::string_view, 5> names{"sm", "dv", "notw", "notw-nodv", "raytraced"};

/// When the shadow pass cuts an edge: always above this share of the map (the finest of Rosen
/// 2012), never below so many texels, and in between when the warp bends it by more than the last.
constexpr double always_cut_share = 0.01;
constexpr double never_cut_texels = 0.5;
constexpr double bend_texels = 1.0;

/// Mirror of `light_buffer` in shaders/light.glsl.
struct light_block {
    glm::mat4 full{1.0f};
    glm::mat4 matrix{1.0f};
    glm::mat4 normal{1.0f};
    glm::vec4 position{0.0f};
    glm::vec4 axis{0.0f};
    glm::vec4 rect{0.0f, 0.0f, 1.0f, 1.0f};
};

/// Mirror of `triangle_counts` in shaders/triangles.glsl.
struct triangle_counts {
    std::uint32_t vertex_count = 0;
    std::uint32_t instance_count = 1;
    std::uint32_t first_vertex = 0;
    std::uint32_t base_instance = 0;
    std::array<std::uint32_t, 2> waiting{};
    std::uint32_t lost = 0;
    std::uint32_t crowded = 0;
    std::uint32_t uncut = 0;
    std::uint32_t padding = 0;
};
constexpr std::size_t map_triangle_bytes = 48;

/// Texture units and buffer bindings that several shaders share.
enum unit : GLuint {
    unit_position = 0,
    unit_normal = 1,
    unit_rows = 2,
    unit_columns = 3,
    unit_centres = 4,
    unit_map = 5
};
enum binding : GLuint {
    on_light = 4,
    on_desired_view = 5,
    on_counts = 6,
    on_ready = 7,
    on_waiting = 8,
    on_next = 9
};

/// Which of the steps before the shadow pass a method takes.
struct method_steps {
    bool desired_view;
    bool warp;
};

method_steps steps_of(std::string_view method) {
    if (method == "sm") {
        return {false, false};
    }
    if (method == "dv") {
        return {true, false};
    }
    if (method == "notw") {
        return {true, true};
    }
    if (method == "notw-nodv") {
        return {false, true};
    }
    throw bad_input("no such method: " + std::string(method));
}

double farthest_along(const ws::box3<double>& box, glm::dvec3 from, glm::dvec3 axis) {
    double farthest = 0.0;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1) != 0 ? box.hi.x : box.lo.x,
                                (i & 2) != 0 ? box.hi.y : box.lo.y,
                                (i & 4) != 0 ? box.hi.z : box.lo.z);
        farthest = std::max(farthest, glm::dot(corner - from, axis));
    }
    return farthest;
}

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

light_block make_light_block(const scene& world, const light_view& view) {
    const ws::light<double>& light = view.light;
    light_block block;
    ws::light_matrix_result<double> built;
    if (light.kind == ws::light_kind::directional) {
        built = ws::directional_light_matrix(light, world.box, ws::clip::opengl);
        block.position = glm::vec4(glm::vec3(-glm::normalize(light.direction)), 0.0f);
        block.axis = glm::vec4(0.0f, 0.0f, 0.0f, -2.0f);
    } else {
        const glm::dvec3 axis = glm::normalize(light.direction);
        const double far_distance = farthest_along(world.box, light.position, axis);
        built =
            ws::spot_light_matrix(light, far_distance * 0x1p-10, far_distance, ws::clip::opengl);
        block.position = glm::vec4(glm::vec3(light.position), 1.0f);
        block.axis =
            glm::vec4(glm::vec3(axis), static_cast<float>(std::cos(0.5 * light.cone_angle)));
    }
    if (ws::any(built.flags, ws::status::invalid_input | ws::status::out_of_range)) {
        throw bad_input("the light " + view.label + " does not reach the scene " + world.name);
    }
    block.full = glm::mat4(built.matrix);
    block.matrix = block.full;
    block.normal = glm::mat4(glm::transpose(glm::inverse(built.matrix)));
    return block;
}

glm::mat4 make_camera_matrix(const scene& world, const camera_view& camera, glm::ivec2 view) {
    const double aspect = static_cast<double>(view.x) / view.y;
    const double far_distance =
        1.01 *
        std::max(farthest_along(world.box, camera.eye, glm::normalize(camera.target - camera.eye)),
                 1e-3);
    const ws::view_volume<double> volume =
        ws::perspective_volume(camera.fov_y, aspect, far_distance * 0x1p-13, far_distance);
    const ws::frustum<double> frustum =
        ws::make_frustum(camera.eye, camera.target - camera.eye, glm::dvec3(0.0, 1.0, 0.0), volume)
            .value;
    return glm::mat4(ws::projection_matrix(volume, ws::clip::opengl) *
                     ws::view_matrix(frustum, ws::clip::opengl));
}

double median(std::vector<double> values) {
    if (values.empty()) {
        return 0.0;
    }
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

void wait_for_writes() {
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

} // namespace

std::span<const std::string_view> method_names() {
    return names;
}

struct renderer::state {
    /// Textures and lists whose size follows the shadow map.
    struct map_resources {
        explicit map_resources(int size)
            : depth(GL_DEPTH_COMPONENT32F, size, size), target({}, &depth),
              counts(GL_R32UI, size, size), rows(GL_R32F, size + 1, size),
              columns(GL_R32F, size + 1, size), centres(GL_RG32F, size, size) {}
        gl::texture depth;
        gl::framebuffer target;
        gl::texture counts, rows, columns, centres;
    };

    state(const scene& scene_to_show, glm::ivec2 view_size)
        : world(scene_to_show), view(view_size), library{gl::glsl_files(), lab_shaders()},
          mesh(world.positions, world.triangles),
          normals(std::span<const glm::vec4>(face_normals())),
          g_position(GL_RGBA32F, view.x, view.y), g_normal(GL_RGBA32F, view.x, view.y),
          g_depth(GL_DEPTH_COMPONENT32F, view.x, view.y),
          g_target({&g_position, &g_normal}, &g_depth), mask(GL_R8UI, view.x, view.y),
          light_buffer(sizeof(light_block), nullptr, GL_DYNAMIC_DRAW),
          desired(4 * sizeof(std::uint32_t), nullptr, GL_DYNAMIC_DRAW),
          counters(sizeof(triangle_counts), nullptr, GL_DYNAMIC_DRAW), watch(gl::best_timing()) {
        draw_g_buffer = link("g_buffer.vert", "g_buffer.frag");
        draw_plain = link("shadow_plain.vert", "empty.frag");
        draw_warped = link("shadow_warped.vert", "shadow_warped.frag");
        find_desired_view = compute("desired_view.comp");
        crop = compute("crop.comp");
        splat_rows = compute("splat_rows.comp");
        splat_columns = compute("splat_columns.comp");
        sum_columns = compute("column_sums.comp");
        build_axis = compute("build_axis.comp");
        unwarp_centres = compute("unwarp_centres.comp");
        set_up_triangles = compute("triangle_setup.comp");
        cut_triangles = compute("triangle_cut.comp");
        test_plain = compute("shadow_test.comp");
        test_warped = compute("shadow_test.comp", {"WARPED"});
        for (const gl::program* program :
             {&find_desired_view, &splat_rows, &splat_columns, &test_plain, &test_warped}) {
            program->set("g_position", static_cast<int>(unit_position));
            program->set("g_normal", static_cast<int>(unit_normal));
            program->set("shadow_map", static_cast<int>(unit_map));
        }
        set_capacity(2 * world.triangles.size() + 65536, 65536);
    }

    std::vector<glm::vec4> face_normals() const {
        std::vector<glm::vec4> result;
        result.reserve(world.triangles.size());
        for (const glm::uvec3& t : world.triangles) {
            const glm::dvec3 a(world.positions[t.x]);
            const glm::dvec3 n = glm::cross(glm::dvec3(world.positions[t.y]) - a,
                                            glm::dvec3(world.positions[t.z]) - a);
            const double length = glm::length(n);
            // a triangle without area is never drawn; any direction will do
            result.emplace_back(length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f, 1.0f, 0.0f),
                                0.0f);
        }
        return result;
    }

    gl::program link(const char* vertex, const char* fragment) const {
        return gl::program({{GL_VERTEX_SHADER, library.load(std::string("lab/") + vertex)},
                            {GL_FRAGMENT_SHADER, library.load(std::string("lab/") + fragment)}});
    }

    gl::program compute(const char* file, std::vector<std::string> defines = {}) const {
        return gl::program::compute(library.load(std::string("lab/") + file, defines));
    }

    void set_capacity(std::size_t ready_count, std::size_t waiting_count) {
        ready = gl::buffer(ready_count * map_triangle_bytes, nullptr, GL_DYNAMIC_COPY);
        for (gl::buffer& list : waiting) {
            list = gl::buffer(waiting_count * map_triangle_bytes, nullptr, GL_DYNAMIC_COPY);
        }
    }

    /// Runs one step, timed if the frame asks for it.
    template <typename Step> void pass(const char* name, Step step) {
        if (pass_times == nullptr) {
            step();
            return;
        }
        watch.start();
        step();
        (*pass_times)[name].push_back(watch.stop());
        if (std::find(pass_order.begin(), pass_order.end(), name) == pass_order.end()) {
            pass_order.emplace_back(name);
        }
    }

    void draw_view(const glm::mat4& camera, glm::vec3 eye) {
        g_target.bind();
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glDisable(GL_CULL_FACE);
        glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
        glClearDepth(1.0);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        draw_g_buffer.use();
        draw_g_buffer.set("camera", camera);
        draw_g_buffer.set("eye", eye);
        normals.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        mesh.draw();
    }

    void bind_view_samples() {
        g_position.bind(unit_position);
        g_normal.bind(unit_normal);
        light_buffer.bind_base(GL_SHADER_STORAGE_BUFFER, on_light);
    }

    void focus_on_desired_view(int map_size) {
        const std::uint32_t infinity =
            std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
        const std::array<std::uint32_t, 4> empty{infinity, infinity, 0u, 0u};
        desired.write(0, sizeof empty, empty.data());
        desired.bind_base(GL_SHADER_STORAGE_BUFFER, on_desired_view);
        find_desired_view.dispatch((view.x + 3) / 4, (view.y + 3) / 4);
        wait_for_writes();
        crop.set("margin", 0.5f / static_cast<float>(std::max(map_size - 1, 1)));
        crop.dispatch(1);
        wait_for_writes();
    }

    /// Importance to functions of one axis.
    void build(map_resources& map, const gl::program& splat, const gl::texture& table,
               const char* splat_name, const char* build_name) {
        pass(splat_name, [&] {
            map.counts.clear(glm::uvec4(0u));
            map.counts.bind_image(0, GL_READ_WRITE);
            splat.dispatch(view.x, view.y);
            wait_for_writes();
        });
        if (keep_counts) {
            (&table == &map.rows ? first_counts : second_counts) = map.counts.read<std::uint32_t>();
        }
        pass(build_name, [&] {
            const int size = map.counts.width();
            map.counts.bind_image(0, GL_READ_WRITE);
            sum_columns.dispatch(size);
            wait_for_writes();
            table.bind_image(1, GL_WRITE_ONLY);
            const ws::build_options<float> options;
            build_axis.set("ws_radius", ws::window_radius(options.window, size));
            // the device computes nodes in float: four times the floor that rounding once needs
            build_axis.set("ws_floor",
                           std::max(options.floor, 4.0f * ws::smallest_floor<float, float>(size)));
            build_axis.use();
            glDispatchCompute(static_cast<GLuint>(size), 1, 1);
            wait_for_writes();
        });
    }

    void build_tables(map_resources& map) {
        build(map, splat_rows, map.rows, "splat rows", "build rows");
        map.rows.bind(unit_rows);
        build(map, splat_columns, map.columns, "splat columns", "build columns");
        map.columns.bind(unit_columns);
        pass("unwarp centres", [&] {
            map.centres.bind_image(0, GL_WRITE_ONLY);
            unwarp_centres.dispatch(map.centres.width(), map.centres.height());
            wait_for_writes();
            map.centres.bind(unit_centres);
        });
    }

    void draw_plain_map(map_resources& map) {
        map.target.bind();
        glClear(GL_DEPTH_BUFFER_BIT);
        draw_plain.use();
        mesh.draw();
    }

    void draw_warped_map(map_resources& map) {
        const double size = map.depth.width();
        const double shortest = never_cut_texels / size;
        for (const gl::program* program : {&set_up_triangles, &cut_triangles}) {
            program->set("longest", static_cast<float>(always_cut_share));
            program->set("shortest", static_cast<float>(shortest));
            program->set("deviation", static_cast<float>(bend_texels / size));
        }
        pass("cut triangles", [&] {
            const triangle_counts none;
            counters.write(0, sizeof none, &none);
            mesh.positions().bind_base(GL_SHADER_STORAGE_BUFFER, 0);
            mesh.indices().bind_base(GL_SHADER_STORAGE_BUFFER, 1);
            normals.bind_base(GL_SHADER_STORAGE_BUFFER, 2);
            counters.bind_base(GL_SHADER_STORAGE_BUFFER, on_counts);
            ready.bind_base(GL_SHADER_STORAGE_BUFFER, on_ready);
            waiting[0].bind_base(GL_SHADER_STORAGE_BUFFER, on_waiting);
            const int triangles = static_cast<int>(world.triangles.size());
            set_up_triangles.set("triangle_count", triangles);
            set_up_triangles.dispatch(triangles);
            wait_for_writes();
            // three halvings, one of each edge, make a triangle half as large; no edge is longer
            // than the map's diagonal at first
            const int rounds =
                3 * static_cast<int>(std::ceil(std::log2(std::sqrt(2.0) / shortest))) + 1;
            for (int round = 0; round < rounds; ++round) {
                const std::size_t source = static_cast<std::size_t>(round % 2);
                const std::uint32_t zero = 0;
                counters.write(offsetof(triangle_counts, waiting) + (1 - source) * sizeof zero,
                               sizeof zero, &zero);
                waiting[source].bind_base(GL_SHADER_STORAGE_BUFFER, on_waiting);
                waiting[1 - source].bind_base(GL_SHADER_STORAGE_BUFFER, on_next);
                cut_triangles.set("list", static_cast<int>(source));
                cut_triangles.set("last_round", static_cast<int>(round + 1 == rounds));
                cut_triangles.dispatch(64 * 64);
                wait_for_writes();
            }
        });
        pass("shadow map", [&] {
            map.target.bind();
            glClear(GL_DEPTH_BUFFER_BIT);
            draw_warped.use();
            ready.bind_base(GL_SHADER_STORAGE_BUFFER, on_ready);
            nothing.bind();
            counters.bind(GL_DRAW_INDIRECT_BUFFER);
            glDrawArraysIndirect(GL_TRIANGLES, nullptr);
            wait_for_writes();
        });
    }

    void test_shadows(map_resources& map, bool warped) {
        map.depth.bind(unit_map);
        mask.bind_image(0, GL_WRITE_ONLY);
        (warped ? test_warped : test_plain).dispatch(view.x, view.y);
        wait_for_writes();
    }

    void frame(const method_steps& steps, const view_request& request, const light_block& light,
               const glm::mat4& camera, map_resources& map) {
        pass("g-buffer", [&] { draw_view(camera, glm::vec3(request.camera.eye)); });
        light_buffer.write(0, sizeof light, &light);
        bind_view_samples();
        if (steps.desired_view) {
            pass("desired view", [&] { focus_on_desired_view(request.map_size); });
        }
        if (steps.warp) {
            build_tables(map);
            draw_warped_map(map);
        } else {
            pass("shadow map", [&] { draw_plain_map(map); });
        }
        pass("shadow test", [&] { test_shadows(map, steps.warp); });
    }

    [[nodiscard]] std::vector<std::string> guards(const method_steps& steps) const {
        std::vector<std::string> result;
        if (steps.desired_view) {
            const std::vector<std::uint32_t> bits = desired.read<std::uint32_t>();
            if (bits[0] > bits[2]) {
                result.emplace_back(ws::status_name(ws::status::empty_importance));
            }
        }
        if (steps.warp) {
            const triangle_counts counted = counters.read<triangle_counts>().front();
            if (counted.lost > 0) {
                result.emplace_back(ws::status_name(ws::status::capacity_reached));
            }
            if (counted.uncut > 0) {
                result.emplace_back(ws::status_name(ws::status::bound_missed));
            }
        }
        return result;
    }

    /// Makes the triangle lists large enough for what the last frame needed; false if they were.
    bool grow_lists() {
        const triangle_counts counted = counters.read<triangle_counts>().front();
        const std::size_t ready_count = ready.bytes() / map_triangle_bytes;
        const std::size_t waiting_count = waiting[0].bytes() / map_triangle_bytes;
        if ((counted.lost == 0 && counted.crowded == 0) || ready_count > most_triangles ||
            waiting_count > most_triangles) {
            return false;
        }
        set_capacity(counted.lost > 0 ? 2 * ready_count : ready_count,
                     counted.crowded > 0 ? 2 * waiting_count : waiting_count);
        return true;
    }

    static constexpr std::size_t most_triangles = std::size_t{1} << 22;

    const scene& world;
    glm::ivec2 view;
    gl::shader_library library;
    gl::mesh mesh;
    gl::buffer normals;
    gl::texture g_position, g_normal, g_depth;
    gl::framebuffer g_target;
    gl::texture mask;
    gl::buffer light_buffer, desired, counters;
    gl::buffer ready;
    std::array<gl::buffer, 2> waiting;
    gl::vertex_array nothing;
    gl::program draw_g_buffer, draw_plain, draw_warped;
    gl::program find_desired_view, crop, splat_rows, splat_columns, sum_columns, build_axis,
        unwarp_centres;
    gl::program set_up_triangles, cut_triangles, test_plain, test_warped;
    gl::stopwatch watch;
    std::map<std::string, std::vector<double>>* pass_times = nullptr;
    std::vector<std::string> pass_order;
    bool keep_counts = false;
    std::vector<std::uint32_t> first_counts, second_counts;
};

renderer::renderer(const scene& world, glm::ivec2 view)
    : state_(std::make_unique<state>(world, view)) {}

renderer::~renderer() = default;

g_buffer_samples renderer::samples(const camera_view& camera, const light_view& light) {
    state& s = *state_;
    const glm::mat4 matrix = make_camera_matrix(s.world, camera, s.view);
    s.draw_view(matrix, glm::vec3(camera.eye)); // warms up
    s.watch.start();
    s.draw_view(matrix, glm::vec3(camera.eye));
    g_buffer_samples result;
    result.draw_ms = s.watch.stop();
    result.size = s.view;
    result.position = s.g_position.read<glm::vec4>();
    for (const glm::vec4& n : s.g_normal.read<glm::vec4>()) {
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

std::optional<std::string> renderer::why_not(std::string_view method,
                                             const light_view& light) const {
    if (method != "raytraced" && light.light.kind == ws::light_kind::point) {
        return "a point light shines all around and has no single map";
    }
    return std::nullopt;
}

method_result renderer::run(std::string_view method, const view_request& request) {
    state& s = *state_;
    const method_steps steps = steps_of(method);
    method_result result;

    const auto begin = std::chrono::steady_clock::now();
    const light_block light = make_light_block(s.world, request.light);
    const std::chrono::duration<double, std::micro> set_up =
        std::chrono::steady_clock::now() - begin;
    result.cpu_setup_us.emplace_back("light matrix", set_up.count());

    const glm::mat4 camera = make_camera_matrix(s.world, request.camera, s.view);
    state::map_resources map(request.map_size);
    const auto frame = [&] { s.frame(steps, request, light, camera, map); };

    // the first frame warms up and, with tables, finds how long the lists must be
    s.keep_counts = steps.warp;
    do {
        frame();
    } while (steps.warp && s.grow_lists());
    s.keep_counts = false;
    glFinish();

    std::vector<double> frames;
    for (int i = 0; i < request.repeat; ++i) {
        s.watch.start();
        frame();
        frames.push_back(s.watch.stop());
    }
    std::map<std::string, std::vector<double>> times;
    s.pass_times = &times;
    s.pass_order.clear();
    for (int i = 0; i < std::min(request.repeat, 3); ++i) {
        frame();
    }
    s.pass_times = nullptr;
    gl::check("shadow methods");

    result.frame_ms_median = median(frames);
    result.frame_ms_min = frames.empty() ? 0.0 : *std::min_element(frames.begin(), frames.end());
    result.frame_ms_max = frames.empty() ? 0.0 : *std::max_element(frames.begin(), frames.end());
    result.frames = static_cast<int>(frames.size());
    for (const std::string& name : s.pass_order) {
        result.passes.push_back({name, median(times[name])});
    }
    result.shadowed = s.mask.read<std::uint8_t>();
    result.bytes = map.depth.bytes();
    result.triangles = s.world.triangles.size();
    result.status = s.guards(steps);
    if (steps.warp) {
        result.bytes += map.counts.bytes() + map.rows.bytes() + map.columns.bytes() +
                        map.centres.bytes() + s.ready.bytes() + s.waiting[0].bytes() +
                        s.waiting[1].bytes();
        result.triangles = s.counters.read<triangle_counts>().front().vertex_count / 3;
        const warp_readback tables{request.map_size, map.rows.read<float>(),
                                   map.columns.read<float>(), s.first_counts, s.second_counts};
        result.pictures = warp_pictures(tables);
    }
    result.pictures.push_back(depth_picture(map.depth.read<float>(), request.map_size));
    return result;
}

} // namespace lab
