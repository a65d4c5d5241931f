// Properties of warpshadow/polytope.hpp, against vertices found by solving every three planes.
//
// Tolerance: a vertex is rounded to T once per coordinate when it is made (half an epsilon of its
// size), the corners and planes it comes from are rounded too (2 and 1 epsilon): 8 epsilon(T)
// times the size of the point covers the sum. Box planes are met exactly.
#include <warpshadow/frustum.hpp>
#include <warpshadow/polytope.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

using namespace warpshadow;

namespace {

using dvec3 = glm::dvec3;
using dvec4 = glm::dvec4;

/// Numbers from a seed: the scenes below need no shrinking, only a seed to repeat them.
struct random_numbers {
    std::mt19937_64 bits;
    double operator()(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(bits() >> 11) * 0x1p-53);
    }
    dvec3 direction() {
        dvec3 d;
        do {
            d = {(*this)(-1.0, 1.0), (*this)(-1.0, 1.0), (*this)(-1.0, 1.0)};
        } while (glm::dot(d, d) < 0.01 || glm::dot(d, d) > 1.0);
        return d;
    }
};

random_numbers from_seed() {
    return {std::mt19937_64(*rc::gen::noShrink(rc::gen::arbitrary<std::uint64_t>()))};
}

template <typename T> struct scene {
    std::array<glm::vec<4, T>, 8> corners;
    std::array<glm::vec<4, T>, 6> planes;
    box3<T> box;
};

template <typename T>
scene<T> make_scene(const glm::vec<3, T>& forward, const view_volume<T>& volume,
                    const box3<T>& box) {
    const auto camera =
        make_frustum<T>(glm::vec<3, T>(T(0)), forward, glm::vec<3, T>(T(0), T(1), T(0)), volume);
    return {frustum_corners(camera.value), frustum_planes(camera.value), box};
}

template <typename T> box3<T> box_between(const dvec3& a, const dvec3& b) {
    return {glm::vec<3, T>(glm::min(a, b)), glm::vec<3, T>(glm::max(a, b))};
}

template <typename T> scene<T> any_scene(random_numbers& random, T far_distance) {
    const double fov = random(0.4, 2.0);
    const double near_distance = random(0.05, 1.0);
    const double reach = 12.0;
    const dvec3 a(random(-reach, reach), random(-reach, reach), random(-reach, reach));
    const dvec3 b(random(-reach, reach), random(-reach, reach), random(-reach, reach));
    return make_scene<T>(glm::vec<3, T>(random.direction()),
                         perspective_volume<T>(static_cast<T>(fov),
                                               static_cast<T>(random(0.5, 2.0)),
                                               static_cast<T>(near_distance), far_distance),
                         box_between<T>(a, b));
}

template <typename T> double size_of(const glm::vec<4, T>& p) {
    return std::max({std::abs(double(p.x)), std::abs(double(p.y)), std::abs(double(p.z))});
}

template <typename T> double distance_to(const glm::vec<4, T>& plane, const glm::vec<4, T>& p) {
    return glm::dot(dvec4(plane), dvec4(p));
}

template <typename T> double tolerance(const glm::vec<4, T>& p) {
    return 8.0 * double(std::numeric_limits<T>::epsilon()) * size_of(p);
}

/// The planes of frustum and box; of the box's the bounds are the offsets.
template <typename T> std::array<dvec4, 12> all_planes(const scene<T>& s) {
    std::array<dvec4, 12> planes;
    for (std::size_t i = 0; i < 6; ++i) {
        planes[i] = dvec4(s.planes[i]);
    }
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        dvec4 plane(0.0);
        plane[axis] = 1.0;
        plane.w = -double(s.box.lo[axis]);
        planes[6 + 2 * static_cast<std::size_t>(axis)] = plane;
        plane[axis] = -1.0;
        plane.w = double(s.box.hi[axis]);
        planes[7 + 2 * static_cast<std::size_t>(axis)] = plane;
    }
    return planes;
}

