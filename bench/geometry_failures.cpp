// Writes the table of failures: smallest rectangles and hulls of libraries on hard sets of points,
// judged in exact arithmetic.
//
// geometry_failures [FILE.md [FILE.json]]: Markdown to the file, or to the standard output, and the
// same numbers as JSON. WARPSHADOW_SETS sets per class (400 if it is not set). Exit status 1 if
// warpshadow fails anywhere.
//
// A rectangle fails if its area exceeds the smallest by a factor of 1e-3 (float) or 1e-9 (double),
// or if a point lies outside by 1e-5 or 1e-12 diameters, both beyond the rounding of what is
// returned; if it is not finite; or if the call throws, crashes or does not end in 10 seconds.
// Of sets with a NaN or an infinity only a report passes: an exception, a status, or a result that
// is not finite. A hull fails if its vertices are not those of the exact hull.
#include "arguments.hpp"
#include "exact_geometry.hpp"
#include "point_sets.hpp"

#include <warpshadow/calipers.hpp>
#include <warpshadow/hull.hpp>

#define USE_UNSTABLE_GEOS_CPP_API // silences a warning of GEOS: this is its C++ interface

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/convex_hull_2.h>
#include <CGAL/min_quadrilateral_2.h>
#include <CGAL/version.h>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/multi_point.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/version.hpp>
#include <geos/algorithm/MinimumDiameter.h>
#include <geos/geom/Coordinate.h>
#include <geos/geom/CoordinateSequence.h>
#include <geos/geom/Geometry.h>
#include <geos/geom/GeometryFactory.h>
#include <geos/geom/MultiPoint.h>
#include <geos/version.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace {

using exact::real;
template <typename T> using points = point_sets::points<T>;

// What a library says -----------------------------------------------------------------------------

/// Four corners of a rectangle, in order; or word that the input was not accepted.
template <typename T> struct rectangle_answer {
    std::array<glm::dvec2, 4> corners{};
    bool reported = false; // a status or an exception
};

template <typename T> struct hull_answer {
    std::vector<glm::vec<2, T>> vertices;
    bool reported = false;
};

template <typename T> rectangle_answer<T> warpshadow_rectangle(const points<T>& set) {
    points<T> scratch(set.size());
    const auto r = warpshadow::min_area_rectangle<T>(set, scratch);
    const glm::dvec2 c(r.centre);
    const glm::dvec2 u = double(r.half_extents.x) * glm::dvec2(r.axis);
    const glm::dvec2 v = double(r.half_extents.y) * glm::dvec2(-double(r.axis.y), double(r.axis.x));
    return {{c - u - v, c + u - v, c + u + v, c - u + v},
            warpshadow::any(r.flags, warpshadow::status::invalid_input)};
}

rectangle_answer<float> opencv_rectangle(const points<float>& set) {
    std::vector<cv::Point2f> input;
    for (const auto& p : set) {
        input.emplace_back(p.x, p.y);
    }
    cv::Point2f corners[4];
    cv::minAreaRect(input).points(corners);
    rectangle_answer<float> answer;
    for (std::size_t i = 0; i < 4; ++i) {
        answer.corners[i] = {double(corners[i].x), double(corners[i].y)};
    }
    return answer;
}

template <typename Kernel, typename T>
std::vector<typename Kernel::Point_2> cgal_hull_of(const points<T>& set) {
    std::vector<typename Kernel::Point_2> input;
    for (const auto& p : set) {
        input.emplace_back(double(p.x), double(p.y));
    }
    std::vector<typename Kernel::Point_2> hull;
    CGAL::convex_hull_2(input.begin(), input.end(), std::back_inserter(hull));
    return hull;
}

