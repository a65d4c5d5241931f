// Properties of warpshadow/stable_fit.hpp.
#include "camera.hpp"

#include <warpshadow/stable_fit.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

using namespace warpshadow;
using namespace camera_test;

namespace {

using d3 = glm::dvec3;

template <typename T> frustum<T> looking(const d3& eye, const d3& forward) {
    return make_frustum(glm::vec<3, T>(eye), glm::vec<3, T>(forward),
                        glm::vec<3, T>(T(0), T(1), T(0)),
                        perspective_volume(T(1), T(1.5), T(0.5), T(30)))
        .value;
}

template <typename T> box3<T> plain_box() {
    return {glm::vec<3, T>(T(-50), T(-1), T(-50)), glm::vec<3, T>(T(50), T(9), T(50))};
}

/// Number of the texel of the grid that a point falls into, and how near it is to a border.
template <typename T>
std::array<double, 2> grid_texel(const stable_result<T>& fit, const real3& p, int size,
                                 double& to_border) {
    const real4 clip = multiply(fit.matrix, {p[0], p[1], p[2], real(1)});
    std::array<double, 2> texel{};
    for (std::size_t k = 0; k < 2; ++k) {
        const double first = k == 0 ? fit.x.first : fit.y.first;
        const double at = as_double((clip[k] + 1) / 2 * size) + first;
        texel[k] = std::floor(at);
        to_border = std::min({to_border, at - texel[k], texel[k] + 1.0 - at});
    }
    return texel;
}

/// Area of the hull of a few points: gift wrapping, then the sum over its sides.
double hull_area(const std::vector<glm::dvec2>& points) {
    std::size_t start = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        start = points[i].x < points[start].x ? i : start;
    }
    double twice = 0.0;
    std::size_t at = start;
    for (std::size_t n = 0; n < points.size(); ++n) {
        std::size_t next = at == 0 ? 1 : 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const glm::dvec2 a = points[next] - points[at];
            const glm::dvec2 b = points[i] - points[at];
            next = a.x * b.y - a.y * b.x < 0.0 ? i : next;
        }
        twice += points[at].x * points[next].y - points[at].y * points[next].x;
        at = next;
        if (at == start) {
            break;
        }
    }
    return 0.5 * twice;
}

} // namespace

TEST_CASE("a quantised length is at most an eighth longer and made of four bits", "[stable]") {
    REQUIRE(rc::check("bits", [] {
        const double x = log_between<double>(1e-30, 1e30);
        const double q = quantised_length(x);
        RC_ASSERT(q >= x);
        RC_ASSERT(q <= x * 1.125);
        RC_ASSERT(quantised_length(q) == q);
        RC_ASSERT(quantised_length(x * 1024.0) == q * 1024.0);
        int exponent = 0;
        const double sixteenths = 16.0 * std::frexp(q, &exponent);
        RC_ASSERT(sixteenths == std::floor(sixteenths));
    }));
}

TEST_CASE("a span of texels holds its extent with the margin", "[stable]") {
    REQUIRE(rc::check("span", [] {
        const int texels = *rc::gen::inRange(8, 5000);
        const int margin = *rc::gen::inRange(0, 3);
        const double extent = log_between<double>(1e-3, 1e3);
        const double lo = between<double>(-1e4, 1e4);
        const double texel = texel_for(extent, texels, margin);
        const texel_span span = snap_to_texels(lo, texel, margin);
        RC_ASSERT(span.first == std::floor(span.first));
        // lo / texel is rounded once, and lo + extent once more
        const double bound = 0x1p-51 * (std::abs(lo) + extent);
        RC_ASSERT((span.first + margin) * texel <= lo + bound);
        RC_ASSERT((span.first + texels - margin) * texel >= lo + extent - bound);
    }));
    REQUIRE(any(snap_to_texels(1e30, 1e-3, 0).flags, status::out_of_range));
    REQUIRE(texel_for(1.0, 3, 1) == 0.0);
}

TEMPLATE_TEST_CASE("the ball holds all corners and knows only the volume", "[stable]", float,
                   double) {
    REQUIRE(rc::check("ball", [] {
        const auto volume = any_volume<TestType>(coin(), 100.0);
        const view_ball ball = bounding_ball(volume);
        const auto camera =
            make_frustum(any_direction<TestType>(1, 10), any_direction<TestType>(1, 10),
                         any_direction<TestType>(1, 10), volume)
                .value;
        const glm::dvec3 centre = ball.distance * d3(camera.forward) +
                                  ball.across.x * d3(camera.right) + ball.across.y * d3(camera.up);
        // the ball is 2^-40 larger; corners are rounded to T, along axes that are unit and
        // perpendicular to 4u: each moves a corner by a few u of its own distance
        for (const auto& corner : frustum_corners(camera)) {
            const double bound =
                16.0 * roundoff<TestType>() * (ball.radius + glm::length(d3(corner)));
            RC_ASSERT(glm::length(d3(corner) - centre) <= ball.radius + bound);
        }
    }));
    // symmetric: the smallest, as two opposite near and far corners are on it
    const auto v = perspective_volume(TestType(1), TestType(1.5), TestType(1), TestType(2));
    const view_ball ball = bounding_ball(v);
    const double slope2 = double(v.right) * double(v.right) + double(v.top) * double(v.top);
    const double to_near = std::hypot(std::sqrt(slope2), ball.distance - 1.0);
    const double to_far = std::hypot(2.0 * std::sqrt(slope2), ball.distance - 2.0);
    REQUIRE(ball.radius == Approx(std::max(to_near, to_far)).epsilon(1e-11)); // 2^-40 and roundings
    REQUIRE(any(bounding_ball(perspective_volume(TestType(1), TestType(1), TestType(1),
                                                 std::numeric_limits<TestType>::infinity()))
                    .flags,
                status::unbounded));
}