/// Points in which three planes meet and that all other planes leave inside, by more than
/// `margin` times the error that rounding can have there; in double, for planes rounded to T.
std::vector<dvec3> clear_vertices(const std::array<dvec4, 12>& planes, double epsilon,
                                  double margin) {
    std::vector<dvec3> found;
    for (std::size_t i = 0; i < 12; ++i) {
        for (std::size_t j = i + 1; j < 12; ++j) {
            for (std::size_t k = j + 1; k < 12; ++k) {
                const dvec3 a(planes[i]), b(planes[j]), c(planes[k]);
                const double det = glm::dot(a, glm::cross(b, c));
                if (std::abs(det) < 0.01) {
                    continue;
                }
                const dvec3 p = -(planes[i].w * glm::cross(b, c) + planes[j].w * glm::cross(c, a) +
                                  planes[k].w * glm::cross(a, b)) /
                                det;
                const double error = margin * epsilon * (1.0 + glm::length(p)) / std::abs(det);
                bool inside = true;
                for (std::size_t m = 0; m < 12; ++m) {
                    // The two sides of a flat box are one plane.
                    const bool own = m == i || m == j || m == k || planes[m] == -planes[i] ||
                                     planes[m] == -planes[j] || planes[m] == -planes[k];
                    inside = inside && (own || glm::dot(planes[m], dvec4(p, 1.0)) > error);
                }
                if (inside) {
                    found.push_back(p);
                }
            }
        }
    }
    return found;
}

template <typename T>
bool holds_near(const std::vector<dvec3>& points, const dvec3& p, double tol) {
    return std::any_of(points.begin(), points.end(),
                       [&](const dvec3& q) { return glm::length(p - q) <= tol; });
}

template <typename T, std::size_t N> std::vector<dvec3> vertices_of(const convex_body<T, N>& body) {
    std::vector<dvec3> result;
    for (std::size_t i = 0; i < body.count; ++i) {
        result.emplace_back(dvec3(body.vertices[i]));
    }
    return result;
}

template <typename T> std::vector<dvec3> vertices_of(const vertex_set<T>& set) {
    std::vector<dvec3> result;
    for (std::size_t i = 0; i < set.count; ++i) {
        result.emplace_back(dvec3(set.points[i]));
    }
    return result;
}

/// No two vertices closer than `tol`.
bool all_distinct(const std::vector<dvec3>& points, double tol = 0.0) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t j = i + 1; j < points.size(); ++j) {
            if (glm::length(points[i] - points[j]) <= tol) {
                return false;
            }
        }
    }
    return true;
}

template <typename Planes> bool inside_all(const Planes& planes, const dvec3& p) {
    return std::all_of(planes.begin(), planes.end(), [&](const auto& plane) {
        return glm::dot(dvec4(plane), dvec4(p, 1.0)) >= 0.0;
    });
}

/// Share of the box's volume that lies in the frustum, times the volume, and its standard error.
template <typename T>
std::array<double, 2> monte_carlo_volume(const scene<T>& s, random_numbers& random, int samples) {
    int hits = 0;
    for (int i = 0; i < samples; ++i) {
        const dvec3 lo(s.box.lo);
        const dvec3 hi(s.box.hi);
        hits += inside_all(s.planes, {random(lo.x, hi.x), random(lo.y, hi.y), random(lo.z, hi.z)});
    }
    const dvec3 extent = dvec3(s.box.hi) - dvec3(s.box.lo);
    const double all = extent.x * extent.y * extent.z;
    const double share = static_cast<double>(hits) / samples;
    // At least one hit's worth of doubt, where none or all are hits.
    const double deviation = std::sqrt(std::max(share * (1.0 - share), 1.0 / samples) / samples);
    return {all * share, all * deviation};
}

template <typename T> convex_body<T, 32> body_of_32(const box3<T>& box) {
    return body_from_corners<T, 32>(detail::corners_of(box));
}

} // namespace

TEMPLATE_TEST_CASE("an intersection has the vertices that its planes have", "[polytope]", float,
                   double) {
    using T = TestType;
    constexpr double epsilon = double(std::numeric_limits<T>::epsilon());
    REQUIRE(rc::check([] {
        random_numbers random = from_seed();
        const scene<T> s = any_scene<T>(random, static_cast<T>(random(5.0, 50.0)));
        const convex_body<T> body = intersection(s.corners, s.box);
        RC_ASSERT(body.count <= body.capacity);
        RC_ASSERT((body.count == 0) == any(body.flags, status::empty_body));

        const std::array<dvec4, 12> planes = all_planes(s);
        for (std::size_t i = 0; i < body.count; ++i) {
            const glm::vec<4, T>& v = body.vertices[i];
            RC_ASSERT(v.w == T(1));
            int met = 0;
            for (const dvec4& plane : planes) {
                const double d = glm::dot(plane, dvec4(v));
                RC_ASSERT(d >= -tolerance(v));
                met += d <= tolerance(v);
            }
            RC_ASSERT(met >= 3); // a corner, not a point inside a face or an edge
            RC_ASSERT(std::popcount(body.planes_at[i]) >= 3);
            for (glm::length_t k = 0; k < 3; ++k) {
                RC_ASSERT(v[k] >= s.box.lo[k]);
                RC_ASSERT(v[k] <= s.box.hi[k]);
            }
        }
        // Nothing is missing: the error of a solved vertex is that of its planes over det.
        const std::vector<dvec3> found = vertices_of(body);
        for (const dvec3& p : clear_vertices(planes, epsilon, 64.0)) {
            const double tol = 64.0 * epsilon * (1.0 + glm::length(p)) / 0.01;
            RC_ASSERT(holds_near<T>(found, p, tol));
        }
    }));
}

