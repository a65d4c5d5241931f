// Properties of warpshadow/focus.hpp.
//
// The oracle is brute force: points drawn in view and box, segments from them to the light, slab
// tests of boxes; it knows no bodies, hulls or planes of volumes. Decisions closer to a border than
// 2^-36 of the coordinates are not asked for: the planes' own bound is 2^-46 of the coordinates.
#include "focus_scenes.hpp"

#include <warpshadow/focus.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace warpshadow;
using namespace camera_test;
using namespace focus_test;

namespace {

constexpr double undecided = 0x1p-36;

/// How far a point is inside view, receiver box and cone: a signed length, from the definitions.
template <typename T> double depth_inside(const focus_input<T>& scene, const d3& p) {
    const auto& camera = scene.camera;
    const auto& v = camera.volume;
    const d3 q = p - d3(camera.eye);
    const double x = glm::dot(d3(camera.right), q);
    const double y = glm::dot(d3(camera.up), q);
    const double z = glm::dot(d3(camera.forward), q);
    const double w = v.orthographic ? 1.0 : z;
    const double xs =
        1.0 + (v.orthographic ? 0.0 : double(std::max(std::abs(v.left), std::abs(v.right))));
    const double ys =
        1.0 + (v.orthographic ? 0.0 : double(std::max(std::abs(v.bottom), std::abs(v.top))));
    double depth = std::min(z - double(v.near_distance), double(v.far_distance) - z);
    const double x0 = double(std::min(v.left, v.right)), x1 = double(std::max(v.left, v.right));
    const double y0 = double(std::min(v.bottom, v.top)), y1 = double(std::max(v.bottom, v.top));
    depth = std::min(depth, std::min(x - x0 * w, x1 * w - x) / xs);
    depth = std::min(depth, std::min(y - y0 * w, y1 * w - y) / ys);
    for (glm::length_t k = 0; k < 3; ++k) {
        if (scene.receivers.lo[k] != scene.receivers.hi[k]) {
            depth = std::min(depth, p[k] - double(scene.receivers.lo[k]));
            depth = std::min(depth, double(scene.receivers.hi[k]) - p[k]);
        } else if (p[k] != double(scene.receivers.lo[k])) {
            return -1.0;
        }
    }
    if (scene.source.kind == light_kind::spot) {
        const d3 r = p - d3(scene.source.position);
        const d3 axis = glm::normalize(d3(scene.source.direction));
        const double along = glm::dot(axis, r);
        const double across = glm::length(r - along * axis);
        const double half = 0.5 * double(scene.source.cone_angle);
        depth = std::min(depth, std::sin(half) * along - std::cos(half) * across);
    }
    return depth;
}

/// A point of the receivers' body: a random mean of its vertices, world space.
d3 point_of(const receiver_body& body, const d3& eye, std::mt19937& random) {
    std::exponential_distribution<double> weight(1.0);
    d3 sum(0.0);
    double total = 0.0;
    for (std::size_t i = 0; i < body.count; ++i) {
        const double w = weight(random);
        sum += w * d3(body.vertices[i]);
        total += w;
    }
    return eye + sum / total;
}

/// Whether the segment a + t (b - a), t in [0, 1], or the ray if `endless`, meets a box.
template <typename T>
bool meets(const d3& a, const d3& step, bool endless, const box3<T>& box, double& first) {
    double t0 = 0.0;
    double t1 = endless ? std::numeric_limits<double>::max() : 1.0;
    for (glm::length_t k = 0; k < 3; ++k) {
        const double lo = double(box.lo[k]) - a[k];
        const double hi = double(box.hi[k]) - a[k];
        if (step[k] == 0.0) {
            if (lo > 0.0 || hi < 0.0) {
                return false;
            }
            continue;
        }
        t0 = std::max(t0, std::min(lo / step[k], hi / step[k]));
        t1 = std::min(t1, std::max(lo / step[k], hi / step[k]));
    }
    first = t0;
    return t0 <= t1;
}

template <typename T> d3 towards_light(const light<T>& source, const d3& p) {
    return source.kind == light_kind::directional ? -d3(source.direction) : d3(source.position) - p;
}

template <typename T> bool all_vertices_finite(const T& body) {
    for (std::size_t i = 0; i < body.count; ++i) {
        if (!finite(body.vertices[i])) {
            return false;
        }
    }
    return true;
}

bool same_body(const receiver_body& a, const receiver_body& b, double scale) {
    bool same = a.count == b.count && a.flags == b.flags;
    for (std::size_t i = 0; same && i < a.count; ++i) {
        same = d3(a.vertices[i]) * scale == d3(b.vertices[i]);
    }
    return same;
}

template <typename T> bool covers_random_points(const focus_input<T>& scene, unsigned seed) {
    const focus_result r = focus(scene);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const double bound = undecided * (size_of(scene, r) + glm::length(r.eye));
    bool good = true;
    for (int i = 0; i < 60; ++i) {
        d3 p;
        for (glm::length_t k = 0; k < 3; ++k) {
            p[k] = glm::mix(double(scene.receivers.lo[k]), double(scene.receivers.hi[k]),
                            unit(random));
        }
        if (!(depth_inside(scene, p) > bound)) {
            if (r.receivers.count == 0) {
                continue;
            }
            p = point_of(r.receivers, r.eye, random);
            if (!(depth_inside(scene, p) > bound)) {
                continue;
            }
        }
        good = good && !r.volume.nothing;
        const d3 step = towards_light(scene.source, p);
        const bool endless = scene.source.kind == light_kind::directional;
        // a box drawn in the caster box, and one around a point of the segment
        for (int n = 0; n < 2; ++n) {
            box3<T> caster;
            const double t =
                endless ? unit(random) * size_of(scene, r) / glm::length(step) : unit(random);
            for (glm::length_t k = 0; k < 3; ++k) {
                const double lo = double(scene.casters.lo[k]), hi = double(scene.casters.hi[k]);
                const double at = n == 0 ? glm::mix(lo, hi, unit(random)) : p[k] + t * step[k];
                const double half = (hi - lo) * 0.2 * unit(random) + bound;
                caster.lo[k] = static_cast<T>(at - half);
                caster.hi[k] = static_cast<T>(at + half);
            }
            double first = 0.0;
            if (meets(p, step, endless, caster, first)) {
                good = good && may_cast(r.volume, caster).may_cast;
                double enters = 0.0;
                if (meets(p, step, endless, scene.casters, enters) &&
                    any(r.flags, status::unbounded | status::light_inside_body) == false) {
                    // the last point of the caster box on the way to the light
                    const d3 back = -step;
                    d3 far_end = p + step;
                    if (endless) {
                        far_end = p + step * (8.0 * size_of(scene, r) / glm::length(step));
                    }
                    double t0 = 0.0;
                    const d3 whole = endless ? p - far_end : back;
                    if (meets(far_end, whole, false, scene.casters, t0)) {
                        const d3 q = far_end + t0 * whole;
                        const double z = in_light_axes(r.view, q - r.eye).z;
                        good = good && r.nearest_caster <= z + bound;
                        good = good && r.casters.count > 0;
                    }
                }
            }
        }
    }
    return good;
}

} // namespace

