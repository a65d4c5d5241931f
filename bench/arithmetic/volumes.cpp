// Frusta against frusta, faces of a cube map, and the body of a frustum and a box.
#include "kernels.hpp"
#include "scalar_culling.hpp"

#include <warpshadow/cube.hpp>
#include <warpshadow/cull.hpp>
#include <warpshadow/polytope.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ws = warpshadow;

namespace arithmetic::ARITHMETIC_BUILD {

namespace {

void add_pairs(entries& to, const pair_case& in) {
    const auto add = [&](const std::string& variant, auto meets) {
        add_each(to, "frustum test", in.envelope, variant, in.pairs.size(), meets,
                 [&in](std::size_t i, bool found) {
                     return found == in.meet[i] ? 0.0 : found ? kept_in_vain : missed;
                 });
    };
    const auto add_scalar = [&]<typename N>(const std::string& variant, N, bool world) {
        using prepared = std::array<scalar_culling::prepared<N>, 2>;
        const auto own = std::make_shared<std::vector<prepared>>();
        for (const auto& [a, b] : in.pairs) {
            const auto origin = world ? glm::vec<3, N>(N(0)) : glm::vec<3, N>(a.eye);
            own->push_back(
                {scalar_culling::prepare(a, origin), scalar_culling::prepare(b, origin)});
        }
        add(variant, [own](std::size_t i) {
            return scalar_culling::scalar_intersects((*own)[i][0], (*own)[i][1]);
        });
    };
    add_scalar("float, no bounds, world space", 0.0f, true);
    add_scalar("float, no bounds", 0.0f, false);
    add_scalar("double, no bounds", 0.0, false);
    const auto volumes = std::make_shared<std::vector<std::array<ws::cull_volume, 2>>>();
    for (const auto& [a, b] : in.pairs) {
        volumes->push_back({ws::make_cull_volume(a), ws::make_cull_volume(b)});
    }
    add("prepared, `intersects`", [volumes](std::size_t i) {
        return ws::intersects((*volumes)[i][0], (*volumes)[i][1]).intersects;
    });
    add("from frusta, `intersects`",
        [&in](std::size_t i) { return ws::intersects(in.pairs[i][0], in.pairs[i][1]).intersects; });
    add("prepared, `separating_axis`", [volumes](std::size_t i) {
        return !(ws::separating_axis((*volumes)[i][0], (*volumes)[i][1]).gap > 0.0);
    });
}

void add_faces(entries& to, const face_case& in) {
    const auto add = [&](const std::string& variant, bool refined) {
        ws::face_options options;
        options.refined = refined;
        const auto masks = std::make_shared<std::vector<std::uint32_t>>(in.lights.size());
        to.add({"cube faces", in.envelope, variant, double(in.lights.size()),
                [&in, options, masks] {
                    for (std::size_t i = 0; i < masks->size(); ++i) {
                        (*masks)[i] = ws::face_mask(in.lights[i], in.views[i], options).mask;
                    }
                },
                [&in, masks] {
                    // one decision for each face
                    std::vector<double> wrong(6 * masks->size(), 0.0);
                    for (std::size_t k = 0; k < wrong.size(); ++k) {
                        const bool found = ((*masks)[k / 6] >> k % 6 & 1u) != 0u;
                        const bool truth = (in.masks[k / 6] >> k % 6 & 1u) != 0u;
                        wrong[k] = found == truth ? 0.0 : found ? kept_in_vain : missed;
                    }
                    return wrong;
                }});
    };
    add("fast", false);
    add("refined", true);
}

/// What is made of a scene: vertices and how many there are.
template <typename T> struct vertex_list {
    std::array<glm::vec<3, T>, 96> points;
    std::size_t count = 0;
};

/// Corners of a box in the order of a frustum's: two rings.
template <typename T> std::array<glm::vec<4, T>, 8> corners_of(const ws::box3<T>& box) {
    std::array<glm::vec<4, T>, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        corners[i] = {i % 4 == 1 || i % 4 == 2 ? box.hi.x : box.lo.x,
                      i % 4 >= 2 ? box.hi.y : box.lo.y, i >= 4 ? box.hi.z : box.lo.z, T(1)};
    }
    return corners;
}

/// The edges of one body cut by the planes of the other, by a + t (b - a), without care for ties.
template <typename T>
void add_cut_edges(const std::array<glm::vec<4, T>, 8>& corners,
                   const std::array<glm::vec<4, T>, 6>& planes, vertex_list<T>& to) {
    for (std::size_t edge = 0; edge < 12; ++edge) {
        const std::size_t i = edge % 4;
        const std::size_t ring = edge < 4 || edge >= 8 ? 0 : 4;
        const glm::vec<4, T>& a = corners[ring + i];
        const glm::vec<4, T>& b = corners[edge < 8 ? ring + (i + 1) % 4 : 4 + i];
        T enter = T(0);
        T leave = T(1);
        for (const glm::vec<4, T>& plane : planes) {
            const T from = glm::dot(plane, a);
            const T until = glm::dot(plane, b);
            if (from < T(0) && until < T(0)) {
                enter = T(2);
            } else if (from < T(0)) {
                enter = std::max(enter, from / (from - until));
            } else if (until < T(0)) {
                leave = std::min(leave, from / (from - until));
            }
        }
        if (enter <= leave) {
            to.points[to.count++] = glm::vec<3, T>(a + enter * (b - a));
            to.points[to.count++] = glm::vec<3, T>(a + leave * (b - a));
        }
    }
}

template <typename T>
void add_bodies(entries& to, const body_case<T>& in, const std::string& type) {
    struct scene {
        std::array<glm::vec<4, T>, 8> corners;
        std::array<glm::vec<4, T>, 6> planes;
        ws::box3<T> box;
    };
    const auto own = std::make_shared<std::vector<scene>>();
    for (std::size_t i = 0; i < in.views.size(); ++i) {
        own->push_back(
            {ws::frustum_corners(in.views[i]), ws::frustum_planes(in.views[i]), in.boxes[i]});
    }
    const auto add = [&](const std::string& variant, auto make) {
        add_each(
            to, "clipping", in.envelope, type + variant, own->size(),
            [own, make](std::size_t i) {
                vertex_list<T> found;
                make((*own)[i], found);
                return found;
            },
            [&in](std::size_t i, const vertex_list<T>& found) {
                return body_error(
                    in, i,
                    {found.points.begin(),
                     found.points.begin() + static_cast<std::ptrdiff_t>(found.count)});
            });
    };
    add(", a + t (b - a)", [](const scene& s, vertex_list<T>& found) {
        using vec4 = glm::vec<4, T>;
        const std::array<vec4, 6> sides{
            vec4(T(1), T(0), T(0), -s.box.lo.x), vec4(T(-1), T(0), T(0), s.box.hi.x),
            vec4(T(0), T(1), T(0), -s.box.lo.y), vec4(T(0), T(-1), T(0), s.box.hi.y),
            vec4(T(0), T(0), T(1), -s.box.lo.z), vec4(T(0), T(0), T(-1), s.box.hi.z)};
        add_cut_edges(s.corners, sides, found);
        add_cut_edges(corners_of(s.box), s.planes, found);
    });
    add(", `intersection_vertices`", [](const scene& s, vertex_list<T>& found) {
        const auto set = ws::intersection_vertices(s.corners, s.planes, s.box);
        std::copy_n(set.points.begin(), set.count, found.points.begin());
        found.count = set.count;
    });
    add(", `intersection`", [](const scene& s, vertex_list<T>& found) {
        const auto body = ws::intersection(s.corners, s.box);
        for (std::size_t k = 0; k < body.count; ++k) {
            found.points[found.count++] = glm::vec<3, T>(body.vertices[k]);
        }
    });
}

} // namespace

void add_volumes(entries& to) {
    for (const pair_case& in : pair_cases()) {
        add_pairs(to, in);
    }
    for (const face_case& in : face_cases()) {
        add_faces(to, in);
    }
    for (const auto& in : body_cases()) {
        add_bodies(to, in, "float");
    }
    for (const auto& in : wide_body_cases()) {
        add_bodies(to, in, "double");
    }
}

} // namespace arithmetic::ARITHMETIC_BUILD
