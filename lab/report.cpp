#include "lab/report.hpp"

#include "lab/accuracy.hpp"
#include "lab/accuracy_report.hpp"
#include "lab/plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <string_view>

namespace lab {
namespace {

std::string base64(const std::vector<std::uint8_t>& bytes) {
    static constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8 | (k < left ? bytes[i + k] : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            out += k <= left ? digits[group >> (18 - 6 * k) & 63u] : '=';
        }
    }
    return out;
}

std::string image(const png_file& source, const std::string& what, const std::string& more = "") {
    return "<img" + more + " alt=\"" + escaped(what) + "\" width=\"" +
           std::to_string(source.width) + "\" height=\"" + std::to_string(source.height) +
           "\" loading=\"lazy\" src=\"data:image/png;base64," + base64(source.bytes) + "\">";
}

/// A method with its bias, if that was measured.
std::string label_of(const run_record& run) {
    return run.bias ? method_text(run) + " " + *run.bias : method_text(run);
}

bool any_bias(const results& all) {
    return std::any_of(all.runs.begin(), all.runs.end(),
                       [](const run_record& run) { return run.bias.has_value(); });
}

/// Rank of a method in the order of first appearance; it decides the colour.
std::size_t rank_of(const results& all, const std::string& method) {
    std::vector<std::string> seen;
    const auto see = [&](const std::string& each) {
        if (std::find(seen.begin(), seen.end(), each) == seen.end()) {
            seen.push_back(each);
        }
    };
    for (const run_record& run : all.runs) {
        see(label_of(run));
    }
    for (const path_record& path : all.paths) {
        see(path.method);
    }
    return static_cast<std::size_t>(std::find(seen.begin(), seen.end(), method) - seen.begin());
}

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
        if (run.scene == view.scene && run.camera == view.camera && run.light == view.light) {
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
    return "<div class=\"compare\"><p><select aria-label=\"left\">" + choices +
           "</select> against <select aria-label=\"right\">" + choices +
           "</select></p><div class=\"over\"><img alt=\"left\"><img alt=\"right\"></div>"
           "<input type=\"range\" aria-label=\"border between the pictures\" min=\"0\" "
           "max=\"100\" value=\"50\"></div>\n";
}

std::string cell(const std::string& text, bool number = true) {
    return number ? "<td class=\"n\">" + escaped(text) + "</td>" : "<td>" + escaped(text) + "</td>";
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
                "<td><i class=\"dot c" +
                std::to_string(rank_of(all, label_of(run)) % plot_colours) + "\"></i>" +
                escaped(method_text(run)) + "</td>" +
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

std::string view_section(const results& all, const view_pictures& view) {
    std::string html = "<section>\n<h2>" + escaped(view.scene) + "</h2>\n<p>camera " +
                       escaped(view.camera_text) + "<br>light " + escaped(view.light_text) +
                       "</p>\n" + plots_of(all, view) + comparison_of(all, view) +
                       "<div class=\"cards\">\n";
    html += "<article><h3>ray traced</h3>\n<p>the reference</p>\n" +
            image(view.reference, view.scene + ", ray traced", " class=\"truth\"") +
            "<div class=\"pair\">" + image(view.reference_detail, "detail", " class=\"pixel\"") +
            "</div></article>\n";
    for (const run_pictures& each : view.runs) {
        const run_record& run = all.runs[each.run];
        if (run.method == "raytraced") {
            continue; // the reference
        }
        const comparison& c = run.against_truth;
        html +=
            "<article><h3><i class=\"dot c" +
            std::to_string(rank_of(all, label_of(run)) % plot_colours) + "\"></i>" +
            escaped(label_of(run)) +
            (run.map == 0 ? std::string() : " <small>" + std::to_string(run.map) + "²</small>") +
            "</h3>\n<p>" + percent_text(c.ratio(c.false_shadow + c.false_light)) +
            "&nbsp;% wrong, " + ms_text(run.result.frame_ms_median) + "&nbsp;ms, " +
            bytes_text(run.result.bytes) + "</p>\n" +
            (run.bias ? "<p>" + percent_text(run.bias_effect.acne_ratio) +
                            "&nbsp;% acne, displacement " +
                            texels_text(run.bias_effect.displacement_texels) + "&nbsp;texels</p>\n"
                      : "") +
            texel_line(run.result) +
            image(each.marked, view.scene + ", " + method_text(run) + ", wrong pixels in red",
                  " id=\"p" + std::to_string(each.run) + "\"") +
            "<div class=\"pair\">" + image(each.detail, "detail", " class=\"pixel\"") +
            image(each.detail_marked, "detail, wrong pixels in red", " class=\"pixel\"") +
            "</div>\n" + pass_list(run.result);
        if (!each.explanations.empty()) {
            html += "<details><summary>inside the method</summary><div class=\"pair\">\n";
            for (const auto& [name, explained] : each.explanations) {
                html += "<figure>" + image(explained, name, " class=\"pixel\"") + "<figcaption>" +
                        escaped(name) + std::string(caption_of(name)) + "</figcaption></figure>\n";
            }
            html += "</div></details>\n";
        }
        html += "</article>\n";
    }
    return html + "</div>\n</section>\n";
}

std::string path_section(const results& all, const path_pictures& seen) {
    const path_record& first = all.paths[seen.first];
    std::string html = "<section>\n<h2>" + escaped(first.scene) + ", " + escaped(first.path) +
                       "</h2>\n<p>" + std::to_string(first.frames.size()) + " frames from camera " +
                       escaped(seen.camera_text) + "<br>light " + escaped(seen.light_text) +
                       "</p>\n<div class=\"scroll\"><table>\n<thead><tr><th>method</th>"
                       "<th class=\"n\">map</th><th class=\"n\">wrong&nbsp;%</th>"
                       "<th class=\"n\">flips&nbsp;%</th><th class=\"n\">largest turn&nbsp;°</th>"
                       "<th class=\"n\">frame ms</th><th class=\"n\">shadow map ms</th>"
                       "<th class=\"n\">maps</th></tr></thead>\n"
                       "<tbody>\n";
    std::vector<frame_series> wrong;
    std::vector<frame_series> flips;
    std::vector<frame_series> angles;
    std::vector<frame_series> times;
    std::vector<frame_series> shadow_map_times;
    std::vector<frame_series> maps;
    for (std::size_t i = seen.first; i < seen.first + seen.count; ++i) {
        const path_record& path = all.paths[i];
        const path_means means = means_of(path);
        const std::size_t rank = rank_of(all, path.method);
        html += "<tr><td><i class=\"dot c" + std::to_string(rank % plot_colours) + "\"></i>" +
                escaped(path.method) + "</td>" +
                cell(path.map == 0 ? "–" : std::to_string(path.map)) +
                cell(percent_text(means.wrong_ratio)) +
                cell(means.flip_ratio ? fixed(100.0 * *means.flip_ratio, 3) : "-") +
                cell(fixed(glm::degrees(means.largest_turn), 2)) + cell(ms_text(means.frame_ms)) +
                cell(ms_text(means.shadow_map_ms)) + cell(short_number(means.maps)) + "</tr>\n";
        const std::string name =
            path.method + (seen.one_size || path.map == 0 ? "" : " " + std::to_string(path.map));
        for (std::vector<frame_series>* const each :
             {&wrong, &flips, &angles, &times, &shadow_map_times, &maps}) {
            each->push_back({name, rank, {}});
        }
        const auto per_cent = [](std::optional<double> ratio) {
            return ratio ? std::optional(100.0 * *ratio) : std::nullopt;
        };
        for (const path_frame& frame : path.frames) {
            wrong.back().values.push_back(per_cent(frame.wrong_ratio));
            flips.back().values.push_back(per_cent(frame.flip_ratio));
            angles.back().values.emplace_back(glm::degrees(frame.angle));
            times.back().values.emplace_back(frame.frame_ms);
            shadow_map_times.back().values.emplace_back(frame.shadow_map_ms);
            maps.back().values.emplace_back(frame.maps);
        }
    }
    html += "</tbody></table></div>\n<div class=\"plots\">\n" +
            frame_plot(wrong, "wrong pixels, %") + frame_plot(flips, "pixels that flip, %") +
            frame_plot(angles, "turn of the map, °") + frame_plot(times, "frame time, ms") +
            frame_plot(shadow_map_times, "shadow maps, ms") + frame_plot(maps, "maps drawn") +
            "</div>\n<div class=\"cards\">\n";
    for (const auto& [caption, picture] : seen.pictures) {
        html += "<figure>" + image(picture, caption) + "<figcaption>" + escaped(caption) +
                "</figcaption></figure>\n";
    }
    return html + "</div>\n</section>\n";
}

constexpr const char* style = R"(
:root { color-scheme: light dark; --paper: #fbfaf7; --ink: #1f2328; --soft: #5d6670; --rule: #d9d6cf;
  --card: #ffffff; --c0: #7b8794; --c1: #2f7dc0; --c2: #c4532d; --c3: #9a6cc0; --c4: #3f8f4f;
  --c5: #b88a00; --c6: #c2417c; --c7: #2a9d9d; --c8: #5b6bd6; --c9: #8a6d3b;
  --c10: #6a994e; --c11: #a23b3b; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181b; --ink: #e6e4df; --soft: #9aa3ad;
  --rule: #33383e; --card: #1d2024; --c0: #9aa7b4; --c1: #63aeea; --c2: #f0845c; --c3: #bf9be0;
  --c4: #6fc283; --c5: #e0b84a; --c6: #ec7fb0; --c7: #5fcaca;
  --c8: #98a4ff; --c9: #c7a66b; --c10: #a3cf86; --c11: #e08080; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", sans-serif; }
main { max-width: 1240px; margin: 0 auto; padding: 1.2rem; }
h1 { font-size: 1.6rem; margin: .4rem 0; } h2 { margin: 2.4rem 0 .2rem; }
h3 { margin: 0; font-size: 1.05rem; } h3 small, p, figcaption { color: var(--soft); }
p { margin: .3rem 0; overflow-wrap: anywhere; } .passes { font-size: .8rem; }
.scroll { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .9rem; }
th, td { text-align: left; padding: .3rem .8rem .3rem 0; border-bottom: 1px solid var(--rule);
  white-space: nowrap; }
th { font-weight: 600; vertical-align: bottom; } .n { text-align: right; }
.cards { display: grid; gap: 1.2rem; grid-template-columns: repeat(auto-fill, minmax(min(100%, 380px), 1fr)); }
article { background: var(--card); border: 1px solid var(--rule); border-radius: 8px; padding: .8rem; }
img { width: 100%; height: auto; display: block; border-radius: 3px; margin-top: .4rem; }
.pixel { image-rendering: pixelated; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: .4rem; }
figure { margin: 0; } figcaption { font-size: .8rem; } summary { cursor: pointer; margin-top: .5rem; }
.plot { width: 100%; max-width: 640px; height: auto; margin: .6rem 0 1rem; font-size: 12px; }
.plot text { fill: var(--ink); } .plot .small { font-size: 10px; fill: var(--soft); }
.grid { stroke: var(--rule); stroke-width: .6; } .axis { stroke: var(--soft); }
.series { stroke-width: 1.6; } .span { stroke-width: 1.2; }
.plots { display: grid; gap: .4rem 1.2rem;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, 480px), 1fr)); }
.plot .open { fill: none; }
.front { fill: none; stroke: var(--ink); stroke-width: 5; stroke-opacity: .18; stroke-linejoin: round; }
.answer td { white-space: normal; } .answer small { color: var(--soft); }
.over { position: relative; max-width: 1024px; } .over img { margin: 0; }
.over img + img { position: absolute; inset: 0; clip-path: inset(0 0 0 50%); }
.compare input { width: 100%; max-width: 1024px; }
.dot { display: inline-block; width: .7em; height: .7em; border-radius: 50%; margin-right: .45em; }
)";