TEMPLATE_TEST_CASE("vertices of the receivers' body are in view, box and cone", "[focus]", float,
                   double) {
    REQUIRE(rc::check("vertices", [] {
        const focus_input<TestType> scene = any_scene<TestType>();
        const focus_result r = focus(scene);
        RC_CLASSIFY(r.receivers.count == 0, "empty");
        RC_ASSERT(!any(r.flags, status::invalid_input | status::capacity_reached));
        // Vertices are exact to 8u·√3 of the size of what they lie on, and so is their box's
        // distance from the eye; evaluating the definitions in world coordinates adds as much of
        // the eye's distance. The axes are T's: a float frame is orthonormal to 4u of float, which
        // the definitions do not see, but `frustum_planes` and corners are made from the same
        // axes: their disagreement is 4u(T) of the size.
        const double axes = 8.0 * roundoff<TestType>();
        double largest = r.volume.extent + glm::length(r.eye);
        for (const auto& c : r.corners) {
            largest = std::max(largest, c.w == 0.0 ? 0.0 : glm::length(d3(c)));
        }
        const double bound = 0x1p-46 * largest + axes * r.volume.extent * 4.0;
        // the eight planes touch the cone: a corner of the octagon is farther out by 1/cos 22.5°
        focus_input<TestType> wide = scene;
        if (scene.source.kind == light_kind::spot) {
            const double slope =
                std::tan(0.5 * double(scene.source.cone_angle)) / std::cos(M_PI / 8);
            wide.source.cone_angle =
                TestType(2.0 * std::atan(slope) * (1.0 + 4.0 * roundoff<TestType>()));
        }
        for (std::size_t i = 0; i < r.receivers.count; ++i) {
            if (r.receivers.vertices[i].w == 0.0) {
                RC_ASSERT(any(r.flags, status::unbounded));
                continue;
            }
            d3 p = r.eye + d3(r.receivers.vertices[i]);
            for (glm::length_t k = 0; k < 3; ++k) {
                if (scene.receivers.lo[k] == scene.receivers.hi[k]) {
                    RC_ASSERT(std::abs(p[k] - double(scene.receivers.lo[k])) <= bound);
                    p[k] = double(scene.receivers.lo[k]);
                }
            }
            RC_ASSERT(depth_inside(wide, p) >= -bound);
        }
    }));
}

