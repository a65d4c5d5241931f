#include "lab/figures.hpp"

#include "lab/bias_run.hpp"
#include "lab/method_table.hpp"
#include "lab/raster_figure.hpp"
#include "lab/view_arguments.hpp"
#include "lab/vpl.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace lab {
namespace {

/// One cell of a figure that is to be run.
struct cell_plan {
    std::string row;
    std::string column;
    std::string method;
    std::string bias;
    filter_choice filter;
};

std::vector<cell_plan> plan_biases() {
    struct row {
        const char* name;
        const char* method;
        const char* suffix;
    };
    constexpr std::array rows{row{"lispsm, hyperbolic depth", "lispsm", ""},
                              row{"lispsm, linear depth", "lispsm", "+linear"},
                              row{"lispsm, back faces", "lispsm", "+back-face"},
                              row{"fitted, hyperbolic depth", "fitted", ""},
                              row{"fitted, linear depth", "fitted", "+linear"},
                              row{"fitted, back faces", "fitted", "+back-face"},
                              row{"sm", "sm", ""},
                              row{"sm, back faces", "sm", "+back-face"}};
    constexpr std::array<const char*, 4> columns{"none", "constant", "slope", "footprint"};
    std::vector<cell_plan> cells;
    for (const row& each : rows) {
        for (const char* const column : columns) {
            cells.push_back(
                {each.name, column, each.method, std::string(column) + each.suffix, {}});
        }
    }
    return cells;
}

std::vector<cell_plan> plan_blurs() {
    struct row {
        const char* name;
        const char* method;
        const char* bias;
        bool less_with_depth;
    };
    constexpr std::array rows{row{"sm, blur everywhere", "sm", "slope:0.5", false},
                              row{"sm, blur less with depth", "sm", "slope:0.5", true},
                              row{"lispsm, blur everywhere", "lispsm", "slope:0.5", false},
                              row{"lispsm, blur less with depth", "lispsm", "slope:0.5", true}};
    std::vector<cell_plan> cells;
    for (const row& each : rows) {
        for (const int blurs : {0, 1, 2, 4, 8, 16}) {
            cells.push_back({each.name,
                             std::to_string(blurs) + "×",
                             each.method,
                             each.bias,
                             {shadow_filter::blur, blurs, each.less_with_depth}});
        }
    }
    return cells;
}

std::vector<cell_plan> plan_of(const std::string& name) {
    return name == "figure6" ? plan_biases() : plan_blurs();
}

} // namespace

figure_defaults defaults_of_figure(const std::string& name) {
    if (is_vpl(name)) {
        points_of_vpl(name);
        return defaults_of_vpl();
    }
    if (is_raster_figure(name)) {
        return defaults_of_raster_figure();
    }
    if (name != "figure6" && name != "figure8") {
        throw bad_input("--preset wants figure6, figure7, figure8 or vpl, not '" + name + "'");
    }
    return {"outdoor", "0", "0", name == "figure6" ? 2048 : 1024, {512, 512}};
}

std::size_t runs_of_figure(const std::string& name) {
    if (is_vpl(name)) {
        return runs_of_vpl();
    }
    if (is_raster_figure(name)) {
        return runs_of_raster_figure();
    }
    return plan_of(name).size();
}

