// Properties of warpshadow/cube.hpp and warpshadow/casters.hpp.
#include "exact_volumes.hpp"
#include "frustum_pairs.hpp"

#include <warpshadow/casters.hpp>
#include <warpshadow/cube.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <span>
#include <vector>

using namespace warpshadow;

namespace {

const int many = frustum_pairs::iterations(400);

template <typename T> constexpr T infinity = std::numeric_limits<T>::infinity();
template <typename T> constexpr T nan_value = std::numeric_limits<T>::quiet_NaN();

/// Any finite T: bits are drawn, so that all exponents occur.
template <typename T> T any_number() {
    if constexpr (std::numeric_limits<T>::digits == 24) {
        const auto bits = *rc::gen::arbitrary<std::uint32_t>();
        const T x = std::bit_cast<T>(bits);
        return std::isfinite(x) ? x : T(1);
    } else {
        const auto bits = *rc::gen::arbitrary<std::uint64_t>();
        const T x = std::bit_cast<T>(bits);
        return std::isfinite(x) ? x : T(1);
    }
}

/// A component that is often equal to another one, zero or extreme.
template <typename T> T awkward_number(T other) {
    switch (*rc::gen::inRange(0, 6)) {
    case 0:
        return other;
    case 1:
        return -other;
    case 2:
        return std::nextafter(other, T(0));
    case 3:
        return T(0);
    case 4:
        return T(*rc::gen::inRange(-1000, 1000)) / T(64);
    default:
        return any_number<T>();
    }
}

/// What OpenGL 4.6, table 8.19 says, in numbers: axes of s, t and of the face, one row per face.
constexpr int table[6][3][3] = {
    {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
    {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};

template <typename T> T along(const int (&axis)[3], const glm::vec<3, T>& v) {
    T sum = T(0);
    for (int i = 0; i < 3; ++i) {
        // one term only: exact, and no product of zero and infinity
        sum = axis[i] > 0 ? v[i] : axis[i] < 0 ? -v[i] : sum;
    }
    return sum;
}

template <typename T>
frustum<T> camera(glm::vec<3, T> eye, glm::vec<3, T> forward, T slope, T n, T f) {
    return make_frustum(eye, forward, glm::vec<3, T>(T(0), T(1), T(0)),
                        view_volume<T>{-slope, slope, -slope, slope, n, f, false})
        .value;
}

template <typename T> face_options refined() {
    face_options options;
    options.refined = true;
    return options;
}

/// The pyramid of a face up to `distance`.
template <typename T> frustum<T> pyramid(const glm::vec<3, T>& light, int face, T distance) {
    frustum<T> f = face_camera(light, face, cube_api::opengl, T(1), T(2)).value;
    f.volume.near_distance = T(0);
    f.volume.far_distance = distance;
    return f;
}

} // namespace

TEMPLATE_TEST_CASE("peers 32: a direction has the face of its largest component, and its uv",
                   "[cube]", float, double) {
    using T = TestType;
    REQUIRE(rc::check("lookup", [] {
        glm::vec<3, T> d;
        d.x = any_number<T>();
        d.y = awkward_number(d.x);
        d.z = awkward_number(*rc::gen::arbitrary<bool>() ? d.x : d.y);
        if (*rc::gen::arbitrary<bool>()) {
            std::swap(d.x, d.z);
        }
        const cube_point<T> p = cube_lookup(d);
        const T size[3] = {std::abs(d.x), std::abs(d.y), std::abs(d.z)};
        if (size[0] == T(0) && size[1] == T(0) && size[2] == T(0)) {
            RC_ASSERT(p.face == -1);
            return;
        }
        // x before y before z among the largest
        int axis = 0;
        for (int i = 1; i < 3; ++i) {
            axis = size[i] > size[axis] ? i : axis;
        }
        RC_ASSERT(p.face == 2 * axis + (d[axis] < T(0) ? 1 : 0));
        const auto& row = table[p.face];
        const oracle::real m = along(row[2], d);
        const oracle::real s = (oracle::real(along(row[0], d)) / m + 1) / 2;
        const oracle::real t = (oracle::real(along(row[1], d)) / m + 1) / 2;
        // division, product, sum: three roundings of numbers up to 1
        const oracle::real bound = 2 * oracle::real(std::numeric_limits<T>::epsilon());
        RC_ASSERT(abs(s - p.uv.x) <= bound);
        RC_ASSERT(abs(t - p.uv.y) <= bound);
        RC_ASSERT((p.uv.x >= T(0) && p.uv.x <= T(1) && p.uv.y >= T(0) && p.uv.y <= T(1)));
    }));
}

TEMPLATE_TEST_CASE("J51: ties go to x, then y, then z; uv = 1 is the last texel", "[cube]", float,
                   double) {
    using T = TestType;
    for (const T x : {T(-1), T(1)}) {
        for (const T y : {T(-1), T(1)}) {
            for (const T z : {T(-1), T(1)}) {
                REQUIRE(cube_lookup(glm::vec<3, T>(x, y, z)).face == (x < T(0) ? 1 : 0));
                REQUIRE(cube_lookup(glm::vec<3, T>(T(0.5) * x, y, z)).face == (y < T(0) ? 3 : 2));
                REQUIRE(cube_lookup(glm::vec<3, T>(x, T(0.5) * y, z)).face == (x < T(0) ? 1 : 0));
                REQUIRE(cube_lookup(glm::vec<3, T>(x, y, T(0.5) * z)).face == (x < T(0) ? 1 : 0));
                const auto corner = cube_lookup(glm::vec<3, T>(x, y, z));
                for (const int size : {1, 2, 3, 1000, 1024}) {
                    const glm::ivec2 texel = cube_texel(corner.uv, size);
                    REQUIRE((texel.x == 0 || texel.x == size - 1));
                    REQUIRE((texel.y == 0 || texel.y == size - 1));
                    REQUIRE(texel.x == (corner.uv.x == T(1) ? size - 1 : 0));
                    REQUIRE(texel.y == (corner.uv.y == T(1) ? size - 1 : 0));
                }
            }
        }
    }
    // both zeros are one number
    REQUIRE(cube_lookup(glm::vec<3, T>(-T(0), T(0), T(-2))).face == 5);
    REQUIRE(cube_lookup(glm::vec<3, T>(T(0), -T(0), T(2))).face == 4);
    REQUIRE(cube_texel(glm::vec<2, T>(std::nextafter(T(1), T(0)), T(2)), 8) == glm::ivec2(7, 7));
    REQUIRE(cube_texel(glm::vec<2, T>(T(-3), -infinity<T>), 8) == glm::ivec2(0, 0));
    REQUIRE(cube_texel(glm::vec<2, T>(nan_value<T>, infinity<T>), 8) == glm::ivec2(0, 7));
}

TEMPLATE_TEST_CASE("J51, peers 21: zero and non-finite directions have no face", "[cube]", float,
                   double) {
    using T = TestType;
    for (const T bad : {nan_value<T>, infinity<T>, -infinity<T>}) {
        for (int i = 0; i < 3; ++i) {
            glm::vec<3, T> d(T(1), T(2), T(3));
            d[i] = bad;
            const auto p = cube_lookup(d);
            REQUIRE(p.face == -1);
            REQUIRE(p.uv == glm::vec<2, T>(T(0)));
        }
    }
    REQUIRE(cube_lookup(glm::vec<3, T>(T(0), -T(0), T(0))).face == -1);
    REQUIRE(cube_direction(6, glm::vec<2, T>(T(0.5))) == glm::vec<3, T>(T(0)));
    REQUIRE(cube_direction(-1, glm::vec<2, T>(T(0.5))) == glm::vec<3, T>(T(0)));
    const T least = std::numeric_limits<T>::denorm_min();
    const T most = std::numeric_limits<T>::max();
    REQUIRE(cube_lookup(glm::vec<3, T>(T(0), T(0), -least)).face == 5);
    REQUIRE(cube_lookup(glm::vec<3, T>(most, -most, most)).uv == glm::vec<2, T>(T(0), T(1)));
}

TEMPLATE_TEST_CASE("a texel's direction leads back to the texel", "[cube]", float, double) {
    using T = TestType;
    for (const int size : {1, 2, 3, 7, 64}) {
        for (int face = 0; face < 6; ++face) {
            for (int i = 0; i < size; ++i) {
                for (int j = 0; j < size; ++j) {
                    const auto d = cube_texel_direction<T>(face, glm::ivec2(i, j), size);
                    const auto p = cube_lookup(d);
                    REQUIRE((p.face == face && cube_texel(p.uv, size) == glm::ivec2(i, j)));
                    REQUIRE(cube_distance(d) == T(1));
                }
            }
        }
    }
    REQUIRE(rc::check("any size", [] {
        const int size = *rc::gen::inRange(1, 1 << 20);
        const int face = *rc::gen::inRange(0, 6);
        const glm::ivec2 texel(*rc::gen::inRange(0, size), *rc::gen::inRange(0, size));
        const auto p = cube_lookup(cube_texel_direction<T>(face, texel, size));
        RC_ASSERT(p.face == face);
        RC_ASSERT(cube_texel(p.uv, size) == texel);
    }));
}

TEMPLATE_TEST_CASE("peers 40: a face camera puts each direction where the look-up finds it",
                   "[cube]", float, double) {
    using T = TestType;
    frustum_pairs::random random(21);
    for (const cube_api api : {cube_api::opengl, cube_api::vulkan, cube_api::direct3d}) {
        for (int option = 0; option < 16; ++option) {
            clip_space clip{
                (option & 1) != 0 ? depth_range::zero_to_one : depth_range::minus_one_to_one,
                (option & 2) != 0, (option & 4) != 0, (option & 8) != 0, api == cube_api::vulkan};
            for (int i = 0; i < many / 8; ++i) {
                const glm::vec<3, T> light = random.in_cube<T>(10.0);
                const glm::vec<3, T> d = random.in_cube<T>(5.0);
                const auto p = cube_lookup(d);
                const auto made = face_camera(light, p.face, api, T(1e-3), T(10));
                REQUIRE(made.flags == status::ok);
                const frustum<T>& f = made.value;
                REQUIRE(f.eye == light);
                // relative to the light, so that nothing but the projection is rounded
                const glm::vec<4, T> c = projection_matrix(f.volume, clip) *
                                         (view_matrix(f, clip, light) * glm::vec<4, T>(d, T(1)));
                const T x = T(0.5) + T(0.5) * c.x / c.w;
                const T row = api == cube_api::direct3d ? T(0.5) - T(0.5) * c.y / c.w
                                                        : T(0.5) + T(0.5) * c.y / c.w;
                const T bound = T(4) * std::numeric_limits<T>::epsilon();
                REQUIRE(std::abs(x - p.uv.x) <= bound);
                REQUIRE(std::abs(row - p.uv.y) <= bound);
                REQUIRE(std::abs(c.w - cube_distance(d)) <= bound * c.w);
                // no other face sees it, but for ties
                for (int face = 0; face < 6; ++face) {
                    const frustum<T> other = face_camera(light, face, api, T(1e-3), T(10)).value;
                    const glm::vec<4, T> e =
                        projection_matrix(other.volume, clip) *
                        (view_matrix(other, clip, light) * glm::vec<4, T>(d, T(1)));
                    const bool seen = e.w > T(0) && std::abs(e.x) < e.w && std::abs(e.y) < e.w;
                    REQUIRE((!seen || face == p.face));
                }
                const T handed = glm::dot(glm::cross(f.right, f.up), f.forward);
                REQUIRE(handed == (api == cube_api::opengl ? T(-1) : T(1)));
            }
        }
    }
    const auto bad = face_camera(glm::vec<3, T>(T(0)), 6, cube_api::opengl, T(0), T(10), T(0.5));
    REQUIRE(any(bad.flags, status::out_of_range));
    REQUIRE(any(bad.flags, status::near_clamped));
    REQUIRE(bad.value.forward == glm::vec<3, T>(T(1), T(0), T(0)));
    REQUIRE(bad.value.volume.right == T(1));
}

TEMPLATE_TEST_CASE("J46: camera at the light, 90 degrees, along an axis", "[cube]", float, double) {
    using T = TestType;
    const glm::vec<3, T> light(T(3), T(-2), T(7));
    const auto opposite = [](int face) { return 1u << (face ^ 1); };
    for (int face = 0; face < 6; ++face) {
        frustum<T> view = pyramid(light, face, T(100));
        view.volume.near_distance = T(0.125);
        const std::uint32_t own = 1u << face;
        // closed: the own face and the four that touch
        REQUIRE(face_mask(light, view, refined<T>()).mask == (all_faces & ~opposite(face)));
        // here the planes of the pyramids decide as well: the near plane is in front of the light
        REQUIRE(face_mask(light, view).mask == (all_faces & ~opposite(face)));
        face_options open;
        open.open = true;
        REQUIRE(face_mask(light, view, open).mask == own);
        open.refined = true;
        REQUIRE(face_mask(light, view, open).mask == own);
        // with the light in the view, at its apex, all touch
        view.volume.near_distance = T(0);
        REQUIRE(face_mask(light, view, refined<T>()).mask == all_faces);
        REQUIRE(face_mask(light, view, open).mask == own);
        // endless
        view.volume.near_distance = T(0.125);
        view.volume.far_distance = infinity<T>;
        REQUIRE((face_mask(light, view, refined<T>()).mask & own) != 0u);
        REQUIRE((face_mask(light, view, refined<T>()).mask & opposite(face)) == 0u);
        REQUIRE(face_mask(light, view, open).mask == own);
    }
}

TEMPLATE_TEST_CASE("J47, peers 13: a corner exactly on the plane between two faces keeps both",
                   "[cube]", float, double) {
    using T = TestType;
    frustum_pairs::random random(22);
    int touches = 0;
    for (int i = 0; i < many; ++i) {
        const frustum<T> view = frustum_pairs::dyadic_view<T>(random);
        const glm::vec<3, T> corner = frustum_pairs::point_on(
            view, T(random.integer(0, 1)), T(random.integer(0, 1)), T(random.integer(0, 1)));
        // the corner is at (d, d, z) from the light, up to signs and order
        const int a = random.integer(0, 2);
        const int b = (a + random.integer(1, 2)) % 3;
        glm::vec<3, T> offset(T(0));
        const T d = T(random.integer(1, 80)) * T(0.125);
        offset[a] = random.integer(0, 1) == 0 ? d : -d;
        offset[b] = random.integer(0, 1) == 0 ? d : -d;
        offset[3 - a - b] = d * T(random.integer(-4, 4)) * T(0.25);
        const glm::vec<3, T> light = corner - offset;
        const std::uint32_t face_a = 1u << (2 * a + (offset[a] < T(0) ? 1 : 0));
        const std::uint32_t face_b = 1u << (2 * b + (offset[b] < T(0) ? 1 : 0));
        for (const bool exact : {false, true}) {
            face_options options;
            options.refined = exact;
            const std::uint32_t mask = face_mask(light, view, options).mask;
            REQUIRE((mask & face_a) != 0u);
            REQUIRE((mask & face_b) != 0u);
        }
        // and with any displacement of the world
        const glm::vec<3, T> far_away(T(65536), T(-4096), T(8192));
        frustum<T> moved = view;
        moved.eye += far_away;
        REQUIRE(face_mask(light + far_away, moved).mask == face_mask(light, view).mask);
        ++touches;
    }
    REQUIRE(touches == many);
}

TEMPLATE_TEST_CASE("the mask holds every face that is seen, the refined one no other", "[cube]",
                   float, double) {
    using T = TestType;
    frustum_pairs::random random(23);
    int needed = 0;
    int by_planes = 0;
    int by_test = 0;
    int in_vain = 0;
    long exact = 0;
    const int pairs = many;
    for (int i = 0; i < pairs; ++i) {
        frustum<T> view = i % 4 == 3
                              ? frustum_pairs::dyadic_view<T>(random)
                              : frustum_pairs::any_view<T>(random, 20.0, 0.05, 1.0, 5.0, 30.0);
        if (i % 8 == 1) {
            view.volume = view_volume<T>{T(-3), T(4), T(-2), T(2), T(-5), T(20), true};
        }
        const glm::vec<3, T> light =
            i % 8 == 3 ? frustum_pairs::point_on(view, T(0), T(1), T(0)) : random.in_cube<T>(20.0);
        const std::uint32_t mask = face_mask(light, view).mask;
        const std::uint32_t fine = face_mask(light, view, refined<T>()).mask;
        // a range that no view exceeds changes nothing
        face_options ranged = refined<T>();
        ranged.range = 1000.0;
        REQUIRE((face_mask(light, view, ranged).mask & ~fine) == 0u);
        std::uint32_t truth = 0u;
        for (int face = 0; face < 6; ++face) {
            truth |=
                (oracle::intersect(pyramid(light, face, T(1000)), view, light, exact) ? 1u : 0u)
                << face;
        }
        REQUIRE((truth & ~mask) == 0u);
        REQUIRE((truth & ~fine) == 0u);
        REQUIRE((fine & ~mask) == 0u);
        needed += std::popcount(truth);
        by_planes += std::popcount(mask);
        by_test += std::popcount(fine);
        in_vain += std::popcount(fine & ~truth);
    }
    std::printf("%s faces of %d views: needed %d, mask %d, refined mask %d, decided exactly %ld\n",
                std::numeric_limits<T>::digits == 24 ? "float" : "double", pairs, needed, by_planes,
                by_test, exact);
    REQUIRE(in_vain == 0);
    REQUIRE(needed < 6 * pairs);
    REQUIRE(by_planes < 6 * pairs);
}

TEMPLATE_TEST_CASE("a wider slope asks for no fewer faces than the samples around a view", "[cube]",
                   float, double) {
    using T = TestType;
    frustum_pairs::random random(24);
    for (int i = 0; i < many; ++i) {
        const frustum<T> view = frustum_pairs::any_view<T>(random, 20.0, 0.05, 1.0, 5.0, 30.0);
        const glm::vec<3, T> light = random.in_cube<T>(20.0);
        face_options options;
        options.slope = 1.25;
        options.refined = i % 2 == 0;
        const std::uint32_t wide = face_mask(light, view, options).mask;
        if (options.refined) {
            // the planes alone may separate the wide pyramid and not the narrow one
            options.slope = 1.0;
            REQUIRE((face_mask(light, view, options).mask & ~wide) == 0u);
        }
        for (int k = 0; k < 50; ++k) {
            const glm::vec<3, T> point = frustum_pairs::point_on(
                view, T(random.uniform(0.01, 0.99)), T(random.uniform(0.01, 0.99)),
                T(random.uniform(0.01, 0.99)));
            const glm::vec<3, T> d = point - light;
            for (int face = 0; face < 6; ++face) {
                const T m = along(table[face][2], d);
                const T reach = glm::max(std::abs(along(table[face][0], d)),
                                         std::abs(along(table[face][1], d)));
                if (m > T(0) && reach < T(1.2499) * m) {
                    REQUIRE((wide >> face & 1u) != 0u);
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE("J48: views thinner than 1e-6 and flat ones miss nothing", "[cube]", float,
                   double) {
    using T = TestType;
    frustum_pairs::random random(25);
    int some = 0;
    for (int i = 0; i < many; ++i) {
        frustum<T> view = frustum_pairs::make_pair<T>(12, random).a;
        const glm::vec<3, T> light = random.in_cube<T>(20.0);
        const std::uint32_t mask = face_mask(light, view).mask;
        const std::uint32_t fine = face_mask(light, view, refined<T>()).mask;
        long exact = 0;
        for (int face = 0; face < 6; ++face) {
            if (oracle::intersect(pyramid(light, face, T(1000)), view, light, exact)) {
                REQUIRE((mask >> face & 1u) != 0u);
                REQUIRE((fine >> face & 1u) != 0u);
                ++some;
            } else {
                REQUIRE((fine >> face & 1u) == 0u);
            }
        }
    }
    REQUIRE(some > many);
}

TEMPLATE_TEST_CASE("J49, peers 11: the light inside the view needs all six faces", "[cube]", float,
                   double) {
    using T = TestType;
    frustum_pairs::random random(26);
    for (int i = 0; i < many; ++i) {
        const frustum<T> view = frustum_pairs::any_view<T>(random, 20.0, 0.05, 1.0, 5.0, 30.0);
        const glm::vec<3, T> light =
            frustum_pairs::point_on(view, T(random.uniform(0.01, 0.99)),
                                    T(random.uniform(0.01, 0.99)), T(random.uniform(0.01, 0.99)));
        REQUIRE(face_mask(light, view, refined<T>()).mask == all_faces);
    }
    // outside, in front of a view that looks at it from afar: five at most, and one behind
    const frustum<T> view = camera<T>(glm::vec<3, T>(T(0), T(0), T(50)),
                                      glm::vec<3, T>(T(0), T(0), T(1)), T(0.1), T(1), T(100));
    REQUIRE(face_mask(glm::vec<3, T>(T(0)), view, refined<T>()).mask == (1u << 4));
}

TEMPLATE_TEST_CASE("peers 34: masks of several views are joined; a map that lasts has all faces",
                   "[cube]", float, double) {
    using T = TestType;
    frustum_pairs::random random(27);
    for (int i = 0; i < many; ++i) {
        const glm::vec<3, T> light = random.in_cube<T>(20.0);
        std::vector<frustum<T>> views;
        std::uint32_t joined = 0u;
        const face_options options = i % 2 == 0 ? face_options{} : refined<T>();
        for (int k = 0; k < 3; ++k) {
            views.push_back(frustum_pairs::any_view<T>(random, 20.0, 0.05, 1.0, 5.0, 30.0));
            joined |= face_mask(light, views.back(), options).mask;
        }
        REQUIRE(face_mask(light, std::span<const frustum<T>>(views), options).mask == joined);
    }
    face_options once;
    once.update = cube_update::one_shot;
    const frustum<T> view = camera<T>(glm::vec<3, T>(T(0), T(0), T(50)),
                                      glm::vec<3, T>(T(0), T(0), T(1)), T(0.1), T(1), T(100));
    REQUIRE(face_mask(glm::vec<3, T>(T(0)), view, once).mask == all_faces);
    REQUIRE(face_mask(glm::vec<3, T>(T(0)), view, once).flags == status::ok);
    REQUIRE(face_mask(glm::vec<3, T>(T(0)), std::span<const frustum<T>>()).mask == 0u);
}

TEMPLATE_TEST_CASE("peers 5, 21: masks scale with the scene; NaN keeps all faces", "[cube]", float,
                   double) {
    using T = TestType;
    frustum_pairs::random random(28);
    for (int i = 0; i < many; ++i) {
        const glm::vec<3, T> light = random.in_cube<T>(20.0);
        frustum<T> view = frustum_pairs::any_view<T>(random, 20.0, 0.05, 1.0, 5.0, 30.0);
        const std::uint32_t mask = face_mask(light, view, refined<T>()).mask;
        for (const double factor : {0x1p-20, 0x1p20}) {
            frustum<T> scaled = view;
            scaled.eye *= T(factor);
            scaled.volume.near_distance *= T(factor);
            scaled.volume.far_distance *= T(factor);
            REQUIRE(face_mask(light * T(factor), scaled, refined<T>()).mask == mask);
        }
        for (const T bad : {nan_value<T>, infinity<T>}) {
            frustum<T> broken = view;
            T* const members[] = {&broken.eye.y,      &broken.right.x,
                                  &broken.forward.z,  &broken.volume.left,
                                  &broken.volume.top, &broken.volume.near_distance};
            *members[i % 6] = bad;
            const mask_result result = face_mask(light, broken, refined<T>());
            REQUIRE(result.mask == all_faces);
            REQUIRE(any(result.flags, status::invalid_input));
            glm::vec<3, T> nowhere = light;
            nowhere[i % 3] = bad;
            REQUIRE(face_mask(nowhere, view).mask == all_faces);
            REQUIRE(any(face_mask(nowhere, view).flags, status::invalid_input));
        }
    }
    face_options options;
    options.slope = nan_value<double>;
    const frustum<T> view = frustum_pairs::any_view<T>(random, 20.0, 0.05, 1.0, 5.0, 30.0);
    REQUIRE(any(face_mask(glm::vec<3, T>(T(0)), view, options).flags, status::invalid_input));
}

TEMPLATE_TEST_CASE("faces of boxes and balls: each that holds a point of them, and no other",
                   "[casters]", float, double) {
    using T = TestType;
    frustum_pairs::random random(29);
    long exact = 0;
    int all = 0;
    int in_vain = 0;
    for (int i = 0; i < many; ++i) {
        const glm::vec<3, T> light = random.in_cube<T>(4.0);
        box3<T> box;
        if (i % 2 == 0) {
            box.lo = random.in_cube<T>(8.0);
            box.hi = box.lo + glm::vec<3, T>(T(random.uniform(0, 6)), T(random.uniform(0, 6)),
                                             T(random.uniform(0, 6)));
        } else {
            // small integers relative to the light: corners on the planes between faces are common
            box.lo = light;
            for (int k = 0; k < 3; ++k) {
                box.lo[k] = T(random.integer(-3, 2));
                box.hi[k] = box.lo[k] + T(random.integer(0, 3));
            }
        }
        const glm::vec<3, T> at = i % 2 == 0 ? light : glm::vec<3, T>(T(0));
        const mask_result boxes = caster_faces(at, box);
        REQUIRE(boxes.flags == status::ok);
        std::uint32_t truth = 0u;
        for (int face = 0; face < 6; ++face) {
            truth |= (oracle::intersect(pyramid(at, face, T(64)), box, at, exact) ? 1u : 0u)
                     << face;
        }
        REQUIRE((truth & ~boxes.mask) == 0u);
        in_vain += std::popcount(boxes.mask & ~truth);
        all += std::popcount(truth);
    }
    REQUIRE(in_vain == 0);
    REQUIRE(all < 6 * many);
    for (int i = 0; i < many / 8; ++i) {
        const glm::vec<3, T> light = random.in_cube<T>(4.0);
        sphere3<T> ball{random.in_cube<T>(8.0), T(random.uniform(0, 5))};
        const int tight = random.integer(0, 5);
        const oracle::real distance =
            sqrt(oracle::square_distance(pyramid(light, tight, T(64)), ball.centre));
        if (i % 2 == 0) {
            ball.radius = T(distance);
        }
        const std::uint32_t mask = caster_faces(light, ball).mask;
        for (int face = 0; face < 6; ++face) {
            const oracle::real gap =
                sqrt(oracle::square_distance(pyramid(light, face, T(64)), ball.centre)) -
                oracle::real(ball.radius);
            if (gap <= 0) {
                REQUIRE((mask >> face & 1u) != 0u);
            } else if (gap > oracle::real(0x1p-44)) {
                // 32u (|centre| + radius), both below 32
                REQUIRE((mask >> face & 1u) == 0u);
            }
        }
    }
}

TEMPLATE_TEST_CASE("casters beyond the range are dropped; NaN keeps; one pass is many", "[casters]",
                   float, double) {
    using T = TestType;
    const glm::vec<3, T> light(T(0));
    const box3<T> box{glm::vec<3, T>(T(3), T(0), T(0)), glm::vec<3, T>(T(4), T(1), T(1))};
    REQUIRE(caster_faces(light, box, T(3)).mask == 1u);
    REQUIRE(caster_faces(light, box, std::nextafter(T(3), T(0)) * T(0.999)).mask == 0u);
    const sphere3<T> ball{glm::vec<3, T>(T(0), T(-5), T(0)), T(1)};
    REQUIRE(caster_faces(light, ball, T(4)).mask == 8u);
    REQUIRE(caster_faces(light, ball, T(3.999)).mask == 0u);
    box3<T> inverted{box.hi, box.lo};
    REQUIRE(caster_faces(light, inverted).mask == all_faces);
    REQUIRE(any(caster_faces(light, inverted).flags, status::invalid_input));
    inverted.lo.y = nan_value<T>;
    REQUIRE(caster_faces(light, inverted).mask == all_faces);
    REQUIRE(caster_faces(light, sphere3<T>{ball.centre, T(-1)}).mask == all_faces);
    // the light inside a caster
    REQUIRE(caster_faces(light, box3<T>{glm::vec<3, T>(T(-1)), glm::vec<3, T>(T(1))}).mask ==
            all_faces);
    REQUIRE(caster_faces(light, sphere3<T>{light, T(0)}).mask == all_faces);

    frustum_pairs::random random(30);
    std::vector<box3<T>> boxes;
    std::vector<sphere3<T>> balls;
    for (int i = 0; i < 50; ++i) {
        const glm::vec<3, T> at = random.in_cube<T>(10.0);
        boxes.push_back(box3<T>{at, at + glm::vec<3, T>(T(1))});
        balls.push_back(sphere3<T>{at, T(1)});
    }
    std::vector<std::uint8_t> masks(50, 0xff);
    std::uint32_t joined = 0u;
    const auto batch =
        caster_faces(light, std::span<const box3<T>>(boxes), T(12), std::span<std::uint8_t>(masks));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        REQUIRE(masks[i] == caster_faces(light, boxes[i], T(12)).mask);
        joined |= masks[i];
    }
    REQUIRE(batch.mask == joined);
    REQUIRE(batch.flags == status::ok);
    joined = 0u;
    const auto round = caster_faces(light, std::span<const sphere3<T>>(balls), T(12),
                                    std::span<std::uint8_t>(masks));
    for (std::size_t i = 0; i < balls.size(); ++i) {
        REQUIRE(masks[i] == caster_faces(light, balls[i], T(12)).mask);
        joined |= masks[i];
    }
    REQUIRE(round.mask == joined);
    masks.assign(50, 0xff);
    const auto small = caster_faces(light, std::span<const box3<T>>(boxes), T(12),
                                    std::span<std::uint8_t>(masks).first(49));
    REQUIRE(small.mask == all_faces);
    REQUIRE(small.flags == status::buffer_too_small);
    REQUIRE(masks[0] == 0xff);
}

TEMPLATE_TEST_CASE("peers 12, 13: casters that can shadow the view are kept, and only those",
                   "[casters]", float, double) {
    using T = TestType;
    frustum_pairs::random random(31);
    long exact = 0;
    int kept = 0;
    int in_vain = 0;
    int outside = 0;
    const int pairs = many;
    for (int i = 0; i < pairs; ++i) {
        frustum<T> view = i % 4 == 3
                              ? frustum_pairs::dyadic_view<T>(random)
                              : frustum_pairs::any_view<T>(random, 15.0, 0.05, 1.0, 5.0, 30.0);
        if (i % 16 == 1) {
            view.volume.far_distance = infinity<T>;
        }
        glm::vec<3, T> light = random.in_cube<T>(25.0);
        glm::vec<3, T> corner = random.in_cube<T>(25.0);
        glm::vec<3, T> size(T(random.uniform(0, 3)), T(random.uniform(0, 3)),
                            T(random.uniform(0, 3)));
        if (i % 4 == 3) {
            // light on a plane, an edge or a corner of the view; box that touches a point halfway
            // to it
            light = frustum_pairs::point_on(view, T(random.integer(0, 1)), T(random.integer(-2, 4)),
                                            T(random.integer(-1, 2)));
            const glm::vec<3, T> seen = frustum_pairs::point_on(
                view, T(random.integer(0, 1)), T(random.integer(0, 1)), T(random.integer(0, 1)));
            corner = T(0.5) * (light + seen);
            size = glm::vec<3, T>(T(random.integer(0, 3)), T(random.integer(0, 3)), T(1));
            for (int k = 0; k < 3; ++k) {
                corner[k] -= random.integer(0, 1) == 0 ? T(0) : size[k];
            }
        }
        const box3<T> box{corner, corner + size};
        const caster_filter filter = make_caster_filter(light, view);
        REQUIRE_FALSE(any(filter.flags, status::invalid_input));
        const bool answer = casts_into_view(filter, box);
        bool took_exact = false;
        const bool truth = oracle::intersect(
            oracle::hull_with_origin(oracle::make_body<long double>(view, light)),
            oracle::make_body<long double>(box, light),
            oracle::hull_with_origin(oracle::make_body<oracle::dyadic>(view, light)),
            oracle::make_body<oracle::dyadic>(box, light), took_exact);
        exact += took_exact ? 1 : 0;
        INFO(i);
        REQUIRE((answer || !truth));
        in_vain += answer && !truth ? 1 : 0;
        kept += truth ? 1 : 0;
        outside += truth && !intersects(view, box).intersects ? 1 : 0;
    }
    std::printf("%s casters: %d boxes, %d matter, %d of those outside the view, %d kept in vain, "
                "decided exactly %ld\n",
                std::numeric_limits<T>::digits == 24 ? "float" : "double", pairs, kept, outside,
                in_vain, exact);
    REQUIRE(in_vain == 0);
    REQUIRE(kept > pairs / 8);
    REQUIRE(kept < pairs * 7 / 8);
    REQUIRE(outside > pairs / 50);
}

TEMPLATE_TEST_CASE(
    "balls that can shadow the view, and King and Newhall's frustum around the shadow", "[casters]",
    float, double) {
    using T = TestType;
    frustum_pairs::random random(32);
    int exact_kept = 0;
    int frustum_kept = 0;
    const int pairs = many / 3;
    for (int i = 0; i < pairs; ++i) {
        const frustum<T> view = frustum_pairs::any_view<T>(random, 15.0, 0.05, 1.0, 5.0, 30.0);
        const glm::vec<3, T> light = random.in_cube<T>(25.0);
        sphere3<T> ball{random.in_cube<T>(20.0), T(random.uniform(0, 4))};
        std::vector<oracle::vec<oracle::real>> points = oracle::corners_of(view);
        points.push_back(oracle::real_vec(light));
        const oracle::real distance =
            sqrt(oracle::square_distance(points, oracle::real_vec(ball.centre)));
        if (i % 3 == 0) {
            ball.radius = T(distance);
        }
        const bool truth = distance <= oracle::real(ball.radius);
        const bool answer = casts_into_view(make_caster_filter(light, view), ball);
        REQUIRE((answer || !truth));
        if (answer && !truth) {
            // 3 * 16u * 3 of the extent of view, light and ball, below 128
            REQUIRE(distance - oracle::real(ball.radius) <= oracle::real(0x1p-39));
        }
        const cull_volume shadow = shadow_volume(light, ball);
        const bool published = intersects(shadow, make_cull_volume(view)).intersects;
        REQUIRE((published || !truth));
        exact_kept += answer ? 1 : 0;
        frustum_kept += published ? 1 : 0;
    }
    std::printf("%s balls: %d matter, frustum around the shadow keeps %d of %d\n",
                std::numeric_limits<T>::digits == 24 ? "float" : "double", exact_kept, frustum_kept,
                pairs);
    REQUIRE(exact_kept < pairs);
    REQUIRE(frustum_kept >= exact_kept);
    // what cannot be decided is kept
    const frustum<T> view =
        camera<T>(glm::vec<3, T>(T(0)), glm::vec<3, T>(T(0), T(0), T(-1)), T(1), T(1), T(10));
    const glm::vec<3, T> light(T(0), T(30), T(0));
    const caster_filter filter = make_caster_filter(light, view, T(100));
    const sphere3<T> behind{glm::vec<3, T>(T(0), T(40), T(0)), T(1)};
    REQUIRE_FALSE(casts_into_view(filter, behind));
    REQUIRE(casts_into_view(filter, sphere3<T>{behind.centre, nan_value<T>}));
    REQUIRE(casts_into_view(filter, box3<T>{behind.centre, glm::vec<3, T>(nan_value<T>)}));
    REQUIRE(casts_into_view(make_caster_filter(glm::vec<3, T>(nan_value<T>), view), behind));
    REQUIRE(
        any(make_caster_filter(glm::vec<3, T>(nan_value<T>), view).flags, status::invalid_input));
    REQUIRE(shadow_volume(light, sphere3<T>{light, T(1)}).flags == status::light_inside_body);
    REQUIRE(intersects(shadow_volume(light, sphere3<T>{light, T(1)}), make_cull_volume(view))
                .intersects);
    // out of the light's reach
    const sphere3<T> between{glm::vec<3, T>(T(0), T(15), T(-4)), T(1)};
    REQUIRE(casts_into_view(filter, between));
    REQUIRE_FALSE(casts_into_view(make_caster_filter(light, view, T(10)), between));
}
