#include "lab/sweep.hpp"

#include "lab/method_table.hpp"
#include "lab/path_runner.hpp"
#include "lab/view_archive.hpp"
#include "lab/view_arguments.hpp"
#include "lab/view_runner.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lab {
namespace {

/// What is varied one by one, with everything else as it is by default.
std::vector<run_variant> variants_at(int map) {
    std::vector<run_variant> result;
    const auto tables = [&](const char* name, auto set) {
        run_variant variant{"notw", name, map};
        set(variant.tables);
        result.push_back(variant);
    };
    const auto raster = [&](const char* text) {
        result.push_back({"notw", std::string("raster ") + text, map, {}, parse_raster(text)});
    };
    raster("none");
    raster("fragment");
    raster("rule:2.5");
    raster("bound:1");
    raster("bound:0.25");
    tables("tables 32", [](warp_wishes& wish) { wish.tables = 32; });
    tables("tables 512", [](warp_wishes& wish) { wish.tables = 512; });
    tables("window 0.25", [](warp_wishes& wish) { wish.window = 0.25f; }); // the default: the noise
    tables("window 0.7", [](warp_wishes& wish) { wish.window = 0.7f; });
    tables("window 2", [](warp_wishes& wish) { wish.window = 2.0f; });
    tables("floor 0.05", [](warp_wishes& wish) { wish.floor = 0.05f; });
    tables("every 16th sample", [](warp_wishes& wish) { wish.every = 4; });
    tables("unorm16", [](warp_wishes& wish) { wish.format = table_format::unorm16; });
    // lengths in scene units: about the side of a texel outdoors, and of several indoors
    for (const char* const text :
         {"pcf", "blur", "pcf-texels:2", "pcf-light:0.05", "pcf-footprint:0.05"}) {
        result.push_back({"notw", std::string("filter ") + text, map, {}, {}, parse_filter(text)});
    }
    for (const char* const method : {"sm", "stable", "min-sm", "dv", "lispsm", "fitted", "notw"}) {
        result.push_back({method, "float", map, {}, {}, {}, precision::in_float});
    }
    return result;
}

/// What decides the records of a view; times aside, equal texts mean equal records.
std::string settings_of(const options& wanted, const camera_view& camera, const light_view& light,
                        const results& all) {
    std::string text = wanted.command + "|" + all.renderer + "|" + all.version + "|" +
                       wanted.sweep + "|" + std::to_string(wanted.view.x) + "x" +
                       std::to_string(wanted.view.y) + "|" + std::to_string(wanted.repeat) + "|" +
                       std::to_string(wanted.rounds) + "|" + std::to_string(wanted.seed) + "|" +
                       camera_text(camera) + "|" + light_text(light);
    text += "|" + wanted.path + "|" + std::to_string(wanted.frames);
    for (const std::string& method : wanted.methods) {
        text += "|" + method;
    }
    for (const int map : wanted.maps) {
        text += "|" + std::to_string(map);
    }
    for (const run_variant& variant : wanted.variants) {
        text += "|" + variant.method + " " + variant.name;
    }
    return text;
}

} // namespace

options options_of_sweep(const std::string& name) {
    if (name != "short" && name != "full") {
        throw bad_input("--sweep wants short or full, not '" + name + "'");
    }
    const bool full = name == "full";
    options result;
    result.sweep = name;
    result.scenes = {"outdoor", "colonnade", "interior", "leaves"};
    result.methods = {"sm",        "stable",     "pssm",        "sdsm",        "min-sm",
                      "dv",        "lispsm",     "fitted",      "fitted-2",    "rtw-backward",
                      "notw",      "notw-edges", "notw-hybrid", "fitted-notw", "cube6",
                      "cube6-efc", "cube-notw",  "dpsm",        "dpsm-pc",     "dpsm-notw",
                      "sv",        "raytraced"};
    result.point_lights = {{"interior", "point:0.2,1.97,-0.1"}};
    result.view = {512, 384};
    result.repeat = 1;
    result.rounds = 3;
    result.maps = {256, 512, 1024};
    if (full) {
        result.point_lights.push_back({"outdoor", "point:0,8,-8"});
        result.cameras = {"0", "1", "2"};
        result.lights = {"0", "1", "2"};
        result.maps = {256, 512, 1024, 2048, 4096};
        result.methods.insert(result.methods.end() - 2, {"min-sm-notw", "lispsm-notw", "notw-nodv",
                                                         "notw-fine", "notw-oracle", "rtw-forward",
                                                         "rtw-hybrid", "cube6-cull", "dpsm-cull"});
        result.view = {1024, 768};
        result.rounds = 5;
    }
    result.variants = variants_at(512);
    result.moves = {"yaw",
                    {"sm", "stable", "min-sm", "dv", "fitted", "notw", "notw-hybrid"},
                    512,
                    full ? 60 : 12};
    return result;
}

