// Properties of warpshadow/cull.hpp.
//
// Frustum pairs are judged by the exact oracle of exact_volumes.hpp. WARPSHADOW_TEST_PAIRS sets the
// number of pairs per class and type, WARPSHADOW_TEST_SEED the seed; the counts are printed.
#include "exact_volumes.hpp"
#include "frustum_pairs.hpp"

#include <warpshadow/cull.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

using namespace warpshadow;

namespace {

long from_environment(const char* name, long standard) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::atol(text) : standard;
}

template <typename T> const char* type_name() {
    return std::numeric_limits<T>::digits == 24 ? "float" : "double";
}

template <typename T> constexpr T infinity = std::numeric_limits<T>::infinity();
template <typename T> constexpr T nan_value = std::numeric_limits<T>::quiet_NaN();

template <typename T> frustum<T> scaled(frustum<T> f, T factor) {
    f.eye *= factor;
    f.volume.near_distance *= factor;
    f.volume.far_distance *= factor;
    if (f.volume.orthographic) {
        f.volume.left *= factor;
        f.volume.right *= factor;
        f.volume.bottom *= factor;
        f.volume.top *= factor;
    }
    return f;
}

using oracle::real;
using oracle::square_distance;

} // namespace

TEMPLATE_TEST_CASE("peers 35, J48: no pair of frusta that meets or touches is missed, in any class",
                   "[cull]", float, double) {
    const long pairs =
        from_environment("WARPSHADOW_TEST_PAIRS", frustum_pairs::iterations(2000, 20));
    const auto seed = static_cast<std::uint64_t>(from_environment("WARPSHADOW_TEST_SEED", 1));
    // one pair in so many is also given to the slower separating_axis
    const long stride = pairs > 1000 ? 16 : 2;
    for (std::size_t kind = 0; kind < frustum_pairs::kinds.size(); ++kind) {
        frustum_pairs::random random(seed * 1000 + kind);
        long missed = 0;
        long kept_in_vain = 0;
        long meet = 0;
        long exact = 0;
        long axis_wrong = 0;
        long axis_not_found = 0;
        for (long i = 0; i < pairs; ++i) {
            const auto p = frustum_pairs::make_pair<TestType>(kind, random);
            const bool truth = oracle::intersect(p.a, p.b, p.a.eye, exact);
            const cull_volume a = make_cull_volume(p.a);
            const cull_volume b = make_cull_volume(p.b);
            const cull_result answer = intersects(a, b);
            REQUIRE_FALSE(any(answer.flags, status::invalid_input));
            REQUIRE_FALSE(any(answer.flags, status::out_of_range));
            meet += truth ? 1 : 0;
            missed += truth && !answer.intersects ? 1 : 0;
            kept_in_vain += !truth && answer.intersects ? 1 : 0;
            if (frustum_pairs::kinds[kind].touching) {
                REQUIRE(truth);
            }
            if (i % stride == 0) {
                const separation_result s = separating_axis(a, b);
                axis_wrong += truth && s.gap > 0.0 ? 1 : 0;
                const bool finite = std::isfinite(p.a.volume.far_distance) &&
                                    std::isfinite(p.b.volume.far_distance);
                axis_not_found += finite && !answer.intersects && !(s.gap > 0.0) ? 1 : 0;
            }
        }
        std::printf("%-6s %-30s pairs %ld meet %ld exact %ld false negatives %ld false positives "
                    "%ld axes wrong %ld not found %ld\n",
                    type_name<TestType>(), frustum_pairs::kinds[kind].name.data(), pairs, meet,
                    exact, missed, kept_in_vain, axis_wrong, axis_not_found);
        INFO(frustum_pairs::kinds[kind].name);
        CHECK(missed == 0);
        CHECK(axis_wrong == 0);
        if (kind < 2) {
            CHECK(static_cast<double>(kept_in_vain) <= 2e-5 * static_cast<double>(pairs));
            CHECK(static_cast<double>(axis_not_found) <= 2e-5 * static_cast<double>(pairs));
        }
        // the test is worth something only where both answers occur
        CHECK(meet > 0);
        if (!frustum_pairs::kinds[kind].touching) {
            CHECK(meet < pairs);
        }
    }
}

