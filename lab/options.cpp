#include "lab/options.hpp"

#include "lab/figures.hpp"
#include "lab/numbers.hpp"
#include "lab/sweep.hpp"
#include "lab/warp_arguments.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace lab {
namespace {

constexpr const char* examples = R"(Cameras and lights:
  a number takes a view that the scene brings (see --list-scenes);
  --camera ex,ey,ez,tx,ty,tz,fov      eye, target, vertical field of view in degrees
  --light sun:dx,dy,dz                direction in which the light travels
  --light spot:x,y,z,tx,ty,tz,angle   position, target, full cone angle in degrees
  --light point:x,y,z                 position

Biases (--bias), each measured by its acne and by how far shadows recede:
  plane                     the receiver's plane at the texel's centre, the default
  none                      the receiver's own depth
  constant[:VALUE]          less VALUE, 0 to 1 of the depth range; else the least without acne
  slope[:FACTOR[:UNITS]]    less the slope of the depth over a texel, as graphics APIs have it
  footprint                 less what the texel's footprint takes
  linear, back-face         none, with the light's own depth, or with back faces in the map;
                            slope+linear, footprint+back-face and so on

Filters (--filter) of the shadows in the pictures:
  none, pcf               hard edges; 2 x 2 texels
  blur                    2 x 2 texels, blurred in the picture
  pcf-texels:RADIUS       a square kernel, half its side in texels of the map as it is drawn: it
                          smooths the stairs, and a warp makes it wide here and narrow there
  pcf-light:RADIUS        half its side in scene units: as wide everywhere; each tap is moved in the
                          light's space and then warped
  pcf-footprint:RADIUS    the same with the warp taken as linear over the kernel

Ways to draw maps with tables (--raster); the warp bends edges, rasterisers draw straight ones:
  none            warped corners, all else interpolated
  fragment        the same, with the depth of the unwarped place per fragment
  rule:PERCENT    and edges cut down to a share of the map: 5, 2.5 and 1 in the papers
  bound:TEXELS    and edges cut until they surely depart by no more than so many texels
  hull            what surely holds the curved triangle is drawn, and each fragment asks whether
                  its unwarped place lies in the triangle
  exact           the same without a rasteriser, in compute: every texel in a box that surely holds
                  the curved triangle asks; the default
  ideal           no rasteriser: a ray per texel; the time is that of the CPU

Figures (--preset), over a scene, camera and light of your choice:
  figure6   biases (Scherzer 2005, figure 6): none, constant, slope-scale and footprint, each with
            hyperbolic and linear depth and with back faces, for lispsm, fitted and sm
  figure7   ways to draw warped maps (Rosen 2012, figure 7): rtw-backward and notw under every
            --raster, the same detail of each
  figure8   blur of the shadows in the picture (Scherzer 2005, figure 8): 0 to 16 iterations, the
            same everywhere and less with depth, for sm and lispsm
  vpl       shadow maps of virtual lights on the surfaces (Navratil 2012, figure 13), the scene as a
            cloud of 100000 points, or with vpl:POINTS of so many; cubes against paraboloids

Paths (--path), all with nothing but the camera in motion:
  yaw       turns on the spot, 0.1 degrees a frame
  forward   moves towards its target, a thousandth of the distance a frame
  strafe    moves to its right, a thousandth of the distance a frame
  orbit     turns around its target, 0.1 degrees a frame
  walk      moves through the scene's cameras in turn
  FILE      moves through the cameras of a file, one a line as for --camera

Examples:
  warpshadow-lab
  warpshadow-lab --scene leaves,colonnade --map 256,512,1024 --out report
  warpshadow-lab --scene house.glb --camera=-2.6,1.5,1.6,2.5,0.3,-1.5,65 --light sun:0.3,-1,0.2
  warpshadow-lab --scene outdoor --path yaw --frames 120 --methods sm,min-sm,dv
  warpshadow-lab --scene colonnade --methods sm,lispsm --bias constant,slope,footprint
  warpshadow-lab --preset figure6 --out figure6
  warpshadow-lab --scene outdoor --camera 0 --camera 2 --methods sm,notw --view 1920x1080
)";

int positive(const std::string& text, const char* option) {
    const std::optional<int> value = number<int>(text);
    if (!value || *value < 1) {
        throw bad_input(std::string(option) + " wants whole numbers from 1 on, not '" + text + "'");
    }
    return *value;
}

void check_methods(std::vector<std::string>& wanted, std::span<const std::string_view> known) {
    std::vector<std::string> result;
    const auto add = [&](std::string_view name) {
        if (std::find(result.begin(), result.end(), name) == result.end()) {
            result.emplace_back(name);
        }
    };
    for (const std::string& name : wanted) {
        if (name == "all") {
            std::for_each(known.begin(), known.end(), add);
            continue;
        }
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            std::string names;
            for (const std::string_view each : known) {
                names += (names.empty() ? "" : ", ") + std::string(each);
            }
            throw bad_input("unknown method '" + name + "'; there are " + names + ", and all");
        }
        add(name);
    }
    wanted = result;
}

