// Figure 13 of Navratil 2012: shadow maps of virtual point lights, which all geometry is before.
//
// As in imperfect shadow maps (Ritschel et al. 2008) the scene is a cloud of points on its
// surfaces, and the lights are on surfaces too: a light shines into the hemisphere of its normal
// alone.
#pragma once

#include "gl/objects.hpp"
#include "lab/figure_matrix.hpp"
#include "lab/objects.hpp"
#include "lab/options.hpp"
#include "lab/passes.hpp"
#include "lab/progress.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"

#include <warpshadow/cull.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/// Points on the surfaces of a scene, in groups of near ones that are culled as one.
struct point_cloud {
    std::vector<glm::vec3> points;
    std::vector<triangle_range> groups;             ///< of `points`
    std::vector<warpshadow::sphere3<double>> balls; ///< around the groups
};

/// `count` points, evenly over the area of the triangles; the same on every machine.
point_cloud make_points(const scene& world, std::size_t count, unsigned seed);

/// A light on a surface, which shines to one side of it.
struct virtual_light {
    glm::dvec3 position;
    glm::dvec3 normal; ///< unit length
};

/// `count` lights, evenly over the area; their normals look to where most of the scene is.
std::vector<virtual_light> make_virtual_lights(const scene& world, std::size_t count,
                                               unsigned seed);

/// The ways to draw the maps of a virtual light.
struct vpl_way {
    std::string_view name;
    bool hemispheres; ///< two paraboloids instead of six faces
    bool cull;        ///< no map and no group behind the surface; groups to their maps alone
};
inline constexpr std::array vpl_ways{vpl_way{"cube6", false, false},
                                     vpl_way{"cube6-efc", false, true},
                                     vpl_way{"dpsm", true, false}, vpl_way{"dpsm-pc", true, true}};

/// Draws the maps of virtual lights: the axis of the front, and of face 4, is the normal.
class vpl_passes {
  public:
    vpl_passes(const scene& world, const point_cloud& cloud, int map_size);

    /// What is drawn to which map takes part in the time. Returns how many maps were drawn.
    int draw(const virtual_light& light, const vpl_way& way);
    /// The depths of one map: a face of the cube, or front and back.
    [[nodiscard]] std::vector<float> depths(const vpl_way& way, int map) const;

  private:
    void sort_groups(const virtual_light& light, const glm::dmat3& axes, const vpl_way& way);
    void draw_points(std::size_t map);

    const point_cloud& cloud_;
    int size_;
    double reach_; ///< diagonal of the scene
    gl::program draw_face_, draw_half_;
    gl::buffer points_;
    gl::vertex_array array_;
    map_resources faces_, hemispheres_;
    std::vector<std::uint8_t> masks_;
    std::vector<GLint> firsts_;
    std::vector<GLsizei> counts_;
};

/// Whether the preset is this one: `vpl` or `vpl:POINTS`.
bool is_vpl(const std::string& preset);

/// How many points the preset asks for.
/// @throws bad_input when that is no number from 1 on, or too large.
std::size_t points_of_vpl(const std::string& preset);

figure_defaults defaults_of_vpl();

/// How many steps of progress a run takes.
std::size_t runs_of_vpl();

/// Measures all ways for each light and adds the record to `all`.
void run_vpl(const options& wanted, const scene& world, results& all, progress_bar& progress);

/// The record as a part of report.html.
std::string vpl_section(const results& all, std::size_t record);

} // namespace lab
