#include "lab/light_maps.hpp"

#include <warpshadow/cascades.hpp>
#include <warpshadow/cube.hpp>
#include <warpshadow/fit.hpp>
#include <warpshadow/lispsm.hpp>
#include <warpshadow/stable_fit.hpp>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace lab {

namespace ws = warpshadow;

namespace {

/// Depth starts at this share of the distance to the farthest point.
constexpr double near_share = 0x1p-10;

constexpr int faces = 6;

void check_reach(const scene& world, const light_view& view, ws::status flags) {
    if (ws::any(flags, ws::status::invalid_input | ws::status::out_of_range)) {
        throw bad_input("the light " + view.label + " does not reach the scene " + world.name);
    }
}

ws::frustum<double> face_of(const scene& world, const ws::light<double>& light, int face) {
    const glm::dvec3 axis = ws::cube_direction(face, glm::dvec2(0.5));
    // a face that looks away from the scene needs a depth range too
    const double far_distance = std::max(farthest_along(world.box, light.position, axis),
                                         near_share * glm::length(world.box.hi - world.box.lo));
    return ws::face_camera(light.position, face, ws::cube_api::opengl, far_distance * near_share,
                           far_distance)
        .value;
}

glm::dmat4 matrix_of(const ws::frustum<double>& camera) {
    return ws::projection_matrix(camera.volume, ws::clip::opengl) *
           ws::view_matrix(camera, ws::clip::opengl);
}

/// The cone around the pyramid of a cube face.
ws::light<double> face_beam(const ws::frustum<double>& face) {
    const double corner = 2.0 * std::atan(std::numbers::sqrt2);
    return {ws::light_kind::spot, face.eye, face.forward, corner};
}

/// The part of a cube face that the receivers in view take up; not used if there is none.
light_map cropped_face(const scene& world, const ws::frustum<double>& camera,
                       const ws::light<double>& light, int face, int map_size) {
    const ws::frustum<double> face_view = face_of(world, light, face);
    const ws::focus_result seen = focus_on(world, camera, face_beam(face_view));
    light_map result{matrix_of(face_view), seen.receivers.count > 0};
    if (seen.footprint_count == 0) {
        return result; // nothing in view, or no bounds: the whole face
    }
    glm::dvec2 lo(1.0);
    glm::dvec2 hi(0.0);
    for (std::size_t i = 0; i < seen.footprint_count; ++i) {
        const glm::dvec3 ray = seen.view.forward + seen.footprint[i].x * seen.view.right +
                               seen.footprint[i].y * seen.view.up;
        const double along = glm::dot(ray, face_view.forward);
        const glm::dvec2 p =
            0.5 +
            0.5 * glm::dvec2(glm::dot(ray, face_view.right), glm::dot(ray, face_view.up)) / along;
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    lo = glm::max(lo, 0.0);
    hi = glm::min(hi, 1.0);
    result.used = lo.x < hi.x && lo.y < hi.y;
    if (result.used) {
        const double margin = 0.5 / std::max(map_size - 1, 1);
        ws::map_rect<double> rect{lo, hi};
        ws::widen_side(lo.x, hi.x, margin, rect.lo.x, rect.hi.x);
        ws::widen_side(lo.y, hi.y, margin, rect.lo.y, rect.hi.y);
        result.matrix = ws::crop_matrix(result.matrix, rect).matrix;
    }
    return result;
}

/// The camera with a volume that turning does not change, and moving rarely does.
ws::frustum<double> turning_camera(const scene& world, const ws::frustum<double>& camera) {
    ws::frustum<double> turning = camera;
    // a far plane that depends on where the camera looks would change the texels with it
    turning.volume.far_distance = 0.0;
    for (const glm::dvec3& corner : corners_of(world.box)) {
        turning.volume.far_distance =
            std::max(turning.volume.far_distance, glm::length(corner - camera.eye));
    }
    // and one that depends on where it stands: in powers of two, as rarely as can be
    turning.volume.far_distance = std::exp2(std::ceil(std::log2(turning.volume.far_distance)));
    turning.volume.near_distance = turning.volume.far_distance * 0x1p-13;
    return turning;
}

ws::stable_options<double> stable_fits(int map_size) {
    ws::stable_options<double> options;
    options.map_size = map_size;
    options.clip = ws::clip::opengl;
    return options;
}

} // namespace

std::array<glm::dvec3, 8> corners_of(const ws::box3<double>& box) {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] =
            glm::dvec3((i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y,
                       (i & 4) != 0 ? box.hi.z : box.lo.z);
    }
    return corners;
}

