// Pairs of frusta by class, on which intersection tests are known to go wrong; for tests and bench.
#pragma once

#include <warpshadow/cube.hpp>
#include <warpshadow/frustum.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string_view>

namespace frustum_pairs {

template <typename T> struct pair { warpshadow::frustum<T> a, b; };

struct kind {
    std::string_view name;
    bool touching; ///< all pairs touch or overlap by construction
};

inline constexpr std::array<kind, 13> kinds{{
    {"random", false},
    {"view and cube face", false},
    {"thin piercing", false},
    {"shared apex", false},
    {"adjacent faces of one light", true},
    {"coplanar splits", true},
    {"tiles sharing a plane", true},
    {"offset 1e4 to 1e6", false},
    {"near 1e-4 far 1e5", false},
    {"vertex on vertex, edge, face", false},
    {"infinite far plane", false},
    {"orthographic", false},
    {"flat, thin, empty volumes", false},
}};

/// How often a test repeats: `n` times, or a share of that where nothing is optimised, which is
/// where sanitizers run. WARPSHADOW_TEST_SCALE multiplies it.
inline int iterations(int n, int share = 8) {
#if !defined(__OPTIMIZE__)
    n = n / share;
#else
    static_cast<void>(share);
#endif
    const char* text = std::getenv("WARPSHADOW_TEST_SCALE");
    return text != nullptr ? n * std::atoi(text) : n;
}

/// Random numbers without the distributions of the standard library, which differ between versions.
/// The order in which arguments are drawn is still the compiler's.
class random {
  public:
    explicit random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    double log_uniform(double lo, double hi) {
        return std::exp(uniform(std::log(lo), std::log(hi)));
    }
    int integer(int lo, int hi) {
        return lo + static_cast<int>(engine_() % static_cast<std::uint64_t>(hi - lo + 1));
    }
    template <typename T> glm::vec<3, T> in_cube(double size) {
        return glm::vec<3, T>(T(uniform(-size, size)), T(uniform(-size, size)),
                              T(uniform(-size, size)));
    }

