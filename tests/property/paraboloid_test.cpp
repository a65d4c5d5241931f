// Properties of warpshadow/paraboloid.hpp, against 50 digits and against exact arithmetic.
#include "exact_volumes.hpp"
#include "frustum_pairs.hpp"

#include <warpshadow/light.hpp>
#include <warpshadow/paraboloid.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <span>
#include <vector>

using namespace warpshadow;
using oracle::real;

namespace {

const int many = frustum_pairs::iterations(400);

template <typename T> constexpr T infinity = std::numeric_limits<T>::infinity();
template <typename T> constexpr T nan_value = std::numeric_limits<T>::quiet_NaN();
template <typename T> constexpr double eps = static_cast<double>(std::numeric_limits<T>::epsilon());

/// Length and uv of a position, in 50 digits: uv = xy / (|p| + s z), or its reciprocal form.
template <typename T> struct exact_map {
    real distance, u, v;
    exact_map(const glm::vec<3, T>& p, int side) {
        const real x(p.x);
        const real y(p.y);
        const real z = side == 1 ? -real(p.z) : real(p.z);
        distance = sqrt(x * x + y * y + z * z);
        const real square = x * x + y * y;
        // 50 digits are not enough for |p| + z close to the far pole
        const real scale = z >= 0 ? real(1 / (distance + z)) : real((distance - z) / square);
        u = x * scale;
        v = y * scale;
    }
    double error(const glm::vec<2, T>& uv) const {
        const real length = sqrt(u * u + v * v);
        const real du = u - uv.x;
        const real dv = v - uv.y;
        return static_cast<double>(real(sqrt(du * du + dv * dv) / length));
    }
};

/// A direction with a component at every scale, close to axes and to the horizon often.
template <typename T> glm::vec<3, T> any_position(frustum_pairs::random& r) {
    glm::vec<3, T> p = r.in_cube<T>(1.0);
    const T small = T(std::pow(10.0, r.uniform(-12.0, 0.0)));
    switch (r.integer(0, 4)) {
    case 0:
        p.x *= small;
        p.y *= small;
        break;
    case 1:
        p.z *= small;
        break;
    case 2:
        p.z = T(0);
        break;
    case 3:
        p.y = T(0);
        p.x *= small;
        break;
    default:
        break;
    }
    const double size = std::numeric_limits<T>::digits == 24 ? 30.0 : 250.0;
    return p * T(std::pow(10.0, r.uniform(-size, size)));
}

} // namespace

TEMPLATE_TEST_CASE("peers 33: the projection holds at every point, pole and horizon included",
                   "[paraboloid]", float, double) {
    using T = TestType;
    frustum_pairs::random random(41);
    double worst = 0.0;
    double worst_distance = 0.0;
    for (int i = 0; i < 50 * many; ++i) {
        const glm::vec<3, T> p = any_position<T>(random);
        if (p.x == T(0) && p.y == T(0)) {
            continue;
        }
        for (const int side : {0, 1}) {
            const exact_map<T> truth(p, side);
            const glm::vec<2, T> uv = paraboloid_uv(p, side);
            if (truth.u * truth.u + truth.v * truth.v >
                real(0.9) * real(paraboloid_limit) * real(paraboloid_limit)) {
                // as far away as it is said to be
                REQUIRE(std::isfinite(uv.x));
                REQUIRE(std::isfinite(uv.y));
                REQUIRE(glm::length(glm::vec<2, double>(uv)) > 0.7 * double(paraboloid_limit));
                REQUIRE(glm::length(glm::vec<2, double>(uv)) < 1.5 * double(paraboloid_limit));
                continue;
            }
            worst = std::max(worst, truth.error(uv));
        }
        const real d = exact_map<T>(p, 0).distance;
        if (d < real(std::numeric_limits<T>::max())) {
            worst_distance = std::max(
                worst_distance, static_cast<double>(real(abs(d - paraboloid_distance(p)) / d)));
        }
    }
    std::printf("%s paraboloid: uv within %.2f eps, distance within %.2f eps\n",
                std::numeric_limits<T>::digits == 24 ? "float" : "double", worst / eps<T>,
                worst_distance / eps<T>);
    // scaling, three squares, two sums, root, sum, quotient: below eight roundings of eps / 2
    REQUIRE(worst <= 4.0 * eps<T>);
    REQUIRE(worst_distance <= 4.0 * eps<T>);
}

