// Plain cases of warpshadow/conventions.hpp: the presets, GLM as a second opinion, and each repair.
#include "../camera.hpp"

#include <warpshadow/conventions.hpp>

#include <catch2/catch.hpp>
#include <glm/ext/matrix_clip_space.hpp>

#include <cmath>
#include <limits>
#include <string>

using namespace warpshadow;
using camera_test::identity;
using camera_test::roundoff;

namespace {

template <typename T> constexpr T infinity = std::numeric_limits<T>::infinity();
template <typename T> constexpr T nan_of = std::numeric_limits<T>::quiet_NaN();

/// Largest difference of two matrices in u of the larger entry.
template <typename T>
double distance_in_u(const glm::mat<4, 4, T>& a, const glm::mat<4, 4, double>& b) {
    double worst = 0.0;
    for (glm::length_t column = 0; column < 4; ++column) {
        for (glm::length_t row = 0; row < 4; ++row) {
            const double x = static_cast<double>(a[column][row]);
            const double y = b[column][row];
            if (x != y) {
                worst = std::max(worst, std::abs(x - y) / std::max(std::abs(x), std::abs(y)));
            }
        }
    }
    return worst / roundoff<T>();
}

template <typename T> view_volume<T> volume_of(T l, T r, T b, T t, T n, T f, bool orthographic) {
    return view_volume<T>{l, r, b, t, n, f, orthographic};
}

} // namespace

TEST_CASE("presets are what the APIs say") {
    static_assert(near_depth<float>(clip::opengl) == -1.0f);
    static_assert(far_depth<float>(clip::opengl) == 1.0f);
    static_assert(near_depth<float>(clip::vulkan) == 0.0f);
    static_assert(far_depth<float>(clip::vulkan) == 1.0f);
    static_assert(near_depth<double>(clip::d3d.reversed()) == 1.0);
    static_assert(far_depth<double>(clip::d3d.reversed()) == 0.0);
    static_assert(near_depth<double>(clip::opengl.reversed()) == 1.0);
    static_assert(far_depth<double>(clip::opengl.reversed()) == -1.0);
    static_assert(!clip::opengl.left_handed && !clip::vulkan.left_handed && clip::d3d.left_handed);
    static_assert(!clip::opengl.y_down && clip::vulkan.y_down && !clip::d3d.y_down);
    static_assert(clip::vulkan.infinite().infinite_far && !clip::vulkan.infinite_far);
    static_assert(clip::vulkan.infinite().infinite() == clip::vulkan.infinite());
    static_assert(clip::vulkan.reversed().reversed() == clip::vulkan);
    static_assert(clip::vulkan.reversed().infinite() == clip::vulkan.infinite().reversed());
    SUCCEED();
}

