// Maps with tables as they are drawn, against an ideal map with a ray per texel.
//
// The triangles lie flat at heights of their own, so a texel tells by its depth which of them it
// holds. How far a map deviates is how far from a texel's centre the ideal map, evaluated
// anywhere, has what the texel holds.
#include "gl/context.hpp"
#include "lab/truth.hpp"
#include "lab/warped_raster.hpp"

#include <warpshadow/warp.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace ws = warpshadow;

namespace {

constexpr int size = 192;

/// Flat triangles of all sizes over a ground; neighbours share edges where they come from one fan.
/// `bottom` is the least height that the map holds, 0 that of the ground.
lab::scene flat_triangles(unsigned seed, int fans, const ws::light<double>& light, double bottom) {
    lab::scene world;
    world.name = "flat";
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const auto add_fan = [&](glm::vec2 centre, float radius, float height, int parts) {
        const auto first = static_cast<unsigned>(world.positions.size());
        world.positions.emplace_back(centre.x, height, centre.y);
        for (int i = 0; i <= parts; ++i) {
            const float angle =
                6.2831853f * static_cast<float>(i % parts) / static_cast<float>(parts);
            world.positions.emplace_back(centre.x + radius * std::cos(angle), height,
                                         centre.y + radius * std::sin(angle));
        }
        for (unsigned i = 1; i <= static_cast<unsigned>(parts); ++i) {
            world.triangles.emplace_back(first, first + i, first + i + 1);
        }
    };
    for (int i = 0; i < fans; ++i) {
        // one after the other: arguments are evaluated in any order
        const float share = unit(random);
        const float x = unit(random);
        const float y = unit(random);
        const float parts = unit(random);
        const float radius = 4.0f * std::pow(share, 3.0f) + (fans == 1 ? 1.0f : 0.05f);
        const float height = 0.1f + 0.8f * static_cast<float>(i) / static_cast<float>(fans);
        add_fan({10.0f * x, 10.0f * y}, radius, height, 3 + static_cast<int>(4.0f * parts));
    }
    add_fan({5.0f, 5.0f}, 12.0f, 0.0f, 4); // the ground, beyond the map
    world.box = {glm::dvec3(0.0, bottom, 0.0), glm::dvec3(10.0, 1.0, 10.0)};
    world.cameras.push_back({"0", {5.0, 8.0, 5.0}, {5.0, 0.0, 5.1}, 1.0});
    world.lights.push_back({"0", light});
    return world;
}

/// Functions that crowd around a place that moves from row to row.
std::vector<float> steep_table(double centre, double drift, double width) {
    std::vector<float> nodes;
    for (int row = 0; row < size; ++row) {
        std::vector<double> sum{0.0};
        for (int k = 0; k < size; ++k) {
            const double x = (k + 0.5) / size - centre - drift * (row + 0.5) / size;
            sum.push_back(sum.back() + 0.25 + 3.0 * std::exp(-x * x / (width * width)));
        }
        for (const double s : sum) {
            nodes.push_back(static_cast<float>(s / sum.back()));
        }
    }
    return nodes;
}

struct drawn_maps {
    lab::scene world;
    lab::ray_tracer rays{world};
    gl::headless_context context;
    lab::passes gpu{world, {32, 24}};
    lab::warped_raster raster{gpu};
    lab::map_resources maps{size, 1, size, size};
    lab::g_buffer seen{{32, 24}};
    std::vector<float> rows = steep_table(0.25, 0.3, 0.06);
    std::vector<float> columns = steep_table(0.7, -0.4, 0.09);
    std::vector<float> ideal;
    double tolerance; ///< between heights that are the same; the rest is the rounding of depths

    drawn_maps(unsigned seed, int fans,
               const ws::light<double>& light = ws::sun(glm::dvec3(0.0, -1.0, 0.0)),
               double same_height = 1e-4, double bottom = 0.0)
        : world(flat_triangles(seed, fans, light, bottom)), tolerance(same_height) {
        const lab::light_maps chosen = lab::whole_scene_maps(world, world.lights.front());
        gpu.draw_view(seen, glm::mat4(1.0f), glm::vec3(0.0f)); // sets the state of all passes
        gpu.use(seen, chosen, world.lights.front().light);
        maps.warps.front().rows.write(rows.data());
        maps.warps.front().columns.write(columns.data());
        lab::passes::bind_tables(maps, 0);
        gpu.find_centres(maps, 0);
        ideal = draw({lab::raster_kind::ideal, 0.0});
    }
    std::vector<float> draw(const lab::raster_choice& how) {
        do {
            raster.forget_counts();
            raster.draw_map(maps, 0, how, &rays, true);
        } while (raster.grow_lists());
        gl::check("warped map");
        return maps.depth.read<float>();
    }
    std::size_t triangles() const { return raster.counted().front().vertex_count / 3; }

