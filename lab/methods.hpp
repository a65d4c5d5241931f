// Shadow methods on the GPU, as the lab runs and measures them.
#pragma once

#include "lab/bias.hpp"
#include "lab/light_maps.hpp"
#include "lab/scene.hpp"
#include "lab/warp_options.hpp"
#include "lab/warped_raster.hpp"

#include <warpshadow/metric.hpp>

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lab {

/// One measurement that is asked for.
struct view_request {
    camera_view camera;
    light_view light;
    int map_size;                                     ///< texels along each side of the shadow map
    unsigned seed;                                    ///< of anything random
    int repeat;                                       ///< frames timed after the warm-up
    std::optional<bias_choice> bias = std::nullopt;   ///< to be measured; else the plane's
    filter_choice filter = {};                        ///< for pictures
    raster_choice raster = {};                        ///< of maps with tables
    const ray_tracer* rays = nullptr;                 ///< for maps without a rasteriser
    warp_wishes tables = {};                          ///< for methods with warp tables
    const std::vector<std::uint8_t>* truth = nullptr; ///< for methods that are told it
    precision set_up = precision::in_double;          ///< of the steps on the host
    bool details = true;     ///< pictures that explain the method, and times pass by pass
    bool keep_depth = false; ///< of the maps, in the result
};

/// View samples, row 0 at the bottom of the picture.
struct g_buffer_samples {
    glm::ivec2 size;
    std::vector<glm::vec4> position; ///< world; w = 1 where a surface is seen, 0 for background
    std::vector<glm::vec3> normal;   ///< of the face, unit length, towards the viewer
    std::vector<float> n_dot_l; ///< 0 or less where the light does not reach (also outside a cone)
    double draw_ms;             ///< time of drawing the G-buffer alone
};

/// Time of one pass, median over the frames.
struct pass_time {
    std::string pass;
    double ms;
};

/// A picture that explains a method (importance map, warp grid), row 0 at the top.
struct named_picture {
    std::string name;
    int width;
    int height;
    std::vector<std::uint8_t> rgb;
};

/// Pixels that a texel covers, over the lit-facing samples: Lloyd's m, see warpshadow/metric.hpp.
struct texel_metric {
    warpshadow::metric_summary<double> on_receivers;
    warpshadow::metric_summary<double> facing; ///< without the slope of the surface
    /// Rosen's maximum effective resolution: texels along u and v of the maps without tables that
    /// would be as fine as the finest part of these.
    glm::dvec2 finest{0.0};
};

/// What a method did.
struct method_result {
    std::vector<std::uint8_t> shadowed; ///< per view sample: 1 = in shadow
    std::vector<double> frame_ms;       ///< of every frame that was timed, see `add_times`
    double frame_ms_median;
    double frame_ms_min;
    double frame_ms_max;
    std::vector<pass_time> passes;
    std::vector<std::pair<std::string, double>> cpu_setup_us;
    std::size_t bytes;     ///< of GPU memory that the method needs beyond mesh and G-buffer
    std::size_t triangles; ///< rasterised into the shadow maps
    int maps;              ///< shadow maps drawn
    double angle;          ///< of the map's sides to the axes of the light, radians
    std::optional<double> weakened;     ///< share of the identity in the last map's tables
    std::optional<double> mean_side;    ///< predicted side of a texel, to one without tables
    std::vector<std::string> status;    ///< names of the guards that fired
    std::optional<texel_metric> texels; ///< of methods whose maps have a matrix
    std::vector<named_picture> pictures;
    std::vector<bias_sample> biases; ///< per view sample, where a bias was asked for
    std::vector<float> light;        ///< share per view sample, where a filter was asked for
    std::vector<float> depth;        ///< of the maps, one after the other, where asked for
};

/// Adds times of frames, and brings their median and ends up to date.
void add_times(method_result& result, std::span<const double> frame_ms);

/// One frame of a moving camera.
struct moving_frame {
    std::vector<std::uint8_t> shadowed; ///< per view sample, as in `method_result`
    /// The answers of this frame's maps to the samples of the frame before; empty in the first.
    std::vector<std::uint8_t> shadowed_before;
    double frame_ms;      ///< one frame, without warm-up
    double shadow_map_ms; ///< of the passes between the G-buffer and the shadow test, run by itself
    int maps;
    double angle;
};

/// What a method keeps while a camera moves.
struct method_memory {
    light_memory light;
};

/// What a method draws again and again for a camera that stands still, ready for the next frame.
struct standing_view;

/// Bytes on the device that it holds.
std::size_t bytes_of(const standing_view& view);

/// Holds one scene on the GPU and renders its G-buffer and shadows.
class renderer {
  public:
    renderer(const scene& world, glm::ivec2 view);
    ~renderer();
    renderer(const renderer&) = delete;
    renderer& operator=(const renderer&) = delete;

    g_buffer_samples samples(const camera_view& camera, const light_view& light);

    /// Runs a method other than "raytraced", which needs no GPU.
    /// @param[out] kept where not null: what `more_frames` goes on with; null for "sv"
    method_result run(std::string_view method, const view_request& request,
                      std::shared_ptr<standing_view>* kept = nullptr);

    /// Times of as many frames more as the request repeats, and nothing else: `run` in rounds lets
    /// what drifts on a machine hit all methods alike.
    /// @param kept of a `run` of the same request; null: all is made again, and warmed up
    std::vector<double> more_frames(std::string_view method, const view_request& request,
                                    standing_view* kept = nullptr);

    /// The next frame of a camera that moves; `repeat` does not count. The samples of the frame
    /// before are those of the last `remember_view`.
    moving_frame next_frame(std::string_view method, const view_request& request,
                            method_memory& memory);

    /// Keeps the view of a camera as the frame before the next; nothing: there was none.
    void remember_view(const std::optional<camera_view>& camera);

  private:
    struct state;
    std::unique_ptr<state> state_;
};

} // namespace lab
