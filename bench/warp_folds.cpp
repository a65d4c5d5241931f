// Counts the right triangles that turn over when their corners alone are warped.
//
// warp_folds [FILE.json]: a table on the standard output, and the same numbers as JSON. For every
// built-in scene, its first camera and its first light with one map: tables of the default options
// at each shear limit, triangles of each size at random places and turned at random, half of them
// anywhere and half where the view has samples. A triangle that turned over is cut into n x n
// similar ones until none of those turns over.
#include "arguments.hpp"
#include "gl/context.hpp"
#include "lab/light_maps.hpp"
#include "lab/methods.hpp"

#include <warpshadow/warp_build.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <limits>
#include <random>
#include <vector>

namespace ws = warpshadow;

namespace {

constexpr int map_size = 512;
constexpr std::array sizes{1, 2, 4, 8, 16};            // legs in texels
constexpr std::array subdivisions{1, 2, 4, 8, 16, 32}; // pieces of each edge
constexpr std::array limits{std::numeric_limits<double>::infinity(), 4.0, 2.0, 1.0, 0.5, 0.0};
constexpr int triangles_per_size = 40000;

/// Places of the lit samples in a map that holds them and little more.
std::vector<glm::dvec2> samples_of(const lab::scene& world, const lab::light_view& light) {
    lab::renderer renderer(world, {512, 384});
    const lab::g_buffer_samples seen = renderer.samples(world.cameras.front(), light);
    const glm::dmat4 matrix = lab::whole_scene_maps(world, light).maps.front().matrix;
    std::vector<glm::dvec2> places;
    glm::dvec2 lo(1e30);
    glm::dvec2 hi(-1e30);
    for (std::size_t i = 0; i < seen.position.size(); ++i) {
        if (seen.position[i].w > 0.5f && seen.n_dot_l[i] > 0.0f) {
            const glm::dvec4 clip = matrix * glm::dvec4(glm::dvec3(seen.position[i]), 1.0);
            places.emplace_back(glm::dvec2(clip) / clip.w);
            lo = glm::min(lo, places.back());
            hi = glm::max(hi, places.back());
        }
    }
    const glm::dvec2 margin = 0.5 / (map_size - 1.0) * (hi - lo);
    for (glm::dvec2& p : places) {
        p = (p - (lo - margin)) / (hi - lo + 2.0 * margin);
    }
    return places;
}

struct tables {
    std::vector<std::uint32_t> counts;
    std::vector<std::uint64_t> scratch;
    std::vector<double> rows, columns;
    ws::warp_result<double> warp;

    tables(const std::vector<glm::dvec2>& samples, double shear)
        : counts(std::size_t{map_size} * map_size), rows(std::size_t{map_size} * (map_size + 1)),
          columns(rows.size()) {
        ws::build_options<double> options;
        options.shear = shear;
        scratch.resize(ws::scratch_size(map_size, options));
        warp = ws::build_warp<double, double>(samples, options,
                                              {map_size, counts, scratch, rows, columns});
    }
    [[nodiscard]] double area(const std::array<glm::dvec2, 3>& p) const {
        std::array<glm::dvec2, 3> q;
        for (std::size_t i = 0; i < 3; ++i) {
            q[i] = ws::warp(warp.rows, warp.columns, p[i]);
        }
        return (q[1].x - q[0].x) * (q[2].y - q[0].y) - (q[1].y - q[0].y) * (q[2].x - q[0].x);
    }
};

/// Whether any of n x n similar parts of a triangle (counter-clockwise) turns over.
bool any_part_turns(const tables& built, const std::array<glm::dvec2, 3>& p, int n) {
    const glm::dvec2 x = (p[1] - p[0]) / static_cast<double>(n);
    const glm::dvec2 y = (p[2] - p[0]) / static_cast<double>(n);
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i + j < n; ++i) {
            const glm::dvec2 a = p[0] + static_cast<double>(i) * x + static_cast<double>(j) * y;
            if (!(built.area({a, a + x, a + y}) > 0.0) ||
                (i + j + 1 < n && !(built.area({a + x, a + x + y, a + y}) > 0.0))) {
                return true;
            }
        }
    }
    return false;
}

