// Properties of warpshadow/metric.hpp.
//
// The oracle carries points of the map along their light rays to the receiver's plane and from
// there to the image, in 100 digits, and takes differences: it knows no gradient.
#include "camera.hpp"

#include <warpshadow/frustum.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/metric.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

using namespace warpshadow;
using namespace camera_test;

namespace {

template <typename T> using T3 = glm::vec<3, T>;

template <typename T> constexpr T largest = std::numeric_limits<T>::max();

/// A light, a camera, and a receiver in the middle of both.
template <typename T> struct view_of_a_receiver {
    glm::mat<4, 4, T> light{T(1)};
    glm::mat<4, 4, T> camera{T(1)};
    glm::vec<3, T> point{T(0)};
    glm::vec<3, T> normal{T(0)};
    glm::vec<2, T> texels{T(0)};
    glm::vec<2, T> pixels{T(0)};
};

template <typename T> view_of_a_receiver<T> any_view() {
    using vec3 = glm::vec<3, T>;
    view_of_a_receiver<T> view;
    const T scale = log_between<T>(1e-3, 1e3);
    const vec3 point = any_direction<T>(0.1, 2.0) * scale;
    const vec3 to_eye = any_direction<T>(1.0, 30.0);
    const clip_space clip = clip::opengl;
    const auto eye = make_frustum(point + to_eye * scale, -to_eye + any_direction<T>(0.001, 0.2),
                                  any_direction<T>(1.0, 1.0),
                                  perspective_volume(T(1), T(1.5), T(0.1) * scale, T(100) * scale))
                         .value;
    view.camera = make_projection(eye.volume, clip).matrix * view_matrix(eye, clip);
    if (coin()) {
        const box3<T> box{vec3(T(-10) * scale), vec3(T(10) * scale)};
        view.light = directional_light_matrix(sun(any_direction<T>(1.0, 1.0)), box, clip).matrix;
    } else {
        const vec3 to_light = any_direction<T>(3.0, 20.0) * scale;
        view.light =
            spot_light_matrix(
                spot_light(point + to_light, point + any_direction<T>(0.01, 0.5) * scale, T(1)),
                T(0.1) * scale, T(100) * scale, clip)
                .matrix;
    }
    view.point = point;
    view.normal = any_direction<T>(0.01, 100.0);
    view.texels = {log_between<T>(64, 4096), log_between<T>(64, 4096)};
    view.pixels = {log_between<T>(64, 4096), log_between<T>(64, 4096)};
    return view;
}

/// Inverse of a matrix of T, by Gauss-Jordan with pivots.
template <typename T> std::array<real4, 4> inverse_rows(const glm::mat<4, 4, T>& m) {
    std::array<std::array<real, 8>, 4> rows{};
    for (std::size_t r = 0; r < 4; ++r) {
        for (std::size_t c = 0; c < 4; ++c) {
            rows[r][c] = real(m[static_cast<glm::length_t>(c)][static_cast<glm::length_t>(r)]);
        }
        rows[r][4 + r] = 1;
    }
    for (std::size_t c = 0; c < 4; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c; r < 4; ++r) {
            pivot = abs(rows[r][c]) > abs(rows[pivot][c]) ? r : pivot;
        }
        std::swap(rows[c], rows[pivot]);
        const real by = rows[c][c];
        for (real& each : rows[c]) {
            each /= by;
        }
        for (std::size_t r = 0; r < 4; ++r) {
            const real factor = r == c ? real(0) : rows[r][c];
            for (std::size_t k = 0; k < 8; ++k) {
                rows[r][k] -= factor * rows[c][k];
            }
        }
    }
    std::array<real4, 4> result{};
    for (std::size_t r = 0; r < 4; ++r) {
        for (std::size_t c = 0; c < 4; ++c) {
            result[r][c] = rows[r][4 + c];
        }
    }
    return result;
}

