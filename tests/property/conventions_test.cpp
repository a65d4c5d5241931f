// Properties of warpshadow/conventions.hpp.
//
// u is the unit roundoff of T. An entry of a projection matrix carries at most `entry_error` u:
// 1 for float (double arithmetic, one rounding), 3 for double (difference, quotient, product).
#include "camera.hpp"

#include <warpshadow/conventions.hpp>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

using namespace warpshadow;
using namespace camera_test;

namespace {

const double entry_error = 4.0; // 3, and what is of second order

/// A point inside the volume: distance along the view, offsets across it.
template <typename T> struct inside_point { T x, y, distance; };

template <typename T> inside_point<T> any_point(const view_volume<T>& v) {
    const double n = static_cast<double>(v.near_distance);
    const double f = static_cast<double>(v.far_distance);
    const double d = v.orthographic ? between<double>(n, f) : log_between<double>(n, f);
    const double a = between<double>(0.0, 1.0);
    const double b = between<double>(0.0, 1.0);
    const double reach = v.orthographic ? 1.0 : d;
    return inside_point<T>{static_cast<T>(reach * ((1.0 - a) * static_cast<double>(v.left) +
                                                   a * static_cast<double>(v.right))),
                           static_cast<T>(reach * ((1.0 - b) * static_cast<double>(v.bottom) +
                                                   b * static_cast<double>(v.top))),
                           glm::clamp(static_cast<T>(d), v.near_distance, v.far_distance)};
}

/// Exact ratio near / far of the projection, 0 for an infinite one.
template <typename T> real exact_ratio(const view_volume<T>& v, clip_space clip) {
    return clip.infinite_far || std::isinf(v.far_distance) ? real(0)
                                                           : real(v.near_distance) / v.far_distance;
}

/// Exact NDC depth of a distance.
template <typename T> real exact_depth(const view_volume<T>& v, clip_space clip, const real& d) {
    const real d0 = near_depth<double>(clip);
    const real d1 = far_depth<double>(clip);
    const real n = v.near_distance;
    if (v.orthographic) {
        return d0 + (d1 - d0) * (d - n) / (real(v.far_distance) - n);
    }
    const real r = exact_ratio(v, clip);
    return d0 + (d1 - d0) * (1 - n / d) / (1 - r);
}

} // namespace

