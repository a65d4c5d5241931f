#include "lab/passes.hpp"

#include "lab/shaders.hpp"

#include <warpshadow/warp.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lab {

namespace ws = warpshadow;

namespace {

/// Mirror of `light_buffer` in shaders/light.glsl.
struct light_block {
    glm::vec4 position{0.0f};
    glm::vec4 axis{0.0f};
    glm::ivec4 choice{0};
    glm::vec4 depth_plane{0.0f};
    std::array<float, 8> splits{};
};

/// Mirror of `light_map` in shaders/light.glsl.
struct map_block {
    glm::mat4 full{1.0f};
    glm::mat4 matrix{1.0f};
    glm::mat4 normal{1.0f};
};

constexpr std::size_t most_maps = 8;

/// WS_CENTRES_STRIP of passes/unwarp_centres.glsl.
constexpr int centres_strip = 16;

/// Texture units and buffer bindings that several shaders share.
enum unit : GLuint {
    unit_position = 0,
    unit_normal = 1,
    unit_rows = 2,
    unit_columns = 3,
    unit_centres = 4,
    unit_map = 5,
    unit_positions = 6,
    unit_indices = 7,
    unit_face_normals = 8
};
enum binding : GLuint { on_light = 4, on_desired_view = 5 };

/// Sets bounds of view samples to those of no sample.
void clear_bounds(gl::buffer& bounds) {
    const std::uint32_t infinity =
        std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
    const std::array<std::uint32_t, 4> empty{infinity, infinity, 0u, 0u};
    bounds.write(0, sizeof empty, empty.data());
}

} // namespace

g_buffer::g_buffer(glm::ivec2 view)
    : position(GL_RGBA32F, view.x, view.y), normal(GL_RGBA32F, view.x, view.y),
      depth(GL_DEPTH_COMPONENT32F, view.x, view.y), target({&position, &normal}, &depth) {}

GLenum internal_format(table_format format) {
    return format == table_format::unorm16 ? GL_R16 : GL_R32F;
}

std::string image_format(table_format format) {
    return format == table_format::unorm16 ? "r16" : "r32f";
}

std::vector<float> nodes_of(const gl::texture& table) {
    if (table.format() == GL_R32F) {
        return table.read<float>();
    }
    std::vector<float> nodes;
    for (const std::uint16_t node : table.read<std::uint16_t>()) {
        nodes.push_back(ws::detail::node_value<float>(node));
    }
    return nodes;
}

map_resources::tables::tables(int size, int cells, int functions, table_format format)
    : counts(GL_R32UI, cells, cells), rows(internal_format(format), cells + 1, functions),
      columns(internal_format(format), cells + 1, functions), centres(GL_RG32F, size, size) {}

map_resources::map_resources(int map_size, std::size_t maps, int cells, int functions,
                             table_format format)
    : size(map_size), depth(GL_DEPTH_COMPONENT32F, map_size, map_size, static_cast<int>(maps)) {
    all_layers = gl::framebuffer::of_layers(depth);
    for (std::size_t i = 0; i < maps; ++i) {
        targets.push_back(gl::framebuffer::of_layer(depth, static_cast<int>(i)));
        desired.emplace_back(4 * sizeof(std::uint32_t), nullptr, GL_DYNAMIC_DRAW);
        if (cells > 0) {
            warps.emplace_back(size, cells, functions, format);
        }
    }
}

std::size_t map_resources::bytes() const {
    std::size_t sum = depth.bytes();
    for (const tables& each : warps) {
        for (const gl::texture* part :
             {&each.counts, &each.rows, &each.columns, &each.centres, &each.classes, &each.lines,
              &each.boxes[0], &each.boxes[1], &each.common}) {
            sum += part->id() != 0 ? part->bytes() : 0;
        }
    }
    return sum;
}

passes::passes(const scene& scene_to_show, glm::ivec2 view_size)
    : world_(scene_to_show), view_(view_size), library_{gl::glsl_files(), lab_shaders()},
      mesh_(world_.positions, world_.triangles),
      normals_(std::span<const glm::vec4>(face_normals())),
      positions_view_(mesh_.positions(), GL_RGB32F), indices_view_(mesh_.indices(), GL_RGB32UI),
      normals_view_(normals_, GL_RGBA32F), mask_(GL_R8UI, view_.x, view_.y),
      light_buffer_(sizeof(light_block) + most_maps * sizeof(map_block), nullptr, GL_DYNAMIC_DRAW),
      depths_(4 * sizeof(std::uint32_t), nullptr, GL_DYNAMIC_DRAW), watch_(gl::best_timing()) {
    draw_g_buffer_ = link("g_buffer.vert", "g_buffer.frag");
    draw_plain_ = link("shadow_plain.vert", "empty.frag");
    find_desired_view_ = compute("desired_view.comp");
    find_depth_range_ = compute("depth_range.comp");
    crop_ = compute("crop.comp");
    unwarp_centres_ = compute("unwarp_centres.comp");
    count_histogram_ = compute("histogram.comp", {"WS_SPLAT_MERGED"});
    test_plain_ = compute("shadow_test.comp");
    test_warped_ = compute("shadow_test.comp", {"WARPED"});
    for (const gl::program* program : {&find_desired_view_, &find_depth_range_, &count_histogram_,
                                       &test_plain_, &test_warped_}) {
        set_units(*program);
    }
}

