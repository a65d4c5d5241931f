// Where a method puts its shadow maps: the part of a frame that runs on the CPU.
#pragma once

#include "lab/scene.hpp"

#include <warpshadow/focus.hpp>
#include <warpshadow/principal_axis.hpp>
#include <warpshadow/projective.hpp>
#include <warpshadow/shadow_frustum.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace lab {

/// Which of a method's maps a point of the scene is looked up in; mirrored in shaders/light.glsl.
enum class map_choice {
    single = 0,     ///< there is one
    cube_face = 1,  ///< the face of the light's cube, in the order of `warpshadow::cube_lookup`
    view_depth = 2, ///< by depth along the view axis, nearest first
    hemisphere = 3  ///< front and back of a paraboloid pair, see lab/omni.hpp
};

/// Type of what the host hands to the library and takes from it between the steps of a set-up; the
/// library itself computes in double wherever that matters.
enum class precision { in_double, in_float };

/// One shadow map.
struct light_map {
    glm::dmat4 matrix{1.0}; ///< clip space (OpenGL) from the world, before a crop on the device
    bool used = true;       ///< false: nothing in view receives light from it, it is not drawn
    glm::dvec3 linear{1.0, 0.0, 0.0}; ///< of `warpshadow::linear_depth`
};

/// All maps of a method, and what choosing them met.
struct light_maps {
    std::vector<light_map> maps;
    map_choice choice = map_choice::single;
    glm::dvec4 depth_plane{0.0}; ///< view depth of a world position is dot(plane, (p, 1))
    std::vector<double> splits;  ///< view depths at which the next map begins; one less than maps
    double angle = 0.0;          ///< of the map's sides to the axes of the light, radians
    precision at = precision::in_double; ///< of the steps that follow
    warpshadow::status flags = warpshadow::status::ok;
};

/// What the set-up of one method keeps from frame to frame.
struct light_memory {
    warpshadow::fit_state fit;
    std::vector<warpshadow::projective_state<double>> bends; ///< per map
    warpshadow::axis_state turn;                             ///< of a map that is aligned
};

/// Corners of a box.
std::array<glm::dvec3, 8> corners_of(const warpshadow::box3<double>& box);

/// Distance from `from` to the farthest corner of a box along an axis of unit length; at least 0.
double farthest_along(const warpshadow::box3<double>& box, glm::dvec3 from, glm::dvec3 axis);

/// The camera's view of the whole scene; near is 2^-13 of far.
warpshadow::frustum<double> camera_frustum(const scene& world, const camera_view& camera,
                                           glm::ivec2 view);

/// Clip space (OpenGL) from the world.
glm::mat4 camera_matrix(const warpshadow::frustum<double>& camera);

/// What the camera and the light make of the scene's box.
warpshadow::focus_result focus_on(const scene& world, const warpshadow::frustum<double>& camera,
                                  const warpshadow::light<double>& light);

/// `sm`: maps of all that the light reaches in the scene's box; a point light has six.
/// @throws bad_input when the light does not reach the scene.
light_maps whole_scene_maps(const scene& world, const light_view& view,
                            precision at = precision::in_double);

/// `min-sm` (Milet et al. 2015, §3.2): the minimal shadow frustum of what the camera can see. The
/// faces of a point light's cube are cropped, and left out where no receiver is in view.
/// @throws bad_input when the light does not reach the scene.
light_maps minimal_maps(const scene& world, const warpshadow::frustum<double>& camera,
                        const light_view& view, int map_size, light_memory& memory,
                        precision at = precision::in_double);

/// `stable`: the fit whose texels stay where they are while the camera turns and moves; sunlight.
light_maps stable_maps(const scene& world, const warpshadow::frustum<double>& camera,
                       const light_view& view, int map_size, precision at = precision::in_double);

/// `pssm` (Zhang et al. 2006): the same for each of `count` slices of the view, practical splits of
/// which no part depends on where the camera looks; sunlight.
light_maps cascade_maps(const scene& world, const warpshadow::frustum<double>& camera,
                        const light_view& view, int count, int map_size,
                        precision at = precision::in_double);

/// `lispsm` (Wimmer et al. 2004, Scherzer 2005): the body that the camera sees, warped by one
/// matrix; face by face for a point light.
light_maps lispsm_maps(const scene& world, const warpshadow::frustum<double>& camera,
                       const light_view& view, precision at = precision::in_double);

/// A map for each of several slices of the view: the one there is serves all, unless they have
/// theirs.
void split_by_depth(light_maps& maps, const warpshadow::frustum<double>& camera,
                    std::vector<double> splits);

} // namespace lab
