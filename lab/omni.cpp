#include "lab/omni.hpp"

#include "lab/shaders.hpp"

#include <warpshadow/casters.hpp>
#include <warpshadow/cube.hpp>
#include <warpshadow/paraboloid.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

namespace lab {

namespace ws = warpshadow;

namespace {

/// A view sample is a position in float: it may lie that share of its distance outside the view,
/// and faces and hemispheres are widened by as much.
constexpr double sample_rounding = 0x1p-20;

/// Words of the command that glMultiDrawElementsIndirect reads; glMultiDrawArraysIndirect does with
/// one less.
constexpr std::size_t words_of_command = 5;

/// Clip space from a place relative to the light and its distance, see `light_coordinates` in
/// shaders/light.glsl.
glm::dmat4 paraboloid_matrix(const glm::dmat3& axes, int side) {
    const glm::dvec3 along = side == 1 ? -axes[2] : axes[2];
    return glm::transpose(glm::dmat4(glm::dvec4(axes[0], 0.0), glm::dvec4(axes[1], 0.0),
                                     glm::dvec4(0.0, 0.0, 0.0, 1.0), glm::dvec4(along, 1.0)));
}

double us_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
        .count();
}

} // namespace

light_maps omni_maps(const scene& world, std::span<const ws::frustum<double>> cameras,
                     const light_view& light, const omni_way& way) {
    const glm::dvec3 position = light.light.position;
    light_maps result;
    ws::mask_result needed{way.hemispheres ? ws::both_sides : ws::all_faces, ws::status::ok};
    if (way.hemispheres) {
        const glm::dmat3 axes = make_hemisphere_frame(world, position, front_axis).axes;
        result.choice = map_choice::hemisphere;
        result.depth_plane = glm::dvec4(axes[2], -glm::dot(axes[2], position));
        for (int side = 0; side < 2; ++side) {
            result.maps.push_back({paraboloid_matrix(axes, side)});
        }
        if (way.cull_maps) {
            needed = ws::side_mask(position, front_axis, cameras, sample_rounding);
        }
    } else {
        result = whole_scene_maps(world, light);
        if (way.cull_maps) {
            ws::face_options options;
            options.refined = true;
            options.slope = 1.0 + sample_rounding;
            needed = ws::face_mask(position, cameras, options);
        }
    }
    result.flags |= needed.flags;
    for (std::size_t i = 0; i < result.maps.size(); ++i) {
        result.maps[i].used = (needed.mask >> i & 1u) != 0u;
    }
    return result;
}

omni_passes::omni_passes(passes& gpu)
    : gpu_(gpu), objects_(make_objects(gpu.world())), raster_(gpu) {
    draw_face_ = gpu_.link("omni_face.vert", "empty.frag");
    draw_hemisphere_ = gpu_.link("omni_hemisphere.vert", "omni_hemisphere.frag");
    test_hemispheres_ = gpu_.compute("omni_test.comp");
    test_warped_ = gpu_.compute("omni_test.comp", {"WARPED"});
    const gl::shader_library library{gl::glsl_files(), lab_shaders()};
    const auto layered = [&](const char* vertex, const char* geometry, const char* fragment) {
        return gl::program({{GL_VERTEX_SHADER, library.load(vertex)},
                            {GL_GEOMETRY_SHADER, library.load(geometry)},
                            {GL_FRAGMENT_SHADER, library.load(fragment)}});
    };
    draw_layers_ = layered("lab/omni_layers.vert", "lab/omni_layers.geom", "lab/empty.frag");
    draw_halves_ =
        layered("lab/omni_halves.vert", "lab/omni_halves.geom", "lab/omni_hemisphere.frag");
    passes::set_units(test_hemispheres_);
    passes::set_units(test_warped_);

    indices_ = gl::buffer(std::span<const glm::uvec3>(objects_.triangles));
    masks_.resize(objects_.ranges.size());
    masks_on_device_ = gl::buffer(masks_.size() * sizeof(std::uint32_t), nullptr, GL_DYNAMIC_DRAW);
    commands_ = gl::buffer(masks_.size() * words_of_command * sizeof(std::uint32_t), nullptr,
                           GL_DYNAMIC_DRAW);
    array_.bind();
    gpu_.mesh().positions().bind(GL_ARRAY_BUFFER);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    bind_masks(1);
    indices_.bind(GL_ELEMENT_ARRAY_BUFFER);
    glBindVertexArray(0);
}

void omni_passes::bind_masks(GLuint index) const {
    masks_on_device_.bind(GL_ARRAY_BUFFER);
    glEnableVertexAttribArray(index);
    glVertexAttribIPointer(index, 1, GL_UNSIGNED_INT, sizeof(std::uint32_t), nullptr);
    glVertexAttribDivisor(index, 1);
}

