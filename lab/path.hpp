// A camera that moves, and what its frames show.
#pragma once

#include "lab/measure.hpp"
#include "lab/methods.hpp"
#include "lab/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/// A way of moving that --path knows by name.
struct path_summary {
    std::string_view name;
    std::string_view about;
};
std::span<const path_summary> builtin_paths();

/// Cameras of all frames.
///
/// `name`: one of `builtin_paths`, or a file with one `ex,ey,ez,tx,ty,tz,fov` per line: key frames
/// through which the camera moves smoothly. `start`: where a built-in path begins.
/// `frames`: 2 or more.
/// @throws bad_input when the file is missing or a line of it is no camera.
std::vector<camera_view> camera_path(const std::string& name, const scene& world,
                                     const camera_view& start, int frames);

/// How often the shadow of a place on a surface changes from one frame to the next although
/// nothing but the camera moves.
///
/// Counted are the samples of the frame before that `compare` counts and that are seen in this
/// frame too. A share of them, or nothing when there are none.
/// @param before     samples of the frame before
/// @param shadowed   their answers in that frame
/// @param again      their answers with the maps of this frame
/// @param now        samples of this frame
/// @param camera_now camera of this frame
std::optional<double> flip_ratio(const g_buffer_samples& before,
                                 std::span<const std::uint8_t> shadowed,
                                 std::span<const std::uint8_t> again, const g_buffer_samples& now,
                                 const glm::mat4& camera_now);

/// What one method did in one frame.
struct path_frame {
    std::optional<double> wrong_ratio;
    std::optional<double> flip_ratio; ///< nothing in the first frame
    double angle;                     ///< of the map to the light's axes, radians
    double frame_ms;
    double shadow_map_ms; ///< of the passes between the G-buffer and the shadow test
    int maps;
};

/// One method at one map size along one path.
struct path_record {
    std::string scene;
    std::string camera;
    std::string light;
    std::string path;
    std::string method;
    int map = 0;
    std::vector<path_frame> frames;
};

/// Means over the frames that have a value, in the units of `path_frame`.
struct path_means {
    std::optional<double> wrong_ratio;
    std::optional<double> flip_ratio;
    double largest_turn;  ///< of the map between two frames, radians
    double frame_ms;      ///< median
    double shadow_map_ms; ///< median
    double maps;
};
path_means means_of(const path_record& record);

} // namespace lab
