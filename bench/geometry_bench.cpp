// Speed of hull, rectangle, body and orientation, beside OpenCV, CGAL, GEOS, Boost, voro++ and
// Bullet.
//
// Run with --benchmark_enable_random_interleaving=true --benchmark_repetitions=7 and compare the
// medians within one run. Each library gets its own types, filled beforehand.
#include "geometry_inputs.hpp"

#include <warpshadow/calipers.hpp>
#include <warpshadow/hull.hpp>
#include <warpshadow/polytope.hpp>
#include <warpshadow/predicates.hpp>

#define USE_UNSTABLE_GEOS_CPP_API // silences a warning of GEOS: this is its C++ interface

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_2.h>
#include <CGAL/min_quadrilateral_2.h>
#include <LinearMath/btGeometryUtil.h>
#include <benchmark/benchmark.h>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/multi_point.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <geos/algorithm/ConvexHull.h>
#include <geos/algorithm/MinimumDiameter.h>
#include <geos/geom/CoordinateArraySequence.h>
#include <geos/geom/Geometry.h>
#include <geos/geom/GeometryFactory.h>
#include <geos/geom/MultiPoint.h>
#include <opencv2/imgproc.hpp>
#include <voro++/voro++.hh>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace {

using geometry_inputs::point_set;
using geometry_inputs::scene;

// What built it, for the results
// -------------------------------------------------------------------

#if defined(__clang__)
constexpr const char* compiler = __VERSION__;
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

[[maybe_unused]] const bool context_known = [] {
    benchmark::AddCustomContext("compiler", compiler);
    benchmark::AddCustomContext("lanes", std::to_string(warpshadow::detail::native_lanes));
    return true;
}();

// Inputs -----------------------------------------------------------------------------------------

enum class shape { body, disk, rim };

const std::vector<point_set>& sets(shape kind, std::size_t size) {
    struct entry {
        shape kind;
        std::size_t size;
        std::vector<point_set> sets;
    };
    static std::vector<std::unique_ptr<entry>> made;
    for (const auto& e : made) {
        if (e->kind == kind && e->size == size) {
            return e->sets;
        }
    }
    const std::size_t count =
        std::clamp<std::size_t>(200000 / std::max<std::size_t>(size, 1), 4, 4096);
    made.push_back(std::make_unique<entry>(
        entry{kind, size,
              kind == shape::body ? geometry_inputs::bodies(4096)
                                  : geometry_inputs::ellipses(count, size, kind == shape::rim)}));
    return made.back()->sets;
}

const std::vector<scene>& all_scenes() {
    static const std::vector<scene> made = geometry_inputs::scenes(4096);
    return made;
}

/// Times `work` on one input after another.
template <typename Inputs, typename Work>
void cycle(benchmark::State& state, const Inputs& inputs, Work work) {
    std::size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(work(inputs[i]));
        i = i + 1 == inputs.size() ? 0 : i + 1;
    }
}

// Conversions, made before the clock runs --------------------------------------------------------

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
namespace bg = boost::geometry;
using boost_point = bg::model::d2::point_xy<double>;
using boost_points = bg::model::multi_point<boost_point>;
using boost_polygon = bg::model::polygon<boost_point>;

template <typename To, typename Convert>
std::vector<To> converted(const std::vector<point_set>& from, Convert convert) {
    std::vector<To> result;
    result.reserve(from.size());
    for (const point_set& set : from) {
        result.push_back(convert(set));
    }
    return result;
}

std::vector<std::vector<cv::Point2f>> for_opencv(const std::vector<point_set>& from) {
    return converted<std::vector<cv::Point2f>>(from, [](const point_set& set) {
        std::vector<cv::Point2f> points;
        for (const glm::vec2& p : set) {
            points.emplace_back(p.x, p.y);
        }
        return points;
    });
}

std::vector<std::vector<kernel::Point_2>> for_cgal(const std::vector<point_set>& from) {
    return converted<std::vector<kernel::Point_2>>(from, [](const point_set& set) {
        std::vector<kernel::Point_2> points;
        for (const glm::vec2& p : set) {
            points.emplace_back(double(p.x), double(p.y));
        }
        return points;
    });
}

