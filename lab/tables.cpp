#include "lab/tables.hpp"

#include <warpshadow/warp_build.hpp>

#include <algorithm>
#include <limits>
#include <string>

namespace lab {

namespace ws = warpshadow;

namespace {

enum unit : GLuint { unit_known = 6, unit_light_depths = 7, unit_light_edges = 8 };

/// Texels along a side of the light's depth image, as in Rosen 2012, §6.
constexpr int light_image_size = 512;

/// Difference of depths beyond which the light's image has an edge: more than a slope of two takes
/// over a texel, where the scene is as deep as it is wide.
constexpr float edge_bias = 4.0f / static_cast<float>(light_image_size);

/// Share of the view's depth below which all counts as near alike: the camera's near plane is so
/// near that nothing is ever worth what the distance function gives there.
constexpr double nearest_share = 1.0 / 256.0;

/// Samples along a side of what an invocation adds up before it counts, with WS_SPLAT_MERGED.
constexpr int merged = 2;

bool uses_functions(const warp_options& options) {
    return options.functions.distance || options.functions.edge || options.functions.normal;
}

bool asks_for_ends(const warp_options& options) {
    return options.from == analysis::hybrid && options.functions.edge &&
           options.edges == edge_kind::shadow_end;
}

bool looks_from_the_light(const warp_options& options) {
    return options.from == analysis::forward ||
           (options.from == analysis::hybrid && options.functions.edge);
}

} // namespace

table_passes::table_passes(passes& gpu) : gpu_(gpu), axes_(gpu) {
    weigh_cells_ = gpu.compute("weigh_cells.comp");
    none_.shadowed = gl::texture(GL_R8UI, 1, 1);
}

table_passes::splat_programs& table_passes::programs(const warp_options& options) {
    std::vector<std::string> defines{"WS_SPLAT_MERGED"};
    if (options.from == analysis::forward) {
        defines.emplace_back("FORWARD");
    }
    if (uses_functions(options) || options.from == analysis::forward) {
        defines.emplace_back("WS_SPLAT_WEIGHTED");
        if (options.functions.edge) {
            defines.emplace_back(asks_for_ends(options) ? "SHADOW_ENDS" : "LIGHT_EDGES");
            if (options.rectilinear) {
                defines.emplace_back("EITHER_AXIS"); // one splat serves both
            }
        }
    }
    if (options.cells == ws::cell_rule::largest) {
        defines.emplace_back("WS_SPLAT_LARGEST");
    }
    if (options.shadows != known_shadows::none) {
        defines.emplace_back("WS_SPLAT_CLASSES 2");
    }
    if (options.every > 1) {
        defines.emplace_back("WS_SPLAT_SUBSET");
    }
    const auto found = splats_.find(defines);
    if (found != splats_.end()) {
        return found->second;
    }
    splat_programs made;
    made.rows = gpu_.compute("splat.comp", defines);
    std::vector<std::string> of_columns = defines;
    of_columns.emplace_back("WS_SPLAT_COLUMNS");
    made.columns = gpu_.compute("splat.comp", of_columns);
    for (const gl::program* program : {&made.rows, &made.columns}) {
        passes::set_units(*program);
        program->set("ws_every", options.every);
    }
    return splats_.emplace(defines, std::move(made)).first->second;
}

std::uint64_t table_passes::sample_count(const warp_options& options) const {
    const glm::ivec2 size =
        options.from == analysis::forward ? glm::ivec2(light_image_size) : gpu_.view();
    return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
}

float table_passes::steps(const warp_options& options, int cells) const {
    constexpr float largest = 2.0f * 3.0f; // of the functions' product, and of their sum
    if (options.cells == ws::cell_rule::largest) {
        const auto all = static_cast<std::uint64_t>(cells) * static_cast<std::uint64_t>(cells);
        return ws::weight_steps(all, largest);
    }
    return ws::weight_steps(sample_count(options), largest);
}

std::uint64_t table_passes::most_counts(const warp_options& options) const {
    const bool weighs = uses_functions(options) || options.from == analysis::forward ||
                        options.shadows != known_shadows::none;
    // steps of a weight are such that 32 bits hold their sum
    return weighs ? std::numeric_limits<std::uint32_t>::max() : sample_count(options);
}

void table_passes::look_from_the_light(std::size_t index, bool mark_edges) {
    if (!seen_by_light_) {
        seen_by_light_.emplace(light_image_size, 1, 0, 0);
        light_edges_ = gl::texture(GL_R8UI, light_image_size, light_image_size);
        mark_edges_ = gpu_.compute("depth_edges.comp");
    }
    gpu_.draw_plain_map(*seen_by_light_, 0, index);
    seen_by_light_->depth.bind(unit_light_depths);
    if (mark_edges) {
        mark_edges_.set("ws_edge_bias", edge_bias);
        light_edges_.bind_image(0, GL_WRITE_ONLY);
        mark_edges_.dispatch(light_image_size, light_image_size);
        gl::wait_for_writes();
    }
    light_edges_.bind(unit_light_edges);
}

std::size_t table_passes::light_image_bytes(const warp_options& options) const {
    if (!seen_by_light_ || !looks_from_the_light(options)) {
        return 0;
    }
    const bool edges = options.functions.edge && !asks_for_ends(options);
    return seen_by_light_->depth.bytes() + (edges ? light_edges_.bytes() : 0);
}

void table_passes::splat(map_resources& maps, std::size_t index, const warp_options& options,
                         bool columns) {
    map_resources::tables& warp = maps.warps[index];
    const gl::program& program = columns ? programs(options).columns : programs(options).rows;
    const bool classes = options.shadows != known_shadows::none;
    if (classes && warp.classes.width() != warp.counts.width()) {
        warp.classes = gl::texture(GL_R32UI, warp.counts.width(), 2 * warp.counts.height());
    }
    gl::texture& target = classes ? warp.classes : warp.counts;
    target.clear(glm::uvec4(0u));
    target.bind_image(0, GL_READ_WRITE);
    const glm::ivec2 samples =
        options.from == analysis::forward ? glm::ivec2(light_image_size) : gpu_.view();
    const int side = merged * options.every;
    program.dispatch((samples.x + side - 1) / side, (samples.y + side - 1) / side);
    gl::wait_for_writes();
    if (classes) {
        weigh_cells_.set("ws_share", options.share);
        weigh_cells_.set("ws_steps", ws::weight_steps(sample_count(options), options.share + 0.5f));
        warp.counts.bind_image(1, GL_WRITE_ONLY);
        weigh_cells_.dispatch(warp.counts.width(), warp.counts.height());
        gl::wait_for_writes();
    }
}

void table_passes::build_axis(map_resources& maps, std::size_t index, const warp_options& options,
                              bool columns, bool keep_counts) {
    map_resources::tables& warp = maps.warps[index];
    const gl::texture& table = columns ? warp.columns : warp.rows;
    gpu_.timed_pass(columns ? "splat columns" : "splat rows",
                    [&] { splat(maps, index, options, columns); });
    if (keep_counts) {
        (columns ? warp.second_counts : warp.first_counts) = warp.counts.read<std::uint32_t>();
    }
    gpu_.timed_pass(columns ? "build columns" : "build rows",
                    [&] { axes_.build(warp, table, options, most_counts(options)); });
}

void table_passes::build_lines(map_resources& maps, std::size_t index, const warp_options& options,
                               bool keep_counts) {
    map_resources::tables& warp = maps.warps[index];
    const int size = warp.counts.width();
    gpu_.timed_pass("splat", [&] { splat(maps, index, options, false); });
    if (keep_counts) {
        warp.first_counts = warp.counts.read<std::uint32_t>();
    }
    gpu_.timed_pass("collapse and build", [&] {
        const std::string rule =
            options.collapse == ws::cell_rule::largest ? "WS_COLLAPSE_LARGEST" : "WS_COLLAPSE_SUM";
        gl::program& collapse = collapse_.try_emplace(rule).first->second;
        if (collapse.id() == 0) {
            collapse = gpu_.compute("collapse.comp", {rule});
        }
        gl::program& build_line = build_line_[static_cast<std::size_t>(options.format)];
        if (build_line.id() == 0) {
            build_line = gpu_.compute("build_line.comp",
                                      {"WS_TABLE_FORMAT " + image_format(options.format)});
        }
        if (warp.lines.width() != size) {
            warp.lines = gl::texture(GL_R32UI, size, 2);
        }
        warp.counts.bind_image(0, GL_READ_ONLY);
        warp.lines.bind_image(1, GL_READ_WRITE);
        collapse.dispatch(size);
        gl::wait_for_writes();
        warp.lines.bind_image(0, GL_READ_ONLY);
        warp.rows.bind_image(1, GL_WRITE_ONLY);
        warp.columns.bind_image(2, GL_WRITE_ONLY);
        build_line.set("ws_cells", glm::ivec2(size));
        build_line.set("ws_width", options.width * static_cast<float>(size));
        build_line.set("ws_floor",
                       std::max(options.build.floor, least_floor(size, options.format)));
        build_line.set("ws_power", options.power);
        build_line.use();
        glDispatchCompute(2, 1, 1);
        gl::wait_for_writes();
    });
}

void table_passes::prepare(map_resources& maps, std::size_t index, const warp_options& options,
                           const ws::frustum<double>& camera, const shadow_memory& before) {
    gpu_.select_map(index);
    const int cells = maps.warps[index].counts.width();
    const splat_programs& splats = programs(options);
    const double nearest =
        std::max(camera.volume.near_distance, nearest_share * camera.volume.far_distance);
    for (const gl::program* program : {&splats.rows, &splats.columns}) {
        program->set("map_index", static_cast<int>(index));
        program->set("functions.distance", static_cast<int>(options.functions.distance));
        program->set("functions.edge", static_cast<int>(options.functions.edge));
        program->set("functions.normal", static_cast<int>(options.functions.normal));
        program->set("functions.add", static_cast<int>(options.functions.add));
        program->set("functions.near_distance", static_cast<float>(nearest));
        program->set("functions.inverse_far", static_cast<float>(1.0 / camera.volume.far_distance));
        program->set("functions.alpha", options.functions.alpha);
        program->set("functions.beta", options.functions.beta);
        program->set("functions.least_cosine", options.functions.least_cosine);
        program->set("steps", steps(options, cells));
        const glm::dvec3 forward = glm::normalize(camera.forward);
        program->set("view_depth", glm::vec4(glm::dvec4(forward, -glm::dot(forward, camera.eye))));
        program->set("eye", glm::vec3(camera.eye));
        program->set("camera", camera_matrix(camera));
        program->set("any_known", static_cast<int>(before.known));
        program->set("known_camera", before.camera);
    }
    (before.known ? before : none_).shadowed.bind(unit_known);
    if (looks_from_the_light(options)) {
        gpu_.timed_pass("light image", [&] {
            look_from_the_light(index, options.functions.edge && !asks_for_ends(options));
        });
    }
}

std::vector<std::uint32_t> table_passes::importance(map_resources& maps, std::size_t index,
                                                    const warp_options& options,
                                                    const ws::frustum<double>& camera,
                                                    const shadow_memory& before) {
    warp_options of_both = options;
    of_both.rectilinear = true; // one splat that tells of both axes
    prepare(maps, index, of_both, camera, before);
    std::vector<std::uint32_t> counts;
    gpu_.timed_pass("align", [&] {
        splat(maps, index, of_both, false);
        counts = maps.warps[index].counts.read<std::uint32_t>();
    });
    return counts;
}

void table_passes::build(map_resources& maps, std::size_t index, const warp_options& options,
                         const ws::frustum<double>& camera, const shadow_memory& before,
                         bool keep_counts) {
    prepare(maps, index, options, camera, before);
    if (options.rectilinear) {
        build_lines(maps, index, options, keep_counts);
        passes::bind_tables(maps, index);
    } else {
        build_axis(maps, index, options, false, keep_counts);
        passes::bind_tables(maps, index);
        build_axis(maps, index, options, true, keep_counts);
    }
    gpu_.find_centres(maps, index);
}

void table_passes::remember(shadow_memory& memory, const ws::frustum<double>& camera) {
    if (memory.shadowed.width() != gpu_.view().x || memory.shadowed.height() != gpu_.view().y) {
        memory.shadowed = gl::texture(GL_R8UI, gpu_.view().x, gpu_.view().y);
    }
    const gl::texture& mask = gpu_.mask();
    glCopyImageSubData(mask.id(), GL_TEXTURE_2D, 0, 0, 0, 0, memory.shadowed.id(), GL_TEXTURE_2D, 0,
                       0, 0, 0, mask.width(), mask.height(), 1);
    memory.camera = camera_matrix(camera);
    memory.known = true;
}

void table_passes::remember(shadow_memory& memory, const ws::frustum<double>& camera,
                            const std::vector<std::uint8_t>& shadowed) {
    memory.shadowed = gl::texture(GL_R8UI, gpu_.view().x, gpu_.view().y);
    memory.shadowed.write(shadowed.data());
    memory.camera = camera_matrix(camera);
    memory.known = true;
}

} // namespace lab