TEMPLATE_TEST_CASE("no box that shadows a receiver in view is rejected", "[focus]", float, double) {
    REQUIRE(rc::check("rays", [] {
        const auto scene = any_scene<TestType>();
        RC_ASSERT(covers_random_points(scene, *rc::gen::arbitrary<unsigned>()));
    }));
}

TEMPLATE_TEST_CASE("a box that only touches the border of the volume is kept", "[focus]", float,
                   double) {
    REQUIRE(rc::check("touching", [] {
        const auto scene = any_scene<TestType>();
        const focus_result r = focus(scene);
        for (std::size_t i = 0; i < r.receivers.count; ++i) {
            if (r.receivers.vertices[i].w == 0.0) {
                continue;
            }
            // on the way from a vertex to the light
            const d3 p = r.eye + d3(r.receivers.vertices[i]);
            d3 step = towards_light(scene.source, p);
            if (scene.source.kind == light_kind::directional) {
                step *= r.volume.extent / glm::length(step);
            }
            for (const double t : {0.0, 0.25, 1.0}) {
                const d3 q = p + t * step;
                // what rounding the box to T moves it by
                const double half = 4.0 * roundoff<TestType>() * (glm::length(q) + glm::length(p));
                RC_ASSERT(may_cast(r.volume, box_at<TestType>(q, d3(half))).may_cast);
            }
        }
    }));
}