TEMPLATE_TEST_CASE("peers 36, 37: the whole view stays inside the margin wherever the camera is",
                   "[stable]", float, double) {
    REQUIRE(rc::check("inside", [] {
        const auto camera = looking<TestType>(d3(any_direction<double>(0.1, 100.0)),
                                              d3(any_direction<double>(1.0, 2.0)));
        stable_options<TestType> options;
        options.map_size = *rc::gen::inRange(16, 4096);
        options.margin = *rc::gen::inRange(0, 4);
        options.clip = any_convention();
        options.origin = camera.eye;
        const auto source = sun(any_direction<TestType>(1, 2));
        const auto fit = stable_fit(camera, source, plain_box<TestType>(), options);
        RC_ASSERT(fit.flags == status::ok);
        const double border = 1.0 - 2.0 * options.margin / double(options.map_size);
        for (const auto& corner : frustum_corners(camera)) {
            const real4 p{real(corner.x), real(corner.y), real(corner.z), real(1)};
            const real4 clip = multiply(fit.matrix, p);
            const real4 size = magnitudes(fit.matrix, p);
            for (std::size_t k = 0; k < 2; ++k) {
                // entries and corners are rounded to T: 2u each of every term, and the ball's
                // centre is off by the axes' 4u of its distance, which is a term's size too
                const double bound = 16.0 * roundoff<TestType>() * as_double(size[k] + 1);
                RC_ASSERT(as_double(abs(clip[k])) <= border + bound);
            }
        }
        // the scene's box fills the depth range
        const double d0 = near_depth<double>(options.clip), d1 = far_depth<double>(options.clip);
        double lo = 2.0, hi = -2.0, bound = 0.0;
        for (int i = 0; i < 8; ++i) {
            const auto box = plain_box<TestType>();
            const real4 p{real((i & 1) != 0 ? box.lo.x : box.hi.x) - real(options.origin.x),
                          real((i & 2) != 0 ? box.lo.y : box.hi.y) - real(options.origin.y),
                          real((i & 4) != 0 ? box.lo.z : box.hi.z) - real(options.origin.z),
                          real(1)};
            const double z = as_double(multiply(fit.matrix, p)[2]);
            bound = std::max(bound,
                             8.0 * roundoff<TestType>() * as_double(magnitudes(fit.matrix, p)[2]));
            lo = std::min(lo, z);
            hi = std::max(hi, z);
        }
        RC_ASSERT(std::abs(lo - std::min(d0, d1)) <= bound);
        RC_ASSERT(std::abs(hi - std::max(d0, d1)) <= bound);
    }));
}

TEMPLATE_TEST_CASE("peers 37: moving the camera by less than a texel changes no texel, turning it "
                   "no size",
                   "[stable]", float, double) {
    const auto source = sun(glm::vec<3, TestType>(TestType(0.3), TestType(-1), TestType(0.2)));
    stable_options<TestType> options;
    options.map_size = 256;
    std::vector<glm::vec<3, TestType>> points;
    for (int i = 0; i < 40; ++i) {
        points.push_back(glm::vec<3, TestType>(TestType(0.37 * i - 7.0), TestType(0.05 * i),
                                               TestType(8.0 - 0.41 * i)));
    }
    std::vector<std::array<double, 2>> before;
    int same_matrix = 0;
    int undecided = 0;
    glm::mat<4, 4, TestType> last(TestType(0));
    TestType texel = TestType(0);
    for (int frame = 0; frame < 400; ++frame) {
        // 0.3 texels a frame, turning by half a degree
        const double angle = 0.0087 * frame;
        const double step = 0.3 * (frame == 0 ? 0.0 : double(texel));
        const auto camera = looking<TestType>(d3(step * frame, 2.0, 0.5 * step * frame),
                                              d3(std::sin(angle), -0.2, std::cos(angle)));
        const auto fit = stable_fit(camera, source, plain_box<TestType>(), options);
        REQUIRE(fit.flags == status::ok);
        texel = frame == 0 ? fit.texel : texel;
        REQUIRE(fit.texel == texel); // no rotation changes it
        same_matrix += fit.matrix == last ? 1 : 0;
        last = fit.matrix;
        for (std::size_t i = 0; i < points.size(); ++i) {
            double to_border = 1.0;
            const auto now = grid_texel(fit, exact(points[i]), options.map_size, to_border);
            if (frame == 0) {
                before.push_back(now);
                continue;
            }
            // the rounded matrix moves a point by its entries' u times the terms, in texels
            const real4 size = magnitudes(
                fit.matrix, {real(points[i].x), real(points[i].y), real(points[i].z), real(1)});
            const double bound = 4.0 * roundoff<TestType>() * options.map_size *
                                 as_double(std::max(size[0], size[1]));
            if (to_border <= bound) {
                ++undecided;
                continue;
            }
            REQUIRE(now == before[i]);
        }
    }
    REQUIRE(undecided < 400 * 40 / 50);

    // translation alone: most frames are the same to the bit
    same_matrix = 0;
    for (int frame = 0; frame < 100; ++frame) {
        const auto camera =
            looking<TestType>(d3(0.05 * double(texel) * frame, 2.0, 0.0), d3(0.0, -0.2, 1.0));
        const auto fit = stable_fit(camera, source, plain_box<TestType>(), options);
        same_matrix += fit.matrix == last ? 1 : 0;
        last = fit.matrix;
    }
    // 5 texels along x make at most 5 + 1 moves on each axis of the grid
    REQUIRE(same_matrix >= 100 - 1 - 12);
}