figure_pictures run_figure(const options& wanted, const scene& world, renderer& gpu,
                           const ray_tracer& rays, const camera_view& camera,
                           const light_view& light, results& all, report_folder& folder,
                           progress_bar& progress) {
    if (is_raster_figure(wanted.preset)) {
        return run_raster_figure(wanted, world, gpu, rays, camera, light, all, folder, progress);
    }
    const g_buffer_samples samples = gpu.samples(camera, light);
    const std::vector<std::uint8_t> truth = rays.shadows(samples, light).shadowed;
    const shader shades(world, rays, samples, camera, light);
    const int map = wanted.maps.front();
    const auto write = [&](const std::string& kind, const picture& source) {
        return write_figure_picture(wanted, world, camera, light, folder, kind, source);
    };
    figure_record record{wanted.preset, world.name, camera.label, light.label, {}};
    figure_pictures seen{all.figures.size(),
                         camera_text(camera),
                         light_text(light),
                         write("raytraced", shades.shade(truth)),
                         {},
                         {}};
    for (const cell_plan& plan : plan_of(wanted.preset)) {
        stop_if_asked();
        progress.show(world.name + " " + plan.method + " " + plan.bias);
        const bias_choice bias = parse_bias(plan.bias);
        std::optional<std::string> reason = why_not(plan.method, light);
        if (!reason) {
            reason = why_not(plan.method, light, bias);
        }
        progress.advance();
        if (reason) {
            all.left_out.push_back({world.name, light.label, plan.method, *reason});
            continue;
        }
        run_record run{world.name, camera.label, light.label, plan.method, map, {}, {}};
        run_method(run, gpu,
                   {camera, light, map, wanted.seed, wanted.repeat, bias, plan.filter,
                    raster_of(wanted), &rays},
                   samples, truth);
        figure_record::cell cell{plan.row, plan.column, all.runs.size(), {}, {}};
        picture shown;
        std::string filter_name;
        if (plan.filter.kind == shadow_filter::none) {
            shown = shades.shade(run.result.shadowed);
        } else {
            run.filter = "blur";
            filter_name = (plan.filter.less_with_depth ? "-depth-" : "-all-") +
                          std::to_string(plan.filter.blurs);
            const std::vector<float>& share = run.result.light;
            // what is dark without the filter, and dark with it
            std::vector<std::uint8_t> dark = run.result.shadowed;
            for (std::size_t i = 0; i < share.size(); ++i) {
                dark[i] = share[i] < 0.5f ? dark[i] : 0;
            }
            cell.filtered_acne = measure_bias(samples, truth, dark, run.result.biases).acne_ratio;
            cell.mean_light_error = measure_filter(samples, truth, share).mean_light;
            shown = shades.shade(share);
        }
        seen.cells.push_back(write(plan.method + "-" + plan.bias + filter_name, shown));
        // one value per pixel, which nothing needs any more
        run.result.pictures.clear();
        run.result.shadowed = {};
        run.result.biases = {};
        run.result.light = {};
        run.against_truth.wrong = {};
        all.runs.push_back(std::move(run));
        record.cells.push_back(std::move(cell));
    }
    all.figures.push_back(std::move(record));
    return seen;
}

std::string figure_section(const results& all, const figure_pictures& seen) {
    const std::string& name = all.figures[seen.figure].name;
    if (is_raster_figure(name)) {
        return raster_figure_section(all, seen);
    }
    const bool blurs = name == "figure8";
    return matrix_section(
        all, seen,
        {std::string("figure ") + (blurs ? "8" : "6") + " of Scherzer 2005",
         std::string("Acne: lit pixels that are dark although their texel holds nothing before the "
                     "plane of their own face. Displacement: the bias along the light ray over the "
                     "side of the texel, a mean; so far a shadow recedes from a caster that it "
                     "touches") +
             (blurs ? ". Light error: mean difference of the blurred light and that of the ray "
                      "tracer. Acne counts what the blur leaves with less than half of the light."
                    : "."),
         blurs ? 180 : 270, [blurs](const figure_record::cell& cell, const run_record& run) {
             const comparison& c = run.against_truth;
             return "acne&nbsp;" +
                    percent_text(blurs ? cell.filtered_acne : run.bias_effect.acne_ratio) +
                    "&nbsp;%, displacement&nbsp;" +
                    texels_text(run.bias_effect.displacement_texels) + "&nbsp;texels, " +
                    (blurs
                         ? "light error&nbsp;" + percent_text(cell.mean_light_error)
                         : "wrong&nbsp;" + percent_text(c.ratio(c.false_shadow + c.false_light))) +
                    "&nbsp;%";
         }});
}

} // namespace lab