template <typename Kernel, typename T> rectangle_answer<T> cgal_rectangle(const points<T>& set) {
    const auto hull = cgal_hull_of<Kernel>(set);
    std::vector<typename Kernel::Point_2> corners;
    if (hull.size() < 3) { // its precondition; a segment is the rectangle
        corners = {hull.front(), hull.back(), hull.back(), hull.front()};
    } else {
        CGAL::min_rectangle_2(hull.begin(), hull.end(), std::back_inserter(corners));
    }
    rectangle_answer<T> answer;
    for (std::size_t i = 0; i < 4; ++i) {
        answer.corners[i] = {CGAL::to_double(corners.at(i).x()),
                             CGAL::to_double(corners.at(i).y())};
    }
    return answer;
}

template <typename T> std::unique_ptr<geos::geom::Geometry> geos_points(const points<T>& set) {
    std::vector<geos::geom::Coordinate> input;
    for (const auto& p : set) {
        input.emplace_back(double(p.x), double(p.y));
    }
    return std::unique_ptr<geos::geom::Geometry>(
        geos::geom::GeometryFactory::getDefaultInstance()->createMultiPoint(input));
}

template <typename T> rectangle_answer<T> geos_rectangle(const points<T>& set) {
    const auto input = geos_points(set);
    const auto rectangle = geos::algorithm::MinimumDiameter::getMinimumRectangle(input.get());
    const auto corners = rectangle->getCoordinates();
    rectangle_answer<T> answer;
    const std::size_t last = corners->getSize() - 1; // a point or a segment has fewer
    const std::size_t at[4] = {0, std::min<std::size_t>(1, last),
                               std::min<std::size_t>(last < 2 ? 1 : 2, last),
                               last < 2 ? 0 : std::min<std::size_t>(3, last)};
    for (std::size_t i = 0; i < 4; ++i) {
        answer.corners[i] = {corners->getAt(at[i]).x, corners->getAt(at[i]).y};
    }
    return answer;
}

template <typename T> hull_answer<T> warpshadow_hull(const points<T>& set) {
    points<T> work = set;
    const auto result = warpshadow::convex_hull(std::span(work));
    work.resize(result.count);
    return {work, warpshadow::any(result.flags, warpshadow::status::invalid_input)};
}

hull_answer<float> opencv_hull(const points<float>& set) {
    std::vector<cv::Point2f> input;
    std::vector<cv::Point2f> hull;
    for (const auto& p : set) {
        input.emplace_back(p.x, p.y);
    }
    cv::convexHull(input, hull);
    hull_answer<float> answer;
    for (const auto& p : hull) {
        answer.vertices.push_back({p.x, p.y});
    }
    return answer;
}

template <typename Kernel, typename T> hull_answer<T> cgal_hull(const points<T>& set) {
    hull_answer<T> answer;
    for (const auto& p : cgal_hull_of<Kernel>(set)) {
        answer.vertices.push_back({static_cast<T>(p.x()), static_cast<T>(p.y())});
    }
    return answer;
}

template <typename T> hull_answer<T> geos_hull(const points<T>& set) {
    const auto hull = geos_points(set)->convexHull();
    const auto ring = hull->getCoordinates();
    hull_answer<T> answer;
    for (std::size_t i = 0; i < ring->getSize(); ++i) {
        answer.vertices.push_back(
            {static_cast<T>(ring->getAt(i).x), static_cast<T>(ring->getAt(i).y)});
    }
    return answer;
}

template <typename T> hull_answer<T> boost_hull(const points<T>& set) {
    namespace bg = boost::geometry;
    using point = bg::model::d2::point_xy<T>;
    bg::model::multi_point<point> input;
    for (const auto& p : set) {
        bg::append(input, point(p.x, p.y));
    }
    bg::model::polygon<point> hull;
    bg::convex_hull(input, hull);
    hull_answer<T> answer;
    for (const auto& p : hull.outer()) {
        answer.vertices.push_back({p.x(), p.y()});
    }
    return answer;
}

// Judgement ---------------------------------------------------------------------------------------

