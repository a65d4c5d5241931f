// Pairs of volumes and bodies of a frustum and a box, judged by exact separating axes and by all
// triples of planes.
#include "exact_volumes.hpp"
#include "frustum_pairs.hpp"
#include "inputs.hpp"

#include <warpshadow/cube.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace arithmetic {

namespace {

using frustum_pairs::random;

constexpr std::size_t pairs_of_a_kind = 1000;
constexpr std::size_t face_count = 500;
constexpr std::size_t body_count = 300;

std::size_t kind_named(std::string_view name) {
    std::size_t i = 0;
    while (frustum_pairs::kinds.at(i).name != name) {
        ++i;
    }
    return i;
}

/// Inward planes of a frustum at the origin and a box, exactly those of the numbers given.
using oracle::real;
using oracle::vec;
struct plane {
    vec<real> normal;
    real offset;
};

template <typename T>
std::vector<plane> planes_of(const warpshadow::frustum<T>& f, const warpshadow::box3<T>& box) {
    const auto corners = oracle::corners_of(f);
    vec<real> centre = corners[0];
    for (std::size_t i = 1; i < 8; ++i) {
        centre = centre + corners[i];
    }
    centre = oracle::times(real(0.125), centre);
    std::vector<plane> planes;
    // by three corners each; bits of a corner are right, top and far
    for (const auto& [a, b, c] :
         {std::array{0, 2, 4}, {1, 3, 5}, {0, 1, 4}, {2, 3, 6}, {0, 1, 2}, {4, 5, 6}}) {
        const auto& p = corners[static_cast<std::size_t>(a)];
        vec<real> n = oracle::cross(corners[static_cast<std::size_t>(b)] - p,
                                    corners[static_cast<std::size_t>(c)] - p);
        n = oracle::times(real(1 / sqrt(oracle::dot(n, n))), n);
        if (oracle::dot(n, centre - p) < 0) {
            n = oracle::times(real(-1), n);
        }
        planes.push_back({n, -oracle::dot(n, p)});
    }
    for (glm::length_t k = 0; k < 3; ++k) {
        vec<real> n{{real(0), real(0), real(0)}};
        n[static_cast<std::size_t>(k)] = 1;
        planes.push_back({n, -real(box.lo[k])});
        n[static_cast<std::size_t>(k)] = -1;
        planes.push_back({n, real(box.hi[k])});
    }
    return planes;
}

/// Vertices of what is inside all planes: of each three the point where they meet, if it is inside
/// the others to 40 digits of the size.
std::vector<vec<real>> vertices_of(const std::vector<plane>& planes, const real& size) {
    std::vector<vec<real>> vertices;
    const real tolerance = size * real("1e-40");
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const vec<real> line = oracle::cross(planes[i].normal, planes[j].normal);
            for (std::size_t k = 0; k < j; ++k) {
                const real det = oracle::dot(line, planes[k].normal);
                if (abs(det) < real("1e-30")) {
                    continue;
                }
                vec<real> p = oracle::times(planes[k].offset, line);
                p = p + oracle::times(planes[i].offset,
                                      oracle::cross(planes[j].normal, planes[k].normal));
                p = p + oracle::times(planes[j].offset,
                                      oracle::cross(planes[k].normal, planes[i].normal));
                p = oracle::times(real(-1 / det), p);
                const bool inside = std::all_of(planes.begin(), planes.end(), [&](const plane& q) {
                    return oracle::dot(q.normal, p) + q.offset >= -tolerance;
                });
                if (inside) {
                    vertices.push_back(p);
                }
            }
        }
    }
    return vertices;
}

/// The vertices in two doubles each, found when they are first asked for.
struct body_truth {
    std::vector<std::array<wide, 3>> vertices;
    double size;
};

template <typename T> const body_truth& truth_of(const body_case<T>& in, std::size_t i) {
    static std::map<std::pair<std::string, std::size_t>, body_truth> known;
    const auto [at, missing] = known.try_emplace({in.envelope, i});
    if (missing) {
        const real reach = in.views[i].volume.far_distance;
        real lo = 0;
        real hi = 0;
        for (const auto& p : vertices_of(planes_of(in.views[i], in.boxes[i]), reach)) {
            std::array<wide, 3> rounded;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto high = static_cast<double>(p[k]);
                rounded[k] = {high, static_cast<double>(real(p[k] - high))};
                lo = at->second.vertices.empty() && k == 0 ? p[k] : std::min(lo, p[k]);
                hi = at->second.vertices.empty() && k == 0 ? p[k] : std::max(hi, p[k]);
            }
            at->second.vertices.push_back(rounded);
        }
        at->second.size = static_cast<double>(real(hi - lo));
    }
    return at->second;
}

