// Properties of warpshadow/cascades.hpp.
#include "camera.hpp"

#include <warpshadow/cascades.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

using namespace warpshadow;
using namespace camera_test;

namespace {

template <typename T> constexpr T infinity = std::numeric_limits<T>::infinity();
template <typename T> constexpr T nan_of = std::numeric_limits<T>::quiet_NaN();

/// The practical split in 100 digits.
real practical(const real& n, const real& f, int number, int count, const real& lambda) {
    const real s = real(number) / count;
    return lambda * n * pow(f / n, s) + (1 - lambda) * (n + (f - n) * s);
}

} // namespace

TEMPLATE_TEST_CASE("splits are those of Zhang et al.", "[cascades]", float, double) {
    REQUIRE(rc::check("oracle", [] {
        using T = TestType;
        const T n = log_between<T>(1e-3, 1e3);
        const T f = n * log_between<T>(1.01, 1e6);
        const T lambda = between<T>(0.0, 1.0);
        const auto count = static_cast<std::size_t>(*rc::gen::inRange(1, 9));
        std::vector<T> splits(count + 1);
        const split_result result = split_depths(n, f, lambda, std::span<T>(splits));
        RC_ASSERT(result.count == count);
        RC_ASSERT(result.flags == status::ok);
        RC_ASSERT(splits.front() == n);
        RC_ASSERT(splits.back() == f);
        for (std::size_t i = 1; i < count; ++i) {
            RC_ASSERT(splits[i] > splits[i - 1]);
            const double expected = as_double(practical(real(n), real(f), static_cast<int>(i),
                                                        static_cast<int>(count), real(lambda)));
            // far / near is rounded, and its logarithm's error counts once per octave
            const double bound = (32.0 + std::log2(static_cast<double>(f / n))) * roundoff<T>();
            RC_ASSERT(std::abs(static_cast<double>(splits[i]) - expected) <= bound * expected);
        }
    }));
}

TEMPLATE_TEST_CASE("splits scale with the scene, to the bit", "[cascades]", float, double) {
    REQUIRE(rc::check("powers of two", [] {
        using T = TestType;
        const T n = log_between<T>(1e-3, 1e3);
        const T f = n * log_between<T>(1.01, 1e6);
        const T scale = std::ldexp(T(1), *rc::gen::inRange(-40, 40));
        std::array<T, 5> a{};
        std::array<T, 5> b{};
        const T lambda = between<T>(0.0, 1.0);
        split_depths(n, f, lambda, std::span<T>(a));
        split_depths(n * scale, f * scale, lambda, std::span<T>(b));
        for (std::size_t i = 0; i < a.size(); ++i) {
            RC_ASSERT(b[i] == a[i] * scale);
        }
    }));
}

TEMPLATE_TEST_CASE("splits are finite, positive and in order whatever comes in", "[cascades]",
                   float, double) {
    REQUIRE(rc::check("any numbers", [] {
        using T = TestType;
        std::array<T, 5> splits{};
        const split_result result =
            split_depths(any_number<T>(), any_number<T>(), any_number<T>(), std::span<T>(splits));
        RC_ASSERT(result.count == 4u);
        for (std::size_t i = 0; i < splits.size(); ++i) {
            RC_ASSERT(std::isfinite(splits[i]));
            RC_ASSERT(splits[i] >= T(0));
            // an operator of RapidCheck's, not the one that stops at what is true
            if (i > 0) {
                RC_ASSERT(splits[i] >= splits[i - 1]);
            }
        }
    }));
    using T = TestType;
    std::array<T, 4> splits{};
    const std::span<T> all(splits);
    REQUIRE(split_depths(T(0), T(100), T(0.5), all).flags == status::near_clamped);
    REQUIRE(splits[0] == T(100) * T(0x1p-20));
    REQUIRE(split_depths(T(1), infinity<T>, T(0.5), all).flags == status::unbounded);
    REQUIRE(splits[3] == T(0x1p20));
    REQUIRE(split_depths(T(5), T(5), T(0.5), all).flags == status::out_of_range);
    REQUIRE(splits[3] > splits[0]);
    REQUIRE(split_depths(nan_of<T>, T(5), T(0.5), all).flags == status::invalid_input);
    REQUIRE(split_depths(T(1), T(5), T(2), all).flags == status::out_of_range);
    std::array<T, 4> logarithmic{};
    split_depths(T(1), T(5), T(1), std::span<T>(logarithmic));
    REQUIRE(splits == logarithmic);
    REQUIRE(split_depths(T(1), T(5), T(1), all.first(1)).flags == status::buffer_too_small);
    // one cascade is the whole range
    REQUIRE(split_depths(T(1), T(5), T(1), all.first(2)).flags == status::ok);
    REQUIRE(splits[1] == T(5));
}