TEMPLATE_TEST_CASE("peers 40: a point has one map position and one distance in every convention",
                   "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const bool orthographic = coin();
        const view_volume<T> v = any_volume<T>(orthographic, 1e7);
        const inside_point<T> p = any_point(v);
        const double u = roundoff<T>();
        const real reach = orthographic ? real(1) : real(p.distance);
        const real width = (real(v.right) - v.left) * reach;
        const real height = (real(v.top) - v.bottom) * reach;
        const real map_x = (real(p.x) - real(v.left) * reach) / width;
        const real map_y = (real(p.y) - real(v.bottom) * reach) / height;
        // terms of x_ndc and y_ndc, whose entries, products, sum and quotient are rounded
        const double terms_x =
            as_double((2 * abs(real(p.x)) + abs(real(v.right) + v.left) * reach) / abs(width));
        const double terms_y =
            as_double((2 * abs(real(p.y)) + abs(real(v.top) + v.bottom) * reach) / abs(height));
        const double bound_x = 0.5 * (entry_error + 4.0) * u * terms_x + 2.0 * u;
        const double bound_y = 0.5 * (entry_error + 4.0) * u * terms_y + 2.0 * u;
        for (const clip_space clip : all_conventions()) {
            const projection_result<T> made = make_projection(v, clip);
            RC_ASSERT(made.flags == status::ok);
            const T ahead = clip.left_handed ? p.distance : -p.distance;
            const glm::vec<4, T> q = made.matrix * glm::vec<4, T>(p.x, p.y, ahead, T(1));
            RC_ASSERT(q.w == (orthographic ? T(1) : p.distance));
            const glm::vec<2, T> map = map_from_ndc(glm::vec<2, T>(q) / q.w, clip);
            RC_ASSERT(std::abs(as_double(map.x - map_x)) <= bound_x);
            RC_ASSERT(std::abs(as_double(map.y - map_y)) <= bound_y);

            const T depth = q.z / q.w;
            const T distance = eye_depth_from_ndc(depth, v, clip);
            RC_ASSERT(distance >= v.near_distance);
            RC_ASSERT(distance <= v.far_distance);
            const double span = std::abs(far_depth<double>(clip) - near_depth<double>(clip));
            const double scale = std::abs(static_cast<double>(made.matrix[2][2]));
            const double offset = std::abs(static_cast<double>(made.matrix[3][2]));
            const double n = static_cast<double>(v.near_distance);
            const double f = static_cast<double>(v.far_distance);
            const double d = static_cast<double>(p.distance);
            const double error = std::abs(static_cast<double>(distance) - d);
            if (orthographic) {
                const double depth_error =
                    (entry_error + 4.0) * u * (scale * std::abs(d) + offset) / span;
                const double largest = std::max(std::abs(n), std::abs(f));
                RC_ASSERT(error <= depth_error * (f - n) + 8.0 * u * largest);
            } else {
                // n / d = to_near + to_far r, so that an error e of the depth share moves d by the
                // factor 1 / (1 - e (1 - r) d / n)
                const double r = as_double(exact_ratio(v, clip));
                const double depth_error = (entry_error + 4.0) * u * (scale + offset / d) / span;
                const double moved = depth_error * (1.0 - r) * d / n;
                if (moved < 0.5) {
                    RC_ASSERT(error <= d * (moved / (1.0 - moved) + 8.0 * u));
                } else {
                    // standard depth in float cannot tell such distances apart
                    RC_ASSERT(!(clip.reversed_z && clip.depth == depth_range::zero_to_one));
                }
            }
        }
    }));
}

TEMPLATE_TEST_CASE("entries of a projection are within their bound, however close near and far are",
                   "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const bool orthographic = coin();
        view_volume<T> v = any_volume<T>(orthographic, 1e7);
        if (coin()) {
            v.far_distance = v.near_distance +
                             (std::abs(v.near_distance) + T(1e-3)) * log_between<T>(1e-5, 1e-2);
        }
        const double bound = (std::numeric_limits<T>::digits == 24 ? 1.001 : 3.001) * roundoff<T>();
        const real n = v.near_distance;
        const real width = real(v.right) - v.left;
        const real height = real(v.top) - v.bottom;
        for (const clip_space clip : some_conventions(8)) {
            const glm::mat<4, 4, T> m = projection_matrix(v, clip);
            const auto is = [&](T entry, const real& expected) {
                return abs(entry - expected) <= bound * abs(expected);
            };
            const real ahead = clip.left_handed ? 1 : -1;
            const real down = clip.y_down ? -1 : 1;
            const real d0 = near_depth<double>(clip);
            const real d1 = far_depth<double>(clip);
            const real r = exact_ratio(v, clip);
            RC_ASSERT(is(m[0][0], 2 / width));
            RC_ASSERT(is(m[1][1], 2 * down / height));
            if (orthographic) {
                const real length = real(v.far_distance) - n;
                RC_ASSERT(is(m[3][0], -(real(v.right) + v.left) / width));
                RC_ASSERT(is(m[3][1], -down * (real(v.top) + v.bottom) / height));
                RC_ASSERT(is(m[2][2], ahead * (d1 - d0) / length));
                RC_ASSERT(is(m[3][2], (d0 * v.far_distance - d1 * n) / length));
                RC_ASSERT(m[2][3] == T(0));
                RC_ASSERT(m[3][3] == T(1));
            } else {
                RC_ASSERT(is(m[2][0], -ahead * (real(v.right) + v.left) / width));
                RC_ASSERT(is(m[2][1], -ahead * down * (real(v.top) + v.bottom) / height));
                RC_ASSERT(is(m[2][2], ahead * (d1 - d0 * r) / (1 - r)));
                RC_ASSERT(is(m[3][2], (d0 - d1) * n / (1 - r)));
                RC_ASSERT(m[2][3] == static_cast<T>(ahead));
                RC_ASSERT(m[3][3] == T(0));
            }
        }
    }));
}

