// Properties of warpshadow/bias.hpp. Numbers after J are those of the list of hard cases.
//
// A receiver's plane is sampled at the centres of texels and looked up elsewhere in them: acne is
// where it shadows itself. WARPSHADOW_ACNE_POINTS sets the number of points per map (default
// 10000, and a million for the tests of no acne where they are optimised).
#include "camera.hpp"

#include <warpshadow/bias.hpp>
#include <warpshadow/lispsm.hpp>
#include <warpshadow/warp_build.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <span>
#include <vector>

using namespace warpshadow;
using camera_test::between;
using camera_test::coin;
using camera_test::log_between;

namespace {

using vec2 = glm::vec<2, double>;
using vec3 = glm::vec<3, double>;
using vec4 = glm::vec<4, double>;
using mat2 = glm::mat<2, 2, double>;
using mat4 = glm::mat<4, 4, double>;

constexpr double pi = 3.14159265358979323846;

int point_count() {
    const char* text = std::getenv("WARPSHADOW_ACNE_POINTS");
    return text != nullptr ? std::max(1, std::atoi(text)) : 10000;
}

int acne_point_count() {
#ifdef NDEBUG
    const int usual = 1000000;
#else
    const int usual = 10000;
#endif
    return std::getenv("WARPSHADOW_ACNE_POINTS") != nullptr ? point_count() : usual;
}

/// Evenly distributed numbers with a fixed seed.
class numbers {
  public:
    double operator()(double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(engine_);
    }
    /// Normal, in map space, of a receiver with slopes up to `steepest` in any direction.
    vec3 normal(double steepest) {
        const double slope = steepest * std::pow((*this)(0.0, 1.0), 2.0);
        const double angle = (*this)(0.0, 2.0 * pi);
        const double length = ((*this)(-1.0, 1.0) < 0.0 ? -1.0 : 1.0) * (*this)(0.1, 10.0);
        return length * vec3(-slope * std::cos(angle), -slope * std::sin(angle), 1.0);
    }

  private:
    std::mt19937_64 engine_{20051215};
};

/// A table warp built from clustered samples.
struct tables {
    std::vector<std::uint32_t> counts;
    std::vector<std::uint64_t> scratch;
    std::vector<double> row_nodes, column_nodes;
    table_view<double> rows, columns;

    tables(int size, double window) {
        const auto cells = static_cast<std::size_t>(size);
        counts.resize(cells * cells);
        scratch.resize(cells);
        row_nodes.resize(cells * (cells + 1));
        column_nodes.resize(cells * (cells + 1));
        std::vector<vec2> samples;
        numbers random;
        for (int i = 0; i < 100000; ++i) {
            const double t = random(0.0, 1.0);
            const double u = random(0.0, 1.0);
            const double s = random(0.0, 1.0);
            // a cone of view, a cluster, and some everywhere
            samples.push_back(i % 4 == 0
                                  ? vec2(0.7 + 0.1 * (t + u - 1.0), 0.3 + 0.1 * (s + u - 1.0))
                              : i % 4 == 1 ? vec2(t, u)
                                           : vec2(0.5 + (u - 0.5) * t * t, t * t));
        }
        build_options<double> options;
        options.window = window;
        warp_memory<double> memory;
        memory.size = size;
        memory.counts = counts;
        memory.scratch = scratch;
        memory.rows = row_nodes;
        memory.columns = column_nodes;
        const auto built = build_warp<double, double>(samples, options, memory);
        REQUIRE(built.flags == status::ok);
        rows = built.rows;
        columns = built.columns;
    }
    /// Largest ratio of neighbouring slopes of the functions of either axis, multiplied: what the
    /// Jacobian can change by within a texel that is no larger than a cell.
    double slope_ratio() const {
        double product = 1.0;
        for (const auto* table : {&rows, &columns}) {
            double largest = 1.0;
            for (int r = 0; r < table->rows; ++r) {
                for (int k = 0; k + 2 <= table->cells; ++k) {
                    const double a = table_node(*table, r, k + 1) - table_node(*table, r, k);
                    const double b = table_node(*table, r, k + 2) - table_node(*table, r, k + 1);
                    largest = std::max(largest, std::max(a / b, b / a));
                }
            }
            product *= largest;
        }
        return product;
    }
};

double plane_depth(const vec3& normal, const vec2& p) {
    return -(normal.x * p.x + normal.y * p.y) / normal.z;
}

/// Depth over the centre's that the plane reaches in the texel of `centre`, by walking around it.
double needed_bias(const tables& t, const vec3& normal, const vec2& centre, double texel) {
    const double at_centre = plane_depth(normal, unwarp(t.rows, t.columns, centre));
    double largest = 0.0;
    const int steps = 24;
    for (int side = 0; side < 4; ++side) {
        for (int i = 0; i < steps; ++i) {
            const double s = (i + 0.5) / steps - 0.5;
            const vec2 at = side == 0   ? vec2(s, -0.5)
                            : side == 1 ? vec2(0.5, s)
                            : side == 2 ? vec2(s, 0.5)
                                        : vec2(-0.5, s);
            const vec2 p = unwarp(t.rows, t.columns, centre + at * texel);
            largest = std::max(largest, plane_depth(normal, p) - at_centre);
        }
    }
    return largest;
}

/// A plane in the scene under a light matrix, and random points of it.
struct scene_plane {
    vec3 point, normal; ///< relative to the eye