TEMPLATE_TEST_CASE("16: the volume is that of a Monte Carlo count", "[polytope]", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        random_numbers random = from_seed();
        const scene<T> s = any_scene<T>(random, static_cast<T>(random(5.0, 50.0)));
        const double v = volume(intersection(s.corners, s.box));
        const auto [expected, deviation] = monte_carlo_volume(s, random, 2000);
        // 6 standard deviations: one false alarm in 5e8 comparisons.
        RC_ASSERT(std::abs(v - expected) <= 6.0 * deviation);
    }));
}

TEMPLATE_TEST_CASE("16: a frustum that pierces the box with no corner inside either", "[polytope]",
                   float, double) {
    using T = TestType;
    // A thin frustum along z through a thin plate.
    const scene<T> s =
        make_scene<T>({T(0.1), T(0.2), T(-1)}, perspective_volume<T>(T(0.1), T(1), T(1), T(100)),
                      box_between<T>({-30, -30, -20}, {30, 30, -10}));
    for (const auto& corner : s.corners) {
        bool inside = true;
        for (glm::length_t k = 0; k < 3; ++k) {
            inside = inside && corner[k] >= s.box.lo[k] && corner[k] <= s.box.hi[k];
        }
        REQUIRE_FALSE(inside);
    }
    const convex_body<T> body = intersection(s.corners, s.box);
    CHECK(body.count == 8);
    CHECK(body.flags == status::ok);
    const vertex_set<T> set = intersection_vertices(s.corners, s.planes, s.box);
    CHECK(set.count == 8);
    random_numbers random{std::mt19937_64(1)};
    scene<T> tight = s; // a box close around what is left, for a count with few misses
    tight.box.lo = glm::vec<3, T>(body.vertices[0]);
    tight.box.hi = tight.box.lo;
    for (const dvec3& p : vertices_of(body)) {
        tight.box.lo = glm::min(tight.box.lo, glm::vec<3, T>(p));
        tight.box.hi = glm::max(tight.box.hi, glm::vec<3, T>(p));
    }
    const auto [expected, deviation] = monte_carlo_volume(tight, random, 100000);
    CHECK(std::abs(volume(body) - expected) <= 6.0 * deviation);
    CHECK(deviation < 0.01 * expected);
}

TEMPLATE_TEST_CASE("vertices alone are the same vertices", "[polytope]", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        random_numbers random = from_seed();
        const T far_distance = random(0.0, 1.0) < 0.5 ? static_cast<T>(random(5.0, 50.0))
                                                      : std::numeric_limits<T>::infinity();
        const scene<T> s = any_scene<T>(random, far_distance);
        const convex_body<T> body = intersection(s.corners, s.box);
        const vertex_set<T> set = intersection_vertices(s.corners, s.planes, s.box);
        RC_ASSERT(set.flags == body.flags);
        RC_ASSERT(set.count == body.count);
        const std::vector<dvec3> a = vertices_of(body);
        const std::vector<dvec3> b = vertices_of(set);
        for (std::size_t i = 0; i < a.size(); ++i) {
            // Both are off by rounding at most; edges that cross a plane at a grazing angle
            // magnify that, hence the factor.
            const double tol =
                1024.0 * double(std::numeric_limits<T>::epsilon()) * (1.0 + glm::length(a[i]));
            RC_ASSERT(holds_near<T>(b, a[i], tol));
            RC_ASSERT(holds_near<T>(a, b[i], tol));
        }
    }));
}

