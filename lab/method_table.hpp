// The shadow methods by name: what each is made of, and to which lights it applies.
#pragma once

#include "lab/bias.hpp"
#include "lab/omni.hpp"
#include "lab/scene.hpp"
#include "lab/warp_options.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lab {

/// Which matrices a method starts from.
enum class map_base {
    whole_scene, ///< all that the light reaches
    stable,      ///< the ball around the view, on a fixed grid
    cascades,    ///< the same for slices of the view
    minimal,     ///< what the camera can see
    lispsm,      ///< the same, warped by one matrix
    all_around   ///< faces or hemispheres of a point light
};

/// A method as the steps that it takes.
struct method {
    std::string_view name;
    map_base base = map_base::whole_scene;
    int partitions = 1;               ///< maps by view depth
    bool desired_view = false;        ///< crop to the lit view samples
    bool fitted = false;              ///< projective warp fitted to the lit view samples
    bool warp = false;                ///< tables, and triangles cut for them
    omni_way omni = {};               ///< of maps all around
    warp_options tables = {};         ///< how they are made, with `warp`
    std::string_view for_points = {}; ///< the method that does this for point lights, if not this
};

/// All method names, "raytraced" last.
std::span<const std::string_view> method_names();

/// Whether a method has shadow maps: all but "sv" (see lab/volumes.hpp) and "raytraced".
[[nodiscard]] bool has_maps(std::string_view name);

/// The method of a name that `has_maps`; throws `bad_input` for an unknown one.
const method& find_method(std::string_view name);

/// Whether the maps of a method are fitted to the view: a point light then has maps for what is
/// seen of its cube.
[[nodiscard]] bool follows_the_view(const method& how);

/// Whether the steps that all kinds of light share draw the maps, and not those of lab/omni.hpp.
[[nodiscard]] bool drawn_one_by_one(const method& how);

/// Whether a method, of any name, has maps with tables.
[[nodiscard]] bool has_tables(std::string_view name);

/// Why the method does not apply to the light, or nothing when it does.
[[nodiscard]] std::optional<std::string> why_not(std::string_view name, const light_view& light);

/// Why a method cannot be set up at a precision, or nothing when it can.
[[nodiscard]] std::optional<std::string> why_not(std::string_view name, precision set_up);

/// Why a bias does not apply to a method that applies to the light, or nothing when it does.
[[nodiscard]] std::optional<std::string> why_not(std::string_view name, const light_view& light,
                                                 const bias_choice& bias);

} // namespace lab
