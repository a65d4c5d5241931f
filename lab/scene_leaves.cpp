#include "lab/scene_builder.hpp"

#include <cmath>
#include <numbers>

namespace lab {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Diamond wire mesh between posts, in the plane z = 0 of the builder's frame.
void add_wire_fence(scene_builder& b, std::uint8_t wire, std::uint8_t post, float width,
                    float height) {
    b.use(post);
    for (float x = 0.0f; x <= width + 0.01f; x += width / 3.0f) {
        b.tube({x, 0, 0}, {x, height + 0.08f, 0}, 0.025f, 0.025f, 10);
    }
    b.tube({0, height, 0}, {width, height, 0}, 0.015f, 0.015f, 8);
    b.use(wire);
    const float step = 0.075f;
    for (float start = -height; start < width; start += step) {
        for (const bool rising : {true, false}) {
            const float lo = std::max(0.0f, -start);
            const float hi = std::min(height, width - start);
            if (hi - lo < 0.02f) {
                continue;
            }
            const auto at = [&](float t) {
                return glm::vec3(start + t, rising ? t : height - t, 0.0f);
            };
            b.tube(at(lo), at(hi), 0.0022f, 0.0022f, 4, false);
        }
    }
}

/// A grating of flat bars and rods, lying or standing, spanned by u and v.
void add_grating(scene_builder& b, glm::vec3 corner, glm::vec3 u, glm::vec3 v, int bars, int rods) {
    const glm::vec3 n = glm::normalize(glm::cross(u, v));
    for (int i = 0; i <= bars; ++i) {
        const glm::vec3 from = corner + u * (static_cast<float>(i) / static_cast<float>(bars));
        const glm::vec3 half = 0.003f * glm::normalize(u);
        const glm::vec3 deep = 0.03f * n;
        b.quad(from - half, from - half + v, from - half + v + deep, from - half + deep);
        b.quad(from + half, from + half + v, from + half + v + deep, from + half + deep);
        b.quad(from - half, from + half, from + half + v, from - half + v);
        b.quad(from - half + deep, from + half + deep, from + half + v + deep,
               from - half + v + deep);
    }
    for (int i = 0; i <= rods; ++i) {
        const glm::vec3 from =
            corner + v * (static_cast<float>(i) / static_cast<float>(rods)) + 0.015f * n;
        b.tube(from, from + u, 0.004f, 0.004f, 5, false);
    }
}

void add_wheel(scene_builder& b, std::uint8_t tyre, std::uint8_t metal, glm::vec3 centre,
               glm::vec3 axis) {
    const glm::vec3 a = glm::normalize(axis);
    b.use(tyre);
    b.ring(centre, a, 0.33f, 0.018f, 56, 8);
    b.use(metal);
    b.ring(centre, a, 0.31f, 0.008f, 56, 5);
    b.tube(centre - 0.05f * a, centre + 0.05f * a, 0.02f, 0.02f, 12);
    const glm::vec3 u = glm::normalize(glm::cross(a, glm::vec3(0.1f, 1.0f, 0.2f)));
    const glm::vec3 v = glm::cross(a, u);
    for (int i = 0; i < 32; ++i) {
        const float t = 2.0f * pi * static_cast<float>(i) / 32.0f;
        const glm::vec3 rim = centre + 0.31f * (std::cos(t) * u + std::sin(t) * v);
        const float side = i % 2 == 0 ? 1.0f : -1.0f;
        const float twist = t + 0.35f * (i % 4 < 2 ? 1.0f : -1.0f);
        const glm::vec3 hub =
            centre + 0.02f * (std::cos(twist) * u + std::sin(twist) * v) + side * 0.035f * a;
        b.tube(hub, rim, 0.0012f, 0.0012f, 4, false);
    }
}

} // namespace

