#include "lab/light_picture.hpp"

#include "lab/canvas.hpp"
#include "lab/warp_pictures.hpp"

#include <warpshadow/fit.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <optional>

namespace lab {

namespace ws = warpshadow;

namespace {

constexpr glm::vec3 body_colour(0.25f, 0.55f, 0.95f);
constexpr glm::vec3 hull_colour(0.95f, 0.8f, 0.2f);
constexpr glm::vec3 map_colour(0.95f, 0.25f, 0.2f);

/// Place in the light's map; nothing behind the light.
std::optional<glm::dvec2> place(const glm::dmat4& matrix, const glm::dvec4& world) {
    const glm::dvec4 clip = matrix * world;
    if (!(clip.w > 0.0)) {
        return std::nullopt;
    }
    return glm::dvec2(clip) / clip.w * 0.5 + 0.5;
}

void join(canvas& on, const std::optional<glm::dvec2>& a, const std::optional<glm::dvec2>& b,
          glm::vec3 colour) {
    if (a && b) {
        on.line(*a, *b, colour);
    }
}

/// The corners of a map, as another map of the same light sees them.
std::array<std::optional<glm::dvec2>, 4> border(const glm::dmat4& seen_by, const glm::dmat4& map) {
    constexpr std::array<glm::dvec2, 4> corners{glm::dvec2(-1.0, -1.0), glm::dvec2(1.0, -1.0),
                                                glm::dvec2(1.0, 1.0), glm::dvec2(-1.0, 1.0)};
    const glm::dmat4 back = glm::inverse(map);
    std::array<std::optional<glm::dvec2>, 4> result;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        // any depth will do: a ray of light is one place in either map
        const glm::dvec4 world = back * glm::dvec4(corners[i], 0.0, 1.0);
        result[i] = place(seen_by, world / world.w);
    }
    return result;
}

} // namespace

glm::dmat4 enclosing(const glm::dmat4& light, const glm::dmat4& map) {
    ws::map_rect<double> rect{glm::dvec2(0.0), glm::dvec2(1.0)};
    for (const std::optional<glm::dvec2>& corner : border(light, map)) {
        if (!corner) {
            return light;
        }
        rect.lo = glm::min(rect.lo, *corner);
        rect.hi = glm::max(rect.hi, *corner);
    }
    const glm::dvec2 extent = rect.hi - rect.lo;
    return extent.x <= 3.0 && extent.y <= 3.0 ? ws::crop_matrix(light, rect).matrix : light;
}

named_picture light_picture(const light_depths& all, const glm::dmat4& matrix,
                            const ws::focus_result& focus) {
    canvas result("light-view", all.size);
    result.picture = depth_picture(all.depth, all.size, "light-view");

    // two vertices that lie on two planes in common are the ends of an edge
    const ws::receiver_body& body = focus.receivers;
    const auto vertex = [&](std::size_t i) {
        return place(all.matrix, glm::dvec4(glm::dvec3(body.vertices[i]) + focus.eye, 1.0));
    };
    for (std::size_t i = 0; i < body.count; ++i) {
        for (std::size_t j = i + 1; j < body.count; ++j) {
            if (std::popcount(body.planes_at[i] & body.planes_at[j]) >= 2) {
                join(result, vertex(i), vertex(j), body_colour);
            }
        }
    }
    for (std::size_t i = 0; i < focus.footprint_count; ++i) {
        const auto on_ray = [&](std::size_t k) {
            const glm::dvec2 p = focus.footprint[k % focus.footprint_count];
            const glm::dvec3 across = p.x * focus.view.right + p.y * focus.view.up;
            const glm::dvec3 from_eye =
                focus.view.position + across +
                (focus.view.perspective ? focus.view.forward : glm::dvec3(0.0));
            return place(all.matrix, glm::dvec4(focus.eye + from_eye, 1.0));
        };
        join(result, on_ray(i), on_ray(i + 1), hull_colour);
    }
    const std::array<std::optional<glm::dvec2>, 4> corners = border(all.matrix, matrix);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        join(result, corners[i], corners[(i + 1) % corners.size()], map_colour);
    }
    return std::move(result.picture);
}

} // namespace lab
