// Parts of the lab that need no OpenGL: scenes, command line, ray tracer, measures, folders.
#include "lab/measure.hpp"
#include "lab/options.hpp"
#include "lab/picture.hpp"
#include "lab/raster_figure.hpp"
#include "lab/report_folder.hpp"
#include "lab/results.hpp"
#include "lab/scene.hpp"
#include "lab/truth.hpp"
#include "lab/view_arguments.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace {

namespace fs = std::filesystem;

const std::string data = LAB_TEST_DATA;
/// Those that are run by default, and one more.
constexpr std::array<std::string_view, 9> methods{
    "sm", "min-sm", "dv", "fitted", "rtw-backward", "notw", "notw-hybrid", "raytraced", "lispsm"};

lab::options parsed(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "warpshadow-lab");
    return lab::parse_options(static_cast<int>(arguments.size()), arguments.data(), methods)
        .value();
}

bool same_scene(const lab::scene& a, const lab::scene& b) {
    return a.positions == b.positions && a.triangles == b.triangles &&
           a.material_of == b.material_of;
}

/// A square of side 2 at height 0 that casts on a floor of side 20 at height -1.
lab::scene square_over_floor() {
    lab::scene world;
    world.name = "square";
    world.positions = {{-1, 0, -1},    {1, 0, -1},    {1, 0, 1},    {-1, 0, 1},
                       {-10, -1, -10}, {10, -1, -10}, {10, -1, 10}, {-10, -1, 10}};
    world.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    world.box = {{-10, -1, -10}, {10, 0, 10}};
    return world;
}

/// A grid of view samples on the floor of `square_over_floor`.
lab::g_buffer_samples floor_samples() {
    lab::g_buffer_samples samples;
    samples.size = {200, 200};
    for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) {
            samples.position.emplace_back(-7.96f + 0.08f * static_cast<float>(x), -1.0f,
                                          -7.96f + 0.08f * static_cast<float>(y), 1.0f);
            samples.normal.emplace_back(0.0f, 1.0f, 0.0f);
            samples.n_dot_l.push_back(0.5f);
        }
    }
    return samples;
}

} // namespace

TEST_CASE("built-in scenes are whole and the same for the same seed") {
    for (const lab::scene_summary& summary : lab::builtin_scenes()) {
        INFO(std::string(summary.name));
        REQUIRE(lab::is_builtin_scene(summary.name));
        const lab::scene world = lab::build_scene(summary.name, 7);
        CHECK(world.name == summary.name);
        CHECK(same_scene(world, lab::build_scene(summary.name, 7)));
        CHECK_FALSE(same_scene(world, lab::build_scene(summary.name, 8)));
        CHECK(world.triangles.size() > 20000);
        CHECK(world.triangles.size() < 400000);
        CHECK(world.material_of.size() == world.triangles.size());
        const auto valid_triangle = [&](const glm::uvec3& t) {
            return std::max({t.x, t.y, t.z}) < world.positions.size();
        };
        CHECK(std::all_of(world.triangles.begin(), world.triangles.end(), valid_triangle));
        CHECK(*std::max_element(world.material_of.begin(), world.material_of.end()) <
              world.materials.size());
        const auto in_box = [&](const glm::vec3& p) { // false for NaN
            return glm::all(glm::greaterThanEqual(glm::dvec3(p), world.box.lo)) &&
                   glm::all(glm::lessThanEqual(glm::dvec3(p), world.box.hi));
        };
        CHECK(std::all_of(world.positions.begin(), world.positions.end(), in_box));
        bool has_sun = false;
        bool has_spot = false;
        for (const lab::light_view& light : world.lights) {
            has_sun = has_sun || light.light.kind == warpshadow::light_kind::directional;
            has_spot = has_spot || light.light.kind == warpshadow::light_kind::spot;
        }
        CHECK(world.cameras.size() >= 2);
        CHECK(has_sun);
        CHECK(has_spot);
    }
    CHECK(lab::build_scene("outdoor", 1).triangles.size() >= 150000);
    CHECK(lab::build_scene("outdoor", 1).triangles.size() <= 300000);
    CHECK_THROWS_AS(lab::build_scene("atlantis", 1), lab::bad_input);
}