TEMPLATE_TEST_CASE("what is rejected shadows nothing and what shadows nothing is rejected",
                   "[focus]", float, double) {
    // A point casts into view exactly if the ray from the light through it goes on to meet the
    // receivers' body. Both ways: the volume is the hull, not just around it.
    int kept = 0;
    int rejected = 0;
    REQUIRE(rc::check("points", [&] {
        auto scene = any_scene<TestType>();
        if (scene.source.kind == light_kind::spot) { // the octagon is not the cone
            scene.source = point_light(scene.source.position);
        }
        const focus_result r = focus(scene);
        RC_PRE(!any(r.flags, status::degenerate_extent | status::unbounded | status::empty_body |
                                 status::light_inside_body));
        std::mt19937 random(*rc::gen::arbitrary<unsigned>());
        std::uniform_real_distribution<double> unit(-0.2, 1.2);
        const double bound = 0x1p-20 * size_of(scene, r);
        for (int n = 0; n < 50; ++n) {
            d3 c;
            for (glm::length_t k = 0; k < 3; ++k) {
                c[k] = double(static_cast<TestType>(glm::mix(
                    double(scene.casters.lo[k]), double(scene.casters.hi[k]), unit(random))));
            }
            // deepest point of the ray in the receivers' body: `depth_inside` is concave
            const d3 away = glm::normalize(-towards_light(scene.source, c));
            double a = 0.0;
            double b = 4.0 * size_of(scene, r);
            for (int i = 0; i < 200; ++i) {
                const double u = a + (b - a) / 3.0;
                const double v = b - (b - a) / 3.0;
                (depth_inside(scene, c + u * away) < depth_inside(scene, c + v * away) ? a : b) =
                    depth_inside(scene, c + u * away) < depth_inside(scene, c + v * away) ? u : v;
            }
            const double depth = depth_inside(scene, c + a * away);
            const glm::vec<3, TestType> at(c);
            const bool answer = may_cast(r.volume, box3<TestType>{at, at}).may_cast;
            if (depth > bound) {
                RC_ASSERT(answer);
                ++kept;
            } else if (depth < -bound) {
                RC_ASSERT(!answer);
                ++rejected;
            }
        }
    }));
    REQUIRE(kept > 0);
    REQUIRE(rejected > 0);
}

TEMPLATE_TEST_CASE("J23 scaling a scene by a power of two scales the result and no other bit",
                   "[focus]", float, double) {
    REQUIRE(rc::check("scale", [] {
        const focus_input<TestType> scene = any_scene<TestType>();
        const double k = std::ldexp(1.0, *rc::gen::inRange(-20, 21));
        const focus_input<TestType> other = scaled(scene, TestType(k));
        const focus_result a = focus(scene);
        const focus_result b = focus(other);
        RC_ASSERT(a.flags == b.flags);
        RC_ASSERT(same_body(a.receivers, b.receivers, k));
        RC_ASSERT(a.casters.count == b.casters.count);
        for (std::size_t i = 0; i < a.casters.count; ++i) {
            RC_ASSERT(d3(a.casters.vertices[i]) * k == d3(b.casters.vertices[i]));
        }
        RC_ASSERT(a.footprint_count == b.footprint_count);
        const double across = a.view.perspective ? 1.0 : k;
        for (std::size_t i = 0; i < a.footprint_count; ++i) {
            RC_ASSERT(a.footprint[i] * across == b.footprint[i]);
        }
        RC_ASSERT(a.volume.count == b.volume.count);
        for (std::size_t i = 0; i < a.volume.count; ++i) {
            RC_ASSERT(d3(a.volume.planes[i]) == d3(b.volume.planes[i]));
            RC_ASSERT(a.volume.planes[i].w * k == b.volume.planes[i].w);
            RC_ASSERT(a.volume.number[i] == b.volume.number[i]);
        }
        RC_ASSERT(a.nearest_caster * k == b.nearest_caster);
        RC_ASSERT(a.farthest_receiver * k == b.farthest_receiver);
    }));
}

TEMPLATE_TEST_CASE("any numbers at all give finite bodies and a status", "[focus]", float, double) {
    REQUIRE(rc::check("total", [] {
        const focus_input<TestType> scene = any_nonsense<TestType>();
        const focus_result r = focus(scene);
        RC_ASSERT(all_vertices_finite(r.receivers));
        RC_ASSERT(all_vertices_finite(r.casters));
        for (std::size_t i = 0; i < r.footprint_count; ++i) {
            RC_ASSERT(finite(r.footprint[i]));
        }
        for (std::size_t i = 0; i < r.volume.count; ++i) {
            RC_ASSERT(finite(r.volume.planes[i]));
        }
        RC_ASSERT(std::isfinite(r.nearest_caster));
        RC_ASSERT(std::isfinite(r.farthest_receiver));
        RC_ASSERT(r.footprint_count > 0 ||
                  any(r.flags, status::empty_body | status::unbounded | status::invalid_input |
                                   status::light_inside_body));
        if (any(r.flags, status::invalid_input)) {
            RC_ASSERT(may_cast(r.volume, scene.casters).may_cast);
        }
    }));
}