std::vector<boost_points> for_boost(const std::vector<point_set>& from) {
    return converted<boost_points>(from, [](const point_set& set) {
        boost_points points;
        for (const glm::vec2& p : set) {
            bg::append(points, boost_point(double(p.x), double(p.y)));
        }
        return points;
    });
}

std::vector<std::unique_ptr<geos::geom::Geometry>> for_geos(const std::vector<point_set>& from) {
    return converted<std::unique_ptr<geos::geom::Geometry>>(from, [](const point_set& set) {
        std::vector<geos::geom::Coordinate> points;
        for (const glm::vec2& p : set) {
            points.emplace_back(double(p.x), double(p.y));
        }
        return std::unique_ptr<geos::geom::Geometry>(
            geos::geom::GeometryFactory::getDefaultInstance()->createMultiPoint(points));
    });
}

std::vector<std::vector<glm::dvec2>> in_double(const std::vector<point_set>& from) {
    return converted<std::vector<glm::dvec2>>(
        from, [](const point_set& set) { return std::vector<glm::dvec2>(set.begin(), set.end()); });
}

// Smallest rectangle -----------------------------------------------------------------------------

template <typename P>
auto warpshadow_rectangle(const std::vector<P>& points, std::vector<P>& scratch) {
    using T = typename P::value_type;
    scratch.resize(points.size());
    return warpshadow::min_area_rectangle<T>(points, scratch).area;
}

void rectangle_warpshadow(benchmark::State& state, shape kind, std::size_t size) {
    point_set scratch;
    cycle(state, sets(kind, size),
          [&](const point_set& s) { return warpshadow_rectangle(s, scratch); });
}

void rectangle_warpshadow_double(benchmark::State& state, shape kind, std::size_t size) {
    std::vector<glm::dvec2> scratch;
    cycle(state, in_double(sets(kind, size)),
          [&](const std::vector<glm::dvec2>& s) { return warpshadow_rectangle(s, scratch); });
}

void rectangle_opencv(benchmark::State& state, shape kind, std::size_t size) {
    cycle(state, for_opencv(sets(kind, size)),
          [](const auto& s) { return cv::minAreaRect(s).size.width; });
}

void rectangle_cgal(benchmark::State& state, shape kind, std::size_t size) {
    std::vector<kernel::Point_2> hull;
    std::vector<kernel::Point_2> corners;
    cycle(state, for_cgal(sets(kind, size)), [&](const auto& s) {
        hull.clear();
        corners.clear();
        CGAL::convex_hull_2(s.begin(), s.end(), std::back_inserter(hull));
        CGAL::min_rectangle_2(hull.begin(), hull.end(), std::back_inserter(corners));
        return corners.front().x();
    });
}

void rectangle_geos(benchmark::State& state, shape kind, std::size_t size) {
    cycle(state, for_geos(sets(kind, size)), [](const auto& s) {
        return geos::algorithm::MinimumDiameter::getMinimumRectangle(s.get()).get() != nullptr;
    });
}

// Hull -------------------------------------------------------------------------------------------

void hull_warpshadow(benchmark::State& state, shape kind, std::size_t size) {
    point_set work;
    cycle(state, sets(kind, size), [&](const point_set& s) {
        work.assign(s.begin(), s.end());
        return warpshadow::convex_hull(std::span(work)).count;
    });
}

void hull_warpshadow_double(benchmark::State& state, shape kind, std::size_t size) {
    std::vector<glm::dvec2> work;
    cycle(state, in_double(sets(kind, size)), [&](const auto& s) {
        work.assign(s.begin(), s.end());
        return warpshadow::convex_hull(std::span(work)).count;
    });
}

void hull_opencv(benchmark::State& state, shape kind, std::size_t size) {
    std::vector<cv::Point2f> hull;
    cycle(state, for_opencv(sets(kind, size)), [&](const auto& s) {
        cv::convexHull(s, hull);
        return hull.size();
    });
}

void hull_cgal(benchmark::State& state, shape kind, std::size_t size) {
    std::vector<kernel::Point_2> hull;
    cycle(state, for_cgal(sets(kind, size)), [&](const auto& s) {
        hull.clear();
        CGAL::convex_hull_2(s.begin(), s.end(), std::back_inserter(hull));
        return hull.size();
    });
}

