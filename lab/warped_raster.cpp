#include "lab/warped_raster.hpp"

#include "lab/numbers.hpp"
#include "lab/truth.hpp"

#include <warpshadow/warp_strength.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lab {

namespace {

/// Hulls: edges above this share of the map are cut without a look at where they go.
constexpr double longest_walk = 0.125;
/// What a hull may cover in vain before it is cut: texels, and a share of what it holds.
constexpr double excess_texels = 64.0;
constexpr double excess_share = 0.5;

/// Halvings of an edge that are enough for all: 2^-20 of the map is less than its rounding.
constexpr int most_halvings = 20;

constexpr std::size_t source_bytes = 48;
constexpr std::size_t piece_bytes = 32;

/// Buffer bindings of the shaders.
enum binding : GLuint { on_sides = 5, on_source = 0, on_crossing = 1 };

struct kind_name {
    std::string_view name;
    raster_kind kind;
};
constexpr std::array kinds{
    kind_name{"none", raster_kind::none},   kind_name{"fragment", raster_kind::fragment},
    kind_name{"rule", raster_kind::rule},   kind_name{"bound", raster_kind::bound},
    kind_name{"hull", raster_kind::hull},   kind_name{"exact", raster_kind::exact},
    kind_name{"ideal", raster_kind::ideal},
};

bool has_value(raster_kind kind) {
    return kind == raster_kind::rule || kind == raster_kind::bound;
}

} // namespace

raster_choice parse_raster(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string_view name = std::string_view(text).substr(0, colon);
    const auto* const found = std::find_if(
        kinds.begin(), kinds.end(), [&](const kind_name& each) { return each.name == name; });
    if (found != kinds.end() && has_value(found->kind) == (colon != std::string::npos)) {
        raster_choice result{found->kind};
        if (!has_value(found->kind)) {
            return result;
        }
        if (const auto value = number_in(text.substr(colon + 1), 0.1, 100.0)) {
            result.value = *value;
            return result;
        }
    }
    throw bad_input("--raster wants none, fragment, rule:PERCENT, bound:TEXELS (0.1 to 100), hull, "
                    "exact or ideal, not '" +
                    text + "'");
}

std::string raster_name(const raster_choice& choice) {
    for (const kind_name& each : kinds) {
        if (each.kind == choice.kind) {
            char number[32] = "";
            if (has_value(choice.kind)) {
                std::snprintf(number, sizeof number, ":%g", choice.value);
            }
            return std::string(each.name) + number;
        }
    }
    return {};
}

warped_raster::warped_raster(passes& gpu)
    : gpu_(gpu), lists_(piece_bytes), texels_(gpu),
      sides_(2 * sizeof(std::uint32_t), nullptr, GL_DYNAMIC_DRAW) {
    predict_ = gpu_.compute("predict_gain.comp");
    passes::set_units(predict_);
    for (std::size_t i = 0; i < weaken_.size(); ++i) {
        weaken_[i] = gpu_.compute("weaken_table.comp",
                                  {"TABLE_FORMAT " + image_format(static_cast<table_format>(i))});
    }
    const std::size_t triangles = gpu_.world().triangles.size();
    sources_ =
        gl::buffer((triangles + triangles / 2 + 1024) * source_bytes, nullptr, GL_DYNAMIC_COPY);
    crossing_ = gl::buffer(std::max<std::size_t>(triangles, 1) * sizeof(std::uint32_t), nullptr,
                           GL_DYNAMIC_COPY);
    lists_.make_room_for(triangles);
}

