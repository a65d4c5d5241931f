// Paths of the lab's camera, what is counted along them, and the maps that the CPU chooses.
#include "lab/light_maps.hpp"
#include "lab/path.hpp"
#include "lab/scene.hpp"

#include <warpshadow/cube.hpp>

#include <catch2/catch.hpp>

#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace {

namespace ws = warpshadow;

const lab::camera_view start{"0", {1.0, 2.0, 3.0}, {1.0, 2.0, -7.0}, 1.0};

lab::scene room() {
    lab::scene world;
    world.name = "room";
    world.box = {{-5.0, 0.0, -8.0}, {5.0, 4.0, 8.0}};
    world.cameras = {start, {"1", {0.0, 1.0, 0.0}, {4.0, 1.0, 1.0}, 0.5}};
    return world;
}

double angle_between(glm::dvec3 a, glm::dvec3 b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

} // namespace

TEST_CASE("a yaw turns by a tenth of a degree a frame and stays where it is") {
    const std::vector<lab::camera_view> path = lab::camera_path("yaw", room(), start, 50);
    REQUIRE(path.size() == 50);
    CHECK(path[0].target == start.target);
    for (std::size_t i = 1; i < path.size(); ++i) {
        CHECK(path[i].eye == start.eye);
        CHECK(angle_between(path[i].target - path[i].eye, path[i - 1].target - path[i - 1].eye) ==
              Approx(std::numbers::pi / 1800.0).epsilon(1e-9));
    }
}

TEST_CASE("an orbit keeps its target in sight at the same distance") {
    for (const lab::camera_view& each : lab::camera_path("orbit", room(), start, 20)) {
        CHECK(glm::length(each.target - start.target) == 0.0);
        CHECK(glm::length(each.eye - each.target) == Approx(10.0).epsilon(1e-12));
    }
}

TEST_CASE("forward and strafe move without turning") {
    for (const char* const name : {"forward", "strafe"}) {
        const std::vector<lab::camera_view> path = lab::camera_path(name, room(), start, 11);
        for (std::size_t i = 0; i < path.size(); ++i) {
            const glm::dvec3 moved = path[i].eye - start.eye;
            CHECK(glm::length(moved - (path[i].target - start.target)) < 1e-12);
            CHECK(glm::length(moved) == Approx(0.01 * static_cast<double>(i)).margin(1e-12));
        }
    }
    CHECK(lab::camera_path("strafe", room(), start, 2)[1].eye.x > start.eye.x);
    CHECK(lab::camera_path("forward", room(), start, 2)[1].eye.z < start.eye.z);
}

TEST_CASE("a walk begins at the first camera and ends at the last") {
    const lab::scene world = room();
    const std::vector<lab::camera_view> path = lab::camera_path("walk", world, start, 31);
    REQUIRE(path.size() == 31);
    CHECK(glm::length(path.front().eye - world.cameras[0].eye) < 1e-12);
    CHECK(glm::length(path.back().eye - world.cameras[1].eye) < 1e-12);
    CHECK(path.back().fov_y == Approx(0.5));
    double longest = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        longest = std::max(longest, glm::length(path[i].eye - path[i - 1].eye));
    }
    CHECK(longest < 0.1 * glm::length(world.cameras[1].eye - world.cameras[0].eye));
}

