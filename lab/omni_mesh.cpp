#include "lab/omni_mesh.hpp"

#include <warpshadow/light.hpp>
#include <warpshadow/paraboloid.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lab {

namespace ws = warpshadow;

namespace {

/// Halvings after which a triangle is drawn as it is: forty of each edge.
constexpr int most_halvings = 120;

struct piece {
    std::array<glm::dvec3, 3> corners;
    int halvings;
};

double distance_to_edge(glm::dvec3 a, glm::dvec3 b) {
    const glm::dvec3 along = b - a;
    const double square = glm::dot(along, along);
    const double t = square > 0.0 ? glm::clamp(-glm::dot(a, along) / square, 0.0, 1.0) : 0.0;
    return glm::length(a + t * along);
}

/// From the origin to the nearest point of a triangle; `normal` has length 1.
double distance_to_triangle(const std::array<glm::dvec3, 3>& p, glm::dvec3 normal) {
    const glm::dvec3 foot = glm::dot(normal, p[0]) * normal;
    bool inside = true;
    double nearest = glm::length(p[0]);
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 a = p[i];
        const glm::dvec3 b = p[(i + 1) % 3];
        inside = inside && glm::dot(glm::cross(b - a, foot - a), normal) >= 0.0;
        nearest = std::min(nearest, distance_to_edge(a, b));
    }
    return inside ? glm::length(foot) : nearest;
}

class cutter {
  public:
    cutter(const hemisphere_frame& frame, int map_size, hemisphere_mesh& result)
        : overlap_(horizon_overlap(map_size)),
          chord_(ws::longest_chord(arc_texels, static_cast<double>(map_size))),
          from_world_(glm::transpose(frame.axes)), light_(frame.light), result_(result) {}

    void add(const std::array<glm::vec3, 3>& world) {
        piece whole{};
        for (std::size_t i = 0; i < 3; ++i) {
            whole.corners[i] = from_world_ * (glm::dvec3(world[i]) - light_);
        }
        const auto& p = whole.corners;
        const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double area = glm::length(across);
        if (!(area > 0.0)) {
            return; // nothing casts no shadow, but arcs through its corners would have an inside
        }
        const glm::dvec3 normal = across / area;
        plane_ = glm::vec4(glm::vec3(normal), static_cast<float>(glm::dot(normal, p[0])));
        reach_ = glm::vec2(
            glm::dvec2(distance_to_triangle(p, normal),
                       std::max({glm::length(p[0]), glm::length(p[1]), glm::length(p[2])})));
        waiting_.assign(1, whole);
        while (!waiting_.empty()) {
            const piece next = waiting_.back();
            waiting_.pop_back();
            cut(next);
        }
    }

  private:
    [[nodiscard]] bool shows(glm::dvec3 p, int side) const {
        return ws::paraboloid_clip(p, side, overlap_) >= 0.0;
    }

    /// Parts that an edge asks for. A side shows nothing of an edge whose ends are both behind its
    /// horizon: what is behind is a convex cone.
    [[nodiscard]] double parts_of(glm::dvec3 a, glm::dvec3 b) const {
        const bool ordered = a.x != b.x   ? a.x < b.x
                             : a.y != b.y ? a.y < b.y
                                          : a.z <= b.z; // as its neighbour does
        double parts = 1.0;
        for (int side = 0; side < 2; ++side) {
            if (shows(a, side) || shows(b, side)) {
                parts = std::max(parts, ordered ? ws::paraboloid_segments(a, b, side, chord_)
                                                : ws::paraboloid_segments(b, a, side, chord_));
            }
        }
        return parts;
    }

    void cut(const piece& t) {
        std::size_t longest = 0;
        double most = 1.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double parts = parts_of(t.corners[i], t.corners[(i + 1) % 3]);
            if (parts > most) {
                most = parts;
                longest = i;
            }
        }
        if (most <= 1.0 || t.halvings == most_halvings) {
            result_.flags |= most > 1.0 ? ws::status::bound_missed : ws::status::ok;
            for (const glm::dvec3 p : t.corners) {
                result_.vertices.push_back({glm::vec3(p), plane_, reach_});
            }
            return;
        }
        const glm::dvec3 a = t.corners[longest];
        const glm::dvec3 b = t.corners[(longest + 1) % 3];
        const glm::dvec3 c = t.corners[(longest + 2) % 3];
        const glm::dvec3 middle = 0.5 * (a + b);
        waiting_.push_back({{a, middle, c}, t.halvings + 1});
        waiting_.push_back({{middle, b, c}, t.halvings + 1});
    }

    double overlap_, chord_;
    glm::dmat3 from_world_;
    glm::dvec3 light_;
    hemisphere_mesh& result_;
    glm::vec4 plane_{0.0f};
    glm::vec2 reach_{0.0f};
    std::vector<piece> waiting_;
};

} // namespace

hemisphere_frame make_hemisphere_frame(const scene& world, glm::dvec3 light, glm::dvec3 axis) {
    const ws::light_frame_result<double> axes = ws::light_frame(axis);
    const glm::dvec3 farthest =
        glm::max(glm::abs(world.box.lo - light), glm::abs(world.box.hi - light));
    return {light, glm::dmat3(axes.right, axes.up, axes.forward),
            glm::length(farthest) * (1.0 + 0x1p-10)};
}

double horizon_overlap(int map_size) {
    return std::min(4.0 / map_size, 1.0);
}

hemisphere_mesh cut_for_hemispheres(const scene& world, const scene_objects& objects,
                                    const hemisphere_frame& frame, int map_size) {
    hemisphere_mesh result;
    cutter cut(frame, map_size, result);
    for (const triangle_range& object : objects.ranges) {
        const std::size_t first = result.vertices.size() / 3;
        for (std::size_t i = object.first; i < object.first + object.count; ++i) {
            const glm::uvec3 t = objects.triangles[i];
            cut.add({world.positions[t.x], world.positions[t.y], world.positions[t.z]});
        }
        result.ranges.push_back({first, result.vertices.size() / 3 - first});
    }
    return result;
}

} // namespace lab
