#include "lab/method_table.hpp"

#include <algorithm>
#include <array>

namespace lab {

namespace ws = warpshadow;

namespace {

/// Of the Gaussian of rectilinear tables, 12 of 512 cells: where importance is summed, wider is
/// better than the published 3.
constexpr float sigma = 12.0f / 512.0f;

constexpr std::array methods{
    method{.name = "sm"},
    method{.name = "stable", .base = map_base::stable},
    method{.name = "min-sm", .base = map_base::minimal},
    method{.name = "dv", .desired_view = true},
    // parallel-split shadow maps (Zhang et al. 2006), practical splits
    method{.name = "pssm", .base = map_base::cascades, .partitions = 4},
    // sample distribution shadow maps (Lauritzen et al. 2011), in equal ratios of depth
    method{.name = "sdsm", .partitions = 4, .desired_view = true},
    method{.name = "lispsm", .base = map_base::lispsm},
    method{.name = "fitted", .desired_view = true, .fitted = true},
    method{.name = "fitted-2", .partitions = 2, .desired_view = true, .fitted = true},
    method{.name = "min-sm-notw", .base = map_base::minimal, .warp = true},
    method{.name = "lispsm-notw", .base = map_base::lispsm, .desired_view = true, .warp = true},
    method{.name = "fitted-notw", .desired_view = true, .fitted = true, .warp = true},
    // what each sample adds to its row grows less than linearly: lines that are seen much get less
    method{.name = "notw",
           .desired_view = true,
           .warp = true,
           .tables = {.power = 2.0f / 3.0f, .build = {.window = 0.25f, .floor = 0.1f}},
           .for_points = "cube-notw"},
    // narrower windows, whose neighbours blend, and finer tables to hold them
    method{.name = "notw-fine",
           .desired_view = true,
           .warp = true,
           .tables = {.power = 0.6f,
                      .build = {.window = 0.08f, .floor = 0.1f, .shape = ws::window_shape::tent},
                      .tables = 256},
           .for_points = "cube-notw"},
    method{.name = "notw-nodv", .warp = true},
    method{.name = "notw-edges",
           .desired_view = true,
           .warp = true,
           .tables = {.shadows = known_shadows::last_frame,
                      .share = 0.5f,
                      .power = 2.0f / 3.0f,
                      .build = {.window = 0.25f, .floor = 0.1f}},
           .for_points = "cube-notw"},
    method{.name = "notw-oracle",
           .desired_view = true,
           .warp = true,
           .tables = {.shadows = known_shadows::truth,
                      .share = 0.5f,
                      .power = 2.0f / 3.0f,
                      .build = {.window = 0.25f, .floor = 0.1f}},
           .for_points = "cube-notw"},
    // the same, and what lies near the ends of shadows alone counts: one sample in four tells as
    // well
    method{.name = "notw-hybrid",
           .desired_view = true,
           .warp = true,
           .tables = {.from = analysis::hybrid,
                      .functions = {.edge = true, .alpha = 0.02f},
                      .edges = edge_kind::shadow_end,
                      .power = 0.5f,
                      .build = {.window = 0.1f, .floor = 0.05f, .shape = ws::window_shape::tent},
                      .tables = 256,
                      .every = 2},
           .for_points = "cube-notw"},
    // Rosen's forward analysis knows nothing of the view but its frustum
    method{.name = "rtw-forward",
           .base = map_base::minimal,
           .warp = true,
           .tables = {.from = analysis::forward,
                      .functions = {.distance = true, .edge = true, .alpha = 0.1f},
                      .cells = ws::cell_rule::largest,
                      .rectilinear = true,
                      .width = sigma},
           .for_points = "cube-notw"},
    method{.name = "rtw-backward",
           .desired_view = true,
           .warp = true,
           .tables = {.rectilinear = true, .width = sigma},
           .for_points = "cube-notw"},
    method{.name = "rtw-hybrid",
           .desired_view = true,
           .warp = true,
           .tables = {.from = analysis::hybrid,
                      .functions = {.edge = true, .alpha = 0.1f},
                      .rectilinear = true,
                      .width = sigma},
           .for_points = "cube-notw"},
    method{.name = "cube6", .base = map_base::all_around},
    method{.name = "cube6-cull", .base = map_base::all_around, .omni = {.cull_objects = true}},
    method{.name = "cube6-efc",
           .base = map_base::all_around,
           .omni = {.cull_maps = true, .cull_objects = true}},
    method{.name = "cube6-gs", .base = map_base::all_around, .omni = {.layered = true}},
    method{.name = "cube6-cull-gs",
           .base = map_base::all_around,
           .omni = {.cull_objects = true, .layered = true}},
    method{.name = "cube6-efc-gs",
           .base = map_base::all_around,
           .omni = {.cull_maps = true, .cull_objects = true, .layered = true}},
    method{.name = "dpsm", .base = map_base::all_around, .omni = {.hemispheres = true}},
    method{.name = "dpsm-cull",
           .base = map_base::all_around,
           .omni = {.hemispheres = true, .cull_objects = true}},
    method{.name = "dpsm-pc",
           .base = map_base::all_around,
           .omni = {.hemispheres = true, .cull_maps = true, .cull_objects = true}},
    method{.name = "dpsm-gs",
           .base = map_base::all_around,
           .omni = {.hemispheres = true, .layered = true}},
    method{.name = "dpsm-cull-gs",
           .base = map_base::all_around,
           .omni = {.hemispheres = true, .cull_objects = true, .layered = true}},
    method{.name = "dpsm-pc-gs",
           .base = map_base::all_around,
           .omni = {.hemispheres = true, .cull_maps = true, .cull_objects = true, .layered = true}},
    method{.name = "cube-notw",
           .base = map_base::all_around,
           .desired_view = true,
           .warp = true,
           .omni = {.cull_maps = true}},
    method{.name = "dpsm-notw",
           .base = map_base::all_around,
           .desired_view = true,
           .warp = true,
           .omni = {.hemispheres = true, .cull_maps = true}},
};

constexpr auto names = [] {
    std::array<std::string_view, methods.size() + 2> result;
    std::transform(methods.begin(), methods.end(), result.begin(),
                   [](const method& each) { return each.name; });
    result[methods.size()] = "sv";
    result.back() = "raytraced";
    return result;
}();

} // namespace

std::span<const std::string_view> method_names() {
    return names;
}

const method& find_method(std::string_view name) {
    const auto* const found = std::find_if(methods.begin(), methods.end(),
                                           [&](const method& each) { return each.name == name; });
    if (found == methods.end()) {
        throw bad_input("no such method: " + std::string(name));
    }
    return *found;
}

bool follows_the_view(const method& how) {
    return how.base != map_base::whole_scene || how.desired_view;
}

bool drawn_one_by_one(const method& how) {
    return how.base != map_base::all_around || how.warp;
}

bool has_maps(std::string_view name) {
    return name != "sv" && name != "raytraced";
}

bool has_tables(std::string_view name) {
    return has_maps(name) && find_method(name).warp;
}

std::optional<std::string> why_not(std::string_view name, const light_view& light) {
    if (!has_maps(name)) {
        return std::nullopt;
    }
    const method& how = find_method(name);
    if (how.base == map_base::all_around && light.light.kind != ws::light_kind::point) {
        return "faces of a cube and paraboloids are for a light that shines all around";
    }
    if (!how.for_points.empty() && light.light.kind == ws::light_kind::point) {
        return "for a point light it is called " + std::string(how.for_points);
    }
    if ((how.base == map_base::stable || how.base == map_base::cascades) &&
        light.light.kind != ws::light_kind::directional) {
        return "a texel of a fixed size has no meaning for a light with a position";
    }
    if (light.light.kind == ws::light_kind::point && how.partitions > 1) {
        return "partitions of the view and faces of a cube do not go together";
    }
    if (light.light.kind == ws::light_kind::point && !follows_the_view(how)) {
        return "a point light shines all around and has no single map";
    }
    return std::nullopt;
}

std::optional<std::string> why_not(std::string_view name, precision set_up) {
    if (set_up == precision::in_float && has_maps(name) &&
        find_method(name).base == map_base::all_around) {
        return "cubes and paraboloids are set up in double";
    }
    return std::nullopt;
}

std::optional<std::string> why_not(std::string_view name, const light_view& light,
                                   const bias_choice& bias) {
    if (!has_maps(name)) {
        return std::nullopt;
    }
    const method& how = find_method(name);
    if (how.omni.hemispheres) {
        return bias.label + " is for maps of depth, and paraboloids hold distances";
    }
    if (bias.depth == depth_kind::hyperbolic) {
        return std::nullopt;
    }
    if (!drawn_one_by_one(how)) {
        return bias.label + " is for maps drawn one by one";
    }
    if (how.warp) {
        return bias.label + " is for maps without tables";
    }
    if (bias.depth == depth_kind::linear && light.light.kind == ws::light_kind::point) {
        return bias.label + " is for lights with one map";
    }
    if (bias.depth == depth_kind::linear && how.base == map_base::lispsm &&
        light.light.kind != ws::light_kind::directional) {
        return bias.label + " is for sunlight where the map's own matrix warps";
    }
    return std::nullopt;
}

} // namespace lab
