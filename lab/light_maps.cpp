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

// Inputs of a set-up at T.
template <typename T> ws::light<T> at(const ws::light<double>& light) {
    return {light.kind, glm::vec<3, T>(light.position), glm::vec<3, T>(light.direction),
            static_cast<T>(light.cone_angle), light.vertical};
}
template <typename T> ws::box3<T> at(const ws::box3<double>& box) {
    return {glm::vec<3, T>(box.lo), glm::vec<3, T>(box.hi)};
}
template <typename T> ws::frustum<T> at(const ws::frustum<double>& camera) {
    const ws::view_volume<double>& v = camera.volume;
    return {glm::vec<3, T>(camera.eye),
            glm::vec<3, T>(camera.right),
            glm::vec<3, T>(camera.up),
            glm::vec<3, T>(camera.forward),
            {static_cast<T>(v.left), static_cast<T>(v.right), static_cast<T>(v.bottom),
             static_cast<T>(v.top), static_cast<T>(v.near_distance), static_cast<T>(v.far_distance),
             v.orthographic}};
}

/// The same steps at float or at double.
template <typename Steps> light_maps set_up(precision how, Steps steps) {
    light_maps result = how == precision::in_float ? steps(float{}) : steps(double{});
    result.at = how;
    return result;
}

template <typename T>
ws::frustum<T> face_of(const scene& world, const ws::light<double>& light, int face) {
    const glm::dvec3 axis = ws::cube_direction(face, glm::dvec2(0.5));
    // a face that looks away from the scene needs a depth range too
    const double far_distance = std::max(farthest_along(world.box, light.position, axis),
                                         near_share * glm::length(world.box.hi - world.box.lo));
    return ws::face_camera(glm::vec<3, T>(light.position), face, ws::cube_api::opengl,
                           static_cast<T>(far_distance * near_share), static_cast<T>(far_distance))
        .value;
}

template <typename T> glm::mat<4, 4, T> matrix_of(const ws::frustum<T>& camera) {
    return ws::projection_matrix(camera.volume, ws::clip::opengl) *
           ws::view_matrix(camera, ws::clip::opengl);
}

/// The cone around the pyramid of a cube face.
template <typename T> ws::light<T> face_beam(const ws::frustum<T>& face) {
    const double corner = 2.0 * std::atan(std::numbers::sqrt2);
    return {ws::light_kind::spot, face.eye, face.forward, static_cast<T>(corner)};
}

template <typename T>
ws::focus_result focus_at(const scene& world, const ws::frustum<double>& camera,
                          const ws::light<T>& light) {
    return ws::focus(ws::focus_input<T>{at<T>(camera), light, at<T>(world.box), at<T>(world.box)});
}

