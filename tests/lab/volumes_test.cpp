// Shadow volumes: their edges, what they count, and whether rays say the same.
#include "gl/context.hpp"
#include "lab/measure.hpp"
#include "lab/truth.hpp"
#include "lab/volumes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

namespace ws = warpshadow;

namespace {

constexpr glm::ivec2 view(160, 120);

void add_quad(lab::scene& world, std::initializer_list<glm::vec3> corners) {
    const auto first = static_cast<unsigned>(world.positions.size());
    world.positions.insert(world.positions.end(), corners);
    world.triangles.emplace_back(first, first + 1, first + 2);
    world.triangles.emplace_back(first, first + 2, first + 3);
}

/// A level square around a point of the y axis.
void add_square(lab::scene& world, float height, float half) {
    add_quad(world, {{-half, height, -half},
                     {-half, height, half},
                     {half, height, half},
                     {half, height, -half}});
}

/// A floor of side 40 at height 0 and nothing over it.
lab::scene floor_alone() {
    lab::scene world;
    world.name = "floor";
    add_square(world, 0.0f, 20.0f);
    world.box = {{-20.0, 0.0, -20.0}, {20.0, 10.0, 20.0}};
    return world;
}

lab::light_view sun(glm::dvec3 direction) {
    return {"sun", ws::sun(direction)};
}

/// What the volumes and the rays make of one view.
struct answers {
    lab::g_buffer_samples samples;
    std::vector<float> counts;
    std::vector<std::uint8_t> volumes;
    std::vector<std::uint8_t> rays;
    std::vector<std::uint8_t> near_rays; ///< that start a tenth as far from the surface
    std::vector<std::uint8_t> hidden;    ///< 1: the eye does not see the sample

    /// Share of the counted samples on which volumes and rays agree.
    [[nodiscard]] double agreement() const {
        const lab::comparison c = lab::compare(samples, rays, volumes);
        return 1.0 - c.ratio(c.false_shadow + c.false_light).value();
    }

    /// The same where rays are sure of what is seen.
    ///
    /// Not where another start of the rays gives another answer; and not where the eye does not see
    /// the sample: rasterisers move corners by up to 1/512 of a pixel, so at an outline a sample
    /// may lie behind a surface, in the dark, while the surface before it is lit.
    [[nodiscard]] double agreement_of_the_sure() const {
        lab::g_buffer_samples sure = samples;
        for (std::size_t i = 0; i < hidden.size(); ++i) {
            sure.position[i].w =
                hidden[i] != 0 || rays[i] != near_rays[i] ? 0.0f : sure.position[i].w;
        }
        const lab::comparison c = lab::compare(sure, rays, volumes);
        return 1.0 - c.ratio(c.false_shadow + c.false_light).value();
    }
};

answers ask(const lab::scene& world, const lab::camera_view& camera, const lab::light_view& light) {
    answers result;
    lab::renderer renderer(world, view);
    result.samples = renderer.samples(camera, light);
    lab::passes gpu(world, view);
    lab::volume_passes volumes(gpu);
    lab::g_buffer seen(view);
    volumes.frame(seen, camera, light);
    gl::check("shadow volumes");
    result.counts = volumes.counts();
    result.volumes = gpu.shadowed();

    const lab::ray_tracer rays(world);
    result.rays = rays.shadows(result.samples, light).shadowed;
    lab::g_buffer_samples near = result.samples;
    const auto back = static_cast<float>(-0.9 * rays.origin_offset());
    std::vector<glm::dvec3> eyes;
    std::vector<glm::dvec3> beyond;
    for (std::size_t i = 0; i < near.position.size(); ++i) {
        const glm::dvec3 p(near.position[i]);
        eyes.push_back(camera.eye);
        beyond.push_back(camera.eye + 1.01 * (p - camera.eye));
        near.position[i] += glm::vec4(back * near.normal[i], 0.0f);
    }
    result.near_rays = rays.shadows(near, light).shadowed;
    const std::vector<double> hits = rays.first_hits(eyes, beyond);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        // how far above the sample's plane the way from the eye ends
        const double gap =
            (1.0 - 1.01 * hits[i]) * glm::dot(eyes[i] - glm::dvec3(result.samples.position[i]),
                                              glm::dvec3(result.samples.normal[i]));
        result.hidden.push_back(gap > 2e-5 ? 1 : 0);
    }
    return result;
}

} // namespace

