// Maps that are turned to the axis of their importance.
#include "gl/context.hpp"
#include "lab/align.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace ws = warpshadow;

namespace {

constexpr int cells = 64;

lab::scene ground() {
    lab::scene world;
    world.name = "ground";
    world.positions = {{0.0f, 0.0f, 0.0f}, {10.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 4.0f}};
    world.triangles = {{0u, 1u, 2u}};
    world.box = {glm::dvec3(0.0), glm::dvec3(10.0, 1.0, 4.0)};
    world.cameras.push_back({"0", {5.0, 8.0, 2.0}, {5.0, 0.0, 2.1}, 1.0});
    world.lights.push_back({"sun", ws::sun(glm::dvec3(0.0, -1.0, 0.0))});
    world.lights.push_back(
        {"spot", ws::spot_light(glm::dvec3(5.0, 6.0, 2.0), glm::dvec3(5.0, 0.0, 2.0), 1.5)});
    return world;
}

/// Place in the map of a point.
glm::dvec2 place(const glm::dmat4& matrix, glm::dvec3 p) {
    const glm::dvec4 clip = matrix * glm::dvec4(p, 1.0);
    return glm::dvec2(clip) / clip.w * 0.5 + 0.5;
}

} // namespace

TEST_CASE("extents of maps") {
    const lab::scene world = ground();
    const glm::dvec2 sun =
        lab::extent_of(lab::whole_scene_maps(world, world.lights[0]).maps.front().matrix);
    CHECK(std::max(sun.x, sun.y) == Approx(10.0));
    CHECK(std::min(sun.x, sun.y) == Approx(4.0));
    const glm::dvec2 spot =
        lab::extent_of(lab::whole_scene_maps(world, world.lights[1]).maps.front().matrix);
    CHECK(spot.x == Approx(2.0 * std::tan(0.75)));
    CHECK(spot.y == Approx(2.0 * std::tan(0.75)));
}

TEST_CASE("a map is turned until its importance lies along a side, and keeps all it held") {
    const lab::scene world = ground();
    const gl::headless_context context;
    lab::passes gpu(world, {8, 8});
    const lab::g_buffer seen({8, 8});
    for (const lab::light_view& light : world.lights) {
        CAPTURE(light.label);
        const lab::light_maps chosen = lab::whole_scene_maps(world, light);
        gpu.use(seen, chosen, light.light);
        const glm::dmat4 before(gpu.matrix_in_use(0));
        // samples along a line on the ground, in the middle of the map
        const glm::dvec3 from(4.0, 0.0, 1.3);
        const glm::dvec3 to(6.0, 0.0, 2.7);
        std::vector<std::uint32_t> counts(cells * cells);
        for (int i = 0; i <= 1000; ++i) {
            const glm::dvec2 p =
                place(before, glm::mix(from, to, i / 1000.0)) * static_cast<double>(cells);
            ++counts[static_cast<std::size_t>(static_cast<int>(p.y) * cells +
                                              static_cast<int>(p.x))];
        }
        ws::axis_state state;
        const double angle = lab::turn_to_importance(gpu, 0, counts, cells, 0.0, state);
        CHECK(std::abs(angle) > 0.1);
        CHECK(std::abs(angle) <= 0.25 * std::numbers::pi + 1e-9);
        CHECK(angle == state.angle);
        const glm::dmat4 after(gpu.matrix_in_use(0));
        const glm::dvec2 side = lab::extent_of(after);
        const glm::dvec2 line = glm::abs(place(after, to) - place(after, from)) * side;
        CHECK(std::min(line.x, line.y) < 0.05 * std::max(line.x, line.y));
        // a turn: lengths stay, and what was in the map still is
        const glm::dvec2 old = (place(before, to) - place(before, from)) * lab::extent_of(before);
        CHECK(glm::length(line) == Approx(glm::length(old)).epsilon(1e-4));
        const glm::dmat4 back = glm::inverse(before);
        for (const glm::dvec2 corner : {glm::dvec2(-1.0, -1.0), glm::dvec2(1.0, -1.0),
                                        glm::dvec2(-1.0, 1.0), glm::dvec2(1.0, 1.0)}) {
            const glm::dvec4 world_corner = back * glm::dvec4(corner, 0.0, 1.0);
            const glm::dvec2 p = place(after, glm::dvec3(world_corner) / world_corner.w);
            CHECK(p.x > -1e-4);
            CHECK(p.x < 1.0001);
            CHECK(p.y > -1e-4);
            CHECK(p.y < 1.0001);
        }
        // nothing to see: the map stays
        std::fill(counts.begin(), counts.end(), 0u);
        CHECK(lab::turn_to_importance(gpu, 0, counts, cells, angle, state) == angle);
    }
}