TEST_CASE("files: node transforms apply, lines are dropped, a view is derived from the box") {
    const lab::scene gltf = lab::load_scene(data + "/two_quads.gltf");
    REQUIRE(gltf.triangles.size() == 4);
    CHECK(gltf.name == "two_quads");
    // one square scaled to side 10, one of side 1 moved by its own and its parent's translation
    CHECK(gltf.box.lo == glm::dvec3(-5, 0, -5));
    CHECK(gltf.box.hi == glm::dvec3(5, 3, 5));
    int raised = 0;
    for (const glm::vec3& p : gltf.positions) {
        raised += p.y == 3.0f && std::abs(p.x - 1.0f) == 0.5f && std::abs(p.z) == 0.5f ? 1 : 0;
    }
    CHECK(raised == 4);
    REQUIRE(gltf.cameras.size() == 1);
    REQUIRE(gltf.lights.size() == 1);
    CHECK(gltf.lights[0].light.kind == warpshadow::light_kind::directional);

    const lab::scene obj = lab::load_scene(data + "/quad_and_line.obj");
    CHECK(obj.triangles.size() == 2);
    CHECK(obj.box.hi == glm::dvec3(2, 0, 2)); // the end of the line, at height 5, is gone
}

TEST_CASE("the default camera sees the whole box") {
    const lab::scene world = lab::load_scene(data + "/two_quads.gltf");
    const lab::camera_view& camera = world.cameras[0];
    const glm::dvec3 forward = glm::normalize(camera.target - camera.eye);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1) != 0 ? world.box.hi.x : world.box.lo.x,
                                (i & 2) != 0 ? world.box.hi.y : world.box.lo.y,
                                (i & 4) != 0 ? world.box.hi.z : world.box.lo.z);
        const double cosine = glm::dot(glm::normalize(corner - camera.eye), forward);
        CHECK(std::acos(cosine) < 0.5 * camera.fov_y);
    }
}

TEST_CASE("command line: spaces, =, lists, repetition and negative numbers") {
    const lab::options none = parsed({});
    CHECK(none.scenes == std::vector<std::string>{"outdoor", "interior"});
    CHECK(none.methods == std::vector<std::string>(methods.begin(), methods.end() - 1));
    CHECK(none.maps == std::vector<int>{512});
    CHECK(none.view == glm::ivec2(1024, 768));
    CHECK(none.repeat == 5);
    CHECK(none.out == "warpshadow-report");

    const lab::options all = parsed(
        {"--scene", "leaves,interior", "--scene=colonnade", "--camera", "-2.6,-1,.5,-1,2,3,65",
         "--camera=-.5,1,2,3,4,5,60", "--light", "sun:-1,-2,-3", "--methods", "all", "--map",
         "256,1024", "--view=640x480", "--repeat", "9", "--seed=4", "--out", "there"});
    CHECK(all.scenes == std::vector<std::string>{"leaves", "interior", "colonnade"});
    CHECK(all.cameras == std::vector<std::string>{"-2.6,-1,.5,-1,2,3,65", "-.5,1,2,3,4,5,60"});
    CHECK(all.lights == std::vector<std::string>{"sun:-1,-2,-3"});
    CHECK(all.methods == std::vector<std::string>(methods.begin(), methods.end()));
    CHECK(all.maps == std::vector<int>{256, 1024});
    CHECK(all.view == glm::ivec2(640, 480));
    CHECK(all.repeat == 9);
    CHECK(all.seed == 4);
    CHECK(all.out == "there");

    CHECK(parsed({"--methods", "notw,sm,notw"}).methods == std::vector<std::string>{"notw", "sm"});
    CHECK(parsed({"--camera", "-.5,1,2,3,4,5,60"}).cameras ==
          std::vector<std::string>{"-.5,1,2,3,4,5,60"});
    CHECK(parsed({"--list-scenes"}).list_scenes);
}

