// What each way to fit a map to a view wastes, how a turning view moves it, and a drawing of one
// fit.
//
// geometry_fits [FILE.json [FILE.svg]]: JSON to the file, or to the standard output.
//
// Cameras stand on flat ground of 200 by 200 units under a roof of 15 units, which is where the
// casters end; the light is the sun at 15 to 80 degrees. Two things are counted as used: the
// footprint of the receivers' body (view ∩ bounds, all that a fit without samples can know), and
// the convex hull of the ground points that 160 by 90 pixels see.
#include "arguments.hpp"
#include "geometry_inputs.hpp"

#include <warpshadow/fit.hpp>
#include <warpshadow/focus.hpp>
#include <warpshadow/hull.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/shadow_frustum.hpp>
#include <warpshadow/stable_fit.hpp>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace ws = warpshadow;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using ws::fit_frame;
using ws::sun;

constexpr double degree = std::numbers::pi / 180.0;
constexpr ws::box3<double> bounds{dvec3(-100.0, 0.0, -100.0), dvec3(100.0, 15.0, 100.0)};
constexpr int map_size = 1024;

ws::frustum<double> camera_at(const dvec3& eye, const dvec3& forward, double far_distance,
                              double fov_y = 60.0 * degree) {
    return ws::make_frustum(eye, forward, dvec3(0.0, 1.0, 0.0),
                            ws::perspective_volume(fov_y, 16.0 / 9.0, 0.1, far_distance))
        .value;
}

dvec2 in_map(const dmat4& matrix, const dvec3& p) {
    return dvec2(matrix * glm::dvec4(p, 1.0)) * 0.5 + 0.5;
}

/// Share of the map inside the convex hull of points of it.
double used_share(std::vector<dvec2> points) {
    const std::size_t count = ws::convex_hull(std::span(points)).count;
    return ws::detail::polygon_area(std::span<const dvec2>(points).first(count));
}

/// Area that an orthographic map covers across the light.
double covered_area(const dmat4& matrix) {
    const auto row = [&](int k) { return dvec3(matrix[0][k], matrix[1][k], matrix[2][k]); };
    return 4.0 / (glm::length(row(0)) * glm::length(row(1)));
}

std::vector<dvec3> ground_seen(const ws::frustum<double>& camera) {
    std::vector<dvec3> points;
    const ws::view_volume<double>& v = camera.volume;
    for (int j = 0; j < 90; ++j) {
        for (int i = 0; i < 160; ++i) {
            const double x = v.left + (v.right - v.left) * (i + 0.5) / 160.0;
            const double y = v.bottom + (v.top - v.bottom) * (j + 0.5) / 90.0;
            const dvec3 ray = camera.forward + x * camera.right + y * camera.up;
            const double t = -camera.eye.y / ray.y;
            const dvec3 p = camera.eye + t * ray;
            if (ray.y < 0.0 && t < v.far_distance && std::abs(p.x) < bounds.hi.x &&
                std::abs(p.z) < bounds.hi.z) {
                points.push_back(p);
            }
        }
    }
    return points;
}

dmat4 desired(const dmat4& light, const std::vector<dvec3>& seen) {
    std::vector<dvec2> samples;
    for (const dvec3& p : seen) {
        samples.push_back(in_map(light, p));
    }
    const auto found =
        ws::desired_view(std::span<const dvec2>(samples), 0.5 / static_cast<double>(map_size - 1));
    return ws::crop_matrix(light, found.rect).matrix;
}

nlohmann::json percentiles(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
        return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    return {{"p10", at(0.1)}, {"median", at(0.5)}, {"p90", at(0.9)}};
}

// Waste ------------------------------------------------------------------------------------------

struct tally {
    std::vector<double> outside_body, outside_ground, relative_area;
};