TEMPLATE_TEST_CASE("J50, peers 33: poles, extremes and nothing at all", "[paraboloid]", float,
                   double) {
    using T = TestType;
    using vec3 = glm::vec<3, T>;
    using vec2 = glm::vec<2, T>;
    const auto back = paraboloid_lookup(vec3(T(0), T(0), T(-1)));
    REQUIRE(back.side == 1);
    REQUIRE(back.uv == vec2(T(0)));
    const auto close = paraboloid_lookup(vec3(T(1e-20), T(0), T(-1)));
    REQUIRE(close.side == 1);
    REQUIRE(close.uv.x == T(0.5e-20));
    const auto large = paraboloid_lookup(vec3(T(1e25), T(0), T(1e25)));
    REQUIRE(large.side == 0);
    REQUIRE(std::abs(double(large.uv.x) - (std::sqrt(2.0) - 1.0)) <= eps<T>);
    const auto none = paraboloid_lookup(vec3(T(0), T(0), T(0)));
    REQUIRE(none.side == -1);
    REQUIRE(none.uv == vec2(T(0)));
    const T most = std::numeric_limits<T>::max();
    const T least = std::numeric_limits<T>::denorm_min();
    REQUIRE(paraboloid_lookup(vec3(most, most, most)).side == 0);
    REQUIRE(std::isfinite(paraboloid_distance(vec3(most, most, most))));
    REQUIRE(paraboloid_distance(vec3(most, most, most)) == most);
    REQUIRE(paraboloid_distance(vec3(least, T(0), T(0))) == least);
    REQUIRE(paraboloid_lookup(vec3(least, T(0), least)).side == 0);
    REQUIRE(std::abs(double(paraboloid_lookup(vec3(least, T(0), least)).uv.x) -
                     (std::sqrt(2.0) - 1.0)) <= eps<T>);
    for (const T bad : {nan_value<T>, infinity<T>, -infinity<T>}) {
        for (int i = 0; i < 3; ++i) {
            vec3 p(T(1), T(2), T(3));
            p[i] = bad;
            REQUIRE(paraboloid_lookup(p).side == -1);
            REQUIRE(paraboloid_uv(p, 0) == vec2(T(0)));
            REQUIRE(paraboloid_distance(p) == T(0));
            REQUIRE(paraboloid_depth(p, T(1), T(2)) == T(0));
            REQUIRE(paraboloid_segments(p, vec3(T(1)), 0, T(0.1)) >= T(1));
            REQUIRE(std::isfinite(paraboloid_segments(vec3(T(1)), p, 0, T(0.1))));
        }
        const vec3 d = paraboloid_unproject(vec2(bad, T(0)), 0);
        REQUIRE(std::isfinite(d.x));
        REQUIRE(std::isfinite(d.y));
        REQUIRE(std::isfinite(d.z));
    }
    // the far pole of a side, for vertices: far away, and finite
    const vec2 pole = paraboloid_uv(vec3(T(0), T(0), T(-1)), 0);
    REQUIRE(pole == vec2(T(paraboloid_limit), T(0)));
    REQUIRE(paraboloid_depth(vec3(T(1), T(0), T(0)), T(2), T(2)) == T(1));
    REQUIRE(paraboloid_depth(vec3(T(1), T(0), T(0)), T(1), infinity<T>) == T(1));
    REQUIRE(paraboloid_depth(vec3(T(3), T(0), T(4)), T(1), T(9)) == T(0.5));
    REQUIRE(paraboloid_map(vec2(T(-1), T(1))) == vec2(T(0), T(1)));
}

