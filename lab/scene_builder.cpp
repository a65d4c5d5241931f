#include "lab/scene_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lab {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

std::uint32_t hashed(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

float lattice(glm::ivec3 p, std::uint32_t seed) {
    const std::uint32_t h = hashed(
        static_cast<std::uint32_t>(p.x) +
        hashed(static_cast<std::uint32_t>(p.y) + hashed(static_cast<std::uint32_t>(p.z) + seed)));
    return static_cast<float>(h >> 8) * (2.0f / 16777216.0f) - 1.0f;
}

/// Two directions across `axis`, unit length.
void frame_about(glm::vec3 axis, glm::vec3& u, glm::vec3& v) {
    const glm::vec3 hint =
        std::abs(axis.y) < 0.9f * glm::length(axis) ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    u = glm::normalize(glm::cross(hint, axis));
    v = glm::normalize(glm::cross(axis, u));
}

float linear_from_srgb(std::uint32_t byte) {
    const float s = static_cast<float>(byte) / 255.0f;
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

} // namespace

random_source::random_source(std::uint64_t seed) : state_(seed * 2654435761u + 88172645463325252u) {
    bits();
}

std::uint32_t random_source::bits() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005u + 1442695040888963407u;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<std::uint32_t>(old >> 59);
    return (shifted >> turn) | (shifted << ((32u - turn) & 31u));
}

float random_source::unit() {
    return static_cast<float>(bits() >> 8) * (1.0f / 16777216.0f);
}

float random_source::range(float lo, float hi) {
    return lo + (hi - lo) * unit();
}

int random_source::below(int count) {
    return static_cast<int>(unit() * static_cast<float>(count));
}

glm::vec3 random_source::direction() {
    const float z = range(-1.0f, 1.0f);
    const float angle = range(0.0f, 2.0f * pi);
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {r * std::cos(angle), z, r * std::sin(angle)};
}

float value_noise(glm::vec3 p, std::uint32_t seed) {
    const glm::vec3 cell = glm::floor(p);
    const glm::ivec3 i(cell);
    const glm::vec3 f = p - cell;
    const glm::vec3 t = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
    const auto at = [&](int x, int y, int z) { return lattice(i + glm::ivec3(x, y, z), seed); };
    const float low = glm::mix(glm::mix(at(0, 0, 0), at(1, 0, 0), t.x),
                               glm::mix(at(0, 1, 0), at(1, 1, 0), t.x), t.y);
    const float high = glm::mix(glm::mix(at(0, 0, 1), at(1, 0, 1), t.x),
                                glm::mix(at(0, 1, 1), at(1, 1, 1), t.x), t.y);
    return glm::mix(low, high, t.z);
}

scene_builder::scene_builder(std::string_view name, unsigned seed) : random(seed) {
    scene_.name = name;
}

std::uint8_t scene_builder::add_material(std::uint32_t srgb, float variation) {
    scene_.materials.push_back(
        {glm::vec3(linear_from_srgb(srgb >> 16 & 255u), linear_from_srgb(srgb >> 8 & 255u),
                   linear_from_srgb(srgb & 255u)),
         variation});
    return static_cast<std::uint8_t>(scene_.materials.size() - 1);
}

void scene_builder::use(std::uint8_t material) {
    begin_part();
    material_ = material;
}

void scene_builder::begin_part() {
    if (!in_tree_ && (scene_.parts.empty() || scene_.parts.back() < scene_.triangles.size())) {
        scene_.parts.push_back(scene_.triangles.size());
    }
}

void scene_builder::place(glm::vec3 origin, float yaw) {
    begin_part();
    origin_ = origin;
    cosine_ = std::cos(yaw);
    sine_ = std::sin(yaw);
}

glm::vec3 scene_builder::placed(glm::vec3 p) const {
    return origin_ + glm::vec3(cosine_ * p.x + sine_ * p.z, p.y, cosine_ * p.z - sine_ * p.x);
}

void scene_builder::triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const auto first = static_cast<unsigned>(scene_.positions.size());
    scene_.positions.insert(scene_.positions.end(), {placed(a), placed(b), placed(c)});
    scene_.triangles.emplace_back(first, first + 1, first + 2);
    scene_.material_of.push_back(material_);
}

