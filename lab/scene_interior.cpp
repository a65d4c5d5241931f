#include "lab/scene_builder.hpp"

#include <cmath>
#include <numbers>

namespace lab {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

struct palette {
    std::uint8_t floor, wall, ceiling, oak, dark_oak, cloth, metal, brass, china, leaf, clay, rug,
        glass, paper, fruit, lemon, books[6];
};

void add_chair(scene_builder& b, const palette& m, glm::vec3 at, float yaw) {
    b.place(at, yaw);
    b.use(m.dark_oak);
    const float w = 0.21f;
    for (const float x : {-w, w}) {
        b.tube({x * 1.05f, 0, 0.22f}, {x * 0.95f, 0.45f, 0.19f}, 0.016f, 0.022f, 8);
        b.tube({x * 1.05f, 0, -0.24f}, {x * 0.95f, 0.45f, -0.2f}, 0.016f, 0.022f, 8);
        b.tube({x * 0.95f, 0.45f, -0.2f}, {x * 0.95f, 0.98f, -0.29f}, 0.022f, 0.015f, 8);
        b.tube({x, 0.2f, 0.2f}, {x, 0.2f, -0.22f}, 0.011f, 0.011f, 6);
    }
    b.tube({-w, 0.26f, 0.0f}, {w, 0.26f, 0.0f}, 0.011f, 0.011f, 6);
    b.box({-0.235f, 0.44f, -0.22f}, {0.235f, 0.475f, 0.24f});
    for (int i = 0; i < 7; ++i) {
        const float x = -0.165f + 0.055f * static_cast<float>(i);
        b.tube({x, 0.475f, -0.2f}, {x, 0.93f, -0.28f}, 0.008f, 0.007f, 6);
    }
    b.beam({-w, 0.95f, -0.285f}, {w, 0.95f, -0.285f}, 0.025f, 0.07f);
    b.place({0, 0, 0});
}

/// A basket of wire with fruit in it.
void add_basket(scene_builder& b, const palette& m, glm::vec3 at) {
    b.use(m.metal);
    const int ribs = 22;
    for (int i = 0; i < ribs; ++i) {
        const float a = 2.0f * pi * static_cast<float>(i) / static_cast<float>(ribs);
        const glm::vec3 d(std::cos(a), 0.0f, std::sin(a));
        const glm::vec3 low = at + 0.09f * d + glm::vec3(0, 0.012f, 0);
        const glm::vec3 mid = at + 0.165f * d + glm::vec3(0, 0.06f, 0);
        const glm::vec3 high = at + 0.2f * d + glm::vec3(0, 0.135f, 0);
        b.tube(low, mid, 0.0025f, 0.0025f, 5, false);
        b.tube(mid, high, 0.0025f, 0.0025f, 5, false);
    }
    b.ring(at + glm::vec3(0, 0.012f, 0), {0, 1, 0}, 0.09f, 0.004f, 32, 6);
    b.ring(at + glm::vec3(0, 0.06f, 0), {0, 1, 0}, 0.165f, 0.003f, 40, 6);
    b.ring(at + glm::vec3(0, 0.135f, 0), {0, 1, 0}, 0.2f, 0.005f, 40, 6);
    for (int i = 0; i < 9; ++i) {
        const float a = 2.4f * static_cast<float>(i);
        const float r = i < 6 ? 0.095f : 0.045f;
        b.use(i % 3 == 0 ? m.lemon : m.fruit);
        b.ellipsoid(at + glm::vec3(r * std::cos(a), i < 6 ? 0.055f : 0.115f, r * std::sin(a)),
                    glm::vec3(0.042f), 18, 0.05f);
    }
}

void add_setting(scene_builder& b, const palette& m, glm::vec3 at, float yaw) {
    b.place(at, yaw);
    b.use(m.china);
    b.tube({0, 0.002f, 0}, {0, 0.018f, 0}, 0.07f, 0.13f, 28);
    b.tube({0.2f, 0, -0.08f}, {0.2f, 0.09f, -0.08f}, 0.03f, 0.04f, 18);
    b.ring({0.25f, 0.05f, -0.08f}, {0, 0, 1}, 0.025f, 0.005f, 14, 5);
    b.use(m.metal);
    for (const float x : {-0.17f, -0.2f, 0.16f}) {
        b.beam({x, 0.006f, -0.08f}, {x, 0.006f, 0.1f}, 0.012f, 0.004f);
    }
    b.use(m.glass);
    const glm::vec3 stem(-0.16f, 0.0f, -0.16f);
    b.tube(stem, stem + glm::vec3(0, 0.006f, 0), 0.034f, 0.02f, 16);
    b.tube(stem, stem + glm::vec3(0, 0.09f, 0), 0.005f, 0.005f, 8);
    b.tube(stem + glm::vec3(0, 0.09f, 0), stem + glm::vec3(0, 0.15f, 0), 0.006f, 0.037f, 18, false);
    b.tube(stem + glm::vec3(0, 0.15f, 0), stem + glm::vec3(0, 0.2f, 0), 0.037f, 0.03f, 18, false);
    b.place({0, 0, 0});
}

void add_shelves(scene_builder& b, const palette& m, glm::vec3 at, float yaw, float width,
                 float height, int levels) {
    b.place(at, yaw);
    const float depth = 0.3f;
    const float board = 0.025f;
    b.use(m.oak);
    b.box({0, 0, 0}, {board, height, depth});
    b.box({width - board, 0, 0}, {width, height, depth});
    b.box({0, 0, 0}, {width, height, 0.012f});
    const float gap = height / static_cast<float>(levels);
    for (int i = 0; i <= levels; ++i) {
        const float y = std::min(gap * static_cast<float>(i), height - board);
        b.use(m.oak);
        b.box({0, y, 0}, {width, y + board, depth});
        if (i == levels) {
            break;
        }
        float x = 0.04f;
        while (x < width - 0.12f) {
            const float kind = b.random.unit();
            if (kind < 0.07f) { // a vase
                const float r = b.random.range(0.05f, 0.08f);
                b.use(b.random.unit() < 0.5f ? m.china : m.clay);
                const glm::vec3 foot(x + r, y + board, 0.16f);
                b.tube(foot, foot + glm::vec3(0, 0.1f, 0), 0.6f * r, r, 18);
                b.tube(foot + glm::vec3(0, 0.1f, 0), foot + glm::vec3(0, 0.2f, 0), r, 0.4f * r, 18);
                b.tube(foot + glm::vec3(0, 0.2f, 0), foot + glm::vec3(0, 0.24f, 0), 0.4f * r,
                       0.55f * r, 18, false);
                x += 2.0f * r + 0.03f;
            } else if (kind < 0.11f) {
                x += b.random.range(0.06f, 0.2f);
            } else {
                const float thick = b.random.range(0.016f, 0.05f);
                const float tall = std::min(gap - 0.06f, b.random.range(0.19f, 0.31f));
                const float deep = b.random.range(0.15f, 0.23f);
                const float lean = b.random.unit() < 0.06f ? 0.05f : 0.0f;
                b.use(m.books[b.random.below(6)]);
                b.beam({x + 0.5f * thick + lean, y + board, 0.03f + 0.5f * deep},
                       {x + 0.5f * thick, y + board + tall, 0.03f + 0.5f * deep}, thick, deep);
                x += thick + 0.002f + lean;
            }
        }
    }
    b.place({0, 0, 0});
}

void add_plant(scene_builder& b, const palette& m, glm::vec3 at) {
    b.use(m.clay);
    b.tube(at, at + glm::vec3(0, 0.34f, 0), 0.15f, 0.21f, 24);
    b.ring(at + glm::vec3(0, 0.34f, 0), {0, 1, 0}, 0.21f, 0.02f, 24, 6);
    for (int i = 0; i < 26; ++i) {
        const float a = 2.4f * static_cast<float>(i);
        const float reach = b.random.range(0.12f, 0.5f);
        const glm::vec3 out(std::cos(a), 0.0f, std::sin(a));
        const glm::vec3 root = at + glm::vec3(0, 0.34f, 0) + 0.05f * out;
        const glm::vec3 tip = root + reach * out + glm::vec3(0, b.random.range(0.45f, 1.15f), 0);
        const glm::vec3 mid = glm::mix(root, tip, 0.5f) + glm::vec3(0, 0.1f, 0) - 0.05f * out;
        b.use(m.leaf);
        b.tube(root, mid, 0.006f, 0.005f, 5, false);
        b.tube(mid, tip, 0.005f, 0.003f, 5, false);
        for (int k = 0; k < 9; ++k) {
            const glm::vec3 base = glm::mix(mid, tip, static_cast<float>(k) / 8.0f);
            const glm::vec3 d = glm::normalize(out + 0.9f * b.random.direction());
            b.leaf(base, d, glm::vec3(0, 1, 0) + 0.4f * b.random.direction(), 0.17f, 0.06f);
        }
    }
}

void add_picture(scene_builder& b, const palette& m, glm::vec3 centre, glm::vec3 right,
                 glm::vec3 out, float width, float height) {
    const glm::vec3 w = 0.5f * width * right;
    const glm::vec3 h(0.0f, 0.5f * height, 0.0f);
    b.use(m.paper);
    const glm::vec3 sheet = centre + 0.012f * out;
    b.quad(sheet - w - h, sheet + w - h, sheet + w + h, sheet - w + h);
    b.use(m.dark_oak);
    const glm::vec3 front = centre + 0.02f * out;
    b.beam(front - w - h, front + w - h, 0.04f, 0.04f);
    b.beam(front - w + h, front + w + h, 0.04f, 0.04f);
    b.beam(front - w - h, front - w + h, 0.04f, 0.04f);
    b.beam(front + w - h, front + w + h, 0.04f, 0.04f);
}

} // namespace