int pictured_size(const options& wanted) {
    const bool usual = std::find(wanted.maps.begin(), wanted.maps.end(), 512) != wanted.maps.end();
    return usual ? 512 : *std::min_element(wanted.maps.begin(), wanted.maps.end());
}

void settle_sweep(options& wanted) {
    const auto is_left_out = [&](const std::string& method) {
        return std::find(wanted.methods.begin(), wanted.methods.end(), method) ==
               wanted.methods.end();
    };
    std::erase_if(wanted.variants,
                  [&](const run_variant& variant) { return is_left_out(variant.method); });
    for (run_variant& variant : wanted.variants) {
        variant.map = pictured_size(wanted);
    }
    if (wanted.moves) {
        std::erase_if(wanted.moves->methods, is_left_out);
        wanted.moves->map = pictured_size(wanted);
    }
}

std::optional<options> options_of_motion(const options& wanted, const light_view& light) {
    if (!wanted.moves) {
        return std::nullopt;
    }
    options result = wanted;
    result.moves.reset();
    result.variants.clear();
    result.path = wanted.moves->path;
    result.frames = wanted.moves->frames;
    result.maps = {wanted.moves->map};
    result.methods = wanted.moves->methods;
    std::erase_if(result.methods, [&](const std::string& method) {
        return why_not(method, light) || why_not(method, wanted.set_up);
    });
    return result.methods.empty() ? std::nullopt : std::optional(result);
}

view_pictures resume_view(const options& wanted, const scene& world, renderer& gpu,
                          const ray_tracer& rays, const camera_view& camera,
                          const light_view& light, results& all, report_folder& folder,
                          progress_bar& progress) {
    const std::string settings = settings_of(wanted, camera, light, all);
    const std::string name = archive_name({world.name, camera.label, light.label});
    if (std::optional<archived_view> kept = read_archive(folder.read(name), settings)) {
        folder.keep();
        const std::size_t first = all.runs.size();
        for (run_record& run : kept->runs) {
            all.runs.push_back(std::move(run));
            progress.advance();
        }
        for (run_pictures& each : kept->pictures.runs) {
            each.run += first;
        }
        return std::move(kept->pictures);
    }
    const std::size_t first = all.runs.size();
    view_pictures seen = run_view(wanted, world, gpu, rays, camera, light, all, folder, progress);
    archived_view archived{{all.runs.begin() + static_cast<std::ptrdiff_t>(first), all.runs.end()},
                           seen};
    for (run_pictures& each : archived.pictures.runs) {
        each.run -= first;
    }
    folder.write(name, archive_of(archived, settings));
    folder.keep();
    return seen;
}

path_pictures resume_path(const options& wanted, const scene& world, renderer& gpu,
                          const ray_tracer& rays, const camera_view& camera,
                          const light_view& light, results& all, report_folder& folder,
                          progress_bar& progress) {
    const std::string settings = settings_of(wanted, camera, light, all);
    const std::string name =
        archive_name({world.name, camera.label, light.label, "path", wanted.path});
    const std::size_t first = all.paths.size();
    if (std::optional<std::vector<path_record>> kept =
            read_path_archive(folder.read(name), settings)) {
        folder.keep();
        for (path_record& path : *kept) {
            for (std::size_t i = 0; i < path.frames.size(); ++i) {
                progress.advance();
            }
            all.paths.push_back(std::move(path));
        }
        return {first, all.paths.size() - first, true, camera_text(camera), light_text(light), {}};
    }
    path_pictures seen = run_path(wanted, world, gpu, rays, camera, light, all, folder, progress);
    folder.write(name, archive_of(std::span(all.paths).subspan(first), settings));
    folder.keep();
    return seen;
}

} // namespace lab
