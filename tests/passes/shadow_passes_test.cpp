// The passes that soften shadows, on whatever OpenGL there is, against the same steps on the host.
#include "gl/context.hpp"
#include "gl/objects.hpp"
#include "passes/compute_pass.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace {

std::size_t index_of(glm::ivec2 size, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(x);
}

/// Samples as the blur's hook reads them: light, depth, 1 for a surface.
struct picture {
    glm::ivec2 size;
    std::vector<glm::vec4> samples;

    picture(int width, int height)
        : size(width, height),
          samples(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                  glm::vec4(0.0f)) {}
    void put(int x, int y, float light, float depth) {
        samples[index_of(size, x, y)] = glm::vec4(light, depth, 1.0f, 0.0f);
    }
    [[nodiscard]] glm::dvec4 at(int x, int y) const {
        if (x < 0 || y < 0 || x >= size.x || y >= size.y) {
            return glm::dvec4(0.0);
        }
        return glm::dvec4(samples[index_of(size, x, y)]);
    }
};

struct blur_settings {
    float full_depth;
    float edge;
};

/// One direction of one iteration on the device.
std::vector<float> blur_on_device(const picture& source, glm::ivec2 axis,
                                  const blur_settings& settings) {
    const gl::program blur = pass(R"(
layout(std430, binding = 1) readonly buffer sample_buffer { vec4 sample_list[]; };
uniform ivec2 view_size;
ivec2 ws_view_size() { return view_size; }
bool ws_blur_sample(ivec2 pixel, out float light, out float depth)
{
    vec4 s = sample_list[pixel.y * view_size.x + pixel.x];
    light = s.x;
    depth = s.y;
    return s.z != 0.0;
}
#include "passes/eye_blur.glsl"
)");
    const gl::buffer list(std::span<const glm::vec4>(source.samples));
    list.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
    const gl::texture result(GL_R32F, source.size.x, source.size.y);
    result.bind_image(0, GL_WRITE_ONLY);
    blur.set("view_size", source.size);
    blur.set("ws_blur_axis", axis);
    blur.set("ws_blur_full_depth", settings.full_depth);
    blur.set("ws_blur_edge", settings.edge);
    blur.dispatch(source.size.x, source.size.y);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    return result.read<float>();
}

/// Whether two samples in a row lie on one surface: the step between them continues a step beside.
bool joined(const glm::dvec4 (&row)[4], double edge) {
    double nearness[4];
    for (int i = 0; i < 4; ++i) {
        nearness[i] = row[i].z != 0.0 ? 1.0 / row[i].y : 0.0;
    }
    if (nearness[1] == 0.0 || nearness[2] == 0.0) {
        return false;
    }
    const double allowed = edge * std::min(nearness[1], nearness[2]);
    const double step = nearness[2] - nearness[1];
    return (nearness[0] != 0.0 && std::abs(step - (nearness[1] - nearness[0])) <= allowed) ||
           (nearness[3] != 0.0 && std::abs((nearness[3] - nearness[2]) - step) <= allowed);
}

std::vector<double> blur_on_host(const picture& source, glm::ivec2 axis,
                                 const blur_settings& settings) {
    std::vector<double> result;
    for (int y = 0; y < source.size.y; ++y) {
        for (int x = 0; x < source.size.x; ++x) {
            const auto along = [&](int k) { return source.at(x + k * axis.x, y + k * axis.y); };
            const glm::dvec4 own = along(0);
            if (own.z == 0.0) {
                result.push_back(0.0);
                continue;
            }
            const double share = std::min(1.0, static_cast<double>(settings.full_depth) / own.y);
            double light = own.x;
            for (const int side : {-1, 1}) {
                const glm::dvec4 row[4] = {along(-side), own, along(side), along(2 * side)};
                if (joined(row, static_cast<double>(settings.edge))) {
                    light += 0.25 * share * share * (row[2].x - own.x);
                }
            }
            result.push_back(light);
        }
    }
    return result;
}

