// Properties of warpshadow/shadow_frustum.hpp.
#include "exact_geometry.hpp"
#include "focus_scenes.hpp"

#include <warpshadow/shadow_frustum.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

using namespace warpshadow;
using namespace camera_test;
using namespace focus_test;

namespace {

constexpr double degree = 0.017453292519943295769;

template <typename T> fit_options<T> any_options(const focus_input<T>& scene) {
    fit_options<T> options;
    options.frame = coin() ? fit_frame::fixed : fit_frame::rotated_minimal;
    options.clip = any_convention();
    options.clip.infinite_far = false; // nothing has a far plane to be tested then
    options.map_size = {*rc::gen::inRange(64, 4097), *rc::gen::inRange(64, 4097)};
    options.margin = coin() ? T(0) : between<T>(0.0, 8.0);
    options.snap = coin();
    options.origin = scene.camera.eye; // T = float, and thousands of sizes away from the origin
    return options;
}

/// Clip position of a vertex relative to the eye, and a bound on what rounding makes of it: the
/// entries are a few roundings of double, then of T, from exact; and made from vertices that are
/// exact to 2^-46 of `extent`, as is the plane it is made from.
struct mapped {
    real4 clip;
    std::array<double, 4> bound;
};
template <typename T>
mapped map_vertex(const glm::mat<4, 4, T>& matrix, const glm::dvec4& v, double extent) {
    const real4 p{real(v.x), real(v.y), real(v.z), real(1)};
    mapped result{multiply(matrix, p), {}};
    const real4 size = magnitudes(matrix, p);
    for (std::size_t k = 0; k < 4; ++k) {
        const auto row = static_cast<glm::length_t>(k);
        const double slope = std::abs(double(matrix[0][row])) + std::abs(double(matrix[1][row])) +
                             std::abs(double(matrix[2][row]));
        result.bound[k] = 8.0 * roundoff<T>() * as_double(size[k]) + 0x1p-46 * slope * extent;
    }
    return result;
}

/// Bodies that a vertex at the apex of a cone has no place in: the map has none for the light.
bool at_light(const focus_result& r, const glm::dvec4& v) {
    return r.view.perspective && in_light_axes(r.view, d3(v)).z <= 0x1p-42 * r.volume.extent;
}

/// Positions of the body's vertices in the light's plane, and the area of their exact hull.
double hull_area(const focus_result& r) {
    std::vector<glm::dvec2> points;
    for (std::size_t i = 0; i < r.receivers.count; ++i) {
        const d3 q = in_light_axes(r.view, d3(r.receivers.vertices[i]));
        if (!at_light(r, r.receivers.vertices[i])) {
            points.push_back(r.view.perspective ? glm::dvec2(q.x / q.z, q.y / q.z)
                                                : glm::dvec2(q.x, q.y));
        }
    }
    const exact::grid_points grid = exact::on_grid(std::span<const glm::dvec2>(points));
    const std::vector<std::size_t> corners = exact::hull(grid.points);
    exact::integer twice = 0;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        twice += exact::cross(grid.points[corners[0]], grid.points[corners[i - 1]],
                              grid.points[corners[i]]);
    }
    return as_double(real(twice) / 2 * ldexp(real(1), 2 * grid.exponent));
}

/// Area of the rectangle around the footprint at an angle.
double area_at(const focus_result& r, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    double u0 = infinity<double>, u1 = -u0, v0 = u0, v1 = u1;
    for (std::size_t i = 0; i < r.footprint_count; ++i) {
        const auto p = r.footprint[i];
        u0 = std::min(u0, c * p.x + s * p.y);
        u1 = std::max(u1, c * p.x + s * p.y);
        v0 = std::min(v0, c * p.y - s * p.x);
        v1 = std::max(v1, c * p.y - s * p.x);
    }
    return (u1 - u0) * (v1 - v0);
}

constexpr status no_map = status::empty_body | status::unbounded | status::light_inside_body |
                          status::invalid_input | status::out_of_range;

} // namespace

