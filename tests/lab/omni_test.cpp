// Maps of point lights: what culling leaves out is never seen, and what cutting bends is bounded.
#include "gl/context.hpp"
#include "lab/measure.hpp"
#include "lab/methods.hpp"
#include "lab/omni.hpp"
#include "lab/scene_builder.hpp"
#include "lab/scene_detail.hpp"
#include "lab/tables.hpp"
#include "lab/truth.hpp"
#include "lab/vpl.hpp"

#include <warpshadow/cube.hpp>
#include <warpshadow/paraboloid.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <utility>

namespace ws = warpshadow;

namespace {

/// Camera, light and scene triples: 160, or fewer where they are not optimised.
int triples() {
#ifdef NDEBUG
    const int usual = 160;
#else
    const int usual = 24;
#endif
    const char* const asked = std::getenv("WARPSHADOW_OMNI_TRIPLES");
    return asked == nullptr ? usual : std::max(std::atoi(asked), 1);
}

/// Of so many triples one is drawn with tables too; of all where a number was asked for.
int warped_triples() {
    return std::getenv("WARPSHADOW_OMNI_TRIPLES") == nullptr ? triples() / 4 : 1;
}

/// The same for one pass that draws all maps, which geometry shaders make slow.
int layered_triples() {
    return std::getenv("WARPSHADOW_OMNI_TRIPLES") == nullptr ? 3 : 1; // odd: one view and two
}

constexpr glm::ivec2 view{64, 48};
constexpr int triples_of_a_scene = 8;

/// A floor and boxes of all sizes in all directions, each an object.
lab::scene boxes(unsigned seed) {
    lab::scene_builder b("boxes", seed);
    const std::uint8_t stone = b.add_material(0x9b958a);
    b.use(stone);
    b.box({-20, -6.2f, -20}, {20, -6, 20});
    const int count = 10 + b.random.below(60);
    for (int i = 0; i < count; ++i) {
        b.use(stone);
        const glm::vec3 at = 9.0f * b.random.unit() * b.random.direction();
        const glm::vec3 half(b.random.range(0.05f, 1.5f), b.random.range(0.05f, 1.5f),
                             b.random.range(0.05f, 1.5f));
        b.box(at - half, at + half);
    }
    b.add_camera({0, 0, 12}, {0, 0, 0}, 60.0);
    b.add_sun({0, -1, 0});
    return b.take();
}

/// What one camera sees, with its answers.
struct eye {
    explicit eye() : seen(view) {}
    lab::camera_view camera;
    ws::frustum<double> frustum{};
    lab::g_buffer seen;
};

class random_views {
  public:
    explicit random_views(unsigned seed) : random_(seed) {}

    double in(double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(random_);
    }
    glm::dvec3 place(double reach) { return {in(-reach, reach), in(-5.5, 6.0), in(-reach, reach)}; }
    lab::camera_view camera() {
        return {"random", place(14.0), place(14.0), glm::radians(in(5.0, 100.0))};
    }
    lab::light_view light() { return {"random", ws::point_light(place(16.0))}; }
    /// A light seen by the camera, or at its very eye.
    lab::light_view light_near(const lab::camera_view& camera) {
        return {"random", ws::point_light(
                              glm::mix(camera.eye, camera.target, in(0.0, 1.0) < 0.3 ? 0.0 : 0.5))};
    }

  private:
    std::mt19937 random_;
};

/// Fills all maps with what shadows everything: a face that is read without being drawn shows.
void poison(lab::map_resources& maps) {
    maps.all_layers.bind();
    glClearDepth(0.0);
    glClear(GL_DEPTH_BUFFER_BIT);
    glClearDepth(1.0);
}

int maps_in_use(const lab::light_maps& chosen) {
    return static_cast<int>(std::count_if(chosen.maps.begin(), chosen.maps.end(),
                                          [](const lab::light_map& each) { return each.used; }));
}

/// One scene on the device.
class stage {
  public:
    explicit stage(unsigned seed)
        : world_(boxes(seed)), gpu_(world_, view), omni_(gpu_), tables_(gpu_), raster_(gpu_),
          faces_(32, 6, 0, 0), hemispheres_(32, 2, 0, 0), warped_faces_(32, 6, 32, 32),
          warped_hemispheres_(32, 2, 32, 32) {}