TEMPLATE_TEST_CASE("a power of two as a scale changes no answer", "[cull]", float, double) {
    frustum_pairs::random random(7);
    for (int i = 0; i < 400; ++i) {
        const std::size_t kind = static_cast<std::size_t>(i) % frustum_pairs::kinds.size();
        const auto p = frustum_pairs::make_pair<TestType>(kind, random);
        const bool answer = intersects(p.a, p.b).intersects;
        for (const double factor : {0x1p-20, 0x1p20}) {
            const auto s = static_cast<TestType>(factor);
            REQUIRE(intersects(scaled(p.a, s), scaled(p.b, s)).intersects == answer);
        }
    }
}

TEMPLATE_TEST_CASE("prepared corners and planes are those of frustum.hpp", "[cull]", float,
                   double) {
    frustum_pairs::random random(8);
    for (int i = 0; i < 200; ++i) {
        const auto p = frustum_pairs::make_pair<TestType>(i % 2 == 0 ? 0u : 11u, random);
        const cull_volume volume = make_cull_volume(p.a);
        const auto corners = frustum_corners(p.a);
        const auto planes = frustum_planes(p.a);
        for (std::size_t k = 0; k < 8; ++k) {
            const glm::dvec4 mine(volume.x[k], volume.y[k], volume.z[k], volume.w[k]);
            const glm::dvec4 theirs(corners[k]);
            // 2 ulp of the corner in T
            const double bound =
                4.0 * double(std::numeric_limits<TestType>::epsilon()) * glm::length(theirs);
            REQUIRE(glm::length(mine - theirs) <= bound);
        }
        for (std::size_t k = 0; k < 6; ++k) {
            const glm::dvec3 n(volume.a[k], volume.b[k], volume.c[k]);
            const glm::dvec3 m{glm::vec<3, TestType>(planes[k])};
            if (!(glm::length(n) > 0.0)) {
                REQUIRE(planes[k].w == TestType(1));
                continue;
            }
            // the axes are orthonormal to about 4 eps of T only
            REQUIRE(glm::length(n / glm::length(n) - m) <=
                    64.0 * double(std::numeric_limits<TestType>::epsilon()));
        }
    }
}