TEST_CASE("flips are counted on surfaces that both frames see") {
    // a wall at z = -1 of 4 × 1 pixels, seen twice by a camera at the origin
    const glm::mat4 camera = lab::camera_matrix(
        lab::camera_frustum(room(), {"", {0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 1.0}, {4, 1}));
    lab::g_buffer_samples before;
    before.size = {4, 1};
    for (int i = 0; i < 4; ++i) {
        const glm::vec4 clip(-0.75f + 0.5f * static_cast<float>(i), 0.0f, 0.0f, 1.0f);
        const glm::vec4 far_point = glm::inverse(camera) * clip;
        const glm::vec3 ray(far_point / far_point.w);
        before.position.emplace_back(ray / -ray.z, 1.0f);
        before.normal.emplace_back(0.0f, 0.0f, 1.0f);
        before.n_dot_l.push_back(i == 3 ? 0.05f : 0.5f); // the last is at grazing light
    }
    const std::array<std::uint8_t, 4> shadowed{0, 0, 1, 0};
    const std::array<std::uint8_t, 4> again{1, 0, 1, 1};
    CHECK(lab::flip_ratio(before, shadowed, shadowed, before, camera) == 0.0);
    CHECK(lab::flip_ratio(before, shadowed, again, before, camera).value() ==
          Approx(1.0 / 3.0)); // of three that count, one
    // something stands before the first pixel now: two are left, and none of them flips
    lab::g_buffer_samples now = before;
    now.position[0] *= glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
    CHECK(lab::flip_ratio(before, shadowed, again, now, camera) == 0.0);
    // looking away, nothing is seen again
    const glm::mat4 back = lab::camera_matrix(
        lab::camera_frustum(room(), {"", {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 1.0}, {4, 1}));
    CHECK_FALSE(lab::flip_ratio(before, shadowed, again, before, back));
}

TEST_CASE("means along a path leave out frames without a value") {
    lab::path_record record;
    record.frames = {{std::nullopt, std::nullopt, 1.5, 3.0, 1.0, 6},
                     {0.2, 0.5, -1.5, 1.0, 1.0, 2},
                     {0.4, 0.1, -1.4, 2.0, 1.0, 1}};
    const lab::path_means means = lab::means_of(record);
    CHECK(means.wrong_ratio.value() == Approx(0.3));
    CHECK(means.flip_ratio.value() == Approx(0.3));
    CHECK(means.frame_ms == 2.0);
    CHECK(means.maps == Approx(3.0));
    // 3 radians are a half turn less pi - 3, and a square map has four sides
    CHECK(means.largest_turn == Approx(std::numbers::pi - 3.0));
}

TEST_CASE("the minimal maps of the lab hold what the camera sees and a light can reach") {
    const lab::scene world = room();
    std::mt19937 random(7); // NOLINT: a fixed seed makes the test repeat
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto inside = [&] {
        return glm::mix(world.box.lo, world.box.hi,
                        glm::dvec3(unit(random), unit(random), unit(random)));
    };
    int looked_up = 0;
    for (int turn = 0; turn < 200; ++turn) {
        const lab::camera_view camera{"", inside(), inside(), 0.3 + unit(random)};
        const ws::frustum<double> view = lab::camera_frustum(world, camera, {16, 9});
        const std::array<lab::light_view, 3> lights{
            lab::light_view{"sun", ws::sun(inside() - inside())},
            lab::light_view{"spot", ws::spot_light(inside(), inside(), 1.0)},
            lab::light_view{"point", ws::point_light(inside())}};
        const glm::mat4 clip_from_world = lab::camera_matrix(view);
        for (const lab::light_view& light : lights) {
            lab::light_memory memory;
            const lab::light_maps maps = lab::minimal_maps(world, view, light, 256, memory);
            REQUIRE(maps.maps.size() ==
                    (light.light.kind == ws::light_kind::point ? std::size_t{6} : std::size_t{1}));
            for (int i = 0; i < 50; ++i) {
                const glm::dvec3 p = inside();
                const glm::dvec4 seen = glm::dmat4(clip_from_world) * glm::dvec4(p, 1.0);
                const glm::dvec3 from_light = p - light.light.position;
                const bool in_view = seen.w > 0.0 && std::abs(seen.x) < 0.999 * seen.w &&
                                     std::abs(seen.y) < 0.999 * seen.w && seen.z > -seen.w;
                const bool in_cone = light.light.kind != ws::light_kind::spot ||
                                     angle_between(from_light, light.light.direction) < 0.499;
                if (!in_view || !in_cone) {
                    continue;
                }
                const int face = light.light.kind == ws::light_kind::point
                                     ? ws::cube_lookup(from_light).face
                                     : 0;
                const lab::light_map& map = maps.maps[static_cast<std::size_t>(face)];
                REQUIRE(map.used);
                const glm::dvec4 clip = map.matrix * glm::dvec4(p, 1.0);
                REQUIRE(clip.w > 0.0);
                REQUIRE(std::abs(clip.x) <= clip.w);
                REQUIRE(std::abs(clip.y) <= clip.w);
                ++looked_up;
            }
        }
    }
    CHECK(looked_up > 1000);
}

TEST_CASE("cascades hold what the camera sees, with texels that turning does not change") {
    const lab::scene world = room();
    std::mt19937 random(11); // NOLINT: a fixed seed makes the test repeat
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto inside = [&] {
        return glm::mix(world.box.lo, world.box.hi,
                        glm::dvec3(unit(random), unit(random), unit(random)));
    };
    int looked_up = 0;
    std::array<int, 4> of_map{};
    for (int turn = 0; turn < 200; ++turn) {
        const glm::dvec3 eye = inside();
        const double fov = 0.3 + unit(random);
        const lab::light_view light{"sun", ws::sun(inside() - inside())};
        std::vector<double> texels;
        std::vector<double> splits;
        for (int look = 0; look < 3; ++look) {
            const ws::frustum<double> view =
                lab::camera_frustum(world, {"", eye, inside(), fov}, {16, 9});
            const lab::light_maps maps = lab::cascade_maps(world, view, light, 4, 128);
            REQUIRE(maps.maps.size() == 4);
            REQUIRE(maps.choice == lab::map_choice::view_depth);
            for (std::size_t i = 0; i < maps.maps.size(); ++i) {
                // of rows that are orthogonal, the first is two texels over the side's length
                const glm::dvec3 across = glm::dvec3(glm::row(maps.maps[i].matrix, 0));
                const double texel = 2.0 / (128.0 * glm::length(across));
                if (look == 0) {
                    texels.push_back(texel);
                } else {
                    REQUIRE(texel == Approx(texels[i]).epsilon(1e-12));
                }
            }
            REQUIRE((look == 0 || maps.splits == splits));
            splits = maps.splits;
            const glm::dmat4 clip_from_world(lab::camera_matrix(view));
            for (int i = 0; i < 50; ++i) {
                const glm::dvec3 p = inside();
                const glm::dvec4 seen = clip_from_world * glm::dvec4(p, 1.0);
                if (seen.w <= 0.0 || std::abs(seen.x) >= 0.999 * seen.w ||
                    std::abs(seen.y) >= 0.999 * seen.w || seen.z <= -seen.w) {
                    continue;
                }
                const double depth = glm::dot(maps.depth_plane, glm::dvec4(p, 1.0));
                const auto map = static_cast<std::size_t>(std::count_if(
                    splits.begin(), splits.end(), [&](double split) { return depth >= split; }));
                const glm::dvec4 clip = maps.maps[map].matrix * glm::dvec4(p, 1.0);
                REQUIRE(glm::all(
                    glm::lessThanEqual(glm::abs(glm::dvec3(clip)), glm::dvec3(1.0 + 1e-9))));
                ++of_map[map];
                ++looked_up;
            }
        }
        REQUIRE(splits.size() == 3);
        REQUIRE(std::is_sorted(texels.begin(), texels.end()));
    }
    CHECK(looked_up > 1000);
    CHECK(of_map[0] > 100);
    CHECK(of_map[3] > 0);
}

TEST_CASE("lispsm under a spot light keeps a depth range although casters reach to the light") {
    // this view once had all depths within 1e-10 of each other, and three of four pixels wrong
    const lab::scene world = lab::build_scene("leaves", 1);
    const ws::frustum<double> view = lab::camera_frustum(world, world.cameras.at(1), {16, 12});
    const lab::light_view& light = world.lights.at(2);
    REQUIRE(light.light.kind == ws::light_kind::spot);
    const lab::light_maps maps = lab::lispsm_maps(world, view, light);
    REQUIRE(maps.maps.size() == 1);
    const glm::dvec3 axis = glm::normalize(light.light.direction);
    const double reach = lab::farthest_along(world.box, light.light.position, axis);
    double lo = 1.0;
    double hi = -1.0;
    for (const double share : {0.1, 0.2, 0.4, 0.8}) {
        const glm::dvec4 clip =
            maps.maps[0].matrix * glm::dvec4(light.light.position + share * reach * axis, 1.0);
        lo = std::min(lo, clip.z / clip.w);
        hi = std::max(hi, clip.z / clip.w);
    }
    // depths of a perspective map with near at 2^-10 of far: 2 near / (1 - near) · (1 / 0.1 - 1 /
    // 0.8) in NDC, or 0.017; a warp's own w takes a share of it
    CHECK(hi - lo > 0.001);
}