TEMPLATE_TEST_CASE("the wasted area is that of the polygon", "[stable]", float, double) {
    REQUIRE(rc::check("waste", [] {
        const auto camera =
            looking<TestType>(d3(1.0, 2.0, 3.0), d3(any_direction<double>(1.0, 2.0)));
        const auto source = sun(any_direction<TestType>(1, 2));
        stable_options<TestType> options;
        options.origin = camera.eye;
        const auto fit = stable_fit(camera, source, plain_box<TestType>(), options);
        std::vector<glm::dvec2> seen;
        for (const auto& corner : frustum_corners(camera)) {
            const real4 clip =
                multiply(fit.matrix, {real(corner.x), real(corner.y), real(corner.z), real(1)});
            seen.emplace_back(as_double(clip[0]), as_double(clip[1]));
        }
        const double wasted = 1.0 - hull_area(seen) / 4.0;
        // positions in the map are off by some 16u, as is the area by its perimeter, 8, times that
        RC_ASSERT(std::abs(wasted - double(fit.wasted_area)) <= 128.0 * roundoff<TestType>());
        RC_ASSERT(wasted > 0.0);
    }));
}

TEMPLATE_TEST_CASE("scaling by a power of two scales the stable fit", "[stable]", float, double) {
    auto camera = looking<TestType>(d3(1.0, 2.0, 3.0), d3(0.2, -0.3, 1.0));
    const auto source = sun(glm::vec<3, TestType>(TestType(0.3), TestType(-1), TestType(0.2)));
    stable_options<TestType> options;
    options.origin = glm::vec<3, TestType>(TestType(1), TestType(0), TestType(2));
    box3<TestType> box = plain_box<TestType>();
    const auto a = stable_fit(camera, source, box, options);
    for (const TestType k : {TestType(0x1p-20), TestType(0x1p20)}) {
        auto other = camera;
        other.eye *= k;
        other.volume.near_distance *= k;
        other.volume.far_distance *= k;
        auto scaled = options;
        scaled.origin *= k;
        const auto b = stable_fit(other, source, box3<TestType>{box.lo * k, box.hi * k}, scaled);
        REQUIRE(b.flags == a.flags);
        REQUIRE(b.texel == a.texel * k);
        for (glm::length_t column = 0; column < 4; ++column) {
            REQUIRE(b.matrix[column] * (column < 3 ? k : TestType(1)) == a.matrix[column]);
        }
    }
}

TEMPLATE_TEST_CASE("unusable input gives the identity and says so", "[stable]", float, double) {
    const auto camera = looking<TestType>(d3(1.0, 2.0, 3.0), d3(0.2, -0.3, 1.0));
    const auto source = sun(glm::vec<3, TestType>(TestType(0.3), TestType(-1), TestType(0.2)));
    const stable_options<TestType> options;
    const auto box = plain_box<TestType>();
    auto small = options;
    small.map_size = 3;
    REQUIRE(any(stable_fit(camera, source, box, small).flags, status::out_of_range));
    auto endless = camera;
    endless.volume.far_distance = std::numeric_limits<TestType>::infinity();
    REQUIRE(any(stable_fit(endless, source, box, options).flags, status::unbounded));
    const auto zero = sun(glm::vec<3, TestType>(TestType(0)));
    REQUIRE(any(stable_fit(camera, zero, box, options).flags, status::invalid_input));
    const box3<TestType> inverted{box.hi, box.lo};
    const auto invalid = stable_fit(camera, source, inverted, options);
    REQUIRE(any(invalid.flags, status::invalid_input));
    REQUIRE(invalid.matrix == identity<TestType>());
    const auto flat = stable_fit(
        camera, sun(glm::vec<3, TestType>(0, -1, 0)),
        box3<TestType>{{box.lo.x, TestType(1), box.lo.z}, {box.hi.x, TestType(1), box.hi.z}},
        options);
    REQUIRE(any(flat.flags, status::degenerate_extent));
    REQUIRE(finite(flat.matrix));
}