    void look(eye& e, const lab::camera_view& camera) {
        e.camera = camera;
        e.frustum = lab::camera_frustum(world_, camera, view);
        gpu_.draw_view(e.seen, lab::camera_matrix(e.frustum), glm::vec3(camera.eye));
    }

    /// The answers of one set of maps to all eyes.
    std::vector<std::uint8_t> shadows(std::span<const eye> eyes, const lab::light_view& light,
                                      const lab::omni_way& way) {
        lab::map_resources& maps = way.hemispheres ? hemispheres_ : faces_;
        std::vector<ws::frustum<double>> cameras;
        for (const eye& each : eyes) {
            cameras.push_back(each.frustum);
        }
        poison(maps);
        lab::light_maps chosen = lab::omni_maps(world_, cameras, light, way);
        gpu_.use(eyes.front().seen, chosen, light.light);
        omni_.draw(maps, chosen, light, way);
        maps_drawn = maps_in_use(chosen);
        std::vector<std::uint8_t> result;
        for (const eye& each : eyes) {
            gpu_.use(each.seen);
            if (way.hemispheres) {
                omni_.test_hemispheres(maps, chosen, light, false);
            } else {
                gpu_.test_shadows(maps, chosen, false);
            }
            const std::vector<std::uint8_t> mask = gpu_.shadowed();
            result.insert(result.end(), mask.begin(), mask.end());
        }
        return result;
    }

    /// The same with tables, for one eye: they are made for what it sees.
    std::vector<std::uint8_t> warped_shadows(const eye& seen, const lab::light_view& light,
                                             const lab::omni_way& way) {
        lab::map_resources& maps = way.hemispheres ? warped_hemispheres_ : warped_faces_;
        lab::light_maps chosen = lab::omni_maps(world_, std::span(&seen.frustum, 1), light, way);
        gpu_.use(seen.seen, chosen, light.light);
        maps_drawn = maps_in_use(chosen);
        do {
            raster_.forget_counts();
            omni_.raster().forget_counts();
            poison(maps);
            for (std::size_t i = 0; i < chosen.maps.size(); ++i) {
                if (!chosen.maps[i].used) {
                    continue;
                }
                gpu_.crop_to_desired_view(maps, i);
                tables_.build(maps, i, {}, seen.frustum, {}, false);
                if (way.hemispheres) {
                    omni_.draw_warped(maps, i, light, true);
                } else {
                    raster_.draw_map(maps, i, {}, nullptr, true);
                }
            }
        } while (raster_.grow_lists() || omni_.raster().grow_lists());
        if (way.hemispheres) {
            omni_.test_hemispheres(maps, chosen, light, true);
        } else {
            gpu_.test_shadows(maps, chosen, true);
        }
        return gpu_.shadowed();
    }

    [[nodiscard]] std::size_t triangles() const { return omni_.triangles(); }
    [[nodiscard]] const lab::scene& world() const { return world_; }

    int maps_drawn = 0; ///< by the last `shadows`

  private:
    lab::scene world_;
    lab::passes gpu_;
    lab::omni_passes omni_;
    lab::table_passes tables_;
    lab::warped_raster raster_;
    lab::map_resources faces_, hemispheres_, warped_faces_, warped_hemispheres_;
};

constexpr std::array cube_ways{
    lab::omni_way{.cull_objects = true},
    lab::omni_way{.cull_maps = true},
    lab::omni_way{.cull_maps = true, .cull_objects = true},
    lab::omni_way{.layered = true},
    lab::omni_way{.cull_objects = true, .layered = true},
    lab::omni_way{.cull_maps = true, .cull_objects = true, .layered = true}};
constexpr std::array paraboloid_ways{
    lab::omni_way{.hemispheres = true, .cull_objects = true},
    lab::omni_way{.hemispheres = true, .cull_maps = true},
    lab::omni_way{.hemispheres = true, .cull_maps = true, .cull_objects = true},
    lab::omni_way{.hemispheres = true, .layered = true},
    lab::omni_way{.hemispheres = true, .cull_objects = true, .layered = true},
    lab::omni_way{.hemispheres = true, .cull_maps = true, .cull_objects = true, .layered = true}};

} // namespace