    /// Largest distance in texels, of the radii, that some texel needs; infinity where none serves.
    double deviation(const std::vector<float>& map, const std::vector<double>& radii) const {
        const ws::table_view<float> row_view{rows, size, size}, column_view{columns, size, size};
        const glm::dmat4 inverse = glm::inverse(glm::dmat4(gpu.matrix_in_use(0)));
        constexpr double nothing = -1.0; // below the ground
        const auto place = [&](glm::vec2 q, double depth) {
            const glm::dvec2 ndc = 2.0 * glm::dvec2(ws::unwarp(row_view, column_view, q)) - 1.0;
            const glm::dvec4 p = inverse * glm::dvec4(ndc, 2.0 * depth - 1.0, 1.0);
            return glm::dvec3(p) / p.w;
        };
        double most = 0.0;
        for (int i = 0; i < size * size; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const glm::vec2 centre(static_cast<float>(i % size) + 0.5f,
                                   static_cast<float>(i / size) + 0.5f);
            const auto height_of = [&](float depth) {
                return depth < 1.0f
                           ? place(centre / static_cast<float>(size), static_cast<double>(depth)).y
                           : nothing;
            };
            const double held = height_of(map[at]);
            if (std::abs(held - height_of(ideal[at])) < tolerance) {
                continue;
            }
            double needed = std::numeric_limits<double>::infinity();
            for (const double radius : radii) {
                std::vector<glm::dvec3> from, to;
                for (int k = 0; k < 128; ++k) {
                    const double angle = 0.049087385 * k;
                    const glm::vec2 q =
                        (centre + glm::vec2(static_cast<float>(radius * std::cos(angle)),
                                            static_cast<float>(radius * std::sin(angle)))) /
                        static_cast<float>(size);
                    from.push_back(place(q, 0.0));
                    to.push_back(place(q, 1.0));
                }
                const std::vector<double> hits = rays.first_hits(from, to);
                bool served = false;
                for (std::size_t k = 0; k < hits.size(); ++k) {
                    const double height =
                        hits[k] < 1.0 ? glm::mix(from[k], to[k], hits[k]).y : nothing;
                    served = served || std::abs(height - held) < tolerance;
                }
                if (served) {
                    needed = radius;
                    break;
                }
            }
            most = std::max(most, needed);
        }
        return most;
    }
};

} // namespace