TEMPLATE_TEST_CASE("every receiver is in the map and every caster between near and far", "[fit]",
                   float, double) {
    int tested = 0;
    REQUIRE(rc::check("in the map", [&] {
        const auto scene = any_scene<TestType>();
        const focus_result r = focus(scene);
        const auto options = any_options(scene);
        const auto fit = minimal_shadow_frustum(r, options);
        RC_ASSERT(finite(fit.matrix));
        RC_PRE(!any(fit.flags, no_map));
        ++tested;
        const double d0 =
            std::min(near_depth<double>(options.clip), far_depth<double>(options.clip));
        const double d1 =
            std::max(near_depth<double>(options.clip), far_depth<double>(options.clip));
        const double border[2] = {1.0 - 2.0 * double(options.margin) / options.map_size.x,
                                  1.0 - 2.0 * double(options.margin) / options.map_size.y};
        for (std::size_t i = 0; i < r.receivers.count; ++i) {
            if (at_light(r, r.receivers.vertices[i])) {
                continue;
            }
            const mapped m = map_vertex(fit.matrix, r.receivers.vertices[i], r.volume.extent);
            RC_ASSERT(m.clip[3] > 0);
            for (std::size_t k = 0; k < 2; ++k) {
                RC_ASSERT(as_double(abs(m.clip[k]) - border[k] * m.clip[3]) <=
                          m.bound[k] + m.bound[3]);
            }
            // nearer than the first caster is nearer than the near plane, but nothing is beyond far
            const real far = far_depth<double>(options.clip);
            const real side =
                far_depth<double>(options.clip) > near_depth<double>(options.clip) ? 1 : -1;
            RC_ASSERT(as_double(side * (m.clip[2] - far * m.clip[3])) <= m.bound[2] + m.bound[3]);
        }
        for (std::size_t i = 0; i < r.casters.count; ++i) {
            const double z = in_light_axes(r.view, d3(r.casters.vertices[i])).z;
            if (r.view.perspective && z < fit.near_distance) {
                // at the light: cut off, and reported
                RC_ASSERT(any(fit.flags, status::near_clamped) ||
                          z >= fit.near_distance - 0x1p-46 * r.volume.extent);
                continue;
            }
            const mapped m = map_vertex(fit.matrix, r.casters.vertices[i], size_of(scene, r));
            RC_ASSERT(as_double(m.clip[2] - d1 * m.clip[3]) <= m.bound[2] + m.bound[3]);
            RC_ASSERT(as_double(d0 * m.clip[3] - m.clip[2]) <= m.bound[2] + m.bound[3]);
        }
    }));
    REQUIRE(tested > 0);
}

TEMPLATE_TEST_CASE("the rectangle contains the footprint and its waste is that of the polygon",
                   "[fit]", float, double) {
    REQUIRE(rc::check("rectangle", [] {
        const auto scene = any_scene<TestType>();
        const focus_result r = focus(scene);
        const auto options = any_options(scene);
        const auto fit = minimal_shadow_frustum(r, options);
        RC_PRE(!any(fit.flags, no_map | status::degenerate_extent));
        fit_state state;
        minimal_shadow_frustum(r, options, state);
        const double c = std::cos(state.angle), s = std::sin(state.angle);
        double largest = 0.0;
        double reach = fit.half_extents.x + fit.half_extents.y;
        for (std::size_t i = 0; i < r.footprint_count; ++i) {
            const auto p = r.footprint[i];
            const glm::dvec2 q(c * p.x + s * p.y - fit.centre.x, c * p.y - s * p.x - fit.centre.y);
            reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
            largest = std::max(
                {largest, std::abs(q.x) - fit.half_extents.x, std::abs(q.y) - fit.half_extents.y});
        }
        // four roundings of positions and, snapped, of their distance from the world's origin
        const double world = options.snap && !r.view.perspective ? glm::length(r.eye) : 0.0;
        RC_ASSERT(largest <= 0x1p-50 * (reach + world));
        const double area = 4.0 * fit.half_extents.x * fit.half_extents.y;
        // Positions are good to 8u of reach and move four sides of the polygon's bounds; the sum of
        // up to 20 products of differences, three roundings each, adds 60u of diameter squared.
        const double sides = fit.half_extents.x + fit.half_extents.y;
        // Slopes beyond the octagon's corners are put back on its circle, by rounding and no more.
        double beyond = 0.0;
        for (std::size_t i = 0; i < r.receivers.count; ++i) {
            const d3 q = in_light_axes(r.view, d3(r.receivers.vertices[i]));
            if (r.view.perspective && !at_light(r, r.receivers.vertices[i])) {
                const double excess = std::hypot(q.x / q.z, q.y / q.z) - r.view.widest_slope;
                RC_ASSERT(excess <= 0x1p-46 * r.volume.extent / q.z * (1.0 + r.view.widest_slope));
                beyond = std::max(beyond, excess);
            }
        }
        const double bound =
            (0x1p-53 * (32.0 * reach * sides + 240.0 * sides * sides) + 4.0 * beyond * sides) /
            area;
        RC_PRE(bound < 1e-3); // a sliver far from the light's axis
        RC_ASSERT(std::abs(1.0 - hull_area(r) / area - double(fit.wasted_area)) <=
                  bound + roundoff<TestType>());
    }));
}

