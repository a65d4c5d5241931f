// What a fragment computes: its place on a paraboloid and its bias.
#include "kernels.hpp"

#include <warpshadow/bias.hpp>
#include <warpshadow/paraboloid.hpp>

#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace ws = warpshadow;

namespace arithmetic::ARITHMETIC_BUILD {

namespace {

template <typename T>
void add_paraboloid(entries& to, const paraboloid_case& in, const std::string& type) {
    using vec2 = glm::vec<2, T>;
    using vec3 = glm::vec<3, T>;
    const auto own =
        std::make_shared<std::vector<vec3>>(in.directions.begin(), in.directions.end());
    const auto add = [&](const std::string& variant, auto project) {
        add_each(
            to, "paraboloid", in.envelope, type + variant, own->size(),
            [own, project](std::size_t i) { return project((*own)[i]); },
            [&in](std::size_t i, const vec2& uv) {
                const wide2& truth = in.uv[i];
                const double length = std::hypot(truth.x.hi, truth.y.hi);
                const double away =
                    std::hypot(off(double(uv.x), truth.x), off(double(uv.y), truth.y));
                return 0x1p23 * away / length;
            });
    };
    add(", xy / (1 + z) of the unit vector", [](const vec3& p) {
        const vec3 d = glm::normalize(p);
        return vec2(d.x, d.y) / (T(1) + d.z);
    });
    add(", xy / (|p| + z)", [](const vec3& p) { return vec2(p.x, p.y) / (glm::length(p) + p.z); });
    add(", `paraboloid_uv`", [](const vec3& p) { return ws::paraboloid_uv(p, 0); });
}

template <typename T> void add_bias(entries& to, const bias_case& in, const std::string& type) {
    struct receiver {
        glm::vec<3, T> normal;
        glm::mat<2, 2, T> jacobian;
    };
    const auto own = std::make_shared<std::vector<receiver>>();
    for (std::size_t i = 0; i < in.normals.size(); ++i) {
        own->push_back({glm::vec<3, T>(in.normals[i]), glm::mat<2, 2, T>(in.jacobians[i])});
    }
    auto settings = ws::settings_for(glm::vec<2, T>(T(map_size)), T(0));
    settings.largest = T(1e6); // errors of the formula, not of its clamp
    const auto error = [&in](std::size_t i, T found) {
        return float_ulps(double(found), in.bias[i]);
    };
    add_each(
        to, "footprint bias", in.envelope, type + ", `footprint_bias`", own->size(),
        [own, settings](std::size_t i) {
            return ws::footprint_bias((*own)[i].normal, (*own)[i].jacobian, settings).value;
        },
        error);
    add_each(
        to, "footprint bias", in.envelope, type + ", inverse matrix", own->size(),
        [own, settings](std::size_t i) {
            const receiver& r = (*own)[i];
            const glm::vec<2, T> slope(-r.normal.x / r.normal.z, -r.normal.y / r.normal.z);
            const glm::vec<2, T> texel = slope * glm::inverse(r.jacobian) * settings.texel.x;
            return T(0.5) * (std::abs(texel.x) + std::abs(texel.y));
        },
        error);
}

} // namespace

void add_fragments(entries& to) {
    for (const paraboloid_case& in : paraboloid_cases()) {
        add_paraboloid<float>(to, in, "float");
        add_paraboloid<double>(to, in, "double");
    }
    for (const bias_case& in : bias_cases()) {
        add_bias<float>(to, in, "float");
        add_bias<double>(to, in, "double");
    }
}

} // namespace arithmetic::ARITHMETIC_BUILD