TEST_CASE("cameras and lights by number and by value") {
    const lab::scene world = lab::build_scene("interior", 1);
    CHECK(lab::resolve_camera("1", world).eye == world.cameras[1].eye);
    const lab::camera_view camera = lab::resolve_camera("-2.6,1.5,1.6,2.5,0.3,-1.5,65", world);
    CHECK(camera.eye == glm::dvec3(-2.6, 1.5, 1.6));
    CHECK(camera.target == glm::dvec3(2.5, 0.3, -1.5));
    CHECK(camera.fov_y == glm::radians(65.0));
    CHECK(camera.label == "-2.6,1.5,1.6,2.5,0.3,-1.5,65");

    const lab::light_view sun = lab::resolve_light("sun:0.35,-1,0.25", world);
    CHECK(sun.light.kind == warpshadow::light_kind::directional);
    CHECK(sun.light.direction == glm::dvec3(0.35, -1.0, 0.25));
    const lab::light_view spot = lab::resolve_light("spot:0,2,0,0,0,0,140", world);
    CHECK(spot.light.kind == warpshadow::light_kind::spot);
    CHECK(spot.light.position == glm::dvec3(0, 2, 0));
    CHECK(spot.light.direction == glm::dvec3(0, -1, 0));
    CHECK(spot.light.cone_angle == glm::radians(140.0));
    const lab::light_view point = lab::resolve_light("point:1,1.25,-0.6", world);
    CHECK(point.light.kind == warpshadow::light_kind::point);
    CHECK(point.light.position == glm::dvec3(1, 1.25, -0.6));

    // what --list-scenes prints can be given back
    for (const lab::camera_view& each : world.cameras) {
        CHECK_NOTHROW(lab::resolve_camera(lab::camera_text(each), world));
    }
    for (const lab::light_view& each : world.lights) {
        CHECK(lab::resolve_light(lab::light_text(each), world).light.kind == each.light.kind);
    }
}

TEST_CASE("ray tracer: the shadow of a square is where geometry puts it") {
    const lab::scene world = square_over_floor();
    const lab::ray_tracer rays(world);
    const lab::g_buffer_samples samples = floor_samples();
    const double offset = rays.origin_offset();
    CHECK(offset == 2e-4);
    lab::scene small = world;
    small.box = {{-1, -0.1, -1}, {1, 0, 1}};
    CHECK(lab::ray_tracer(small).origin_offset() == 1e-5 * std::sqrt(8.01));

    struct light_case {
        lab::light_view light;
        glm::dvec2 centre; ///< of the shadow on the floor
        double half;       ///< of its side
    };
    const light_case cases[] = {
        {{"", warpshadow::sun(glm::dvec3(2.0, -1.0, -3.0))}, {2.0, -3.0}, 1.0},
        {{"", warpshadow::sun(glm::dvec3(0.0, -1e-6, 0.0))}, {0.0, 0.0}, 1.0},
        {{"", warpshadow::point_light(glm::dvec3(0.5, 1.0, 0.0))}, {-0.5, 0.0}, 2.0},
        {{"", warpshadow::spot_light(glm::dvec3(0.0, 0.5, 0.0), glm::dvec3(0.0), 3.0)},
         {0.0, 0.0},
         3.0},
    };
    for (const light_case& each : cases) {
        const lab::traced_shadows traced = rays.shadows(samples, each.light);
        std::size_t dark = 0;
        for (std::size_t i = 0; i < samples.position.size(); ++i) {
            const glm::dvec2 p(samples.position[i].x, samples.position[i].z);
            const glm::dvec2 d = glm::abs(p - each.centre);
            const double outside = std::max(d.x, d.y) - each.half;
            // the origin is `offset` above the floor: the edge moves by that times the slope of the
            // light, below 8 here; samples nearer to the edge say nothing
            if (std::abs(outside) > 8.0 * offset) {
                REQUIRE((traced.shadowed[i] != 0) == (outside < 0.0));
            }
            dark += traced.shadowed[i];
        }
        CHECK(dark > 100);
    }
}

