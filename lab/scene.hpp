// Scenes: triangles, views and lights; procedural ones by name, others from files.
#pragma once

#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/// Input that the lab cannot use; `what()` is one line for the user.
class bad_input : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A perspective camera that looks from `eye` to `target`, world units, y up.
struct camera_view {
    std::string label; ///< number of a built-in view, or the text that the user gave
    glm::dvec3 eye;
    glm::dvec3 target;
    double fov_y; ///< vertical, radians
};

/// A light and its name in reports.
struct light_view {
    std::string label; ///< number of a built-in light, or the text that the user gave
    warpshadow::light<double> light;
};

/// Colour of a surface in pictures, linear sRGB; measurements do not depend on it.
struct material {
    glm::vec3 colour;
    float variation; ///< how much the colour changes from place to place, 0 to 1
};

/// Triangles in metres, y up. Both sides of a triangle are seen and cast shadows.
struct scene {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<camera_view> cameras;      ///< at least one
    std::vector<light_view> lights;        ///< at least one
    warpshadow::box3<double> box;          ///< of the positions
    std::vector<std::uint8_t> material_of; ///< per triangle, index into `materials`
    std::vector<material> materials;
    std::vector<std::size_t> parts; ///< first triangles of the objects it was built of, increasing
};

/// A built-in scene as --list-scenes shows it.
struct scene_summary {
    std::string_view name;
    std::string_view about;
};
std::span<const scene_summary> builtin_scenes();

/// Whether `name` is one of `builtin_scenes()`.
bool is_builtin_scene(std::string_view name);

/// Builds a built-in scene; equal seeds give equal scenes.
/// @throws bad_input for an unknown name.
scene build_scene(std::string_view name, unsigned seed);

/// Reads a .obj, .gltf or .glb file; node transforms are applied, points and lines dropped. Gets
/// a camera and a sun derived from its box.
/// @throws bad_input when the file is missing, unreadable, has no triangles or a vertex that is
/// not finite.
scene load_scene(const std::string& path);

/// `build_scene` for a built-in name, for NAME:CORNERS the same with more triangles (see
/// lab/scene_detail.hpp), `load_scene` for anything else.
scene open_scene(const std::string& name_or_path, unsigned seed);

} // namespace lab