void hull_boost(benchmark::State& state, shape kind, std::size_t size) {
    cycle(state, for_boost(sets(kind, size)), [&](const auto& s) {
        boost_polygon hull;
        bg::convex_hull(s, hull);
        return hull.outer().size();
    });
}

void hull_geos(benchmark::State& state, shape kind, std::size_t size) {
    cycle(state, for_geos(sets(kind, size)),
          [](const auto& s) { return s->convexHull()->getNumPoints(); });
}

// Orientation ------------------------------------------------------------------------------------

/// Triples at random, or three points on a line of whole numbers.
template <typename T> std::vector<std::array<glm::vec<2, T>, 3>> triples(bool on_a_line) {
    geometry_inputs::numbers random(3);
    std::vector<std::array<glm::vec<2, T>, 3>> result(4096);
    for (auto& t : result) {
        for (auto& p : t) {
            p = {static_cast<T>(random(-1.0, 1.0)), static_cast<T>(random(-1.0, 1.0))};
        }
        if (on_a_line) {
            const glm::dvec2 a(std::floor(random(-100.0, 100.0)),
                               std::floor(random(-100.0, 100.0)));
            const glm::dvec2 d(std::floor(random(1.0, 100.0)), std::floor(random(1.0, 100.0)));
            t = {glm::vec<2, T>(a), glm::vec<2, T>(a + 3.0 * d), glm::vec<2, T>(a + 7.0 * d)};
        }
    }
    return result;
}

void orientation_warpshadow(benchmark::State& state, bool on_a_line) {
    cycle(state, triples<float>(on_a_line),
          [](const auto& t) { return warpshadow::orient2d(t[0], t[1], t[2]); });
}

void orientation_warpshadow_double(benchmark::State& state, bool on_a_line) {
    cycle(state, triples<double>(on_a_line),
          [](const auto& t) { return warpshadow::orient2d(t[0], t[1], t[2]); });
}

void orientation_cgal(benchmark::State& state, bool on_a_line) {
    std::vector<std::array<kernel::Point_2, 3>> points;
    for (const auto& t : triples<double>(on_a_line)) {
        points.push_back({kernel::Point_2(t[0].x, t[0].y), kernel::Point_2(t[1].x, t[1].y),
                          kernel::Point_2(t[2].x, t[2].y)});
    }
    cycle(state, points, [](const auto& t) { return CGAL::orientation(t[0], t[1], t[2]); });
}

// Frustum and box --------------------------------------------------------------------------------

void body_warpshadow_vertices(benchmark::State& state) {
    cycle(state, all_scenes(), [](const scene& s) {
        return warpshadow::intersection_vertices(s.corners, s.planes, s.box).count;
    });
}

void body_warpshadow_body(benchmark::State& state) {
    cycle(state, all_scenes(),
          [](const scene& s) { return warpshadow::intersection(s.corners, s.box).count; });
}

/// The box cut by the frustum's planes; false if nothing is left.
bool cut_by_voro(const scene& s, voro::voronoicell& cell) {
    cell.init(double(s.box.lo.x), double(s.box.hi.x), double(s.box.lo.y), double(s.box.hi.y),
              double(s.box.lo.z), double(s.box.hi.z));
    for (const glm::vec4& p : s.planes) {
        if (!cell.plane(-double(p.x), -double(p.y), -double(p.z), 2.0 * double(p.w))) {
            return false;
        }
    }
    return true;
}

void body_voro(benchmark::State& state) {
    voro::voronoicell cell;
    std::vector<double> vertices;
    cycle(state, all_scenes(), [&](const scene& s) {
        vertices.clear();
        if (cut_by_voro(s, cell)) {
            cell.vertices(vertices);
        }
        return vertices.size();
    });
}