scene build_interior(unsigned seed) {
    scene_builder b("interior", seed);
    palette m{};
    m.floor = b.add_material(0xb39a7c, 0.12f);
    m.wall = b.add_material(0xe9e2d2, 0.02f);
    m.ceiling = b.add_material(0xf2efe8, 0.02f);
    m.oak = b.add_material(0xa98660, 0.2f);
    m.dark_oak = b.add_material(0x6e4528, 0.2f);
    m.cloth = b.add_material(0x8fa3ad, 0.1f);
    m.metal = b.add_material(0x8c9196, 0.05f);
    m.brass = b.add_material(0xb8924a, 0.05f);
    m.china = b.add_material(0xf4f2ee);
    m.leaf = b.add_material(0x4f7a3a, 0.3f);
    m.clay = b.add_material(0xb5694a, 0.15f);
    m.rug = b.add_material(0x8f5a55, 0.12f);
    m.glass = b.add_material(0xb9d0d4);
    m.paper = b.add_material(0x7f95a8, 0.45f);
    m.fruit = b.add_material(0xc2452f, 0.25f);
    m.lemon = b.add_material(0xe0b83a, 0.15f);
    const std::uint32_t covers[6] = {0x7a2e2a, 0x2f4a63, 0x46603f, 0xc79a4b, 0x5a4a6b, 0xd9cfb8};
    for (int i = 0; i < 6; ++i) {
        m.books[i] = b.add_material(covers[i], 0.15f);
    }

    // the room: walls of a few huge triangles, one with a window
    const float x = 4.0f;
    const float y = 2.8f;
    const float z = 3.0f;
    b.use(m.floor);
    b.quad({-x, 0, -z}, {x, 0, -z}, {x, 0, z}, {-x, 0, z});
    b.use(m.ceiling);
    b.quad({-x, y, -z}, {x, y, -z}, {x, y, z}, {-x, y, z});
    b.use(m.wall);
    b.quad({-x, 0, z}, {x, 0, z}, {x, y, z}, {-x, y, z});
    b.quad({-x, 0, -z}, {-x, 0, z}, {-x, y, z}, {-x, y, -z});
    b.quad({x, 0, -z}, {x, 0, z}, {x, y, z}, {x, y, -z});
    b.quad({-x, 0, -z}, {x, 0, -z}, {x, 0.9f, -z}, {-x, 0.9f, -z});
    b.quad({-x, 2.3f, -z}, {x, 2.3f, -z}, {x, y, -z}, {-x, y, -z});
    b.quad({-x, 0.9f, -z}, {0.4f, 0.9f, -z}, {0.4f, 2.3f, -z}, {-x, 2.3f, -z});
    b.quad({2.4f, 0.9f, -z}, {x, 0.9f, -z}, {x, 2.3f, -z}, {2.4f, 2.3f, -z});
    b.use(m.ceiling);
    b.box({0.3f, 0.84f, -z - 0.2f}, {2.5f, 0.9f, -z + 0.1f});
    for (const float at : {0.4f, 1.4f, 2.4f}) {
        b.box({at - 0.03f, 0.9f, -z - 0.06f}, {at + 0.03f, 2.3f, -z + 0.02f});
    }
    b.box({0.4f, 2.25f, -z - 0.06f}, {2.4f, 2.3f, -z + 0.02f});
    for (int i = 0; i < 26; ++i) { // a Venetian blind, half let down
        const float at = 2.24f - 0.03f * static_cast<float>(i);
        b.beam({0.43f, at, -z - 0.1f}, {2.37f, at, -z - 0.1f}, 0.034f, 0.002f);
    }
    for (const float side : {-1.0f, 1.0f}) { // skirting boards
        b.box({-x, 0, side * z - (side > 0 ? 0.02f : 0.0f)},
              {x, 0.1f, side * z + (side > 0 ? 0.0f : 0.02f)});
    }

    b.use(m.rug);
    b.box({-1.7f, 0.0f, -1.35f}, {2.1f, 0.012f, 1.15f});

    // table, chairs and what is on the table
    const float top = 0.75f;
    b.use(m.oak);
    b.box({-0.95f, top - 0.035f, -0.6f}, {1.35f, top, 0.4f});
    for (const float tx : {-0.85f, 1.25f}) {
        for (const float tz : {-0.5f, 0.3f}) {
            b.tube({tx, 0.012f, tz}, {tx, top - 0.035f, tz}, 0.028f, 0.042f, 12);
        }
        b.beam({tx, top - 0.08f, -0.5f}, {tx, top - 0.08f, 0.3f}, 0.025f, 0.09f);
    }
    for (const float tz : {-0.5f, 0.3f}) {
        b.beam({-0.85f, top - 0.08f, tz}, {1.25f, top - 0.08f, tz}, 0.025f, 0.09f);
    }
    add_chair(b, m, {-0.45f, 0.012f, -0.85f}, 0.1f);
    add_chair(b, m, {0.75f, 0.012f, -0.88f}, -0.15f);
    add_chair(b, m, {-0.4f, 0.012f, 0.72f}, pi + 0.2f);
    add_chair(b, m, {0.85f, 0.012f, 0.85f}, pi - 0.4f);
    add_chair(b, m, {-1.45f, 0.012f, -0.15f}, 0.5f * pi + 0.15f);
    add_chair(b, m, {2.0f, 0.0f, -0.35f}, -0.5f * pi - 0.25f);
    for (const float sx : {-0.45f, 0.8f}) {
        add_setting(b, m, {sx, top, -0.35f}, 0.0f);
        add_setting(b, m, {sx, top, 0.15f}, pi);
    }
    add_basket(b, m, {0.2f, top, -0.1f});
    b.use(m.brass);
    for (const float cx : {-0.2f, 0.58f}) {
        const glm::vec3 foot(cx, top, -0.02f);
        b.tube(foot, foot + glm::vec3(0, 0.02f, 0), 0.055f, 0.04f, 18);
        b.tube(foot, foot + glm::vec3(0, 0.2f, 0), 0.012f, 0.009f, 10);
        b.tube(foot + glm::vec3(0, 0.2f, 0), foot + glm::vec3(0, 0.22f, 0), 0.02f, 0.03f, 14);
        b.use(m.china);
        b.tube(foot + glm::vec3(0, 0.22f, 0), foot + glm::vec3(0, 0.4f, 0), 0.011f, 0.01f, 10);
        b.use(m.brass);
    }

    add_shelves(b, m, {-3.95f, 0.0f, 1.9f}, 0.5f * pi, 2.1f, 2.2f, 6);
    add_shelves(b, m, {-3.2f, 0.0f, -2.98f}, 0.0f, 2.6f, 1.9f, 5);
    // a sideboard with drawers
    b.use(m.oak);
    b.box({3.5f, 0.12f, -1.0f}, {3.97f, 0.85f, 1.2f});
    b.box({3.46f, 0.85f, -1.05f}, {3.98f, 0.88f, 1.25f});
    for (int i = 0; i < 4; ++i) {
        const float from = -0.97f + 0.545f * static_cast<float>(i);
        for (int k = 0; k < 2; ++k) {
            const float low = 0.16f + 0.35f * static_cast<float>(k);
            b.use(m.oak);
            b.box({3.485f, low, from}, {3.5f, low + 0.32f, from + 0.5f});
            b.use(m.brass);
            b.ellipsoid({3.465f, low + 0.16f, from + 0.25f}, glm::vec3(0.018f), 10);
        }
    }
    b.use(m.dark_oak);
    for (const float leg : {-0.95f, 1.15f}) {
        b.box({3.55f, 0, leg - 0.03f}, {3.6f, 0.12f, leg + 0.03f});
        b.box({3.88f, 0, leg - 0.03f}, {3.93f, 0.12f, leg + 0.03f});
    }
    b.use(m.china);
    b.tube({3.72f, 0.88f, 0.8f}, {3.72f, 1.12f, 0.8f}, 0.06f, 0.1f, 20);
    b.tube({3.72f, 1.12f, 0.8f}, {3.72f, 1.22f, 0.8f}, 0.1f, 0.04f, 20, false);
    b.use(m.leaf);
    b.leaf_cluster({3.72f, 1.45f, 0.8f}, 0.24f, 160, 0.1f);
    add_plant(b, m, {3.2f, 0.0f, -2.35f});
    add_plant(b, m, {1.3f, 0.0f, 2.55f});
    add_picture(b, m, {3.99f, 1.7f, 0.1f}, {0, 0, -1}, {-1, 0, 0}, 0.9f, 0.65f);
    add_picture(b, m, {3.99f, 1.75f, 1.2f}, {0, 0, -1}, {-1, 0, 0}, 0.5f, 0.7f);
    add_picture(b, m, {-0.2f, 1.7f, 2.99f}, {-1, 0, 0}, {0, 0, -1}, 1.1f, 0.7f);
    add_picture(b, m, {-3.99f, 1.75f, -1.3f}, {0, 0, 1}, {1, 0, 0}, 0.6f, 0.8f);

    // an armchair of wicker: bent rods close together
    b.place({2.75f, 0.0f, 1.75f}, -2.3f);
    b.use(m.brass);
    for (int i = 0; i <= 34; ++i) {
        const float a = pi * (-0.12f + 1.24f * static_cast<float>(i) / 34.0f);
        const glm::vec3 d(std::cos(a), 0.0f, -std::sin(a));
        const float high = 0.62f + 0.3f * std::pow(std::max(0.0f, std::sin(a)), 2.0f);
        b.tube(0.3f * d + glm::vec3(0, 0.36f, 0), 0.4f * d + glm::vec3(0, high, 0), 0.007f, 0.007f,
               5, false);
        b.tube(0.24f * d, 0.3f * d + glm::vec3(0, 0.36f, 0), 0.007f, 0.007f, 5, false);
    }
    for (const float level : {0.1f, 0.36f, 0.47f, 0.58f}) {
        b.ring({0, level, 0}, {0, 1, 0}, 0.24f + 0.16f * level, 0.009f, 40, 6);
    }
    b.use(m.cloth);
    b.ellipsoid({0, 0.42f, 0}, {0.29f, 0.07f, 0.29f}, 28);
    b.place({0, 0, 0});

    // lamp: cord, shade, and the light just below it
    b.use(m.brass);
    b.tube({0.2f, 2.1f, -0.1f}, {0.2f, y, -0.1f}, 0.006f, 0.006f, 6);
    b.tube({0.2f, 1.98f, -0.1f}, {0.2f, 2.16f, -0.1f}, 0.26f, 0.05f, 32, false);

    b.add_camera({-3.1, 1.62, 2.05}, {0.85, 0.55, -0.75}, 58.0);
    b.add_camera({1.75, 1.35, 1.25}, {-0.1, 0.62, -0.45}, 50.0);
    b.add_camera({2.2, 1.7, -2.3}, {-1.4, 0.55, 0.8}, 62.0);
    b.add_spot({0.2, 1.97, -0.1}, {0.2, 0.0, -0.1}, 150.0);
    b.add_spot({-1.9, 2.7, 1.6}, {0.9, 0.3, -0.9}, 85.0);
    b.add_sun({-0.45, -0.55, 0.85}); // through the blind
    return b.take();
}

} // namespace lab