/// The part of a cube face that the receivers in view take up; not used if there is none.
template <typename T>
light_map cropped_face(const scene& world, const ws::frustum<double>& camera,
                       const ws::light<double>& light, int face, int map_size) {
    const ws::frustum<T> face_view = face_of<T>(world, light, face);
    const ws::focus_result seen = focus_at(world, camera, face_beam(face_view));
    light_map result{glm::dmat4(matrix_of(face_view)), seen.receivers.count > 0};
    if (seen.footprint_count == 0) {
        return result; // nothing in view, or no bounds: the whole face
    }
    const glm::dvec3 right(face_view.right);
    const glm::dvec3 up(face_view.up);
    const glm::dvec3 forward(face_view.forward);
    glm::dvec2 lo(1.0);
    glm::dvec2 hi(0.0);
    for (std::size_t i = 0; i < seen.footprint_count; ++i) {
        const glm::dvec3 ray = seen.view.forward + seen.footprint[i].x * seen.view.right +
                               seen.footprint[i].y * seen.view.up;
        const double along = glm::dot(ray, forward);
        const glm::dvec2 p =
            0.5 + 0.5 * glm::dvec2(glm::dot(ray, right), glm::dot(ray, up)) / along;
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
        const ws::map_rect<T> rounded{glm::vec<2, T>(rect.lo), glm::vec<2, T>(rect.hi)};
        result.matrix = glm::dmat4(ws::crop_matrix(matrix_of(face_view), rounded).matrix);
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

template <typename T> ws::stable_options<T> stable_fits(int map_size) {
    ws::stable_options<T> options;
    options.map_size = map_size;
    options.clip = ws::clip::opengl;
    return options;
}

template <typename T> light_maps whole_scene_at(const scene& world, const light_view& view) {
    const ws::light<double>& light = view.light;
    light_maps result;
    if (light.kind == ws::light_kind::point) {
        result.choice = map_choice::cube_face;
        for (int face = 0; face < faces; ++face) {
            result.maps.push_back({glm::dmat4(matrix_of(face_of<T>(world, light, face))), true});
        }
        return result;
    }
    ws::light_matrix_result<T> built;
    if (light.kind == ws::light_kind::directional) {
        built = ws::directional_light_matrix(at<T>(light), at<T>(world.box), ws::clip::opengl);
    } else {
        const double far_distance =
            farthest_along(world.box, light.position, glm::normalize(light.direction));
        built = ws::spot_light_matrix(at<T>(light), static_cast<T>(far_distance * near_share),
                                      static_cast<T>(far_distance), ws::clip::opengl);
    }
    check_reach(world, view, built.flags);
    result.maps.push_back({glm::dmat4(built.matrix), true});
    return result;
}

template <typename T>
light_maps minimal_at(const scene& world, const ws::frustum<double>& camera, const light_view& view,
                      int map_size, light_memory& memory) {
    const ws::light<double>& light = view.light;
    light_maps result;
    if (light.kind == ws::light_kind::point) {
        result.choice = map_choice::cube_face;
        for (int face = 0; face < faces; ++face) {
            result.maps.push_back(cropped_face<T>(world, camera, light, face, map_size));
        }
        return result;
    }
    const ws::focus_result seen = focus_at(world, camera, at<T>(light));
    result.flags = seen.flags;
    if (seen.footprint_count == 0) {
        // no receiver, or no bound for them: the map of everything serves
        const light_maps whole = whole_scene_at<T>(world, view);
        result.maps = whole.maps;
        result.flags |= whole.flags;
        return result;
    }
    ws::fit_options<T> options;
    options.frame = ws::fit_frame::rotated_minimal;
    options.clip = ws::clip::opengl;
    options.map_size = glm::ivec2(map_size);
    options.margin = T(0.5); // as the desired view has: no sample on the border
    if (light.kind == ws::light_kind::spot) {
        options.least_near =
            static_cast<T>(near_share * farthest_along(world.box, light.position,
                                                       glm::normalize(light.direction)));
    }
    const ws::shadow_fit<T> fit = ws::minimal_shadow_frustum(seen, options, memory.fit);
    result.flags |= fit.flags;
    result.angle = static_cast<double>(fit.angle);
    result.maps.push_back({glm::dmat4(fit.matrix), true});
    return result;
}

template <typename T>
light_maps stable_at(const scene& world, const ws::frustum<double>& camera, const light_view& view,
                     int map_size) {
    const ws::stable_result<T> fit =
        ws::stable_fit(at<T>(turning_camera(world, camera)), at<T>(view.light), at<T>(world.box),
                       stable_fits<T>(map_size));
    check_reach(world, view, fit.flags);
    light_maps result;
    result.maps.push_back({glm::dmat4(fit.matrix), true});
    result.flags = fit.flags;
    return result;
}

template <typename T>
light_maps cascades_at(const scene& world, const ws::frustum<double>& camera,
                       const light_view& view, int count, int map_size) {
    const auto slices = static_cast<std::size_t>(count);
    std::vector<T> splits(slices + 1);
    std::vector<ws::cascade<T>> cascades(slices);
    ws::cascade_options<T> options; // of lambda 1/2, without a blend
    options.fit = stable_fits<T>(map_size);
    light_maps result;
    result.flags =
        ws::fit_cascades(at<T>(turning_camera(world, camera)), at<T>(view.light), at<T>(world.box),
                         options, std::span<T>(splits), std::span<ws::cascade<T>>(cascades))
            .flags;
    for (const ws::cascade<T>& each : cascades) {
        check_reach(world, view, each.fit.flags);
        result.maps.push_back({glm::dmat4(each.fit.matrix), true});
        result.flags |= each.fit.flags;
    }
    split_by_depth(result, camera, std::vector<double>(splits.begin() + 1, splits.end() - 1));
    return result;
}

template <typename T>
light_maps lispsm_at(const scene& world, const ws::frustum<double>& camera,
                     const light_view& view) {
    light_maps result = whole_scene_at<T>(world, view);
    const ws::frustum<T> seen_by = at<T>(camera);
    for (std::size_t i = 0; i < result.maps.size(); ++i) {
        light_map& map = result.maps[i];
        ws::light<T> light = at<T>(view.light);
        if (light.kind == ws::light_kind::point) {
            light = face_beam(face_of<T>(world, view.light, static_cast<int>(i)));
        }
        const ws::focus_result seen = focus_at(world, camera, light);
        result.flags |= seen.flags;
        map.used = seen.receivers.count > 0 || view.light.kind != ws::light_kind::point;
        if (seen.footprint_count == 0) {
            continue; // no receiver, or no bound for them: the map of everything serves
        }
        std::vector<glm::vec<3, T>> body;
        std::vector<glm::vec<3, T>> casters;
        for (std::size_t k = 0; k < seen.receivers.count; ++k) {
            body.emplace_back(seen.receivers.vertices[k]);
        }
        // casters reach to the light itself: depth begins at a share of the distance, as elsewhere
        const bool placed = light.kind != ws::light_kind::directional;
        const glm::vec<3, T> axis = glm::normalize(light.direction);
        const glm::vec<3, T> apex = light.position - seen_by.eye;
        const T least = static_cast<T>(
            near_share * farthest_along(world.box, glm::dvec3(light.position), glm::dvec3(axis)));
        for (std::size_t k = 0; k < seen.casters.count; ++k) {
            const glm::vec<3, T> caster(seen.casters.vertices[k]);
            if (!placed || glm::dot(caster - apex, axis) >= least) {
                casters.push_back(caster);
            }
        }
        for (std::size_t k = 0; placed && k < body.size(); ++k) {
            const T along = glm::dot(body[k] - apex, axis);
            if (along > least) {
                casters.push_back(apex + (body[k] - apex) * (least / along));
            }
        }
        ws::lispsm_options<T> options;
        options.casters = casters;
        const ws::lispsm_result<T> warped = ws::lispsm(
            seen_by, light, std::span<const glm::vec<3, T>>(body), ws::clip::opengl, options);
        result.flags |= warped.flags;
        if (!ws::any(warped.flags, ws::status::light_inside_body | ws::status::unbounded |
                                       ws::status::invalid_input | ws::status::out_of_range)) {
            map.matrix =
                glm::dmat4(warped.matrix * glm::translate(glm::mat<4, 4, T>(T(1)), -seen_by.eye));
            map.linear = {warped.depth_scale, warped.depth_shift, warped.depth_centre};
        }
    }
    return result;
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
    return focus_at(world, camera, light);
}

light_maps whole_scene_maps(const scene& world, const light_view& view, precision at) {
    return set_up(at, [&]<typename T>(T /*type*/) { return whole_scene_at<T>(world, view); });
}

light_maps minimal_maps(const scene& world, const ws::frustum<double>& camera,
                        const light_view& view, int map_size, light_memory& memory, precision at) {
    return set_up(at, [&]<typename T>(T /*type*/) {
        return minimal_at<T>(world, camera, view, map_size, memory);
    });
}

light_maps stable_maps(const scene& world, const ws::frustum<double>& camera,
                       const light_view& view, int map_size, precision at) {
    return set_up(
        at, [&]<typename T>(T /*type*/) { return stable_at<T>(world, camera, view, map_size); });
}

light_maps cascade_maps(const scene& world, const ws::frustum<double>& camera,
                        const light_view& view, int count, int map_size, precision at) {
    return set_up(at, [&]<typename T>(T /*type*/) {
        return cascades_at<T>(world, camera, view, count, map_size);
    });
}

light_maps lispsm_maps(const scene& world, const ws::frustum<double>& camera,
                       const light_view& view, precision at) {
    return set_up(at, [&]<typename T>(T /*type*/) { return lispsm_at<T>(world, camera, view); });
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
