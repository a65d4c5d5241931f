#include "lab/report_views.hpp"

#include "lab/accuracy.hpp"
#include "lab/plot.hpp"
#include "lab/report_parts.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace lab {
namespace {

/// Error against a cost; a line joins the map sizes of one method, another what nothing beats.
std::string plot_of(const results& all, const std::vector<std::size_t>& runs, cost of) {
    std::map<std::size_t, plot_series> series;
    std::vector<std::size_t> by_size = runs;
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) {
        return all.runs[a].map < all.runs[b].map;
    });
    constexpr double mebibyte = 1024.0 * 1024.0;
    const auto x_of = [&](double value) { return of == cost::time ? value : value / mebibyte; };
    for (const std::size_t index : by_size) {
        const run_record& run = all.runs[index];
        const std::optional<double> ratio = wrong_of(run);
        if (!ratio || !(cost_of(run, of) > 0.0)) {
            continue;
        }
        plot_series& of_method = series[rank_of(all, label_of(run))];
        of_method.name = label_of(run);
        const std::string size = run.map > 0 ? std::to_string(run.map) + "²" : "";
        const double x = x_of(cost_of(run, of));
        const bool timed = of == cost::time;
        of_method.points.push_back({x, timed ? run.result.frame_ms_min : x,
                                    timed ? run.result.frame_ms_max : x, 100.0 * *ratio, size,
                                    label_of(run) + (run.map > 0 ? " at " + size : "") + ": " +
                                        short_number(100.0 * *ratio) + " %, " +
                                        ms_text(run.result.frame_ms_median) + " ms, " +
                                        bytes_text(run.result.bytes)});
    }
    std::vector<plot_series> all_series;
    for (auto& [rank, each] : series) {
        each.colour = rank;
        all_series.push_back(std::move(each));
    }
    std::vector<std::pair<double, double>> front;
    std::vector<std::size_t> with_maps; // what is exact would hide what maps can do
    std::copy_if(runs.begin(), runs.end(), std::back_inserter(with_maps),
                 [&](std::size_t index) { return all.runs[index].map > 0; });
    for (const std::size_t index : pareto_front(all.runs, with_maps, of)) {
        front.emplace_back(x_of(cost_of(all.runs[index], of)), 100.0 * *wrong_of(all.runs[index]));
    }
    return scatter_plot(all_series, of == cost::time ? "frame time, ms" : "memory, MiB",
                        "wrong pixels, %", front);
}

/// The plots of one view; of a sweep against memory too.
std::string plots_of(const results& all, const view_pictures& view) {
    std::vector<std::size_t> runs;
    for (std::size_t i = 0; i < all.runs.size(); ++i) {
        const run_record& run = all.runs[i];
        if (run.scene == view.scene && run.camera == view.camera && run.light == view.light &&
            !run.variant) { // variants have a table of their own
            runs.push_back(i);
        }
    }
    const std::string time = plot_of(all, runs, cost::time);
    return all.matched == 0
               ? time
               : "<div class=\"plots\">\n" + time + plot_of(all, runs, cost::bytes) + "</div>\n";
}

/// Two pictures of a view over each other, with a slider between them.
std::string comparison_of(const results& all, const view_pictures& view) {
    std::string choices = "<option value=\"\">ray traced</option>";
    std::string chosen;
    for (const run_pictures& each : view.runs) {
        const run_record& run = all.runs[each.run];
        if (run.method == "raytraced") {
            continue;
        }
        const std::string id = "p" + std::to_string(each.run);
        chosen = chosen.empty() ? id : chosen;
        choices += "<option value=\"" + id + "\">" + escaped(label_of(run)) +
                   (run.map == 0 ? "" : " " + std::to_string(run.map) + "²") + "</option>";
    }
    if (chosen.empty()) {
        return "";
    }
    const auto picture = [&](const char* side) { // chosen by the script
        return std::string("<img alt=\"") + side + "\" width=\"" +
               std::to_string(view.reference.width) + "\" height=\"" +
               std::to_string(view.reference.height) + "\" loading=\"lazy\" draggable=\"false\">";
    };
    return "<div class=\"compare\"><p><select aria-label=\"left\">" + choices +
           "</select> against <select aria-label=\"right\">" + choices +
           "</select></p><div class=\"over\">" + picture("left") + picture("right") +
           "</div>"
           "<input type=\"range\" aria-label=\"border between the pictures\" min=\"0\" "
           "max=\"100\" value=\"50\"></div>\n";
}