const warped_raster::steps& warped_raster::steps_for(raster_kind kind) {
    std::optional<steps>& found = steps_[static_cast<std::size_t>(kind)];
    if (!found) {
        const auto program = [&](const char* file, std::vector<std::string> defines) {
            const auto name = [&](const char* text, raster_kind which) {
                defines.push_back(text + std::to_string(static_cast<int>(which)));
            };
            name("RASTER ", kind);
            name("RASTER_RULE ", raster_kind::rule);
            name("RASTER_BOUND ", raster_kind::bound);
            name("RASTER_HULL ", raster_kind::hull);
            return gpu_.compute(file, defines);
        };
        found = {program("triangle_setup.comp", {}),
                 program("triangle_setup.comp", {"LISTED", "CLIPPED"}),
                 program("triangle_cut.comp", {}),
                 kind == raster_kind::none
                     ? gpu_.link("shadow_warped.vert", "empty.frag", {"INTERPOLATED"})
                 : kind == raster_kind::hull
                     ? gpu_.link("shadow_warped.vert", "shadow_warped.frag", {"COVERAGE"})
                     : gpu_.link("shadow_warped.vert", "shadow_warped.frag")};
    }
    return *found;
}

void warped_raster::prepare(const steps& use, std::size_t index, int size,
                            const raster_choice& choice) {
    const double texels = size;
    const double longest = choice.kind == raster_kind::rule   ? choice.value / 100.0
                           : choice.kind == raster_kind::hull ? longest_walk
                                                              : 2.0;
    for (const gl::program* program : {&use.within, &use.crossing, &use.cut}) {
        program->set("map_index", static_cast<int>(index));
        program->set("longest", static_cast<float>(longest));
        program->set("deviation", static_cast<float>(choice.value / texels));
        program->set("map_texels", static_cast<float>(texels));
        program->set("excess_floor", static_cast<float>(excess_texels / (texels * texels)));
        program->set("excess_share", static_cast<float>(excess_share));
    }
}

void warped_raster::set_up(const steps& use) {
    lists_.begin();
    gpu_.bind_triangles();
    sources_.bind_base(GL_SHADER_STORAGE_BUFFER, on_source);
    crossing_.bind_base(GL_SHADER_STORAGE_BUFFER, on_crossing);
    const std::size_t triangles = gpu_.world().triangles.size();
    use.within.set("triangle_count", static_cast<unsigned>(triangles));
    use.within.dispatch_over(triangles);
    gl::wait_for_writes();
    const std::uint32_t crossing = lists_.counts().crossing;
    if (crossing > 0) {
        use.crossing.set("triangle_count", crossing);
        use.crossing.dispatch_over(crossing);
        gl::wait_for_writes();
    }
}

void warped_raster::draw_exact(map_resources& maps, std::size_t index) {
    gpu_.timed_pass("set up triangles", [&] { texels_.sort(maps, index); });
    gpu_.timed_pass("shadow map", [&] { texels_.draw(maps, index); });
}

double warped_raster::weaken(map_resources& maps, std::size_t index) {
    float share = 0.0f;
    gpu_.timed_pass("weaken", [&] {
        sides_.fill(0);
        sides_.bind_base(GL_SHADER_STORAGE_BUFFER, on_sides);
        passes::bind_tables(maps, index);
        predict_.set("map_index", static_cast<int>(index));
        predict_.dispatch((gpu_.view().x + 3) / 4, (gpu_.view().y + 3) / 4);
        gl::wait_for_writes();
        const std::vector<std::uint32_t> sides = sides_.read<std::uint32_t>();
        mean_side_ = sides[1] == 0 ? 1.0f
                                   : static_cast<float>(static_cast<double>(sides[0]) /
                                                        (256.0 * static_cast<double>(sides[1])));
        share = warpshadow::weakening(mean_side_);
        if (share > 0.0f) {
            const gl::texture& rows = maps.warps[index].rows;
            const gl::texture& columns = maps.warps[index].columns;
            const gl::program& weaken = weaken_[rows.format() == GL_R16 ? 1 : 0];
            weaken.set("share", share);
            for (const gl::texture* table : {&rows, &columns}) {
                table->bind_image(0, GL_READ_WRITE);
                weaken.dispatch(table->width(), table->height());
                gl::wait_for_writes();
            }
        }
    });
    if (share > 0.0f) {
        gpu_.find_centres(maps, index);
    }
    return static_cast<double>(share);
}