TEMPLATE_TEST_CASE("a tiny world keeps its near distance", "[cascades]", float, double) {
    // an absolute padding makes the near distance negative there (peers: -0.738 for .01 to 10)
    using T = TestType;
    std::array<T, 5> splits{};
    REQUIRE(split_depths(T(0.01), T(10), T(0.95), std::span<T>(splits)).flags == status::ok);
    REQUIRE(splits[0] == T(0.01));
    REQUIRE(splits[1] > T(0.01));
}

TEMPLATE_TEST_CASE("every depth of the view has its cascade", "[cascades]", float, double) {
    REQUIRE(rc::check("search", [] {
        using T = TestType;
        std::array<T, 5> splits{};
        const T n = log_between<T>(1e-2, 1e2);
        const T f = n * log_between<T>(1.5, 1e4);
        split_depths(n, f, T(0.7), std::span<T>(splits));
        const glm::vec<4, T> ends(splits[1], splits[2], splits[3], splits[4]);
        const T depth = coin() ? log_between<T>(static_cast<double>(n), static_cast<double>(f))
                               : splits[static_cast<std::size_t>(*rc::gen::inRange(0, 5))];
        const int number = cascade_of(depth, ends);
        RC_ASSERT(number >= 0 && number < 4);
        const auto i = static_cast<std::size_t>(number);
        RC_ASSERT(depth >= splits[i] || i == 0);
        RC_ASSERT(depth < splits[i + 1] || i == 3);
    }));
    using T = TestType;
    REQUIRE(cascade_of(nan_of<T>, glm::vec<4, T>(T(1))) == 0);
    // two cascades
    REQUIRE(cascade_of(T(7), glm::vec<4, T>(T(2), infinity<T>, infinity<T>, infinity<T>)) == 1);
}

TEMPLATE_TEST_CASE("a blend runs from 0 to 1 inside the overlap of two slices", "[cascades]", float,
                   double) {
    REQUIRE(rc::check("blend", [] {
        using T = TestType;
        const T end = log_between<T>(1e-2, 1e4);
        const T overlap = between<T>(0.01, 0.5);
        const T depth = end * between<T>(0.25, 1.5);
        const T share = cascade_blend(depth, end, overlap);
        RC_ASSERT(share >= T(0) && share <= T(1));
        if (depth >= end) {
            RC_ASSERT(share == T(1));
        }
        // wherever the next cascade counts, its slice is there; the band's ends are rounded
        frustum<T> camera{};
        camera.volume = perspective_volume(T(1), T(1), end * T(0.001), end * T(10));
        const frustum<T> next = cascade_slice(camera, end, end * T(2), overlap);
        const T slack = end * std::numeric_limits<T>::epsilon() * T(4);
        if (share > T(0)) {
            RC_ASSERT(depth >= next.volume.near_distance - slack);
        }
        RC_ASSERT(next.volume.far_distance == end * T(2));
    }));
    using T = TestType;
    REQUIRE(cascade_blend(T(1), T(2), T(0)) == T(0));
    REQUIRE(cascade_blend(T(2), T(2), T(0)) == T(1));
    REQUIRE(cascade_blend(T(1), T(2), nan_of<T>) == T(0));
}