TEST_CASE("edges: each once, with all triangles that run along it") {
    // two triangles at an edge, their corners doubled, and a third one the other way round
    const std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0},  {1, 0, 0},
                                           {0, 0, 0}, {0, 0, 1}, {0, -1, 0}, {-0.0f, 0, 0}};
    const std::vector<glm::uvec3> triangles{{0, 1, 2}, {3, 4, 5}, {7, 1, 6}};
    const lab::volume_edges found = lab::edges_of(positions, triangles);
    CHECK(found.edges.size() == 7);
    CHECK(found.runs.size() == 9);
    std::size_t runs = 0;
    for (const glm::uvec4& edge : found.edges) {
        CHECK(edge.x < edge.y);
        CHECK(edge.z == runs);
        runs += edge.w;
        if (edge.x == 0 && edge.y == 1) {
            REQUIRE(edge.w == 3);
            const auto first = found.runs.begin() + static_cast<std::ptrdiff_t>(edge.z);
            CHECK(std::vector<std::uint32_t>(first, first + 3) ==
                  std::vector<std::uint32_t>{0, 3, 4});
        } else {
            CHECK(edge.w == 1);
        }
    }
    CHECK(runs == found.runs.size());

    // no length, no edge; both ways along the two others
    const std::vector<glm::uvec3> flat{{0, 4, 2}};
    const lab::volume_edges of_flat = lab::edges_of(positions, flat);
    REQUIRE(of_flat.edges.size() == 1);
    CHECK(of_flat.edges[0].w == 2);
    CHECK((of_flat.runs[0] ^ of_flat.runs[1]) == 1u);
    CHECK(lab::edges_of({}, {}).edges.empty());
}

TEST_CASE("volumes count every surface on the way to the light") {
    const gl::headless_context context;
    lab::scene world = floor_alone();
    constexpr int squares = 700; // a stencil of eight bits would count 700 - 512 or, of 512, none
    for (int i = 0; i < squares; ++i) {
        add_square(world, 2.0f + 0.005f * static_cast<float>(i), 3.0f);
    }
    const lab::light_view above = sun({0.0, -1.0, 0.0});
    for (const lab::camera_view& camera :
         {lab::camera_view{"from the light", {12.0, 9.0, 0.5}, {0.0, 0.0, 0.0}, 1.0},
          lab::camera_view{"from the shadow", {0.3, 1.0, 0.2}, {9.0, 0.0, 1.0}, 1.2}}) {
        CAPTURE(camera.label);
        const answers found = ask(world, camera, above);
        int in_all = 0;
        int in_none = 0;
        for (std::size_t i = 0; i < found.counts.size(); ++i) {
            const glm::vec4 p = found.samples.position[i];
            // the casters themselves, the background and the edge of the shadow
            if (p.w == 0.0f || p.y > 1.0f ||
                std::abs(std::max(std::abs(p.x), std::abs(p.z)) - 3.0f) < 1e-3f) {
                continue;
            }
            const bool below = std::max(std::abs(p.x), std::abs(p.z)) < 3.0f;
            REQUIRE(found.counts[i] == (below ? static_cast<float>(squares) : 0.0f));
            REQUIRE(found.volumes[i] == (below ? 1 : 0));
            ++(below ? in_all : in_none);
        }
        CHECK(in_all > 100);
        CHECK(in_none > 1000);
    }
}