TEMPLATE_TEST_CASE("rotated: no rectangle of a fine sweep is smaller by more than the hysteresis",
                   "[fit]", float, double) {
    REQUIRE(rc::check("sweep", [] {
        const auto scene = any_scene<TestType>();
        const focus_result r = focus(scene);
        fit_options<TestType> options;
        options.frame = fit_frame::rotated_minimal;
        options.origin = scene.camera.eye;
        const auto fit = minimal_shadow_frustum(r, options);
        RC_PRE(!any(fit.flags, no_map | status::degenerate_extent));
        options.hysteresis = TestType(0);
        const auto tight = minimal_shadow_frustum(r, options);
        const double area = 4.0 * fit.half_extents.x * fit.half_extents.y;
        const double least = 4.0 * tight.half_extents.x * tight.half_extents.y;
        for (double angle = 0.0; angle < 90.0; angle += 0.5) {
            const double swept = area_at(r, angle * degree);
            RC_ASSERT(least <= swept * (1.0 + 1e-12)); // 4 epsilon for ties, roundings of a sliver
            RC_ASSERT(area <= swept * 1.05 * (1.0 + 1e-6)); // 0.05 as a float
        }
        RC_ASSERT(double(fit.excess_area) == Approx(area / least - 1.0).margin(1e-6));
        // the fixed frame is never better than the rotated one by more than nothing
        options.frame = fit_frame::fixed;
        const auto fixed = minimal_shadow_frustum(r, options);
        RC_ASSERT(area <= 4.0 * fixed.half_extents.x * fixed.half_extents.y * (1.0 + 1e-12));
        RC_ASSERT(fixed.angle == TestType(0));
    }));
}

TEMPLATE_TEST_CASE("peers 40: all clip conventions give the same map and the same depth", "[fit]",
                   float, double) {
    REQUIRE(rc::check("conventions", [] {
        const auto scene = any_scene<TestType>();
        const focus_result r = focus(scene);
        fit_options<TestType> options;
        options.origin = scene.camera.eye;
        options.clip = clip::opengl;
        const auto reference = minimal_shadow_frustum(r, options);
        RC_PRE(!any(reference.flags, no_map));
        for (const clip_space clip : some_conventions(4)) {
            options.clip = clip;
            const auto fit = minimal_shadow_frustum(r, options);
            RC_ASSERT(fit.flags == reference.flags);
            for (std::size_t i = 0; i < r.receivers.count; ++i) {
                const auto& v = r.receivers.vertices[i];
                const mapped a = map_vertex(reference.matrix, v, r.volume.extent);
                const mapped b = map_vertex(fit.matrix, v, r.volume.extent);
                RC_ASSERT(as_double(abs(a.clip[0] - b.clip[0])) <= a.bound[0] + b.bound[0]);
                const real y = clip.y_down ? real(-b.clip[1]) : b.clip[1];
                RC_ASSERT(as_double(abs(a.clip[1] - y)) <= a.bound[1] + b.bound[1]);
                RC_ASSERT(as_double(abs(a.clip[3] - b.clip[3])) <= a.bound[3] + b.bound[3]);
                if (clip.infinite_far) {
                    continue;
                }
                const real d0 = near_depth<double>(clip), d1 = far_depth<double>(clip);
                const real from_a = (a.clip[2] + a.clip[3]) / 2;
                const real from_b = (b.clip[2] - d0 * b.clip[3]) / (d1 - d0);
                RC_ASSERT(as_double(abs(from_a - from_b)) <=
                          a.bound[2] + b.bound[2] + a.bound[3] + b.bound[3]);
            }
        }
    }));
}