TEMPLATE_TEST_CASE("vertices in lanes are the bits of vertices one by one", "[polytope]", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        random_numbers random = from_seed();
        const scene<T> s = any_scene<T>(random, static_cast<T>(20));
        const auto run = [&]<int N>(std::integral_constant<int, N>) {
            using L = detail::lanes<N>;
            vertex_set<T> set;
            set.count = 0;
            detail::add_edge_points<L>(set, detail::hexahedron_edges(s.corners),
                                       detail::distances_to_box<T>{s.box});
            detail::add_edge_points<L>(set, detail::hexahedron_edges(detail::corners_of(s.box)),
                                       detail::distances_to_planes<T>{s.planes});
            return vertices_of(set);
        };
        const auto one =
            run(std::integral_constant<int, 1>{}); // needs vector types, as GCC and Clang have them
        RC_ASSERT((one == run(std::integral_constant<int, detail::native_lanes>{})));
        RC_ASSERT((one == run(std::integral_constant<int, 2>{})));
        RC_ASSERT((one == run(std::integral_constant<int, 8>{})));
    }));
}

TEMPLATE_TEST_CASE("J17, 20: a frustum beside the box leaves nothing", "[polytope]", float,
                   double) {
    using T = TestType;
    const scene<T> s =
        make_scene<T>({T(0), T(0), T(-1)}, perspective_volume<T>(T(1), T(1), T(0.1), T(100)),
                      box_between<T>({-1, -1, 5}, {1, 1, 6}));
    const convex_body<T> body = intersection(s.corners, s.box);
    CHECK(body.count == 0);
    CHECK(body.flags == status::empty_body);
    CHECK(volume(body) == 0.0);
    const vertex_set<T> set = intersection_vertices(s.corners, s.planes, s.box);
    CHECK(set.count == 0);
    CHECK(set.flags == status::empty_body);
}

TEMPLATE_TEST_CASE("J18, 17: box planes through corners, edges and faces of the frustum",
                   "[polytope]", float, double) {
    using T = TestType;
    // An orthographic frustum is a box too, so that every coincidence can be had exactly.
    const view_volume<T> block{T(-2), T(2), T(-1), T(1), T(1), T(5), true};
    const glm::vec<3, T> ahead(T(0), T(0), T(-1));
    struct {
        dvec3 lo, hi;
        std::size_t count;
        double volume;
        status flags;
    } const cases[] = {
        {{-2, -1, -5}, {2, 1, -1}, 8, 32.0, status::ok},             // the same body
        {{-9, -9, -9}, {9, 9, 9}, 8, 32.0, status::ok},              // around it
        {{-1, -0.5, -4}, {1, 0.5, -2}, 8, 4.0, status::ok},          // in it
        {{-2, -1, -9}, {0, 9, 9}, 8, 16.0, status::ok},              // sharing faces
        {{-9, -9, -9}, {9, 9, -1}, 8, 32.0, status::ok},             // near plane
        {{2, 1, -1}, {9, 9, 9}, 1, 0.0, status::degenerate_extent},  // a corner
        {{2, 1, -9}, {9, 9, 9}, 2, 0.0, status::degenerate_extent},  // an edge
        {{2, -9, -9}, {9, 9, 9}, 4, 0.0, status::degenerate_extent}, // a face
        {{2.5, -9, -9}, {9, 9, 9}, 0, 0.0, status::empty_body},
    };
    for (const auto& c : cases) {
        INFO("box from " << c.lo.x << ' ' << c.lo.y << ' ' << c.lo.z);
        const scene<T> s = make_scene<T>(ahead, block, box_between<T>(c.lo, c.hi));
        const convex_body<T> body = intersection(s.corners, s.box);
        CHECK(body.count == c.count);
        CHECK(all_distinct(vertices_of(body)));
        CHECK(body.flags == c.flags);
        CHECK(volume(body) == Approx(c.volume).margin(1e-12));
        const vertex_set<T> set = intersection_vertices(s.corners, s.planes, s.box);
        CHECK((set.count == 0) == (body.count == 0));
        for (const dvec3& p : vertices_of(set)) {
            CHECK(holds_near<T>(vertices_of(body), p, 0.0));
        }
        for (const dvec3& p : vertices_of(body)) {
            CHECK(holds_near<T>(vertices_of(set), p, 0.0));
        }
    }
}