/// One word of a POSIX shell.
std::string single_quoted(std::string_view text) {
    std::string result = "'";
    for (const char each : text) {
        result += each == '\'' ? std::string("'\\''") : std::string(1, each);
    }
    return result + "'";
}

/// The command line without the folder to write to, which is of no interest to a reader elsewhere.
std::string command_of(int argc, const char* const* argv) {
    std::string result = "warpshadow-lab";
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument == "--out") {
            ++i;
        } else if (!argument.starts_with("--out=")) {
            const bool plain =
                !argument.empty() &&
                argument.find_first_of(" \t\n'\"$`\\&|;<>()*?#~![]{}") == argument.npos;
            result += ' ';
            result += plain ? std::string(argument) : single_quoted(argument);
        }
    }
    return result;
}

} // namespace

raster_choice raster_of(const options& wanted) {
    return wanted.rasters.empty() ? raster_choice{} : wanted.rasters.front();
}

std::optional<options> parse_options(int argc, const char* const* argv,
                                     std::span<const std::string_view> methods) {
    options result;
    std::string sweep;
    CLI::App app("Renders scenes with shadow-mapping methods, counts the pixels that each gets "
                 "wrong against ray tracing, and writes a report.",
                 "warpshadow-lab");
    app.footer(examples);
    std::vector<std::string> scenes;
    std::vector<std::string> cameras;
    std::vector<std::string> lights;
    std::vector<std::string> wanted;
    std::vector<std::string> maps;
    std::string view;
    std::string repeat;
    std::string seed;
    std::string frames;
    std::vector<std::string> biases;
    std::string filter;
    std::vector<std::string> rasters;
    const auto list = [&](const char* name, std::vector<std::string>& to, const char* about) {
        app.add_option(name, to, about)->allow_extra_args(false);
    };
    list(
        "--scene", scenes,
        "Built-in scene or .obj, .gltf, .glb file; comma-separated or repeated; a built-in one may "
        "be "
        "NAME:CORNERS, its triangles cut until they have about so many corners (outdoor,interior)");
    app.add_flag("--list-scenes", result.list_scenes, "Print the built-in scenes and their views");
    list("--camera", cameras, "Camera, may be repeated (0)");
    list("--light", lights, "Light, may be repeated (0)");
    list("--methods", wanted,
         "Comma-separated methods, or all "
         "(sm,min-sm,dv,fitted,rtw-backward,notw,notw-hybrid,raytraced)");
    list("--map", maps, "Comma-separated sizes of the shadow map in texels (512)");
    app.add_option("--view", view, "Size of the picture, WxH (1024x768)");
    app.add_option("--repeat", repeat, "Frames that are timed after the warm-up (5)");
    list("--bias", biases, "Comma-separated biases to compare (plane, and not measured)");
    app.add_option("--filter", filter,
                   "Shadows in the pictures and in the times, see below; wrong pixels are counted "
                   "without (none)");
    list("--raster", rasters,
         "Comma-separated ways to draw maps with tables, to compare (exact); see below");
    std::string set_up;
    app.add_option("--setup", set_up,
                   "Type of matrices and fits on the host, float or double, which all are rounded "
                   "to float for the device (double)");
    warp_arguments tables;
    add_warp_arguments(app, tables);
    app.add_option("--preset", result.preset,
                   "Redo a figure of a paper: figure6, figure7, figure8, vpl or vpl:POINTS");
    app.add_option("--sweep", sweep,
                   "All methods at all sizes on all built-in scenes, what accuracy costs in time: "
                   "short or full (hours); what is given besides takes the place of its part, and "
                   "a sweep that was stopped goes on where it was")
        ->expected(0, 1)
        ->default_str("short");
    app.add_option("--path", result.path,
                   "Move the camera and follow every frame: yaw, forward, strafe, orbit, walk or a "
                   "file");
    app.add_option("--frames", frames, "Frames along the path (60)");
    app.add_option("--seed", seed, "Seed of the built-in scenes (1)");
    app.add_option("--out", result.out, "Folder of the report (warpshadow-report)");
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        std::fputs(app.help().c_str(), stdout);
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        std::string text = error.what();
        std::replace(text.begin(), text.end(), '\n', ' ');
        throw bad_input(text + " (see --help)");
    }

    if (app.count("--sweep") > 0) {
        // it varies these itself, one at a time
        const auto given = app.get_options([](CLI::Option* option) {
            return option->count() > 0 && option->get_group() == table_group;
        });
        if (!(result.preset.empty() && result.path.empty() && biases.empty() && filter.empty() &&
              rasters.empty() && set_up.empty() && given.empty())) {
            throw bad_input(
                "--sweep knows no --preset, --path, --bias, --filter, --raster, --setup "
                "and no options of warp tables");
        }
        const std::string out = result.out;
        const bool list_scenes = result.list_scenes;
        result = options_of_sweep(sweep.empty() ? "short" : sweep);
        result.out = out;
        result.list_scenes = list_scenes;
        if (!(scenes.empty() && lights.empty())) {
            result.point_lights.clear();
        }
    }
    result.command = command_of(argc, argv);
    result.tables = warp_wishes_of(tables);
    if (!set_up.empty()) {
        if (set_up != "float" && set_up != "double") {
            throw bad_input("--setup wants float or double, not '" + set_up + "'");
        }
        if (!result.preset.empty()) {
            throw bad_input("--preset knows no --setup");
        }
        result.set_up = set_up == "float" ? precision::in_float : precision::in_double;
    }

    const auto replace_if_given = [](std::vector<std::string>& target,
                                     const std::vector<std::string>& given) {
        if (given.empty()) {
            return;
        }
        target.clear();
        for (const std::string& each : given) {
            for (const std::string& part : split(each, ',')) {
                target.push_back(part);
            }
        }
    };
    if (!scenes.empty()) {
        result.scenes.clear();
        for (const std::string& each : scenes) {
            std::error_code error;
            if (std::filesystem::exists(each, error)) { // a file may have commas in its name
                result.scenes.push_back(each);
            } else {
                for (const std::string& part : split(each, ',')) {
                    result.scenes.push_back(part);
                }
            }
        }
    }
    if (!cameras.empty()) {
        result.cameras = cameras;
    }
    if (!lights.empty()) {
        result.lights = lights;
    }
    replace_if_given(result.methods, wanted);
    check_methods(result.methods, methods);
    if (!maps.empty()) {
        std::vector<std::string> texts;
        replace_if_given(texts, maps);
        result.maps.clear();
        for (const std::string& text : texts) {
            result.maps.push_back(positive(text, "--map"));
        }
    }
    if (!view.empty()) {
        const std::vector<std::string> sides = split(view, 'x');
        const std::optional<int> width = number<int>(sides.front());
        const std::optional<int> height = number<int>(sides.back());
        if (sides.size() != 2 || !width || !height || *width < 1 || *height < 1) {
            throw bad_input("--view wants WIDTHxHEIGHT in pixels, both from 1 on, not '" + view +
                            "'");
        }
        result.view = {*width, *height};
    }
    std::vector<std::string> bias_texts;
    replace_if_given(bias_texts, biases);
    for (const std::string& text : bias_texts) {
        result.biases.push_back(parse_bias(text));
    }
    std::vector<std::string> raster_texts;
    replace_if_given(raster_texts, rasters);
    for (const std::string& text : raster_texts) {
        result.rasters.push_back(parse_raster(text));
    }
    if (result.rasters.size() > 1 && !(result.path.empty() && result.preset.empty())) {
        throw bad_input("--path and --preset take one --raster");
    }
    if (!filter.empty()) {
        result.filter = parse_filter(filter);
    }
    if (!result.path.empty() && !(biases.empty() && filter.empty())) {
        throw bad_input("--bias and --filter are for a camera that stands still, not for --path");
    }
    if (!result.preset.empty()) {
        if (!(wanted.empty() && biases.empty() && filter.empty() && result.path.empty())) {
            throw bad_input("--preset brings its own --methods, --bias and --filter, and knows no "
                            "--path");
        }
        const figure_defaults defaults = defaults_of_figure(result.preset);
        if (result.preset == "figure7" && !rasters.empty()) {
            throw bad_input("--preset figure7 brings its own --raster");
        }
        const auto take = [](std::vector<std::string>& target, const auto& given,
                             const char* value) {
            if (given.empty()) {
                target = {value};
            }
        };
        take(result.scenes, scenes, defaults.scene);
        take(result.cameras, cameras, defaults.camera);
        take(result.lights, lights, defaults.light);
        if (maps.empty()) {
            result.maps = {defaults.map};
        }
        if (view.empty()) {
            result.view = defaults.view;
        }
        if (repeat.empty()) {
            result.repeat = 1;
        }
        if (result.maps.size() != 1) {
            throw bad_input("--preset wants one size of the map");
        }
    }
    if (!repeat.empty()) {
        result.repeat = positive(repeat, "--repeat");
    }
    if (!frames.empty()) {
        result.frames = positive(frames, "--frames");
        if (result.path.empty()) {
            throw bad_input("--frames is for a camera that moves: give a --path too");
        }
        if (result.frames < 2) {
            throw bad_input("--frames wants 2 or more: one frame is no motion");
        }
    }
    if (!seed.empty()) {
        const std::optional<unsigned> value = number<unsigned>(seed);
        if (!value) {
            throw bad_input("--seed wants a whole number from 0 on, not '" + seed + "'");
        }
        result.seed = *value;
    }
    if (!result.sweep.empty()) {
        result.pictured = pictured_size(result);
        settle_sweep(result);
    }
    if (result.out.empty()) {
        throw bad_input("--out wants a folder");
    }
    return result;
}

} // namespace lab
