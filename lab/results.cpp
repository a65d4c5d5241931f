#include "lab/results.hpp"

#include "lab/accuracy_report.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace lab {
namespace {

using nlohmann::ordered_json;

ordered_json number_or_null(std::optional<double> value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json json_of(const warpshadow::metric_summary<double>& m) {
    ordered_json json;
    json["max"] = m.max;
    json["p99"] = m.p99;
    json["p50"] = m.p50;
    json["share_above_1"] = m.share_above_1;
    return json;
}

ordered_json json_of_run(const run_record& run, glm::ivec2 view) {
    const comparison& c = run.against_truth;
    const method_result& r = run.result;
    ordered_json json;
    json["scene"] = run.scene;
    json["camera"] = run.camera;
    json["light"] = run.light;
    json["light_kind"] = run.kind;
    json["method"] = run.method;
    json["map"] = run.map;
    json["view"] = {view.x, view.y};
    if (run.variant) {
        json["variant"] = *run.variant;
    }
    if (run.raster) {
        json["raster"] = *run.raster;
    }
    if (run.bias) {
        const bias_measures& effect = run.bias_effect;
        ordered_json bias;
        bias["kind"] = *run.bias;
        bias["value"] = effect.value;
        bias["acne_ratio"] = number_or_null(effect.acne_ratio);
        bias["leak_ratio"] = number_or_null(effect.leak_ratio);
        bias["displacement_texels"] = number_or_null(effect.displacement_texels);
        json["bias"] = bias;
    }
    if (run.tables) {
        json["tables_format"] = *run.tables;
    }
    if (run.set_up) {
        json["setup"] = *run.set_up;
    }
    if (run.filter != "none") {
        json["filter"] = run.filter;
    }
    json["samples"] = c.samples;
    json["wrong_pixel_ratio"] = number_or_null(c.ratio(c.false_shadow + c.false_light));
    json["false_shadow_ratio"] = number_or_null(c.ratio(c.false_shadow));
    json["false_light_ratio"] = number_or_null(c.ratio(c.false_light));
    if (run.filtered.mean_light) {
        json["filtered"] = {{"mean_light_error", *run.filtered.mean_light},
                            {"wrong_pixel_ratio", number_or_null(run.filtered.wrong)}};
    }
    ordered_json grazing;
    grazing["samples"] = c.grazing_samples;
    grazing["wrong_pixel_ratio"] = c.grazing_samples == 0
                                       ? ordered_json(nullptr)
                                       : ordered_json(static_cast<double>(c.grazing_wrong) /
                                                      static_cast<double>(c.grazing_samples));
    json["grazing"] = grazing;
    if (r.texels) {
        json["m"] = json_of(r.texels->on_receivers);
        json["m_facing"] = json_of(r.texels->facing);
        json["mer"] = {r.texels->finest.x, r.texels->finest.y};
        json["storage_factor"] = r.texels->on_receivers.storage_factor;
    }
    ordered_json frame;
    frame["median"] = r.frame_ms_median;
    frame["min"] = r.frame_ms_min;
    frame["max"] = r.frame_ms_max;
    frame["n"] = r.frame_ms.size();
    json["frame_ms"] = frame;
    json["pass_ms"] = ordered_json::object();
    for (const pass_time& pass : r.passes) {
        json["pass_ms"][pass.pass] = pass.ms;
    }
    json["cpu_setup_us"] = ordered_json::object();
    for (const auto& [name, us] : r.cpu_setup_us) {
        json["cpu_setup_us"][name] = us;
    }
    json["bytes"] = r.bytes;
    json["triangles"] = r.triangles;
    json["maps"] = r.maps;
    json["angle_degrees"] = glm::degrees(r.angle);
    if (r.weakened) {
        json["weakened"] = *r.weakened;
        json["predicted_texel_side"] = number_or_null(r.mean_side);
    }
    json["status"] = r.status;
    return json;
}

ordered_json json_of_path(const path_record& path, glm::ivec2 view) {
    const path_means means = means_of(path);
    ordered_json json;
    json["scene"] = path.scene;
    json["camera"] = path.camera;
    json["light"] = path.light;
    json["path"] = path.path;
    json["method"] = path.method;
    json["map"] = path.map;
    json["view"] = {view.x, view.y};
    ordered_json mean;
    mean["wrong_pixel_ratio"] = number_or_null(means.wrong_ratio);
    mean["flip_ratio"] = number_or_null(means.flip_ratio);
    mean["largest_turn_degrees"] = glm::degrees(means.largest_turn);
    mean["frame_ms"] = means.frame_ms;
    mean["shadow_map_ms"] = means.shadow_map_ms;
    mean["maps"] = means.maps;
    json["mean"] = mean;
    json["frames"] = ordered_json::array();
    for (const path_frame& frame : path.frames) {
        ordered_json entry;
        entry["wrong_pixel_ratio"] = number_or_null(frame.wrong_ratio);
        entry["flip_ratio"] = number_or_null(frame.flip_ratio);
        entry["angle_degrees"] = glm::degrees(frame.angle);
        entry["frame_ms"] = frame.frame_ms;
        entry["shadow_map_ms"] = frame.shadow_map_ms;
        entry["maps"] = frame.maps;
        json["frames"].push_back(entry);
    }
    return json;
}

ordered_json json_of_figure(const figure_record& figure) {
    ordered_json json;
    json["figure"] = figure.name;
    json["scene"] = figure.scene;
    json["camera"] = figure.camera;
    json["light"] = figure.light;
    json["cells"] = ordered_json::array();
    for (const figure_record::cell& cell : figure.cells) {
        ordered_json entry;
        entry["row"] = cell.row;
        entry["column"] = cell.column;
        entry["run"] = cell.run;
        if (cell.mean_light_error) {
            entry["filtered_acne_ratio"] = number_or_null(cell.filtered_acne);
            entry["mean_light_error"] = number_or_null(cell.mean_light_error);
        }
        if (cell.wrong_texels) {
            entry["wrong_texel_ratio"] = *cell.wrong_texels;
        }
        json["cells"].push_back(entry);
    }
    return json;
}

ordered_json json_of_vpl(const vpl_record& vpl) {
    ordered_json json;
    json["scene"] = vpl.scene;
    json["points"] = vpl.points;
    json["groups"] = vpl.groups;
    json["map"] = vpl.map;
    json["ways"] = ordered_json::array();
    for (const vpl_record::way_record& way : vpl.ways) {
        json["ways"].push_back({{"way", way.way}, {"ms", way.ms}, {"maps", way.maps}});
    }
    return json;
}

bool any_bias(const results& all) {
    return std::any_of(all.runs.begin(), all.runs.end(),
                       [](const run_record& run) { return run.bias.has_value(); });
}

std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t texts) {
    std::string text;
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const std::vector<std::string>& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths[i] = std::max(widths[i], row[i].size());
        }
    }
    for (const std::vector<std::string>& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string space(widths[i] - row[i].size(), ' ');
            text += i < texts ? row[i] + space : space + row[i];
            text += i + 1 < row.size() ? "  " : "";
        }
        text += '\n';
    }
    return text;
}

} // namespace