TEST_CASE("volumes hold for lights and eyes anywhere, and for triangles of any kind") {
    const gl::headless_context context;
    // boxes without tops, turned at random, and triangles by themselves
    lab::scene world = floor_alone();
    std::mt19937 random(5); // NOLINT: a fixed seed makes the test repeat
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const auto place = [&] {
        const float x = 12.0f * unit(random) - 6.0f;
        const float y = 4.0f * unit(random);
        return glm::vec3(x, y, 12.0f * unit(random) - 6.0f);
    };
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 a = place();
        const glm::vec3 b = a + 0.4f * place();
        const glm::vec3 c = a + 0.4f * place();
        const auto first = static_cast<unsigned>(world.positions.size());
        world.positions.insert(world.positions.end(), {a, b, c, 0.5f * (a + b)});
        world.triangles.emplace_back(first, first + 1, first + 2);
        if (i % 3 == 0) { // one more at half of an edge, one more at the whole, and that one again
            world.positions.push_back(b - 0.2f * place());
            world.triangles.emplace_back(first, first + 3, first + 4);
            world.triangles.emplace_back(first + 4, first + 1, first);
            world.triangles.emplace_back(first, first + 1, first + 4);
        }
        const glm::vec3 foot(a.x, 0.0f, a.z);
        for (int side = 0; i % 4 == 0 && side < 4; ++side) {
            const float s = side % 2 == 0 ? 0.5f : -0.5f;
            const glm::vec3 u = side < 2 ? glm::vec3(s, 0.0f, 0.5f) : glm::vec3(0.5f, 0.0f, s);
            const glm::vec3 v = side < 2 ? glm::vec3(s, 0.0f, -0.5f) : glm::vec3(-0.5f, 0.0f, s);
            const glm::vec3 up(0.0f, 1.0f, 0.0f);
            add_quad(world, {foot + u, foot + v, foot + v + up, foot + u + up});
        }
    }
    struct lit_view {
        const char* name;
        lab::camera_view camera;
        lab::light_view light;
    };
    const lab::camera_view outside{"", {9.0, 6.0, 9.0}, {0.0, 0.5, 0.0}, 1.0};
    const lab::camera_view inside{"", {0.2, 1.6, 0.3}, {4.0, 0.2, 2.0}, 1.2};
    for (const lit_view& each : {
             lit_view{"sun", outside, sun({0.4, -1.0, 0.2})},
             lit_view{"low sun behind", inside, sun({4.0, -1.0, 2.0})},
             lit_view{"sun in view", inside, sun({-4.0, -1.2, -2.0})},
             lit_view{"lamp in view", outside, {"", ws::point_light(glm::dvec3(0.1, 2.0, 0.3))}},
             // with the eye at the light nearly all the ways from what is seen end in volumes
             lit_view{"lamp at the eye", inside, {"", ws::point_light(glm::dvec3(0.1, 1.7, 0.3))}},
             lit_view{"lamp behind", inside, {"", ws::point_light(glm::dvec3(-4.0, 3.0, -2.0))}},
             lit_view{"spot",
                      outside,
                      {"", ws::spot_light(glm::dvec3(-5.0, 6.0, 1.0), glm::dvec3(0.0), 1.0)}},
         }) {
        CAPTURE(each.name);
        const answers found = ask(world, each.camera, each.light);
        const lab::comparison c = lab::compare(found.samples, found.rays, found.volumes);
        const auto dark = static_cast<std::size_t>(
            std::count(found.rays.begin(), found.rays.end(), std::uint8_t{1}));
        CHECK(c.samples > 1000);
        CHECK(dark > 150);
        CHECK(found.agreement() >= 0.999);
        CHECK(found.agreement_of_the_sure() >= 0.9995);
    }
}

TEST_CASE("volumes and rays agree on every built-in scene") {
    const gl::headless_context context;
    for (const lab::scene_summary& summary : lab::builtin_scenes()) {
        const lab::scene world = lab::build_scene(summary.name, 1);
        for (std::size_t camera = 0; camera < 2; ++camera) {
            for (std::size_t light = 0; light < 3; ++light) {
                CAPTURE(world.name, camera, light);
                const answers found = ask(world, world.cameras.at(camera), world.lights.at(light));
                CHECK(found.agreement_of_the_sure() >= 0.999);
                CHECK(found.agreement() >= 0.997);
                const auto hidden = static_cast<std::size_t>(
                    std::count(found.hidden.begin(), found.hidden.end(), std::uint8_t{1}));
                CHECK(hidden < found.hidden.size() / 100);
            }
        }
    }
}
