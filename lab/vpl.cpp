#include "lab/vpl.hpp"

#include "gl/timer.hpp"
#include "lab/numbers.hpp"
#include "lab/plot.hpp"
#include "lab/scene_builder.hpp"
#include "lab/shaders.hpp"
#include "lab/statistics.hpp"

#include <warpshadow/casters.hpp>
#include <warpshadow/conventions.hpp>
#include <warpshadow/cube.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/paraboloid.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lab {

namespace ws = warpshadow;

namespace {

constexpr std::size_t lights_of_a_run = 16;
constexpr std::size_t usual_points = 100000;
constexpr std::size_t most_points = std::size_t{1} << 26;
constexpr std::size_t points_of_a_group = 1024;

/// Depth of a face starts at this share of the reach.
constexpr double near_share = 0x1p-10;

/// The face behind the surface: the last one, against the axis.
constexpr std::uint32_t faces_before = ws::all_faces & ~(1u << 5);

struct surface_point {
    glm::vec3 position;
    std::size_t triangle;
};

/// Draws places evenly over the area of a scene.
class surface {
  public:
    surface(const scene& world, unsigned seed) : world_(world), random_(seed) {
        double sum = 0.0;
        for (const glm::uvec3& t : world.triangles) {
            const glm::dvec3 a(world.positions[t.x]);
            sum += glm::length(glm::cross(glm::dvec3(world.positions[t.y]) - a,
                                          glm::dvec3(world.positions[t.z]) - a));
            areas_.push_back(sum);
        }
    }

    surface_point draw() {
        const double wanted = static_cast<double>(random_.unit()) * areas_.back();
        const std::size_t i =
            std::min(static_cast<std::size_t>(
                         std::upper_bound(areas_.begin(), areas_.end(), wanted) - areas_.begin()),
                     areas_.size() - 1);
        const float root = std::sqrt(random_.unit());
        const float share = random_.unit();
        const glm::uvec3 t = world_.triangles[i];
        return {(1.0f - root) * world_.positions[t.x] +
                    root * (1.0f - share) * world_.positions[t.y] +
                    root * share * world_.positions[t.z],
                i};
    }

  private:
    const scene& world_;
    random_source random_;
    std::vector<double> areas_; ///< twice the areas up to and with each triangle
};

void split(std::span<glm::vec3> points, std::size_t first, point_cloud& result) {
    glm::vec3 lo = points.front();
    glm::vec3 hi = lo;
    for (const glm::vec3& p : points) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    if (points.size() <= points_of_a_group) {
        const glm::dvec3 centre = 0.5 * (glm::dvec3(lo) + glm::dvec3(hi));
        double radius = 0.0;
        for (const glm::vec3& p : points) {
            radius = std::max(radius, glm::length(glm::dvec3(p) - centre));
        }
        result.groups.push_back({first, points.size()});
        result.balls.push_back({centre, radius});
        return;
    }
    const glm::vec3 size = hi - lo;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = points.size() / 2;
    std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half),
                     points.end(), [axis](const glm::vec3& a, const glm::vec3& b) {
                         return a[axis] != b[axis] ? a[axis] < b[axis]
                                : a.x != b.x       ? a.x < b.x
                                : a.y != b.y       ? a.y < b.y
                                                   : a.z < b.z;
                     });
    split(points.first(half), first, result);
    split(points.subspan(half), first + half, result);
}

glm::dmat3 axes_of(const virtual_light& light) {
    const ws::light_frame_result<double> frame = ws::light_frame(light.normal);
    return {frame.right, frame.up, frame.forward};
}

gl::program program_of(const char* vertex) {
    const gl::shader_library library{gl::glsl_files(), lab_shaders()};
    return gl::program({{GL_VERTEX_SHADER, library.load(vertex)},
                        {GL_FRAGMENT_SHADER, library.load("lab/empty.frag")}});
}

} // namespace

point_cloud make_points(const scene& world, std::size_t count, unsigned seed) {
    point_cloud result;
    surface places(world, seed);
    result.points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        result.points.push_back(places.draw().position);
    }
    if (count > 0) {
        split(std::span(result.points), 0, result);
    }
    return result;
}