TEMPLATE_TEST_CASE("J18: planes through a body's own corners make no second copy of them",
                   "[polytope]", float, double) {
    using T = TestType;
    const auto cube = [] {
        return body_from_corners(
            detail::corners_of(box3<T>{glm::vec<3, T>(T(-1)), glm::vec<3, T>(T(1))}));
    };
    convex_body<T> halved = cube(); // through two opposite edges
    clip_body(halved, glm::vec<4, T>(T(1), T(1), T(0), T(0)));
    CHECK(halved.count == 6);
    CHECK(all_distinct(vertices_of(halved)));
    CHECK(volume(halved) == Approx(4.0));
    clip_body(halved, glm::vec<4, T>(T(1), T(-1), T(0), T(0))); // the other diagonal
    CHECK(halved.count == 6);
    CHECK(all_distinct(vertices_of(halved)));
    CHECK(volume(halved) == Approx(2.0));

    convex_body<T> corner = cube(); // through three corners
    clip_body(corner, glm::vec<4, T>(T(1), T(1), T(1), T(1)));
    CHECK(corner.count == 7);
    CHECK(volume(corner) == Approx(8.0 - 4.0 / 3.0));
    clip_body(corner, glm::vec<4, T>(T(1), T(1), T(1), T(1))); // again: nothing happens
    CHECK(corner.count == 7);
    CHECK(corner.planes == 7);

    convex_body<T> touched = cube(); // at one corner only, from outside and from inside
    clip_body(touched, glm::vec<4, T>(T(1), T(1), T(1), T(3)));
    CHECK(touched.count == 8);
    CHECK(touched.planes == 6);
    CHECK(touched.flags == status::ok);
    clip_body(touched, glm::vec<4, T>(T(1), T(1), T(1), T(-3)));
    CHECK(touched.count == 1);
    CHECK(touched.flags == status::degenerate_extent);
}

TEMPLATE_TEST_CASE("J19, 18: a flat box gives a flat body", "[polytope]", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        random_numbers random = from_seed();
        const scene<T> s = any_scene<T>(random, static_cast<T>(20));
        const auto axis = static_cast<glm::length_t>(*rc::gen::inRange(0, 3));
        box3<T> flat = s.box;
        flat.lo[axis] = flat.hi[axis] = static_cast<T>(random(-5.0, 5.0));
        const convex_body<T> body = intersection(s.corners, flat);
        RC_ASSERT(any(body.flags, status::empty_body) == (body.count == 0));
        RC_ASSERT(any(body.flags, status::degenerate_extent) == (body.count != 0));
        RC_ASSERT(body.count <= 8u); // a quadrilateral section clipped by four lines
        RC_ASSERT(all_distinct(vertices_of(body)));
        for (std::size_t i = 0; i < body.count; ++i) {
            RC_ASSERT(body.vertices[i][axis] == flat.lo[axis]);
        }
        constexpr double epsilon = double(std::numeric_limits<T>::epsilon());
        const std::vector<dvec3> found = vertices_of(body);
        for (const dvec3& p :
             clear_vertices(all_planes(scene<T>{s.corners, s.planes, flat}), epsilon, 64.0)) {
            RC_ASSERT(holds_near<T>(found, p, 64.0 * epsilon * (1.0 + glm::length(p)) / 0.01));
        }
    }));
}

TEMPLATE_TEST_CASE("J20, 21: inverted boxes and NaN are invalid and leave nothing", "[polytope]",
                   float, double) {
    using T = TestType;
    const scene<T> s =
        make_scene<T>({T(0), T(0), T(-1)}, perspective_volume<T>(T(1), T(1), T(0.1), T(100)),
                      box_between<T>({-1, -1, -6}, {1, 1, -5}));
    constexpr T nan = std::numeric_limits<T>::quiet_NaN();
    for (glm::length_t k = 0; k < 3; ++k) {
        box3<T> inverted = s.box;
        std::swap(inverted.lo[k], inverted.hi[k]);
        box3<T> not_a_number = s.box;
        not_a_number.hi[k] = nan;
        for (const box3<T>& box : {inverted, not_a_number}) {
            const convex_body<T> body = intersection(s.corners, box);
            CHECK(body.count == 0);
            CHECK(body.flags == (status::empty_body | status::invalid_input));
            const vertex_set<T> set = intersection_vertices(s.corners, s.planes, box);
            CHECK(set.count == 0);
            CHECK(set.flags == body.flags);
        }
    }
    auto corners = s.corners;
    corners[3].y = nan;
    CHECK(intersection(corners, s.box).flags == (status::empty_body | status::invalid_input));
    auto planes = s.planes;
    planes[2].z = nan; // what the corners say holds
    const vertex_set<T> set = intersection_vertices(s.corners, planes, s.box);
    CHECK(set.count == intersection(s.corners, s.box).count);
    CHECK(set.flags == status::invalid_input);

    convex_body<T> body = intersection(s.corners, s.box);
    const double before = volume(body);
    clip_body(body, glm::vec<4, T>(nan, T(0), T(0), T(0)));
    CHECK(body.flags == status::invalid_input);
    CHECK(volume(body) == before);
    clip_body(body, glm::vec<4, T>(T(0), T(0), T(0), T(1))); // everything is inside
    CHECK(volume(body) == before);
    clip_body(body, glm::vec<4, T>(T(0), T(0), T(0), T(-1)));
    CHECK(body.count == 0);
}

