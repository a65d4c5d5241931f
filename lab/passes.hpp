// The passes that shadow methods are made of, on the GPU.
#pragma once

#include "gl/mesh.hpp"
#include "gl/objects.hpp"
#include "gl/shader_source.hpp"
#include "gl/timer.hpp"
#include "lab/light_maps.hpp"
#include "lab/scene.hpp"
#include "lab/warp_options.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lab {

/// What the camera sees: position and face normal per pixel.
struct g_buffer {
    explicit g_buffer(glm::ivec2 view);
    gl::texture position, normal, depth;
    gl::framebuffer target;
};

/// The internal format of a table's texture, and its name in a shader's image.
GLenum internal_format(table_format format);
std::string image_format(table_format format);

/// Nodes of a table of either format.
std::vector<float> nodes_of(const gl::texture& table);

/// Textures and buffers of all maps of one method; their size follows the maps.
struct map_resources {
    /// `cells` of the tables along a side, 0 for maps without; `functions` of either axis.
    map_resources(int size, std::size_t maps, int cells, int functions,
                  table_format format = table_format::r32f);

    /// Count map and tables of one map.
    struct tables {
        tables(int size, int cells, int functions, table_format format);
        gl::texture counts, rows, columns, centres;
        gl::texture classes, lines;       ///< where a method wants them, see lab/tables.cpp
        std::array<gl::texture, 2> boxes; ///< sums between the boxes of a window that is no box
        gl::texture common;               ///< the function that all rows share, for the shear limit
        std::vector<std::uint32_t> first_counts, second_counts; ///< read back where wanted
    };

    int size;
    gl::texture depth; ///< one layer per map
    std::vector<gl::framebuffer> targets;
    gl::framebuffer all_layers;      ///< of all maps, for layered drawing
    std::vector<gl::buffer> desired; ///< bounds of the desired view per map
    std::vector<tables> warps;       ///< per map, or none
    [[nodiscard]] std::size_t bytes() const;
};

/// One scene on the GPU, and the programs that draw its shadows.
class passes {
  public:
    passes(const scene& scene_to_show, glm::ivec2 view_size);

    /// Times passes from now on, or no more with null.
    void time_into(std::map<std::string, std::vector<double>>* times);
    /// Names of the timed passes in the order of their first run.
    [[nodiscard]] const std::vector<std::string>& timed() const { return order_; }

    /// Runs one step, timed if that is asked for; several runs in a frame add up.
    template <typename Step> void timed_pass(const char* name, Step step) {
        if (times_ == nullptr) {
            step();
            return;
        }
        watch_.start();
        step();
        note(name, watch_.stop());
    }
    /// A new frame begins: times of its passes are kept apart from the last one's.
    void begin_frame();

    void draw_view(g_buffer& seen, const glm::mat4& camera, glm::vec3 eye);
    /// Makes these samples and this light the ones that all later passes see.
    void use(const g_buffer& seen, const light_maps& maps, const warpshadow::light<double>& light);
    void use(const g_buffer& seen);
    /// Crops one map to its lit view samples.
    void crop_to_desired_view(map_resources& maps, std::size_t index);
    /// Least and largest view depth of the lit samples; nothing when there are none.
    std::optional<glm::dvec2> depth_range(const warpshadow::frustum<double>& camera);
    /// Histogram of the lit samples of one map, `size` cells along a side.
    std::vector<std::uint32_t> histogram(std::size_t index, int size);
    /// Puts a matrix before that of a map, as it is after a crop.
    void warp_map(std::size_t index, const glm::dmat4& warp);
    /// Where the centres of the texels of one map with tables lie before the warp.
    void find_centres(map_resources& maps, std::size_t index);
    /// Makes a map the one that the next passes are about.
    void select_map(std::size_t index);
    void draw_plain_map(map_resources& maps, std::size_t index) {
        draw_plain_map(maps, index, index);
    }
    /// Draws one map with the matrix of another.
    void draw_plain_map(map_resources& maps, std::size_t index, std::size_t matrix);
    /// Shadow test of all samples in use.
    void test_shadows(map_resources& maps, const light_maps& chosen, bool warped);
    /// Only the depths of one map, into a texture of no array; for pictures.
    std::vector<float> draw_depths(const glm::dmat4& matrix, int size);

    /// The matrix of a map after a crop on the device.
    [[nodiscard]] glm::mat4 matrix_in_use(std::size_t index) const;
    [[nodiscard]] std::vector<std::uint8_t> shadowed() const;

    /// What other passes over the same scene and view need.
    [[nodiscard]] gl::program link(const char* vertex, const char* fragment,
                                   const std::vector<std::string>& defines = {}) const;
    [[nodiscard]] gl::program compute(const char* file,
                                      const std::vector<std::string>& defines = {}) const;
    /// Tells a program where the G-buffer and the shadow map are bound.
    static void set_units(const gl::program& program);
    static void bind_depth(const map_resources& maps);
    static void bind_tables(const map_resources& maps, std::size_t index);
    /// Makes the triangles of the scene those of shaders/triangle_corners.glsl.
    void bind_triangles() const;
    [[nodiscard]] const gl::mesh& mesh() const { return mesh_; }
    [[nodiscard]] const gl::buffer& face_normal_buffer() const { return normals_; }
    [[nodiscard]] gl::texture& mask() { return mask_; }

    [[nodiscard]] gl::stopwatch& watch() { return watch_; }
    [[nodiscard]] const scene& world() const { return world_; }
    [[nodiscard]] glm::ivec2 view() const { return view_; }

  private:
    [[nodiscard]] std::vector<glm::vec4> face_normals() const;
    void note(const char* name, double ms);
    void write_map(std::size_t index, const glm::dmat4& matrix);

    const scene& world_;
    glm::ivec2 view_;
    gl::shader_library library_;
    gl::mesh mesh_;
    gl::buffer normals_;
    gl::buffer_texture positions_view_, indices_view_, normals_view_;
    gl::texture mask_;
    gl::buffer light_buffer_, depths_;
    gl::texture histogram_;
    gl::program draw_g_buffer_, draw_plain_;
    gl::program find_desired_view_, find_depth_range_, crop_, count_histogram_, unwarp_centres_;
    gl::program test_plain_, test_warped_;
    gl::stopwatch watch_;
    precision at_ = precision::in_double; ///< of matrices that are made of those in use
    std::map<std::string, std::vector<double>>* times_ = nullptr;
    std::map<std::string, double> frame_times_;
    std::vector<std::string> order_;
};

} // namespace lab