TEMPLATE_TEST_CASE("peers 33: both sides agree along the seam, to the bit", "[paraboloid]", float,
                   double) {
    using T = TestType;
    frustum_pairs::random random(42);
    for (int i = 0; i < 10 * many; ++i) {
        glm::vec<3, T> p = any_position<T>(random);
        p.z = random.integer(0, 1) == 0 ? T(0) : -T(0);
        if (p.x == T(0) && p.y == T(0)) {
            continue;
        }
        const glm::vec<2, T> front = paraboloid_uv(p, 0);
        REQUIRE(front == paraboloid_uv(p, 1));
        REQUIRE(paraboloid_lookup(p).side == 0);
        REQUIRE(std::abs(glm::length(glm::vec<2, double>(front)) - 1.0) <= 4.0 * eps<T>);
        REQUIRE(paraboloid_clip(p, 0, T(0)) == T(0));
        REQUIRE(paraboloid_clip(p, 1, T(0)) == T(0));
        // with an overlap both sides draw it
        REQUIRE(paraboloid_clip(p, 0, T(0.01)) > T(0));
        REQUIRE(paraboloid_clip(p, 1, T(0.01)) > T(0));
        // every direction is seen by the side that the look-up names, and lies in the disc
        const glm::vec<3, T> q = any_position<T>(random);
        const auto seen = paraboloid_lookup(q);
        REQUIRE(paraboloid_clip(q, seen.side, T(0)) >= T(0));
        REQUIRE(glm::length(glm::vec<2, double>(seen.uv)) <= 1.0 + 4.0 * eps<T>);
    }
}

TEMPLATE_TEST_CASE("unproject undoes the projection, in the disc and behind the horizon",
                   "[paraboloid]", float, double) {
    using T = TestType;
    frustum_pairs::random random(43);
    for (int i = 0; i < 50 * many; ++i) {
        const glm::vec<3, T> p = any_position<T>(random);
        const int side = random.integer(0, 1);
        const glm::vec<2, T> uv = paraboloid_uv(p, side);
        const glm::vec<3, T> d = paraboloid_unproject(uv, side);
        REQUIRE(std::abs(glm::length(glm::vec<3, double>(d)) - 1.0) <= 4.0 * eps<T>);
        const exact_map<T> truth(p, side);
        if (p.x == T(0) && p.y == T(0)) {
            continue;
        }
        // directions differ by the error of uv, 4 eps of its length, times at most 2 / (1 +
        // |uv|^2), and by four roundings of the inverse; the clamped ones by 2 / limit
        const double bound = 4.0 * eps<T> * 2.0 + 4.0 * eps<T> +
                             (glm::length(glm::vec<2, double>(uv)) > 0.5 * double(paraboloid_limit)
                                  ? 4.0 / double(paraboloid_limit)
                                  : 0.0);
        real square = 0;
        for (int k = 0; k < 3; ++k) {
            const real gap = real(p[k]) / truth.distance - real(d[k]);
            square += gap * gap;
        }
        REQUIRE(sqrt(square) <= real(bound));
    }
    REQUIRE(paraboloid_unproject(glm::vec<2, T>(T(0)), 0) == glm::vec<3, T>(T(0), T(0), T(1)));
    REQUIRE(paraboloid_unproject(glm::vec<2, T>(T(0)), 1) == glm::vec<3, T>(T(0), T(0), T(-1)));
    REQUIRE(paraboloid_unproject(glm::vec<2, T>(T(1), T(0)), 0) ==
            glm::vec<3, T>(T(1), T(0), T(0)));
}

TEMPLATE_TEST_CASE("a power of two as a scale changes no bit", "[paraboloid]", float, double) {
    using T = TestType;
    frustum_pairs::random random(44);
    for (int i = 0; i < 5 * many; ++i) {
        const glm::vec<3, T> a = random.in_cube<T>(3.0);
        const glm::vec<3, T> b = random.in_cube<T>(3.0);
        const T s = T(random.integer(0, 1) == 0 ? 0x1p20 : 0x1p-20);
        REQUIRE(paraboloid_uv(a, 0) == paraboloid_uv(s * a, 0));
        REQUIRE(paraboloid_lookup(a).uv == paraboloid_lookup(s * a).uv);
        REQUIRE(s * paraboloid_distance(a) == paraboloid_distance(s * a));
        REQUIRE(paraboloid_segments(a, b, 0, T(0.1)) ==
                paraboloid_segments(s * a, s * b, 0, T(0.1)));
    }
}