/// In how many ways sets of a class failed.
enum verdict : unsigned char {
    passed,
    too_large,
    not_enclosing,
    not_finite,
    silent,
    threw,
    crashed,
    wrong_hull,
    verdicts
};
constexpr const char* verdict_names[verdicts] = {"passed",     "not smallest", "not enclosing",
                                                 "not finite", "silent",       "exception",
                                                 "crash",      "wrong hull"};

template <typename T>
verdict judge(const points<T>& set, bool finite, const rectangle_answer<T>& answer) {
    if (answer.reported) {
        return finite ? silent : passed;
    }
    for (const glm::dvec2& c : answer.corners) {
        if (!std::isfinite(c.x) || !std::isfinite(c.y)) {
            return finite ? not_finite : passed;
        }
    }
    if (!finite) {
        return silent;
    }
    constexpr bool single = sizeof(T) == 4;
    const real diameter = exact::diameter<T>(set);
    // Corners are rounded to T: half an epsilon of their coordinates, whatever they bound.
    real size = 0;
    for (const glm::dvec2& c : answer.corners) {
        size = std::max(size, real(std::max(std::abs(c.x), std::abs(c.y))));
    }
    const real rounding = 2 * real(std::numeric_limits<T>::epsilon()) * size;
    const real tolerance = real(single ? 1e-5 : 1e-12) * diameter + rounding;

    const auto side = [&](std::size_t a, std::size_t b) {
        return std::array<real, 2>{real(answer.corners[b].x) - real(answer.corners[a].x),
                                   real(answer.corners[b].y) - real(answer.corners[a].y)};
    };
    const auto length_of = [](const std::array<real, 2>& v) {
        return real(sqrt(v[0] * v[0] + v[1] * v[1]));
    };
    std::array<real, 2> u = side(0, 1);
    const std::array<real, 2> v = side(1, 2);
    const real a = length_of(u);
    const real b = length_of(v);
    // The longer side gives the axis: it is the better conditioned one.
    if (b > a) {
        u = {v[1], -v[0]};
    }
    const real longer = std::max(a, b);
    const std::array<real, 2> axis = longer > 0 ? std::array<real, 2>{u[0] / longer, u[1] / longer}
                                                : std::array<real, 2>{real(1), real(0)};
    std::array<real, 2> lo{};
    std::array<real, 2> hi{};
    const auto along = [&](const real& x, const real& y, int k) {
        const real dx = x - real(answer.corners[0].x);
        const real dy = y - real(answer.corners[0].y);
        return k == 0 ? real(axis[0] * dx + axis[1] * dy) : real(axis[0] * dy - axis[1] * dx);
    };
    for (const glm::dvec2& c : answer.corners) {
        for (int k = 0; k < 2; ++k) {
            const real d = along(c.x, c.y, k);
            lo[static_cast<std::size_t>(k)] = std::min(lo[static_cast<std::size_t>(k)], d);
            hi[static_cast<std::size_t>(k)] = std::max(hi[static_cast<std::size_t>(k)], d);
        }
    }
    for (const auto& p : set) {
        for (int k = 0; k < 2; ++k) {
            const real d = along(real(p.x), real(p.y), k);
            if (d < lo[static_cast<std::size_t>(k)] - tolerance ||
                d > hi[static_cast<std::size_t>(k)] + tolerance) {
                return not_enclosing;
            }
        }
    }
    const real area = (hi[0] - lo[0]) * (hi[1] - lo[1]);
    const real best = exact::smallest_area(exact::on_grid<T>(set));
    // A rectangle with rounded corners is longer and wider by the rounding.
    const real allowed =
        best * (1 + real(single ? 1e-3 : 1e-9)) + 4 * rounding * (diameter + rounding) +
        real(single ? 1e-5 : 1e-12) * real(std::numeric_limits<T>::epsilon()) * diameter * diameter;
    return area > allowed ? too_large : passed;
}