TEMPLATE_TEST_CASE("near and far plane have the depths that the convention says", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const bool orthographic = coin();
        const view_volume<T> v = any_volume<T>(orthographic, 1e7);
        for (const clip_space clip : some_conventions(8)) {
            const glm::mat<4, 4, T> m = projection_matrix(v, clip);
            const bool endless = clip.infinite_far && !orthographic;
            for (int plane = 0; plane < 2; ++plane) {
                const real d = plane == 0 ? v.near_distance : v.far_distance;
                const real4 p{real(0), real(0), clip.left_handed ? d : real(-d), real(1)};
                const real4 q = multiply(m, p);
                const real4 terms = magnitudes(m, p);
                const real expected = plane == 0 ? real(near_depth<double>(clip))
                                      : endless  ? exact_depth(v, clip, d)
                                                 : real(far_depth<double>(clip));
                // only the entries are rounded
                RC_ASSERT(as_double(abs(q[2] / q[3] - expected)) <=
                          entry_error * roundoff<T>() * as_double(terms[2] / q[3]));
            }
            // the functions are exact at both ends
            RC_ASSERT(ndc_from_eye_depth(v.near_distance, v, clip) == near_depth<T>(clip));
            RC_ASSERT(eye_depth_from_ndc(near_depth<T>(clip), v, clip) == v.near_distance);
            RC_ASSERT(eye_depth_from_ndc(far_depth<T>(clip), v, clip) == v.far_distance);
        }
    }));
}

TEMPLATE_TEST_CASE("eye_depth_from_ndc is within 4 ulp of the exact distance of its depth", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const bool orthographic = coin();
        const view_volume<T> v = any_volume<T>(orthographic, 1e7);
        const double share = coin() ? between<double>(0.0, 1.0) : log_between<double>(1e-9, 1.0);
        for (const clip_space clip : all_conventions()) {
            const double d0 = near_depth<double>(clip);
            const double d1 = far_depth<double>(clip);
            const T depth = static_cast<T>(d1 + (d0 - d1) * share);
            const real to_near = (real(d1) - depth) / (real(d1) - d0);
            const T found = eye_depth_from_ndc(depth, v, clip);
            if (orthographic) {
                const real expected =
                    to_near * v.near_distance + (1 - to_near) * real(v.far_distance);
                const real largest = std::max(std::abs(v.near_distance), std::abs(v.far_distance));
                RC_ASSERT(abs(found - expected) <= 8 * real(roundoff<T>()) * largest);
            } else {
                const real ratio = to_near + (1 - to_near) * exact_ratio(v, clip);
                const real far_distance = v.far_distance;
                const real expected = ratio > 0 && v.near_distance / ratio < far_distance
                                          ? real(v.near_distance / ratio)
                                          : far_distance;
                RC_ASSERT(abs(found - expected) <= 8 * real(roundoff<T>()) * expected);
            }
        }
    }));
}

TEMPLATE_TEST_CASE("ndc_from_eye_depth is within its bound, and reversed 0..1 keeps distances", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const bool orthographic = coin();
        const view_volume<T> v = any_volume<T>(orthographic, 1e7);
        const inside_point<T> p = any_point(v);
        const double u = roundoff<T>();
        for (const clip_space clip : some_conventions(8)) {
            const T depth = ndc_from_eye_depth(p.distance, v, clip);
            const real expected = exact_depth(v, clip, real(p.distance));
            if (orthographic) {
                // the differences cancel at worst down to an ulp of the larger distance
                RC_ASSERT(as_double(abs(depth - expected)) <= 8.0 * u);
                continue;
            }
            const double c = as_double(1 / (1 - exact_ratio(v, clip)));
            RC_ASSERT(as_double(abs(depth - expected)) <= 8.0 * c * u);
            if (clip.reversed_z && clip.depth == depth_range::zero_to_one) {
                const T back = eye_depth_from_ndc(depth, v, clip);
                RC_ASSERT(as_double(abs(real(back) - p.distance)) <=
                          (12.0 * c + 8.0) * u * static_cast<double>(p.distance));
            }
        }
    }));
}