nlohmann::json waste(std::size_t views) {
    geometry_inputs::numbers random(4);
    std::vector<std::string> order;
    std::map<std::string, tally> tallies;
    for (std::size_t made = 0; made < views;) {
        const dvec3 eye(random(-80.0, 80.0), random(1.5, 8.0), random(-80.0, 80.0));
        const double yaw = random(0.0, 360.0 * degree);
        const dvec3 forward(std::sin(yaw), random(-0.5, 0.05), std::cos(yaw));
        const double turn = random(0.0, 360.0 * degree);
        const double height = random(15.0 * degree, 80.0 * degree);
        const dvec3 light(std::cos(height) * std::sin(turn), -std::sin(height),
                          std::cos(height) * std::cos(turn));
        const ws::frustum<double> camera = camera_at(eye, forward, 100.0);
        const std::vector<dvec3> ground = ground_seen(camera);
        const ws::focus_result seen =
            ws::focus(ws::focus_input<double>{camera, sun(light), bounds, bounds});
        if (ground.size() < 100 || seen.footprint_count < 3) {
            continue;
        }
        ++made;
        const auto smallest = ws::min_area_rectangle_of_hull(
            std::span<const dvec2>(seen.footprint.data(), seen.footprint_count));
        const auto record = [&](const std::string& name, const dmat4& matrix, bool whole_body) {
            std::vector<dvec2> body;
            std::vector<dvec2> points;
            for (std::size_t i = 0; i < seen.receivers.count; ++i) {
                body.push_back(in_map(matrix, seen.eye + dvec3(seen.receivers.vertices[i])));
            }
            for (const dvec3& p : ground) {
                points.push_back(in_map(matrix, p));
            }
            if (tallies.find(name) == tallies.end()) {
                order.push_back(name);
            }
            tally& t = tallies[name];
            if (whole_body) {
                t.outside_body.push_back(1.0 - used_share(body));
            }
            t.outside_ground.push_back(1.0 - used_share(points));
            t.relative_area.push_back(covered_area(matrix) / smallest.area);
        };
        const auto minimal = [&](fit_frame frame, bool snap) {
            ws::fit_options<double> options;
            options.frame = frame;
            options.snap = snap;
            options.map_size = glm::ivec2(map_size);
            return ws::minimal_shadow_frustum(seen, options).matrix;
        };
        const dmat4 whole =
            ws::directional_light_matrix(sun(light), bounds, ws::clip_space{}).matrix;
        ws::stable_options<double> stable;
        stable.map_size = map_size;
        record("whole scene", whole, true);
        record("stable", ws::stable_fit(camera, sun(light), bounds, stable).matrix, true);
        record("minimal, fixed frame, snapped", minimal(fit_frame::fixed, true), true);
        record("minimal, fixed frame", minimal(fit_frame::fixed, false), true);
        record("minimal, rotated", minimal(fit_frame::rotated_minimal, false), true);
        record("desired view of the whole scene", desired(whole, ground), false);
        record("desired view of minimal, rotated",
               desired(minimal(fit_frame::rotated_minimal, false), ground), false);
    }
    nlohmann::json rows = nlohmann::json::array();
    for (const std::string& name : order) {
        const tally& t = tallies[name];
        nlohmann::json row{{"fit", name},
                           {"outside_ground", percentiles(t.outside_ground)},
                           {"relative_area", percentiles(t.relative_area)}};
        if (!t.outside_body.empty()) {
            row["outside_body"] = percentiles(t.outside_body);
        }
        rows.push_back(row);
    }
    return {{"views", views}, {"rows", rows}};
}

// Yaw --------------------------------------------------------------------------------------------

