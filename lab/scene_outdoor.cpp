#include "lab/scene_builder.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace lab {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Middle of the path at a distance along the field.
float path_x(float z) {
    return 1.6f + 2.2f * std::sin(0.035f * z) + 5.0f * std::sin(0.011f * z + 0.4f) - 1.95f;
}

/// Height of the ground: hills that grow with the distance from the path, and bumps.
float ground(float x, float z) {
    const float off = std::abs(x - path_x(z));
    const float away = glm::smoothstep(6.0f, 90.0f, off + 0.25f * std::max(0.0f, -z - 60.0f));
    const float hills = 9.0f * value_noise({x / 85.0f, 0.5f, z / 85.0f}, 11u) +
                        3.0f * value_noise({x / 31.0f, 0.5f, z / 31.0f}, 12u);
    const float bumps = 0.5f * value_noise({x / 11.0f, 0.5f, z / 11.0f}, 13u) +
                        0.12f * value_noise({x / 3.2f, 0.5f, z / 3.2f}, 14u);
    return away * hills + bumps * (0.35f + 0.65f * glm::smoothstep(1.0f, 8.0f, off));
}

struct palette {
    std::uint8_t grass, dirt, bark, leaf, light_leaf, needles, paint, wall, warm_wall, roof, slate,
        wood, glass, stone, iron, straw;
};

void add_ground(scene_builder& b, const palette& m) {
    // columns follow the path, so that its edges are edges of triangles
    std::vector<float> offsets;
    for (float x = 0.9f; x < 206.0f; x += x < 12.0f ? 1.1f : std::min(0.09f * x, 5.0f)) {
        offsets.push_back(x);
        offsets.insert(offsets.begin(), -x);
    }
    const int rows = 230;
    const auto z_of = [&](int j) {
        const float t = static_cast<float>(j) / static_cast<float>(rows);
        return 60.0f - 400.0f * t * (0.45f + 0.55f * t);
    };
    const auto at = [&](std::size_t i, int j) {
        const float z = z_of(j);
        const float bend =
            path_x(z) * (1.0f - glm::smoothstep(20.0f, 190.0f, std::abs(offsets[i])));
        const float x = offsets[i] + bend;
        return glm::vec3(x, ground(x, z), z);
    };
    for (int j = 0; j < rows; ++j) {
        for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
            b.use(offsets[i] < 0.0f && offsets[i + 1] > 0.0f ? m.dirt : m.grass);
            b.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
}

/// Pickets, posts and two rails along a polyline on the ground.
void add_fence(scene_builder& b, const palette& m, const std::vector<glm::vec2>& line) {
    b.use(m.paint);
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const glm::vec2 from = line[k];
        const glm::vec2 to = line[k + 1];
        const float length = glm::length(to - from);
        const glm::vec2 along = (to - from) / length;
        const glm::vec3 u(along.x, 0.0f, along.y);
        const glm::vec3 n(-along.y, 0.0f, along.x);
        const auto foot = [&](float s) {
            const glm::vec2 p = from + s * along;
            return glm::vec3(p.x, ground(p.x, p.y), p.y);
        };
        const float bay = length / std::ceil(length / 2.4f);
        for (float s = 0.0f; s < length - 0.01f; s += bay) {
            b.tube(foot(s) - glm::vec3(0, 0.3f, 0), foot(s) + glm::vec3(0, 1.15f, 0), 0.07f, 0.07f,
                   4);
            for (const float y : {0.28f, 0.78f}) {
                b.beam(foot(s) + glm::vec3(0, y, 0) - 0.035f * n,
                       foot(s + bay) + glm::vec3(0, y, 0) - 0.035f * n, 0.04f, 0.08f);
            }
        }
        for (float s = 0.12f; s < length; s += 0.165f) {
            const float w = 0.042f;
            const float top = 0.98f + b.random.range(-0.015f, 0.015f);
            const glm::vec3 p = foot(s);
            const glm::vec3 lean = b.random.range(-0.012f, 0.012f) * u;
            const glm::vec3 outline[5] = {
                p - w * u + glm::vec3(0, 0.06f, 0), p + w * u + glm::vec3(0, 0.06f, 0),
                p + w * u + lean + glm::vec3(0, top - 0.09f, 0), p + lean + glm::vec3(0, top, 0),
                p - w * u + lean + glm::vec3(0, top - 0.09f, 0)};
            const glm::vec3 half = 0.011f * n;
            for (const float side : {-1.0f, 1.0f}) {
                for (int i = 1; i < 4; ++i) {
                    b.triangle(outline[0] + side * half, outline[i] + side * half,
                               outline[i + 1] + side * half);
                }
            }
            for (int i = 0; i < 5; ++i) {
                const glm::vec3 a = outline[i];
                const glm::vec3 c = outline[(i + 1) % 5];
                b.quad(a - half, c - half, c + half, a + half);
            }
        }
    }
}

