#include "lab/report.hpp"

#include "lab/accuracy_report.hpp"
#include "lab/plot.hpp"
#include "lab/report_parts.hpp"
#include "lab/report_paths.hpp"
#include "lab/report_style.hpp"
#include "lab/report_views.hpp"

#include <algorithm>
#include <optional>

namespace lab {
namespace {

bool any_bias(const results& all) {
    return std::any_of(all.runs.begin(), all.runs.end(),
                       [](const run_record& run) { return run.bias.has_value(); });
}

std::string bias_cells(const run_record& run) {
    return cell(run.bias.value_or("–"), false) + cell(percent_text(run.bias_effect.acne_ratio)) +
           cell(percent_text(run.bias_effect.leak_ratio)) +
           cell(texels_text(run.bias_effect.displacement_texels));
}

std::string table(const results& all) {
    std::string html =
        "<div class=\"scroll\"><table>\n<thead><tr><th>scene</th><th>camera</th><th>light</th>"
        "<th>method</th><th class=\"n\">map</th>" +
        std::string(any_bias(all) ? "<th>bias</th><th class=\"n\">acne&nbsp;%</th>"
                                    "<th class=\"n\">leak&nbsp;%</th>"
                                    "<th class=\"n\">displacement, texels</th>"
                                  : "") +
        "<th class=\"n\">wrong&nbsp;%</th><th class=\"n\">false shadow&nbsp;%</th><th "
        "class=\"n\">false light&nbsp;%</th>"
        "<th class=\"n\">grazing wrong&nbsp;%</th><th class=\"n\">MER</th>"
        "<th class=\"n\">frame ms</th><th class=\"n\">min–max</th><th class=\"n\">bytes</th><th "
        "class=\"n\">triangles</th>"
        "</tr></thead>\n<tbody>\n";
    for (const run_record& run : all.runs) {
        const comparison& c = run.against_truth;
        const method_result& r = run.result;
        std::optional<double> grazing;
        if (c.grazing_samples > 0) {
            grazing = static_cast<double>(c.grazing_wrong) / static_cast<double>(c.grazing_samples);
        }
        html += "<tr>" + cell(run.scene, false) + cell(run.camera, false) + cell(run.light, false) +
                "<td>" + dot_of(all, label_of(run)) + escaped(method_text(run)) + "</td>" +
                cell(run.map == 0 ? "–" : std::to_string(run.map)) +
                (any_bias(all) ? bias_cells(run) : "") +
                cell(percent_text(c.ratio(c.false_shadow + c.false_light))) +
                cell(percent_text(c.ratio(c.false_shadow))) +
                cell(percent_text(c.ratio(c.false_light))) + cell(percent_text(grazing)) +
                cell(finest_text(r)) + cell(ms_text(r.frame_ms_median)) +
                cell(ms_text(r.frame_ms_min) + "–" + ms_text(r.frame_ms_max)) +
                cell(bytes_text(r.bytes)) + cell(std::to_string(r.triangles)) + "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

} // namespace

std::string html_of(const results& all, const std::vector<view_pictures>& views,
                    const std::vector<path_pictures>& paths,
                    const std::vector<std::string>& figures) {
    std::string html =
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>warpshadow-lab report</title>\n<style>" +
        report_style() +
        "</style>\n</head>\n<body><main>\n"
        "<h1>Shadow maps against ray tracing</h1>\n<p>" +
        escaped(all.renderer) + ", OpenGL " + escaped(all.version) + "; " +
        std::to_string(all.view.x) + " × " + std::to_string(all.view.y) + " pixels; times by " +
        (all.timing == "glfinish" ? "the clock between two glFinish" : "timer queries") +
        ".</p>\n<p>A pixel is wrong when the method's shadow test differs from a ray towards the "
        "light. Counted are pixels that face the light (n·l &gt; 0.1); those at grazing light "
        "(0 &lt; n·l ≤ 0.1) have a column of their own. Wrong pixels are red in the "
        "pictures.</p>\n" +
        (all.runs.empty()   ? std::string()
         : all.matched == 0 ? table(all)
                            : accuracy_section(all) + "<details><summary>All runs</summary>\n" +
                                  table(all) + "</details>\n");
    if (!paths.empty()) {
        html +=
            "<p>A pixel flips when the maps of one frame and those of the next disagree about the "
            "shadow on the same place of a surface that both frames see, though nothing but the "
            "camera moved.</p>\n";
    }
    for (const std::string& line : left_out_lines(all)) {
        html += "<p>Not applicable: " + escaped(line) + ".</p>\n";
    }
    for (const view_pictures& view : views) {
        html += view_section(all, view);
    }
    for (const path_pictures& path : paths) {
        html += path_section(all, path);
    }
    for (const std::string& figure : figures) {
        html += figure;
    }
    return html + "</main>\n<script>" + std::string(report_script()) +
           "</script>\n</body>\n</html>\n";
}

} // namespace lab
