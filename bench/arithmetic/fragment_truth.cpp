// Directions on a paraboloid and receivers under a warp, in 100 digits.
#include "exact_map.hpp"
#include "frustum_pairs.hpp"
#include "inputs.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace arithmetic {

namespace {

using frustum_pairs::random;

constexpr std::size_t count = 8192;

glm::vec3 at_height(random& r, double z) {
    const double angle = r.uniform(0.0, 2.0 * std::numbers::pi);
    const double across = std::sqrt((1.0 - z) * (1.0 + z));
    const double length = r.log_uniform(0.1, 100.0);
    return glm::vec3(length * glm::dvec3(across * std::cos(angle), across * std::sin(angle), z));
}

wide2 exact_uv(const glm::vec3& p) {
    const real x = p.x;
    const real y = p.y;
    const real sum = sqrt(x * x + y * y + real(p.z) * p.z) + p.z;
    return {to_wide(x / sum), to_wide(y / sum)};
}

/// Footprint of the nearest texel: half the slopes along both texel axes, unwarped.
wide exact_bias(const glm::vec3& n, const glm::mat2& jacobian) {
    const real a = jacobian[0][0];
    const real b = jacobian[1][0];
    const real c = jacobian[0][1];
    const real d = jacobian[1][1];
    const real det = a * d - b * c;
    const real zx = -real(n.x) / n.z;
    const real zy = -real(n.y) / n.z;
    // columns of the inverse are the texel axes
    const real along_u = abs(real((zx * d - zy * c) / det));
    const real along_v = abs(real((zy * a - zx * b) / det));
    return to_wide((along_u + along_v) / (2 * real(map_size)));
}

} // namespace

const std::vector<paraboloid_case>& paraboloid_cases() {
    static const std::vector<paraboloid_case> made = [] {
        random r(6);
        std::vector<paraboloid_case> cases;
        const auto add = [&](const std::string& name, auto height) {
            paraboloid_case each{name, {}, {}};
            for (std::size_t i = 0; i < count; ++i) {
                each.directions.push_back(at_height(r, height()));
                each.uv.push_back(exact_uv(each.directions.back()));
            }
            cases.push_back(each);
        };
        add("front", [&] { return r.uniform(0.0, 1.0); });
        add("behind the horizon", [&] { return r.uniform(-0.99, 0.0); });
        add("near the far pole", [&] { return r.log_uniform(1e-8, 1e-2) - 1.0; });
        return cases;
    }();
    return made;
}

const std::vector<bias_case>& bias_cases() {
    static const std::vector<bias_case> made = [] {
        random r(7);
        std::vector<bias_case> cases;
        const auto add = [&](const std::string& name, double steepest, double slope, double shear) {
            bias_case each{name, {}, {}, {}};
            for (std::size_t i = 0; i < count; ++i) {
                const double angle = r.uniform(0.0, 2.0 * std::numbers::pi);
                const double rise = r.log_uniform(0.01, steepest);
                const glm::vec3 n(glm::dvec3(rise * std::cos(angle), rise * std::sin(angle), 1.0));
                // a warp of two passes: rows move u, then columns move v
                const double u = r.log_uniform(1.0 / slope, slope);
                const double v = r.log_uniform(1.0 / slope, slope);
                const double along = shear * r.uniform(-1.0, 1.0);
                const double across = shear * r.uniform(-1.0, 1.0);
                const glm::mat2 jacobian(glm::dmat2(u, across * u, along, v + across * along));
                each.normals.push_back(n);
                each.jacobians.push_back(jacobian);
                each.bias.push_back(exact_bias(n, jacobian));
            }
            cases.push_back(each);
        };
        add("gentle", 2.0, 2.0, 0.1);
        add("steep", 50.0, 4.0, 2.0);
        add("sheared", 50.0, 64.0, 200.0);
        return cases;
    }();
    return made;
}

} // namespace arithmetic
