// How wide the penumbra of each kernel is in the scene, under a warp (Rosen 2012, §6.2).
//
// A plate casts a straight edge on the ground. The warp's density across the edge changes along it:
// a kernel of fixed size in texels is as wide as they are, one of fixed size in the light's space
// as wide everywhere.
#include "gl/context.hpp"
#include "lab/bias_passes.hpp"
#include "lab/warped_raster.hpp"

#include <warpshadow/warp.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace ws = warpshadow;

namespace {

constexpr int map_size = 512;
constexpr int cells = 64;
constexpr glm::ivec2 view(384, 48);
constexpr float from_x = 3.8f; ///< the view: along x across the edge at 5, along z with it
constexpr float to_x = 6.2f;
constexpr double edge_x = 5.0;

/// A plate at height 3 over the ground, below a sun at 45°: its shadow lies from x = 3 to 5.
lab::scene plate() {
    lab::scene world;
    world.name = "plate";
    const auto add_square = [&](glm::vec2 lo, glm::vec2 hi, float height) {
        const auto first = static_cast<unsigned>(world.positions.size());
        for (const glm::vec2 p : {lo, glm::vec2(hi.x, lo.y), hi, glm::vec2(lo.x, hi.y)}) {
            world.positions.emplace_back(p.x, height, p.y);
        }
        world.triangles.emplace_back(first, first + 1, first + 2);
        world.triangles.emplace_back(first, first + 2, first + 3);
    };
    add_square({-5.0f, -5.0f}, {15.0f, 15.0f}, 0.0f);
    add_square({0.0f, -5.0f}, {2.0f, 15.0f}, 3.0f);
    world.box = {glm::dvec3(0.0), glm::dvec3(10.0, 3.0, 10.0)};
    world.cameras.push_back({"0", {5.0, 8.0, 5.0}, {5.0, 0.0, 5.1}, 1.0});
    world.lights.push_back({"0", ws::sun(glm::dvec3(1.0, -1.0, 0.0))});
    return world;
}

/// The ground from above, without perspective.
glm::mat4 from_above() {
    const float x = 2.0f / (to_x - from_x);
    const float z = 2.0f / 8.0f;
    return {glm::vec4(x, 0.0f, 0.0f, 0.0f), glm::vec4(0.0f, 0.0f, -0.1f, 0.0f),
            glm::vec4(0.0f, z, 0.0f, 0.0f),
            glm::vec4(-0.5f * (from_x + to_x) * x, -5.0f * z, 0.0f, 1.0f)};
}

/// Functions that crowd around a place which moves by `drift` from the first to the last.
std::vector<float> crowded(double centre, double drift) {
    std::vector<float> nodes;
    for (int row = 0; row < cells; ++row) {
        std::vector<double> sum{0.0};
        for (int k = 0; k < cells; ++k) {
            const double x = (k + 0.5) / cells - centre - drift * ((row + 0.5) / cells - 0.5);
            sum.push_back(sum.back() + 0.3 + 2.0 * std::exp(-x * x / 0.01));
        }
        for (const double s : sum) {
            nodes.push_back(static_cast<float>(s / sum.back()));
        }
    }
    return nodes;
}

struct lit_edge {
    lab::scene world = plate();
    gl::headless_context context;
    lab::passes gpu{world, view};
    lab::warped_raster raster{gpu};
    lab::bias_passes biased{gpu};
    lab::map_resources maps{map_size, 1, cells, cells};
    lab::g_buffer seen{view};
    lab::light_maps chosen = lab::whole_scene_maps(world, world.lights.front());
    glm::length_t across = 0; ///< the map's axis that runs across the edge
    std::array<std::vector<float>, 2> tables;

    lit_edge() {
        gpu.draw_view(seen, from_above(), glm::vec3(5.0f, 100.0f, 5.0f));
        gpu.use(seen, chosen, world.lights.front().light);
        const glm::dvec2 step = place(edge_x + 0.1, 5.0) - place(edge_x, 5.0);
        across = std::abs(step.x) > std::abs(step.y) ? 0 : 1;
        std::vector<float> identity;
        for (int i = 0; i < cells * (cells + 1); ++i) {
            identity.push_back(static_cast<float>(i % (cells + 1)) / cells);
        }
        tables = {identity, identity};
        tables[static_cast<std::size_t>(across)] = crowded(place(edge_x, 5.0)[across], 0.7);
        maps.warps.front().rows.write(tables[0].data());
        maps.warps.front().columns.write(tables[1].data());
        lab::passes::bind_tables(maps, 0);
        gpu.find_centres(maps, 0);
        do {
            raster.forget_counts();
            raster.draw_map(maps, 0, {lab::raster_kind::exact, 0.0}, nullptr, true);
        } while (raster.grow_lists());
        gl::check("warped map");
    }