std::vector<virtual_light> make_virtual_lights(const scene& world, std::size_t count,
                                               unsigned seed) {
    std::vector<virtual_light> result;
    surface places(world, seed + 1u);
    const glm::dvec3 middle = 0.5 * (world.box.lo + world.box.hi);
    while (result.size() < count) {
        const surface_point at = places.draw();
        const glm::uvec3 t = world.triangles[at.triangle];
        const glm::dvec3 a(world.positions[t.x]);
        const glm::dvec3 normal =
            glm::cross(glm::dvec3(world.positions[t.y]) - a, glm::dvec3(world.positions[t.z]) - a);
        const glm::dvec3 place(at.position);
        if (glm::length(normal) > 0.0) {
            const double side = glm::dot(normal, middle - place) < 0.0 ? -1.0 : 1.0;
            result.push_back({place, side * glm::normalize(normal)});
        }
    }
    return result;
}

vpl_passes::vpl_passes(const scene& world, const point_cloud& cloud, int map_size)
    : cloud_(cloud), size_(map_size), reach_(glm::length(world.box.hi - world.box.lo)),
      draw_face_(program_of("lab/vpl_face.vert")), draw_half_(program_of("lab/vpl_half.vert")),
      points_(std::span<const glm::vec3>(cloud.points)), faces_(map_size, 6, 0, 0),
      hemispheres_(map_size, 2, 0, 0), masks_(cloud.groups.size()) {
    array_.bind();
    points_.bind(GL_ARRAY_BUFFER);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    glBindVertexArray(0);
}

void vpl_passes::sort_groups(const virtual_light& light, const glm::dmat3& axes,
                             const vpl_way& way) {
    if (!way.cull) {
        std::fill(masks_.begin(), masks_.end(),
                  static_cast<std::uint8_t>(way.hemispheres ? ws::both_sides : ws::all_faces));
        return;
    }
    constexpr double far = std::numeric_limits<double>::infinity();
    const glm::dvec3 origin(0.0);
    for (std::size_t i = 0; i < masks_.size(); ++i) {
        const ws::sphere3<double>& ball = cloud_.balls[i];
        std::uint32_t mask = ws::caster_sides(light.position, light.normal, ball).mask & 1u;
        if (mask != 0u && !way.hemispheres) {
            const ws::sphere3<double> turned{(ball.centre - light.position) * axes, ball.radius};
            mask = ws::caster_faces(origin, turned, far).mask & faces_before;
        }
        masks_[i] = static_cast<std::uint8_t>(mask);
    }
}

void vpl_passes::draw_points(std::size_t map) {
    firsts_.clear();
    counts_.clear();
    for (std::size_t i = 0; i < masks_.size(); ++i) {
        if ((masks_[i] >> map & 1u) == 0u) {
            continue;
        }
        const triangle_range& group = cloud_.groups[i];
        if (!firsts_.empty() &&
            static_cast<std::size_t>(firsts_.back() + counts_.back()) == group.first) {
            counts_.back() += static_cast<GLsizei>(group.count);
        } else {
            firsts_.push_back(static_cast<GLint>(group.first));
            counts_.push_back(static_cast<GLsizei>(group.count));
        }
    }
    glClear(GL_DEPTH_BUFFER_BIT);
    glMultiDrawArrays(GL_POINTS, firsts_.data(), counts_.data(),
                      static_cast<GLsizei>(firsts_.size()));
}

int vpl_passes::draw(const virtual_light& light, const vpl_way& way) {
    const glm::dmat3 axes = axes_of(light);
    sort_groups(light, axes, way);
    const std::uint8_t any = std::accumulate(
        masks_.begin(), masks_.end(), std::uint8_t{0},
        [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a | b); });
    map_resources& maps = way.hemispheres ? hemispheres_ : faces_;
    const gl::program& program = way.hemispheres ? draw_half_ : draw_face_;
    const glm::dmat3 from_world = glm::transpose(axes);
    program.set("from_world", glm::mat3(from_world));
    program.set("light", glm::vec3(light.position));
    program.set("reach", static_cast<float>(reach_));
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    if (way.hemispheres) {
        glEnable(GL_CLIP_DISTANCE0);
    }
    array_.bind();
    program.use();
    int drawn = 0;
    for (std::size_t map = 0; map < maps.targets.size(); ++map) {
        if ((any >> map & 1u) == 0u) {
            continue;
        }
        if (way.hemispheres) {
            program.set("side", static_cast<int>(map));
        } else {
            const ws::frustum<double> face =
                ws::face_camera(glm::dvec3(0.0), static_cast<int>(map), ws::cube_api::opengl,
                                near_share * reach_, reach_)
                    .value;
            program.set("face", glm::mat4(ws::projection_matrix(face.volume, ws::clip::opengl) *
                                          ws::view_matrix(face, ws::clip::opengl)));
        }
        maps.targets[map].bind();
        draw_points(map);
        ++drawn;
    }
    glDisable(GL_CLIP_DISTANCE0);
    return drawn;
}