double farthest_along(const ws::box3<double>& box, glm::dvec3 from, glm::dvec3 axis) {
    double farthest = 0.0;
    for (const glm::dvec3& corner : corners_of(box)) {
        farthest = std::max(farthest, glm::dot(corner - from, axis));
    }
    return farthest;
}

ws::frustum<double> camera_frustum(const scene& world, const camera_view& camera, glm::ivec2 view) {
    const double aspect = static_cast<double>(view.x) / view.y;
    const double far_distance =
        1.01 *
        std::max(farthest_along(world.box, camera.eye, glm::normalize(camera.target - camera.eye)),
                 1e-3);
    const ws::view_volume<double> volume =
        ws::perspective_volume(camera.fov_y, aspect, far_distance * 0x1p-13, far_distance);
    return ws::make_frustum(camera.eye, camera.target - camera.eye, glm::dvec3(0.0, 1.0, 0.0),
                            volume)
        .value;
}

glm::mat4 camera_matrix(const ws::frustum<double>& camera) {
    return glm::mat4(matrix_of(camera));
}

ws::focus_result focus_on(const scene& world, const ws::frustum<double>& camera,
                          const ws::light<double>& light) {
    return ws::focus(ws::focus_input<double>{camera, light, world.box, world.box});
}

light_maps whole_scene_maps(const scene& world, const light_view& view) {
    const ws::light<double>& light = view.light;
    light_maps result;
    if (light.kind == ws::light_kind::point) {
        result.choice = map_choice::cube_face;
        for (int face = 0; face < faces; ++face) {
            result.maps.push_back({matrix_of(face_of(world, light, face)), true});
        }
        return result;
    }
    ws::light_matrix_result<double> built;
    if (light.kind == ws::light_kind::directional) {
        built = ws::directional_light_matrix(light, world.box, ws::clip::opengl);
    } else {
        const double far_distance =
            farthest_along(world.box, light.position, glm::normalize(light.direction));
        built =
            ws::spot_light_matrix(light, far_distance * near_share, far_distance, ws::clip::opengl);
    }
    check_reach(world, view, built.flags);
    result.maps.push_back({built.matrix, true});
    return result;
}

light_maps minimal_maps(const scene& world, const ws::frustum<double>& camera,
                        const light_view& view, int map_size, light_memory& memory) {
    const ws::light<double>& light = view.light;
    light_maps result;
    if (light.kind == ws::light_kind::point) {
        result.choice = map_choice::cube_face;
        for (int face = 0; face < faces; ++face) {
            result.maps.push_back(cropped_face(world, camera, light, face, map_size));
        }
        return result;
    }
    const ws::focus_result seen = focus_on(world, camera, light);
    result.flags = seen.flags;
    if (seen.footprint_count == 0) {
        // no receiver, or no bound for them: the map of everything serves
        const light_maps whole = whole_scene_maps(world, view);
        result.maps = whole.maps;
        result.flags |= whole.flags;
        return result;
    }
    ws::fit_options<double> options;
    options.frame = ws::fit_frame::rotated_minimal;
    options.clip = ws::clip::opengl;
    options.map_size = glm::ivec2(map_size);
    options.margin = 0.5; // as the desired view has: no sample on the border
    if (light.kind == ws::light_kind::spot) {
        options.least_near =
            near_share * farthest_along(world.box, light.position, glm::normalize(light.direction));
    }
    const ws::shadow_fit<double> fit = ws::minimal_shadow_frustum(seen, options, memory.fit);
    result.flags |= fit.flags;
    result.angle = fit.angle;
    result.maps.push_back({fit.matrix, true});
    return result;
}