TEMPLATE_TEST_CASE("chord error and longest chord undo each other", "[paraboloid]", float, double) {
    using T = TestType;
    frustum_pairs::random random(45);
    for (int i = 0; i < 5 * many; ++i) {
        const T size = T(random.integer(1, 16384));
        const T texels = T(random.log_uniform(1e-3, 4.0));
        const T chord = longest_chord(texels, size);
        REQUIRE(chord >= T(0));
        REQUIRE(chord <= T(2));
        const real deviation = real(2) * real(texels) / real(size);
        if (deviation < 1) {
            // square root, two products: the chord within 4 eps, its error within twice that
            const real half_chord = real(chord) / 2;
            const real reached = 1 - sqrt(1 - half_chord * half_chord);
            REQUIRE(abs(reached - deviation) <=
                    deviation * 16 * real(eps<T>) / sqrt(1 - deviation));
        } else {
            REQUIRE(chord == T(2));
        }
        const T c = T(random.uniform(0.0, 1.9));
        const real half_chord = real(c) / 2;
        const real truth = 1 - sqrt(1 - half_chord * half_chord);
        REQUIRE(abs(real(chord_error(c)) - truth) <= 16 * real(eps<T>) * truth);
    }
    // half a texel of 1024: 45 texels, sqrt(16 e / w) to first order
    REQUIRE(longest_chord(T(0.5), T(1024)) * T(512) == Approx(45.2437841).epsilon(1e-6));
    REQUIRE(chord_error(T(2)) == T(1));
    REQUIRE(chord_error(T(5)) == T(1));
    REQUIRE(longest_chord(T(1), T(0)) == T(2));
}

TEMPLATE_TEST_CASE("no edge of a random mesh deviates by more than the texels asked for",
                   "[paraboloid]", float, double) {
    using T = TestType;
    frustum_pairs::random random(46);
    double worst = 0.0;
    double spared = 0.0;
    long parts = 0;
    int long_edges = 0;
    for (int i = 0; i < 8 * many; ++i) {
        const int side = random.integer(0, 1);
        const T facing = side == 1 ? T(-1) : T(1);
        const double scale = random.log_uniform(1e-3, 1e3);
        glm::vec<3, T> a = random.in_cube<T>(scale);
        glm::vec<3, T> b = a + random.in_cube<T>(random.log_uniform(1e-3, 2.0) * scale);
        // seen by the side, or a little behind its horizon
        const T behind = T(random.integer(0, 3) == 0 ? 0.1 : 0.0);
        a.z = facing * std::abs(a.z) - facing * behind * T(scale);
        b.z = facing * std::abs(b.z);
        const T size = T(1 << random.integer(6, 12));
        const T texels = T(random.uniform(0.1, 1.0));
        const T chord = longest_chord(texels, size);
        const T wanted = paraboloid_segments(a, b, side, chord);
        REQUIRE(wanted >= T(1));
        REQUIRE(wanted == std::floor(wanted));
        if (wanted > T(4096)) {
            continue;
        }
        const int n = static_cast<int>(wanted);
        parts += n;
        long_edges += n > 1 ? 1 : 0;
        // the image of the edge against the chord of each part, in texels, in long double
        using wide = long double;
        const auto image = [&](wide t) {
            const glm::vec<3, wide> p = glm::vec<3, wide>(a) * (1 - t) + glm::vec<3, wide>(b) * t;
            const wide z = wide(facing) * p.z;
            const wide d = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
            const wide s = z >= 0 ? 1 / (d + z) : (d - z) / (p.x * p.x + p.y * p.y);
            return glm::vec<2, wide>(p.x * s, p.y * s) * (wide(size) / 2);
        };
        double largest = 0.0;
        const int stride = std::max(1, n / 24);
        for (int k = 0; k < n; k += stride) {
            const glm::vec<2, wide> from = image(wide(k) / wide(n));
            const glm::vec<2, wide> to = image(wide(k + 1) / wide(n));
            const glm::vec<2, wide> along = to - from;
            const wide length = std::sqrt(along.x * along.x + along.y * along.y);
            for (int m = 1; m < 16 && length > 0; ++m) {
                const glm::vec<2, wide> q = image((wide(k) + wide(m) / 16) / wide(n)) - from;
                const wide deviation = std::fabs(along.x * q.y - along.y * q.x) / length;
                largest = std::max(largest, static_cast<double>(deviation));
            }
        }
        worst = std::max(worst, largest / double(texels));
        spared += largest / double(texels);
        // the asked deviation in T is off by its own rounding, 16 eps as above
        REQUIRE(largest <= double(texels) * (1.0 + 16.0 * eps<T>));
    }
    std::printf("%s chord bound: worst deviation %.6f of the asked, mean %.3f, %ld parts\n",
                std::numeric_limits<T>::digits == 24 ? "float" : "double", worst,
                spared / (8 * many), parts);
    REQUIRE(long_edges > many);
    REQUIRE(worst > 0.5); // the bound is not idle
}

