#include "lab/scene_builder.hpp"

#include <cmath>
#include <numbers>

namespace lab {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

void add_column(scene_builder& b, glm::vec3 foot, float height, float radius) {
    const auto y = [&](float h) { return foot + glm::vec3(0.0f, h, 0.0f); };
    b.box(foot - glm::vec3(1.5f * radius, 0.0f, 1.5f * radius),
          foot + glm::vec3(1.5f * radius, 0.22f, 1.5f * radius));
    b.ring(y(0.3f), {0, 1, 0}, 1.12f * radius, 0.11f, 28, 6);
    const int sides = 28;
    const int drums = 6;
    const auto girth = [&](int i) {
        const float t = static_cast<float>(i) / static_cast<float>(drums);
        return radius * (1.0f - 0.16f * t * t); // entasis
    };
    const float top = height - 0.55f;
    for (int i = 0; i < drums; ++i) {
        const float from =
            0.22f + (top - 0.22f) * static_cast<float>(i) / static_cast<float>(drums);
        const float to =
            0.22f + (top - 0.22f) * static_cast<float>(i + 1) / static_cast<float>(drums);
        b.tube(y(from), y(to), girth(i), girth(i + 1), sides, false);
    }
    b.ring(y(top - 0.08f), {0, 1, 0}, 0.9f * radius, 0.06f, 28, 6);
    b.tube(y(top), y(top + 0.3f), girth(drums), 1.35f * radius, sides, false);
    b.box(y(top + 0.3f) - glm::vec3(1.45f * radius, 0.0f, 1.45f * radius),
          y(height) + glm::vec3(1.45f * radius, 0.0f, 1.45f * radius));
}

/// A wall with a round arch, between x0 and x1, from y0 (springing) up to y1.
void add_arch(scene_builder& b, float x0, float x1, float y0, float y1, float z, float depth,
              float pier) {
    const float r = 0.5f * (x1 - x0) - pier;
    const float mid = 0.5f * (x0 + x1);
    const int segments = 20;
    const float front = z - 0.5f * depth;
    const float back = z + 0.5f * depth;
    const auto rim = [&](int i) {
        const float a = pi * static_cast<float>(i) / static_cast<float>(segments);
        return glm::vec2(mid - r * std::cos(a), y0 + r * std::sin(a));
    };
    for (int i = 0; i < segments; ++i) {
        const glm::vec2 a = rim(i);
        const glm::vec2 c = rim(i + 1);
        for (const float side : {front, back}) {
            b.quad({a.x, a.y, side}, {c.x, c.y, side}, {c.x, y1, side}, {a.x, y1, side});
        }
        b.quad({a.x, a.y, front}, {c.x, c.y, front}, {c.x, c.y, back}, {a.x, a.y, back});
    }
    b.box({x0, y0, front}, {x0 + pier, y1, back});
    b.box({x1 - pier, y0, front}, {x1, y1, back});
}

void add_baluster(scene_builder& b, glm::vec3 foot) {
    const float profile[7][2] = {{0.0f, 0.07f},  {0.12f, 0.07f}, {0.2f, 0.045f}, {0.38f, 0.085f},
                                 {0.6f, 0.035f}, {0.68f, 0.06f}, {0.78f, 0.06f}};
    for (int i = 0; i < 6; ++i) {
        b.tube(foot + glm::vec3(0, profile[i][0], 0), foot + glm::vec3(0, profile[i + 1][0], 0),
               profile[i][1], profile[i + 1][1], 10, false);
    }
}

void add_figure(scene_builder& b, glm::vec3 foot, float turn) {
    b.box(foot - glm::vec3(0.55f, 0.0f, 0.55f), foot + glm::vec3(0.55f, 1.1f, 0.55f));
    b.box(foot + glm::vec3(-0.65f, 1.1f, -0.65f), foot + glm::vec3(0.65f, 1.22f, 0.65f));
    const glm::vec3 hip = foot + glm::vec3(0.0f, 2.1f, 0.0f);
    const glm::vec3 side(std::cos(turn), 0.0f, std::sin(turn));
    b.tube(foot + glm::vec3(0, 1.22f, 0), hip, 0.36f, 0.22f, 20);
    b.ellipsoid(hip + glm::vec3(0, 0.42f, 0), {0.27f, 0.5f, 0.22f}, 20, 0.06f);
    b.ellipsoid(hip + glm::vec3(0, 1.08f, 0), {0.15f, 0.19f, 0.16f}, 16);
    const glm::vec3 shoulder = hip + glm::vec3(0, 0.72f, 0);
    b.tube(shoulder + 0.22f * side, shoulder + 0.48f * side + glm::vec3(0, -0.45f, 0), 0.08f, 0.06f,
           10);
    b.tube(shoulder - 0.22f * side, shoulder - 0.5f * side + glm::vec3(0, 0.4f, 0), 0.08f, 0.06f,
           10);
    b.tube(shoulder - 0.5f * side + glm::vec3(0, -1.5f, 0),
           shoulder - 0.5f * side + glm::vec3(0, 1.1f, 0), 0.018f, 0.018f, 6); // a staff
}

} // namespace