void scene_builder::quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    const auto first = static_cast<unsigned>(scene_.positions.size());
    scene_.positions.insert(scene_.positions.end(), {placed(a), placed(b), placed(c), placed(d)});
    scene_.triangles.emplace_back(first, first + 1, first + 2);
    scene_.triangles.emplace_back(first, first + 2, first + 3);
    scene_.material_of.insert(scene_.material_of.end(), 2, material_);
}

void scene_builder::box(glm::vec3 lo, glm::vec3 hi) {
    const auto at = [&](int x, int y, int z) {
        return glm::vec3(x == 0 ? lo.x : hi.x, y == 0 ? lo.y : hi.y, z == 0 ? lo.z : hi.z);
    };
    quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
    quad(at(1, 0, 0), at(0, 0, 0), at(0, 1, 0), at(1, 1, 0));
    quad(at(1, 0, 1), at(1, 0, 0), at(1, 1, 0), at(1, 1, 1));
    quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
    quad(at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), at(0, 1, 0));
    quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
}

void scene_builder::beam(glm::vec3 from, glm::vec3 to, float across, float up) {
    const glm::vec3 along = to - from;
    const glm::vec3 hint =
        std::abs(along.y) < 0.9f * glm::length(along) ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
    const glm::vec3 u = 0.5f * across * glm::normalize(glm::cross(hint, along));
    const glm::vec3 v = 0.5f * up * glm::normalize(glm::cross(along, u));
    const auto at = [&](int end, float s, float t) {
        return (end == 0 ? from : to) + s * u + t * v;
    };
    quad(at(0, -1, -1), at(0, 1, -1), at(0, 1, 1), at(0, -1, 1));
    quad(at(1, 1, -1), at(1, -1, -1), at(1, -1, 1), at(1, 1, 1));
    quad(at(0, 1, -1), at(1, 1, -1), at(1, 1, 1), at(0, 1, 1));
    quad(at(1, -1, -1), at(0, -1, -1), at(0, -1, 1), at(1, -1, 1));
    quad(at(0, 1, 1), at(1, 1, 1), at(1, -1, 1), at(0, -1, 1));
    quad(at(0, -1, -1), at(1, -1, -1), at(1, 1, -1), at(0, 1, -1));
}

void scene_builder::tube(glm::vec3 from, glm::vec3 to, float radius_from, float radius_to,
                         int sides, bool caps) {
    glm::vec3 u;
    glm::vec3 v;
    frame_about(to - from, u, v);
    for (int i = 0; i < sides; ++i) {
        const float a = 2.0f * pi * static_cast<float>(i) / static_cast<float>(sides);
        const float b = 2.0f * pi * static_cast<float>((i + 1) % sides) / static_cast<float>(sides);
        const glm::vec3 ra = std::cos(a) * u + std::sin(a) * v;
        const glm::vec3 rb = std::cos(b) * u + std::sin(b) * v;
        if (radius_to > 0.0f && radius_from > 0.0f) {
            quad(from + radius_from * ra, from + radius_from * rb, to + radius_to * rb,
                 to + radius_to * ra);
        } else if (radius_from > 0.0f) {
            triangle(from + radius_from * ra, from + radius_from * rb, to);
        } else {
            triangle(from, to + radius_to * rb, to + radius_to * ra);
        }
        if (caps && radius_from > 0.0f) {
            triangle(from, from + radius_from * rb, from + radius_from * ra);
        }
        if (caps && radius_to > 0.0f) {
            triangle(to, to + radius_to * ra, to + radius_to * rb);
        }
    }
}

