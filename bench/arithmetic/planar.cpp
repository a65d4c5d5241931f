// Orientation, hulls and smallest rectangles.
#include "kernels.hpp"
#include "plain_hull.hpp"

#include <warpshadow/calipers.hpp>
#include <warpshadow/hull.hpp>
#include <warpshadow/predicates.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ws = warpshadow;

namespace arithmetic::ARITHMETIC_BUILD {

namespace {

template <typename T>
int plain_sign(const glm::vec<2, T>& a, const glm::vec<2, T>& b, const glm::vec<2, T>& c) {
    const T area = plain_hull::turn(a, b, c);
    return area > T(0) ? 1 : area < T(0) ? -1 : 0;
}

template <typename T>
void add_orientation(entries& to, const std::string& kernel, const orientation_case<T>& in) {
    const auto add = [&](const std::string& variant, auto sign) {
        add_each(
            to, kernel, in.envelope, variant, in.triples.size(),
            [&in, sign](std::size_t i) {
                return sign(in.triples[i][0], in.triples[i][1], in.triples[i][2]);
            },
            [&in](std::size_t i, int sign_found) {
                return sign_found == in.signs[i] ? 0.0 : kept_in_vain;
            });
    };
    using vec2 = glm::vec<2, T>;
    if constexpr (sizeof(T) == sizeof(float)) {
        add("float",
            [](const vec2& a, const vec2& b, const vec2& c) { return plain_sign(a, b, c); });
    }
    add("double", [](const vec2& a, const vec2& b, const vec2& c) {
        return plain_sign(glm::dvec2(a), glm::dvec2(b), glm::dvec2(c));
    });
    add("adaptive, `orient2d`",
        [](const vec2& a, const vec2& b, const vec2& c) { return ws::orient2d(a, b, c); });
    if constexpr (sizeof(T) == sizeof(float)) {
        double extent = 0.0;
        for (const auto& triple : in.triples) {
            for (const vec2& p : triple) {
                extent = std::max({extent, std::abs(double(p.x)), std::abs(double(p.y))});
            }
        }
        // coordinates of both signs span twice the largest
        const double step = ws::snap_step(2.0 * extent);
        add("on a grid, `orient2d_snapped`", [step](const vec2& a, const vec2& b, const vec2& c) {
            return ws::orient2d_snapped(ws::snap(glm::dvec2(a), step),
                                        ws::snap(glm::dvec2(b), step),
                                        ws::snap(glm::dvec2(c), step));
        });
    }
    add("exact alone", [](const vec2& a, const vec2& b, const vec2& c) {
        return ws::detail::orient2d_exact(glm::dvec2(a), glm::dvec2(b), glm::dvec2(c));
    });
}

/// The sets of a case in T, and memory for one of them.
template <typename T> struct sets {
    explicit sets(const planar_case& in) {
        for (const auto& set : in.sets) {
            all.emplace_back(set.begin(), set.end());
            size = std::max(size, set.size());
        }
        scratch.resize(size);
        hull.reserve(2 * size);
    }
    std::vector<std::vector<glm::vec<2, T>>> all;
    std::vector<glm::vec<2, T>> scratch, hull;
    std::size_t size = 0;
};

template <typename T> void add_hull(entries& to, const planar_case& in, const std::string& type) {
    using vec2 = glm::vec<2, T>;
    const auto own = std::make_shared<sets<T>>(in);
    /// @param make writes the hull of a set into memory of its size and returns the vertices
    const auto add = [&](const std::string& variant, auto make) {
        // results lie in memory that is there before the clock runs
        const auto hulls = std::make_shared<std::vector<std::vector<vec2>>>(own->all);
        const auto sizes = std::make_shared<std::vector<std::size_t>>(own->all.size());
        to.add({"hull", in.envelope, type + variant, double(own->all.size()),
                [own, hulls, sizes, make] {
                    for (std::size_t i = 0; i < hulls->size(); ++i) {
                        (*sizes)[i] = make(own->all[i], (*hulls)[i]);
                    }
                },
                [&in, hulls, sizes] {
                    std::vector<double> wrong;
                    for (std::size_t i = 0; i < hulls->size(); ++i) {
                        const auto& hull = (*hulls)[i];
                        const std::vector<glm::dvec2> found(
                            hull.begin(), hull.begin() + static_cast<std::ptrdiff_t>((*sizes)[i]));
                        wrong.push_back(hull_is_exact(in, i, found) ? 0.0 : kept_in_vain);
                    }
                    return wrong;
                }});
    };
    add(", `convex_hull`", [](const std::vector<vec2>& set, std::vector<vec2>& hull) {
        std::copy(set.begin(), set.end(), hull.begin());
        return ws::convex_hull(std::span<vec2>(hull)).count;
    });
    add(", plain chain", [own](const std::vector<vec2>& set, std::vector<vec2>& hull) {
        plain_hull::monotone_chain(set, own->scratch, own->hull);
        // rounding may leave more vertices than there are points
        const std::size_t count = std::min(own->hull.size(), set.size());
        std::copy_n(own->hull.begin(), count, hull.begin());
        return count;
    });
}

template <typename T>
void add_rectangle(entries& to, const planar_case& in, const std::string& type) {
    const auto own = std::make_shared<sets<T>>(in);
    const auto error = [&in](std::size_t i, const plain_hull::rectangle<T>& r) {
        return rectangle_error(in, i, glm::dvec2(r.centre), glm::dvec2(r.axis),
                               glm::dvec2(r.half_extents));
    };
    const auto as_plain = [](const ws::oriented_rectangle<T>& r) {
        return plain_hull::rectangle<T>{r.centre, r.axis, r.half_extents};
    };
    add_each(
        to, "rectangle", in.envelope, type + ", `min_area_rectangle`", own->all.size(),
        [own, as_plain](std::size_t i) {
            return as_plain(ws::min_area_rectangle<T>(own->all[i], own->scratch));
        },
        error);
    add_each(
        to, "rectangle", in.envelope, type + ", plain", own->all.size(),
        [own](std::size_t i) {
            plain_hull::monotone_chain(own->all[i], own->scratch, own->hull);
            return plain_hull::smallest_rectangle(own->hull);
        },
        error);
}

} // namespace

void add_planar(entries& to) {
    for (const auto& in : orientation_cases()) {
        add_orientation(to, "orientation", in);
    }
    for (const auto& in : wide_orientation_cases()) {
        add_orientation(to, "orientation of doubles", in);
    }
    for (const planar_case& in : planar_cases()) {
        add_hull<float>(to, in, "float");
        add_hull<double>(to, in, "double");
        add_rectangle<float>(to, in, "float");
        add_rectangle<double>(to, in, "double");
    }
}

} // namespace arithmetic::ARITHMETIC_BUILD
