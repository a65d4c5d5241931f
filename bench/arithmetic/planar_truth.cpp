// Points in the plane, and what is true of them in integers and rationals.
#include "exact_geometry.hpp"
#include "frustum_pairs.hpp"
#include "inputs.hpp"
#include "point_sets.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace arithmetic {

namespace {

using frustum_pairs::random;

constexpr std::size_t triple_count = 20000;
constexpr std::uint64_t set_count = 1000;

template <typename T> glm::vec<2, T> any_point(random& r, double lo, double hi) {
    const T x = static_cast<T>(r.uniform(lo, hi));
    return {x, static_cast<T>(r.uniform(lo, hi))};
}

/// A point of the line through two others, rounded.
template <typename T>
glm::vec<2, T> on_line(const glm::vec<2, T>& a, const glm::vec<2, T>& b, double t) {
    const glm::dvec2 p = glm::dvec2(a) + t * (glm::dvec2(b) - glm::dvec2(a));
    return glm::vec<2, T>(p);
}

template <typename T> using triple = std::array<glm::vec<2, T>, 3>;

template <typename T> int exact_sign(const triple<T>& points) {
    const auto set = exact::on_grid<T>(points);
    const exact::integer area = exact::cross(set.points[0], set.points[1], set.points[2]);
    return area < 0 ? -1 : area > 0 ? 1 : 0;
}

template <typename T> std::vector<orientation_case<T>> make_orientations() {
    random r(3);
    std::vector<orientation_case<T>> cases;
    const auto add = [&](const std::string& name, auto make) {
        orientation_case<T> each{name, {}, {}};
        for (std::size_t i = 0; i < triple_count; ++i) {
            each.triples.push_back(make());
            each.signs.push_back(exact_sign(each.triples.back()));
        }
        cases.push_back(each);
    };
    add("random", [&] {
        const auto a = any_point<T>(r, 0.0, 1.0);
        const auto b = any_point<T>(r, 0.0, 1.0);
        return triple<T>{a, b, any_point<T>(r, 0.0, 1.0)};
    });
    add("near a line", [&] {
        const auto a = any_point<T>(r, 0.0, 1.0);
        const auto b = any_point<T>(r, 0.0, 1.0);
        return triple<T>{a, b, on_line(a, b, r.uniform(0.0, 1.0))};
    });
    add("near a line, all scales", [&] {
        const double scale = r.log_uniform(1e-6, 1.0);
        const auto a = any_point<T>(r, 0.0, 1000.0);
        const auto b = on_line(a, any_point<T>(r, 0.0, 1000.0), scale);
        return triple<T>{a, b, on_line(a, b, r.log_uniform(1e-6, 1.0))};
    });
    add("on a line", [&] {
        // multiples of a short vector
        const double x = r.integer(-31, 31);
        const double y = r.integer(-31, 31);
        triple<T> points;
        for (auto& p : points) {
            const int k = r.integer(-1000, 1000);
            p = {static_cast<T>(k * x + 7), static_cast<T>(k * y - 3)};
        }
        return points;
    });
    return cases;
}

/// What is true of a set, found when it is first asked for.
struct set_truth {
    exact::grid_points grid;
    std::vector<std::size_t> hull;
    exact::real area, diameter;
};

const set_truth& truth_of(const planar_case& in, std::size_t i) {
    static std::map<std::pair<std::string, std::size_t>, set_truth> known;
    const auto [at, missing] = known.try_emplace({in.envelope, i});
    if (missing) {
        const std::span<const glm::vec2> set(in.sets[i]);
        at->second.grid = exact::on_grid<float>(set);
        at->second.hull = exact::hull(at->second.grid.points);
        at->second.area = exact::smallest_area(at->second.grid);
        at->second.diameter = exact::diameter(set);
    }
    return at->second;
}

} // namespace

const std::vector<orientation_case<float>>& orientation_cases() {
    static const auto made = make_orientations<float>();
    return made;
}

const std::vector<orientation_case<double>>& wide_orientation_cases() {
    static const auto made = make_orientations<double>();
    return made;
}

const std::vector<planar_case>& planar_cases() {
    static const std::vector<planar_case> made = [] {
        std::vector<planar_case> cases;
        for (const auto& [envelope, kind] : {std::pair{"random", "random"},
                                             {"near a line", "a few ulps off a line"},
                                             {"rectangles", "rectangles jittered by ulps"},
                                             {"far off", "offset 1e6"}}) {
            planar_case each{envelope, {}};
            for (std::uint64_t seed = 0; seed < set_count; ++seed) {
                each.sets.push_back(point_sets::make<float>(kind, seed));
            }
            cases.push_back(each);
        }
        return cases;
    }();
    return made;
}

bool hull_is_exact(const planar_case& in, std::size_t i, const std::vector<glm::dvec2>& hull) {
    const set_truth& truth = truth_of(in, i);
    if (hull.size() != truth.hull.size()) {
        return false;
    }
    std::vector<glm::dvec2> expected;
    for (const std::size_t corner : truth.hull) {
        expected.emplace_back(in.sets[i][corner]);
    }
    std::vector<glm::dvec2> turned = hull;
    const auto start = std::find(turned.begin(), turned.end(), expected.front());
    std::rotate(turned.begin(), start == turned.end() ? turned.begin() : start, turned.end());
    return turned == expected;
}

double rectangle_error(const planar_case& in, std::size_t i, const glm::dvec2& centre,
                       const glm::dvec2& axis, const glm::dvec2& half_extents) {
    using exact::real;
    for (const double x : {centre.x, centre.y, axis.x, axis.y, half_extents.x, half_extents.y}) {
        if (!std::isfinite(x)) {
            return std::nan("");
        }
    }
    const set_truth& truth = truth_of(in, i);
    if (truth.diameter == 0) {
        return 0.0;
    }
    std::vector<glm::dvec2> points(in.sets[i].begin(), in.sets[i].end());
    const real outside =
        exact::outside(std::span<const glm::dvec2>(points), centre, axis, half_extents);
    // what the area exceeds the smallest by, as a strip along the longer side
    const real area = 4 * real(half_extents.x) * real(half_extents.y);
    const real longer = 2 * real(std::max(half_extents.x, half_extents.y));
    const real strip = longer > 0 ? real((area - truth.area) / longer) : real(0);
    const real worst = std::max(outside, strip);
    return map_size * static_cast<double>(real(worst / truth.diameter));
}

} // namespace arithmetic