TEST_CASE("culling changes no pixel, for one view and for two at once") {
    const gl::headless_context context;
    random_views random(2012);
    std::size_t left_out_maps = 0;
    std::size_t left_out_triangles = 0;
    int left_out_warped = 0;
    std::size_t dark = 0;
    std::size_t lit = 0;
    std::optional<stage> scene;
    for (int i = 0; i < triples(); ++i) {
        if (i % triples_of_a_scene == 0) {
            scene.emplace(static_cast<unsigned>(i));
        }
        std::vector<eye> eyes(i % 2 == 0 ? 1 : 2);
        for (eye& each : eyes) {
            scene->look(each, random.camera());
        }
        const lab::light_view light =
            i % 4 == 3 ? random.light_near(eyes.front().camera) : random.light();
        const auto check = [&](const lab::omni_way& whole, std::span<const lab::omni_way> ways) {
            const std::vector<std::uint8_t> all = scene->shadows(eyes, light, whole);
            const int maps = scene->maps_drawn;
            const std::size_t triangles = scene->triangles();
            dark += static_cast<std::size_t>(std::count(all.begin(), all.end(), 1));
            lit += static_cast<std::size_t>(std::count(all.begin(), all.end(), 0));
            for (const lab::omni_way& way : ways) {
                if (way.layered && i % layered_triples() != 0) {
                    continue;
                }
                INFO("triple " << i << (way.hemispheres ? ", paraboloids" : ", faces")
                               << (way.cull_maps ? ", maps culled" : "")
                               << (way.cull_objects ? ", objects culled" : "")
                               << (way.layered ? ", layered" : ""));
                REQUIRE(scene->shadows(eyes, light, way) == all);
                left_out_maps += static_cast<std::size_t>(maps - scene->maps_drawn);
                left_out_triangles += way.layered ? 0 : triangles - scene->triangles();
            }
        };
        check({}, cube_ways);
        check({.hemispheres = true}, paraboloid_ways);
        for (const bool hemispheres : {false, true}) {
            if (i % warped_triples() != 0) {
                continue;
            }
            INFO("triple " << i << (hemispheres ? ", paraboloids" : ", faces") << " with tables");
            const std::vector<std::uint8_t> all =
                scene->warped_shadows(eyes.front(), light, {.hemispheres = hemispheres});
            const int maps = scene->maps_drawn;
            REQUIRE(scene->warped_shadows(eyes.front(), light,
                                          {.hemispheres = hemispheres, .cull_maps = true}) == all);
            left_out_warped += maps - scene->maps_drawn;
        }
    }
    // something was there to be left out, and to be seen
    CHECK(left_out_maps > static_cast<std::size_t>(triples()));
    CHECK(left_out_triangles > 100 * static_cast<std::size_t>(triples()));
    CHECK(left_out_warped > 0);
    CHECK(dark > 100);
    CHECK(lit > 100);
    WARN(triples() << " triples, " << left_out_maps << " maps and " << left_out_triangles
                   << " triangles left out");
}