/// Where texels of the map lie in the image, by rays.
template <typename T> class ray_oracle {
  public:
    explicit ray_oracle(const view_of_a_receiver<T>& view)
        : view_(view), world_(inverse_rows(view.light)) {
        const real4 clip = multiply(view.light, point(exact(view.point)));
        at_ = {clip[0] / clip[3], clip[1] / clip[3]};
        ray_ = unit(minus(unprojected(at_[0], at_[1], real(1)), unprojected(at_[0], at_[1], 0)));
    }

    [[nodiscard]] real3 ray() const { return ray_; }

    /// Pixels per texel along u and v, for a receiver with this normal.
    [[nodiscard]] std::array<std::array<real, 2>, 2> per_texel(const real3& normal) const {
        const real step("1e-40");
        std::array<std::array<real, 2>, 2> columns{};
        for (std::size_t k = 0; k < 2; ++k) {
            // ndc runs over two units where the map runs over one
            const real by = 2 * step / real(view_.texels[static_cast<glm::length_t>(k)]);
            const auto forwards = pixel(k == 0 ? by : real(0), k == 1 ? by : real(0), normal);
            const auto backwards = pixel(k == 0 ? -by : real(0), k == 1 ? -by : real(0), normal);
            columns[k] = {(forwards[0] - backwards[0]) / (2 * step),
                          (forwards[1] - backwards[1]) / (2 * step)};
        }
        return columns;
    }

  private:
    static real4 point(const real3& p) { return {p[0], p[1], p[2], real(1)}; }

    [[nodiscard]] real3 unprojected(const real& x, const real& y, const real& z) const {
        real4 p{};
        for (std::size_t r = 0; r < 4; ++r) {
            p[r] = world_[r][0] * x + world_[r][1] * y + world_[r][2] * z + world_[r][3];
        }
        return {p[0] / p[3], p[1] / p[3], p[2] / p[3]};
    }

    /// Pixel of the receiver's point at a place of the map beside that of the point itself.
    [[nodiscard]] std::array<real, 2> pixel(const real& du, const real& dv,
                                            const real3& normal) const {
        const real3 a = unprojected(at_[0] + du, at_[1] + dv, real(0));
        const real3 b = unprojected(at_[0] + du, at_[1] + dv, real(1));
        const real3 along = minus(b, a);
        const real t = dot(normal, minus(exact(view_.point), a)) / dot(normal, along);
        const real4 clip = multiply(view_.camera, point(sum(a, times(t, along))));
        return {real(view_.pixels.x) * clip[0] / clip[3] / 2,
                real(view_.pixels.y) * clip[1] / clip[3] / 2};
    }

    view_of_a_receiver<T> view_;
    std::array<real4, 4> world_;
    std::array<real, 2> at_{};
    real3 ray_{};
};

real length2(const std::array<real, 2>& a) {
    return sqrt(a[0] * a[0] + a[1] * a[1]);
}

/// Larger singular value from the eigenvalues of the Gram matrix.
real largest_singular_value(const std::array<std::array<real, 2>, 2>& m) {
    const real uu = m[0][0] * m[0][0] + m[0][1] * m[0][1];
    const real vv = m[1][0] * m[1][0] + m[1][1] * m[1][1];
    const real uv = m[0][0] * m[1][0] + m[0][1] * m[1][1];
    const real half = (uu - vv) / 2;
    return sqrt((uu + vv) / 2 + sqrt(half * half + uv * uv));
}

template <typename T> texel_axes<T> axes_of(const view_of_a_receiver<T>& view) {
    return texel_axes_at(view.light, glm::mat<2, 2, T>(T(1)), view.point, T(1) / view.texels);
}

} // namespace

TEMPLATE_TEST_CASE("the extent on a surface is that of rays through neighbouring texels",
                   "[metric]", float, double) {
    REQUIRE(rc::check("rays", [] {
        using T = TestType;
        const auto view = any_view<T>();
        const ray_oracle<T> oracle(view);
        const real3 n = exact(view.normal);
        const double facing = as_double(abs(dot(unit(n), oracle.ray())));
        RC_PRE(facing > 1e-3);
        const auto expected = oracle.per_texel(n);
        const texel_extent<T> extent =
            surface_extent(axes_of(view), image_gradients_at(view.camera, view.point, view.pixels),
                           view.normal, largest<T>);
        const double m = as_double(largest_singular_value(expected));
        // Positions are rounded to an ulp of the view's distance, thirty units at most over a
        // tenth of one; the direction of the ray is lost by as much, which a slope magnifies.
        const double bound = 4096.0 * roundoff<T>() / facing;
        RC_ASSERT(std::abs(static_cast<double>(extent.largest) - m) <= bound * m);
        RC_ASSERT(std::abs(static_cast<double>(extent.u) - as_double(length2(expected[0]))) <=
                  bound * m);
        RC_ASSERT(std::abs(static_cast<double>(extent.v) - as_double(length2(expected[1]))) <=
                  bound * m);
    }));
}