TEMPLATE_TEST_CASE("the chord bound is reached along the horizon", "[paraboloid]", float, double) {
    using T = TestType;
    // a short edge along the horizon, as long as allowed: one part, and all of the deviation used
    const T size = T(1024);
    const T texels = T(0.5);
    const T chord = longest_chord(texels, size);
    const double angle = 2.0 * std::asin(0.5 * double(chord)) * 0.999;
    const glm::vec<3, T> a(T(1), T(0), T(0));
    const glm::vec<3, T> b(T(std::cos(angle)), T(std::sin(angle)), T(0));
    REQUIRE(paraboloid_segments(a, b, 0, chord) <= T(2));
    const double half_chord = 0.5 * 2.0 * std::sin(0.5 * angle);
    const double deviation = (1.0 - std::sqrt(1.0 - half_chord * half_chord)) * 512.0;
    REQUIRE(deviation > 0.99 * 0.5);
    REQUIRE(deviation <= 0.5);
    // an edge through the light has no finite answer but a cap
    REQUIRE(paraboloid_segments(glm::vec<3, T>(T(-1), T(1e-30), T(0)),
                                glm::vec<3, T>(T(1), T(1e-30), T(0)), 0,
                                chord) == T(paraboloid_limit));
    // an edge that points at the light is a point
    REQUIRE(paraboloid_segments(a, T(5) * a, 0, chord) == T(1));
}

TEMPLATE_TEST_CASE("distance per fragment, not per vertex", "[paraboloid]", float, double) {
    using T = TestType;
    // what interpolation would do at the middle of an edge of 17 degrees, distances 1 : 16
    const T angle = T(0.3);
    const glm::vec<3, T> a(T(1), T(0), T(0));
    const glm::vec<3, T> b = T(16) * glm::vec<3, T>(std::cos(angle), std::sin(angle), T(0));
    const auto along = [&](T t) { return (T(1) - t) * a + t * b; };
    T worst = T(0);
    for (int i = 1; i < 64; ++i) {
        // position in the map is linear in the angle to first order: take the point there
        const T share = T(i) / T(64);
        const T direction = share * angle;
        const T t =
            std::sin(direction) / (std::sin(direction) + T(16) * std::sin(angle - direction));
        const glm::vec<3, T> p = along(t);
        const T truth = paraboloid_distance(p);
        REQUIRE(std::abs(double(truth) - glm::length(glm::vec<3, double>(p))) <=
                4.0 * eps<T> * double(truth));
        worst = std::max(worst, std::abs((T(1) - share) * T(1) + share * T(16) - truth) / truth);
    }
    REQUIRE(worst > T(3));
}