void passes::set_units(const gl::program& program) {
    program.set("g_position", static_cast<int>(unit_position));
    program.set("g_normal", static_cast<int>(unit_normal));
    program.set("shadow_map", static_cast<int>(unit_map));
}

void passes::bind_triangles() const {
    positions_view_.bind(unit_positions);
    indices_view_.bind(unit_indices);
    normals_view_.bind(unit_face_normals);
}

void passes::bind_depth(const map_resources& maps) {
    maps.depth.bind(unit_map);
}

void passes::bind_tables(const map_resources& maps, std::size_t index) {
    maps.warps[index].rows.bind(unit_rows);
    maps.warps[index].columns.bind(unit_columns);
    maps.warps[index].centres.bind(unit_centres);
}

std::vector<glm::vec4> passes::face_normals() const {
    std::vector<glm::vec4> result;
    result.reserve(world_.triangles.size());
    for (const glm::uvec3& t : world_.triangles) {
        const glm::dvec3 a(world_.positions[t.x]);
        const glm::dvec3 n = glm::cross(glm::dvec3(world_.positions[t.y]) - a,
                                        glm::dvec3(world_.positions[t.z]) - a);
        const double length = glm::length(n);
        // a triangle without area is never drawn; any direction will do
        result.emplace_back(length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f, 1.0f, 0.0f),
                            0.0f);
    }
    return result;
}

gl::program passes::link(const char* vertex, const char* fragment,
                         const std::vector<std::string>& defines) const {
    return gl::program(
        {{GL_VERTEX_SHADER, library_.load(std::string("lab/") + vertex, defines)},
         {GL_FRAGMENT_SHADER, library_.load(std::string("lab/") + fragment, defines)}});
}

gl::program passes::compute(const char* file, const std::vector<std::string>& defines) const {
    return gl::program::compute(library_.load(std::string("lab/") + file, defines));
}

void passes::time_into(std::map<std::string, std::vector<double>>* times) {
    begin_frame();
    times_ = times;
    if (times != nullptr) {
        order_.clear();
    }
}

void passes::begin_frame() {
    for (const auto& [name, ms] : frame_times_) {
        (*times_)[name].push_back(ms);
    }
    frame_times_.clear();
}

void passes::note(const char* name, double ms) {
    frame_times_[name] += ms;
    if (std::find(order_.begin(), order_.end(), name) == order_.end()) {
        order_.emplace_back(name);
    }
}