template <typename T> verdict judge(const points<T>& set, bool finite, hull_answer<T> answer) {
    if (!finite) {
        return answer.reported ? passed : silent;
    }
    auto& hull = answer.vertices;
    if (hull.size() > 1 && hull.front() == hull.back()) { // a closed ring
        hull.pop_back();
    }
    // Libraries start where they like and run either way: compare as sets.
    std::vector<glm::vec<2, T>> expected;
    for (const std::size_t i : exact::hull(exact::on_grid<T>(set).points)) {
        expected.push_back(set[i]);
    }
    const auto before = [](const auto& p, const auto& q) {
        return p.x != q.x ? p.x < q.x : p.y < q.y;
    };
    std::sort(hull.begin(), hull.end(), before);
    hull.erase(std::unique(hull.begin(), hull.end()), hull.end()); // rings of one or two points
    std::sort(expected.begin(), expected.end(), before);
    return hull == expected ? passed : wrong_hull;
}

// Running -----------------------------------------------------------------------------------------

using counts = std::array<std::uint32_t, verdicts>;

/// Runs every set of a class in a process of its own, which may crash: then the next one goes on.
template <typename T, typename Run>
counts run_class(const point_sets::kind& kind, std::uint64_t sets, Run run) {
    counts result{};
    for (std::uint64_t next = 0; next < sets;) {
        int ends[2];
        if (pipe(ends) != 0) {
            std::perror("pipe");
            std::exit(2);
        }
        const pid_t child = fork();
        if (child == 0) {
            close(ends[0]);
            std::freopen("/dev/null", "w", stderr); // libraries complain there
            for (std::uint64_t seed = next; seed < sets; ++seed) {
                alarm(10);
                unsigned char verdict_of_set = threw;
                const points<T> set = point_sets::make<T>(kind.name, seed);
                try {
                    verdict_of_set = judge(set, kind.finite, run(set));
                } catch (...) {
                    verdict_of_set = kind.finite ? threw : passed; // an exception is a report
                }
                if (write(ends[1], &verdict_of_set, 1) != 1) {
                    _exit(2);
                }
            }
            _exit(0);
        }
        close(ends[1]);
        unsigned char verdict_of_set = 0;
        while (read(ends[0], &verdict_of_set, 1) == 1) {
            ++result[verdict_of_set];
            ++next;
        }
        close(ends[0]);
        int status = 0;
        waitpid(child, &status, 0);
        if (next < sets && !(WIFEXITED(status) && WEXITSTATUS(status) == 0)) {
            ++result[crashed];
            ++next;
        }
    }
    return result;
}

template <typename T> struct candidate {
    std::string name;
    std::function<counts(const point_sets::kind&, std::uint64_t)> run;
};

template <typename T, typename Run> candidate<T> make_candidate(std::string name, Run run) {
    return {std::move(name), [run](const point_sets::kind& kind, std::uint64_t sets) {
                return run_class<T>(kind, sets, run);
            }};
}

std::string cell(const counts& c) {
    std::ostringstream out;
    for (std::size_t v = 1; v < verdicts; ++v) {
        if (c[v] != 0) {
            out << (out.tellp() > 0 ? ", " : "") << c[v] << ' ' << verdict_names[v];
        }
    }
    return out.tellp() > 0 ? out.str() : "0";
}

/// Writes one table and adds its numbers to the JSON; returns the failures of the first candidate.
template <typename T>
std::uint64_t table(std::ostream& out, nlohmann::ordered_json& json, const std::string& title,
                    const std::vector<candidate<T>>& candidates, std::uint64_t sets) {
    out << "\n## " << title << "\n\n| class (sets) |";
    for (const auto& c : candidates) {
        out << ' ' << c.name << " |";
    }
    out << "\n|---|";
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        out << "---|";
    }
    out << '\n';
    std::vector<std::uint64_t> failures(candidates.size());
    for (const point_sets::kind& kind : point_sets::kinds) {
        const std::uint64_t count = kind.cited ? 4 : sets;
        out << "| " << kind.name << " (" << count << ") |";
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const counts c = candidates[i].run(kind, count);
            nlohmann::ordered_json& entry = json[title][std::string(kind.name)][candidates[i].name];
            for (std::size_t v = 0; v < verdicts; ++v) {
                if (c[v] != 0) {
                    entry[verdict_names[v]] = c[v];
                }
                failures[i] += v == passed ? 0 : c[v];
            }
            out << ' ' << cell(c) << " |";
        }
        out << '\n' << std::flush;
    }
    out << "| **all** |";
    for (const std::uint64_t f : failures) {
        out << " **" << f << "** |";
    }
    out << '\n';
    return failures[0];
}