const omni_passes::cut_scene& omni_passes::cut_for(const light_view& light, int map_size) {
    cut_scene& cut = cut_scenes_[map_size];
    if (!cut.ranges.empty() && cut.light == light.light.position) {
        return cut;
    }
    const auto begin = std::chrono::steady_clock::now();
    cut.light = light.light.position;
    cut.frame = make_hemisphere_frame(gpu_.world(), cut.light, front_axis);
    const hemisphere_mesh mesh = cut_for_hemispheres(gpu_.world(), objects_, cut.frame, map_size);
    cut.ms = 1e-3 * us_since(begin);
    cut.ranges = mesh.ranges;
    cut.flags = mesh.flags;
    cut.vertices = gl::buffer(std::span<const hemisphere_vertex>(mesh.vertices));
    cut.array.bind();
    cut.vertices.bind(GL_ARRAY_BUFFER);
    constexpr GLsizei stride = sizeof(hemisphere_vertex);
    const auto attribute = [](GLuint index, GLint size, std::size_t offset) {
        glEnableVertexAttribArray(index);
        glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, stride,
                              reinterpret_cast<const void*>(offset));
    };
    attribute(0, 3, offsetof(hemisphere_vertex, position));
    attribute(1, 4, offsetof(hemisphere_vertex, plane));
    attribute(2, 2, offsetof(hemisphere_vertex, reach));
    bind_masks(3);
    glBindVertexArray(0);
    return cut;
}

void omni_passes::sort_objects(const light_maps& chosen, const light_view& light,
                               const omni_way& way, int map_size) {
    const auto begin = std::chrono::steady_clock::now();
    const glm::dvec3 position = light.light.position;
    std::uint8_t used = 0;
    for (std::size_t i = 0; i < chosen.maps.size(); ++i) {
        used = static_cast<std::uint8_t>(used | (chosen.maps[i].used ? 1u << i : 0u));
    }
    if (!way.cull_objects) {
        std::fill(masks_.begin(), masks_.end(), used);
    } else if (way.hemispheres) {
        const double overlap = horizon_overlap(map_size);
        for (std::size_t i = 0; i < masks_.size(); ++i) {
            // drawn a little behind the horizon too: there a point is that much short of it
            ws::box3<double> box = objects_.boxes[i];
            const double behind = overlap * glm::length(glm::max(glm::abs(box.lo - position),
                                                                 glm::abs(box.hi - position)));
            box.lo -= behind;
            box.hi += behind;
            masks_[i] =
                static_cast<std::uint8_t>(ws::caster_sides(position, front_axis, box).mask & used);
        }
    } else {
        ws::caster_faces(position, std::span<const ws::box3<double>>(objects_.boxes),
                         std::numeric_limits<double>::infinity(), std::span(masks_));
        for (std::uint8_t& mask : masks_) {
            mask = static_cast<std::uint8_t>(mask & used);
        }
    }
    culling_us_ = us_since(begin);
}

void omni_passes::collect(const std::vector<triangle_range>& ranges, std::size_t map) {
    wanted_.clear();
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        if ((masks_[i] >> map & 1u) == 0u || ranges[i].count == 0) {
            continue;
        }
        triangles_ += ranges[i].count;
        if (!wanted_.empty() && wanted_.back().first + wanted_.back().count == ranges[i].first) {
            wanted_.back().count += ranges[i].count;
        } else {
            wanted_.push_back(ranges[i]);
        }
    }
}

void omni_passes::draw_faces(map_resources& maps, const light_maps& chosen) {
    draw_face_.use();
    array_.bind();
    for (std::size_t map = 0; map < chosen.maps.size(); ++map) {
        if (!chosen.maps[map].used) {
            continue;
        }
        collect(objects_.ranges, map);
        counts_.clear();
        offsets_.clear();
        for (const triangle_range& range : wanted_) {
            counts_.push_back(static_cast<GLsizei>(3 * range.count));
            offsets_.push_back(reinterpret_cast<const void*>(range.first * sizeof(glm::uvec3)));
        }
        draw_face_.set("map_index", static_cast<int>(map));
        maps.targets[map].bind();
        glClear(GL_DEPTH_BUFFER_BIT);
        glMultiDrawElements(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, offsets_.data(),
                            static_cast<GLsizei>(counts_.size()));
    }
}

void omni_passes::write_masks(const std::vector<triangle_range>& ranges, bool indexed) {
    const std::vector<std::uint32_t> masks(masks_.begin(), masks_.end());
    masks_on_device_.write(0, masks.size() * sizeof(std::uint32_t), masks.data());
    std::vector<std::uint32_t> words;
    words.reserve(ranges.size() * words_of_command);
    commands_in_use_ = 0;
    for (std::size_t i = 0; i < masks_.size(); ++i) {
        const triangle_range& range = ranges[i];
        if (masks_[i] == 0 || range.count == 0) {
            continue;
        }
        triangles_ += range.count;
        ++commands_in_use_;
        words.insert(words.end(), {static_cast<std::uint32_t>(3 * range.count), 1u,
                                   static_cast<std::uint32_t>(3 * range.first)});
        if (indexed) {
            words.push_back(0u); // added to each index
        }
        words.push_back(static_cast<std::uint32_t>(i)); // the first instance: the object's mask
    }
    commands_.write(0, words.size() * sizeof(std::uint32_t), words.data());
    commands_.bind(GL_DRAW_INDIRECT_BUFFER);
}