std::string pass_list(const method_result& result) {
    std::string html = "<p class=\"passes\">";
    for (std::size_t i = 0; i < result.passes.size(); ++i) {
        html += i == 0 ? "" : " · ";
        html += escaped(result.passes[i].pass);
        html += "&nbsp;";
        html += ms_text(result.passes[i].ms);
    }
    html += result.passes.empty() ? "" : " ms; ";
    for (const auto& [name, us] : result.cpu_setup_us) {
        html += escaped(name) + " on the CPU&nbsp;" + ms_text(us) + " µs";
    }
    html += "; maps&nbsp;" + std::to_string(result.maps);
    if (result.angle != 0.0) {
        html += ", turned by " + fixed(glm::degrees(result.angle), 1) + "°";
    }
    html += "</p>\n";
    if (!result.status.empty()) {
        html += "<p class=\"passes\">guards:";
        for (const std::string& guard : result.status) {
            html += ' ';
            html += escaped(guard);
        }
        html += "</p>\n";
    }
    return html;
}

/// What the colours of a picture mean, where its name does not say.
std::string_view caption_of(std::string_view name) {
    return name == "texel-extent" ? ": pixels that a texel covers; blue ⅛ or less, white 1, red 8 "
                                    "or more"
                                  : "";
}

std::string texel_line(const method_result& result) {
    if (!result.texels || result.texels->on_receivers.counted == 0) {
        return "";
    }
    const auto& m = result.texels->on_receivers;
    return "<p>a texel covers " + ms_text(m.p50) + "&nbsp;pixels in the median, " + ms_text(m.p99) +
           " at 99&nbsp;%; without the slope of the surface " + ms_text(result.texels->facing.p50) +
           " and " + ms_text(result.texels->facing.p99) + "</p>\n";
}

} // namespace

std::string view_section(const results& all, const view_pictures& view,
                         const std::string& heading) {
    std::string html = "<section>\n" + heading + "\n<p>camera " + escaped(view.camera_text) +
                       "<br>light " + escaped(view.light_text) + "</p>\n" + plots_of(all, view) +
                       comparison_of(all, view) + "<div class=\"cards\">\n";
    html += "<article><h3>ray traced</h3>\n<p>the reference</p>\n" +
            png_image(view.reference, view.scene + ", ray traced", " class=\"truth\"") +
            "<div class=\"pair\">" +
            png_image(view.reference_detail, "detail", " class=\"pixel\"") + "</div></article>\n";
    for (const run_pictures& each : view.runs) {
        const run_record& run = all.runs[each.run];
        if (run.method == "raytraced") {
            continue; // the reference
        }
        const comparison& c = run.against_truth;
        html +=
            "<article><h3>" + dot_of(all, label_of(run)) + escaped(label_of(run)) +
            (run.map == 0 ? std::string() : " <small>" + std::to_string(run.map) + "²</small>") +
            "</h3>\n<p>" + percent_text(c.ratio(c.false_shadow + c.false_light)) +
            "&nbsp;% wrong, " + ms_text(run.result.frame_ms_median) + "&nbsp;ms, " +
            bytes_text(run.result.bytes) + "</p>\n" +
            (run.bias ? "<p>" + percent_text(run.bias_effect.acne_ratio) +
                            "&nbsp;% acne, displacement " +
                            texels_text(run.bias_effect.displacement_texels) + "&nbsp;texels</p>\n"
                      : "") +
            texel_line(run.result) +
            png_image(each.marked, view.scene + ", " + method_text(run) + ", wrong pixels in red",
                      " id=\"p" + std::to_string(each.run) + "\"") +
            "<div class=\"pair\">" + png_image(each.detail, "detail", " class=\"pixel\"") +
            png_image(each.detail_marked, "detail, wrong pixels in red", " class=\"pixel\"") +
            "</div>\n" + pass_list(run.result);
        if (!each.explanations.empty()) {
            html += "<details><summary>inside the method</summary><div class=\"pair\">\n";
            for (const auto& [name, explained] : each.explanations) {
                html += "<figure>" + png_image(explained, name, " class=\"pixel\"") +
                        "<figcaption>" + escaped(name) + std::string(caption_of(name)) +
                        "</figcaption></figure>\n";
            }
            html += "</div></details>\n";
        }
        html += "</article>\n";
    }
    return html + "</div>\n</section>\n";
}

} // namespace lab