TEMPLATE_TEST_CASE("peers 21, J48: what is not a volume is kept and reported", "[cull]", float,
                   double) {
    using T = TestType;
    using vec3 = glm::vec<3, T>;
    const frustum<T> good =
        make_frustum(vec3(T(0)), vec3(T(0), T(0), T(-1)), vec3(T(0), T(1), T(0)),
                     perspective_volume(T(1), T(1), T(1), T(10)))
            .value;
    frustum<T> other = good;
    other.eye = vec3(T(100), T(0), T(0));
    REQUIRE_FALSE(intersects(good, other).intersects);
    REQUIRE(intersects(good, other).flags == status::ok);
    const auto kept = [&](const frustum<T>& bad, status why) {
        const cull_result one = intersects(bad, other);
        const cull_result two = intersects(other, bad);
        return one.intersects && two.intersects && any(one.flags, why) && any(two.flags, why) &&
               intersects(bad, sphere3<T>{vec3(T(0), T(0), T(50)), T(1)}).intersects &&
               intersects(bad, box3<T>{vec3(T(50)), vec3(T(60))}).intersects &&
               separating_axis(make_cull_volume(bad), make_cull_volume(other)).gap == 0.0;
    };
    for (const T bad : {nan_value<T>, infinity<T>, -infinity<T>}) {
        for (int member = 0; member < 9; ++member) {
            frustum<T> f = good;
            T* const members[9] = {&f.eye.x,         &f.right.y,     &f.up.z,
                                   &f.forward.x,     &f.volume.left, &f.volume.right,
                                   &f.volume.bottom, &f.volume.top,  &f.volume.near_distance};
            *members[member] = bad;
            INFO(member << " " << bad);
            REQUIRE(kept(f, status::invalid_input));
        }
    }
    frustum<T> f = good;
    f.volume.far_distance = nan_value<T>;
    REQUIRE(kept(f, status::invalid_input));
    f = good;
    f.right = f.up;
    REQUIRE(kept(f, status::invalid_input));
    f = good;
    f.forward = vec3(T(0));
    REQUIRE(kept(f, status::invalid_input));

    // put in order, not given up
    f = good;
    std::swap(f.volume.near_distance, f.volume.far_distance);
    REQUIRE_FALSE(intersects(f, other).intersects);
    REQUIRE(any(intersects(f, other).flags, status::out_of_range));
    f = good;
    std::swap(f.volume.left, f.volume.right);
    REQUIRE_FALSE(intersects(f, other).intersects);
    REQUIRE(intersects(f, good).intersects);
    f.volume.near_distance = T(-1);
    REQUIRE(any(intersects(f, other).flags, status::near_clamped));

    REQUIRE(intersects(good, sphere3<T>{vec3(nan_value<T>), T(1)}).intersects);
    REQUIRE(intersects(good, sphere3<T>{vec3(T(500)), T(-1)}).intersects);
    REQUIRE(any(intersects(good, sphere3<T>{vec3(T(500)), T(-1)}).flags, status::invalid_input));
    REQUIRE(intersects(good, box3<T>{vec3(T(60)), vec3(T(50))}).intersects);
    REQUIRE(any(intersects(good, box3<T>{vec3(T(60)), vec3(T(50))}).flags, status::invalid_input));
    REQUIRE(intersects(good, cone3<T>{vec3(T(500)), vec3(T(0)), T(1), T(1)}).intersects);
    REQUIRE(intersects(good, cone3<T>{vec3(T(500)), vec3(T(1)), nan_value<T>, T(1)}).intersects);
}

TEST_CASE("magnitudes beyond the range of the bounds are kept and reported", "[cull]") {
    frustum_pairs::random random(3);
    auto p = frustum_pairs::make_pair<double>(0, random);
    for (const double size : {1e300, 1e-300}) {
        const cull_result result = intersects(scaled(p.a, size), scaled(p.b, size));
        REQUIRE(result.intersects);
        REQUIRE(any(result.flags, status::out_of_range));
    }
}

TEMPLATE_TEST_CASE("frustum and box: exact but for rounding", "[cull]", float, double) {
    using T = TestType;
    const long pairs =
        from_environment("WARPSHADOW_TEST_PAIRS", frustum_pairs::iterations(2000, 8));
    frustum_pairs::random random(11);
    long missed = 0;
    long kept_in_vain = 0;
    long meet = 0;
    long exact = 0;
    for (long i = 0; i < pairs; ++i) {
        // every third pair shares a corner
        frustum<T> f = i % 3 == 0 ? frustum_pairs::dyadic_view<T>(random)
                                  : frustum_pairs::any_view<T>(random, 20.0, 0.05, 1.0, 5.0, 30.0);
        glm::vec<3, T> corner = random.in_cube<T>(20.0);
        glm::vec<3, T> size(T(random.uniform(0, 8)), T(random.uniform(0, 8)), T(0.5));
        if (i % 3 == 0) {
            corner =
                frustum_pairs::point_on(f, T(random.integer(0, 1)), T(random.integer(0, 2)) / 2,
                                        T(random.integer(0, 2)) / 2);
            size = glm::vec<3, T>(T(random.integer(0, 4)), T(random.integer(0, 4)), T(2));
            for (glm::length_t k = 0; k < 3; ++k) {
                corner[k] -= random.integer(0, 1) == 0 ? T(0) : size[k];
            }
        }
        const box3<T> box{corner, corner + size};
        const bool truth = oracle::intersect(f, box, f.eye, exact);
        const bool answer = intersects(f, box).intersects;
        meet += truth ? 1 : 0;
        missed += truth && !answer ? 1 : 0;
        kept_in_vain += !truth && answer ? 1 : 0;
    }
    std::printf("%-6s frustum and box: pairs %ld meet %ld exact %ld false negatives %ld false "
                "positives %ld\n",
                type_name<T>(), pairs, meet, exact, missed, kept_in_vain);
    CHECK(missed == 0);
    CHECK(static_cast<double>(kept_in_vain) <= 2e-5 * static_cast<double>(pairs));
    CHECK(meet > pairs / 8);
    CHECK(meet < pairs);
}