TEMPLATE_TEST_CASE("map and NDC positions are each other's inverse", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<2, T> map(between<T>(0.0, 1.0), between<T>(0.0, 1.0));
        for (const clip_space clip : all_conventions()) {
            const glm::vec<2, T> back = map_from_ndc(ndc_from_map(map, clip), clip);
            // 2x - 1 and x/2 + 1/2 round once each, to an ulp of a number below 1
            RC_ASSERT(std::abs(static_cast<double>(back.x) - static_cast<double>(map.x)) <=
                      1.5 * roundoff<T>());
            RC_ASSERT(std::abs(static_cast<double>(back.y) - static_cast<double>(map.y)) <=
                      1.5 * roundoff<T>());
        }
    }));
}

TEMPLATE_TEST_CASE("volumes are recovered from their matrices; B1: reversed 0..1 to 3u at any "
                   "ratio",
                   "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const bool orthographic = coin();
        const view_volume<T> v = any_volume<T>(orthographic, 1e7);
        const double u = roundoff<T>();
        const bool is_float = std::numeric_limits<T>::digits == 24;
        // two entries and the result are rounded; double adds the steps in between
        const double plain = is_float ? 3.001 : 11.0;
        const double n = static_cast<double>(v.near_distance);
        const double f = static_cast<double>(v.far_distance);
        for (const clip_space clip : all_conventions()) {
            const glm::mat<4, 4, T> m = projection_matrix(v, clip);
            const volume_result<T> found = volume_from_projection(m, clip);
            const view_volume<T>& w = found.volume;
            RC_ASSERT(w.orthographic == orthographic);
            const auto near_to = [](T a, T b, double bound) {
                return std::abs(static_cast<double>(a) - static_cast<double>(b)) <= bound;
            };
            const double x = static_cast<double>(std::max(std::abs(v.left), std::abs(v.right)));
            const double y = static_cast<double>(std::max(std::abs(v.bottom), std::abs(v.top)));
            RC_ASSERT(near_to(w.left, v.left, plain * u * x));
            RC_ASSERT(near_to(w.right, v.right, plain * u * x));
            RC_ASSERT(near_to(w.bottom, v.bottom, plain * u * y));
            RC_ASSERT(near_to(w.top, v.top, plain * u * y));
            if (orthographic) {
                RC_ASSERT(found.flags == status::ok);
                // (d - offset) / scale, offset and scale rounded
                const double span = std::abs(far_depth<double>(clip) - near_depth<double>(clip));
                const double bound =
                    plain * u *
                    (std::max(std::abs(n), std::abs(f)) +
                     (std::abs(static_cast<double>(m[3][2])) + 1.0) * (f - n) / span);
                RC_ASSERT(near_to(w.near_distance, v.near_distance, bound));
                RC_ASSERT(near_to(w.far_distance, v.far_distance, bound));
                continue;
            }
            RC_ASSERT(near_to(w.near_distance, v.near_distance, plain * u * n));
            if (clip.infinite_far) {
                RC_ASSERT(found.flags == status::ok);
                RC_ASSERT(std::isinf(w.far_distance));
            } else if (clip.reversed_z && clip.depth == depth_range::zero_to_one) {
                RC_ASSERT(found.flags == status::ok);
                RC_ASSERT(near_to(w.far_distance, v.far_distance, plain * u * f));
            } else {
                // d1 - scale cancels: an error of 1 u there is f / n u in the result, e, and
                // the distance is off by the factor 1 / (1 - e)
                const double e = plain * u * f / n;
                if (e < 0.5) {
                    RC_ASSERT(found.flags == status::ok);
                    RC_ASSERT(near_to(w.far_distance, v.far_distance, f * e / (1.0 - e)));
                }
            }
        }
    }));
}