scene build_leaves(unsigned seed) {
    scene_builder b("leaves", seed);
    const std::uint8_t paving = b.add_material(0xc9c2b4, 0.1f);
    const std::uint8_t plaster = b.add_material(0xe4d9c6, 0.05f);
    const std::uint8_t wood = b.add_material(0x9a7448, 0.2f);
    const std::uint8_t wire = b.add_material(0x7d858a);
    const std::uint8_t iron = b.add_material(0x3c4146);
    const std::uint8_t rubber = b.add_material(0x242424);
    const std::uint8_t bark = b.add_material(0x6d5a47, 0.3f);
    const std::uint8_t leaf = b.add_material(0x56782f, 0.4f);
    const std::uint8_t vine = b.add_material(0x7d9440, 0.4f);
    const std::uint8_t clay = b.add_material(0xb0643f, 0.15f);
    const std::uint8_t cloth = b.add_material(0xc9583e, 0.05f);

    // a yard: ground and house wall are two triangles each
    b.use(paving);
    b.quad({-24, 0, -18}, {24, 0, -18}, {24, 0, 22}, {-24, 0, 22});
    b.use(plaster);
    b.quad({-24, 0, -7}, {24, 0, -7}, {24, 6, -7}, {-24, 6, -7});

    // pergola with slats and a vine
    b.use(wood);
    for (const float x : {-5.0f, -2.4f, 0.2f, 2.8f}) {
        for (const float z : {-6.6f, -3.2f}) {
            b.box({x - 0.06f, 0, z - 0.06f}, {x + 0.06f, 2.6f, z + 0.06f});
        }
        b.box({x - 0.05f, 2.6f, -7.0f}, {x + 0.05f, 2.75f, -2.8f});
    }
    for (float z = -6.9f; z < -2.8f; z += 0.16f) {
        b.box({-5.5f, 2.75f, z}, {3.3f, 2.8f, z + 0.035f});
    }
    for (int i = 0; i < 42; ++i) {
        b.use(vine);
        const glm::vec3 at(b.random.range(-5.4f, 1.0f), b.random.range(2.7f, 2.95f),
                           b.random.range(-6.8f, -4.2f));
        b.leaf_cluster(at, 0.45f, 90, 0.12f);
    }
    for (int i = 0; i < 14; ++i) { // tendrils
        const glm::vec3 from(b.random.range(-5.2f, 2.5f), 2.75f, b.random.range(-6.0f, -3.0f));
        const glm::vec3 to = from - glm::vec3(0.0f, b.random.range(0.3f, 0.9f), 0.0f);
        b.use(vine);
        b.tube(from, to, 0.004f, 0.002f, 4, false);
        for (float t = 0.1f; t < 1.0f; t += 0.12f) {
            b.leaf(glm::mix(from, to, t), b.random.direction() - glm::vec3(0, 0.6f, 0),
                   b.random.direction(), 0.09f, 0.055f);
        }
    }

    b.place({3.9f, 0.0f, -1.6f}, 0.35f);
    add_wire_fence(b, wire, iron, 6.0f, 1.6f);
    b.place({-8.2f, 0.0f, -2.0f}, -0.5f);
    add_wire_fence(b, wire, iron, 3.6f, 1.4f);
    b.place({0, 0, 0});

    b.use(iron);
    add_grating(b, {-1.4f, 0.55f, -1.2f}, {1.5f, 0, 0}, {0, 0, 1.0f}, 40, 10); // a table top
    for (const float x : {-1.35f, 0.05f}) {
        for (const float z : {-1.15f, -0.25f}) {
            b.tube({x, 0, z}, {x, 0.55f, z}, 0.014f, 0.014f, 8);
        }
    }
    add_grating(b, {1.1f, 0.0f, -2.2f}, {1.4f, 0, 0.5f}, {0, 1.7f, -0.1f}, 32, 14); // a screen
    add_grating(b, {-3.6f, 0.0f, -0.9f}, {0.7f, 0, -0.7f}, {0, 1.1f, 0}, 20, 9);
    add_wheel(b, rubber, wire, {0.55f, 0.35f, 0.1f}, {0.75f, 0.12f, 0.65f});
    add_wheel(b, rubber, wire, {2.0f, 0.35f, -1.2f}, {-0.2f, 0.25f, 0.95f});

    // a deck chair: laths and a cloth
    b.place({-2.3f, 0.0f, 0.8f}, 0.6f);
    b.use(wood);
    for (const float x : {-0.3f, 0.3f}) {
        b.beam({x, 0.0f, 0.5f}, {x, 1.05f, -0.55f}, 0.03f, 0.04f);
        b.beam({x, 0.0f, -0.5f}, {x, 0.55f, 0.4f}, 0.03f, 0.04f);
    }
    for (int i = 0; i < 9; ++i) {
        const float t = 0.2f + 0.095f * static_cast<float>(i);
        b.use(i % 2 == 0 ? cloth : plaster);
        const glm::vec3 p = glm::mix(glm::vec3(0, 0.05f, 0.5f), glm::vec3(0, 1.05f, -0.55f), t);
        b.beam(p - glm::vec3(0.29f, 0, 0), p + glm::vec3(0.29f, 0, 0), 0.07f, 0.006f);
    }
    b.place({0, 0, 0});

    // pots, a small tree and a bush
    for (int i = 0; i < 7; ++i) {
        const glm::vec3 foot(-4.6f + 1.5f * static_cast<float>(i), 0.0f,
                             -6.4f + b.random.range(0.0f, 0.3f));
        b.use(clay);
        b.tube(foot, foot + glm::vec3(0, 0.3f, 0), 0.14f, 0.2f, 18);
        b.use(i % 2 == 0 ? leaf : vine);
        b.leaf_cluster(foot + glm::vec3(0, 0.6f, 0), 0.34f, 150, 0.13f);
    }
    b.broad_tree({-6.4f, 0.0f, 1.0f}, {4.6f, 4, 14, 0.1f, bark, leaf});
    b.broad_tree({6.2f, 0.0f, 0.4f}, {3.4f, 3, 30, 0.1f, bark, vine});
    b.use(leaf);
    for (int i = 0; i < 120; ++i) { // fallen leaves
        const glm::vec3 at(b.random.range(-7.0f, 5.0f), 0.012f, b.random.range(-2.5f, 4.0f));
        glm::vec3 d = b.random.direction();
        d.y = 0.25f * std::abs(d.y);
        b.leaf(at, d, {0, 1, 0}, 0.09f, 0.055f);
    }

    b.add_camera({0.9, 1.5, 4.6}, {-0.6, 0.55, -2.4}, 52.0);
    b.add_camera({-1.8, 1.25, 1.7}, {0.5, 0.1, -1.3}, 50.0);
    b.add_camera({7.0, 2.6, 6.0}, {-1.0, 0.6, -3.0}, 48.0);
    b.add_sun({-0.55, -0.75, -0.3});
    b.add_sun({0.75, -0.5, -0.45});
    b.add_spot({1.5, 4.2, -5.2}, {-0.5, 0.0, 0.0}, 80.0);
    return b.take();
}

} // namespace lab