    /// Place of a point of the ground in the map before the warp.
    glm::dvec2 place(double x, double z) const {
        const glm::dvec4 clip = chosen.maps.front().matrix * glm::dvec4(x, 0.0, z, 1.0);
        return glm::dvec2(clip) / clip.w * 0.5 + 0.5;
    }
    static double z_of(int row) { return 1.0 + 8.0 * (row + 0.5) / view.y; }

    /// Widths along x of the penumbra, by rows of the view: 6 ∫ l (1 − l) is that of a ramp.
    std::vector<double> widths(const lab::filter_choice& filter) {
        biased.filter(maps, chosen, true, lab::bias_choice{}, filter, seen,
                      lab::camera_frustum(world, world.cameras.front(), view), true);
        const std::vector<float> light = biased.light();
        gl::check("filter");
        const double pixel = static_cast<double>(to_x - from_x) / view.x;
        std::vector<double> result;
        for (int row = 0; row < view.y; ++row) {
            double sum = 0.0;
            for (int i = 0; i < view.x; ++i) {
                const auto l = static_cast<double>(
                    light[static_cast<std::size_t>(row) * static_cast<std::size_t>(view.x) +
                          static_cast<std::size_t>(i)]);
                sum += l * (1.0 - l);
            }
            result.push_back(6.0 * pixel * sum);
        }
        CHECK(light[0] == 0.0f); // from shadow to light
        CHECK(light.back() == 1.0f);
        return result;
    }

    /// Width along x of a texel of the warped map at the edge, as `widths` measures it: that of a
    /// and b convolved, of what either of its sides takes.
    double texel_width(int row) const {
        const ws::table_view<float> rows{tables[0], cells, cells}, columns{tables[1], cells, cells};
        const glm::dvec2 p = place(edge_x, z_of(row));
        const glm::dmat2 back = glm::inverse(glm::dmat2(ws::jacobian(rows, columns, glm::vec2(p))));
        const double along = place(edge_x + 1.0, z_of(row))[across] - p[across];
        const double a = std::max(std::abs(back[0][across]), std::abs(back[1][across]));
        const double b = std::min(std::abs(back[0][across]), std::abs(back[1][across]));
        return (a + b * b / (2.0 * a) - b * b * b / (10.0 * a * a)) / map_size / std::abs(along);
    }
};

double spread(const std::vector<double>& widths) {
    const auto [least, most] = std::minmax_element(widths.begin(), widths.end());
    return *most / *least;
}

} // namespace

TEST_CASE("kernels in texels follow the warp, kernels in the scene do not") {
    lit_edge edge;
    std::vector<double> texels;
    for (int row = 0; row < view.y; ++row) {
        texels.push_back(edge.texel_width(row));
    }
    CHECK(spread(texels) > 3.0);

    const double radius = 5.0;
    const std::vector<double> in_texels = edge.widths(lab::parse_filter("pcf-texels:5"));
    CAPTURE(spread(in_texels));
    CHECK(spread(in_texels) > 3.0);
    for (std::size_t row = 0; row < texels.size(); ++row) {
        CAPTURE(row, in_texels[row], texels[row]);
        CHECK(in_texels[row] == Approx(2.0 * radius * texels[row]).epsilon(0.2));
    }

    // half a side of 0.3 across the light is 0.3 · √2 along the ground
    const double expected = 2.0 * 0.3 * std::sqrt(2.0);
    const std::vector<double> in_scene = edge.widths(lab::parse_filter("pcf-light:0.3"));
    CHECK(spread(in_scene) < 1.02);
    for (const double width : in_scene) {
        CHECK(width == Approx(expected).epsilon(0.03));
    }
    // the warp bends over the kernel, which its Jacobian does not know
    const std::vector<double> linear = edge.widths(lab::parse_filter("pcf-footprint:0.3"));
    CHECK(spread(linear) < 1.25);
    for (const double width : linear) {
        CHECK(width == Approx(expected).epsilon(0.2));
    }
}
