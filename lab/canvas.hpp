// A square picture to draw on.
#pragma once

#include "lab/methods.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace lab {

/// Pixels of a named picture; row 0 of `y` is the bottom, where pictures start at the top.
struct canvas {
    canvas(std::string name, int size)
        : picture{std::move(name), size, size,
                  std::vector<std::uint8_t>(3 * static_cast<std::size_t>(size) *
                                            static_cast<std::size_t>(size))} {}

    /// Colours from 0 to 1.
    void set(int x, int y, glm::vec3 colour) {
        const std::size_t first = 3 * (static_cast<std::size_t>(picture.height - 1 - y) *
                                           static_cast<std::size_t>(picture.width) +
                                       static_cast<std::size_t>(x));
        for (std::size_t i = 0; i < 3; ++i) {
            const float value = std::clamp(colour[static_cast<glm::length_t>(i)], 0.0f, 1.0f);
            picture.rgb[first + i] = static_cast<std::uint8_t>(value * 255.0f + 0.5f);
        }
    }

    /// A line two pixels wide between positions of the unit square; what lies outside is left out.
    void line(glm::dvec2 from, glm::dvec2 to, glm::vec3 colour) {
        const double size = picture.width;
        const double length = size * std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
        // far beyond the border there is nothing to see
        const int steps = static_cast<int>(std::clamp(2.0 * length, 1.0, 64.0 * size));
        for (int i = 0; i <= steps; ++i) {
            const glm::dvec2 p = glm::mix(from, to, static_cast<double>(i) / steps) * size - 0.5;
            const int x = static_cast<int>(std::floor(p.x));
            const int y = static_cast<int>(std::floor(p.y));
            for (const glm::ivec2 at : {glm::ivec2(x, y), glm::ivec2(x + 1, y),
                                        glm::ivec2(x, y + 1), glm::ivec2(x + 1, y + 1)}) {
                if (at.x >= 0 && at.y >= 0 && at.x < picture.width && at.y < picture.height) {
                    set(at.x, at.y, colour);
                }
            }
        }
    }

    named_picture picture;
};

} // namespace lab