    vec4 plane() const { return vec4(normal, -glm::dot(normal, point)); }
};

struct outcome {
    int acne = 0;
    double given = 0.0;  ///< mean bias
    double needed = 0.0; ///< mean of what the texel of each point needs
    double largest_needed = 0.0;
};

/// Walks over a plane under a light matrix: the map position of random points of the body, the
/// texel's centre, the light ray through it, and where that meets the plane.
template <typename Bias>
outcome look_up(const mat4& light, clip_space clip, const scene_plane& receiver,
                std::span<const vec3> points, double size, const Bias& bias) {
    const mat4 back = glm::inverse(light);
    const auto depth = [&](const vec3& p) {
        const vec4 c = light * vec4(p, 1.0);
        const double z = c.z / c.w;
        const double n = near_depth<double>(clip);
        return (z - n) / (far_depth<double>(clip) - n);
    };
    const auto on_plane = [&](const vec2& map) {
        const vec2 q = ndc_from_map(map, clip);
        const vec4 a = back * vec4(q, 0.25, 1.0);
        const vec4 b = back * vec4(q, 0.75, 1.0);
        const vec3 from = vec3(a) / a.w;
        const vec3 ray = vec3(b) / b.w - from;
        return from + ray * (glm::dot(receiver.normal, receiver.point - from) /
                             glm::dot(receiver.normal, ray));
    };
    outcome out;
    for (const vec3& p : points) {
        const vec4 c = light * vec4(p, 1.0);
        const vec2 map = map_from_ndc(vec2(c) / c.w, clip);
        const vec2 corner = glm::floor(map * size);
        const double stored = depth(on_plane((corner + 0.5) / size));
        const double b = bias(p, map);
        out.acne += stored < depth(p) - b ? 1 : 0;
        out.given += b;
        double most = 0.0;
        for (int k = 0; k < 4; ++k) {
            const vec2 at = (corner + vec2(k & 1, k >> 1)) / size;
            most = std::max(most, depth(on_plane(at)) - stored);
        }
        out.needed += most;
        out.largest_needed = std::max(out.largest_needed, most);
    }
    return out;
}

/// Points of a plane inside the view of a camera at the origin that looks along -z.
std::vector<vec3> points_in_view(const scene_plane& receiver, double slope, double zn, double zf,
                                 int count, numbers& random) {
    std::vector<vec3> points;
    while (static_cast<int>(points.size()) < count) {
        const vec3 ray(random(-slope, slope), random(-slope, slope), -1.0);
        const double along = glm::dot(receiver.normal, ray);
        const double z = glm::dot(receiver.normal, receiver.point) / along;
        if (z > zn && z < zf) {
            points.push_back(z * ray);
        }
    }
    return points;
}

/// A receiver with the given slope against the plane across the light, through a point.
scene_plane tilted(const vec3& light, double slope, double azimuth, const vec3& through) {
    const auto axes = light_frame(light);
    const vec3 down = std::cos(azimuth) * axes.right + std::sin(azimuth) * axes.up;
    return {through, glm::normalize(-axes.forward + slope * down)};
}

} // namespace

// --- planes under matrices -----------------------------------------------------------------------