TEMPLATE_TEST_CASE("hemispheres: a side is skipped only if the view is behind the plane",
                   "[paraboloid]", float, double) {
    using T = TestType;
    using vec3 = glm::vec<3, T>;
    frustum_pairs::random random(47);
    int skipped = 0;
    for (int i = 0; i < 2 * many; ++i) {
        frustum<T> view = i % 2 == 0
                              ? frustum_pairs::dyadic_view<T>(random)
                              : frustum_pairs::any_view<T>(random, 15.0, 0.05, 1.0, 5.0, 30.0);
        vec3 axis = random.in_cube<T>(1.0);
        vec3 light = random.in_cube<T>(20.0);
        if (i % 2 == 0) {
            // small integers, and the plane through a corner of the view
            axis = vec3(T(random.integer(-3, 3)), T(random.integer(-3, 3)), T(1));
            light = frustum_pairs::point_on(view, T(random.integer(0, 1)), T(random.integer(0, 1)),
                                            T(random.integer(0, 1))) +
                    vec3(T(1), T(0), -axis.x);
        }
        // exact signs at the corners
        const auto body = oracle::make_body<oracle::dyadic>(view, light);
        const auto g = oracle::make<oracle::dyadic>(axis);
        std::uint32_t truth = 0u;
        for (const auto& p : body.points) {
            const int sign = oracle::dot(g, p).sign();
            truth |= sign > 0 ? 1u : sign < 0 ? 2u : 3u;
        }
        const mask_result result = side_mask(light, axis, std::span<const frustum<T>>(&view, 1));
        REQUIRE(result.flags == status::ok);
        REQUIRE((truth & ~result.mask) == 0u);
        // and only then: nothing comes as close as rounding without touching
        REQUIRE(result.mask == truth);
        skipped += result.mask != both_sides ? 1 : 0;
        // an overlap asks for more
        const std::uint32_t wider =
            side_mask(light, axis, std::span<const frustum<T>>(&view, 1), T(0.1)).mask;
        REQUIRE((result.mask & ~wider) == 0u);

        const box3<T> box{light + random.in_cube<T>(5.0), light + vec3(T(6))};
        std::uint32_t sides = 0u;
        for (const auto& p : oracle::make_body<oracle::dyadic>(box, light).points) {
            const int sign = oracle::dot(g, p).sign();
            sides |= sign > 0 ? 1u : sign < 0 ? 2u : 3u;
        }
        REQUIRE(caster_sides(light, axis, box).mask == sides);
        const sphere3<T> ball{light + random.in_cube<T>(5.0), T(random.uniform(0, 3))};
        const real height = [&] {
            real sum = 0;
            real square = 0;
            for (int k = 0; k < 3; ++k) {
                sum += (real(ball.centre[k]) - real(light[k])) * real(axis[k]);
                square += real(axis[k]) * real(axis[k]);
            }
            return real(sum / sqrt(square));
        }();
        const std::uint32_t expected = (height + real(ball.radius) >= 0 ? 1u : 0u) |
                                       (height - real(ball.radius) <= 0 ? 2u : 0u);
        REQUIRE(caster_sides(light, axis, ball).mask == expected);
    }
    REQUIRE(skipped > many / 4);
    // joined over views, kept when undecided
    const frustum<T> ahead =
        make_frustum(vec3(T(0), T(0), T(5)), vec3(T(0), T(0), T(1)), vec3(T(0), T(1), T(0)),
                     perspective_volume(T(1), T(1), T(1), T(10)))
            .value;
    frustum<T> behind = ahead;
    behind.eye.z = T(-20);
    const vec3 axis(T(0), T(0), T(1));
    const std::vector<frustum<T>> two{ahead, behind};
    REQUIRE(side_mask(vec3(T(0)), axis, std::span<const frustum<T>>(&ahead, 1)).mask == 1u);
    REQUIRE(side_mask(vec3(T(0)), axis, std::span<const frustum<T>>(&behind, 1)).mask == 2u);
    REQUIRE(side_mask(vec3(T(0)), axis, std::span<const frustum<T>>(two)).mask == 3u);
    REQUIRE(side_mask(vec3(T(0)), axis, std::span<const frustum<T>>()).mask == 0u);
    for (const vec3 bad : {vec3(T(0)), vec3(nan_value<T>), vec3(infinity<T>, T(0), T(0))}) {
        REQUIRE(side_mask(vec3(T(0)), bad, std::span<const frustum<T>>(two)).mask == both_sides);
        REQUIRE(any(side_mask(vec3(T(0)), bad, std::span<const frustum<T>>(two)).flags,
                    status::invalid_input));
        REQUIRE(caster_sides(vec3(T(0)), bad, sphere3<T>{vec3(T(1)), T(1)}).mask == both_sides);
    }
    REQUIRE(any(side_mask(vec3(nan_value<T>), axis, std::span<const frustum<T>>(two)).flags,
                status::invalid_input));
    // beyond the range
    REQUIRE(caster_sides(vec3(T(0)), axis, sphere3<T>{vec3(T(9), T(0), T(0)), T(1)}, T(7)).mask ==
            0u);
    REQUIRE(caster_sides(vec3(T(0)), axis, box3<T>{vec3(T(9)), vec3(T(10))}, T(7)).mask == 0u);
    // an endless view to the front stays there
    frustum<T> endless = ahead;
    endless.volume.far_distance = infinity<T>;
    REQUIRE(side_mask(vec3(T(0)), axis, std::span<const frustum<T>>(&endless, 1)).mask == 1u);
}