TEMPLATE_TEST_CASE("J23 scaling by a power of two scales the fit and no other bit", "[fit]", float,
                   double) {
    REQUIRE(rc::check("scale", [] {
        const auto scene = any_scene<TestType>();
        const auto k = static_cast<TestType>(std::ldexp(1.0, *rc::gen::inRange(-16, 17)));
        const auto other = scaled(scene, k);
        auto options = any_options(scene);
        const auto a = minimal_shadow_frustum(focus(scene), options);
        options.origin *= k;
        const auto b = minimal_shadow_frustum(focus(other), options);
        RC_ASSERT(a.flags == b.flags);
        RC_ASSERT(a.angle == b.angle);
        RC_ASSERT(a.wasted_area == b.wasted_area);
        RC_ASSERT(a.excess_area == b.excess_area);
        RC_PRE(!any(a.flags, no_map));
        const bool perspective = scene.source.kind != light_kind::directional;
        for (glm::length_t column = 0; column < 4; ++column) {
            for (glm::length_t row = 0; row < 4; ++row) {
                // a perspective matrix gives lengths: w, and depth times w
                const bool length = perspective && column == 3;
                const TestType factor = perspective ? (length ? k : TestType(1))
                                                    : (column < 3 ? TestType(1) / k : TestType(1));
                RC_ASSERT(a.matrix[column][row] * factor == b.matrix[column][row]);
            }
        }
    }));
}

TEMPLATE_TEST_CASE("J29 a yaw of 3600 frames turns no faster than the slew and wastes little",
                   "[fit]", float, double) {
    const std::array<glm::vec<3, TestType>, 3> suns{
        glm::vec<3, TestType>(TestType(0.5), TestType(-1), TestType(0.25)),
        glm::vec<3, TestType>(TestType(1), TestType(-0.4), TestType(-0.2)),
        glm::vec<3, TestType>(TestType(0.3), TestType(-1), TestType(0.8))};
    for (std::size_t which = 0; which < suns.size(); ++which) {
        focus_input<TestType> scene = plain_scene<TestType>();
        const auto& direction = suns[which];
        const TestType far = which < 2 ? TestType(15) : TestType(50);
        scene.source = sun(direction);
        fit_options<TestType> options;
        options.frame = fit_frame::rotated_minimal;
        fit_state state;
        double ratio = 0.0;
        double largest_step = 0.0;
        double last = 0.0;
        for (int frame = 0; frame < 3600; ++frame) {
            const double yaw = 0.1 * degree * frame;
            scene.camera = camera_at<TestType>(
                d3(0.0, 2.0, 10.0), d3(std::sin(yaw), -0.25, std::cos(yaw)), TestType(0.5), far);
            const auto fit = minimal_shadow_frustum(focus(scene), options, state);
            REQUIRE(fit.flags == status::ok);
            ratio += 1.0 + double(fit.excess_area);
            if (frame > 0) {
                const double step = std::remainder(double(fit.angle) - last, 360.0 * degree);
                largest_step = std::max(largest_step, std::abs(step));
            }
            last = double(fit.angle);
        }
        CAPTURE(direction.x, direction.y, far, ratio / 3600.0, largest_step / degree);
        // the angle is rounded to T, and is at most 180°
        REQUIRE(largest_step <= 0.25 * degree + 8.0 * roundoff<TestType>());
        REQUIRE(ratio / 3600.0 <= 1.03);
    }
}

