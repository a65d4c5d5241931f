#include "lab/report.hpp"

#include "lab/accuracy_report.hpp"
#include "lab/plot.hpp"
#include "lab/report_parts.hpp"
#include "lab/report_paths.hpp"
#include "lab/report_style.hpp"
#include "lab/report_views.hpp"

#include <algorithm>
#include <cstddef>
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

std::string view_text(const std::string& scene, const std::string& camera,
                      const std::string& light) {
    return escaped(scene + ", camera " + camera + ", light " + light);
}

/// A row per run, those of a view under its name.
std::string table(const results& all) {
    const std::string columns = any_bias(all) ? "15" : "11";
    std::string html =
        "<div class=\"scroll\"><table class=\"runs\">\n<thead><tr><th>method</th>"
        "<th class=\"n\">map</th>" +
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
    std::string shown;
    for (const run_record& run : all.runs) {
        const std::string view = view_text(run.scene, run.camera, run.light);
        if (view != shown) {
            html += "<tr><th class=\"view\" colspan=\"" + columns + "\">" + view + "</th></tr>\n";
            shown = view;
        }
        const comparison& c = run.against_truth;
        const method_result& r = run.result;
        std::optional<double> grazing;
        if (c.grazing_samples > 0) {
            grazing = static_cast<double>(c.grazing_wrong) / static_cast<double>(c.grazing_samples);
        }
        html += "<tr><td>" + dot_of(all, label_of(run)) + escaped(method_text(run)) + "</td>" +
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

/// What links call a section.
std::string anchor(std::size_t section) {
    return "s" + std::to_string(section);
}

/// Links to the sections, where there are several.
std::string contents(const std::vector<std::string>& titles) {
    if (titles.size() < 2) {
        return {};
    }
    std::string html = "<nav>\n<h2>Plots and pictures</h2>\n<ul class=\"contents\">\n";
    for (std::size_t i = 0; i < titles.size(); ++i) {
        html += "<li><a href=\"#" + anchor(i) + "\">" + titles[i] + "</a></li>\n";
    }
    return html + "</ul>\n</nav>\n";
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
        ".</p>\n<p><code class=\"command\">" + escaped(all.command) +
        "</code></p>\n<p>A pixel is wrong when the method's shadow test differs from a ray towards "
        "the "
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
    std::vector<std::string> titles;
    for (const view_pictures& view : views) {
        titles.push_back(view_text(view.scene, view.camera, view.light));
    }
    for (const path_pictures& path : paths) {
        const path_record& record = all.paths[path.first];
        titles.push_back(view_text(record.scene, record.camera, record.light) + ", " +
                         escaped(record.path));
    }
    html += contents(titles);
    for (std::size_t i = 0; i < titles.size(); ++i) {
        const std::string heading = "<h2 id=\"" + anchor(i) + "\">" + titles[i] + "</h2>";
        html += i < views.size() ? view_section(all, views[i], heading)
                                 : path_section(all, paths[i - views.size()], heading);
    }
    for (const std::string& figure : figures) {
        html += figure;
    }
    return html + "</main>\n<script>" + std::string(report_script()) +
           "</script>\n</body>\n</html>\n";
}

} // namespace lab