TEST_CASE("ray tracer: what faces away is in shadow, background never") {
    const lab::scene world = square_over_floor();
    const lab::ray_tracer rays(world);
    lab::g_buffer_samples samples;
    samples.size = {3, 1};
    samples.position = {{5, -1, 5, 1}, {5, -1, 5, 1}, {0, 0, 0, 0}};
    samples.normal = {{0, 1, 0}, {0, 1, 0}, {0, 0, 0}};
    samples.n_dot_l = {1.0f, -0.5f, 0.0f};
    const lab::light_view sun{"", warpshadow::sun(glm::dvec3(0, -1, 0))};
    CHECK(rays.shadows(samples, sun).shadowed == std::vector<std::uint8_t>{0, 1, 0});
    CHECK(rays.bytes() > 0);
}

TEST_CASE("ray tracer: no surface shadows itself") {
    // the diagonal is large and the sun low: an offset that were lost in rounding would show here
    lab::scene world = square_over_floor();
    for (glm::vec3& p : world.positions) {
        p = p * 20.0f + glm::vec3(150.0f, 3.0f, -90.0f);
    }
    world.box = {{-50, -17, -290}, {350, 3, 110}};
    const lab::ray_tracer rays(world);
    CHECK(rays.origin_offset() == 2e-4);
    lab::g_buffer_samples samples = floor_samples();
    for (glm::vec4& p : samples.position) {
        p = glm::vec4(glm::vec3(p) * 20.0f + glm::vec3(150.0f, 3.0f, -90.0f), 1.0f);
    }
    const lab::light_view sun{"", warpshadow::sun(glm::dvec3(0.0, -0.1, 1.0))};
    const lab::traced_shadows traced = rays.shadows(samples, sun);
    for (std::size_t i = 0; i < samples.position.size(); ++i) {
        // the square, 20 above the floor, throws its shadow 200 along z, over 180 to 220 ± edges
        const glm::dvec2 p(samples.position[i].x - 150.0f, samples.position[i].z + 90.0f);
        if (std::abs(p.x) > 20.1 || p.y < 179.0) {
            REQUIRE(traced.shadowed[i] == 0);
        }
    }
}

TEST_CASE("measures: what counts and as what") {
    lab::g_buffer_samples samples;
    samples.size = {8, 1};
    samples.position.assign(8, {0, 0, 0, 1});
    samples.position[7].w = 0.0f; // background
    samples.normal.assign(8, {0, 1, 0});
    samples.n_dot_l = {0.5f, 0.5f, 0.5f, 0.5f, 0.05f, 0.1f, -0.5f, 0.5f};
    const std::vector<std::uint8_t> truth{0, 1, 0, 1, 0, 1, 0, 0};
    const std::vector<std::uint8_t> found{0, 1, 1, 0, 1, 1, 1, 1};
    const lab::comparison c = lab::compare(samples, truth, found);
    CHECK(c.samples == 4);
    CHECK(c.false_shadow == 1);
    CHECK(c.false_light == 1);
    CHECK(c.grazing_samples == 2); // 0.1 itself is grazing
    CHECK(c.grazing_wrong == 1);
    CHECK(c.wrong == std::vector<std::uint8_t>{0, 0, 1, 1, 0, 0, 0, 0});
    CHECK(c.ratio(c.false_light) == 0.25);
    CHECK_FALSE(lab::comparison{}.ratio(0).has_value());
}

TEST_CASE("texts of numbers") {
    CHECK(lab::percent_text(0.03456) == "3.46");
    CHECK(lab::percent_text(0.345678) == "34.6");
    CHECK(lab::percent_text(std::nullopt) == "-");
    CHECK(lab::bytes_text(1023) == "1023 B");
    CHECK(lab::bytes_text(1 << 20) == "1.0 MiB");
    CHECK(lab::bytes_text(std::size_t{200} << 20) == "200 MiB");
    CHECK(lab::ms_text(3.14159) == "3.14");
    CHECK(lab::ms_text(314.159) == "314");
}