nlohmann::ordered_json count_folds(const std::vector<glm::dvec2>& samples, double shear) {
    const tables built(samples, shear);
    nlohmann::ordered_json result;
    result["shear_limit"] =
        shear == limits.front() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(shear);
    result["mix"] = {built.warp.row_mix, built.warp.column_mix};
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    int enough = 1;
    bool always = true;
    int flipped_of_all = 0;
    for (const int size : sizes) {
        int flipped = 0;
        for (int i = 0; i < triangles_per_size; ++i) {
            const double leg = static_cast<double>(size) / map_size;
            glm::dvec2 p(unit(random), unit(random));
            const double turn = 6.283185307179586 * unit(random);
            if (i % 2 == 0) {
                p = samples[static_cast<std::size_t>(unit(random) * 0.999999 *
                                                     static_cast<double>(samples.size()))];
            }
            const glm::dvec2 x = leg * glm::dvec2(std::cos(turn), std::sin(turn));
            const glm::dvec2 y(-x.y, x.x);
            const std::array<glm::dvec2, 3> corner{p, p + x, p + y};
            if (std::any_of(corner.begin(), corner.end(),
                            [](const glm::dvec2& c) { return c != glm::clamp(c, 0.0, 1.0); })) {
                --i; // clipped before it is warped: another one
                continue;
            }
            if (built.area(corner) > 0.0) {
                continue;
            }
            ++flipped;
            const auto* const found =
                std::find_if(subdivisions.begin(), subdivisions.end(),
                             [&](int n) { return !any_part_turns(built, corner, n); });
            always = always && found != subdivisions.end();
            enough = std::max(enough, found == subdivisions.end() ? 0 : *found);
        }
        flipped_of_all += flipped;
        result["flipped"][std::to_string(size)] = static_cast<double>(flipped) / triangles_per_size;
    }
    result["flipped_of_all"] = static_cast<double>(flipped_of_all) /
                               (triangles_per_size * static_cast<double>(sizes.size()));
    result["none_at_subdivision"] =
        always ? nlohmann::ordered_json(enough) : nlohmann::ordered_json(nullptr);
    return result;
}

void count_all(const char* file) {
    const gl::headless_context context;
    nlohmann::ordered_json all;
    all["map"] = map_size;
    all["triangles_per_size"] = triangles_per_size;
    all["entries"] = nlohmann::ordered_json::array();
    std::printf("%-12s %5s  %s\n", "scene", "limit",
                "flipped of 1, 2, 4, 8, 16 texels; of all; "
                "none flips when each edge is cut into");
    for (const lab::scene_summary& summary : lab::builtin_scenes()) {
        const lab::scene world = lab::build_scene(summary.name, 1);
        const auto light =
            std::find_if(world.lights.begin(), world.lights.end(), [](const lab::light_view& each) {
                return each.light.kind != ws::light_kind::point;
            });
        if (light == world.lights.end()) {
            continue;
        }
        const std::vector<glm::dvec2> samples = samples_of(world, *light);
        for (const double shear : limits) {
            nlohmann::ordered_json entry = count_folds(samples, shear);
            std::printf("%-12s %5g ", world.name.c_str(), shear);
            for (const auto& [size, share] : entry["flipped"].items()) {
                std::printf(" %.5f", share.get<double>());
            }
            std::printf("; %.6f; %s\n", entry["flipped_of_all"].get<double>(),
                        entry["none_at_subdivision"].dump().c_str());
            std::fflush(stdout);
            entry["scene"] = world.name;
            all["entries"].push_back(entry);
        }
    }
    if (file != nullptr) {
        std::ofstream out(file);
        out << all.dump(1) << '\n';
        if (!out.flush()) {
            throw std::runtime_error(std::string("cannot write ") + file);
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    bench::expect_values(argc, argv, 1, "warp_folds [FILE.json]");
    try {
        count_all(argc == 2 ? argv[1] : nullptr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "warp_folds: %s\n", error.what());
        return 1;
    }
    return 0;
}
