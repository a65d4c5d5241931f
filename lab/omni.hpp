// Maps of point lights: six faces of a cube or two paraboloids, and what need not be drawn of them.
#pragma once

#include "lab/light_maps.hpp"
#include "lab/objects.hpp"
#include "lab/omni_mesh.hpp"
#include "lab/omni_raster.hpp"
#include "lab/passes.hpp"
#include "lab/scene.hpp"

#include <warpshadow/frustum.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace lab {

/// How the maps of a point light are drawn (Navratil et al. 2012, §4).
struct omni_way {
    bool hemispheres = false;  ///< two paraboloids instead of six faces
    bool cull_maps = false;    ///< leave out faces or hemispheres that no view meets
    bool cull_objects = false; ///< draw each object only where the light may see it
    bool layered = false;      ///< one pass, a geometry shader sends triangles to the maps
};

/// The axis of the front hemisphere in the world, of all lights.
inline constexpr glm::dvec3 front_axis{0.0, 0.0, 1.0};

/// Maps of all that a point light reaches; with `cull_maps` only those that one of the cameras
/// needs are used.
light_maps omni_maps(const scene& world, std::span<const warpshadow::frustum<double>> cameras,
                     const light_view& light, const omni_way& way);

/// Draws the maps of point lights, and tests shadows against paraboloids.
class omni_passes {
  public:
    explicit omni_passes(passes& gpu);

    /// Draws the maps in use. Expects `passes::use` to have been called for this light.
    void draw(map_resources& maps, light_maps& chosen, const light_view& light,
              const omni_way& way);
    /// Draws a hemisphere's map with tables, after these were built. `count` as in
    /// `hemisphere_raster::draw`.
    void draw_warped(map_resources& maps, std::size_t side, const light_view& light, bool count);
    /// Shadow test of all samples in use; for faces of a cube see `passes::test_shadows`.
    void test_hemispheres(const map_resources& maps, const light_maps& chosen,
                          const light_view& light, bool warped);

    [[nodiscard]] const scene_objects& objects() const { return objects_; }
    [[nodiscard]] hemisphere_raster& raster() { return raster_; }
    [[nodiscard]] const hemisphere_raster& raster() const { return raster_; }
    /// Triangles given to the device by the last `draw`, once per map or, layered, once in all.
    [[nodiscard]] std::size_t triangles() const { return triangles_; }
    /// Microseconds that the last `draw` spent on sorting objects to maps.
    [[nodiscard]] double culling_us() const { return culling_us_; }
    /// Milliseconds that cutting the scene took for the maps drawn last, once per light and size.
    [[nodiscard]] double cutting_ms() const { return cutting_ms_; }
    /// Bytes of the cut scene drawn last, 0 for faces.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

  private:
    /// A cut scene on the GPU.
    struct cut_scene {
        glm::dvec3 light{0.0};
        hemisphere_frame frame{};
        gl::buffer vertices;
        gl::vertex_array array;
        std::vector<triangle_range> ranges;
        warpshadow::status flags = warpshadow::status::ok;
        double ms = 0.0;
    };

    const cut_scene& cut_for(const light_view& light, int map_size);
    /// Per object the maps that it is drawn to.
    void sort_objects(const light_maps& chosen, const light_view& light, const omni_way& way,
                      int map_size);
    void draw_faces(map_resources& maps, const light_maps& chosen);
    /// The objects of these ranges that a map wants, for one indirect draw of all layers.
    void write_masks(const std::vector<triangle_range>& ranges, bool indexed);
    /// Points an attribute of the vertex array in use to the masks, one per object.
    void bind_masks(GLuint index) const;
    void draw_face_layers(map_resources& maps);
    void draw_hemispheres(map_resources& maps, const light_maps& chosen, const cut_scene& scene);
    static void set_frame(const gl::program& program, const map_resources& maps,
                          const cut_scene& scene);
    void draw_hemisphere_layers(map_resources& maps, const cut_scene& scene);
    /// Ranges of the objects that go to a map, joined where they touch.
    void collect(const std::vector<triangle_range>& ranges, std::size_t map);

    passes& gpu_;
    scene_objects objects_;
    hemisphere_raster raster_;
    gl::program draw_face_, draw_layers_, draw_hemisphere_, draw_halves_, test_hemispheres_,
        test_warped_;
    gl::buffer indices_, masks_on_device_, commands_;
    gl::vertex_array array_;
    std::map<int, cut_scene> cut_scenes_; ///< by the size of their maps
    std::vector<std::uint8_t> masks_;
    std::vector<triangle_range> wanted_;
    std::vector<GLsizei> counts_;
    std::vector<GLint> firsts_;
    std::vector<const void*> offsets_;
    GLsizei commands_in_use_ = 0;
    std::size_t triangles_ = 0;
    double culling_us_ = 0.0;
    double cutting_ms_ = 0.0;
    std::size_t bytes_ = 0;
};

} // namespace lab