/// Two tilted planes, one before the other, background above them, and holes.
picture two_planes(unsigned seed) {
    picture result(53, 37);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> any(0.0f, 1.0f);
    for (int y = 0; y < 37; ++y) {
        for (int x = 0; x < 53; ++x) {
            const bool before = x >= 20 && x < 38 && y >= 9;
            const float nearness = before ? 0.25f + 0.002f * static_cast<float>(x)
                                          : 0.02f + 0.003f * static_cast<float>(37 - y);
            if (y > 33 || any(random) < 0.02f) {
                continue;
            }
            result.put(x, y, any(random), 1.0f / nearness);
        }
    }
    return result;
}

} // namespace

TEST_CASE("passes: the blur is that of the host") {
    const gl::headless_context context;
    for (const unsigned seed : {1u, 2u, 3u}) {
        const picture source = two_planes(seed);
        for (const float full_depth : {1e30f, 10.0f, 0.5f}) {
            for (const glm::ivec2 axis : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
                const blur_settings settings{full_depth, 0.01f};
                const std::vector<float> device = blur_on_device(source, axis, settings);
                const std::vector<double> host = blur_on_host(source, axis, settings);
                REQUIRE(device.size() == host.size());
                double worst = 0.0;
                for (std::size_t i = 0; i < host.size(); ++i) {
                    worst = std::max(worst, std::abs(static_cast<double>(device[i]) - host[i]));
                }
                // two mixtures of numbers in 0..1, a weight of three roundings and GLSL's division
                // of 2.5 ulp, squared: below 20 roundings of 2^-24
                CHECK(worst <= 20.0 * 0x1p-24);
            }
        }
    }
}

TEST_CASE("passes: what the blur keeps") {
    const gl::headless_context context;
    const glm::ivec2 across(1, 0);
    SECTION("light does not cross a silhouette, however often it is blurred") {
        picture source(64, 16);
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 64; ++x) {
                // a lit wall at depth 2 before a dark one that leans away
                const bool before = x < 32;
                source.put(x, y, before ? 1.0f : 0.0f,
                           before ? 2.0f : 1.0f / (0.1f - 0.001f * static_cast<float>(x)));
            }
        }
        for (int i = 0; i < 8; ++i) {
            for (const glm::ivec2 axis : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
                const std::vector<float> light = blur_on_device(source, axis, {1e30f, 0.01f});
                for (std::size_t k = 0; k < light.size(); ++k) {
                    source.samples[k].x = light[k];
                }
            }
        }
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 64; ++x) {
                REQUIRE(source.at(x, y).x == (x < 32 ? 1.0 : 0.0));
            }
        }
    }
    SECTION("on one plane, however steep, the edge of a shadow spreads by n s / 2") {
        picture source(96, 8);
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 96; ++x) {
                // depths from 1.05 to 20: neighbours differ by a tenth
                source.put(x, y, x < 48 ? 1.0f : 0.0f,
                           1.0f / (0.95f - 0.0094f * static_cast<float>(x)));
            }
        }
        const int iterations = 6;
        for (int i = 0; i < iterations; ++i) {
            const std::vector<float> light = blur_on_device(source, across, {1e30f, 0.01f});
            for (std::size_t k = 0; k < light.size(); ++k) {
                source.samples[k].x = light[k];
            }
        }
        // the steps of the edge are the distribution of its place
        double mean = 0.0;
        double square = 0.0;
        for (int x = 1; x < 96; ++x) {
            const double step = source.at(x - 1, 4).x - source.at(x, 4).x;
            mean += step * x;
            square += step * x * x;
        }
        CHECK(mean == Approx(48.0).epsilon(1e-5));
        CHECK(square - mean * mean == Approx(0.5 * iterations).epsilon(1e-3));
    }
    SECTION("it is weaker with depth, and what has no light gets none") {
        picture source(32, 2);
        for (int x = 0; x < 32; ++x) {
            source.put(x, 0, x < 16 ? 1.0f : 0.0f, 10.0f);
            source.put(x, 1, x < 16 ? 1.0f : 0.0f, 40.0f);
        }
        source.samples[index_of(source.size, 3, 0)] = glm::vec4(1.0f, 10.0f, 0.0f, 0.0f);
        const std::vector<float> light = blur_on_device(source, across, {10.0f, 0.01f});
        CHECK(light[index_of(source.size, 15, 0)] == 0.75f);
        CHECK(light[index_of(source.size, 16, 0)] == 0.25f);
        CHECK(light[index_of(source.size, 15, 1)] == 1.0f - 0.25f / 16.0f);
        CHECK(light[index_of(source.size, 16, 1)] == 0.25f / 16.0f);
        CHECK(light[index_of(source.size, 3, 0)] == 0.0f);
        CHECK(light[index_of(source.size, 4, 0)] == 1.0f);
    }
}