TEMPLATE_TEST_CASE("J28 equal areas do not turn the map; the first frame takes the smallest angle",
                   "[fit]", float, double) {
    fit_options<TestType> options;
    options.frame = fit_frame::rotated_minimal;
    for (const double sides : {4.0, 8.0}) {
        focus_result r;
        fit_state state;
        const auto shape = [&](double turned, double jitter) {
            r.footprint_count = static_cast<std::size_t>(sides);
            for (std::size_t i = 0; i < r.footprint_count; ++i) {
                const double angle = 360.0 * degree * (double(i) + 0.5) / sides + turned;
                r.footprint[i] = glm::dvec2(std::cos(angle), std::sin(angle)) *
                                 (1.0 + jitter * ((i * 7) % 5 == 0 ? 1.0 : -1.0));
            }
            r.farthest_receiver = 1.0;
            r.view.in_front = true;
        };
        shape(0.3, 0.0);
        auto first = options;
        first.hysteresis = TestType(0);
        const double quarter_or_side = 360.0 * degree / sides;
        const double angle = double(minimal_shadow_frustum(r, first, state).angle);
        // a side lies at 0.3 and every 45° or 90° from there: nearest to 0, up to T's rounding
        REQUIRE(angle ==
                Approx(std::remainder(0.3, quarter_or_side)).margin(4 * roundoff<TestType>()));
        const double kept = state.angle;
        for (int frame = 0; frame < 200; ++frame) {
            shape(0.3, 1e-9 * ((frame * 37) % 11 - 5));
            minimal_shadow_frustum(r, options, state);
            REQUIRE(state.angle == kept);
        }
    }
}

TEMPLATE_TEST_CASE("peers 37: snapped, motion below a texel changes no texel", "[fit]", float,
                   double) {
    // the receivers are seen through an orthographic camera that moves: the footprint moves with it
    using v3 = glm::vec<3, TestType>;
    for (const bool spot : {false, true}) {
        focus_input<TestType> scene = plain_scene<TestType>();
        scene.receivers = {v3(-200, 0, -200), v3(200, 1, 200)};
        scene.casters = {v3(-200, 0, -200), v3(200, 8, 200)};
        if (spot) {
            scene.source = spot_light(v3(0, 60, 10), v3(0, 0, 20), TestType(1.5));
        }
        fit_options<TestType> options;
        options.snap = true;
        options.map_size = {512, 384};
        options.margin = TestType(1);
        fit_state state;
        std::vector<std::array<double, 2>> before;
        int undecided = 0;
        glm::dvec2 texel(0.0);
        for (int frame = 0; frame < 120; ++frame) {
            const double step = 0.02 * frame;
            scene.camera = make_frustum(v3(TestType(step), TestType(2), TestType(0.5 * step)),
                                        v3(0, TestType(-0.25), 1), v3(0, 1, 0),
                                        view_volume<TestType>{-4, 4, -4, 4, 1, 40, true})
                               .value;
            const auto fit = minimal_shadow_frustum(focus(scene), options, state);
            REQUIRE(fit.flags == status::ok);
            if (frame == 0) {
                texel = glm::dvec2(fit.x.texel, fit.y.texel);
            }
            REQUIRE(glm::dvec2(fit.x.texel, fit.y.texel) == texel);
            for (std::size_t i = 0; i < 50; ++i) {
                const v3 p(TestType(0.17 * double(i) - 3.0), TestType(0.01 * double(i)),
                           TestType(12.0 + 0.31 * double(i)));
                const real4 at{real(p.x), real(p.y), real(p.z), real(1)};
                const real4 clip = multiply(fit.matrix, at);
                const real4 size = magnitudes(fit.matrix, at);
                std::array<double, 2> now{};
                bool decided = true;
                for (std::size_t k = 0; k < 2; ++k) {
                    const int texels = options.map_size[static_cast<glm::length_t>(k)];
                    const double place = as_double((clip[k] / clip[3] + 1) / 2 * texels) +
                                         (k == 0 ? fit.x.first : fit.y.first);
                    now[k] = std::floor(place);
                    // entries are rounded to T: u of each term, in the row and in w
                    const double bound = 4.0 * roundoff<TestType>() * texels *
                                         as_double((size[k] + size[3]) / clip[3]);
                    decided = decided && place - now[k] > bound && now[k] + 1.0 - place > bound;
                }
                if (frame == 0) {
                    before.push_back(now);
                } else if (decided) {
                    REQUIRE(now == before[i]);
                } else {
                    ++undecided;
                }
            }
        }
        REQUIRE(undecided < 120 * 50 / 20);
    }
}