TEMPLATE_TEST_CASE("frustum and ball: the distance to the volume decides", "[cull]", float,
                   double) {
    using T = TestType;
    frustum_pairs::random random(12);
    int meet = 0;
    int in_vain = 0;
    const int pairs = frustum_pairs::iterations(300);
    for (int i = 0; i < pairs; ++i) {
        frustum<T> f = i % 3 == 0 ? frustum_pairs::dyadic_view<T>(random)
                                  : frustum_pairs::any_view<T>(random, 20.0, 0.05, 1.0, 5.0, 30.0);
        sphere3<T> ball{random.in_cube<T>(30.0), T(random.uniform(0, 20))};
        if (i % 3 == 0) {
            // |(2, 3, 6)| = 7: touches a point of the frustum exactly
            const T step = T(random.integer(1, 8)) * T(0.125);
            glm::vec<3, T> away(T(2) * step, T(3) * step, T(6) * step);
            for (glm::length_t k = 0; k < 3; ++k) {
                away[k] = random.integer(0, 1) == 0 ? away[k] : -away[k];
            }
            ball.centre =
                away + frustum_pairs::point_on(f, T(random.integer(0, 1)), T(random.integer(0, 1)),
                                               T(random.integer(0, 1)));
            ball.radius = T(7) * step;
        } else if (i % 3 == 1) {
            // just so, in T
            ball.radius = T(boost::multiprecision::sqrt(square_distance(f, ball.centre)));
        }
        const real square = square_distance(f, ball.centre);
        const real radius = ball.radius;
        // exact contacts are computed to 45 digits
        const bool truth = square <= radius * radius * (1 + real("1e-45"));
        const cull_result answer = intersects(f, ball);
        REQUIRE(answer.flags == status::ok);
        REQUIRE((answer.intersects || !truth));
        meet += truth ? 1 : 0;
        if (answer.intersects && !truth) {
            // within the rounding bound: 8 * 16 u of the extent, the frustum being below 100 across
            REQUIRE(sqrt(square) - radius <= real(0x1p-46) * 100);
            ++in_vain;
        }
    }
    CHECK(meet > pairs / 4);
    CHECK(meet < pairs * 7 / 8);
    INFO(in_vain);
    // without an end, a ball far out is met, and one behind is not
    frustum<T> endless = frustum_pairs::any_view<T>(random, 1.0, 0.1, 0.2, 5.0, 6.0);
    endless.volume.far_distance = infinity<T>;
    const glm::vec<3, T> out = endless.eye + T(1e6) * endless.forward;
    REQUIRE(intersects(endless, sphere3<T>{out, T(1)}).intersects);
    const glm::vec<3, T> behind = endless.eye - T(1e6) * endless.forward;
    REQUIRE_FALSE(intersects(endless, sphere3<T>{behind, T(1)}).intersects);
}