TEMPLATE_TEST_CASE("J21, 3: an infinite frustum gives what a long one gives", "[polytope]", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        random_numbers random = from_seed();
        std::mt19937_64 again = random.bits;
        const scene<T> endless = any_scene<T>(random, std::numeric_limits<T>::infinity());
        random.bits = again;
        const scene<T> lengthy = any_scene<T>(random, T(10000));
        const convex_body<T> a = intersection(endless.corners, endless.box);
        const convex_body<T> b = intersection(lengthy.corners, lengthy.box);
        RC_ASSERT(a.flags == b.flags);
        RC_ASSERT(a.count == b.count);
        // The long frustum's edges run from about 1 to 1e4: its far corner's rounding, 2 epsilon,
        // is an angle, so that both agree relative to the point; grazing planes magnify as above.
        for (const dvec3& p : vertices_of(a)) {
            const double tol =
                4096.0 * double(std::numeric_limits<T>::epsilon()) * (1.0 + glm::length(p));
            RC_ASSERT(holds_near<T>(vertices_of(b), p, tol));
        }
    }));
}

TEMPLATE_TEST_CASE("an infinite frustum in an infinite box has no end", "[polytope]", float,
                   double) {
    using T = TestType;
    constexpr T inf = std::numeric_limits<T>::infinity();
    scene<T> s =
        make_scene<T>({T(1), T(0.5), T(-2)}, perspective_volume<T>(T(1), T(1), T(0.1), inf),
                      box3<T>{glm::vec<3, T>(-inf), glm::vec<3, T>(inf)});
    const convex_body<T> body = intersection(s.corners, s.box);
    CHECK(body.count == 8);
    CHECK(body.flags == status::unbounded);
    CHECK(volume(body) == std::numeric_limits<double>::max());
    const vertex_set<T> set = intersection_vertices(s.corners, s.planes, s.box);
    CHECK(set.count == 4);
    CHECK(set.flags == status::unbounded);

    s.box.lo.z = T(-100); // one bound is enough: the frustum looks down -z
    const convex_body<T> bounded = intersection(s.corners, s.box);
    CHECK(bounded.count == 8);
    CHECK(bounded.flags == status::ok);
    CHECK(intersection_vertices(s.corners, s.planes, s.box).count == 8);
}

TEMPLATE_TEST_CASE("J22: an edge gives the same bits in both directions", "[polytope]", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        random_numbers random = from_seed();
        const auto end = [&] {
            const T w = random(0.0, 1.0) < 0.2 ? T(0) : T(1);
            return glm::vec<4, T>(glm::vec<3, T>(std::exp(random(-5.0, 5.0)) * random.direction()),
                                  w);
        };
        const glm::vec<4, T> a = end();
        const glm::vec<4, T> b = end();
        const double da = std::exp(random(-20.0, 20.0));
        const double db = -std::exp(random(-20.0, 20.0));
        const glm::vec<4, T> p = edge_plane_point(a, da, b, db);
        const glm::vec<4, T> q = edge_plane_point(b, db, a, da);
        RC_ASSERT(p == q);
        RC_ASSERT(p == edge_plane_point(a, -da, b, -db)); // seen from the plane's other side
        if (a.w == T(1) && b.w == T(1)) {
            for (glm::length_t k = 0; k < 3; ++k) {
                RC_ASSERT(p[k] >= std::min(a[k], b[k]));
                RC_ASSERT(p[k] <= std::max(a[k], b[k]));
                using wide = long double; // 11 bits more than double, for a bound of 4 ulp
                const wide exact =
                    (wide(-db) * wide(a[k]) + wide(da) * wide(b[k])) / (wide(da) - wide(db));
                const wide size = wide(std::max(std::abs(a[k]), std::abs(b[k])));
                RC_ASSERT(std::abs(wide(p[k]) - exact) <=
                          4.0L * wide(std::numeric_limits<T>::epsilon()) * size);
            }
        }
    }));
}