TEMPLATE_TEST_CASE("J17 J20 J24: no footprint, no map: the identity and why", "[fit]", float,
                   double) {
    using v3 = glm::vec<3, TestType>;
    fit_options<TestType> options;
    const auto refuses = [&](const focus_input<TestType>& scene, status why) {
        fit_state state;
        state.angle = 0.25;
        const auto fit = minimal_shadow_frustum(focus(scene), options, state);
        return fit.matrix == identity<TestType>() && any(fit.flags, why) && state.angle == 0.25;
    };
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.receivers = {v3(500), v3(501)};
    REQUIRE(refuses(scene, status::empty_body));
    scene = plain_scene<TestType>();
    std::swap(scene.receivers.lo, scene.receivers.hi);
    REQUIRE(refuses(scene, status::invalid_input));
    scene = plain_scene<TestType>();
    scene.source = point_light(v3(0, 1, 10));
    REQUIRE(refuses(scene, status::light_inside_body));
    scene = plain_scene<TestType>();
    scene.camera.volume.far_distance = infinity<TestType>;
    scene.receivers = {v3(-infinity<TestType>), v3(infinity<TestType>)};
    REQUIRE(refuses(scene, status::unbounded));
    options.origin.x = std::numeric_limits<TestType>::quiet_NaN();
    REQUIRE(refuses(plain_scene<TestType>(), status::invalid_input));
}

TEMPLATE_TEST_CASE("J19 J26 flat, thin and point-like bodies get a map of the least extent",
                   "[fit]", float, double) {
    using v3 = glm::vec<3, TestType>;
    for (const bool rotated : {false, true}) {
        for (const bool local : {false, true}) {
            focus_input<TestType> scene = plain_scene<TestType>();
            if (local) {
                scene.source = point_light(v3(TestType(3), TestType(40), TestType(7)));
            }
            fit_options<TestType> options;
            options.frame = rotated ? fit_frame::rotated_minimal : fit_frame::fixed;
            scene.receivers.hi.y = TestType(0); // flat: an ordinary map
            REQUIRE(any(focus(scene).flags, status::degenerate_extent));
            const auto flat = minimal_shadow_frustum(focus(scene), options);
            REQUIRE(flat.half_extents.x > 0.0);
            REQUIRE(flat.wasted_area < TestType(0.6));
            scene.receivers.lo.x = scene.receivers.hi.x = TestType(1);
            const auto edge = minimal_shadow_frustum(focus(scene), options);
            REQUIRE(any(edge.flags, status::degenerate_extent));
            REQUIRE(finite(edge.matrix));
            REQUIRE(edge.matrix != identity<TestType>());
            scene.receivers.lo.z = scene.receivers.hi.z = TestType(10);
            const focus_result r = focus(scene);
            const auto point = minimal_shadow_frustum(r, options);
            REQUIRE(any(point.flags, status::degenerate_extent));
            REQUIRE(finite(point.matrix));
            REQUIRE(point.half_extents.x > 0.0);
            REQUIRE(point.half_extents.y > 0.0);
            REQUIRE(point.wasted_area == TestType(1));
        }
    }
    // a wall in the light: both ends of a line, and a depth range
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.source = sun(v3(0, -1, 0));
    scene.receivers.lo.x = scene.receivers.hi.x = TestType(1);
    const auto wall = minimal_shadow_frustum(focus(scene), fit_options<TestType>{});
    REQUIRE(any(wall.flags, status::degenerate_extent));
    REQUIRE(wall.half_extents.x == Approx(wall.half_extents.y * 0x1p-24));
}