TEST_CASE("no acne under uniform and LiSPSM maps, at no more than is needed") {
    numbers random;
    const double zf = 200.0;
    const auto camera = make_frustum<double>(vec3(0), vec3(0, 0, -1), vec3(0, 1, 0),
                                             perspective_volume(pi / 3.0, 1.0, 1.0, zf))
                            .value;
    std::vector<vec3> body;
    for (const vec4& c : frustum_corners(camera)) {
        body.push_back(vec3(c));
    }
    const double size = 512.0;
    const mat2 one(1.0);
    for (const double strength : {0.0, 1.0}) {
        for (const clip_space& clip : {clip::opengl, clip::vulkan.reversed()}) {
            outcome sum;
            int points_seen = 0;
            const int planes = 20;
            const int count = std::max(50, acne_point_count() / planes);
            for (int i = 0; i < planes; ++i) {
                const vec3 light =
                    glm::normalize(vec3(random(-1.0, 1.0), random(-1.0, -0.5), random(-0.6, 0.6)));
                lispsm_options<double> options;
                options.strength = strength;
                const auto r = lispsm<double>(camera, sun(light), body, clip, options);
                REQUIRE((r.rho > 0.0) == (strength > 0.0));
                const auto receiver = tilted(light, 20.0 * random(0.0, 1.0), random(0.0, 6.28),
                                             vec3(random(-5.0, 5.0), random(-8.0, 2.0), -40.0));
                const auto points = points_in_view(receiver, 0.57, 1.0, zf, count, random);
                const auto planes_matrix = map_planes(r.matrix, clip);
                REQUIRE(planes_matrix.flags == status::ok);
                const vec3 normal = map_normal(planes_matrix.matrix, receiver.plane());
                // what is left is rounding in this test's own double arithmetic
                auto settings = settings_for(vec2(size), 1e-11);
                settings.largest = 1e3;
                const auto seen =
                    look_up(r.matrix, clip, receiver, points, size, [&](const vec3&, const vec2&) {
                        const auto b = footprint_bias(normal, one, settings);
                        REQUIRE_FALSE(b.aliasing);
                        return b.value;
                    });
                sum.acne += seen.acne;
                sum.given += seen.given;
                sum.needed += seen.needed;
                sum.largest_needed = std::max(sum.largest_needed, seen.largest_needed);
                points_seen += static_cast<int>(points.size());
                // without it there is
                if (i == 0) {
                    const auto none = look_up(r.matrix, clip, receiver, points, size,
                                              [](const vec3&, const vec2&) { return 0.0; });
                    CHECK(none.acne > count / 10);
                }
            }
            CAPTURE(strength, sum.given, sum.needed);
            CHECK(sum.acne == 0);
            CHECK(sum.given <= 1.001 * sum.needed);
            // one constant for all of these points is what the worst of them needs, which is the
            // mean only if all need the same
            CHECK(sum.largest_needed * points_seen > sum.given);
        }
    }
}

TEST_CASE("J53: a strong warp, w from 1 to 31, and a plane of slope 20") {
    numbers random;
    // n_opt with far / near = 961: 1 + d / n = 31
    const auto camera = make_frustum<double>(vec3(0), vec3(0, 0, -1), vec3(0, 1, 0),
                                             perspective_volume(pi / 3.0, 1.0, 1.0, 961.0))
                            .value;
    std::vector<vec3> body;
    for (const vec4& c : frustum_corners(camera)) {
        body.push_back(vec3(c));
    }
    const vec3 light(0, -1, 0);
    const auto r = lispsm<double>(camera, sun(light), body, clip::opengl);
    REQUIRE(std::exp(r.rho) == Approx(31.0));
    const double size = 512.0;
    const auto planes_matrix = map_planes(r.matrix, clip::opengl);
    const int count = std::max(10000, 10 * point_count());
    for (const double azimuth : {0.7, 2.0}) {
        const auto receiver = tilted(light, 20.0, azimuth, vec3(0, -5, -100));
        const auto points = points_in_view(receiver, 0.57, 1.0, 961.0, count / 2, random);
        const vec3 normal = map_normal(planes_matrix.matrix, receiver.plane());
        auto settings = settings_for(vec2(size), 1e-11);
        settings.largest = 1e3;
        const auto bias = footprint_bias(normal, mat2(1.0), settings);
        const auto seen = look_up(r.matrix, clip::opengl, receiver, points, size,
                                  [&](const vec3&, const vec2&) { return bias.value; });
        CHECK(seen.acne == 0);
        CHECK(seen.given <= 1.01 * seen.needed);
    }
}

TEST_CASE("one constant bias for all receivers is many times what the footprint needs") {
    numbers random;
    const auto camera = make_frustum<double>(vec3(0), vec3(0, 0, -1), vec3(0, 1, 0),
                                             perspective_volume(pi / 3.0, 1.0, 1.0, 200.0))
                            .value;
    std::vector<vec3> body;
    for (const vec4& c : frustum_corners(camera)) {
        body.push_back(vec3(c));
    }
    const vec3 light(0.2, -1, 0.1);
    const auto r = lispsm<double>(camera, sun(light), body, clip::opengl);
    const auto planes_matrix = map_planes(r.matrix, clip::opengl);
    auto settings = settings_for(vec2(512.0), 1e-11);
    settings.largest = 1e3;
    double given = 0.0;
    double best_constant = 0.0; // the least that leaves no acne
    const int planes = 200;
    for (int i = 0; i < planes; ++i) {
        const auto receiver = tilted(light, std::tan(random(0.0, 1.5)), random(0.0, 6.28),
                                     vec3(0, random(-5, 5), -20));
        const double b =
            footprint_bias(map_normal(planes_matrix.matrix, receiver.plane()), mat2(1.0), settings)
                .value;
        given += b / planes;
        best_constant = std::max(best_constant, b);
    }
    CHECK(best_constant > 3.0 * given);
}