TEMPLATE_TEST_CASE("frustum and cone: the smallest angle to the axis decides", "[cull]", float,
                   double) {
    using T = TestType;
    using wide = long double;
    frustum_pairs::random random(13);
    int hits = 0;
    const int pairs = frustum_pairs::iterations(300);
    for (int i = 0; i < pairs; ++i) {
        const frustum<T> f = frustum_pairs::any_view<T>(random, 20.0, 0.05, 1.0, 5.0, 30.0);
        cone3<T> cone{random.in_cube<T>(30.0), random.in_cube<T>(1.0), T(1), infinity<T>};
        if (i % 4 == 0) {
            // the axis passes close to the frustum, or through it
            cone.axis = f.eye + T(random.uniform(0, 10)) * f.forward - cone.apex;
        }
        // smallest angle over the edges by golden section in long double; the angle has one minimum
        // on an edge. Faces and the inside matter where the axis meets the frustum.
        const auto body = oracle::make_body<wide>(f, cone.apex);
        const oracle::vec<wide> axis = oracle::make<wide>(cone.axis);
        const auto angle = [&](const oracle::vec<wide>& x) {
            const auto n = oracle::cross(axis, x);
            return std::atan2(std::sqrt(oracle::dot(n, n)), oracle::dot(axis, x));
        };
        wide smallest = 4;
        for (std::size_t a = 0; a < 8; ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                // all 28 pairs of corners: diagonals do no harm, their points are in the frustum
                wide lo = 0;
                wide hi = 1;
                const auto at = [&](wide t) {
                    return angle(oracle::times(1 - t, body.points[a]) +
                                 oracle::times(t, body.points[b]));
                };
                for (int step = 0; step < 120; ++step) {
                    const wide third = (hi - lo) / 3;
                    if (at(lo + third) < at(hi - third)) {
                        hi -= third;
                    } else {
                        lo += third;
                    }
                }
                smallest = std::fmin(smallest, std::fmin(at(lo), std::fmin(at(0), at(1))));
            }
        }
        // whether the axis itself meets the frustum: a box that is a thin frustum around the ray
        const T thin = T(1e-9);
        const frustum<T> ray =
            make_frustum(cone.apex, cone.axis, glm::vec<3, T>(T(0), T(1), T(0)),
                         view_volume<T>{-thin, thin, -thin, thin, T(1e-3), T(200), false})
                .value;
        long exact = 0;
        const bool through = oracle::intersect(ray, f, cone.apex, exact);

        cone.angle = T(2 * smallest);
        if (wide(cone.angle) < 2 * smallest) {
            cone.angle = std::nextafter(cone.angle, T(7));
        }
        REQUIRE(intersects(f, cone).intersects);
        ++hits;
        const T narrower = T(2 * (smallest - wide(1e-9)) * (1 - wide(1e-5)));
        if (narrower > T(0)) {
            cone.angle = narrower;
            REQUIRE(intersects(f, cone).intersects == through);
            if (through) {
                cone.angle = T(0);
                REQUIRE(intersects(f, cone).intersects);
            }
        }
        // the range: a ball that does not reach, and one that does
        cone.angle = T(2) * T(3);
        const real distance = sqrt(square_distance(f, cone.apex));
        cone.range = T(distance * real(0.999));
        REQUIRE(intersects(f, cone).intersects == (distance == 0));
        cone.range = T(distance * real(1.001));
        cone.angle = T(6.2831854820251465); // no less than 2 pi
        REQUIRE(intersects(f, cone).intersects);
    }
    REQUIRE(hits == pairs);
}

TEST_CASE("peers 14: a spot light on a frustum plane, and one of almost 180 degrees", "[cull]") {
    const auto camera = make_frustum<double>({0, 0, 0}, {0, 0, -1}, {0, 1, 0},
                                             {-1.0, 1.0, -1.0, 1.0, 1.0, 10.0, false})
                            .value;
    // on the right plane, pointing away
    const light<double> on_plane = spot_light<double>({5, 0, -5}, {6, 0, -5}, 0.1);
    REQUIRE(intersects(camera, light_cone(on_plane, 10.0)).intersects);
    const light<double> off_plane = spot_light<double>({5.001, 0, -5}, {6, 0, -5}, 0.1);
    REQUIRE_FALSE(intersects(camera, light_cone(off_plane, 10.0)).intersects);
    const light<double> wide = spot_light<double>({0, 0, 5}, {0, 0, 6}, 3.14159);
    REQUIRE_FALSE(intersects(camera, light_cone(wide, 100.0)).intersects);
    REQUIRE(intersects(camera, light_cone(point_light<double>({0, 0, 5}), 100.0)).intersects);
    REQUIRE_FALSE(intersects(camera, light_cone(point_light<double>({0, 0, 5}), 5.9)).intersects);
}
