// Inputs of the geometry benchmarks: many sets, so that no branch can be learnt by heart.
#pragma once

#include <warpshadow/frustum.hpp>
#include <warpshadow/polytope.hpp>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace geometry_inputs {

using point_set = std::vector<glm::vec2>;

struct scene {
    std::array<glm::vec4, 8> corners;
    std::array<glm::vec4, 6> planes;
    warpshadow::box3<float> box;
    glm::vec3 light_right, light_up; // axes of the light plane
};

class numbers {
  public:
    explicit numbers(std::uint64_t seed) : bits_(seed) {}
    double operator()(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
    }
    glm::dvec3 direction() {
        glm::dvec3 d;
        do {
            d = {(*this)(-1.0, 1.0), (*this)(-1.0, 1.0), (*this)(-1.0, 1.0)};
        } while (glm::dot(d, d) < 0.01 || glm::dot(d, d) > 1.0);
        return glm::normalize(d);
    }

  private:
    std::mt19937_64 bits_;
};

/// Cameras that look at a box, from inside it or from near it; the two always meet.
inline std::vector<scene> scenes(std::size_t count) {
    numbers random(1);
    std::vector<scene> result;
    while (result.size() < count) {
        scene s;
        const auto volume = warpshadow::perspective_volume(
            static_cast<float>(random(0.4, 1.6)), static_cast<float>(random(1.0, 2.0)),
            static_cast<float>(random(0.05, 1.0)), static_cast<float>(random(5.0, 30.0)));
        const auto camera = warpshadow::make_frustum(glm::vec3(0.0f), glm::vec3(random.direction()),
                                                     glm::vec3(0.0f, 1.0f, 0.0f), volume);
        s.corners = warpshadow::frustum_corners(camera.value);
        s.planes = warpshadow::frustum_planes(camera.value);
        const glm::dvec3 middle = random(0.0, 8.0) * random.direction();
        const glm::dvec3 half(random(1.0, 8.0), random(1.0, 8.0), random(1.0, 8.0));
        s.box = {glm::vec3(middle - half), glm::vec3(middle + half)};
        const glm::dvec3 light = random.direction();
        const glm::dvec3 right = glm::normalize(glm::cross(light, random.direction()));
        s.light_right = glm::vec3(right);
        s.light_up = glm::vec3(glm::cross(right, light));
        if (warpshadow::intersection(s.corners, s.box).count != 0) {
            result.push_back(s);
        }
    }
    return result;
}

/// What the fit of a shadow map sees: vertices of view and scene in the light plane, 8 to 16.
inline std::vector<point_set> bodies(std::size_t count) {
    std::vector<point_set> result;
    for (const scene& s : scenes(3 * count)) {
        const auto body = warpshadow::intersection(s.corners, s.box);
        if (body.count < 8 || body.count > 16) {
            continue;
        }
        point_set points;
        for (std::size_t i = 0; i < body.count; ++i) {
            const glm::vec3 p(body.vertices[i]);
            points.push_back({glm::dot(p, s.light_right), glm::dot(p, s.light_up)});
        }
        result.push_back(points);
        if (result.size() == count) {
            break;
        }
    }
    return result;
}

/// Uniform in a sheared ellipse, or on its rim.
inline std::vector<point_set> ellipses(std::size_t count, std::size_t size, bool rim) {
    numbers random(size);
    std::vector<point_set> result(count);
    for (point_set& set : result) {
        const double flat = random(0.3, 1.0);
        const double shear = random(-0.5, 0.5);
        for (std::size_t i = 0; i < size; ++i) {
            const double angle = random(0.0, 2.0 * std::numbers::pi);
            const double radius = rim ? 1.0 : std::sqrt(random(0.0, 1.0));
            const double x = 10.0 * radius * std::cos(angle);
            const double y = flat * 10.0 * radius * std::sin(angle) + shear * x;
            set.push_back({static_cast<float>(x), static_cast<float>(y)});
        }
    }
    return result;
}

} // namespace geometry_inputs
