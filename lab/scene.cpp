#include "lab/scene.hpp"

#include "lab/numbers.hpp"
#include "lab/scene_builder.hpp"
#include "lab/scene_detail.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

namespace lab {
namespace {

constexpr std::array<scene_summary, 4> summaries{{
    {"outdoor", "field, fence, trees and houses over 400 m of uneven ground; suns, one lamp"},
    {"colonnade", "columns and arches over a floor of two triangles; suns, one spot light"},
    {"interior", "a furnished room with many small things; lamp, spot light, sun by the window"},
    {"leaves", "wire, gratings, spokes and leaves: thin casters; suns, one spot light"},
}};

} // namespace

std::span<const scene_summary> builtin_scenes() {
    return summaries;
}

bool is_builtin_scene(std::string_view name) {
    return std::any_of(summaries.begin(), summaries.end(),
                       [&](const scene_summary& each) { return each.name == name; });
}

scene build_scene(std::string_view name, unsigned seed) {
    if (name == "outdoor") {
        return build_outdoor(seed);
    }
    if (name == "colonnade") {
        return build_colonnade(seed);
    }
    if (name == "interior") {
        return build_interior(seed);
    }
    if (name == "leaves") {
        return build_leaves(seed);
    }
    throw bad_input("there is no built-in scene '" + std::string(name) + "'");
}

scene open_scene(const std::string& name_or_path, unsigned seed) {
    if (is_builtin_scene(name_or_path)) {
        return build_scene(name_or_path, seed);
    }
    const std::size_t colon = name_or_path.find(':');
    if (colon != std::string::npos && is_builtin_scene(name_or_path.substr(0, colon))) {
        const std::string text = name_or_path.substr(colon + 1);
        const std::optional<std::size_t> corners = number<std::size_t>(text);
        if (corners.value_or(0) < 1) {
            throw bad_input("--scene NAME:CORNERS wants a whole number from 1 on, not '" + text +
                            "'");
        }
        scene world = build_scene(name_or_path.substr(0, colon), seed);
        refine(world, *corners);
        return world;
    }
    const std::filesystem::path path(name_or_path);
    if (!path.has_extension() && !std::filesystem::exists(path)) {
        std::string names;
        for (const scene_summary& each : summaries) {
            names += (names.empty() ? "" : ", ") + std::string(each.name);
        }
        throw bad_input("unknown scene '" + name_or_path + "'; built in are " + names +
                        ", and any .obj, .gltf or .glb file can be given");
    }
    return load_scene(name_or_path);
}

} // namespace lab