TEST_CASE("maps with tables hold what an ideal map holds within what was asked for") {
    drawn_maps maps(4, 60);
    const std::size_t texels = maps.ideal.size();
    CHECK(std::count_if(maps.ideal.begin(), maps.ideal.end(), [](float d) { return d < 0.99f; }) >
          static_cast<std::ptrdiff_t>(texels / 2));

    // by a rasteriser and texel by texel: rounding alone
    for (const lab::raster_kind kind : {lab::raster_kind::hull, lab::raster_kind::exact}) {
        CAPTURE(lab::raster_name({kind, 0.0}));
        CHECK(maps.deviation(maps.draw({kind, 0.0}), {0.005, 0.01, 0.02}) <= 0.02);
    }

    // what the two are measured against: without cuts, and with the coarsest rule of the papers
    for (const lab::raster_choice& how : {lab::raster_choice{lab::raster_kind::fragment, 0.0},
                                          lab::raster_choice{lab::raster_kind::rule, 5.0}}) {
        CAPTURE(lab::raster_name(how));
        CHECK(maps.deviation(maps.draw(how), {0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) >= 2.0);
    }
}

TEST_CASE("edges cut by the bound are off by no more than it") {
    // One fan over the ground: where three surfaces meet, two outlines may each be where they may
    // and open a gap to a third that no place near by sees.
    for (unsigned seed = 1; seed <= 5; ++seed) {
        drawn_maps maps(seed, 1);
        maps.draw({lab::raster_kind::exact, 0.0});
        const std::size_t whole = maps.triangles();
        std::size_t pieces = 0;
        for (const double allowed : {0.25, 0.5, 1.0}) {
            CAPTURE(seed, allowed);
            const std::vector<float> map = maps.draw({lab::raster_kind::bound, allowed});
            CHECK(maps.raster.counted().front().uncut == 0);
            // the rasteriser snaps corners to 1/256 of a texel
            std::vector<double> radii{0.02};
            for (int k = 1; k <= 16; ++k) {
                radii.push_back(allowed * k / 16.0 + 0.02);
            }
            CHECK(maps.deviation(map, radii) <= allowed + 0.02);
            pieces = std::max(pieces, maps.triangles());
        }
        CHECK(pieces > whole);
    }
}

TEST_CASE("triangles for which there was no room are counted, and drawn after lists have grown") {
    drawn_maps maps(11, 2000); // most cover many texels: far more than the lists begin with
    maps.raster.forget_counts();
    maps.raster.draw_map(maps.maps, 0, {lab::raster_kind::exact, 0.0}, nullptr, true);
    CHECK(maps.raster.counted().front().lost > 0);
    const std::vector<float> exact = maps.draw({lab::raster_kind::exact, 0.0});
    CHECK(maps.raster.counted().front().lost == 0);
    CHECK(maps.deviation(exact, {0.005, 0.01, 0.02}) <= 0.02);
}

TEST_CASE("a triangle over more blocks of texels than llvmpipe's loops go round is drawn whole") {
    // the ground lies under all of the map, and is nearer than what is nowhere drawn
    drawn_maps maps(3, 1, ws::sun(glm::dvec3(0.0, -1.0, 0.0)), 1e-4, -0.25);
    constexpr int side = 4608; // a quarter of the blocks is under one triangle of the ground
    lab::map_resources large{side, 1, size, size};
    large.warps.front().rows.write(maps.rows.data());
    large.warps.front().columns.write(maps.columns.data());
    lab::passes::bind_tables(large, 0);
    maps.gpu.find_centres(large, 0);
    do {
        maps.raster.forget_counts();
        maps.raster.draw_map(large, 0, {lab::raster_kind::exact, 0.0}, nullptr, true);
    } while (maps.raster.grow_lists());
    const std::vector<float> depth = large.depth.read<float>();
    REQUIRE(depth.size() == static_cast<std::size_t>(side) * side);
    CHECK(std::count(depth.begin(), depth.end(), 1.0f) == 0);
}

TEST_CASE("J43: triangles that reach behind a spot light are clipped before they are warped") {
    drawn_maps maps(
        7, 12, ws::spot_light(glm::dvec3(5.0, 2.5, -1.0), glm::dvec3(5.0, 0.0, 5.0), 1.0), 0.02);
    const glm::dmat4 light(maps.gpu.matrix_in_use(0));
    const auto behind = [&](const glm::vec3& p) {
        return (light * glm::dvec4(glm::dvec3(p), 1.0)).w < 0.0;
    };
    // the ground is under every fan, and one of its corners lies behind the light
    REQUIRE(std::any_of(maps.world.positions.end() - 5, maps.world.positions.end(), behind));
    REQUIRE(std::count_if(maps.ideal.begin(), maps.ideal.end(), [](float d) { return d < 1.0f; }) >
            static_cast<std::ptrdiff_t>(maps.ideal.size() / 2));
    for (const lab::raster_kind kind : {lab::raster_kind::hull, lab::raster_kind::exact}) {
        CAPTURE(lab::raster_name({kind, 0.0}));
        CHECK(maps.deviation(maps.draw({kind, 0.0}), {0.005, 0.01, 0.02}) <= 0.02);
    }
    CHECK(maps.deviation(maps.draw({lab::raster_kind::bound, 0.5}),
                         {0.02, 0.15, 0.27, 0.4, 0.52}) <= 0.52);
}

TEST_CASE("ways to draw maps with tables are read and written alike") {
    for (const char* text :
         {"none", "fragment", "rule:2.5", "bound:0.5", "hull", "exact", "ideal"}) {
        CHECK(lab::raster_name(lab::parse_raster(text)) == text);
    }
    CHECK(lab::raster_name({}) == "exact");
    for (const char* text : {"", "rule", "rule:", "rule:x", "rule:0", "bound:-1", "exact:1",
                             "hull:1", "bound:nan", "rule:101", "rule:5x", "Exact"}) {
        CAPTURE(text);
        CHECK_THROWS_AS(lab::parse_raster(text), lab::bad_input);
    }
}