scene build_colonnade(unsigned seed) {
    scene_builder b("colonnade", seed);
    const std::uint8_t floor = b.add_material(0xcfc4ae, 0.12f);
    const std::uint8_t stone = b.add_material(0xe3d8c2, 0.08f);
    const std::uint8_t wall = b.add_material(0xd3b48c, 0.12f);
    const std::uint8_t wood = b.add_material(0x8a6240, 0.2f);
    const std::uint8_t marble = b.add_material(0xf0ede6, 0.04f);
    const std::uint8_t pot = b.add_material(0xa8613f, 0.15f);
    const std::uint8_t leaf = b.add_material(0x55753a, 0.35f);

    // a court of two triangles between two aisles: few huge triangles below fine casters
    b.use(floor);
    b.quad({-34, 0, -13}, {34, 0, -13}, {34, 0, 13}, {-34, 0, 13});
    b.use(wall);
    const float back = 11.5f;
    b.box({-34, 0, back}, {34, 7.6f, back + 0.6f});
    b.box({-34, 0, -back - 0.6f}, {34, 7.6f, -back});
    b.box({-34.6f, 0, -back - 0.6f}, {-34, 7.6f, back + 0.6f});

    const float row = 5.8f;
    const float bay = 5.0f;
    const float spring = 4.9f;
    for (const float side : {-1.0f, 1.0f}) {
        const float z = side * row;
        for (int i = -6; i <= 6; ++i) {
            b.use(stone);
            const float x = bay * static_cast<float>(i);
            add_column(b, {x, 0, z}, spring, 0.42f);
            if (i == 6) {
                continue;
            }
            add_arch(b, x, x + bay, spring, 7.6f, z, 0.9f, 0.45f);
            if (i == -1 || i == 0 || i == 3) {
                continue;
            }
            b.use(marble);
            const float from = x + 0.75f;
            const float to = x + bay - 0.75f;
            b.box({from, 0, z - 0.12f}, {to, 0.1f, z + 0.12f});
            b.box({from, 0.88f, z - 0.13f}, {to, 1.0f, z + 0.13f});
            for (float s = from + 0.18f; s < to - 0.1f; s += 0.27f) {
                add_baluster(b, {s, 0.1f, z});
            }
        }
        b.use(stone);
        const float inner = z - side * 0.75f;
        b.box({-30.6f, 7.6f, std::min(z - 0.6f, inner)}, {30.6f, 7.95f, std::max(z + 0.6f, inner)});
        for (float x = -30.3f; x < 30.4f; x += 0.5f) { // dentils under the cornice
            b.box({x, 7.38f, std::min(z - side * 0.45f, z - side * 0.62f)},
                  {x + 0.24f, 7.6f, std::max(z - side * 0.45f, z - side * 0.62f)});
        }
        b.use(wood);
        b.box({-34, 7.95f, std::min(z, side * (back + 0.6f))},
              {34, 8.2f, std::max(z, side * (back + 0.6f))});
        for (float x = -30.0f; x < 30.1f; x += 2.5f) {
            b.box({x - 0.12f, 7.55f, std::min(z, side * back)},
                  {x + 0.12f, 7.95f, std::max(z, side * back)});
        }
        for (int i = -5; i <= 5; i += 2) {
            b.use(marble);
            add_figure(b, {bay * (static_cast<float>(i) + 0.5f), 0, side * (back - 1.0f)},
                       b.random.range(-0.6f, 0.6f));
        }
    }
    // laths over one end of the court
    b.use(wood);
    for (float x = 9.0f; x < 28.0f; x += 4.0f) {
        b.box({x - 0.1f, 7.95f, -row - 0.5f}, {x + 0.1f, 8.2f, row + 0.5f});
    }
    for (float z = -row; z < row; z += 0.45f) {
        b.box({8.5f, 8.2f, z}, {29.0f, 8.26f, z + 0.07f});
    }
    for (int i = -5; i <= 5; ++i) {
        for (const float z : {-3.6f, 3.6f}) {
            const glm::vec3 foot(bay * static_cast<float>(i) + 2.5f, 0, z);
            b.use(pot);
            b.tube(foot, foot + glm::vec3(0, 0.62f, 0), 0.26f, 0.4f, 20);
            b.ring(foot + glm::vec3(0, 0.62f, 0), {0, 1, 0}, 0.4f, 0.05f, 20, 6);
            b.use(leaf);
            b.leaf_cluster(foot + glm::vec3(0, 1.25f, 0), 0.62f, 420, 0.2f);
        }
    }
    // a basin in the middle
    b.use(marble);
    b.tube({0, 0, 0}, {0, 0.5f, 0}, 1.7f, 1.8f, 40, false);
    b.ring({0, 0.5f, 0}, {0, 1, 0}, 1.75f, 0.12f, 40, 8);
    b.tube({0, 0, 0}, {0, 1.5f, 0}, 0.25f, 0.16f, 20);
    b.tube({0, 1.5f, 0}, {0, 1.75f, 0}, 0.15f, 0.8f, 32, false);
    b.ring({0, 1.75f, 0}, {0, 1, 0}, 0.8f, 0.05f, 32, 6);

    b.add_camera({-21.0, 1.7, 8.6}, {10.0, 1.6, 8.0}, 60.0);
    b.add_camera({-27.0, 1.7, -1.2}, {6.0, 2.4, 3.4}, 58.0);
    b.add_camera({29.0, 4.6, -3.0}, {4.0, 0.6, 1.6}, 55.0);
    b.add_sun({0.35, -0.62, 0.72});
    b.add_sun({0.45, -1.0, 0.5});
    b.add_sun({0.72, -0.6, 0.3});
    b.add_spot({0.0, 10.5, -4.0}, {2.0, 0.0, 5.0}, 75.0);
    return b.take();
}

} // namespace lab