TEMPLATE_TEST_CASE("GLM builds the same matrices", "", float, double) {
    using T = TestType;
    // GLM takes lengths on the near plane: halves, so that nothing is rounded on the way
    const double n = 0.5;
    const double f = 96.0;
    const double l = -0.75;
    const double r = 1.25;
    const double b = -0.375;
    const double t = 0.625;
    const view_volume<T> perspective =
        volume_of(T(l / n), T(r / n), T(b / n), T(t / n), T(n), T(f), false);
    const view_volume<T> orthographic = volume_of(T(l), T(r), T(b), T(t), T(n), T(f), true);
    const clip_space no = clip::opengl;
    const clip_space zo{depth_range::zero_to_one};
    clip_space no_lh = no;
    no_lh.left_handed = true;
    // an ulp each for GLM and for us, in T; GLM's are in double
    const double bound = 4.0;
    CHECK(distance_in_u(projection_matrix(perspective, no), glm::frustumRH_NO(l, r, b, t, n, f)) <=
          bound);
    CHECK(distance_in_u(projection_matrix(perspective, zo), glm::frustumRH_ZO(l, r, b, t, n, f)) <=
          bound);
    // left-handed view space is z negated; GLM 0.9.9's frustumLH is not that off centre: it puts
    // the corner (l, b, n) at NDC ((3l + r) / (r - l), ...) instead of (-1, -1)
    glm::mat<4, 4, double> z_ahead_no = glm::frustumRH_NO(l, r, b, t, n, f);
    glm::mat<4, 4, double> z_ahead_zo = glm::frustumRH_ZO(l, r, b, t, n, f);
    z_ahead_no[2] = -z_ahead_no[2];
    z_ahead_zo[2] = -z_ahead_zo[2];
    CHECK(distance_in_u(projection_matrix(perspective, no_lh), z_ahead_no) <= bound);
    CHECK(distance_in_u(projection_matrix(perspective, clip::d3d), z_ahead_zo) <= bound);
    const glm::vec<4, T> corner =
        projection_matrix(perspective, clip::d3d) * glm::vec<4, T>(T(l), T(b), T(n), T(1));
    CHECK(corner == glm::vec<4, T>(T(-n), T(-n), T(0), T(n)));
    CHECK(distance_in_u(projection_matrix(orthographic, no), glm::orthoRH_NO(l, r, b, t, n, f)) <=
          bound);
    CHECK(distance_in_u(projection_matrix(orthographic, zo), glm::orthoRH_ZO(l, r, b, t, n, f)) <=
          bound);
    CHECK(distance_in_u(projection_matrix(orthographic, no_lh),
                        glm::orthoLH_NO(l, r, b, t, n, f)) <= bound);
    CHECK(distance_in_u(projection_matrix(orthographic, clip::d3d),
                        glm::orthoLH_ZO(l, r, b, t, n, f)) <= bound);
    // reversed depth is the other distance first
    CHECK(distance_in_u(projection_matrix(perspective, zo.reversed()),
                        glm::frustumRH_ZO(l / n * f, r / n * f, b / n * f, t / n * f, f, n)) <=
          bound);
    // y down is the second row negated
    const glm::mat<4, 4, T> up = projection_matrix(perspective, zo);
    const glm::mat<4, 4, T> down = projection_matrix(perspective, clip::vulkan);
    for (glm::length_t column = 0; column < 4; ++column) {
        for (glm::length_t row = 0; row < 4; ++row) {
            CHECK(down[column][row] == (row == 1 ? -up[column][row] : up[column][row]));
        }
    }
}

TEMPLATE_TEST_CASE("GLM builds the same symmetric and infinite matrices", "", float, double) {
    using T = TestType;
    const T fov = T(1);
    const T aspect = T(1.5);
    const view_volume<T> v = perspective_volume(fov, aspect, T(0.25), T(64));
    const double fov_d = static_cast<double>(fov);
    // the slopes are rounded once more
    CHECK(distance_in_u(projection_matrix(v, clip::opengl),
                        glm::perspectiveRH_NO(fov_d, 1.5, 0.25, 64.0)) <= 8.0);
    CHECK(distance_in_u(projection_matrix(v, clip::d3d),
                        glm::perspectiveLH_ZO(fov_d, 1.5, 0.25, 64.0)) <= 8.0);
    CHECK(distance_in_u(projection_matrix(v, clip::opengl.infinite()),
                        glm::infinitePerspective(fov_d, 1.5, 0.25)) <= 8.0);
}

TEMPLATE_TEST_CASE("map space has its origin left and bottom, whichever way y points", "", float,
                   double) {
    using T = TestType;
    using vec2 = glm::vec<2, T>;
    CHECK(map_from_ndc(vec2(T(-1), T(-1)), clip::opengl) == vec2(T(0), T(0)));
    CHECK(map_from_ndc(vec2(T(1), T(1)), clip::opengl) == vec2(T(1), T(1)));
    CHECK(map_from_ndc(vec2(T(-1), T(1)), clip::vulkan) == vec2(T(0), T(0)));
    CHECK(map_from_ndc(vec2(T(1), T(-1)), clip::vulkan) == vec2(T(1), T(1)));
    CHECK(map_from_ndc(vec2(T(0), T(0)), clip::vulkan) == vec2(T(0.5), T(0.5)));
    CHECK(ndc_from_map(vec2(T(0), T(0)), clip::vulkan) == vec2(T(-1), T(1)));
    CHECK(ndc_from_map(vec2(T(1), T(1)), clip::d3d) == vec2(T(1), T(1)));
    const vec2 lost = map_from_ndc(vec2(nan_of<T>, infinity<T>), clip::opengl);
    CHECK(std::isnan(lost.x));
    CHECK(lost.y == infinity<T>);
}