/// The slider between two pictures, which are those that the page shows anyway.
constexpr const char* script = R"(
for (const box of document.querySelectorAll(".compare")) {
  const [left, right] = box.querySelectorAll("select"), [under, over] = box.querySelectorAll("img");
  const truth = box.parentElement.querySelector(".truth"), slider = box.querySelector("input");
  const source = choice => (choice.value ? document.getElementById(choice.value) : truth).src;
  const show = () => {
    under.src = source(left);
    over.src = source(right);
    over.style.clipPath = `inset(0 0 0 ${slider.value}%)`;
  };
  right.selectedIndex = Math.min(1, right.options.length - 1);
  for (const each of [left, right, slider]) each.addEventListener("input", show);
  show();
}
)";

std::string colour_rules() {
    std::string css;
    for (std::size_t i = 0; i < plot_colours; ++i) {
        const std::string name = std::string("c") + std::to_string(i);
        const std::string colour = std::string("var(--") + name + ")";
        css += '.';
        css += name + " { stroke: " + colour + "; fill: " + colour + "; }\n";
        css += "i.";
        css += name + " { background: " + colour + "; }\n.plot text.";
        css += name + " { stroke: none; fill: " + colour + "; font-weight: 600; }\n";
    }
    return css;
}

} // namespace

std::string png_image(const png_file& source, const std::string& what) {
    return image(source, what);
}

std::string html_of(const results& all, const std::vector<view_pictures>& views,
                    const std::vector<path_pictures>& paths,
                    const std::vector<std::string>& figures) {
    std::string html =
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>warpshadow-lab report</title>\n<style>" +
        std::string(style) + colour_rules() +
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
    return html + "</main>\n<script>" + script + "</script>\n</body>\n</html>\n";
}

} // namespace lab
