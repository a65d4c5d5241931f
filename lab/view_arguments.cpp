#include "lab/view_arguments.hpp"

#include "lab/numbers.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <optional>
#include <vector>

namespace lab {
namespace {

/// Exactly `count` finite numbers between commas.
std::optional<std::vector<double>> numbers(const std::string& text, std::size_t count) {
    std::vector<double> values;
    for (const std::string& part : split(text, ',')) {
        const std::optional<double> value = number<double>(part);
        // the scene's positions are float: what float cannot hold is no place in it
        if (!value || !(std::abs(*value) <= 1e30)) {
            return std::nullopt;
        }
        values.push_back(*value);
    }
    return values.size() == count ? std::optional(values) : std::nullopt;
}

glm::dvec3 vec3_at(const std::vector<double>& values, std::size_t first) {
    return {values[first], values[first + 1], values[first + 2]};
}

/// Index into the built-in views for a text of digits alone; nothing for any other text.
std::optional<std::size_t> built_in_index(const std::string& text) {
    const bool digits = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isdigit(c) != 0;
    });
    return digits ? std::optional(number<std::size_t>(text).value_or(SIZE_MAX)) : std::nullopt;
}

std::string out_of_range(const char* what, const std::string& text, const scene& world,
                         std::size_t count) {
    return "scene '" + world.name + "' has " + what + "s 0 to " + std::to_string(count - 1) +
           ", there is no " + what + " " + text;
}

std::string joined(std::initializer_list<double> values) {
    std::string text;
    for (const double value : values) {
        char buffer[32];
        std::snprintf(buffer, sizeof buffer, "%.4g", value);
        text += (text.empty() ? "" : ",") + std::string(buffer);
    }
    return text;
}

} // namespace

camera_view resolve_camera(const std::string& text, const scene& world) {
    if (const std::optional<std::size_t> index = built_in_index(text)) {
        if (*index >= world.cameras.size()) {
            throw bad_input(out_of_range("camera", text, world, world.cameras.size()));
        }
        return world.cameras[*index];
    }
    const std::optional<std::vector<double>> values = numbers(text, 7);
    if (!values) {
        throw bad_input("--camera wants a number or ex,ey,ez,tx,ty,tz,fov, not '" + text + "'");
    }
    camera_view camera{text, vec3_at(*values, 0), vec3_at(*values, 3), glm::radians((*values)[6])};
    if (camera.eye == camera.target) {
        throw bad_input("--camera " + text + ": eye and target are the same point");
    }
    if (!((*values)[6] > 0.0 && (*values)[6] < 180.0)) {
        throw bad_input("--camera " + text +
                        ": the field of view is not between 0 and 180 degrees");
    }
    return camera;
}

light_view resolve_light(const std::string& text, const scene& world) {
    if (const std::optional<std::size_t> index = built_in_index(text)) {
        if (*index >= world.lights.size()) {
            throw bad_input(out_of_range("light", text, world, world.lights.size()));
        }
        return world.lights[*index];
    }
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    const std::string rest = colon == std::string::npos ? std::string() : text.substr(colon + 1);
    if (kind == "sun") {
        if (const auto values = numbers(rest, 3)) {
            const glm::dvec3 direction = vec3_at(*values, 0);
            if (direction == glm::dvec3(0.0)) {
                throw bad_input("--light " + text + ": the direction has no length");
            }
            return {text, warpshadow::sun(direction)};
        }
    } else if (kind == "spot") {
        if (const auto values = numbers(rest, 7)) {
            const glm::dvec3 position = vec3_at(*values, 0);
            const glm::dvec3 target = vec3_at(*values, 3);
            if (position == target) {
                throw bad_input("--light " + text + ": position and target are the same point");
            }
            if (!((*values)[6] > 0.0 && (*values)[6] < 180.0)) {
                throw bad_input("--light " + text +
                                ": the cone angle is not between 0 and 180 degrees");
            }
            return {text, warpshadow::spot_light(position, target, glm::radians((*values)[6]))};
        }
    } else if (kind == "point") {
        if (const auto values = numbers(rest, 3)) {
            return {text, warpshadow::point_light(vec3_at(*values, 0))};
        }
    }
    throw bad_input("--light wants a number, sun:dx,dy,dz, spot:x,y,z,tx,ty,tz,angle or "
                    "point:x,y,z, not '" +
                    text + "'");
}

std::string kind_text(warpshadow::light_kind kind) {
    using warpshadow::light_kind;
    return kind == light_kind::directional ? "sun" : kind == light_kind::point ? "point" : "spot";
}

std::string camera_text(const camera_view& camera) {
    return joined({camera.eye.x, camera.eye.y, camera.eye.z, camera.target.x, camera.target.y,
                   camera.target.z, glm::degrees(camera.fov_y)});
}

std::string light_text(const light_view& view) {
    const warpshadow::light<double>& light = view.light;
    if (light.kind == warpshadow::light_kind::directional) {
        return "sun:" + joined({light.direction.x, light.direction.y, light.direction.z});
    }
    if (light.kind == warpshadow::light_kind::point) {
        return "point:" + joined({light.position.x, light.position.y, light.position.z});
    }
    const glm::dvec3 target = light.position + light.direction;
    return "spot:" + joined({light.position.x, light.position.y, light.position.z, target.x,
                             target.y, target.z, glm::degrees(light.cone_angle)});
}

} // namespace lab