light_maps stable_maps(const scene& world, const ws::frustum<double>& camera,
                       const light_view& view, int map_size) {
    const ws::stable_result<double> fit =
        ws::stable_fit(turning_camera(world, camera), view.light, world.box, stable_fits(map_size));
    check_reach(world, view, fit.flags);
    light_maps result;
    result.maps.push_back({fit.matrix, true});
    result.flags = fit.flags;
    return result;
}

light_maps cascade_maps(const scene& world, const ws::frustum<double>& camera,
                        const light_view& view, int count, int map_size) {
    const auto slices = static_cast<std::size_t>(count);
    std::vector<double> splits(slices + 1);
    std::vector<ws::cascade<double>> cascades(slices);
    ws::cascade_options<double> options; // of lambda 1/2, without a blend
    options.fit = stable_fits(map_size);
    light_maps result;
    result.flags =
        ws::fit_cascades(turning_camera(world, camera), view.light, world.box, options,
                         std::span<double>(splits), std::span<ws::cascade<double>>(cascades))
            .flags;
    for (const ws::cascade<double>& each : cascades) {
        check_reach(world, view, each.fit.flags);
        result.maps.push_back({each.fit.matrix, true});
        result.flags |= each.fit.flags;
    }
    split_by_depth(result, camera, {splits.begin() + 1, splits.end() - 1});
    return result;
}

light_maps lispsm_maps(const scene& world, const ws::frustum<double>& camera,
                       const light_view& view) {
    light_maps result = whole_scene_maps(world, view);
    for (std::size_t i = 0; i < result.maps.size(); ++i) {
        light_map& map = result.maps[i];
        ws::light<double> light = view.light;
        if (light.kind == ws::light_kind::point) {
            light = face_beam(face_of(world, light, static_cast<int>(i)));
        }
        const ws::focus_result seen = focus_on(world, camera, light);
        result.flags |= seen.flags;
        map.used = seen.receivers.count > 0 || view.light.kind != ws::light_kind::point;
        if (seen.footprint_count == 0) {
            continue; // no receiver, or no bound for them: the map of everything serves
        }
        std::vector<glm::dvec3> body;
        std::vector<glm::dvec3> casters;
        for (std::size_t k = 0; k < seen.receivers.count; ++k) {
            body.emplace_back(seen.receivers.vertices[k]);
        }
        // casters reach to the light itself: depth begins at a share of the distance, as elsewhere
        const bool placed = light.kind != ws::light_kind::directional;
        const glm::dvec3 axis = glm::normalize(light.direction);
        const glm::dvec3 apex = light.position - camera.eye;
        const double least = near_share * farthest_along(world.box, light.position, axis);
        for (std::size_t k = 0; k < seen.casters.count; ++k) {
            const glm::dvec3 caster(seen.casters.vertices[k]);
            if (!placed || glm::dot(caster - apex, axis) >= least) {
                casters.push_back(caster);
            }
        }
        for (std::size_t k = 0; placed && k < body.size(); ++k) {
            const double along = glm::dot(body[k] - apex, axis);
            if (along > least) {
                casters.push_back(apex + (body[k] - apex) * (least / along));
            }
        }
        ws::lispsm_options<double> options;
        options.casters = casters;
        const ws::lispsm_result<double> warped =
            ws::lispsm(camera, light, std::span<const glm::dvec3>(body), ws::clip::opengl, options);
        result.flags |= warped.flags;
        if (!ws::any(warped.flags, ws::status::light_inside_body | ws::status::unbounded |
                                       ws::status::invalid_input | ws::status::out_of_range)) {
            map.matrix = warped.matrix * glm::translate(glm::dmat4(1.0), -camera.eye);
            map.linear = {warped.depth_scale, warped.depth_shift, warped.depth_centre};
        }
    }
    return result;
}

void split_by_depth(light_maps& maps, const ws::frustum<double>& camera,
                    std::vector<double> splits) {
    maps.choice = map_choice::view_depth;
    const glm::dvec3 forward = glm::normalize(camera.forward);
    maps.depth_plane = glm::dvec4(forward, -glm::dot(forward, camera.eye));
    maps.maps.resize(splits.size() + 1, maps.maps.front());
    maps.splits = std::move(splits);
}

} // namespace lab
