#include "lab/path.hpp"

#include "lab/options.hpp"
#include "lab/statistics.hpp"
#include "lab/view_arguments.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace lab {
namespace {

constexpr std::array<path_summary, 5> paths{{
    {"yaw", "turns on the spot, 0.1 degrees a frame"},
    {"forward", "moves towards its target, a thousandth of the distance a frame"},
    {"strafe", "moves to its right, a thousandth of the distance to its target a frame"},
    {"orbit", "turns around its target, 0.1 degrees a frame"},
    {"walk", "moves through the scene's cameras in turn"},
}};

constexpr double step_angle = std::numbers::pi / 1800.0;
constexpr double step_share = 1e-3;

glm::dvec3 turned(glm::dvec3 v, double angle) {
    return glm::dvec3(glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0.0, 1.0, 0.0)) *
                      glm::dvec4(v, 0.0));
}

/// Catmull-Rom: through all values, with a continuous direction.
template <typename T> T through(const T& a, const T& b, const T& c, const T& d, double t) {
    return 0.5 * (2.0 * b + t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) +
                                                t * (3.0 * (b - c) + d - a))));
}

std::vector<camera_view> through_keys(const std::vector<camera_view>& keys, int frames) {
    std::vector<camera_view> result;
    const int spans = static_cast<int>(keys.size()) - 1;
    for (int i = 0; i < frames; ++i) {
        const double at = static_cast<double>(i) / (frames - 1) * spans;
        const int span = std::min(static_cast<int>(at), spans - 1);
        const auto key = [&](int k) -> const camera_view& {
            return keys[static_cast<std::size_t>(std::clamp(k, 0, spans))];
        };
        const camera_view& a = key(span - 1);
        const camera_view& b = key(span);
        const camera_view& c = key(span + 1);
        const camera_view& d = key(span + 2);
        const double t = at - span;
        camera_view camera{b.label, through(a.eye, b.eye, c.eye, d.eye, t),
                           through(a.target, b.target, c.target, d.target, t),
                           glm::mix(b.fov_y, c.fov_y, t)};
        if (camera.eye == camera.target) {
            camera.target = camera.eye + (b.target - b.eye);
        }
        result.push_back(camera);
    }
    return result;
}

std::vector<camera_view> read_keys(const std::string& file, const scene& world) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
        std::string names;
        for (const path_summary& each : paths) {
            names += std::string(each.name) + ", ";
        }
        throw bad_input("--path wants " + names + "or a file of cameras, not '" + file + "'");
    }
    std::ifstream in(file);
    std::vector<camera_view> keys;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        if (line.empty() || line.front() == '#') {
            continue;
        }
        try {
            keys.push_back(resolve_camera(line, world));
        } catch (const bad_input& problem) {
            throw bad_input(file + ", line " + std::to_string(number) + ": " + problem.what());
        }
    }
    if (keys.size() < 2) {
        throw bad_input("--path " + file + ": a path wants two cameras or more");
    }
    return keys;
}

} // namespace

std::span<const path_summary> builtin_paths() {
    return paths;
}

std::vector<camera_view> camera_path(const std::string& name, const scene& world,
                                     const camera_view& start, int frames) {
    const bool built_in = std::any_of(paths.begin(), paths.end(),
                                      [&](const path_summary& each) { return each.name == name; });
    if (!built_in) {
        return through_keys(read_keys(name, world), frames);
    }
    if (name == "walk" && world.cameras.size() > 1) {
        return through_keys(world.cameras, frames);
    }
    if (name == "walk") {
        throw bad_input("--path walk: scene '" + world.name + "' has one camera and no way to go");
    }
    std::vector<camera_view> result;
    const glm::dvec3 ahead = start.target - start.eye;
    const glm::dvec3 right = glm::cross(glm::normalize(ahead), glm::dvec3(0.0, 1.0, 0.0));
    for (int i = 0; i < frames; ++i) {
        camera_view camera = start;
        if (name == "yaw") {
            camera.target = start.eye + turned(ahead, i * step_angle);
        } else if (name == "orbit") {
            camera.eye = start.target - turned(ahead, i * step_angle);
        } else {
            const glm::dvec3 moved =
                i * step_share * (name == "forward" ? ahead : glm::length(ahead) * right);
            camera.eye += moved;
            camera.target += moved;
        }
        result.push_back(camera);
    }
    return result;
}

std::optional<double> flip_ratio(const g_buffer_samples& before,
                                 std::span<const std::uint8_t> shadowed,
                                 std::span<const std::uint8_t> again, const g_buffer_samples& now,
                                 const glm::mat4& camera_now) {
    std::size_t counted = 0;
    std::size_t flips = 0;
    for (std::size_t i = 0; i < before.position.size(); ++i) {
        if (before.position[i].w <= 0.5f || !(before.n_dot_l[i] > counted_n_dot_l)) {
            continue;
        }
        const glm::vec3 p(before.position[i]);
        const glm::vec4 clip = camera_now * glm::vec4(p, 1.0f);
        if (!(clip.w > 0.0f)) {
            continue;
        }
        const glm::vec2 pixel = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(now.size);
        if (!(pixel.x >= 0.0f && pixel.y >= 0.0f && pixel.x < static_cast<float>(now.size.x) &&
              pixel.y < static_cast<float>(now.size.y))) {
            continue;
        }
        const std::size_t at =
            static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(now.size.x) +
            static_cast<std::size_t>(pixel.x);
        // seen again: this frame's surface at that pixel is the same plane
        const float away = std::abs(glm::dot(before.normal[i], glm::vec3(now.position[at]) - p));
        if (now.position[at].w <= 0.5f || away > 1e-3f * clip.w) {
            continue;
        }
        ++counted;
        flips += static_cast<std::size_t>((shadowed[i] != 0) != (again[i] != 0));
    }
    if (counted == 0) {
        return std::nullopt;
    }
    return static_cast<double>(flips) / static_cast<double>(counted);
}

path_means means_of(const path_record& record) {
    path_means result{};
    double wrong = 0.0;
    double flips = 0.0;
    int wrong_frames = 0;
    int flip_frames = 0;
    std::vector<double> times;
    std::vector<double> shadow_map_times;
    for (std::size_t i = 0; i < record.frames.size(); ++i) {
        const path_frame& frame = record.frames[i];
        wrong += frame.wrong_ratio.value_or(0.0);
        flips += frame.flip_ratio.value_or(0.0);
        wrong_frames += frame.wrong_ratio ? 1 : 0;
        flip_frames += frame.flip_ratio ? 1 : 0;
        times.push_back(frame.frame_ms);
        shadow_map_times.push_back(frame.shadow_map_ms);
        result.maps += static_cast<double>(frame.maps) / static_cast<double>(record.frames.size());
        if (i > 0) {
            // a quarter turn maps the sides of a square map to each other
            const double turn =
                std::remainder(frame.angle - record.frames[i - 1].angle, 0.5 * std::numbers::pi);
            result.largest_turn = std::max(result.largest_turn, std::abs(turn));
        }
    }
    if (wrong_frames > 0) {
        result.wrong_ratio = wrong / wrong_frames;
    }
    if (flip_frames > 0) {
        result.flip_ratio = flips / flip_frames;
    }
    result.frame_ms = median(times);
    result.shadow_map_ms = median(shadow_map_times);
    return result;
}

} // namespace lab