TEST_CASE("a light that the camera sees needs all faces, one behind its back does not") {
    const gl::headless_context context;
    stage scene(7);
    std::vector<eye> eyes(1);
    scene.look(eyes.front(), {"", {0, 0, 12}, {0, 0, 0}, glm::radians(60.0)});
    const lab::omni_way way{.cull_maps = true, .cull_objects = true};
    scene.shadows(eyes, {"", ws::point_light(glm::dvec3(0, 0, 2))}, way);
    CHECK(scene.maps_drawn == 6);
    scene.shadows(eyes, {"", ws::point_light(glm::dvec3(0.5, 0.3, 40))}, way);
    CHECK(scene.maps_drawn == 1);
    // the front looks along +z: from behind the camera everything is in the back
    const lab::omni_way plane{.hemispheres = true, .cull_maps = true, .cull_objects = true};
    scene.shadows(eyes, {"", ws::point_light(glm::dvec3(0.5, 0.3, 40))}, plane);
    CHECK(scene.maps_drawn == 1);
    scene.shadows(eyes, {"", ws::point_light(glm::dvec3(0, 0, 2))}, plane);
    CHECK(scene.maps_drawn == 2);
    // two views that look away from each other
    std::vector<eye> both(2);
    scene.look(both[0], {"", {0, 0, -5}, {0, 0, -30}, glm::radians(30.0)});
    scene.look(both[1], {"", {0, 0, 5}, {0, 0, 30}, glm::radians(30.0)});
    scene.shadows(both, {"", ws::point_light(glm::dvec3(0, 0, 0))}, way);
    CHECK(scene.maps_drawn == 2);
}

TEST_CASE("paraboloids shadow what rays say, seam and all") {
    const gl::headless_context context;
    const lab::scene world = boxes(3);
    const lab::ray_tracer rays(world);
    lab::renderer renderer(world, {160, 120});
    // the seam is the plane z = 1 through the light: in the middle of the picture
    const lab::light_view light{"", ws::point_light(glm::dvec3(0.2, 5.0, 1.0))};
    const lab::camera_view camera{"", {14, 9, 1.5}, {0, -3, 1}, glm::radians(60.0)};
    const lab::g_buffer_samples samples = renderer.samples(camera, light);
    const std::vector<std::uint8_t> truth = rays.shadows(samples, light).shadowed;
    std::array<double, 2> wrong{};
    for (const std::string_view name : {"cube6", "dpsm"}) {
        for (std::size_t size = 0; size < 2; ++size) {
            const lab::method_result result =
                renderer.run(name, {camera, light, size == 0 ? 128 : 1024, 1, 1});
            const lab::comparison c = lab::compare(samples, truth, result.shadowed);
            REQUIRE(c.samples > 1000);
            wrong[size] = *c.ratio(c.false_light + c.false_shadow);
        }
        INFO(name << ": " << wrong[0] << ", " << wrong[1]);
        // errors are those of texels at edges of shadows: eight times smaller texels, fewer errors
        CHECK(wrong[0] < 0.2);
        CHECK(wrong[1] < 0.35 * wrong[0]);
        CHECK(wrong[1] < 0.02);
    }
}

TEST_CASE("tables inside paraboloids put texels where they are seen") {
    const gl::headless_context context;
    const lab::scene world = boxes(12);
    const lab::ray_tracer rays(world);
    lab::renderer renderer(world, {96, 72});
    const lab::light_view light{"", ws::point_light(glm::dvec3(0.2, 5.0, 1.0))};
    // across the seam, z = 1, and of little, so that the crop is narrow
    const lab::camera_view camera{"", {18, 12, 18}, {2, -6, 1.5}, glm::radians(8.0)};
    const lab::g_buffer_samples samples = renderer.samples(camera, light);
    const std::vector<std::uint8_t> truth = rays.shadows(samples, light).shadowed;
    const auto wrong = [&](const char* name) {
        const lab::method_result result = renderer.run(name, {camera, light, 64, 1, 1});
        CHECK(result.maps == 2);
        CHECK(result.status == std::vector<std::string>{});
        const lab::comparison c = lab::compare(samples, truth, result.shadowed);
        REQUIRE(c.samples > 1000);
        return *c.ratio(c.false_light + c.false_shadow);
    };
    const double plain = wrong("dpsm");
    const double warped = wrong("dpsm-notw");
    INFO(plain << ", " << warped);
    CHECK(warped < 0.5 * plain);
}