  private:
    std::mt19937_64 engine_;
};

template <typename T> warpshadow::frustum<T> any_axes(random& r) {
    const auto made = warpshadow::make_frustum(
        glm::vec<3, T>(T(0)), r.in_cube<T>(1.0), r.in_cube<T>(1.0),
        warpshadow::view_volume<T>{T(-1), T(1), T(-1), T(1), T(1), T(2), false});
    return made.value;
}

template <typename T>
warpshadow::frustum<T> any_view(random& r, double spread, double near0, double near1, double far0,
                                double far1) {
    warpshadow::frustum<T> f = any_axes<T>(r);
    f.eye = r.in_cube<T>(spread);
    f.volume =
        warpshadow::perspective_volume(T(r.uniform(0.4, 1.6)), T(r.uniform(1.0, 2.0)),
                                       T(r.log_uniform(near0, near1)), T(r.uniform(far0, far1)));
    return f;
}

template <typename T>
warpshadow::frustum<T> any_face(random& r, const glm::vec<3, T>& light, T near_distance,
                                T far_distance) {
    return warpshadow::face_camera(light, r.integer(0, 5), warpshadow::cube_api::opengl,
                                   near_distance, far_distance)
        .value;
}

/// Frustum whose corners are small multiples of 1/32, exactly representable, along the axes.
template <typename T> warpshadow::frustum<T> dyadic_view(random& r) {
    const int first = r.integer(0, 2);
    const int second = (first + r.integer(1, 2)) % 3;
    const int third = 3 - first - second;
    glm::vec<3, T> axes[3] = {glm::vec<3, T>(T(0)), glm::vec<3, T>(T(0)), glm::vec<3, T>(T(0))};
    axes[0][first] = r.integer(0, 1) == 0 ? T(1) : T(-1);
    axes[1][second] = r.integer(0, 1) == 0 ? T(1) : T(-1);
    axes[2][third] = r.integer(0, 1) == 0 ? T(1) : T(-1);
    const auto number = [&r](int lo, int hi) { return T(r.integer(lo, hi)) * T(0.25); };
    const bool orthographic = r.integer(0, 3) == 0;
    return warpshadow::frustum<T>{
        glm::vec<3, T>(number(-8, 8), number(-8, 8), number(-8, 8)), axes[0], axes[1], axes[2],
        warpshadow::view_volume<T>{number(-6, -1), number(1, 6), number(-6, -1), number(1, 6),
                                   number(1, 4), number(5, 24), orthographic}};
}

template <typename T> glm::vec<3, T> point_on(const warpshadow::frustum<T>& f, T x, T y, T z) {
    // position within the volume, each coordinate 0 to 1; exact for dyadic views
    const auto& v = f.volume;
    const T distance = v.near_distance + z * (v.far_distance - v.near_distance);
    const T scale = v.orthographic ? T(1) : distance;
    const T across = (v.left + x * (v.right - v.left)) * scale;
    const T upwards = (v.bottom + y * (v.top - v.bottom)) * scale;
    return f.eye + across * f.right + upwards * f.up + distance * f.forward;
}

template <typename T> pair<T> make_pair(std::size_t kind, random& r) {
    using warpshadow::frustum;
    const T infinity = std::numeric_limits<T>::infinity();
    pair<T> p{any_view<T>(r, 20.0, 0.05, 1.0, 5.0, 30.0),
              any_view<T>(r, 20.0, 0.05, 1.0, 5.0, 30.0)};
    switch (kind) {
    case 0:
        break;
    case 1:
        p.b = any_face(r, r.in_cube<T>(20.0), T(0.1), T(25));
        break;
    case 2: {
        // aimed at a point inside the other, or beside it
        const bool inside = r.integer(0, 1) == 0;
        const T x = inside ? T(r.uniform(0.2, 0.8)) : T(r.uniform(0.99, 1.4));
        const T y = inside ? T(r.uniform(0, 1)) : T(r.uniform(0.99, 1.4));
        const glm::vec<3, T> target = point_on(p.a, x, y, T(r.uniform(0, 1)));
        const T slope = T(r.log_uniform(1e-7, 1e-3));
        p.b = warpshadow::make_frustum(
                  p.b.eye, target - p.b.eye, r.in_cube<T>(1.0),
                  warpshadow::view_volume<T>{-slope, slope, -slope, slope, T(0.01), T(100), false})
                  .value;
        break;
    }
    case 3:
        p.b = any_face(r, p.a.eye, r.integer(0, 3) == 0 ? p.a.volume.near_distance : T(0.1), T(25));
        if (r.integer(0, 9) == 0) {
            p.a.volume.near_distance = T(0);
            p.b.volume.near_distance = T(0);
        }
        break;
    case 4: {
        const glm::vec<3, T> light = r.in_cube<T>(r.log_uniform(1.0, 1e6));
        p.a = any_face(r, light, T(0.1), T(25));
        const glm::vec<3, T> axis = p.a.forward;
        do {
            p.b = any_face(r, light, T(0.1), T(25));
        } while (p.b.forward == -axis);
        break;
    }
    case 5:
        p.b = p.a;
        p.a.volume.far_distance = T(r.uniform(1.0, 5.0));
        p.b.volume.near_distance = p.a.volume.far_distance;
        break;
    case 6:
        p.b = p.a;
        p.a.volume.right = T(r.uniform(-0.3, 0.3)) * p.a.volume.right;
        p.b.volume.left = p.a.volume.right;
        break;
    case 7: {
        const glm::vec<3, T> away = r.in_cube<T>(r.log_uniform(1e4, 1e6));
        p.a.eye += away;
        p.b.eye += away;
        break;
    }
    case 8:
        p = pair<T>{any_view<T>(r, 1e5, 1e-4, 1.0001e-4, 1e5, 1.0001e5),
                    any_view<T>(r, 1e5, 1e-4, 1.0001e-4, 1e5, 1.0001e5)};
        break;
    case 9: {
        p = pair<T>{dyadic_view<T>(r), dyadic_view<T>(r)};
        // halves are points inside edges and faces, 0 and 1 corners
        const auto place = [&r] { return T(r.integer(0, 2)) * T(0.5); };
        const glm::vec<3, T> on_a = point_on(p.a, place(), place(), place());
        const glm::vec<3, T> on_b =
            point_on(p.b, T(r.integer(0, 1)), T(r.integer(0, 1)), T(r.integer(0, 1)));
        p.b.eye += on_a - on_b;
        if (r.integer(0, 2) == 0) {
            // off by one step, apart or not
            const int axis = r.integer(0, 2);
            p.b.eye[axis] =
                std::nextafter(p.b.eye[axis], r.integer(0, 1) == 0 ? infinity : -infinity);
        }
        break;
    }
    case 10:
        p.a.volume.far_distance = infinity;
        if (r.integer(0, 1) == 0) {
            p.b.volume.far_distance = infinity;
        }
        break;
    case 11: {
        const T size = T(r.uniform(1.0, 6.0));
        p.a.volume = warpshadow::view_volume<T>{
            -size, size, T(-2), T(5), T(-1), r.integer(0, 4) == 0 ? infinity : T(30), true};
        if (r.integer(0, 2) == 0) {
            p.b.volume = warpshadow::view_volume<T>{T(-3), T(3), T(-3), T(3), T(0), T(20), true};
        }
        break;
    }
    default: {
        const int what = r.integer(0, 3);
        if (what == 0) {
            p.a.volume.near_distance = p.a.volume.far_distance;
        } else if (what == 1) {
            p.a.volume.left = p.a.volume.right;
        } else if (what == 2) {
            p.a.volume.left = p.a.volume.right;
            p.a.volume.bottom = p.a.volume.top;
        } else {
            p.a.volume.left = -T(1e-7);
            p.a.volume.right = T(1e-7);
            p.a.volume.bottom = T(1e-7);
            p.a.volume.top = T(2e-7);
        }
        // so that about half of them meet
        p.b.eye = point_on(p.a, T(0.5), T(0.5), T(r.uniform(0, 1))) + r.in_cube<T>(5.0);
        break;
    }
    }
    return p;
}

} // namespace frustum_pairs