void add_window(scene_builder& b, const palette& m, glm::vec3 centre, glm::vec3 right,
                glm::vec3 out, float width, float height) {
    const glm::vec3 up(0.0f, 1.0f, 0.0f);
    const glm::vec3 w = 0.5f * width * right;
    const glm::vec3 h = 0.5f * height * up;
    b.use(m.glass);
    const glm::vec3 pane = centre + 0.02f * out;
    b.quad(pane - w - h, pane + w - h, pane + w + h, pane - w + h);
    b.use(m.paint);
    const glm::vec3 front = centre + 0.05f * out;
    for (const float s : {-1.0f, 0.0f, 1.0f}) {
        b.beam(front + s * w - h, front + s * w + h, 0.07f, 0.07f);
        b.beam(front + s * h - w, front + s * h + w, 0.07f, 0.07f);
    }
    b.beam(front - 1.2f * w - h - 0.06f * up, front + 1.2f * w - h - 0.06f * up, 0.2f, 0.06f);
}

/// A house with a gable roof, a chimney and a porch; its front looks along +x of its frame.
void add_house(scene_builder& b, const palette& m, glm::vec2 at, float yaw, glm::vec3 size,
               std::uint8_t wall, std::uint8_t roof) {
    b.place({at.x, ground(at.x, at.y) + 0.3f, at.y}, yaw);
    const float x = 0.5f * size.x;
    const float z = 0.5f * size.z;
    const float y = size.y;
    const float ridge = y + 0.42f * size.x;
    b.use(m.stone);
    b.box({-x - 0.05f, -2.5f, -z - 0.05f}, {x + 0.05f, 0.25f, z + 0.05f});
    b.use(wall);
    b.box({-x, 0.25f, -z}, {x, y, z});
    for (const float side : {-1.0f, 1.0f}) {
        b.triangle({-x, y, side * z}, {x, y, side * z}, {0.0f, ridge, side * z});
    }
    b.use(roof);
    const float over = 0.55f;
    const float drop = over * (ridge - y) / x;
    for (const float side : {-1.0f, 1.0f}) {
        const glm::vec3 eave(side * (x + over), y - drop, 0.0f);
        const glm::vec3 top(0.0f, ridge, 0.0f);
        const glm::vec3 thick(0.0f, 0.16f, 0.0f);
        const glm::vec3 along(0.0f, 0.0f, z + over);
        b.quad(eave - along + thick, eave + along + thick, top + along + thick,
               top - along + thick);
        b.quad(eave - along, eave + along, top + along, top - along);
        b.quad(eave - along, eave + along, eave + along + thick, eave - along + thick);
        for (const float end : {-1.0f, 1.0f}) {
            b.quad(eave + end * along, top + end * along, top + end * along + thick,
                   eave + end * along + thick);
        }
    }
    b.use(m.stone);
    b.box({-0.55f * x - 0.35f, y, 0.35f * z}, {-0.55f * x + 0.35f, ridge + 0.9f, 0.35f * z + 0.7f});

    const int windows = std::max(2, static_cast<int>(size.z / 2.6f));
    for (int i = 0; i < windows; ++i) {
        const float p = -z + size.z * (static_cast<float>(i) + 0.5f) / static_cast<float>(windows);
        for (float level = 1.65f; level < y - 0.7f; level += 2.7f) {
            add_window(b, m, {-x, level, p}, {0, 0, 1}, {-1, 0, 0}, 1.0f, 1.25f);
            if (i != windows / 2 || level > 2.5f) {
                add_window(b, m, {x, level, p}, {0, 0, -1}, {1, 0, 0}, 1.0f, 1.25f);
            }
        }
        if (i == windows / 2) {
            b.use(m.wood);
            b.box({x - 0.01f, 0.25f, p - 0.5f}, {x + 0.05f, 2.35f, p + 0.5f});
        }
    }
    for (const float side : {-1.0f, 1.0f}) {
        add_window(b, m, {-0.4f * x, 1.65f, side * z}, {side, 0, 0}, {0, 0, side}, 1.0f, 1.25f);
        add_window(b, m, {0.4f * x, 1.65f, side * z}, {side, 0, 0}, {0, 0, side}, 1.0f, 1.25f);
        add_window(b, m, {0.0f, y + 0.12f * size.x, side * z}, {side, 0, 0}, {0, 0, side}, 0.8f,
                   0.9f);
    }
    // porch: floor, posts, railing, a lean-to roof
    const float depth = 1.9f;
    b.use(m.wood);
    b.box({x, -0.6f, -0.8f * z}, {x + depth, 0.22f, 0.8f * z});
    b.use(m.paint);
    const int posts = std::max(3, static_cast<int>(size.z / 2.2f));
    for (int i = 0; i <= posts; ++i) {
        const float p = -0.78f * z + 1.56f * z * static_cast<float>(i) / static_cast<float>(posts);
        b.box({x + depth - 0.14f, 0.22f, p - 0.06f}, {x + depth - 0.02f, 2.5f, p + 0.06f});
        if (i == posts || i == posts / 2) {
            continue;
        }
        const float next = p + 1.56f * z / static_cast<float>(posts);
        b.beam({x + depth - 0.08f, 1.05f, p}, {x + depth - 0.08f, 1.05f, next}, 0.07f, 0.05f);
        for (float s = p + 0.14f; s < next - 0.08f; s += 0.13f) {
            b.box({x + depth - 0.1f, 0.22f, s - 0.015f}, {x + depth - 0.06f, 1.05f, s + 0.015f});
        }
    }
    b.use(roof);
    b.quad({x, 3.0f, -0.85f * z}, {x, 3.0f, 0.85f * z}, {x + depth + 0.25f, 2.5f, 0.85f * z},
           {x + depth + 0.25f, 2.5f, -0.85f * z});
    b.quad({x, 2.9f, -0.85f * z}, {x, 2.9f, 0.85f * z}, {x + depth + 0.25f, 2.4f, 0.85f * z},
           {x + depth + 0.25f, 2.4f, -0.85f * z});
    b.place({0, 0, 0});
}