void passes::draw_view(g_buffer& seen, const glm::mat4& camera, glm::vec3 eye) {
    seen.target.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDisable(GL_CULL_FACE);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClearDepth(1.0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw_g_buffer_.use();
    draw_g_buffer_.set("camera", camera);
    draw_g_buffer_.set("eye", eye);
    normals_.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    mesh_.draw();
}

void passes::use(const g_buffer& seen) {
    seen.position.bind(unit_position);
    seen.normal.bind(unit_normal);
}

void passes::use(const g_buffer& seen, const light_maps& maps, const ws::light<double>& light) {
    use(seen);
    at_ = maps.at;
    light_block block;
    if (light.kind == ws::light_kind::directional) {
        block.position = glm::vec4(glm::vec3(-glm::normalize(light.direction)), 0.0f);
        block.axis = glm::vec4(0.0f, 0.0f, 0.0f, -2.0f);
    } else {
        block.position = glm::vec4(glm::vec3(light.position), 1.0f);
        block.axis = light.kind == ws::light_kind::spot
                         ? glm::vec4(glm::vec3(glm::normalize(light.direction)),
                                     static_cast<float>(std::cos(0.5 * light.cone_angle)))
                         : glm::vec4(0.0f, 0.0f, 0.0f, -2.0f);
    }
    block.choice.x = static_cast<int>(maps.choice);
    block.choice.y = static_cast<int>(maps.maps.size());
    block.depth_plane = glm::vec4(maps.depth_plane);
    std::transform(maps.splits.begin(), maps.splits.end(), block.splits.begin(),
                   [](double depth) { return static_cast<float>(depth); });
    light_buffer_.write(0, sizeof block, &block);
    for (std::size_t i = 0; i < maps.maps.size(); ++i) {
        write_map(i, maps.maps[i].matrix);
    }
    light_buffer_.bind_base(GL_SHADER_STORAGE_BUFFER, on_light);
}

void passes::select_map(std::size_t index) {
    for (const gl::program* program :
         {&draw_plain_, &find_desired_view_, &crop_, &count_histogram_, &test_warped_}) {
        program->set("map_index", static_cast<int>(index));
    }
}

void passes::crop_to_desired_view(map_resources& maps, std::size_t index) {
    select_map(index);
    gl::buffer& desired = maps.desired[index];
    clear_bounds(desired);
    desired.bind_base(GL_SHADER_STORAGE_BUFFER, on_desired_view);
    find_desired_view_.dispatch((view_.x + 3) / 4, (view_.y + 3) / 4);
    gl::wait_for_writes();
    crop_.set("margin", 0.5f / static_cast<float>(std::max(maps.size - 1, 1)));
    crop_.dispatch(1);
    gl::wait_for_writes();
}

std::optional<glm::dvec2> passes::depth_range(const ws::frustum<double>& camera) {
    const glm::dvec3 forward = glm::normalize(camera.forward);
    const double far_distance = camera.volume.far_distance;
    clear_bounds(depths_);
    depths_.bind_base(GL_SHADER_STORAGE_BUFFER, on_desired_view);
    find_depth_range_.set(
        "share_of_far",
        glm::vec4(glm::dvec4(forward, -glm::dot(forward, camera.eye)) / far_distance));
    find_depth_range_.dispatch((view_.x + 3) / 4, (view_.y + 3) / 4);
    gl::wait_for_writes();
    const std::vector<float> found = depths_.read<float>();
    if (!(found[0] <= found[2])) {
        return std::nullopt;
    }
    return glm::dvec2(found[0], found[2]) * far_distance;
}

std::vector<std::uint32_t> passes::histogram(std::size_t index, int size) {
    select_map(index);
    if (histogram_.width() != size) {
        histogram_ = gl::texture(GL_R32UI, size, size);
    }
    histogram_.clear(glm::uvec4(0u));
    histogram_.bind_image(0, GL_READ_WRITE);
    count_histogram_.dispatch((view_.x + 1) / 2, (view_.y + 1) / 2);
    gl::wait_for_writes();
    return histogram_.read<std::uint32_t>();
}

void passes::warp_map(std::size_t index, const glm::dmat4& warp) {
    const glm::mat4 before = matrix_in_use(index);
    write_map(index, at_ == precision::in_float ? glm::dmat4(glm::mat4(warp) * before)
                                                : warp * glm::dmat4(before));
}

void passes::write_map(std::size_t index, const glm::dmat4& matrix) {
    map_block map;
    map.full = map.matrix = glm::mat4(matrix);
    map.normal = at_ == precision::in_float ? glm::transpose(glm::inverse(map.matrix))
                                            : glm::mat4(glm::transpose(glm::inverse(matrix)));
    light_buffer_.write(sizeof(light_block) + index * sizeof map, sizeof map, &map);
}

void passes::find_centres(map_resources& maps, std::size_t index) {
    const map_resources::tables& warp = maps.warps[index];
    timed_pass("unwarp centres", [&] {
        warp.rows.bind(unit_rows);
        warp.columns.bind(unit_columns);
        warp.centres.bind_image(0, GL_WRITE_ONLY);
        // a strip of a column each
        unwarp_centres_.dispatch(warp.centres.width(),
                                 (warp.centres.height() + centres_strip - 1) / centres_strip);
        gl::wait_for_writes();
        warp.centres.bind(unit_centres);
    });
}

void passes::draw_plain_map(map_resources& maps, std::size_t index, std::size_t matrix) {
    select_map(matrix);
    maps.targets[index].bind();
    glClear(GL_DEPTH_BUFFER_BIT);
    draw_plain_.use();
    mesh_.draw();
}

void passes::test_shadows(map_resources& maps, const light_maps& chosen, bool warped) {
    bind_depth(maps);
    mask_.bind_image(0, GL_WRITE_ONLY);
    if (!warped) {
        test_plain_.dispatch(view_.x, view_.y);
    }
    if (warped && chosen.maps.size() > 1) {
        mask_.clear(glm::uvec4(1u)); // the background is in no map
    }
    // one dispatch per map: tables of several maps do not fit the units; each sample answers once
    for (std::size_t i = 0; warped && i < chosen.maps.size(); ++i) {
        if (!chosen.maps[i].used) {
            continue;
        }
        select_map(i);
        bind_tables(maps, i);
        test_warped_.dispatch(view_.x, view_.y);
    }
    gl::wait_for_writes();
}

std::vector<float> passes::draw_depths(const glm::dmat4& matrix, int size) {
    map_resources whole(size, 1, 0, 0);
    write_map(0, matrix);
    draw_plain_map(whole, 0);
    return whole.depth.read<float>();
}

glm::mat4 passes::matrix_in_use(std::size_t index) const {
    map_block map;
    light_buffer_.read(sizeof(light_block) + index * sizeof map, sizeof map, &map);
    return map.matrix;
}

std::vector<std::uint8_t> passes::shadowed() const {
    return mask_.read<std::uint8_t>();
}

} // namespace lab