TEST_CASE("objects hold every triangle once, and know where they are") {
    for (const std::string_view name : {"outdoor", "interior"}) {
        const lab::scene world = lab::build_scene(name, 1);
        const lab::scene_objects objects = lab::make_objects(world);
        REQUIRE(objects.ranges.size() == objects.boxes.size());
        CHECK(objects.ranges.size() > 50);
        std::size_t next = 0;
        for (std::size_t i = 0; i < objects.ranges.size(); ++i) {
            const lab::triangle_range range = objects.ranges[i];
            REQUIRE(range.first == next);
            REQUIRE(range.count > 0);
            REQUIRE(range.count <= lab::largest_object);
            next += range.count;
            for (std::size_t t = range.first; t < next; ++t) {
                for (glm::length_t k = 0; k < 3; ++k) {
                    const glm::dvec3 p(world.positions[objects.triangles[t][k]]);
                    REQUIRE(glm::all(glm::greaterThanEqual(p, objects.boxes[i].lo)));
                    REQUIRE(glm::all(glm::lessThanEqual(p, objects.boxes[i].hi)));
                }
            }
        }
        REQUIRE(next == world.triangles.size());
        const auto sorted = [](std::vector<glm::uvec3> all) {
            std::sort(all.begin(), all.end(), [](glm::uvec3 a, glm::uvec3 b) {
                return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
            });
            return all;
        };
        CHECK(sorted(objects.triangles) == sorted(world.triangles));
    }
}

TEST_CASE("culling leaves a virtual light all that is before its surface") {
    const gl::headless_context context;
    const lab::scene world = boxes(5);
    const lab::point_cloud cloud = lab::make_points(world, 30000, 1);
    REQUIRE(cloud.points.size() == 30000);
    REQUIRE(cloud.balls.size() == cloud.groups.size());
    for (std::size_t i = 0; i < cloud.groups.size(); ++i) {
        for (std::size_t k = 0; k < cloud.groups[i].count; ++k) {
            const glm::dvec3 p(cloud.points[cloud.groups[i].first + k]);
            REQUIRE(glm::length(p - cloud.balls[i].centre) <= cloud.balls[i].radius);
        }
    }
    constexpr int size = 64;
    lab::vpl_passes passes(world, cloud, size);
    const auto& [cube, cube_culled, halves, halves_culled] = lab::vpl_ways;
    std::size_t points_seen = 0;
    for (const lab::virtual_light& light : lab::make_virtual_lights(world, 20, 1)) {
        CHECK(passes.draw(light, cube) == 6);
        std::vector<std::vector<float>> all;
        for (int face = 0; face < 6; ++face) {
            all.push_back(passes.depths(cube, face));
        }
        CHECK(passes.draw(light, cube_culled) <= 5);
        for (int face = 0; face < 5; ++face) {
            const std::vector<float> some = passes.depths(cube_culled, face);
            for (int i = 0; i < size * size; ++i) {
                // texels whose every direction is before the surface
                const glm::dvec2 lo = glm::dvec2(i % size, i / size) / static_cast<double>(size);
                const double step = 1.0 / size;
                bool before = true;
                for (const glm::dvec2 corner :
                     {glm::dvec2(0), {step, 0}, {0, step}, {step, step}}) {
                    before = before && ws::cube_direction(face, lo + corner).z > 1e-6;
                }
                if (before) {
                    const auto at = static_cast<std::size_t>(i);
                    REQUIRE(some[at] == all[static_cast<std::size_t>(face)][at]);
                    points_seen += some[at] < 1.0f ? 1u : 0u;
                }
            }
        }
        CHECK(passes.draw(light, halves) == 2);
        const std::vector<float> front = passes.depths(halves, 0);
        CHECK(passes.draw(light, halves_culled) == 1);
        REQUIRE(passes.depths(halves_culled, 0) == front);
    }
    CHECK(points_seen > 10000);
}