TEMPLATE_TEST_CASE("J17 a view entirely outside the receivers is empty", "[focus]", float, double) {
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.camera =
        camera_at<TestType>(d3(0.0, 2.0, 60.0), d3(0.0, 0.0, 1.0), TestType(0.5), TestType(100));
    const focus_result r = focus(scene);
    REQUIRE(r.receivers.count == 0);
    REQUIRE(any(r.flags, status::empty_body));
    REQUIRE_FALSE(may_cast(r.volume, scene.casters).may_cast);
}

TEMPLATE_TEST_CASE("J18 a box plane in the near plane or through its corners adds no vertices",
                   "[focus]", float, double) {
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.camera = make_frustum(glm::vec<3, TestType>(TestType(0)),
                                glm::vec<3, TestType>(TestType(0), TestType(0), TestType(1)),
                                glm::vec<3, TestType>(TestType(0), TestType(1), TestType(0)),
                                view_volume<TestType>{-1, 1, -1, 1, 1, 8, false})
                       .value;
    using v3 = glm::vec<3, TestType>;
    scene.receivers = {v3(-100, -100, 1), v3(100, 100, 100)}; // in the near plane
    REQUIRE(focus(scene).receivers.count == 8);
    scene.receivers = {v3(-100, -100, -100), v3(1, 100, 100)}; // through two near corners
    REQUIRE(focus(scene).receivers.count == 8);
    scene.receivers = {v3(-100, -100, -100), v3(100, 100, 1)}; // nothing but the near plane
    const focus_result flat = focus(scene);
    REQUIRE(flat.receivers.count == 4);
    REQUIRE(any(flat.flags, status::degenerate_extent));
    REQUIRE(flat.footprint_count >= 2);
}

TEMPLATE_TEST_CASE("J19 a flat receiver box, an edge and a point are bodies too", "[focus]", float,
                   double) {
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.receivers.hi.y = TestType(0);
    const focus_result flat = focus(scene);
    REQUIRE(any(flat.flags, status::degenerate_extent));
    REQUIRE(flat.footprint_count >= 3);
    REQUIRE(flat.casters.count >= 4);

    scene.receivers.lo.x = scene.receivers.hi.x = TestType(1);
    const focus_result edge = focus(scene);
    REQUIRE(edge.receivers.count == 2);
    REQUIRE(edge.footprint_count == 2);

    scene.receivers.lo.z = scene.receivers.hi.z = TestType(10);
    const focus_result point = focus(scene);
    REQUIRE(point.receivers.count == 1);
    REQUIRE(point.footprint_count == 1);
    // the volume is the segment to the light: on it a small box counts, beside it it does not
    using v3 = glm::vec<3, TestType>;
    const v3 on = v3(1, 0, 10) + TestType(4) * v3(TestType(-0.5), TestType(1), TestType(-0.25));
    const v3 half(TestType(0.01));
    REQUIRE(may_cast(point.volume, box3<TestType>{on - half, on + half}).may_cast);
    const v3 off = on + v3(TestType(0.1), TestType(0), TestType(0));
    const caster_test beside = may_cast(point.volume, box3<TestType>{off - half, off + half});
    REQUIRE_FALSE(beside.may_cast);
    REQUIRE(beside.rejected_by >= first_side_plane);
}