TEMPLATE_TEST_CASE("a positive factor on a projection matrix changes nothing", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const view_volume<T> v = any_volume<T>(coin(), 1e3);
        const clip_space clip = any_convention();
        const glm::mat<4, 4, T> m = projection_matrix(v, clip);
        const volume_result<T> once = volume_from_projection(m, clip);
        const volume_result<T> twice = volume_from_projection(m * T(0.125), clip);
        RC_ASSERT(once.flags == twice.flags);
        RC_ASSERT(once.volume.left == twice.volume.left);
        RC_ASSERT(once.volume.top == twice.volume.top);
        RC_ASSERT(once.volume.near_distance == twice.volume.near_distance);
        RC_ASSERT(once.volume.far_distance == twice.volume.far_distance);
        const volume_result<T> backwards = volume_from_projection(m * T(-1), clip);
        RC_ASSERT(backwards.flags == status::invalid_input);
    }));
}

TEMPLATE_TEST_CASE("oblique depth planes: the volume holds the whole oblique frustum", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const bool orthographic = coin();
        const view_volume<T> v = any_volume<T>(orthographic, 100.0);
        const clip_space clip = any_convention();
        glm::mat<4, 4, T> m = projection_matrix(v, clip);
        const double reach = orthographic ? static_cast<double>(v.far_distance) -
                                                static_cast<double>(v.near_distance)
                                          : 1.0;
        const T slope = std::abs(m[2][2]) + T(1e-3);
        m[0][2] = between<T>(-0.1, 0.1) * slope / static_cast<T>(reach);
        m[1][2] = (between<T>(-0.1, 0.1) * slope + T(1e-6)) / static_cast<T>(reach);
        const volume_result<T> found = volume_from_projection(m, clip);
        RC_PRE(!any(found.flags, status::invalid_input));
        RC_ASSERT(any(found.flags, status::out_of_range));
        const double u = roundoff<T>();
        const real n = found.volume.near_distance;
        const real f = found.volume.far_distance;
        // points of the volume's own near and far plane are outside or on the oblique planes
        const real d0 = near_depth<double>(clip);
        const real d1 = far_depth<double>(clip);
        for (int corner = 0; corner < 4; ++corner) {
            const real sx = (corner & 1) != 0 ? v.right : v.left;
            const real sy = (corner & 2) != 0 ? v.top : v.bottom;
            for (int plane = 0; plane < 2; ++plane) {
                const real d = plane == 0 ? n : f;
                if (isinf(d)) {
                    continue;
                }
                const real k = orthographic ? real(1) : d;
                const real4 p{sx * k, sy * k, clip.left_handed ? d : real(-d), real(1)};
                const real4 q = multiply(m, p);
                const real4 terms = magnitudes(m, p);
                const real share = (q[2] / q[3] - d0) / (d1 - d0); // 0 near, 1 far
                // the bounds left, right, bottom, top of the matrix are themselves rounded
                const double slack = 32.0 * u * as_double((terms[2] / q[3] + 1) / abs(d1 - d0));
                if (plane == 0) {
                    RC_ASSERT(as_double(share) <= slack);
                } else {
                    RC_ASSERT(as_double(share) >= 1.0 - slack);
                }
            }
        }
    }));
}

