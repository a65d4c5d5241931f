// n_opt and the matrix of LiSPSM.
#include "kernels.hpp"
#include "naive_lispsm.hpp"

#include <warpshadow/lispsm.hpp>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ws = warpshadow;

namespace arithmetic::ARITHMETIC_BUILD {

namespace {

/// 1 / n of one input in T, by one of the forms in use.
enum class form { dot_2004, cross_2006, library };

template <typename T, form F> T inverse_near(const near_case& in, std::size_t i) {
    const glm::vec<3, T> view(in.view[i]);
    const glm::vec<3, T> light(in.light[i]);
    const T z0 = T(in.z0[i]);
    const T d = T(in.extent[i]);
    if constexpr (F == form::dot_2004) {
        const T cosine = glm::dot(view, light);
        const T sine = std::sqrt(T(1) - cosine * cosine);
        return T(1) / ((z0 + std::sqrt(z0 * (z0 + d * sine))) / sine);
    } else {
        const T sine = glm::length(glm::cross(view, light));
        const T z1 = z0 + d * sine;
        if constexpr (F == form::cross_2006) {
            return T(1) / (d / (std::sqrt(z1 / z0) - T(1)));
        } else {
            return ws::inverse_n_opt(z0, z1, sine);
        }
    }
}

template <typename T> void add_near(entries& to, const near_case& in, const std::string& type) {
    const auto error = [&in](std::size_t i, T found) {
        return float_ulps(double(found), in.inverse_near[i]);
    };
    const auto add = [&](const std::string& variant, auto each) {
        add_each(to, "n_opt", in.envelope, type + variant, in.z0.size(), each, error);
    };
    add(", sine from the dot product",
        [&in](std::size_t i) { return inverse_near<T, form::dot_2004>(in, i); });
    add(", d / (√(z1/z0) - 1)",
        [&in](std::size_t i) { return inverse_near<T, form::cross_2006>(in, i); });
    add(", `inverse_n_opt`",
        [&in](std::size_t i) { return inverse_near<T, form::library>(in, i); });
}

struct no_fade {
    double operator()(double) const { return 1.0; }
};

/// Farthest that the matrix puts a point from where it belongs; along the warp's axis alone for
/// the naive matrix, which turns the map about the light its own way.
template <typename T>
double texels_off(const light_scene<T>& scene, const glm::mat<4, 4, T>& matrix, bool axis_alone) {
    double worst = 0.0;
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        const glm::vec<4, T> clip =
            matrix *
            glm::vec<4, T>(axis_alone ? scene.camera.eye + scene.points[i] : scene.points[i], T(1));
        const double x = double(clip.x / clip.w);
        const double y = double(clip.y / clip.w);
        const double error = axis_alone
                                 ? std::abs(off(0.5 * y + 0.5, scene.along[i]))
                                 : 0.5 * std::hypot(off(x, scene.ndc[i].x), off(y, scene.ndc[i].y));
        if (!std::isfinite(error)) {
            return error;
        }
        worst = std::max(worst, error);
    }
    return map_size * worst;
}

template <typename T>
void add_matrix(entries& to, const light_case<T>& in, const std::string& type) {
    add_each(
        to, "light matrix", in.envelope, type + ", naive, world space", in.scenes.size(),
        [&in](std::size_t i) {
            const light_scene<T>& s = in.scenes[i];
            return naive_lispsm::matrix(s.camera, s.direction, s.body, false);
        },
        [&in](std::size_t i, const glm::mat<4, 4, T>& m) {
            return texels_off(in.scenes[i], m, true);
        });
    add_each(
        to, "light matrix", in.envelope, type + ", `lispsm`", in.scenes.size(),
        [&in](std::size_t i) {
            const light_scene<T>& s = in.scenes[i];
            return ws::lispsm<T>(s.camera, ws::sun(s.direction), s.body, ws::clip::opengl, {},
                                 no_fade{})
                .matrix;
        },
        [&in](std::size_t i, const glm::mat<4, 4, T>& m) {
            return texels_off(in.scenes[i], m, false);
        });
}

} // namespace

void add_light(entries& to) {
    for (const near_case& in : near_cases()) {
        add_near<float>(to, in, "float");
        add_near<double>(to, in, "double");
    }
    for (const auto& in : light_cases()) {
        add_matrix(to, in, "float");
    }
    for (const auto& in : wide_light_cases()) {
        add_matrix(to, in, "double");
    }
}

} // namespace arithmetic::ARITHMETIC_BUILD