// --- planes under tables -------------------------------------------------------------------------

TEST_CASE("no acne under rectilinear and non-orthogonal tables, at no more than is needed") {
    struct map {
        const char* name;
        int cells;
        double window;
    };
    // a window of 2 makes all functions equal: rectilinear warping
    const map maps[] = {
        {"RTW 64", 64, 2.0}, {"RTW 256", 256, 2.0}, {"NOTW 64", 64, 0.25}, {"NOTW 128", 128, 0.12}};
    for (const map& m : maps) {
        const tables t(m.cells, m.window);
        for (const double size : {256.0, 1024.0}) {
            numbers random;
            auto settings = settings_for(vec2(size), 1e-13);
            settings.largest = 1e3;
            auto guarded = settings;
            guarded.slope_ratio = t.slope_ratio();
            double by_corners = 0.0;
            double by_jacobian = 0.0;
            double needed = 0.0;
            double best_constant = 0.0; // the least that leaves no acne
            int compared = 0;
            int acne_corners = 0;
            int acne_jacobian = 0;
            int acne_guarded = 0;
            int acne_none = 0;
            const int count = acne_point_count() / 2;
            for (int i = 0; i < count; ++i) {
                const vec3 normal = random.normal(20.0);
                const vec2 p(random(0.0, 1.0), random(0.0, 1.0));
                const vec2 centre = (glm::floor(warp(t.rows, t.columns, p) * size) + 0.5) / size;
                const vec2 from = unwarp(t.rows, t.columns, centre);
                const mat2 j = jacobian(t.rows, t.columns, p);
                const double excess = plane_depth(normal, p) - plane_depth(normal, from);
                const double corners = corner_bias(t.rows, t.columns, normal, p, settings).value;
                const double direct = footprint_bias(normal, j, settings).value;
                best_constant = std::max(best_constant, excess);
                acne_none += excess > 0.0 ? 1 : 0;
                acne_corners += excess > corners ? 1 : 0;
                acne_jacobian += excess > direct ? 1 : 0;
                acne_guarded += excess > footprint_bias(normal, j, guarded).value ? 1 : 0;
                if (i % 8 == 0) {
                    by_corners += corners;
                    by_jacobian += direct;
                    needed += needed_bias(t, normal, centre, 1.0 / size);
                    ++compared;
                }
            }
            CAPTURE(m.name, size, guarded.slope_ratio);
            CHECK(acne_none > count / 4);
            CHECK(acne_corners == 0);
            CHECK(acne_guarded == 0);
            // the Jacobian at one point knows nothing of a kink elsewhere in the texel
            CHECK(acne_jacobian <= count / 50);
            CHECK(by_corners <= 1.05 * needed);
            CHECK(by_jacobian <= 1.05 * needed);
            CHECK(best_constant * compared > by_corners); // as above
        }
    }
}

TEST_CASE("the filter's reach widens the footprint: all taps, all texels") {
    const tables t(64, 0.25);
    numbers random;
    const double size = 512.0;
    for (const double radius : {0.5, 1.0, 2.5}) {
        auto settings = settings_for(vec2(size), 1e-13);
        settings.largest = 1e3;
        settings.radius = radius;
        auto guarded = settings;
        guarded.slope_ratio = t.slope_ratio();
        int acne = 0;
        int acne_guarded = 0;
        for (int i = 0; i < point_count() / 20; ++i) {
            const vec3 normal = random.normal(20.0);
            const vec2 p(random(0.05, 0.95), random(0.05, 0.95));
            const vec2 centre = (glm::floor(warp(t.rows, t.columns, p) * size) + 0.5) / size;
            const double corners = corner_bias(t.rows, t.columns, normal, p, settings).value;
            const double direct =
                footprint_bias(normal, jacobian(t.rows, t.columns, p), guarded).value;
            for (int tap = 0; tap < 9; ++tap) {
                const vec2 at = centre + radius * vec2(tap % 3 - 1, tap / 3 - 1) / size;
                const double excess =
                    plane_depth(normal, p) - plane_depth(normal, unwarp(t.rows, t.columns, at));
                acne += excess > corners ? 1 : 0;
                acne_guarded += excess > direct ? 1 : 0;
            }
        }
        CAPTURE(radius);
        // the corners of the filter alone: kinks between them may hide a tap in a thousand
        CHECK(acne <= 9 * std::max(10, point_count() / 20) / 1000);
        CHECK(acne_guarded == 0);
    }
}

