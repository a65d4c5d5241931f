// Pictures of what a method did, and PNG files of them.
#pragma once

#include "lab/methods.hpp"
#include "lab/scene.hpp"
#include "lab/truth.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace lab {

/// 8-bit sRGB, row 0 at the top.
struct picture {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;
};

/// Shades one view with the shadows of any method; holds what all of them share.
class shader {
  public:
    shader(const scene& world, const ray_tracer& rays, const g_buffer_samples& samples,
           const camera_view& camera, const light_view& light);

    /// The view with these shadows.
    [[nodiscard]] picture shade(std::span<const std::uint8_t> shadowed) const;
    /// The view with these shares of the light, 0 to 1.
    [[nodiscard]] picture shade(std::span<const float> light) const;

  private:
    template <typename Light> [[nodiscard]] picture shade_with(Light light) const;

    glm::ivec2 size_;
    std::vector<glm::vec3> dark_;  ///< linear colour without the light
    std::vector<glm::vec3> light_; ///< what the light adds
};

/// Paints the samples marked in `wrong` (row 0 at the bottom) red.
void paint_red(picture& target, std::span<const std::uint8_t> wrong);

/// A part of a picture, each pixel repeated `zoom` times.
picture cropped(const picture& whole, glm::ivec2 corner, glm::ivec2 size, int zoom);

/// Upper left corner of the window in which the marks of the sets differ most.
glm::ivec2 window_of_difference(std::span<const std::span<const std::uint8_t>> sets,
                                glm::ivec2 view, glm::ivec2 window);

/// A PNG file in memory and what it holds.
struct png_file {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> bytes;
};

/// Encodes a picture; equal pictures give equal bytes.
png_file png_of(const picture& source);

} // namespace lab