TEMPLATE_TEST_CASE("J23, 5: scaling by a power of two scales the bits", "[polytope]", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        random_numbers random = from_seed();
        const scene<T> s = any_scene<T>(random, static_cast<T>(20));
        const T scale = std::ldexp(T(1), *rc::gen::inRange(-20, 21));
        scene<T> scaled = s;
        for (auto& corner : scaled.corners) {
            corner = glm::vec<4, T>(scale * glm::vec<3, T>(corner), corner.w);
        }
        for (auto& plane : scaled.planes) {
            plane.w *= scale;
        }
        scaled.box.lo *= scale;
        scaled.box.hi *= scale;
        const convex_body<T> a = intersection(s.corners, s.box);
        const convex_body<T> b = intersection(scaled.corners, scaled.box);
        RC_ASSERT(a.count == b.count);
        RC_ASSERT(a.flags == b.flags);
        for (std::size_t i = 0; i < a.count; ++i) {
            RC_ASSERT((glm::vec<3, T>(b.vertices[i]) == scale * glm::vec<3, T>(a.vertices[i])));
            RC_ASSERT(a.planes_at[i] == b.planes_at[i]);
        }
        const vertex_set<T> va = intersection_vertices(s.corners, s.planes, s.box);
        const vertex_set<T> vb = intersection_vertices(scaled.corners, scaled.planes, scaled.box);
        RC_ASSERT(va.count == vb.count);
        for (std::size_t i = 0; i < va.count; ++i) {
            RC_ASSERT(vb.points[i] == scale * va.points[i]);
        }
    }));
}

TEMPLATE_TEST_CASE("many planes: the count stays below Euler's bound, the volume is right",
                   "[polytope]", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        random_numbers random = from_seed();
        const box3<T> box{glm::vec<3, T>(T(-1)), glm::vec<3, T>(T(1))};
        auto body = body_of_32(box);
        std::vector<glm::vec<4, T>> planes;
        for (int i = 0; i < 26; ++i) {
            // Planes around a ball inside the cube: nearly all of them become faces.
            const dvec3 n = glm::normalize(random.direction());
            planes.push_back(glm::vec<4, T>(dvec4(n, random(0.7, 0.9))));
            clip_body(body, planes.back());
            RC_ASSERT(body.count <= 2u * body.planes - 4u);
        }
        RC_ASSERT(!any(body.flags, status::capacity_reached));
        int hits = 0;
        const int samples = 2000;
        for (int i = 0; i < samples; ++i) {
            const dvec3 p(random(-1.0, 1.0), random(-1.0, 1.0), random(-1.0, 1.0));
            hits += inside_all(planes, p);
        }
        const double share = static_cast<double>(hits) / samples;
        const double deviation = std::sqrt(share * (1.0 - share) / samples);
        RC_ASSERT(std::abs(volume(body) - 8.0 * share) <= 8.0 * 6.0 * deviation);
        // Euler: V - E + F = 2, with each edge found as two planes shared by two vertices.
        std::size_t edges = 0;
        std::uint64_t faces = 0;
        for (std::size_t i = 0; i < body.count; ++i) {
            faces |= body.planes_at[i];
            for (std::size_t j = i + 1; j < body.count; ++j) {
                edges += std::popcount(body.planes_at[i] & body.planes_at[j]) >= 2 ? 1u : 0u;
            }
        }
        RC_ASSERT(body.count + static_cast<std::size_t>(std::popcount(faces)) == edges + 2u);
    }));
}

TEMPLATE_TEST_CASE("a body that is full keeps what it has and says so", "[polytope]", float,
                   double) {
    using T = TestType;
    const box3<T> box{glm::vec<3, T>(T(-1)), glm::vec<3, T>(T(1))};
    auto body = body_from_corners<T, 6>(detail::corners_of(box));
    clip_body(body, glm::vec<4, T>(T(1), T(1), T(1), T(0)));
    CHECK(body.flags == status::capacity_reached);
    CHECK(body.count == 8);
    CHECK(volume(body) == Approx(8.0));
}
