// The scene of passes_bench: hills with boxes on them, 261,000 triangles.
#pragma once

#include <warpshadow/frustum.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace passes_scene {

struct scene {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<glm::vec4> normals; ///< per triangle
    warpshadow::box3<double> box;
};

inline float height(float x, float z) {
    return 4.0f * std::sin(x * 0.05f) * std::cos(z * 0.04f) +
           0.6f * std::sin(x * 0.31f + z * 0.23f);
}

inline void add_box(scene& to, glm::vec3 lo, glm::vec3 hi) {
    const auto first = static_cast<unsigned>(to.positions.size());
    for (int i = 0; i < 8; ++i) {
        to.positions.emplace_back((i & 1) != 0 ? hi.x : lo.x, (i & 2) != 0 ? hi.y : lo.y,
                                  (i & 4) != 0 ? hi.z : lo.z);
    }
    constexpr std::array<std::array<unsigned, 4>, 6> faces{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (const auto& f : faces) {
        to.triangles.emplace_back(first + f[0], first + f[1], first + f[2]);
        to.triangles.emplace_back(first + f[0], first + f[2], first + f[3]);
    }
}

/// Hills of 330 × 330 × 2 triangles with 3,600 boxes on them.
inline scene make_scene() {
    scene result;
    constexpr unsigned cells = 330;
    constexpr float extent = 200.0f;
    for (unsigned j = 0; j <= cells; ++j) {
        for (unsigned i = 0; i <= cells; ++i) {
            const float x = extent * (static_cast<float>(i) / cells - 0.5f);
            const float z = extent * (static_cast<float>(j) / cells - 0.5f);
            result.positions.emplace_back(x, height(x, z), z);
        }
    }
    for (unsigned j = 0; j < cells; ++j) {
        for (unsigned i = 0; i < cells; ++i) {
            const unsigned a = j * (cells + 1) + i;
            const unsigned b = a + cells + 1;
            result.triangles.emplace_back(a, b, b + 1);
            result.triangles.emplace_back(a, b + 1, a + 1);
        }
    }
    std::mt19937 random(7);
    std::uniform_real_distribution<float> anywhere(-0.5f * extent, 0.5f * extent);
    std::uniform_real_distribution<float> size(0.1f, 0.7f);
    for (int i = 0; i < 3600; ++i) {
        const float x = anywhere(random);
        const float z = anywhere(random);
        const float w = size(random);
        const float h = 4.0f * size(random);
        const float y = height(x, z);
        add_box(result, {x - w, y - 1.0f, z - w}, {x + w, y + h, z + w});
    }
    glm::vec3 lo(std::numeric_limits<float>::max());
    glm::vec3 hi = -lo;
    for (const glm::vec3& p : result.positions) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    result.box = {glm::dvec3(lo), glm::dvec3(hi)};
    for (const glm::uvec3& t : result.triangles) {
        const glm::vec3 a = result.positions[t.x];
        result.normals.emplace_back(
            glm::normalize(glm::cross(result.positions[t.y] - a, result.positions[t.z] - a)), 0.0f);
    }
    return result;
}

} // namespace passes_scene