void add_bench(scene_builder& b, const palette& m, glm::vec2 at, float yaw) {
    b.place({at.x, ground(at.x, at.y), at.y}, yaw);
    b.use(m.wood);
    for (int i = 0; i < 4; ++i) {
        const float z = 0.08f + 0.11f * static_cast<float>(i);
        b.box({-0.85f, 0.43f, z}, {0.85f, 0.46f, z + 0.085f});
    }
    for (int i = 0; i < 3; ++i) {
        const float y = 0.56f + 0.13f * static_cast<float>(i);
        b.box({-0.85f, y, 0.015f - 0.03f * static_cast<float>(i)},
              {0.85f, y + 0.1f, 0.045f - 0.03f * static_cast<float>(i)});
    }
    b.use(m.iron);
    for (const float x : {-0.75f, 0.75f}) {
        b.beam({x, -0.15f, 0.06f}, {x, 0.95f, -0.05f}, 0.05f, 0.05f);
        b.beam({x, -0.15f, 0.48f}, {x, 0.44f, 0.48f}, 0.05f, 0.05f);
        b.beam({x, 0.42f, 0.06f}, {x, 0.42f, 0.5f}, 0.05f, 0.05f);
        b.beam({x, 0.68f, 0.02f}, {x, 0.64f, 0.48f}, 0.05f, 0.04f);
        b.beam({x, 0.44f, 0.46f}, {x, 0.65f, 0.46f}, 0.04f, 0.04f);
    }
    b.place({0, 0, 0});
}