void warped_raster::draw_map(map_resources& maps, std::size_t index, const raster_choice& choice,
                             const ray_tracer* rays, bool count) {
    if (choice.kind == raster_kind::ideal) {
        if (rays != nullptr) {
            gpu_.timed_pass("shadow map", [&] { trace_map(maps, index, *rays); });
        }
        return;
    }
    by_texel_ = choice.kind == raster_kind::exact;
    if (by_texel_) {
        draw_exact(maps, index);
        if (count) {
            lists_.count(texels_.counts());
        }
        return;
    }
    const steps& use = steps_for(choice.kind);
    gpu_.timed_pass("set up triangles", [&] {
        prepare(use, index, maps.size, choice);
        set_up(use);
    });
    gpu_.timed_pass("cut triangles", [&] {
        // three halvings, one of each edge, make a triangle half as large; mostly few are needed
        lists_.cut(use.cut, choice.kind < raster_kind::rule ? 0 : 3 * most_halvings);
    });
    gpu_.timed_pass("shadow map", [&] {
        maps.targets[index].bind();
        glClear(GL_DEPTH_BUFFER_BIT);
        use.draw.use();
        sources_.bind_base(GL_SHADER_STORAGE_BUFFER, on_source);
        lists_.draw();
    });
    if (count) {
        lists_.count(lists_.counts());
    }
}

void warped_raster::trace_map(map_resources& maps, std::size_t index, const ray_tracer& rays) {
    const glm::dmat4 matrix(gpu_.matrix_in_use(index));
    const glm::dmat4 inverse = glm::inverse(matrix);
    const std::vector<glm::vec2> centres = maps.warps[index].centres.read<glm::vec2>();
    std::vector<glm::dvec3> from(centres.size());
    std::vector<glm::dvec3> to(centres.size());
    for (std::size_t i = 0; i < centres.size(); ++i) {
        const glm::dvec2 ndc = 2.0 * glm::dvec2(centres[i]) - 1.0;
        const glm::dvec4 nearest = inverse * glm::dvec4(ndc, -1.0, 1.0);
        const glm::dvec4 farthest = inverse * glm::dvec4(ndc, 1.0, 1.0);
        from[i] = glm::dvec3(nearest) / nearest.w;
        to[i] = glm::dvec3(farthest) / farthest.w;
    }
    const std::vector<double> hits = rays.first_hits(from, to);
    std::vector<float> depth(centres.size(), 1.0f);
    for (std::size_t i = 0; i < centres.size(); ++i) {
        if (hits[i] <= 1.0) {
            const glm::dvec4 clip = matrix * glm::dvec4(from[i] + hits[i] * (to[i] - from[i]), 1.0);
            depth[i] = static_cast<float>(std::clamp(clip.z / clip.w * 0.5 + 0.5, 0.0, 1.0));
        }
    }
    glBindTexture(GL_TEXTURE_2D_ARRAY, maps.depth.id());
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, static_cast<GLint>(index), maps.size, maps.size,
                    1, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
}

std::size_t warped_raster::list_bytes() const {
    std::size_t most = 0;
    std::size_t sources = 0;
    std::size_t crossing = 0;
    for (const triangle_counts& each : lists_.counted()) {
        most = std::max(most, texels_.bytes(each));
        sources = std::max<std::size_t>(sources, each.sources);
        crossing = std::max<std::size_t>(crossing, each.crossing);
    }
    return by_texel_ ? most
                     : sources * source_bytes + crossing * sizeof(std::uint32_t) + lists_.bytes();
}

bool warped_raster::grow_lists() {
    const bool lost = lists_.lost_some();
    if (by_texel_) {
        // keeps the counts of what remains lost
        if (!lost || !texels_.grow()) {
            return false;
        }
        lists_.forget_counts();
        return true;
    }
    // what was lost is a source or a piece: both lists grow
    if (!lists_.grow()) {
        return false;
    }
    if (lost) {
        sources_ = gl::buffer(2 * sources_.bytes(), nullptr, GL_DYNAMIC_COPY);
    }
    return true;
}

} // namespace lab