TEST_CASE("comparing at the texel's centre needs no footprint at all") {
    const tables t(64, 0.25);
    numbers random;
    for (int i = 0; i < 1000; ++i) {
        const vec3 normal = random.normal(50.0);
        const vec2 p(random(0.0, 1.0), random(0.0, 1.0));
        const vec2 centre = (glm::floor(warp(t.rows, t.columns, p) * 512.0) + 0.5) / 512.0;
        const vec2 to = unwarp(t.rows, t.columns, centre);
        const double step = plane_depth_step(normal, p, to, 1e3);
        CHECK(plane_depth(normal, p) + step == Approx(plane_depth(normal, to)).margin(1e-13));
    }
    CHECK(plane_depth_step(vec3(1, 0, 0), vec2(0.1), vec2(0.2), 1.0) == 0.0);
    CHECK(plane_depth_step(vec3(1, 0, 1e-9), vec2(0.1), vec2(0.2), 1.0) == 0.0);
}

// --- limits --------------------------------------------------------------------------------------

TEMPLATE_TEST_CASE("J52: flat receivers and receivers parallel to the light", "", float, double) {
    using T = TestType;
    using v3 = glm::vec<3, T>;
    const auto settings = settings_for(glm::vec<2, T>(T(512)), T(1e-5));
    const glm::mat<2, 2, T> one(T(1));
    for (const T z : {T(1), T(-3), T(1e-20), T(1e20)}) {
        const auto flat = footprint_bias(v3(T(0), T(0), z), one, settings);
        CHECK(flat.value == T(1e-5));
        CHECK_FALSE(flat.aliasing);
    }
    for (const v3& n :
         {v3(T(1), T(0), T(0)), v3(T(0), T(-1), T(0)), v3(T(1), T(1), T(1e-30)),
          v3(T(0), T(0), T(0)), v3(std::numeric_limits<T>::quiet_NaN(), T(0), T(1))}) {
        const auto edge_on = footprint_bias(n, one, settings);
        CHECK(edge_on.value == settings.largest);
        CHECK(edge_on.aliasing);
        CHECK(slope_scale_bias(n, settings, T(1), T(0)).aliasing);
    }
    const glm::mat<2, 2, T> flat_map(T(0));
    CHECK(footprint_bias(v3(T(1), T(0), T(1)), flat_map, settings).aliasing);
}

TEMPLATE_TEST_CASE("any numbers at all: between 0 and the clamp", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        using camera_test::any_number;
        using camera_test::any_numbers;
        auto settings = settings_for(glm::vec<2, T>(T(512), T(256)), T(1e-6));
        settings.radius = coin() ? T(0) : between<T>(0.0, 10.0);
        settings.deviation = coin() ? T(0) : between<T>(0.0, 0.1);
        const auto normal = any_numbers<T>();
        glm::mat<2, 2, T> j(any_number<T>(), any_number<T>(), any_number<T>(), any_number<T>());
        const auto b = footprint_bias(normal, j, settings);
        RC_ASSERT(b.value >= T(0));
        RC_ASSERT(b.value <= settings.largest);
        const auto s = slope_scale_bias(normal, settings, T(2), T(1e-6));
        RC_ASSERT(s.value >= T(0));
        RC_ASSERT(s.value <= settings.largest);
        const T w0 = any_number<T>();
        const T w1 = any_number<T>();
        if (std::isfinite(w0) && std::isfinite(w1)) {
            const T e = linear_depth_error(w0, w1);
            RC_ASSERT(e >= T(0));
            RC_ASSERT(e <= T(1));
        }
    }));
}

TEMPLATE_TEST_CASE("the length and the sign of the normal do not matter", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const auto settings = settings_for(glm::vec<2, T>(T(1024)), T(1e-7));
        const glm::vec<3, T> n(between<T>(-2.0, 2.0), between<T>(-2.0, 2.0), between<T>(0.1, 1.0));
        const glm::mat<2, 2, T> j(between<T>(0.5, 4.0), between<T>(-0.3, 0.3),
                                  between<T>(-0.3, 0.3), between<T>(0.5, 4.0));
        const auto a = footprint_bias(n, j, settings);
        const auto b = footprint_bias(n * T(-64), j, settings);
        RC_ASSERT(a.value == b.value);
        // a mirrored map has the same footprint
        const glm::mat<2, 2, T> mirrored(-j[0][0], j[0][1], -j[1][0], j[1][1]);
        RC_ASSERT(footprint_bias(n, mirrored, settings).value == a.value);
    }));
}