void body_bullet(benchmark::State& state) {
    btAlignedObjectArray<btVector3> planes;
    btAlignedObjectArray<btVector3> vertices;
    cycle(state, all_scenes(), [&](const scene& s) {
        planes.resize(0);
        vertices.resize(0);
        const auto add = [&](double x, double y, double z, double d) {
            btVector4 plane{btScalar(x), btScalar(y), btScalar(z), btScalar(d)};
            planes.push_back(plane);
        };
        for (const glm::vec4& p : s.planes) {
            add(-double(p.x), -double(p.y), -double(p.z), -double(p.w));
        }
        for (int k = 0; k < 3; ++k) {
            const double axis[3] = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
            add(-axis[0], -axis[1], -axis[2], double(s.box.lo[k]));
            add(axis[0], axis[1], axis[2], -double(s.box.hi[k]));
        }
        btGeometryUtil::getVerticesFromPlaneEquations(planes, vertices);
        return vertices.size();
    });
}

// From frustum and box to the rectangle in the light plane ---------------------------------------

void chain_warpshadow(benchmark::State& state) {
    cycle(state, all_scenes(), [](const scene& s) {
        const auto body = warpshadow::intersection_vertices(s.corners, s.planes, s.box);
        std::array<glm::vec2, decltype(body)::capacity> points;
        for (std::size_t i = 0; i < body.count; ++i) {
            points[i] = {glm::dot(body.points[i], s.light_right),
                         glm::dot(body.points[i], s.light_up)};
        }
        return warpshadow::min_area_rectangle<float>(std::span(points).first(body.count)).area;
    });
}

void chain_voro_opencv(benchmark::State& state) {
    voro::voronoicell cell;
    std::vector<double> vertices;
    std::vector<cv::Point2f> points;
    cycle(state, all_scenes(), [&](const scene& s) {
        points.clear();
        if (cut_by_voro(s, cell)) {
            cell.vertices(vertices);
            for (std::size_t i = 0; i + 2 < vertices.size(); i += 3) {
                const glm::vec3 p(vertices[i], vertices[i + 1], vertices[i + 2]);
                points.emplace_back(glm::dot(p, s.light_right), glm::dot(p, s.light_up));
            }
        }
        return points.empty() ? 0.0f : cv::minAreaRect(points).size.width;
    });
}

// ------------------------------------------------------------------------------------------------

#define SIZED(function, kind, size) BENCHMARK_CAPTURE(function, kind##_##size, shape::kind, size)
#define RECTANGLES(kind, size)                                                                     \
    SIZED(rectangle_warpshadow, kind, size);                                                       \
    SIZED(rectangle_warpshadow_double, kind, size);                                                \
    SIZED(rectangle_opencv, kind, size);                                                           \
    SIZED(rectangle_cgal, kind, size);                                                             \
    SIZED(rectangle_geos, kind, size)
#define HULLS(kind, size)                                                                          \
    SIZED(hull_warpshadow, kind, size);                                                            \
    SIZED(hull_warpshadow_double, kind, size);                                                     \
    SIZED(hull_opencv, kind, size);                                                                \
    SIZED(hull_cgal, kind, size);                                                                  \
    SIZED(hull_boost, kind, size);                                                                 \
    SIZED(hull_geos, kind, size)

RECTANGLES(body, 0);
RECTANGLES(disk, 8);
RECTANGLES(disk, 16);
RECTANGLES(disk, 24);
RECTANGLES(disk, 32);
RECTANGLES(disk, 64);
RECTANGLES(disk, 1000);
HULLS(body, 0);
HULLS(disk, 64);
HULLS(disk, 1000);
HULLS(disk, 100000);
HULLS(rim, 100000);
BENCHMARK_CAPTURE(orientation_warpshadow, random, false);
BENCHMARK_CAPTURE(orientation_warpshadow, on_a_line, true);
BENCHMARK_CAPTURE(orientation_warpshadow_double, random, false);
BENCHMARK_CAPTURE(orientation_warpshadow_double, on_a_line, true);
BENCHMARK_CAPTURE(orientation_cgal, random, false);
BENCHMARK_CAPTURE(orientation_cgal, on_a_line, true);
BENCHMARK(body_warpshadow_vertices);
BENCHMARK(body_warpshadow_body);
BENCHMARK(body_voro);
BENCHMARK(body_bullet);
BENCHMARK(chain_warpshadow);
BENCHMARK(chain_voro_opencv);

} // namespace