TEMPLATE_TEST_CASE("J20 inverted boxes and NaN are invalid and keep every caster", "[focus]", float,
                   double) {
    for (int which = 0; which < 4; ++which) {
        focus_input<TestType> scene = plain_scene<TestType>();
        if (which == 0) {
            std::swap(scene.receivers.lo, scene.receivers.hi);
        } else if (which == 1) {
            std::swap(scene.casters.lo, scene.casters.hi);
        } else if (which == 2) {
            scene.camera.eye.x = std::numeric_limits<TestType>::quiet_NaN();
        } else {
            scene.source.direction = glm::vec<3, TestType>(TestType(0));
        }
        const focus_result r = focus(scene);
        REQUIRE(any(r.flags, status::invalid_input));
        REQUIRE(r.footprint_count == 0);
        REQUIRE(may_cast(r.volume, plain_scene<TestType>().casters).may_cast);
    }
}

TEMPLATE_TEST_CASE("J21 an infinite view in a box is the same as a far one", "[focus]", float,
                   double) {
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.camera.volume.far_distance = TestType(1e4);
    const focus_result far = focus(scene);
    scene.camera.volume.far_distance = infinity<TestType>;
    const focus_result endless = focus(scene);
    REQUIRE(endless.receivers.count == far.receivers.count);
    REQUIRE(endless.footprint_count == far.footprint_count);
    for (std::size_t i = 0; i < far.footprint_count; ++i) {
        // the vertex on an edge of length 1e4 is within 4 ulp of that length
        const glm::dvec2 d = far.footprint[i] - endless.footprint[i];
        REQUIRE(std::sqrt(glm::dot(d, d)) <= 8.0 * 0x1p-52 * 2e4);
    }
    for (glm::length_t k = 0; k < 3; ++k) {
        scene.receivers.lo[k] = -infinity<TestType>;
        scene.receivers.hi[k] = infinity<TestType>;
    }
    const focus_result unbounded = focus(scene);
    REQUIRE(any(unbounded.flags, status::unbounded));
    REQUIRE(unbounded.footprint_count == 0);
    REQUIRE(may_cast(unbounded.volume, scene.casters).may_cast);
}

TEMPLATE_TEST_CASE("J24 J25 a point light in or on the body asks for an omnidirectional map",
                   "[focus]", float, double) {
    using v3 = glm::vec<3, TestType>;
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.camera.volume.far_distance = infinity<TestType>;
    const std::array<v3, 4> positions{v3(0, 1, 10), v3(0, 0, 10), v3(0, 0, 40), v3(0, 4, 40)};
    // inside, on the box's floor, on an edge, and outside the view's upper plane or in it
    for (std::size_t i = 0; i < 3; ++i) {
        scene.source = point_light(positions[i]);
        const focus_result r = focus(scene);
        REQUIRE(any(r.flags, status::light_inside_body));
        REQUIRE(r.footprint_count == 0);
        // the volume is the body itself: what is in it may cast
        REQUIRE(may_cast(r.volume, box3<TestType>{v3(0, 0, 10), v3(1, 1, 11)}).may_cast);
    }
    // on a vertex of the body
    scene.receivers = {v3(-1, 0, 10), v3(1, 1, 11)};
    scene.source = point_light(v3(1, 1, 11));
    REQUIRE(any(focus(scene).flags, status::light_inside_body));
    if (std::numeric_limits<TestType>::digits == 53) { // or a few ulp of double off it
        const TestType ulp = std::numeric_limits<TestType>::epsilon();
        scene.source = point_light(v3(1 + 2 * ulp, 1 + 2 * ulp, 11 + 16 * ulp));
        REQUIRE(any(focus(scene).flags, status::light_inside_body));
    }
    // one ulp or so off a face is on it, a thousandth is not
    scene.source =
        point_light(v3(0, TestType(1) + std::numeric_limits<TestType>::epsilon(), TestType(10.5)));
    REQUIRE(any(focus(scene).flags, status::light_inside_body));
    scene.source = point_light(v3(0, TestType(1.001), TestType(10.5)));
    REQUIRE(any(focus(scene).flags, status::light_inside_body) == false);
    REQUIRE(covers_random_points(scene, 1u));
}