TEST_CASE("a float evaluation gives the double bias to a few ulp") {
    REQUIRE(rc::check([] {
        const glm::vec3 n(between<float>(-2.0, 2.0), between<float>(-2.0, 2.0),
                          between<float>(0.1, 1.0));
        const glm::mat2 j(between<float>(0.5, 4.0), between<float>(-0.3, 0.3),
                          between<float>(-0.3, 0.3), between<float>(0.5, 4.0));
        const auto f = footprint_bias(n, j, settings_for(glm::vec2(1024.0f), 0.0f));
        const auto d = footprint_bias(vec3(n), mat2(j), settings_for(vec2(1024.0), 0.0));
        // differences of products of at most 8 over a determinant of at least 0.16: 2^-24 · 8 /
        // 0.16 and a dozen roundings of that size
        RC_ASSERT(std::abs(double(f.value) - d.value) <= 1e-4 * d.value + 1e-8);
    }));
}

// --- the classics --------------------------------------------------------------------------------

TEST_CASE("polygon offset with factor 2 r + 1 is never too little") {
    REQUIRE(rc::check([] {
        auto settings = settings_for(vec2(512.0, 1024.0), 1e-6);
        settings.largest = 1e6;
        settings.radius = coin() ? 0.0 : between<double>(0.0, 4.0);
        const vec3 n(between<double>(-30.0, 30.0), between<double>(-30.0, 30.0), 1.0);
        const auto footprint = footprint_bias(n, mat2(1.0), settings);
        const auto offset =
            slope_scale_bias(n, settings, polygon_offset_factor(settings.radius), 1e-6);
        RC_ASSERT(offset.value >= footprint.value * (1.0 - 1e-14));
        RC_ASSERT(offset.value <= 2.0 * footprint.value * (1.0 + 1e-14));
    }));
    CHECK(constant_bias(4.0, depth_quantum<double>(24)) == 4.0 / 16777215.0);
    CHECK(depth_quantum<double>(16) == 1.0 / 65535.0);
}

TEST_CASE("back faces: only what is thinner than the footprint needs a bias") {
    CHECK(back_face_bias(0.01, 0.02) == 0.0);
    CHECK(back_face_bias(0.01, 0.004) == Approx(0.006));
    // a slab of that thickness, its back face in the map: zero acne from this bias on, by search
    numbers random;
    for (int i = 0; i < 2000; ++i) {
        const double slope = random(0.0, 30.0);
        const double thickness = random(0.0, 0.05);
        auto settings = settings_for(vec2(512.0), 0.0);
        settings.largest = 1e3;
        const double b = back_face_bias(
            footprint_bias(vec3(-slope, 0, 1), mat2(1.0), settings).value, thickness);
        const double p = random(0.0, 1.0);
        const double centre = (std::floor(p * 512.0) + 0.5) / 512.0;
        CHECK_FALSE(slope * centre + thickness < slope * p - b - 1e-15);
    }
}

TEST_CASE("linear depth per fragment is the light's own, exactly") {
    const auto camera = make_frustum<double>(vec3(0), vec3(0, 0, -1), vec3(0, 1, 0),
                                             perspective_volume(pi / 3.0, 1.0, 1.0, 100.0))
                            .value;
    std::vector<vec3> body;
    for (const vec4& c : frustum_corners(camera)) {
        body.push_back(vec3(c));
    }
    const auto light = sun(vec3(0.2, -1, 0.1));
    const mat4 m =
        directional_light_matrix(light, box3<double>{vec3(-150), vec3(150)}, clip::d3d).matrix;
    const auto r = lispsm_warp<double>(camera, light, m, body, clip::d3d);
    numbers random;
    for (int i = 0; i < 100; ++i) {
        const vec3 p(random(-10, 10), random(-10, 10), random(-90, -20));
        const vec4 c = r.matrix * vec4(p, 1.0);
        CHECK(linear_depth(c.z / c.w, c.w, vec3(r.depth_scale, r.depth_shift, r.depth_centre)) ==
              Approx((m * vec4(p, 1.0)).z).epsilon(1e-9));
        CHECK(linear_depth_vertex(0.3, c.w) / c.w == Approx(0.3));
    }
}