TEMPLATE_TEST_CASE("depths: known values, ends, and what lies beyond", "", float, double) {
    using T = TestType;
    const view_volume<T> v = volume_of(T(-1), T(1), T(-1), T(1), T(1), T(4), false);
    const clip_space zo = clip::d3d;
    // (1 - 1/2) / (1 - 1/4) = 2/3
    CHECK(ndc_from_eye_depth(T(2), v, zo) == Approx(2.0 / 3.0).epsilon(8.0 * roundoff<T>()));
    CHECK(eye_depth_from_ndc(T(0.5), v, clip::opengl.infinite()) == T(4)); // 4, and no farther
    CHECK(eye_depth_from_ndc(T(0), v, clip::opengl.infinite()) == T(2));
    for (const clip_space clip : camera_test::all_conventions()) {
        const T beyond = far_depth<T>(clip) + (far_depth<T>(clip) - near_depth<T>(clip));
        const T before = near_depth<T>(clip) - (far_depth<T>(clip) - near_depth<T>(clip));
        CHECK(eye_depth_from_ndc(beyond, v, clip) == T(4));
        CHECK(eye_depth_from_ndc(before, v, clip) == T(1));
        CHECK(eye_depth_from_ndc(nan_of<T>, v, clip) == T(4));
        CHECK(ndc_from_eye_depth(T(-5), v, clip) == near_depth<T>(clip));
        CHECK(ndc_from_eye_depth(nan_of<T>, v, clip) == near_depth<T>(clip));
        CHECK(ndc_from_eye_depth(infinity<T>, v, clip) == ndc_from_eye_depth(T(4), v, clip));
        view_volume<T> endless = v;
        endless.far_distance = infinity<T>;
        CHECK(eye_depth_from_ndc(far_depth<T>(clip), endless, clip) == infinity<T>);
        CHECK(ndc_from_eye_depth(infinity<T>, endless, clip) == far_depth<T>(clip));
    }
}

TEMPLATE_TEST_CASE("J9, peers 4: a near distance of zero or less is raised", "", float, double) {
    using T = TestType;
    for (const T n : {T(0), T(-0.0), T(-1), T(-1e20)}) {
        const view_volume<T> v = volume_of(T(-1), T(1), T(-1), T(1), n, T(1024), false);
        const projection_result<T> made = make_projection(v, clip::opengl);
        CHECK(made.flags == status::near_clamped);
        CHECK(made.volume.near_distance == T(0x1p-10));
    }
    const view_volume<T> tiny = volume_of(T(-1), T(1), T(-1), T(1), T(1e-6), T(1e6), false);
    CHECK(check_volume(tiny, clip::opengl) == status::ok);
    // nothing to take a length from
    const view_volume<T> lost = volume_of(T(-1), T(1), T(-1), T(1), T(0), infinity<T>, false);
    const projection_result<T> made = make_projection(lost, clip::opengl);
    CHECK(made.flags == status::invalid_input);
    CHECK(made.matrix == identity<T>());
    // an orthographic volume may begin anywhere
    const view_volume<T> behind = volume_of(T(-1), T(1), T(-1), T(1), T(-8), T(8), true);
    CHECK(check_volume(behind, clip::opengl) == status::ok);
}

TEMPLATE_TEST_CASE("distances in the wrong order are exchanged, equal ones separated", "", float,
                   double) {
    using T = TestType;
    const view_volume<T> swapped = volume_of(T(-1), T(1), T(-1), T(1), T(100), T(1), false);
    const projection_result<T> a = make_projection(swapped, clip::opengl);
    CHECK(a.flags == status::out_of_range);
    CHECK(a.volume.near_distance == T(1));
    CHECK(a.volume.far_distance == T(100));
    const view_volume<T> flat = volume_of(T(-1), T(1), T(-1), T(1), T(3), T(3), false);
    const projection_result<T> b = make_projection(flat, clip::opengl);
    CHECK(b.flags == status::degenerate_extent);
    CHECK(b.volume.far_distance == T(3) + T(3 * 0x1p-20));
    const view_volume<T> line = volume_of(T(2), T(2), T(-1), T(1), T(1), T(3), false);
    const projection_result<T> c = make_projection(line, clip::opengl);
    CHECK(c.flags == status::degenerate_extent);
    CHECK(c.volume.right - c.volume.left == T(2 * 0x1p-19));
    const view_volume<T> point = volume_of(T(0), T(0), T(0), T(0), T(0), T(0), true);
    CHECK(check_volume(point, clip::opengl) == status::invalid_input);
    CHECK(check_volume(view_volume<T>{}, clip::opengl) == status::invalid_input);
}