TEMPLATE_TEST_CASE("powers of two scale a projection to the bit", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const view_volume<T> v = any_volume<T>(coin(), 1e5);
        const int k = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(-20, 21));
        const T s = std::ldexp(T(1), k);
        view_volume<T> scaled = v;
        scaled.near_distance *= s;
        scaled.far_distance *= s;
        if (v.orthographic) {
            scaled.left *= s;
            scaled.right *= s;
            scaled.bottom *= s;
            scaled.top *= s;
        }
        for (const clip_space clip : all_conventions()) {
            const glm::mat<4, 4, T> a = projection_matrix(v, clip);
            glm::mat<4, 4, T> b = projection_matrix(scaled, clip);
            if (v.orthographic) {
                b[0][0] *= s;
                b[1][1] *= s;
                b[2][2] *= s;
            } else {
                b[3][2] /= s;
            }
            RC_ASSERT(a == b);
            const volume_result<T> one = volume_from_projection(projection_matrix(v, clip), clip);
            const volume_result<T> other =
                volume_from_projection(projection_matrix(scaled, clip), clip);
            RC_ASSERT(one.volume.near_distance * s == other.volume.near_distance);
            RC_ASSERT(one.volume.far_distance * s == other.volume.far_distance);
        }
    }));
}

TEMPLATE_TEST_CASE("J11, peers 3: an infinite far plane is the limit of distant ones", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        view_volume<T> v = any_volume<T>(false, 1e3);
        view_volume<T> distant = v;
        distant.far_distance = v.near_distance * static_cast<T>(0x1p60);
        view_volume<T> endless = v;
        endless.far_distance = std::numeric_limits<T>::infinity();
        for (const clip_space clip : all_conventions()) {
            const glm::mat<4, 4, T> a = projection_matrix(endless, clip);
            const glm::mat<4, 4, T> b = projection_matrix(distant, clip);
            RC_ASSERT(a == projection_matrix(v, clip.infinite()));
            for (glm::length_t column = 0; column < 4; ++column) {
                for (glm::length_t row = 0; row < 4; ++row) {
                    // n / f = 2^-60, and one rounding
                    const double x = static_cast<double>(a[column][row]);
                    RC_ASSERT(std::abs(x - static_cast<double>(b[column][row])) <=
                              0x1p-58 + 2.0 * roundoff<T>() * std::abs(x));
                }
            }
            // depths between near and 1e6 near give the same distances
            const T d = v.near_distance * log_between<T>(1.0, 1e6);
            const T depth = ndc_from_eye_depth(d, endless, clip);
            const T one = eye_depth_from_ndc(depth, endless, clip);
            const T other = eye_depth_from_ndc(depth, distant, clip);
            if (std::isfinite(one)) {
                // each within 8u; n / d = 1e-6 or more is off by 2^-60
                RC_ASSERT(std::abs(static_cast<double>(one) - static_cast<double>(other)) <=
                          (16.0 * roundoff<T>() + 1e6 * 0x1p-60) * static_cast<double>(one));
            }
        }
    }));
}

TEMPLATE_TEST_CASE("a repaired volume needs no second repair", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const view_volume<T> v{any_number<T>(), any_number<T>(), any_number<T>(), any_number<T>(),
                               any_number<T>(), any_number<T>(), coin()};
        const clip_space clip = any_convention();
        const projection_result<T> made = make_projection(v, clip);
        RC_ASSERT(finite(made.matrix));
        RC_ASSERT(usable(made.volume));
        RC_ASSERT(made.flags == check_volume(v, clip));
        const bool neutral = made.matrix == identity<T>();
        if (any(made.flags, status::invalid_input)) {
            RC_ASSERT(neutral);
        } else if (made.flags == status::ok) {
            // nothing repaired means nothing changed
            RC_ASSERT(made.volume.left == v.left);
            RC_ASSERT(made.volume.top == v.top);
            RC_ASSERT(made.volume.near_distance == v.near_distance);
            RC_ASSERT(made.volume.far_distance == v.far_distance);
        }
        if (!neutral) {
            const status again = check_volume(made.volume, clip);
            RC_ASSERT((again == status::ok || again == status::unbounded));
        }
        const bool hopeless = std::isnan(v.left) || std::isnan(v.right) || std::isnan(v.bottom) ||
                              std::isnan(v.top) || std::isnan(v.near_distance) ||
                              std::isnan(v.far_distance) || std::isinf(v.near_distance);
        if (hopeless) {
            RC_ASSERT(made.flags == status::invalid_input);
        }
        // depth conversions of a checked volume are total
        const T depth = eye_depth_from_ndc(any_number<T>(), made.volume, clip);
        RC_ASSERT(depth >= made.volume.near_distance);
        RC_ASSERT(depth <= made.volume.far_distance);
        const T ndc = ndc_from_eye_depth(any_number<T>(), made.volume, clip);
        RC_ASSERT(ndc >= T(-1) - T(1e-6));
        RC_ASSERT(ndc <= T(1) + T(1e-6));
    }));
}