nlohmann::json yaw(int frames) {
    struct policy {
        const char* name;
        fit_frame frame;
        double hysteresis, slew;
    };
    constexpr double any_angle = 360.0 * degree;
    const std::array<policy, 4> policies{{
        {"fixed frame", fit_frame::fixed, 0.0, 0.0},
        {"smallest rectangle of every frame", fit_frame::rotated_minimal, 0.0, any_angle},
        {"hysteresis 5 %", fit_frame::rotated_minimal, 0.05, any_angle},
        {"hysteresis 5 %, slew 0.25°", fit_frame::rotated_minimal, 0.05, 0.25 * degree},
    }};
    const std::array<dvec3, 3> lights{dvec3(0.5, -1.0, 0.25), dvec3(1.0, -0.4, -0.2),
                                      dvec3(0.3, -1.0, 0.8)};
    nlohmann::json rows = nlohmann::json::array();
    for (const policy& how : policies) {
        double mean = 0.0;
        double most = 0.0;
        double largest_step = 0.0;
        int jumps = 0;
        for (const dvec3& light : lights) {
            ws::fit_options<double> options;
            options.frame = how.frame;
            options.hysteresis = how.hysteresis;
            options.slew = how.slew;
            ws::fit_state state;
            double last = 0.0;
            for (int frame = 0; frame < frames; ++frame) {
                const double angle = 360.0 * degree * frame / frames;
                const auto camera = camera_at(dvec3(10.0, 2.0, -20.0),
                                              dvec3(std::sin(angle), -0.25, std::cos(angle)), 60.0);
                const auto fit = ws::minimal_shadow_frustum(
                    ws::focus(ws::focus_input<double>{camera, sun(light), bounds, bounds}), options,
                    state);
                mean += fit.excess_area / (frames * static_cast<double>(lights.size()));
                most = std::max(most, fit.excess_area);
                // a quarter turn gives the same sides
                const double step =
                    std::abs(std::remainder(fit.angle - last, 90.0 * degree)) / degree;
                if (frame > 0) {
                    largest_step = std::max(largest_step, step);
                    jumps += step > 1.0 ? 1 : 0;
                }
                last = fit.angle;
            }
        }
        rows.push_back({{"policy", how.name},
                        {"mean_excess_area", mean},
                        {"largest_excess_area", most},
                        {"largest_step_degrees", largest_step},
                        {"steps_above_1_degree", jumps}});
    }
    return {{"frames", frames}, {"lights", lights.size()}, {"rows", rows}};
}

// Drawing ----------------------------------------------------------------------------------------