void add_tufts(scene_builder& b, const palette& m, int count) {
    for (int i = 0; i < count; ++i) {
        const float z = -28.0f * b.random.unit() * b.random.unit() + 4.0f;
        const float side = b.random.unit() < 0.5f ? -1.0f : 1.0f;
        const float x = path_x(z) + side * (1.0f + 9.0f * b.random.unit() * b.random.unit());
        const glm::vec3 foot(x, ground(x, z) - 0.01f, z);
        b.use(b.random.unit() < 0.25f ? m.straw : m.grass);
        const int blades = 5 + b.random.below(5);
        for (int k = 0; k < blades; ++k) {
            const glm::vec3 d = b.random.direction();
            const glm::vec3 tip =
                foot + glm::vec3(0.09f * d.x, b.random.range(0.10f, 0.26f), 0.09f * d.z);
            const glm::vec3 base = foot + glm::vec3(0.04f * d.z, 0.0f, 0.04f * d.y);
            const glm::vec3 w(0.007f * d.z, 0.0f, -0.007f * d.x);
            b.triangle(base - w, base + w, tip);
        }
    }
}

} // namespace

scene build_outdoor(unsigned seed) {
    scene_builder b("outdoor", seed);
    palette m{};
    m.grass = b.add_material(0x8c9a52, 0.35f);
    m.dirt = b.add_material(0xb59b72, 0.25f);
    m.bark = b.add_material(0x6d5a47, 0.3f);
    m.leaf = b.add_material(0x5f7d33, 0.4f);
    m.light_leaf = b.add_material(0x8a9a3f, 0.4f);
    m.needles = b.add_material(0x3f6040, 0.35f);
    m.paint = b.add_material(0xf1eee6, 0.04f);
    m.wall = b.add_material(0xe0d2b8, 0.06f);
    m.warm_wall = b.add_material(0xb9684f, 0.1f);
    m.roof = b.add_material(0xa04a35, 0.15f);
    m.slate = b.add_material(0x5d6470, 0.15f);
    m.wood = b.add_material(0x93704a, 0.2f);
    m.glass = b.add_material(0x2c3a45);
    m.stone = b.add_material(0x9b958a, 0.2f);
    m.iron = b.add_material(0x33363a);
    m.straw = b.add_material(0xc6b56d, 0.3f);

    add_ground(b, m);
    std::vector<glm::vec2> left;
    for (float z = 3.0f; z > -62.0f; z -= 5.0f) {
        left.emplace_back(path_x(z) - 2.3f - 0.012f * (3.0f - z), z);
    }
    add_fence(b, m, left);
    add_fence(b, m, {{path_x(-30.0f) + 3.0f, -30.0f}, {15.0f, -33.0f}, {24.0f, -33.0f}});

    add_house(b, m, {-17.0f, -36.0f}, 0.25f, {8.0f, 5.6f, 12.0f}, m.wall, m.roof);
    add_house(b, m, {19.0f, -52.0f}, pi - 0.2f, {7.5f, 3.2f, 10.0f}, m.warm_wall, m.slate);
    add_house(b, m, {-34.0f, -86.0f}, 0.5f, {9.0f, 5.6f, 14.0f}, m.paint, m.slate);
    add_house(b, m, {30.0f, -120.0f}, pi + 0.35f, {9.0f, 5.6f, 13.0f}, m.wall, m.roof);
    add_house(b, m, {-12.0f, -165.0f}, 0.1f, {12.0f, 6.2f, 20.0f}, m.warm_wall, m.roof);
    add_bench(b, m, {path_x(-6.5f) + 2.2f, -6.5f}, -0.5f * pi + 0.15f);
    add_bench(b, m, {path_x(-24.0f) + 2.0f, -24.0f}, -0.5f * pi);

    const auto on_ground = [](float x, float z) { return glm::vec3(x, ground(x, z), z); };
    for (int i = 0; i < 26; ++i) {
        b.use(m.stone);
        const float z = -70.0f * b.random.unit() + 2.0f;
        const float x = path_x(z) + (b.random.unit() < 0.5f ? -1.0f : 1.0f) *
                                        (1.3f + 12.0f * b.random.unit() * b.random.unit());
        const float r = b.random.range(0.08f, 0.45f);
        b.ellipsoid(on_ground(x, z), {r, 0.7f * r, 1.2f * r}, 12, 0.35f);
    }
    add_tufts(b, m, 900);

    // a lamp over the path
    b.use(m.iron);
    const glm::vec3 lamp = on_ground(path_x(-12.0f) + 2.6f, -12.0f);
    b.tube(lamp - glm::vec3(0, 0.3f, 0), lamp + glm::vec3(0, 5.2f, 0), 0.07f, 0.05f, 8);
    b.tube(lamp + glm::vec3(0, 5.2f, 0), lamp + glm::vec3(-1.2f, 5.5f, 0), 0.04f, 0.04f, 6);
    b.tube(lamp + glm::vec3(-1.2f, 5.62f, 0), lamp + glm::vec3(-1.2f, 5.45f, 0), 0.08f, 0.3f, 12);

    // near trees with small leaves, farther ones with fewer and larger leaves
    b.broad_tree(on_ground(9.5f, -15.0f), {9.5f, 4, 14, 0.21f, m.bark, m.leaf});
    b.broad_tree(on_ground(-9.0f, -12.0f), {8.0f, 4, 12, 0.2f, m.bark, m.light_leaf});
    b.broad_tree(on_ground(14.0f, 1.0f), {10.0f, 3, 40, 0.3f, m.bark, m.leaf});
    for (const glm::vec2 p : {glm::vec2(8.0f, -34.0f),
                              {-9.5f, -52.0f},
                              {12.0f, -66.0f},
                              {-24.0f, -22.0f},
                              {24.0f, -24.0f},
                              {-20.0f, -62.0f},
                              {6.0f, -84.0f},
                              {-9.0f, -98.0f},
                              {33.0f, -70.0f}}) {
        b.broad_tree(on_ground(p.x, p.y), {b.random.range(7.0f, 11.0f), 3, 16, 0.42f, m.bark,
                                           b.random.unit() < 0.4f ? m.light_leaf : m.leaf});
    }
    for (int i = 0; i < 105; ++i) {
        const float z = -110.0f - 215.0f * b.random.unit();
        const float side = b.random.unit() < 0.5f ? -1.0f : 1.0f;
        const float x = path_x(z) + side * (9.0f + 150.0f * std::pow(b.random.unit(), 1.4f));
        if (b.random.unit() < 0.45f) {
            b.broad_tree(on_ground(x, z), {b.random.range(7.0f, 12.0f), 2, 13, 0.85f, m.bark,
                                           b.random.unit() < 0.3f ? m.light_leaf : m.leaf});
        } else {
            b.conifer(on_ground(x, z), b.random.range(9.0f, 17.0f), 11, 11, m.bark, m.needles);
        }
    }
    for (int i = 0; i < 60; ++i) {
        const float z = 40.0f - 150.0f * b.random.unit();
        const float side = b.random.unit() < 0.5f ? -1.0f : 1.0f;
        const float x = path_x(z) + side * (38.0f + 130.0f * b.random.unit());
        b.conifer(on_ground(x, z), b.random.range(8.0f, 15.0f), 11, 11, m.bark, m.needles);
    }

    const double eye_height = static_cast<double>(ground(0.3f, 4.5f)) + 1.55;
    b.add_camera({0.3, eye_height, 4.5}, {-1.1, eye_height - 1.1, -9.0}, 55.0);
    b.add_camera({34.0, 26.0, 30.0}, {-8.0, 0.0, -55.0}, 50.0);
    b.add_camera({static_cast<double>(path_x(-16.0f)) + 1.2,
                  static_cast<double>(ground(1.0f, -16.0f)) + 1.7, -16.0},
                 {-16.0, 2.0, -36.0}, 55.0);
    b.add_sun({0.82, -0.52, -0.28});
    b.add_sun({0.35, -1.0, 0.25});
    b.add_sun({-0.55, -0.42, 0.75});
    const glm::dvec3 bulb = glm::dvec3(lamp) + glm::dvec3(-1.2, 5.4, 0.0);
    b.add_spot(bulb, bulb + glm::dvec3(-0.6, -5.0, 1.6), 110.0);
    return b.take();
}

} // namespace lab