TEMPLATE_TEST_CASE("reversed or infinite orthographic projections", "", float, double) {
    using T = TestType;
    const view_volume<T> v = volume_of(T(-2), T(2), T(-1), T(1), T(-4), T(4), true);
    for (const clip_space clip : camera_test::all_conventions()) {
        // no far plane at infinity where the volume has one nearer
        clip_space finite = clip;
        finite.infinite_far = false;
        const projection_result<T> made = make_projection(v, clip);
        CHECK(made.flags == status::ok);
        CHECK(made.matrix == projection_matrix(v, finite));
        const T ahead = clip.left_handed ? T(1) : T(-1);
        const glm::vec<4, T> nearest =
            made.matrix * glm::vec<4, T>(T(0), T(0), T(-4) * ahead, T(1));
        const glm::vec<4, T> farthest =
            made.matrix * glm::vec<4, T>(T(0), T(0), T(4) * ahead, T(1));
        CHECK(nearest.z == near_depth<T>(clip));
        CHECK(farthest.z == far_depth<T>(clip));

        view_volume<T> endless = v;
        endless.far_distance = infinity<T>;
        const projection_result<T> limit = make_projection(endless, clip);
        CHECK(limit.flags == status::unbounded);
        const glm::vec<4, T> q =
            limit.matrix * glm::vec<4, T>(T(1), T(0.5), T(12345) * ahead, T(1));
        CHECK(q ==
              glm::vec<4, T>(T(0.5), clip.y_down ? T(-0.5) : T(0.5), near_depth<T>(clip), T(1)));
        CHECK(volume_from_projection(limit.matrix, clip).flags == status::not_invertible);
    }
}

TEMPLATE_TEST_CASE("values that are no volume", "", float, double) {
    using T = TestType;
    const T bad[] = {nan_of<T>, infinity<T>, -infinity<T>};
    for (int member = 0; member < 6; ++member) {
        for (const T value : bad) {
            for (const bool orthographic : {false, true}) {
                view_volume<T> v = volume_of(T(-1), T(1), T(-1), T(1), T(1), T(2), orthographic);
                T* const members[] = {&v.left, &v.right,         &v.bottom,
                                      &v.top,  &v.near_distance, &v.far_distance};
                *members[member] = value;
                CAPTURE(member, value, orthographic);
                const projection_result<T> made = make_projection(v, clip::opengl);
                const bool endless = member == 5 && value > T(0);
                if (!endless) {
                    CHECK(made.flags == status::invalid_input);
                    CHECK(made.matrix == identity<T>());
                } else {
                    CHECK(made.flags == (orthographic ? status::unbounded : status::ok));
                }
            }
        }
    }
    for (const T fov : {T(0), T(-1), T(3.15), T(7), nan_of<T>, infinity<T>}) {
        const view_volume<T> v = perspective_volume(fov, T(1), T(1), T(2));
        CHECK(check_volume(v, clip::opengl) == status::invalid_input);
    }
    for (const T aspect : {T(0), T(-1), nan_of<T>, infinity<T>}) {
        const view_volume<T> v = perspective_volume(T(1), aspect, T(1), T(2));
        CHECK(check_volume(v, clip::opengl) == status::invalid_input);
    }
    // too large for T
    const T largest = std::numeric_limits<T>::max();
    const view_volume<T> wide = volume_of(-largest, largest, T(-1), T(1), T(1), T(2), true);
    CHECK(make_projection(wide, clip::opengl).flags == status::out_of_range);
}