TEST_CASE("pictures: the detail lies where methods differ most") {
    const glm::ivec2 view(64, 48);
    std::vector<std::uint8_t> first(64 * 48, 1); // wrong everywhere, like the second but for a spot
    std::vector<std::uint8_t> second = first;
    for (int y = 30; y < 34; ++y) { // rows count from below
        for (int x = 40; x < 44; ++x) {
            second[static_cast<std::size_t>(y * 64 + x)] = 0;
        }
    }
    const std::array<std::span<const std::uint8_t>, 2> sets{first, second};
    const glm::ivec2 window(16, 12);
    const glm::ivec2 corner = lab::window_of_difference(sets, view, window);
    CHECK(corner.x <= 40);
    CHECK(corner.x + window.x >= 44);
    CHECK(corner.y <= 48 - 34);
    CHECK(corner.y + window.y >= 48 - 30);

    lab::picture whole{2, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
    const lab::picture zoomed = lab::cropped(whole, {1, 0}, {1, 1}, 2);
    CHECK(zoomed.rgb == std::vector<std::uint8_t>{4, 5, 6, 4, 5, 6, 4, 5, 6, 4, 5, 6});
    const std::array<std::uint8_t, 4> lower_left{1, 0, 0, 0};
    lab::paint_red(whole, lower_left);
    CHECK(whole.rgb[6] > 200);
    CHECK(whole.rgb[7] < 50);
    CHECK(whole.rgb[0] == 1);
}

TEST_CASE("texels that are not as in the ideal map") {
    // depths from 0.25 to 0.75: a difference of 0.001 is allowed; 1 is empty
    const std::array<float, 6> ideal{0.25f, 0.75f, 0.5f, 0.5f, 1.0f, 1.0f};
    std::array<float, 6> drawn{0.2505f, 0.752f, 1.0f, std::numeric_limits<float>::quiet_NaN(),
                               0.9999f, 1.0f};
    CHECK(lab::wrong_texels(drawn, ideal) == std::vector<std::uint8_t>{0, 1, 1, 1, 1, 0});
    CHECK(lab::wrong_texels(ideal, ideal) == std::vector<std::uint8_t>(6, 0));
    const std::array<float, 2> empty{1.0f, 1.0f};
    const std::array<float, 2> one{1.0f, 0.5f};
    CHECK(lab::wrong_texels(one, empty) == std::vector<std::uint8_t>{0, 1});
}

TEST_CASE("report folders appear whole or not at all") {
    const fs::path base = fs::temp_directory_path() /
                          ("warpshadow-parts-" + std::to_string(static_cast<long>(::getpid())));
    fs::remove_all(base);
    fs::create_directories(base);
    const auto entries = [](const fs::path& folder) {
        return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
    };
    {
        lab::report_folder folder(base / "a" / "b");
        folder.write("results.json", std::string("{}"));
        CHECK_FALSE(fs::exists(base / "a" / "b"));
    }
    CHECK(entries(base) == 0); // given up: the parents made for it go too
    {
        lab::report_folder folder(base / "report/");
        folder.write("results.json", std::string("first"));
        folder.write("old.png", std::string("x"));
        CHECK(folder.publish() == base / "report");
    }
    CHECK(entries(base) == 1);
    CHECK(entries(base / "report") == 2);
    {
        lab::report_folder folder(base / "report");
        folder.write("results.json", std::string("second"));
        CHECK(fs::exists(base / "report" / "old.png"));
        folder.publish();
    }
    CHECK(entries(base) == 1);
    CHECK(entries(base / "report") == 1);
    std::ifstream file(base / "report" / "results.json");
    std::string text;
    file >> text;
    CHECK(text == "second");

    std::ofstream(base / "report" / "thesis.tex") << "mine";
    CHECK_THROWS_AS(lab::report_folder(base / "report"), lab::bad_input);
    CHECK_THROWS_AS(lab::report_folder(base / "report" / "thesis.tex"), lab::bad_input);
    CHECK_THROWS_AS(lab::report_folder(base / "report" / "thesis.tex" / "below"), lab::bad_input);
    CHECK(entries(base) == 1);
    CHECK(entries(base / "report") == 2);
    fs::remove_all(base);
}