std::string json_of(const results& all) {
    ordered_json json;
    json["schema"] = 1;
    json["command"] = all.command;
    json["device"]["renderer"] = all.renderer;
    json["device"]["version"] = all.version;
    json["timing"] = all.timing;
    json["runs"] = ordered_json::array();
    for (const run_record& run : all.runs) {
        json["runs"].push_back(json_of_run(run, all.view));
    }
    json["paths"] = ordered_json::array();
    for (const path_record& path : all.paths) {
        json["paths"].push_back(json_of_path(path, all.view));
    }
    if (!all.figures.empty()) {
        json["figures"] = ordered_json::array();
        for (const figure_record& figure : all.figures) {
            json["figures"].push_back(json_of_figure(figure));
        }
    }
    for (const vpl_record& vpl : all.vpls) {
        json["vpl"].push_back(json_of_vpl(vpl));
    }
    if (all.matched != 0) {
        json["accuracy"] = accuracy_json(all);
    }
    json["not_applicable"] = ordered_json::array();
    for (const not_applicable& each : all.left_out) {
        ordered_json entry;
        entry["scene"] = each.scene;
        entry["light"] = each.light;
        entry["method"] = each.method;
        entry["reason"] = each.reason;
        json["not_applicable"].push_back(entry);
    }
    // names may hold bytes of any file system: what is not UTF-8 is replaced
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::vector<std::string> left_out_lines(const results& all) {
    struct group {
        std::string rest; // what follows the methods
        std::vector<std::string> methods;
    };
    std::vector<group> groups;
    for (const not_applicable& each : all.left_out) {
        const std::string rest = " on " + each.scene + ", light " + each.light + ": " + each.reason;
        auto same = std::find_if(groups.begin(), groups.end(),
                                 [&](const group& one) { return one.rest == rest; });
        if (same == groups.end()) {
            same = groups.insert(groups.end(), {rest, {}});
        }
        if (std::find(same->methods.begin(), same->methods.end(), each.method) ==
            same->methods.end()) {
            same->methods.push_back(each.method);
        }
    }
    std::vector<std::string> lines;
    for (const group& one : groups) {
        std::string names;
        for (const std::string& method : one.methods) {
            names += (names.empty() ? "" : ", ") + method;
        }
        lines.push_back(names + one.rest);
    }
    return lines;
}

std::string method_text(const run_record& run) {
    if (run.variant) {
        return run.method + " " + *run.variant; // a way to rasterise is part of its name
    }
    return run.raster ? run.method + " " + *run.raster : run.method;
}

std::string percent_text(std::optional<double> ratio) {
    if (!ratio) {
        return "-";
    }
    char buffer[32];
    const double percent = 100.0 * *ratio;
    std::snprintf(buffer, sizeof buffer, percent >= 10.0 ? "%.1f" : "%.2f", percent);
    return buffer;
}

std::string texels_text(std::optional<double> texels) {
    if (!texels) {
        return "-";
    }
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.*f", *texels >= 10.0 ? 1 : 3, *texels);
    return buffer;
}

std::string finest_text(const method_result& result) {
    if (!result.texels) {
        return "-";
    }
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.0fx%.0f", result.texels->finest.x,
                  result.texels->finest.y);
    return buffer;
}