TEST_CASE("passes: percentage closer filtering is that of the host") {
    const gl::headless_context context;
    const gl::program filter = pass(R"(
layout(std430, binding = 1) readonly buffer receiver_buffer { vec4 receivers[]; };
layout(binding = 0) uniform sampler2D depths;
uniform ivec2 view_size;
ivec2 ws_view_size() { return view_size; }
ivec2 ws_map_size() { return textureSize(depths, 0); }
vec4 receiver_of(ivec2 pixel) { return receivers[pixel.y * view_size.x + pixel.x]; }
bool ws_receiver(ivec2 pixel, out vec2 p)
{
    p = receiver_of(pixel).xy;
    return receiver_of(pixel).w != 0.0;
}
float ws_texel_light(ivec2 pixel, ivec2 texel)
{
    return texelFetch(depths, texel, 0).r < receiver_of(pixel).z ? 0.0 : 1.0;
}
#include "passes/pcf.glsl"
)");
    const glm::ivec2 view(61, 43);
    const std::size_t count = static_cast<std::size_t>(view.x) * static_cast<std::size_t>(view.y);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> any(0.0f, 1.0f);
    for (const glm::ivec2 map : {glm::ivec2(1, 1), glm::ivec2(2, 3), glm::ivec2(16, 16)}) {
        std::vector<float> depths(static_cast<std::size_t>(map.x) *
                                  static_cast<std::size_t>(map.y));
        std::generate(depths.begin(), depths.end(), [&] { return any(random); });
        gl::texture depth_map(GL_R32F, map.x, map.y);
        depth_map.write(depths.data());
        depth_map.bind(0);
        std::vector<glm::vec4> receivers;
        for (std::size_t i = 0; i < count; ++i) {
            glm::vec4 r(1.2f * any(random) - 0.1f, 1.2f * any(random) - 0.1f, any(random), 1.0f);
            if (i % 7 == 0) { // on the centre of a texel: that texel alone
                r.x = (std::floor(any(random) * static_cast<float>(map.x)) + 0.5f) /
                      static_cast<float>(map.x);
            }
            r.w = i % 13 == 5 ? 0.0f : 1.0f;
            receivers.push_back(r);
        }
        const gl::buffer list{std::span<const glm::vec4>(receivers)};
        list.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
        gl::texture light(GL_R32F, view.x, view.y);
        light.clear(glm::vec4(-1.0f));
        light.bind_image(0, GL_WRITE_ONLY);
        filter.set("view_size", view);
        filter.dispatch(view.x, view.y);
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        const std::vector<float> device = light.read<float>();
        double worst = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec4 r(receivers[i]);
            if (r.w == 0.0) {
                REQUIRE(device[i] == -1.0f);
                continue;
            }
            // each texel weighs by how much of it a square of one texel around the sample covers
            double sum = 0.0;
            const glm::dvec2 at = glm::dvec2(r) * glm::dvec2(map);
            const glm::ivec2 own(glm::floor(at));
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx) {
                    const glm::dvec2 centre = glm::dvec2(own + glm::ivec2(dx, dy)) + 0.5;
                    const glm::dvec2 overlap =
                        glm::max(1.0 - glm::abs(at - centre), glm::dvec2(0.0));
                    const glm::ivec2 texel =
                        glm::clamp(own + glm::ivec2(dx, dy), glm::ivec2(0), map - 1);
                    const auto stored = depths[static_cast<std::size_t>(texel.y * map.x + texel.x)];
                    sum += overlap.x * overlap.y * (stored < receivers[i].z ? 0.0 : 1.0);
                }
            }
            worst = std::max(worst, std::abs(sum - static_cast<double>(device[i])));
        }
        // a weight is off by the rounding of the place in texels, up to 2^-24 · 16 · 2 on either
        // axis, and by those of the mixtures
        CHECK(worst <= 128.0 * 0x1p-24);
    }
}