TEST_CASE("J54: linear depth per vertex: the error bound is met, and refused") {
    REQUIRE(rc::check([] {
        const double w0 = log_between<double>(1e-2, 1e2);
        const double w1 = log_between<double>(1e-2, 1e2);
        // along the edge on the screen: what comes out against what should
        double largest = 0.0;
        for (int i = 0; i <= 4000; ++i) {
            const double t = i / 4000.0;
            const double weight = t / w1 / ((1.0 - t) / w0 + t / w1); // perspective-correct
            largest = std::max(largest, std::abs(weight - t));
        }
        const double bound = linear_depth_error(w0, w1);
        RC_ASSERT(largest <= bound * (1.0 + 1e-12));
        RC_ASSERT(largest >= bound * 0.999 - 1e-6); // and no smaller would do
        const double e = between<double>(0.0, 0.9);
        const double q = std::max(w0, w1) / std::min(w0, w1);
        const double limit = std::pow((1.0 + e) / (1.0 - e), 2.0);
        RC_PRE(std::abs(q - limit) > 1e-9 * limit);
        RC_ASSERT(linear_depth_allowed(w0, w1, e) == (q <= limit));
    }));
    CHECK(linear_depth_error(1.0, 10.0) == Approx(0.5195).epsilon(1e-3)); // 52 %
    CHECK_FALSE(linear_depth_allowed(1.0, 10.0, 0.1));
    CHECK(linear_depth_allowed(1.0, 1.1, 0.03));
    CHECK(linear_depth_error(0.0, 1.0) == 1.0);
    CHECK(linear_depth_error(-1.0, 1.0) == 1.0);
}

// --- in the scene --------------------------------------------------------------------------------

TEST_CASE("texel axes: one texel across the light ray, under lights of all kinds and tables") {
    const tables t(64, 0.25);
    REQUIRE(rc::check([&] {
        const auto camera = make_frustum<double>(vec3(0), vec3(0, 0, -1), vec3(0, 1, 0),
                                                 perspective_volume(pi / 3.0, 1.0, 1.0, 100.0))
                                .value;
        std::vector<vec3> body;
        for (const vec4& c : frustum_corners(camera)) {
            body.push_back(vec3(c));
        }
        const bool spot = coin();
        const auto source = spot ? spot_light(vec3(0, 90, -40), vec3(0, 0, -60), 2.5)
                                 : sun(camera_test::any_direction<double>(0.5, 2.0));
        const auto r = lispsm<double>(camera, source, body, clip::opengl);
        const double z = between<double>(2.0, 99.0);
        const vec3 p(z * between<double>(-0.5, 0.5), z * between<double>(-0.5, 0.5), -z);
        const vec2 texel(1.0 / 512.0, 1.0 / 1024.0);
        const bool warped = coin();
        const auto map = [&](const vec3& q) {
            const vec4 c = r.matrix * vec4(q, 1.0);
            const vec2 m = map_from_ndc(vec2(c) / c.w, clip::opengl);
            return m;
        };
        const mat2 j = warped ? jacobian(t.rows, t.columns, map(p)) : mat2(1.0);
        const auto axes = texel_axes_at(r.matrix, j, p, texel);
        const vec3 ray =
            spot ? glm::normalize(p - source.position) : glm::normalize(vec3(source.direction));
        RC_ASSERT(std::abs(glm::dot(axes.u, ray)) <= 1e-9 * glm::length(axes.u));
        RC_ASSERT(std::abs(glm::dot(axes.v, ray)) <= 1e-9 * glm::length(axes.v));
        // by difference quotients: a thousandth of a texel either way
        const double h = 1e-3;
        const vec2 du = j * ((map(p + h * axes.u) - map(p - h * axes.u)) / (2.0 * h));
        const vec2 dv = j * ((map(p + h * axes.v) - map(p - h * axes.v)) / (2.0 * h));
        RC_ASSERT(glm::length(du / texel - vec2(1, 0)) <= 1e-5);
        RC_ASSERT(glm::length(dv / texel - vec2(0, 1)) <= 1e-5);
    }));
    // no image plane
    const auto none = texel_axes_at(mat4(0.0), mat2(1.0), vec3(1.0), vec2(1e-3));
    CHECK(none.u == vec3(0.0));
    CHECK(none.v == vec3(0.0));
}

