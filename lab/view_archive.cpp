#include "lab/view_archive.hpp"

#include "lab/report_folder.hpp"

#include <nlohmann/json.hpp>

namespace lab {
namespace {

using nlohmann::json;

template <typename T> json json_or_null(const std::optional<T>& value) {
    return value ? json(*value) : json(nullptr);
}

template <typename T> std::optional<T> read_or_nothing(const json& value) {
    return value.is_null() ? std::nullopt : std::optional(value.get<T>());
}

json pack(const png_file& file) {
    return {{"width", file.width}, {"height", file.height}, {"bytes", json::binary(file.bytes)}};
}

png_file unpack_png(const json& packed) {
    return {packed.at("width"), packed.at("height"), packed.at("bytes").get_binary()};
}

json pack(const warpshadow::metric_summary<double>& m) {
    return {m.counted, m.max, m.p99, m.p50, m.share_above_1, m.storage_factor};
}

warpshadow::metric_summary<double> unpack_metric(const json& packed) {
    warpshadow::metric_summary<double> m;
    m.counted = packed.at(0);
    m.max = packed.at(1);
    m.p99 = packed.at(2);
    m.p50 = packed.at(3);
    m.share_above_1 = packed.at(4);
    m.storage_factor = packed.at(5);
    return m;
}

json pack(const run_record& run) {
    const comparison& c = run.against_truth;
    const method_result& r = run.result;
    json packed = {
        {"scene", run.scene},
        {"camera", run.camera},
        {"light", run.light},
        {"kind", run.kind},
        {"method", run.method},
        {"map", run.map},
        {"raster", json_or_null(run.raster)},
        {"variant", json_or_null(run.variant)},
        {"filter", run.filter},
        {"filtered", {json_or_null(run.filtered.mean_light), json_or_null(run.filtered.wrong)}},
        {"tables", json_or_null(run.tables)},
        {"set_up", json_or_null(run.set_up)},
        {"counts", {c.samples, c.false_shadow, c.false_light, c.grazing_samples, c.grazing_wrong}},
        {"frame_ms", r.frame_ms},
        {"cpu_setup_us", r.cpu_setup_us},
        {"bytes", r.bytes},
        {"triangles", r.triangles},
        {"maps", r.maps},
        {"angle", r.angle},
        {"weakened", json_or_null(r.weakened)},
        {"mean_side", json_or_null(r.mean_side)},
        {"status", r.status},
        {"passes", json::array()}};
    for (const pass_time& pass : r.passes) {
        packed["passes"].push_back({pass.pass, pass.ms});
    }
    if (r.texels) {
        packed["texels"] = {pack(r.texels->on_receivers), pack(r.texels->facing),
                            r.texels->finest.x, r.texels->finest.y};
    }
    return packed;
}

run_record unpack_run(const json& packed) {
    run_record run{};
    run.scene = packed.at("scene");
    run.camera = packed.at("camera");
    run.light = packed.at("light");
    run.kind = packed.at("kind");
    run.method = packed.at("method");
    run.map = packed.at("map");
    run.raster = read_or_nothing<std::string>(packed.at("raster"));
    run.variant = read_or_nothing<std::string>(packed.at("variant"));
    run.filter = packed.at("filter");
    const json& filtered = packed.at("filtered");
    run.filtered = {read_or_nothing<double>(filtered.at(0)),
                    read_or_nothing<double>(filtered.at(1))};
    run.tables = read_or_nothing<std::string>(packed.at("tables"));
    run.set_up = read_or_nothing<std::string>(packed.at("set_up"));
    comparison& c = run.against_truth;
    const json& counts = packed.at("counts");
    c.samples = counts.at(0);
    c.false_shadow = counts.at(1);
    c.false_light = counts.at(2);
    c.grazing_samples = counts.at(3);
    c.grazing_wrong = counts.at(4);
    method_result& r = run.result;
    add_times(r, packed.at("frame_ms").get<std::vector<double>>());
    r.cpu_setup_us = packed.at("cpu_setup_us").get<std::vector<std::pair<std::string, double>>>();
    r.bytes = packed.at("bytes");
    r.triangles = packed.at("triangles");
    r.maps = packed.at("maps");
    r.angle = packed.at("angle");
    r.weakened = read_or_nothing<double>(packed.at("weakened"));
    r.mean_side = read_or_nothing<double>(packed.at("mean_side"));
    r.status = packed.at("status").get<std::vector<std::string>>();
    for (const json& pass : packed.at("passes")) {
        r.passes.push_back({pass.at(0), pass.at(1)});
    }
    if (packed.contains("texels")) {
        const json& texels = packed["texels"];
        r.texels = {unpack_metric(texels.at(0)),
                    unpack_metric(texels.at(1)),
                    {texels.at(2).get<double>(), texels.at(3).get<double>()}};
    }
    return run;
}

json pack(const run_pictures& seen) {
    json packed = {{"run", seen.run},
                   {"marked", pack(seen.marked)},
                   {"detail", pack(seen.detail)},
                   {"detail_marked", pack(seen.detail_marked)},
                   {"explanations", json::array()}};
    for (const auto& [name, file] : seen.explanations) {
        packed["explanations"].push_back({name, pack(file)});
    }
    return packed;
}

run_pictures unpack_pictures(const json& packed) {
    run_pictures seen{packed.at("run"),
                      unpack_png(packed.at("marked")),
                      unpack_png(packed.at("detail")),
                      unpack_png(packed.at("detail_marked")),
                      {}};
    for (const json& each : packed.at("explanations")) {
        seen.explanations.emplace_back(each.at(0), unpack_png(each.at(1)));
    }
    return seen;
}

json pack(const path_record& path) {
    json packed = {{"scene", path.scene},    {"camera", path.camera}, {"light", path.light},
                   {"path", path.path},      {"method", path.method}, {"map", path.map},
                   {"frames", json::array()}};
    for (const path_frame& frame : path.frames) {
        packed["frames"].push_back({json_or_null(frame.wrong_ratio), json_or_null(frame.flip_ratio),
                                    frame.angle, frame.frame_ms, frame.shadow_map_ms, frame.maps});
    }
    return packed;
}

path_record unpack_path(const json& packed) {
    path_record path{packed.at("scene"),
                     packed.at("camera"),
                     packed.at("light"),
                     packed.at("path"),
                     packed.at("method"),
                     packed.at("map"),
                     {}};
    for (const json& frame : packed.at("frames")) {
        path.frames.push_back({read_or_nothing<double>(frame.at(0)),
                               read_or_nothing<double>(frame.at(1)), frame.at(2), frame.at(3),
                               frame.at(4), frame.at(5)});
    }
    return path;
}

} // namespace

std::string archive_name(std::initializer_list<std::string> parts) {
    std::string name = picture_name(parts);
    name.resize(name.size() - std::string_view(".png").size());
    return name.append(archive_suffix);
}

std::vector<std::uint8_t> archive_of(const archived_view& view, const std::string& settings) {
    const view_pictures& seen = view.pictures;
    json packed = {{"settings", settings},
                   {"runs", json::array()},
                   {"scene", seen.scene},
                   {"camera", seen.camera},
                   {"light", seen.light},
                   {"camera_text", seen.camera_text},
                   {"light_text", seen.light_text},
                   {"reference", pack(seen.reference)},
                   {"reference_detail", pack(seen.reference_detail)},
                   {"pictures", json::array()}};
    for (const run_record& run : view.runs) {
        packed["runs"].push_back(pack(run));
    }
    for (const run_pictures& each : seen.runs) {
        packed["pictures"].push_back(pack(each));
    }
    return json::to_cbor(packed);
}

std::optional<archived_view> read_archive(std::span<const std::uint8_t> bytes,
                                          const std::string& settings) {
    try {
        const json packed = json::from_cbor(bytes.begin(), bytes.end());
        if (packed.at("settings") != settings) {
            return std::nullopt;
        }
        archived_view view{{},
                           {packed.at("scene"),
                            packed.at("camera"),
                            packed.at("light"),
                            packed.at("camera_text"),
                            packed.at("light_text"),
                            unpack_png(packed.at("reference")),
                            unpack_png(packed.at("reference_detail")),
                            {}}};
        for (const json& run : packed.at("runs")) {
            view.runs.push_back(unpack_run(run));
        }
        for (const json& each : packed.at("pictures")) {
            view.pictures.runs.push_back(unpack_pictures(each));
        }
        return view;
    } catch (const json::exception&) {
        return std::nullopt; // cut off in the middle, or no archive at all
    }
}

std::vector<std::uint8_t> archive_of(std::span<const path_record> paths,
                                     const std::string& settings) {
    json packed = {{"settings", settings}, {"paths", json::array()}};
    for (const path_record& path : paths) {
        packed["paths"].push_back(pack(path));
    }
    return json::to_cbor(packed);
}

std::optional<std::vector<path_record>> read_path_archive(std::span<const std::uint8_t> bytes,
                                                          const std::string& settings) {
    try {
        const json packed = json::from_cbor(bytes.begin(), bytes.end());
        if (packed.at("settings") != settings) {
            return std::nullopt;
        }
        std::vector<path_record> paths;
        for (const json& path : packed.at("paths")) {
            paths.push_back(unpack_path(path));
        }
        return paths;
    } catch (const json::exception&) {
        return std::nullopt; // cut off in the middle, or no archive at all
    }
}

} // namespace lab