template <typename T> std::vector<candidate<T>> rectangle_candidates() {
    using epick = CGAL::Exact_predicates_inexact_constructions_kernel;
    using cartesian = CGAL::Simple_cartesian<double>;
    std::vector<candidate<T>> result{make_candidate<T>("warpshadow", warpshadow_rectangle<T>)};
    if constexpr (sizeof(T) == 4) {
        result.push_back(make_candidate<T>("OpenCV " CV_VERSION, opencv_rectangle));
    }
    result.push_back(
        make_candidate<T>("CGAL " CGAL_VERSION_STR ", exact predicates", cgal_rectangle<epick, T>));
    result.push_back(
        make_candidate<T>("CGAL " CGAL_VERSION_STR ", double", cgal_rectangle<cartesian, T>));
    result.push_back(make_candidate<T>("GEOS " GEOS_VERSION, geos_rectangle<T>));
    return result;
}

template <typename T> std::vector<candidate<T>> hull_candidates() {
    using epick = CGAL::Exact_predicates_inexact_constructions_kernel;
    using cartesian = CGAL::Simple_cartesian<double>;
    std::vector<candidate<T>> result{make_candidate<T>("warpshadow", warpshadow_hull<T>)};
    if constexpr (sizeof(T) == 4) {
        result.push_back(make_candidate<T>("OpenCV " CV_VERSION, opencv_hull));
    }
    result.push_back(
        make_candidate<T>("CGAL " CGAL_VERSION_STR ", exact predicates", cgal_hull<epick, T>));
    result.push_back(
        make_candidate<T>("CGAL " CGAL_VERSION_STR ", double", cgal_hull<cartesian, T>));
    result.push_back(make_candidate<T>("GEOS " GEOS_VERSION, geos_hull<T>));
    result.push_back(make_candidate<T>("Boost " BOOST_LIB_VERSION, boost_hull<T>));
    return result;
}

} // namespace

int main(int argc, char** argv) {
    bench::expect_values(argc, argv, 2,
                         "[WARPSHADOW_SETS=400] geometry_failures [FILE.md [FILE.json]]");
    std::signal(SIGPIPE, SIG_IGN);
    const char* const asked = std::getenv("WARPSHADOW_SETS");
    const std::uint64_t sets = asked != nullptr ? std::strtoull(asked, nullptr, 10) : 400;
    std::ofstream file;
    if (argc > 1) {
        file.open(argv[1]);
    }
    std::ostream& out = argc > 1 ? file : std::cout;
    nlohmann::ordered_json json;
    out << "# Failures on hard point sets\n\nOf each class the number of sets that failed, and "
           "how. "
           "How they are judged: bench/geometry_failures.cpp.\n";
    std::uint64_t failures = 0;
    failures +=
        table<float>(out, json, "Smallest rectangle, float", rectangle_candidates<float>(), sets);
    failures += table<double>(out, json, "Smallest rectangle, double",
                              rectangle_candidates<double>(), sets);
    failures += table<float>(out, json, "Convex hull, float", hull_candidates<float>(), sets);
    failures += table<double>(out, json, "Convex hull, double", hull_candidates<double>(), sets);
    if (argc > 2) {
        std::ofstream(argv[2]) << json.dump(2) << '\n';
    }
    return failures == 0 ? 0 : 1;
}