std::vector<float> vpl_passes::depths(const vpl_way& way, int map) const {
    const std::vector<float> all = (way.hemispheres ? hemispheres_ : faces_).depth.read<float>();
    const auto texels = static_cast<std::ptrdiff_t>(size_) * size_;
    return {all.begin() + map * texels, all.begin() + (map + 1) * texels};
}

bool is_vpl(const std::string& preset) {
    return preset == "vpl" || preset.starts_with("vpl:");
}

std::size_t points_of_vpl(const std::string& preset) {
    if (preset == "vpl") {
        return usual_points;
    }
    const std::string text = preset.substr(4);
    const std::optional<std::size_t> value = number_in<std::size_t>(text, 1, most_points);
    if (!value) {
        throw bad_input("--preset vpl:POINTS wants 1 to " + std::to_string(most_points) +
                        " points, not '" + text + "'");
    }
    return *value;
}

figure_defaults defaults_of_vpl() {
    return {"interior", "0", "0", 256, {512, 512}};
}

std::size_t runs_of_vpl() {
    return lights_of_a_run * vpl_ways.size();
}

void run_vpl(const options& wanted, const scene& world, results& all, progress_bar& progress) {
    const point_cloud cloud = make_points(world, points_of_vpl(wanted.preset), wanted.seed);
    const int map = wanted.maps.front();
    vpl_passes passes(world, cloud, map);
    vpl_record record{world.name, cloud.points.size(), cloud.groups.size(), map, {}};
    for (const vpl_way& way : vpl_ways) {
        record.ways.push_back({std::string(way.name), {}, {}});
    }
    gl::stopwatch watch(gl::best_timing());
    const std::vector<virtual_light> lights =
        make_virtual_lights(world, lights_of_a_run, wanted.seed);
    for (const virtual_light& light : lights) {
        std::array<std::vector<double>, vpl_ways.size()> times;
        // in turn, so that a busy moment is not one way's alone; the first turn warms up
        for (int turn = 0; turn <= wanted.repeat; ++turn) {
            for (std::size_t way = 0; way < vpl_ways.size(); ++way) {
                stop_if_asked();
                progress.show(world.name + " " + std::string(vpl_ways[way].name));
                watch.start();
                const int maps = passes.draw(light, vpl_ways[way]);
                const double ms = watch.stop();
                if (turn == 0) {
                    record.ways[way].maps.push_back(maps);
                } else {
                    times[way].push_back(ms);
                }
            }
        }
        for (std::size_t way = 0; way < vpl_ways.size(); ++way) {
            record.ways[way].ms.push_back(median(times[way]));
            progress.advance();
        }
    }
    gl::check("virtual lights");
    all.vpls.push_back(std::move(record));
}

std::string vpl_section(const results& all, std::size_t index) {
    const vpl_record& record = all.vpls[index];
    std::vector<frame_series> series;
    for (std::size_t way = 0; way < record.ways.size(); ++way) {
        frame_series one{record.ways[way].way, way, {0.0}};
        double sum = 0.0;
        for (const double ms : record.ways[way].ms) {
            sum += ms;
            one.values.emplace_back(sum);
        }
        series.push_back(std::move(one));
    }
    std::string rows;
    for (const vpl_record::way_record& way : record.ways) {
        const double maps = std::accumulate(way.maps.begin(), way.maps.end(), 0.0) /
                            static_cast<double>(std::max<std::size_t>(way.maps.size(), 1));
        rows += "<tr><th>" + escaped(way.way) + "</th><td>" + fixed(maps, 1) + "</td><td>" +
                short_number(std::accumulate(way.ms.begin(), way.ms.end(), 0.0)) + "</td></tr>\n";
    }
    return "<section class=\"figure\">\n<h2>" + escaped(record.scene) +
           ", after figure 13 of Navratil 2012</h2>\n<p>" + std::to_string(record.points) +
           " points in " + std::to_string(record.groups) + " groups, maps of " +
           std::to_string(record.map) + "²; lights on surfaces shine to one side.</p>\n" +
           frame_plot(series, "shadow maps, ms") +
           "<table><tr><th></th><th>maps a light</th><th>ms, all lights</th></tr>\n" + rows +
           "</table>\n</section>\n";
}

} // namespace lab