TEST_CASE("a finer scene has the same surfaces, cut where neighbours cut them") {
    lab::scene world = boxes(9);
    const lab::scene coarse = world;
    lab::refine(world, 8 * 3 * coarse.triangles.size()); // between 4 and 9: 9 is closer
    REQUIRE(world.triangles.size() == 9 * coarse.triangles.size());
    REQUIRE(world.material_of.size() == world.triangles.size());
    REQUIRE(world.parts.size() == coarse.parts.size());
    CHECK(world.parts.back() == 9 * coarse.parts.back());
    const auto area = [](const lab::scene& s) {
        double sum = 0.0;
        for (const glm::uvec3& t : s.triangles) {
            const glm::dvec3 a(s.positions[t.x]);
            sum += glm::length(
                glm::cross(glm::dvec3(s.positions[t.y]) - a, glm::dvec3(s.positions[t.z]) - a));
        }
        return sum;
    };
    CHECK(area(world) == Approx(area(coarse)).epsilon(1e-5));
    // a closed surface: every edge of a box's triangles is that of two
    std::map<std::array<float, 6>, int> edges;
    const std::size_t first = world.parts[1];
    const std::size_t last = world.parts[2];
    for (std::size_t i = first; i < last; ++i) {
        for (glm::length_t k = 0; k < 3; ++k) {
            glm::vec3 a = world.positions[world.triangles[i][k]];
            glm::vec3 b = world.positions[world.triangles[i][(k + 1) % 3]];
            if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) {
                std::swap(a, b);
            }
            ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}];
        }
    }
    for (const auto& [edge, count] : edges) {
        CHECK(count == 2);
    }
}

TEST_CASE("no edge of a cut scene is farther from its arc than was asked") {
    constexpr int size = 256;
    double worst = 0.0;
    for (unsigned seed = 0; seed < 4; ++seed) {
        const lab::scene world = boxes(seed);
        const lab::scene_objects objects = lab::make_objects(world);
        random_views random(seed);
        const lab::hemisphere_frame frame = lab::make_hemisphere_frame(
            world, random.place(12.0), {random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)});
        const lab::hemisphere_mesh mesh = lab::cut_for_hemispheres(world, objects, frame, size);
        REQUIRE(mesh.flags == ws::status::ok);
        REQUIRE(mesh.ranges.size() == objects.ranges.size());
        CHECK(mesh.vertices.size() > 3 * objects.triangles.size());
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            const glm::dvec3 a(mesh.vertices[i].position);
            const glm::dvec3 b(mesh.vertices[i % 3 == 2 ? i - 2 : i + 1].position);
            // distances are those of the triangle's plane and lie within its reach
            REQUIRE(glm::length(a) <= static_cast<double>(mesh.vertices[i].reach.y) * 1.000001);
            REQUIRE(glm::length(a) >= static_cast<double>(mesh.vertices[i].reach.x) * 0.999999);
            for (int side = 0; side < 2; ++side) {
                if (ws::paraboloid_clip(a, side, 0.0) < 0.0 ||
                    ws::paraboloid_clip(b, side, 0.0) < 0.0) {
                    continue;
                }
                const glm::dvec2 from = ws::paraboloid_uv(a, side);
                const glm::dvec2 chord = ws::paraboloid_uv(b, side) - from;
                for (int k = 1; k < 8; ++k) {
                    const glm::dvec2 arc = ws::paraboloid_uv(glm::mix(a, b, k / 8.0), side) - from;
                    const double t =
                        glm::clamp(glm::dot(arc, chord) / glm::dot(chord, chord), 0.0, 1.0);
                    worst = std::max(worst, glm::length(arc - t * chord) * 0.5 * size);
                }
            }
        }
    }
    // positions are rounded to float, 2^-24 of distances up to 60 away: far less than a texel
    CHECK(worst <= lab::arc_texels * 1.001);
    CHECK(worst > 0.02);
    WARN("edges are " << worst << " texels off their arcs at most");
}