TEMPLATE_TEST_CASE("the extent that faces both is that of a receiver across both", "[metric]",
                   float, double) {
    REQUIRE(rc::check("light beside the eye", [] {
        using T = TestType;
        // eye and light in one direction: a surface that faces one faces the other
        auto view = any_view<T>();
        const glm::vec<3, T> toward = any_direction<T>(5.0, 20.0);
        const auto eye = make_frustum(view.point + toward, -toward, any_direction<T>(1.0, 1.0),
                                      perspective_volume(T(1), T(1.5), T(0.1), T(100)))
                             .value;
        view.camera = make_projection(eye.volume, clip::opengl).matrix *
                      view_matrix(eye, clip::opengl, view.point);
        view.light =
            directional_light_matrix(
                sun(-toward), box3<T>{glm::vec<3, T>(T(-10)), glm::vec<3, T>(T(10))}, clip::opengl)
                .matrix;
        view.point = glm::vec<3, T>(T(0));
        view.pixels.x = view.pixels.y * T(1.5); // square pixels: no direction is drawn out
        const image_gradients<T> image = image_gradients_at(view.camera, view.point, view.pixels);
        const texel_extent<T> facing = facing_extent(axes_of(view), image, largest<T>);
        const double m =
            as_double(largest_singular_value(ray_oracle<T>(view).per_texel(exact(toward))));
        RC_ASSERT(std::abs(static_cast<double>(facing.largest) - m) <= 1024.0 * roundoff<T>() * m);
    }));
}

TEMPLATE_TEST_CASE("a stretch is the longest image of a unit vector", "[metric]", float, double) {
    REQUIRE(rc::check("sweep", [] {
        using T = TestType;
        const auto a = any_direction<T>(1e-2, 1e2);
        const auto b = any_direction<T>(1e-2, 1e2);
        const double stretch = static_cast<double>(largest_stretch(a, b));
        double longest = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const double angle = 3.14159265358979323846 * i / 2000.0;
            longest = std::max(longest, glm::length(std::cos(angle) * glm::dvec3(a) +
                                                    std::sin(angle) * glm::dvec3(b)));
        }
        // the sweep misses the longest by less than half a step
        RC_ASSERT(stretch >= longest * (1.0 - 8.0 * roundoff<T>()));
        RC_ASSERT(stretch * std::cos(0.5 * 3.1415927 / 2000.0) <=
                  longest * (1.0 + 8.0 * roundoff<T>()));
    }));
    const T3<TestType> tiny(std::numeric_limits<TestType>::min() * TestType(4), TestType(0),
                            TestType(0));
    REQUIRE(largest_stretch(tiny, tiny * TestType(0)) == tiny.x);
    const T3<TestType> huge(TestType(0), largest<TestType> / TestType(4), TestType(0));
    REQUIRE(largest_stretch(huge, huge * TestType(0)) == huge.y);
    REQUIRE(largest_stretch(T3<TestType>(TestType(0)), T3<TestType>(TestType(0))) == TestType(0));
}

TEMPLATE_TEST_CASE("extents do not depend on the unit of length", "[metric]", float, double) {
    REQUIRE(rc::check("powers of two", [] {
        using T = TestType;
        const auto view = any_view<T>();
        texel_axes<T> axes = axes_of(view);
        image_gradients<T> image = image_gradients_at(view.camera, view.point, view.pixels);
        const texel_extent<T> before = surface_extent(axes, image, view.normal, largest<T>);
        const int power = *rc::gen::inRange(-60, 60);
        axes.u *= std::ldexp(T(1), power);
        axes.v *= std::ldexp(T(1), power);
        image.x *= std::ldexp(T(1), -power);
        image.y *= std::ldexp(T(1), -power);
        const texel_extent<T> after = surface_extent(axes, image, view.normal, largest<T>);
        RC_ASSERT(before.largest == after.largest);
        RC_ASSERT(before.u == after.u);
        RC_ASSERT(before.v == after.v);
        RC_ASSERT(facing_extent(axes, image, largest<T>).largest >= T(0));
    }));
}

TEMPLATE_TEST_CASE("extents are finite whatever comes in", "[metric]", float, double) {
    REQUIRE(rc::check("any numbers", [] {
        using T = TestType;
        const texel_axes<T> axes{any_numbers<T>(), any_numbers<T>()};
        const image_gradients<T> image{any_numbers<T>(), any_numbers<T>()};
        const T most = T(1e6);
        for (const texel_extent<T>& each : {facing_extent(axes, image, most),
                                            surface_extent(axes, image, any_numbers<T>(), most)}) {
            for (const T value : {each.u, each.v, each.largest}) {
                RC_ASSERT(value >= T(0));
                RC_ASSERT(value <= most);
            }
        }
        glm::mat<4, 4, T> camera(T(1));
        for (glm::length_t c = 0; c < 4; ++c) {
            for (glm::length_t r = 0; r < 4; ++r) {
                camera[c][r] = any_number<T>();
            }
        }
        const image_gradients<T> any =
            image_gradients_at(camera, any_numbers<T>(), glm::vec<2, T>(T(640), T(480)));
        RC_ASSERT(finite(any.x) && finite(any.y));
    }));
}