TEMPLATE_TEST_CASE("a light that holds casters or is cut by them has its near distance raised",
                   "[fit]", float, double) {
    using v3 = glm::vec<3, TestType>;
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.source = point_light(v3(0, 6, 20)); // in the caster box, above the receivers
    scene.receivers.hi.y = TestType(1);
    fit_options<TestType> options;
    const auto fit = minimal_shadow_frustum(focus(scene), options);
    REQUIRE(any(fit.flags, status::near_clamped));
    REQUIRE(fit.near_distance == fit.far_distance * 0x1p-20);
    options.least_near = TestType(0.25);
    const auto raised = minimal_shadow_frustum(focus(scene), options);
    REQUIRE(any(raised.flags, status::near_clamped));
    REQUIRE(raised.near_distance == 0.25);
    scene.casters.hi.y = TestType(2); // nothing up there
    const auto free = minimal_shadow_frustum(focus(scene), options);
    REQUIRE_FALSE(any(free.flags, status::near_clamped));
    REQUIRE(free.near_distance > 0.25);
}

TEMPLATE_TEST_CASE("margins and map sizes without a texel left over are reported", "[fit]", float,
                   double) {
    const focus_result r = focus(plain_scene<TestType>());
    fit_options<TestType> options;
    for (const TestType margin : {TestType(600), TestType(-1), infinity<TestType>,
                                  std::numeric_limits<TestType>::quiet_NaN()}) {
        options.margin = margin;
        const auto fit = minimal_shadow_frustum(r, options);
        REQUIRE(any(fit.flags, status::out_of_range));
        REQUIRE(finite(fit.matrix));
        REQUIRE(fit.half_extents.x > 0.0);
    }
    options.margin = TestType(0);
    options.map_size = {0, -5};
    options.snap = true;
    const auto fit = minimal_shadow_frustum(r, options);
    REQUIRE(any(fit.flags, status::out_of_range));
    REQUIRE(finite(fit.matrix));
}

TEMPLATE_TEST_CASE("any numbers at all give a finite matrix and a status", "[fit]", float, double) {
    REQUIRE(rc::check("total", [] {
        const focus_result r = focus(any_nonsense<TestType>());
        fit_options<TestType> options;
        options.frame = coin() ? fit_frame::fixed : fit_frame::rotated_minimal;
        options.clip = any_convention();
        options.map_size = {*rc::gen::inRange(-1, 100), *rc::gen::inRange(-1, 100)};
        options.margin = any_number<TestType>();
        options.snap = coin();
        options.hysteresis = any_number<TestType>();
        options.slew = any_number<TestType>();
        options.least_near = any_number<TestType>();
        options.origin = coin() ? any_numbers<TestType>() : glm::vec<3, TestType>(TestType(0));
        fit_state state;
        for (int frame = 0; frame < 3; ++frame) {
            const auto fit = minimal_shadow_frustum(r, options, state);
            RC_ASSERT(finite(fit.matrix));
            RC_ASSERT(std::isfinite(fit.angle));
            RC_ASSERT(std::isfinite(state.angle));
            RC_ASSERT(fit.wasted_area >= TestType(0));
            RC_ASSERT(fit.wasted_area <= TestType(1));
            RC_ASSERT(std::isfinite(fit.excess_area));
            RC_ASSERT(finite(fit.centre));
            RC_ASSERT(finite(fit.half_extents));
            RC_ASSERT(std::isfinite(fit.near_distance));
            RC_ASSERT(std::isfinite(fit.far_distance));
            const bool refused = fit.matrix == identity<TestType>();
            RC_ASSERT(!refused || any(fit.flags, no_map));
        }
    }));
}