TEMPLATE_TEST_CASE("J15 a camera behind the light's plane: casters beside and behind the light",
                   "[focus]", float, double) {
    using v3 = glm::vec<3, TestType>;
    focus_input<TestType> scene = plain_scene<TestType>();
    // a spot inside the view whose plane through the light cuts the view in two
    scene.source = spot_light(v3(0, 3, 20), v3(0, 0, 22), TestType(1.5));
    const focus_result r = focus(scene);
    REQUIRE(r.view.in_front);
    REQUIRE(r.footprint_count >= 3);
    REQUIRE_FALSE(any(r.flags, status::light_inside_body));
    REQUIRE_FALSE(may_cast(r.volume, box3<TestType>{v3(-1, 5, 10), v3(1, 6, 12)}).may_cast);
    REQUIRE(may_cast(r.volume, box3<TestType>{v3(-1, 2, 19), v3(1, 6, 21)}).may_cast); // crosses it
    REQUIRE(covers_random_points(scene, 2u));
}

TEMPLATE_TEST_CASE("a vertical light, light on a plane of the view and in line with its edges "
                   "(peers 2, 13)",
                   "[focus]", float, double) {
    using v3 = glm::vec<3, TestType>;
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.source = sun(v3(0, -1, 0));
    REQUIRE(covers_random_points(scene, 3u));
    scene.source = sun(v3(0, 1, 0));
    REQUIRE(covers_random_points(scene, 4u));
    const auto corners = frustum_corners(scene.camera);
    for (std::size_t i = 0; i < 4; ++i) {
        const v3 along(corners[i]);
        const v3 next(corners[(i + 1) % 4]);
        for (const TestType sign : {TestType(1), TestType(-1)}) {
            scene.source = sun(sign * along); // along an edge
            REQUIRE(covers_random_points(scene, 5u));
            scene.source = sun(sign * (along + next)); // in a plane
            REQUIRE(covers_random_points(scene, 6u));
            scene.source = sun(sign * (next - along)); // along a near edge
            REQUIRE(covers_random_points(scene, 7u));
        }
        // on the line of an edge: behind the eye, at the eye, before the near plane
        for (const TestType at : {TestType(-8), TestType(0), TestType(0.5)}) {
            scene.source = point_light(scene.camera.eye + at * along);
            REQUIRE(covers_random_points(scene, 8u));
            scene.source = point_light(scene.camera.eye + at * (along + next));
            REQUIRE(covers_random_points(scene, 9u));
        }
    }
}

TEMPLATE_TEST_CASE("peers 13, 14: a spot's cone of any angle is clipped, and of 180° is none",
                   "[focus]", float, double) {
    using v3 = glm::vec<3, TestType>;
    focus_input<TestType> scene = plain_scene<TestType>();
    std::size_t last = 0;
    for (const TestType angle : {TestType(1e-4), TestType(0.5), TestType(2), TestType(3.1),
                                 TestType(3.1415925), TestType(4)}) {
        scene.source = spot_light(v3(0, 30, 20), v3(0, 0, 20), angle);
        const focus_result r = focus(scene);
        REQUIRE(r.footprint_count >= 3);
        REQUIRE_FALSE(any(r.flags, status::light_inside_body));
        last = r.receivers.planes;
    }
    // the whole of the lit disc is in, what is well outside the octagon is not
    scene.source = spot_light(v3(0, 30, 20), v3(0, 0, 20), TestType(0.4));
    const focus_result disc = focus(scene);
    const double radius = 30.0 * std::tan(0.2);
    for (int i = 0; i < 64; ++i) {
        const double angle = 6.283185307179586 * i / 64.0;
        const auto at = [&](double r) {
            const d3 p(r * std::cos(angle), 0.0, 20.0 + r * std::sin(angle));
            return box_at<TestType>(p, d3(1e-6));
        };
        REQUIRE(may_cast(disc.volume, at(radius * 0.9999)).may_cast);
        REQUIRE_FALSE(may_cast(disc.volume, at(radius * 1.0825)).may_cast); // 1 / cos 22.5°
    }
    // no cone: nothing but the view and the box
    REQUIRE(last <= 12);
    scene.source.cone_angle = TestType(0);
    REQUIRE(any(focus(scene).flags, status::invalid_input));
}