void scene_builder::ellipsoid(glm::vec3 centre, glm::vec3 radii, int sides, float roughness) {
    const int stacks = std::max(3, sides / 2);
    const std::uint32_t seed = random.bits();
    const auto at = [&](int stack, int side) {
        const float polar = pi * static_cast<float>(stack) / static_cast<float>(stacks);
        const float around =
            2.0f * pi * static_cast<float>(side % sides) / static_cast<float>(sides);
        const glm::vec3 d(std::sin(polar) * std::cos(around), std::cos(polar),
                          std::sin(polar) * std::sin(around));
        return centre + radii * d * (1.0f + roughness * value_noise(2.5f * d, seed));
    };
    for (int stack = 0; stack < stacks; ++stack) {
        for (int side = 0; side < sides; ++side) {
            const glm::vec3 a = at(stack, side);
            const glm::vec3 b = at(stack, side + 1);
            const glm::vec3 c = at(stack + 1, side + 1);
            const glm::vec3 d = at(stack + 1, side);
            if (stack == 0) {
                triangle(a, c, d);
            } else if (stack == stacks - 1) {
                triangle(a, b, c);
            } else {
                quad(a, b, c, d);
            }
        }
    }
}

void scene_builder::ring(glm::vec3 centre, glm::vec3 axis, float radius, float thickness,
                         int segments, int sides) {
    glm::vec3 u;
    glm::vec3 v;
    frame_about(axis, u, v);
    const glm::vec3 up = glm::normalize(axis);
    const auto at = [&](int i, int k) {
        const float a = 2.0f * pi * static_cast<float>(i % segments) / static_cast<float>(segments);
        const float c = 2.0f * pi * static_cast<float>(k % sides) / static_cast<float>(sides);
        const glm::vec3 out = std::cos(a) * u + std::sin(a) * v;
        return centre + (radius + thickness * std::cos(c)) * out + thickness * std::sin(c) * up;
    };
    for (int i = 0; i < segments; ++i) {
        for (int k = 0; k < sides; ++k) {
            quad(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
        }
    }
}

void scene_builder::leaf(glm::vec3 base, glm::vec3 direction, glm::vec3 side, float length,
                         float width) {
    const glm::vec3 along = length * glm::normalize(direction);
    glm::vec3 across = glm::cross(side, along);
    const float size = glm::length(across);
    if (!(size > 0.0f)) {
        glm::vec3 other;
        frame_about(along, across, other);
    } else {
        across /= size;
    }
    const glm::vec3 fold = 0.15f * width * glm::normalize(glm::cross(along, across));
    const glm::vec3 middle = base + 0.45f * along + fold;
    triangle(base, middle + 0.5f * width * across, base + along);
    triangle(base, base + along, middle - 0.5f * width * across);
}

void scene_builder::leaf_cluster(glm::vec3 centre, float radius, int count, float size) {
    for (int i = 0; i < count; ++i) {
        const glm::vec3 d = random.direction();
        const float r = radius * std::cbrt(random.unit());
        const glm::vec3 hang =
            glm::normalize(random.direction() + glm::vec3(0.0f, -0.4f, 0.0f) + 0.8f * d);
        const float length = size * random.range(0.7f, 1.3f);
        leaf(centre + r * d, hang, random.direction(), length, 0.55f * length);
    }
}

void scene_builder::branch(glm::vec3 from, glm::vec3 direction, float length, float radius,
                           int level, const tree& shape) {
    use(shape.bark);
    const int sides = level == 0 ? 9 : level == 1 ? 6 : 4;
    const glm::vec3 bend = 0.12f * random.direction();
    const glm::vec3 middle = from + 0.5f * length * direction;
    const glm::vec3 second = glm::normalize(direction + bend + glm::vec3(0.0f, 0.08f, 0.0f));
    const glm::vec3 tip = middle + 0.5f * length * second;
    tube(from, middle, radius, 0.8f * radius, sides, false);
    tube(middle, tip, 0.8f * radius, 0.6f * radius, sides, false);
    if (level == shape.levels) {
        use(shape.leaf);
        leaf_cluster(tip, 0.75f * length, shape.leaves, shape.leaf_size);
        return;
    }
    const int children = level == 0 ? 5 : 3 + random.below(2);
    glm::vec3 u;
    glm::vec3 v;
    frame_about(second, u, v);
    const float turn = random.range(0.0f, 2.0f * pi);
    for (int i = 0; i < children; ++i) {
        const float around = turn + 2.0f * pi *
                                        (static_cast<float>(i) + random.range(-0.25f, 0.25f)) /
                                        static_cast<float>(children);
        const float open = (level == 0 ? 0.75f : 0.65f) * random.range(0.75f, 1.2f);
        const glm::vec3 out = std::cos(around) * u + std::sin(around) * v;
        const glm::vec3 d = glm::normalize(std::cos(open) * second + std::sin(open) * out +
                                           glm::vec3(0.0f, 0.12f, 0.0f));
        const glm::vec3 start = glm::mix(middle, tip, random.range(0.55f, 1.0f));
        branch(start, d, length * random.range(0.62f, 0.8f), 0.55f * radius, level + 1, shape);
    }
    // the leader goes on, so that crowns are not hollow at the top
    branch(tip, glm::normalize(second + 0.25f * random.direction() + glm::vec3(0, 0.3f, 0)),
           0.72f * length, 0.58f * radius, level + 1, shape);
}

void scene_builder::broad_tree(glm::vec3 foot, const tree& shape) {
    const float length = 0.36f * shape.height;
    begin_part();
    in_tree_ = true;
    branch(
        foot - glm::vec3(0.0f, 0.3f, 0.0f),
        glm::normalize(glm::vec3(random.range(-0.06f, 0.06f), 1.0f, random.range(-0.06f, 0.06f))),
        length, 0.034f * shape.height, 0, shape);
    in_tree_ = false;
    begin_part();
}

void scene_builder::conifer(glm::vec3 foot, float height, int tiers, int points, std::uint8_t bark,
                            std::uint8_t needles) {
    begin_part();
    in_tree_ = true;
    use(bark);
    tube(foot - glm::vec3(0.0f, 0.3f, 0.0f), foot + glm::vec3(0.0f, 0.95f * height, 0.0f),
         0.022f * height, 0.004f * height, 6, false);
    use(needles);
    for (int tier = 0; tier < tiers; ++tier) {
        const float t = static_cast<float>(tier) / static_cast<float>(tiers);
        const float y = height * (0.12f + 0.8f * t);
        const float reach = height * 0.24f * (1.0f - t) + 0.03f * height;
        const float turn = random.range(0.0f, 2.0f * pi);
        const glm::vec3 top = foot + glm::vec3(0.0f, y + 0.1f * height, 0.0f);
        for (int i = 0; i < points; ++i) {
            const float step = 2.0f * pi / static_cast<float>(points);
            const float a = turn + step * (static_cast<float>(i) + random.range(-0.2f, 0.2f));
            const float r = reach * random.range(0.75f, 1.1f);
            const auto rim = [&](float angle, float radius, float drop) {
                return foot +
                       glm::vec3(radius * std::cos(angle), y - drop, radius * std::sin(angle));
            };
            const glm::vec3 point = rim(a, r, 0.22f * reach);
            triangle(top, rim(a - 0.42f * step, 0.5f * r, 0.0f), point);
            triangle(top, point, rim(a + 0.42f * step, 0.5f * r, 0.0f));
        }
    }
    in_tree_ = false;
    begin_part();
}

void scene_builder::add_camera(glm::dvec3 eye, glm::dvec3 target, double fov_y_degrees) {
    scene_.cameras.push_back(
        {std::to_string(scene_.cameras.size()), eye, target, glm::radians(fov_y_degrees)});
}

void scene_builder::add_sun(glm::dvec3 direction) {
    scene_.lights.push_back({std::to_string(scene_.lights.size()), warpshadow::sun(direction)});
}

void scene_builder::add_spot(glm::dvec3 position, glm::dvec3 target, double angle_degrees) {
    scene_.lights.push_back(
        {std::to_string(scene_.lights.size()),
         warpshadow::spot_light(position, target, glm::radians(angle_degrees))});
}

scene scene_builder::take() {
    scene_.box = box_of(scene_.positions);
    return std::move(scene_);
}

warpshadow::box3<double> box_of(std::span<const glm::vec3> positions) {
    glm::vec3 lo = positions.front();
    glm::vec3 hi = lo;
    for (const glm::vec3& p : positions) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    return {glm::dvec3(lo), glm::dvec3(hi)};
}

} // namespace lab