/// A view from the origin and a box that it meets.
template <typename T>
void add_body(body_case<T>& to, random& r, double near_distance, double far_distance,
              bool through_eye) {
    auto view = frustum_pairs::any_axes<T>(r);
    view.eye = glm::vec<3, T>(T(0));
    view.volume = warpshadow::perspective_volume(T(r.uniform(0.4, 1.6)), T(r.uniform(1.0, 2.0)),
                                                 T(near_distance), T(far_distance));
    const glm::dvec3 middle = r.uniform(0.0, 8.0) * glm::dvec3(view.forward);
    const glm::dvec3 half(r.uniform(1.0, 8.0), r.uniform(1.0, 8.0), r.uniform(1.0, 8.0));
    warpshadow::box3<T> box{glm::vec<3, T>(middle - half), glm::vec<3, T>(middle + half)};
    if (through_eye) {
        // the ground at the height of the eye: a plane of the box through the apex of the view
        box.lo.y = T(0);
        box.hi.y = std::max(box.hi.y, T(1));
    }
    to.views.push_back(view);
    to.boxes.push_back(box);
}

template <typename T> std::vector<body_case<T>> make_bodies() {
    random r(10);
    std::vector<body_case<T>> cases{
        {"view and box", {}, {}}, {"plane through the eye", {}, {}}, {"far/near 1e6", {}, {}}};
    for (std::size_t i = 0; i < body_count; ++i) {
        add_body(cases[0], r, r.uniform(0.05, 1.0), r.uniform(5.0, 30.0), false);
        add_body(cases[1], r, r.uniform(0.05, 1.0), r.uniform(5.0, 30.0), true);
        add_body(cases[2], r, 1e-3, 1e3, false);
    }
    return cases;
}

template <typename T>
double error_of(const body_case<T>& in, std::size_t i, const std::vector<glm::dvec3>& vertices) {
    const body_truth& truth = truth_of(in, i);
    if (truth.vertices.empty() || vertices.empty()) {
        return truth.vertices.empty() && vertices.empty() ? 0.0 : map_size;
    }
    std::vector<double> from_truth(truth.vertices.size(), map_size * truth.size);
    double worst = 0.0;
    for (const glm::dvec3& v : vertices) {
        double nearest = map_size * truth.size;
        for (std::size_t k = 0; k < truth.vertices.size(); ++k) {
            const auto& t = truth.vertices[k];
            const double away =
                glm::length(glm::dvec3(off(v.x, t[0]), off(v.y, t[1]), off(v.z, t[2])));
            nearest = std::min(nearest, away);
            from_truth[k] = std::min(from_truth[k], away);
        }
        worst = std::max(worst, nearest);
    }
    worst = std::max(worst, *std::max_element(from_truth.begin(), from_truth.end()));
    return map_size * worst / truth.size;
}

} // namespace

const std::vector<pair_case>& pair_cases() {
    static const std::vector<pair_case> made = [] {
        random r(8);
        std::vector<pair_case> cases;
        const auto add = [&](const std::string& name, const std::vector<std::string_view>& kinds) {
            pair_case each{name, {}, {}};
            for (const std::string_view kind : kinds) {
                for (std::size_t i = 0; i < pairs_of_a_kind; ++i) {
                    const auto p = frustum_pairs::make_pair<float>(kind_named(kind), r);
                    long exact = 0;
                    each.pairs.push_back({p.a, p.b});
                    each.meet.push_back(oracle::intersect(p.a, p.b, p.a.eye, exact));
                }
            }
            cases.push_back(each);
        };
        add("anywhere", {"random", "view and cube face"});
        add("touching", {"adjacent faces of one light", "coplanar splits", "tiles sharing a plane",
                         "vertex on vertex, edge, face"});
        add("far off", {"offset 1e4 to 1e6"});
        add("thin or long", {"thin piercing", "near 1e-4 far 1e5"});
        return cases;
    }();
    return made;
}

const std::vector<face_case>& face_cases() {
    static const std::vector<face_case> made = [] {
        random r(9);
        std::vector<face_case> cases;
        for (const auto& [name, spread] :
             {std::pair{"light anywhere", 20.0}, {"light near the view", 2.0}}) {
            face_case each{name, {}, {}, {}};
            for (std::size_t i = 0; i < face_count; ++i) {
                const auto light = r.in_cube<float>(spread);
                const auto view = frustum_pairs::any_view<float>(r, spread, 0.05, 1.0, 5.0, 30.0);
                std::uint32_t mask = 0;
                for (int face = 0; face < 6; ++face) {
                    auto pyramid = warpshadow::face_camera(
                                       light, face, warpshadow::cube_api::opengl, 1.0f, 1000.0f)
                                       .value;
                    pyramid.volume.near_distance = 0.0f;
                    long exact = 0;
                    mask |= (oracle::intersect(pyramid, view, light, exact) ? 1u : 0u) << face;
                }
                each.lights.push_back(light);
                each.views.push_back(view);
                each.masks.push_back(mask);
            }
            cases.push_back(each);
        }
        return cases;
    }();
    return made;
}

const std::vector<body_case<float>>& body_cases() {
    static const auto made = make_bodies<float>();
    return made;
}

const std::vector<body_case<double>>& wide_body_cases() {
    static const auto made = make_bodies<double>();
    return made;
}

double body_error(const body_case<float>& in, std::size_t i,
                  const std::vector<glm::dvec3>& vertices) {
    return error_of(in, i, vertices);
}

double body_error(const body_case<double>& in, std::size_t i,
                  const std::vector<glm::dvec3>& vertices) {
    return error_of(in, i, vertices);
}

} // namespace arithmetic