TEMPLATE_TEST_CASE("peers 16, 17: a view that pierces the box with no corner inside, and one "
                   "inside it",
                   "[focus]", float, double) {
    using v3 = glm::vec<3, TestType>;
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.camera = make_frustum(v3(0, 0, -50), v3(0, 0, 1), v3(0, 1, 0),
                                view_volume<TestType>{-1, 1, -1, 1, 1, 100, true})
                       .value;
    scene.receivers = {v3(-10, -10, -1), v3(10, 10, 1)};
    const focus_result pierced = focus(scene);
    REQUIRE(pierced.receivers.count == 8);
    REQUIRE(volume(pierced.receivers) == Approx(8.0).epsilon(1e-14)); // 2 x 2 x 2, a few roundings
    scene.receivers = {v3(-1000), v3(1000)};
    const focus_result inside = focus(scene);
    REQUIRE(inside.receivers.count == 8);
    REQUIRE(volume(inside.receivers) == Approx(2.0 * 2.0 * 99.0).epsilon(1e-14));
}

TEMPLATE_TEST_CASE("peers 20: casters outside the view that shadow it are kept, others are not",
                   "[focus]", float, double) {
    using v3 = glm::vec<3, TestType>;
    focus_input<TestType> scene = plain_scene<TestType>();
    scene.source = sun(v3(0, -1, 0));
    const focus_result r = focus(scene);
    // above the view, over ground that it sees
    REQUIRE(may_cast(r.volume, box3<TestType>{v3(-1, 7, 20), v3(1, 8, 21)}).may_cast);
    // behind the eye: cut off by the near plane or by the side that takes its place
    REQUIRE_FALSE(may_cast(r.volume, box3<TestType>{v3(-1, 7, -10), v3(1, 8, -9)}).may_cast);
    // below the ground: the box's lower plane
    const caster_test below = may_cast(r.volume, box3<TestType>{v3(-1, -2, 20), v3(1, -1, 21)});
    REQUIRE_FALSE(below.may_cast);
    REQUIRE(below.rejected_by == 8);
    // nothing casts: near is the first receiver
    scene.casters = {v3(-20, -8, -20), v3(20, -4, 40)};
    const focus_result none = focus(scene);
    REQUIRE(any(none.casters.flags, status::empty_body));
    REQUIRE(none.footprint_count >= 3);
    REQUIRE(none.nearest_caster < none.farthest_receiver);
    // and with no bound on the casters towards the light
    scene.casters = {v3(-infinity<TestType>), v3(infinity<TestType>)};
    REQUIRE(any(focus(scene).flags, status::unbounded));
    scene.source = point_light(v3(0, 50, 20));
    const focus_result local = focus(scene);
    REQUIRE_FALSE(any(local.flags, status::unbounded));
    REQUIRE(local.nearest_caster == Approx(0.0).margin(1e-9)); // the light itself
    REQUIRE(local.casters.count > 0);
}

TEMPLATE_TEST_CASE("the eye outside the scene and far from the world's origin (peers 6, 10)",
                   "[focus]", float, double) {
    focus_input<TestType> scene = plain_scene<TestType>();
    const focus_result near = focus(scene);
    const glm::vec<3, TestType> shift(TestType(1048576), TestType(-2097152), TestType(524288));
    scene.camera.eye += shift;
    for (box3<TestType>* box : {&scene.casters, &scene.receivers}) {
        box->lo += shift;
        box->hi += shift;
    }
    const focus_result far = focus(scene);
    // all numbers are whole: the shift is exact in float and in double
    REQUIRE(same_body(near.receivers, far.receivers, 1.0));
    REQUIRE(near.nearest_caster == far.nearest_caster);
}