TEMPLATE_TEST_CASE("a receiver along the light and a point behind the eye have the largest extent",
                   "[metric]", float, double) {
    using T = TestType;
    const texel_axes<T> axes{T3<T>(T(0.5), T(0), T(0)), T3<T>(T(0), T(0.5), T(0))};
    const image_gradients<T> image{T3<T>(T(0), T(10), T(0)), T3<T>(T(0), T(0), T(10))};
    REQUIRE(surface_extent(axes, image, T3<T>(T(1), T(0), T(0)), T(1000)).largest == T(1000));
    // across the light: five pixels along v, and u runs along the view ray
    const texel_extent<T> across = surface_extent(axes, image, T3<T>(T(0), T(0), T(3)), T(1000));
    REQUIRE(across.largest == Approx(5.0));
    REQUIRE(across.v == Approx(5.0));
    REQUIRE(across.u == T(0));
    glm::mat<4, 4, T> camera =
        make_projection(perspective_volume(T(1), T(1), T(1), T(10)), clip::opengl).matrix;
    const image_gradients<T> behind =
        image_gradients_at(camera, T3<T>(T(0), T(0), T(5)), glm::vec<2, T>(T(640), T(480)));
    REQUIRE(behind.x == T3<T>(T(0)));
    REQUIRE(surface_extent(axes, behind, T3<T>(T(0), T(0), T(1)), T(1000)).largest == T(1000));
}

TEMPLATE_TEST_CASE("a summary is that of the sorted samples", "[metric]", float, double) {
    REQUIRE(rc::check("sorted", [] {
        using T = TestType;
        const auto count = static_cast<std::size_t>(*rc::gen::inRange(0, 400));
        std::vector<texel_extent<T>> extents;
        std::vector<T> sorted;
        T most_u(0);
        T most_v(0);
        for (std::size_t i = 0; i < count; ++i) {
            texel_extent<T> each{log_between<T>(0.01, 100), log_between<T>(0.01, 100), T(0)};
            each.largest = coin() ? std::max(each.u, each.v) : std::floor(each.u) + each.v;
            if (*rc::gen::inRange(0, 20) == 0) {
                each.largest = coin() ? std::numeric_limits<T>::quiet_NaN()
                                      : std::numeric_limits<T>::infinity();
            } else {
                sorted.push_back(each.largest);
                most_u = std::max(most_u, each.u);
                most_v = std::max(most_v, each.v);
            }
            extents.push_back(each);
        }
        const glm::vec<2, T> texels(T(512), T(256));
        const glm::vec<2, T> pixels(T(640), T(480));
        const metric_summary<T> summary =
            summarise(std::span<texel_extent<T>>(extents), texels, pixels);
        RC_ASSERT(summary.counted == sorted.size());
        RC_ASSERT(summary.rejected == count - sorted.size());
        RC_ASSERT(any(summary.flags, status::samples_rejected) == (sorted.size() < count));
        RC_ASSERT(any(summary.flags, status::empty_importance) == sorted.empty());
        if (sorted.empty()) {
            RC_ASSERT(summary.max == T(0) && summary.p50 == T(0) && summary.p99 == T(0));
            return;
        }
        std::sort(sorted.begin(), sorted.end());
        const auto not_above = [&](T m) {
            return static_cast<std::size_t>(std::upper_bound(sorted.begin(), sorted.end(), m) -
                                            sorted.begin());
        };
        for (const auto& [m, hundredths] :
             {std::pair(summary.p50, std::size_t(50)), std::pair(summary.p99, std::size_t(99))}) {
            RC_ASSERT(not_above(m) * 100 >= hundredths * sorted.size());
            const auto below = static_cast<std::size_t>(
                std::lower_bound(sorted.begin(), sorted.end(), m) - sorted.begin());
            RC_ASSERT(below * 100 < hundredths * sorted.size());
        }
        RC_ASSERT(summary.max == sorted.back());
        const double above = static_cast<double>(sorted.size() - not_above(T(1)));
        RC_ASSERT(summary.share_above_1 ==
                  static_cast<T>(above / static_cast<double>(sorted.size())));
        const double storage = 512.0 * 256.0 / (640.0 * 480.0) * static_cast<double>(most_u) *
                               static_cast<double>(most_v);
        RC_ASSERT(std::abs(static_cast<double>(summary.storage_factor) - storage) <=
                  4.0 * roundoff<T>() * storage);
    }));
}