void omni_passes::draw_face_layers(map_resources& maps) {
    write_masks(objects_.ranges, true);
    maps.all_layers.bind();
    glClear(GL_DEPTH_BUFFER_BIT);
    draw_layers_.use();
    array_.bind();
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, commands_in_use_, 0);
}

void omni_passes::set_frame(const gl::program& program, const map_resources& maps,
                            const cut_scene& scene) {
    program.set("far_distance", static_cast<float>(scene.frame.far_distance));
    program.set("overlap", static_cast<float>(horizon_overlap(maps.size)));
    program.set("map_size", static_cast<float>(maps.size));
}

void omni_passes::draw_hemisphere_layers(map_resources& maps, const cut_scene& scene) {
    write_masks(scene.ranges, false);
    maps.all_layers.bind();
    glClear(GL_DEPTH_BUFFER_BIT);
    set_frame(draw_halves_, maps, scene);
    draw_halves_.use();
    scene.array.bind();
    glEnable(GL_CLIP_DISTANCE0);
    glMultiDrawArraysIndirect(GL_TRIANGLES, nullptr, commands_in_use_, 0);
    glDisable(GL_CLIP_DISTANCE0);
}

void omni_passes::draw_hemispheres(map_resources& maps, const light_maps& chosen,
                                   const cut_scene& scene) {
    set_frame(draw_hemisphere_, maps, scene);
    draw_hemisphere_.use();
    scene.array.bind();
    glEnable(GL_CLIP_DISTANCE0);
    for (std::size_t side = 0; side < chosen.maps.size(); ++side) {
        if (!chosen.maps[side].used) {
            continue;
        }
        collect(scene.ranges, side);
        counts_.clear();
        firsts_.clear();
        for (const triangle_range& range : wanted_) {
            counts_.push_back(static_cast<GLsizei>(3 * range.count));
            firsts_.push_back(static_cast<GLint>(3 * range.first));
        }
        draw_hemisphere_.set("side", static_cast<int>(side));
        maps.targets[side].bind();
        glClear(GL_DEPTH_BUFFER_BIT);
        glMultiDrawArrays(GL_TRIANGLES, firsts_.data(), counts_.data(),
                          static_cast<GLsizei>(counts_.size()));
    }
    glDisable(GL_CLIP_DISTANCE0);
}

void omni_passes::draw(map_resources& maps, light_maps& chosen, const light_view& light,
                       const omni_way& way) {
    triangles_ = 0;
    cutting_ms_ = 0.0;
    bytes_ = 0;
    sort_objects(chosen, light, way, maps.size);
    if (way.hemispheres) {
        const cut_scene& scene = cut_for(light, maps.size);
        chosen.flags |= scene.flags;
        cutting_ms_ = scene.ms;
        bytes_ = scene.vertices.bytes();
        if (way.layered) {
            draw_hemisphere_layers(maps, scene);
        } else {
            draw_hemispheres(maps, chosen, scene);
        }
    } else if (way.layered) {
        draw_face_layers(maps);
    } else {
        draw_faces(maps, chosen);
    }
}

void omni_passes::draw_warped(map_resources& maps, std::size_t side, const light_view& light,
                              bool count) {
    const hemisphere_frame frame =
        make_hemisphere_frame(gpu_.world(), light.light.position, front_axis);
    raster_.draw(maps, side, frame.far_distance, count);
}

void omni_passes::test_hemispheres(const map_resources& maps, const light_maps& chosen,
                                   const light_view& light, bool warped) {
    const hemisphere_frame frame =
        make_hemisphere_frame(gpu_.world(), light.light.position, front_axis);
    const gl::program& test = warped ? test_warped_ : test_hemispheres_;
    test.set("far_distance", static_cast<float>(frame.far_distance));
    passes::bind_depth(maps);
    gpu_.mask().bind_image(0, GL_WRITE_ONLY);
    if (!warped) {
        test.set("from_world", glm::mat3(glm::transpose(frame.axes)));
        test.dispatch(gpu_.view().x, gpu_.view().y);
        gl::wait_for_writes();
        return;
    }
    gpu_.mask().clear(glm::uvec4(1u)); // a sample of a map that is not used is in no other
    for (std::size_t side = 0; side < chosen.maps.size(); ++side) {
        if (chosen.maps[side].used) {
            test.set("map_index", static_cast<int>(side));
            passes::bind_tables(maps, side);
            test.dispatch(gpu_.view().x, gpu_.view().y);
        }
    }
    gl::wait_for_writes();
}

} // namespace lab