TEMPLATE_TEST_CASE("the range of the samples is that of the sorted ones", "[cascades]", float,
                   double) {
    REQUIRE(rc::check("sorted", [] {
        using T = TestType;
        std::vector<T> depths;
        std::vector<T> good;
        const int count = *rc::gen::inRange(0, 60);
        for (int i = 0; i < count; ++i) {
            depths.push_back(coin() ? any_number<T>() : log_between<T>(1e-3, 1e3));
            if (std::isfinite(depths.back()) && depths.back() > T(0)) {
                good.push_back(depths.back());
            }
        }
        const sample_range_result<T> range = sample_range(std::span<const T>(depths));
        RC_ASSERT(range.counted == good.size());
        RC_ASSERT(any(range.flags, status::empty_importance) == good.empty());
        RC_ASSERT(any(range.flags, status::samples_rejected) == (good.size() < depths.size()));
        if (!good.empty()) {
            RC_ASSERT(range.nearest == *std::min_element(good.begin(), good.end()));
            RC_ASSERT(range.farthest == *std::max_element(good.begin(), good.end()));
        }
    }));
}

TEMPLATE_TEST_CASE("each cascade's map holds its slice and keeps its texels", "[cascades]", float,
                   double) {
    REQUIRE(rc::check("slices", [] {
        using T = TestType;
        using vec3 = glm::vec<3, T>;
        const vec3 eye = any_direction<T>(0.1, 10.0);
        const auto camera =
            make_frustum(eye, any_direction<T>(1.0, 1.0), any_direction<T>(1.0, 1.0),
                         perspective_volume(T(1), T(1.5), T(0.5), T(500)))
                .value;
        const light<T> source = sun(any_direction<T>(1.0, 1.0));
        const box3<T> scene{vec3(T(-100)), vec3(T(100))};
        cascade_options<T> options;
        options.overlap = T(0.1);
        options.shadow_distance = T(60);
        options.fit.map_size = 256;
        options.fit.clip = clip::opengl;
        std::array<T, 5> splits{};
        std::array<cascade<T>, 4> cascades{};
        const split_result result = fit_cascades(
            camera, source, scene, options, std::span<T>(splits), std::span<cascade<T>>(cascades));
        RC_ASSERT(result.flags == status::ok);
        RC_ASSERT(result.count == 4u);
        RC_ASSERT(splits[4] == T(60));
        for (std::size_t i = 0; i < 4; ++i) {
            const cascade<T>& each = cascades[i];
            RC_ASSERT(each.farthest == splits[i + 1]);
            RC_ASSERT(each.nearest <= splits[i]);
            RC_ASSERT(i == 0 || each.nearest < each.farthest);
            frustum<T> slice = camera;
            slice.volume.near_distance = each.nearest;
            slice.volume.far_distance = each.farthest;
            for (const auto& corner : frustum_corners(slice)) {
                const vec3 p = vec3(corner) + eye;
                const real4 clip = multiply(each.fit.matrix, {p.x, p.y, p.z, real(1)});
                RC_ASSERT(abs(clip[0]) <= real(1) + 1e-4);
                RC_ASSERT(abs(clip[1]) <= real(1) + 1e-4);
            }
            if (i > 0) {
                RC_ASSERT(each.fit.texel > cascades[i - 1].fit.texel);
            }
        }
        // turned and moved: the same texels
        auto other = make_frustum(eye + any_direction<T>(1.0, 5.0), any_direction<T>(1.0, 1.0),
                                  any_direction<T>(1.0, 1.0), camera.volume)
                         .value;
        std::array<cascade<T>, 4> moved{};
        fit_cascades(other, source, scene, options, std::span<T>(splits),
                     std::span<cascade<T>>(moved));
        for (std::size_t i = 0; i < 4; ++i) {
            RC_ASSERT(moved[i].fit.texel == cascades[i].fit.texel);
        }
    }));
    using T = TestType;
    std::array<T, 3> splits{};
    std::array<cascade<T>, 4> cascades{};
    REQUIRE(fit_cascades(frustum<T>{}, sun(glm::vec<3, T>(T(0), T(-1), T(0))), box3<T>{},
                         cascade_options<T>{}, std::span<T>(splits),
                         std::span<cascade<T>>(cascades))
                .flags == status::buffer_too_small);
}