TEMPLATE_TEST_CASE("volume_from_projection is total", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const clip_space clip = any_convention();
        glm::mat<4, 4, T> m(T(0));
        if (coin()) {
            // a matrix of the right shape with up to three entries replaced
            m = projection_matrix(any_volume<T>(coin(), 1e4), clip);
            for (int k = 0; k < 3; ++k) {
                const auto column = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 4));
                const auto row = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 4));
                m[column][row] = any_number<T>();
            }
        } else {
            for (glm::length_t i = 0; i < 16; ++i) {
                m[i / 4][i % 4] = any_number<T>();
            }
        }
        const volume_result<T> found = volume_from_projection(m, clip);
        RC_ASSERT(usable(found.volume));
        if (!finite(m)) {
            RC_ASSERT(found.flags == status::invalid_input);
        }
    }));
}

TEMPLATE_TEST_CASE("peers 9: fields of view up to 179.9 degrees and any aspect", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const T fov = between<T>(1e-3, 3.14);
        const T aspect = log_between<T>(0.05, 20.0);
        const view_volume<T> v = perspective_volume(fov, aspect, T(1), T(10));
        // tan loses what the angle lacks: |dy| = |d(fov)| (1 + y^2) / 2, nothing here as fov is
        // given; y is within 1 ulp of the tangent, x within 2
        const real y = tan(real(fov) / 2);
        RC_ASSERT(abs(v.top - y) <= 4 * real(roundoff<T>()) * y);
        RC_ASSERT(abs(v.right - y * aspect) <= 4 * real(roundoff<T>()) * y * aspect);
        RC_ASSERT(v.left == -v.right);
        RC_ASSERT(v.bottom == -v.top);
        RC_ASSERT(check_volume(v, clip::opengl) == status::ok);
    }));
}

TEMPLATE_TEST_CASE("peers 7: a pinhole camera shows its pixels where they are", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        const glm::vec<2, T> focal(between<T>(200, 2000), between<T>(200, 2000));
        const glm::vec<2, T> size(between<T>(300, 4000), between<T>(300, 4000));
        const glm::vec<2, T> centre(size.x * between<T>(0.2, 0.8), size.y * between<T>(0.2, 0.8));
        const view_volume<T> v = pinhole_volume(focal, centre, size, T(0.1), T(100));
        const glm::vec<2, T> pixel(size.x * between<T>(0, 1), size.y * between<T>(0, 1));
        const T d = between<T>(0.1, 100);
        // the ray of a pixel, rows downwards
        const T x = (pixel.x - centre.x) / focal.x * d;
        const T y = (centre.y - pixel.y) / focal.y * d;
        const glm::vec<4, T> q =
            projection_matrix(v, clip::opengl) * glm::vec<4, T>(x, y, -d, T(1));
        const glm::vec<2, T> map = map_from_ndc(glm::vec<2, T>(q) / q.w, clip::opengl);
        // x, the two bounds, entries, products, sum and quotient; every term is below 4 / (width /
        // size) = 4
        const double bound = 64.0 * roundoff<T>();
        RC_ASSERT(std::abs(static_cast<double>(map.x - pixel.x / size.x)) <= bound);
        RC_ASSERT(std::abs(static_cast<double>(T(1) - map.y - pixel.y / size.y)) <= bound);
    }));
}