TEMPLATE_TEST_CASE("matrices that are no view volume", "", float, double) {
    using T = TestType;
    const view_volume<T> v = volume_of(T(-1), T(1), T(-1), T(1), T(1), T(10), false);
    const glm::mat<4, 4, T> m = projection_matrix(v, clip::opengl);
    CHECK(volume_from_projection(glm::mat<4, 4, T>(T(0)), clip::opengl).flags ==
          status::not_invertible);
    glm::mat<4, 4, T> rotated = m; // pre-rotation of a phone's display
    rotated[0] = glm::vec<4, T>(T(0), T(1), T(0), T(0));
    rotated[1] = glm::vec<4, T>(T(-1), T(0), T(0), T(0));
    CHECK(volume_from_projection(rotated, clip::opengl).flags == status::invalid_input);
    glm::mat<4, 4, T> moved = m; // a stereo offset that is not in the view matrix
    moved[3][0] = T(0.1);
    CHECK(volume_from_projection(moved, clip::opengl).flags == status::invalid_input);
    CHECK(volume_from_projection(m, clip::d3d).flags == status::invalid_input); // the other hand
    glm::mat<4, 4, T> broken = m;
    broken[1][1] = nan_of<T>;
    CHECK(volume_from_projection(broken, clip::opengl).flags == status::invalid_input);
    // reversed depth that was not said to be reversed
    const glm::mat<4, 4, T> reversed = projection_matrix(v, clip::opengl.reversed());
    const volume_result<T> put_right = volume_from_projection(reversed, clip::opengl);
    CHECK(put_right.flags == status::out_of_range);
    CHECK(put_right.volume.near_distance == Approx(1.0).epsilon(8.0 * roundoff<T>()));
    CHECK(put_right.volume.far_distance == Approx(10.0).epsilon(80.0 * roundoff<T>()));
    // Lengyel's far plane a little beyond infinity
    glm::mat<4, 4, T> beyond = projection_matrix(v, clip::opengl.infinite());
    beyond[2][2] += T(1e-3);
    const volume_result<T> endless = volume_from_projection(beyond, clip::opengl);
    CHECK(endless.flags == status::out_of_range);
    CHECK(endless.volume.far_distance == infinity<T>);
}

TEMPLATE_TEST_CASE("J12: standard and reversed depth give the same camera, given double matrices",
                   "", float, double) {
    using T = TestType;
    for (const double ratio : {1e2, 1e4, 1e6}) {
        const view_volume<double> v = volume_of(-0.7, 0.9, -0.4, 0.5, 0.1, 0.1 * ratio, false);
        const clip_space zo{depth_range::zero_to_one};
        const auto standard = volume_from_projection(projection_matrix(v, zo), zo).volume;
        const auto reversed =
            volume_from_projection(projection_matrix(v, zo.reversed()), zo.reversed()).volume;
        // 4 ulp of T, and what standard depth loses in double: 8u far / near
        const double bound = 8.0 * roundoff<T>() + 8.0 * roundoff<double>() * ratio;
        CHECK(std::abs(standard.near_distance / reversed.near_distance - 1.0) <= bound);
        CHECK(std::abs(standard.far_distance / reversed.far_distance - 1.0) <= bound);
        CHECK(std::abs(standard.left / reversed.left - 1.0) <= bound);
    }
}

TEST_CASE("B1, J10: what a float matrix of standard depth still knows of its far plane") {
    // the law stated for volume_from_projection: about u far / near; nothing above 2^24
    for (const double ratio : {1e2, 1e4, 1e6, 1e7}) {
        const view_volume<float> v =
            volume_of(-1.0f, 1.0f, -1.0f, 1.0f, 0.1f, static_cast<float>(0.1 * ratio), false);
        const glm::mat<4, 4, float> standard = projection_matrix(v, clip::opengl);
        const glm::mat<4, 4, float> reversed = projection_matrix(v, clip::d3d.reversed());
        const auto a = volume_from_projection(standard, clip::opengl);
        const auto b = volume_from_projection(reversed, clip::d3d.reversed());
        const double f = static_cast<double>(v.far_distance);
        const double off = std::abs(static_cast<double>(a.volume.far_distance) / f - 1.0);
        const double e = 3.001 * roundoff<float>() * ratio;
        CAPTURE(ratio, off);
        if (e < 0.5) {
            CHECK(off <= e / (1.0 - e));
        }
        CHECK(std::abs(static_cast<double>(b.volume.far_distance) / f - 1.0) <=
              3.001 * roundoff<float>());
    }
    const view_volume<float> v = volume_of(-1.0f, 1.0f, -1.0f, 1.0f, 1.0f, 0x1p26f, false);
    const glm::mat<4, 4, float> m = projection_matrix(v, clip::opengl);
    CHECK(std::isinf(volume_from_projection(m, clip::opengl).volume.far_distance));
}
