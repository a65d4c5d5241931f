// Views and lights at all angles, and where LiSPSM puts their points in 100 digits.
#include "exact_map.hpp"
#include "frustum_pairs.hpp"
#include "inputs.hpp"
#include "lispsm_oracle.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace arithmetic {

namespace {

using frustum_pairs::random;

constexpr std::size_t near_count = 4096;
constexpr std::size_t scene_count = 48;

struct range {
    double lo, hi;
};

/// Two unit vectors with an angle between them, rounded.
std::array<glm::vec3, 2> at_angle(random& r, double gamma) {
    const auto frame = frustum_pairs::any_axes<double>(r);
    return {glm::vec3(frame.forward),
            glm::vec3(std::cos(gamma) * frame.forward + std::sin(gamma) * frame.up)};
}

template <typename T> light_scene<T> make_scene(const lispsm_test::configuration& c) {
    const lispsm_test::scene<T> s = lispsm_test::make_scene<T>(c);
    light_scene<T> made{s.camera, s.direction, s.body, s.body, {}, {}};
    made.points.insert(made.points.end(), s.points.begin(), s.points.end());
    const lispsm_test::oracle oracle(s.camera, s.direction, std::span<const glm::vec<3, T>>(s.body),
                                     false);
    for (const auto& p : made.points) {
        const auto ndc = oracle.ndc(camera_test::exact(p));
        made.ndc.push_back({to_wide(ndc[0]), to_wide(ndc[1])});
    }
    for (const real& t : lispsm_test::textbook_positions<T>(s, made.points)) {
        made.along.push_back(to_wide(t));
    }
    return made;
}

template <typename T> std::vector<light_case<T>> make_lights() {
    random r(5);
    std::vector<light_case<T>> cases;
    const auto add = [&](const std::string& name, range gamma, range ratio, range distance) {
        light_case<T> each{name, {}};
        for (std::size_t i = 0; i < scene_count; ++i) {
            const double angle = r.log_uniform(gamma.lo, gamma.hi);
            const double far_by_near = r.log_uniform(ratio.lo, ratio.hi);
            each.scenes.push_back(
                make_scene<T>({angle, far_by_near, r.log_uniform(distance.lo, distance.hi)}));
        }
        cases.push_back(each);
    };
    add("wide angle", {0.5, 1.5}, {1e1, 1e2}, {1e-3, 1.0});
    add("typical", {0.1, 1.5}, {1e2, 1e4}, {1e1, 1e4});
    add("light along the view", {1e-5, 1e-2}, {1e3, 1e7}, {1e1, 1e6});
    return cases;
}

} // namespace

const std::vector<near_case>& near_cases() {
    static const std::vector<near_case> made = [] {
        random r(4);
        std::vector<near_case> cases;
        const auto add = [&](const std::string& name, range gamma, range ratio) {
            near_case each{name, {}, {}, {}, {}, {}};
            for (std::size_t i = 0; i < near_count; ++i) {
                const auto [view, light] = at_angle(r, r.log_uniform(gamma.lo, gamma.hi));
                const auto z0 = static_cast<float>(r.log_uniform(0.1, 10.0));
                const auto d = static_cast<float>(double(z0) * r.log_uniform(ratio.lo, ratio.hi));
                using namespace camera_test;
                const real3 v = camera_test::exact(view);
                const real3 l = camera_test::exact(light);
                const real sine = camera_test::length(cross(v, l));
                const real n = (z0 + sqrt(real(z0) * (z0 + d * sine))) / sine;
                each.view.push_back(view);
                each.light.push_back(light);
                each.z0.push_back(z0);
                each.extent.push_back(d);
                each.inverse_near.push_back(to_wide(1 / n));
            }
            cases.push_back(each);
        };
        add("wide angle", {0.5, 1.57}, {1.0, 1e3});
        add("small angle", {1e-3, 0.5}, {1e-2, 1e4});
        add("light along the view", {1e-6, 1e-3}, {1e-2, 1e4});
        return cases;
    }();
    return made;
}

const std::vector<light_case<float>>& light_cases() {
    static const auto made = make_lights<float>();
    return made;
}

const std::vector<light_case<double>>& wide_light_cases() {
    static const auto made = make_lights<double>();
    return made;
}

} // namespace arithmetic