TEST_CASE("peers 39: the normal offset is the footprint bias, and bounded at grazing light") {
    const auto source = sun(vec3(0.1, -1, 0.2));
    const box3<double> box{vec3(-10, -3, -40), vec3(10, 3, 40)};
    const mat4 m = directional_light_matrix(source, box, clip::d3d).matrix;
    const auto axes_of_light = light_frame(source.direction);
    REQUIRE(rc::check([&] {
        // texels four times as wide as high, and the other way round
        const vec2 size = coin() ? vec2(128.0, 2048.0) : vec2(4096.0, 64.0);
        const auto receiver = tilted(vec3(source.direction), log_between<double>(1e-3, 1e6),
                                     between<double>(0.0, 6.28), vec3(0.0));
        const auto planes_matrix = map_planes(m, clip::d3d);
        auto settings = settings_for(size, 0.0);
        settings.largest = 1e9;
        settings.radius = between<double>(0.0, 3.0);
        const double bias =
            footprint_bias(map_normal(planes_matrix.matrix, receiver.plane()), mat2(1.0), settings)
                .value;
        const auto axes = texel_axes_at(m, mat2(1.0), vec3(0.0), settings.texel);
        const double offset = normal_offset(receiver.normal, axes, settings.radius);
        // as depth along the light ray: divided by the cosine, and by the depth of the map
        const double cosine = std::abs(glm::dot(receiver.normal, axes_of_light.forward));
        const double depth_per_length =
            (m * vec4(vec3(axes_of_light.forward), 0.0)).z; // no division: w is 1
        RC_ASSERT(std::abs(offset / cosine * depth_per_length - bias) <= 1e-6 * bias);
        RC_ASSERT(offset <= (settings.radius + 0.5) * (glm::length(axes.u) + glm::length(axes.v)) *
                                (1.0 + 1e-12));
        // a constant from the texel's larger or smaller side alone is too much or too little
        const double wide = std::max(glm::length(axes.u), glm::length(axes.v));
        const double narrow = std::min(glm::length(axes.u), glm::length(axes.v));
        const double sine = std::sqrt(1.0 - cosine * cosine);
        RC_ASSERT(offset <= (settings.radius + 0.5) * 2.0 * wide * sine * (1.0 + 1e-9) + 1e-12);
        RC_ASSERT(offset >= (settings.radius + 0.5) * narrow * sine * (1.0 - 1e-9) - 1e-12);
    }));
}

TEST_CASE("peers 38: a filter of one size in the scene, wherever it is in a warped map") {
    const auto camera = make_frustum<double>(vec3(0), vec3(0, 0, -1), vec3(0, 1, 0),
                                             perspective_volume(pi / 3.0, 1.0, 1.0, 100.0))
                            .value;
    std::vector<vec3> body;
    for (const vec4& c : frustum_corners(camera)) {
        body.push_back(vec3(c));
    }
    const auto r = lispsm<double>(camera, sun(vec3(0, -1, 0)), body, clip::opengl);
    const double radius = 1e-3;
    double least = 1e9;
    double most = 0.0;
    for (double z = 2.0; z < 99.0; z *= 1.5) {
        const vec3 p(0.1 * z, -1.0, -z);
        const auto axes = texel_axes_at(r.matrix, mat2(1.0), p, vec2(1.0 / 1024.0));
        const vec2 texels = filter_radii(axes, radius);
        // that many texels from p the scene is `radius` away
        CHECK(texels.x * glm::length(axes.u) == Approx(radius));
        CHECK(texels.y * glm::length(axes.v) == Approx(radius));
        least = std::min(least, texels.x);
        most = std::max(most, texels.x);
    }
    CHECK(most > 3.0 * least); // a filter of fixed texels would grow with the distance
}

TEST_CASE("map_planes: a matrix without an inverse, and every convention") {
    CHECK(map_planes(mat4(0.0), clip::opengl).flags == status::not_invertible);
    CHECK(map_planes(mat4(0.0), clip::opengl).matrix == mat4(1.0));
    const auto source = sun(vec3(0.1, -1, 0.2));
    const box3<double> box{vec3(-10), vec3(10)};
    const scene_plane receiver = tilted(vec3(source.direction), 2.0, 0.7, vec3(1, 2, 3));
    const auto axes = light_frame(source.direction);
    for (const clip_space& clip : camera_test::all_conventions()) {
        const mat4 m = directional_light_matrix(source, box, clip).matrix;
        const auto planes_matrix = map_planes(m, clip);
        REQUIRE(planes_matrix.flags == status::ok);
        const vec3 n = map_normal(planes_matrix.matrix, receiver.plane());
        // by difference quotients on the receiver, in map space with depth from the light
        const auto place = [&](const vec3& p) {
            const vec4 c = m * vec4(p, 1.0);
            const double d0 = near_depth<double>(clip);
            return vec3(map_from_ndc(vec2(c), clip), (c.z - d0) / (far_depth<double>(clip) - d0));
        };
        const vec3 side = glm::normalize(glm::cross(receiver.normal, axes.up));
        const vec3 other = glm::cross(receiver.normal, side);
        const vec3 du = place(receiver.point + side) - place(receiver.point);
        const vec3 dv = place(receiver.point + other) - place(receiver.point);
        const vec3 expected = map_normal(du, dv);
        CHECK(glm::length(glm::cross(glm::normalize(n), glm::normalize(expected))) <= 1e-12);
    }
}