/// The light's plane with everything that a fit goes by.
std::string drawing() {
    const dvec3 light(0.5, -1.0, 0.2);
    const ws::frustum<double> camera =
        camera_at(dvec3(-32.0, 8.0, -24.0), dvec3(0.75, -0.12, 0.5), 62.0, 25.0 * degree);
    const ws::box3<double> scene{dvec3(-40.0, 0.0, -40.0), dvec3(40.0, 10.0, 40.0)};
    const ws::focus_result seen =
        ws::focus(ws::focus_input<double>{camera, sun(light), scene, scene});
    const auto at = [&](const dvec3& from_eye) { // y downwards, as in the picture
        const dvec2 p(glm::dot(from_eye, seen.view.right), glm::dot(from_eye, seen.view.up));
        return dvec2(p.x, -p.y);
    };
    std::ostringstream shapes;
    shapes.precision(2);
    shapes << std::fixed;
    dvec2 lo(std::numeric_limits<double>::max());
    dvec2 hi = -lo;
    const auto polygon = [&](const char* kind, const std::vector<dvec2>& points) {
        shapes << "  <polygon class=\"" << kind << "\" points=\"";
        for (const dvec2& p : points) {
            shapes << (&p == &points.front() ? "" : " ") << p.x << ',' << p.y;
            lo = glm::min(lo, p);
            hi = glm::max(hi, p);
        }
        shapes << "\"/>\n";
    };
    const auto rectangle = [&](const char* kind, const ws::shadow_fit<double>& fit) {
        const dvec2 u(std::cos(fit.angle), std::sin(fit.angle));
        const dvec2 v(-u.y, u.x);
        std::vector<dvec2> corners;
        for (const dvec2& side :
             {dvec2(-1.0, -1.0), dvec2(1.0, -1.0), dvec2(1.0, 1.0), dvec2(-1.0, 1.0)}) {
            const dvec2 p = fit.centre + side * fit.half_extents; // along the turned axes
            corners.push_back(p.x * u + p.y * v);
        }
        for (dvec2& p : corners) {
            p.y = -p.y;
        }
        polygon(kind, corners);
    };
    const auto edges = [&](const char* kind, const auto& body) {
        for (std::size_t i = 0; i < body.count; ++i) {
            for (std::size_t j = i + 1; j < body.count; ++j) {
                const std::uint64_t shared = body.planes_at[i] & body.planes_at[j];
                if ((shared & (shared - 1)) == 0) {
                    continue; // fewer than two planes in common
                }
                const dvec2 a = at(dvec3(body.vertices[i]));
                const dvec2 b = at(dvec3(body.vertices[j]));
                shapes << "  <line class=\"" << kind << "\" x1=\"" << a.x << "\" y1=\"" << a.y
                       << "\" x2=\"" << b.x << "\" y2=\"" << b.y << "\"/>\n";
            }
        }
    };
    const dmat4 whole = ws::directional_light_matrix(sun(light), scene, ws::clip_space{}).matrix;
    std::vector<dvec2> whole_corners;
    const dmat4 inverse = glm::inverse(whole);
    for (const dvec2& corner :
         {dvec2(-1.0, -1.0), dvec2(1.0, -1.0), dvec2(1.0, 1.0), dvec2(-1.0, 1.0)}) {
        whole_corners.push_back(at(dvec3(inverse * glm::dvec4(corner, 0.0, 1.0)) - camera.eye));
    }
    polygon("whole", whole_corners);
    ws::fit_options<double> options;
    const ws::convex_body<double> box = ws::body_from_corners(
        ws::detail::corners_of(ws::box3<double>{scene.lo - camera.eye, scene.hi - camera.eye}));
    edges("scene", box);
    std::vector<dvec2> hull;
    for (std::size_t i = 0; i < seen.footprint_count; ++i) {
        hull.push_back({seen.footprint[i].x, -seen.footprint[i].y});
    }
    polygon("hull", hull);
    edges("body", seen.receivers);
    rectangle("fixed", ws::minimal_shadow_frustum(seen, options));
    options.frame = fit_frame::rotated_minimal;
    rectangle("rotated", ws::minimal_shadow_frustum(seen, options));
    const dvec2 eye = at(dvec3(0.0));
    shapes << "  <circle class=\"eye\" cx=\"" << eye.x << "\" cy=\"" << eye.y << "\" r=\"0.9\"/>\n";

    const std::array<std::array<const char*, 2>, 6> legend{
        {{"whole", "map of the whole scene"},
         {"scene", "the scene's box"},
         {"body", "receivers' body, and the eye"},
         {"hull", "its footprint (hull)"},
         {"fixed", "smallest map, fixed frame"},
         {"rotated", "smallest map, rotated"}}};
    std::ostringstream svg;
    svg.precision(2);
    svg << std::fixed;
    const double margin = 2.0;
    const double legend_width = 46.0;
    svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"" << lo.x - margin << ' '
        << lo.y - margin << ' ' << hi.x - lo.x + 2.0 * margin + legend_width << ' '
        << hi.y - lo.y + 2.0 * margin << "\" width=\"880\">\n"
        << "  <style>\n"
           "    svg { background: #fff }\n"
           "    polygon, line { fill: none; stroke-width: 0.4 }\n"
           "    .whole { stroke: #999; stroke-dasharray: 1.6 1 }\n"
           "    .scene { stroke: #bbb }\n"
           "    .body { stroke: #0072b2; stroke-width: 0.3 }\n"
           "    .hull { stroke: #0072b2; fill: #d6e9f5; stroke-width: 0.8 }\n"
           "    .fixed { stroke: #e69f00; stroke-width: 0.6 }\n"
           "    .rotated { stroke: #009e73; stroke-width: 0.6 }\n"
           "    .eye { fill: #0072b2 }\n"
           "    text { font: 2.6px sans-serif; fill: #333 }\n"
           "  </style>\n"
        << shapes.str();
    double y = lo.y + 2.0;
    for (const auto& [kind, text] : legend) {
        const double x = hi.x + margin + 1.0;
        svg << "  <line class=\"" << kind << "\" x1=\"" << x << "\" y1=\"" << y << "\" x2=\""
            << x + 5.0 << "\" y2=\"" << y << "\"/>\n"
            << "  <text x=\"" << x + 6.5 << "\" y=\"" << y + 0.9 << "\">" << text << "</text>\n";
        y += 4.5;
    }
    svg << "</svg>\n";
    return svg.str();
}

} // namespace

int main(int argc, char** argv) {
    bench::expect_values(argc, argv, 2, "geometry_fits [FILE.json [FILE.svg]]");
    const nlohmann::json json{{"waste", waste(1000)}, {"yaw", yaw(3600)}};
    if (argc > 1) {
        std::ofstream(argv[1]) << json.dump(2) << '\n';
    } else {
        std::cout << json.dump(2) << '\n';
    }
    if (argc > 2) {
        std::ofstream(argv[2]) << drawing();
    }
}