std::string ms_text(double ms) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, ms >= 100.0 ? "%.0f" : ms >= 10.0 ? "%.1f" : "%.2f", ms);
    return buffer;
}

std::string bytes_text(std::size_t bytes) {
    const char* const units[] = {"B", "KiB", "MiB", "GiB"};
    auto value = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (value >= 1024.0 && unit < 3) {
        value /= 1024.0;
        ++unit;
    }
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, unit == 0 || value >= 100.0 ? "%.0f %s" : "%.1f %s", value,
                  units[unit]);
    return buffer;
}

std::string table_of(const results& all) {
    std::vector<std::vector<std::string>> rows{{"scene", "camera", "light", "method", "map",
                                                "wrong %", "false shadow %", "false light %", "MER",
                                                "frame ms", "bytes"}};
    for (const run_record& run : all.runs) {
        const comparison& c = run.against_truth;
        rows.push_back({run.scene, run.camera, run.light, method_text(run),
                        run.map == 0 ? "-" : std::to_string(run.map),
                        percent_text(c.ratio(c.false_shadow + c.false_light)),
                        percent_text(c.ratio(c.false_shadow)), percent_text(c.ratio(c.false_light)),
                        finest_text(run.result), ms_text(run.result.frame_ms_median),
                        bytes_text(run.result.bytes)});
    }
    if (any_bias(all)) {
        const auto insert = [](std::vector<std::string>& row, std::vector<std::string> cells) {
            row.insert(row.begin() + 4, cells.begin(), cells.end());
        };
        insert(rows.front(), {"bias", "acne %", "leak %", "texels"});
        for (std::size_t i = 0; i < all.runs.size(); ++i) {
            const bias_measures& effect = all.runs[i].bias_effect;
            insert(rows[i + 1],
                   {all.runs[i].bias.value_or("-"), percent_text(effect.acne_ratio),
                    percent_text(effect.leak_ratio), texels_text(effect.displacement_texels)});
        }
    }
    std::string text = all.runs.empty() ? std::string() : aligned(rows, any_bias(all) ? 5 : 4);
    if (!all.paths.empty()) {
        rows = {{"scene", "camera", "light", "path", "method", "map", "wrong %", "flips %",
                 "largest turn", "frame ms", "shadow map ms", "maps"}};
        for (const path_record& path : all.paths) {
            const path_means means = means_of(path);
            const auto number = [](double value, const char* how) {
                char buffer[32];
                std::snprintf(buffer, sizeof buffer, how, value);
                return std::string(buffer);
            };
            rows.push_back(
                {path.scene, path.camera, path.light, path.path, path.method,
                 path.map == 0 ? "-" : std::to_string(path.map), percent_text(means.wrong_ratio),
                 means.flip_ratio ? number(100.0 * *means.flip_ratio, "%.3f") : "-",
                 number(glm::degrees(means.largest_turn), "%.2f"), ms_text(means.frame_ms),
                 ms_text(means.shadow_map_ms), number(means.maps, "%.1f")});
        }
        text += aligned(rows, 5);
    }
    if (!all.vpls.empty()) {
        rows = {{"scene", "method", "points", "map", "lights", "maps a light", "ms"}};
        for (const vpl_record& vpl : all.vpls) {
            for (const vpl_record::way_record& way : vpl.ways) {
                const double lights = static_cast<double>(way.ms.size());
                char maps[32];
                std::snprintf(maps, sizeof maps, "%.1f",
                              std::accumulate(way.maps.begin(), way.maps.end(), 0.0) / lights);
                rows.push_back({vpl.scene, way.way, std::to_string(vpl.points),
                                std::to_string(vpl.map), std::to_string(way.ms.size()), maps,
                                ms_text(std::accumulate(way.ms.begin(), way.ms.end(), 0.0))});
            }
        }
        text += aligned(rows, 2);
    }
    for (const std::string& line : left_out_lines(all)) {
        text += "not applicable: " + line + "\n";
    }
    return text;
}

} // namespace lab
