#include "lab/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace lab {
namespace {

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += c;
        }
    }
    return out;
}

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

std::string image(const png_file& source, const std::string& what, const char* kind = "") {
    return "<img" + std::string(kind) + " alt=\"" + escaped(what) + "\" width=\"" +
           std::to_string(source.width) + "\" height=\"" + std::to_string(source.height) +
           "\" loading=\"lazy\" src=\"data:image/png;base64," + base64(source.bytes) + "\">";
}

std::string fixed(double value, int digits) {
    char buffer[48];
    std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
    return buffer;
}

/// Three digits, without an exponent where that is readable.
std::string short_number(double value) {
    char buffer[48];
    std::snprintf(buffer, sizeof buffer, value >= 1000.0 && value < 1e7 ? "%.0f" : "%.3g", value);
    return buffer;
}

/// Rank of a method in the order of first appearance; it decides the colour.
std::size_t rank_of(const results& all, const std::string& method) {
    std::vector<std::string> seen;
    for (const run_record& run : all.runs) {
        if (std::find(seen.begin(), seen.end(), run.method) == seen.end()) {
            seen.push_back(run.method);
        }
    }
    return static_cast<std::size_t>(std::find(seen.begin(), seen.end(), method) - seen.begin());
}

constexpr std::size_t colours = 8;

/// A logarithmic axis over the values, widened to the next of 1, 2, 5 · 10^n on both sides.
struct log_axis {
    double lo;
    double hi;
    double from;
    double to;

    [[nodiscard]] double at(double value) const {
        const double t = std::log(std::clamp(value, lo, hi) / lo) / std::log(hi / lo);
        return from + t * (to - from);
    }
};

std::vector<double> ticks_between(double lo, double hi) {
    // short axes get more ticks in a decade
    const std::vector<double> steps = hi > 12.0 * lo
                                          ? std::vector<double>{1.0, 2.0, 5.0}
                                          : std::vector<double>{1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0};
    std::vector<double> result;
    for (int decade = -9; decade < 12; ++decade) {
        for (const double step : steps) {
            const double value = step * std::pow(10.0, decade);
            if (value >= lo * (1.0 - 1e-9) && value <= hi * (1.0 + 1e-9)) {
                result.push_back(value);
            }
        }
    }
    return result;
}

log_axis axis_over(const std::vector<double>& values, double from, double to) {
    double least = 1e9;
    double most = 0.0;
    for (const double value : values) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
    if (values.empty()) {
        least = 0.5;
        most = 1.0;
    }
    double lo = 1e-9;
    double hi = 1e11;
    for (const double tick : ticks_between(1e-9, 1e11)) {
        if (tick < least * 0.999) {
            lo = tick;
        }
        if (tick > most * 1.001 && hi > 1e10) {
            hi = tick;
        }
    }
    return {lo, hi, from, to};
}

struct point {
    double ms;
    double ms_lo;
    double ms_hi;
    double error; ///< per cent
    int map;
};

/// Error against frame time; a line joins the map sizes of one method.
std::string plot_of(const results& all, const view_pictures& view) {
    std::map<std::size_t, std::pair<std::string, std::vector<point>>> series;
    std::vector<double> times;
    std::vector<double> errors;
    for (const run_pictures& each : view.runs) {
        const run_record& run = all.runs[each.run];
        const std::optional<double> ratio =
            run.against_truth.ratio(run.against_truth.false_shadow + run.against_truth.false_light);
        if (!ratio || !(run.result.frame_ms_min > 0.0)) {
            continue;
        }
        auto& [name, points] = series[rank_of(all, run.method)];
        name = run.method;
        points.push_back({run.result.frame_ms_median, run.result.frame_ms_min,
                          run.result.frame_ms_max, 100.0 * *ratio, run.map});
        times.insert(times.end(), {run.result.frame_ms_min, run.result.frame_ms_max});
        if (*ratio > 0.0) {
            errors.push_back(100.0 * *ratio);
        }
    }
    if (times.empty()) {
        return {};
    }
    const double width = 640.0;
    const double height = 400.0;
    const double bottom = height - 52.0;
    const log_axis x = axis_over(times, 64.0, width - 92.0);
    const log_axis y = axis_over(errors, bottom - 30.0, 18.0);
    const auto y_of = [&](double error) { return error > 0.0 ? y.at(error) : bottom - 8.0; };

    std::string svg = "<svg class=\"plot\" viewBox=\"0 0 640 400\" role=\"img\" aria-label=\"Wrong "
                      "pixels against frame time\">\n";
    const auto text = [&](double px, double py, const std::string& what, const char* more) {
        svg += "<text x=\"" + fixed(px, 1) + "\" y=\"" + fixed(py, 1) + "\" " + more + ">" +
               escaped(what) + "</text>\n";
    };
    const auto line = [&](double x0, double y0, double x1, double y1, const std::string& kind) {
        svg += "<line class=\"" + kind + "\" x1=\"" + fixed(x0, 1) + "\" y1=\"" + fixed(y0, 1) +
               "\" x2=\"" + fixed(x1, 1) + "\" y2=\"" + fixed(y1, 1) + "\"/>\n";
    };
    for (const double tick : ticks_between(x.lo, x.hi)) {
        line(x.at(tick), 18.0, x.at(tick), bottom, "grid");
        text(x.at(tick), bottom + 18.0, short_number(tick), "text-anchor=\"middle\"");
    }
    for (const double tick : ticks_between(y.lo, y.hi)) {
        line(64.0, y.at(tick), width - 92.0, y.at(tick), "grid");
        text(58.0, y.at(tick) + 4.0, short_number(tick), "text-anchor=\"end\"");
    }
    line(64.0, bottom, width - 92.0, bottom, "axis");
    line(64.0, 18.0, 64.0, bottom, "axis");
    text(58.0, bottom - 4.0, "0", "text-anchor=\"end\"");
    text(0.5 * (64.0 + width - 92.0), height - 10.0, "frame time, ms", "text-anchor=\"middle\"");
    svg += "<text transform=\"translate(16 " + fixed(0.5 * bottom + 9.0, 1) +
           ") rotate(-90)\" text-anchor=\"middle\">wrong pixels, %</text>\n";

    std::vector<std::pair<double, double>> labels; // where names stand already
    for (auto& [rank, entry] : series) {
        auto& [name, points] = entry;
        std::sort(points.begin(), points.end(),
                  [](const point& a, const point& b) { return a.map < b.map; });
        const std::string colour = "c" + std::to_string(rank % colours);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const point& p = points[i];
            if (i > 0) {
                line(x.at(points[i - 1].ms), y_of(points[i - 1].error), x.at(p.ms), y_of(p.error),
                     "series " + colour);
            }
            line(x.at(p.ms_lo), y_of(p.error), x.at(p.ms_hi), y_of(p.error), "span " + colour);
            svg += "<circle class=\"" + colour + "\" cx=\"" + fixed(x.at(p.ms), 1) + "\" cy=\"" +
                   fixed(y_of(p.error), 1) + "\" r=\"5\"><title>" + escaped(name) +
                   (p.map > 0 ? " at " + std::to_string(p.map) + "²" : "") + ": " +
                   short_number(p.error) + " %, " + ms_text(p.ms) + " ms</title></circle>\n";
            if (points.size() > 1) {
                text(x.at(p.ms), y_of(p.error) - 9.0, std::to_string(p.map) + "²",
                     "class=\"small\" text-anchor=\"middle\"");
            }
        }
        const double label_x = std::max(x.at(points.back().ms), x.at(points.back().ms_hi)) + 9.0;
        double label_y = y_of(points.back().error) + 4.0;
        for (bool moved = true; moved;) {
            moved = false;
            for (const auto& [other_x, other_y] : labels) {
                if (std::abs(other_x - label_x) < 80.0 && std::abs(other_y - label_y) < 13.0) {
                    label_y = other_y - 13.5;
                    moved = true;
                }
            }
        }
        labels.emplace_back(label_x, label_y);
        text(label_x, label_y, name, ("class=\"name " + colour + "\"").c_str());
    }
    return svg + "</svg>\n";
}

std::string cell(const std::string& text, bool number = true) {
    return number ? "<td class=\"n\">" + escaped(text) + "</td>" : "<td>" + escaped(text) + "</td>";
}

std::string table(const results& all) {
    std::string html =
        "<div class=\"scroll\"><table>\n<thead><tr><th>scene</th><th>camera</th><th>light</th>"
        "<th>method</th><th class=\"n\">map</th><th class=\"n\">wrong&nbsp;%</th>"
        "<th class=\"n\">false shadow&nbsp;%</th><th class=\"n\">false light&nbsp;%</th>"
        "<th class=\"n\">grazing wrong&nbsp;%</th><th class=\"n\">frame ms</th>"
        "<th class=\"n\">min–max</th><th class=\"n\">bytes</th><th class=\"n\">triangles</th>"
        "</tr></thead>\n<tbody>\n";
    for (const run_record& run : all.runs) {
        const comparison& c = run.against_truth;
        const method_result& r = run.result;
        std::optional<double> grazing;
        if (c.grazing_samples > 0) {
            grazing = static_cast<double>(c.grazing_wrong) / static_cast<double>(c.grazing_samples);
        }
        html += "<tr>" + cell(run.scene, false) + cell(run.camera, false) + cell(run.light, false) +
                "<td><i class=\"dot c" + std::to_string(rank_of(all, run.method) % colours) +
                "\"></i>" + escaped(run.method) + "</td>" +
                cell(run.map == 0 ? "–" : std::to_string(run.map)) +
                cell(percent_text(c.ratio(c.false_shadow + c.false_light))) +
                cell(percent_text(c.ratio(c.false_shadow))) +
                cell(percent_text(c.ratio(c.false_light))) + cell(percent_text(grazing)) +
                cell(ms_text(r.frame_ms_median)) +
                cell(ms_text(r.frame_ms_min) + "–" + ms_text(r.frame_ms_max)) +
                cell(bytes_text(r.bytes)) + cell(std::to_string(r.triangles)) + "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::string pass_list(const method_result& result) {
    if (result.passes.empty()) {
        return {};
    }
    std::string html = "<p class=\"passes\">";
    for (std::size_t i = 0; i < result.passes.size(); ++i) {
        html += i == 0 ? "" : " · ";
        html += escaped(result.passes[i].pass);
        html += "&nbsp;";
        html += ms_text(result.passes[i].ms);
    }
    html += " ms</p>\n";
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

std::string view_section(const results& all, const view_pictures& view) {
    std::string html = "<section>\n<h2>" + escaped(view.scene) + "</h2>\n<p>camera " +
                       escaped(view.camera_text) + "<br>light " + escaped(view.light_text) +
                       "</p>\n" + plot_of(all, view) + "<div class=\"cards\">\n";
    html += "<article><h3>ray traced</h3>\n<p>the reference</p>\n" +
            image(view.reference, view.scene + ", ray traced") + "<div class=\"pair\">" +
            image(view.reference_detail, "detail", " class=\"pixel\"") + "</div></article>\n";
    for (const run_pictures& each : view.runs) {
        const run_record& run = all.runs[each.run];
        if (run.map == 0) {
            continue; // the ray tracer itself
        }
        const comparison& c = run.against_truth;
        html += "<article><h3><i class=\"dot c" +
                std::to_string(rank_of(all, run.method) % colours) + "\"></i>" +
                escaped(run.method) + " <small>" + std::to_string(run.map) + "²</small></h3>\n<p>" +
                percent_text(c.ratio(c.false_shadow + c.false_light)) + "&nbsp;% wrong, " +
                ms_text(run.result.frame_ms_median) + "&nbsp;ms, " + bytes_text(run.result.bytes) +
                "</p>\n" +
                image(each.marked, view.scene + ", " + run.method + ", wrong pixels in red") +
                "<div class=\"pair\">" + image(each.detail, "detail", " class=\"pixel\"") +
                image(each.detail_marked, "detail, wrong pixels in red", " class=\"pixel\"") +
                "</div>\n" + pass_list(run.result);
        if (!each.explanations.empty()) {
            html += "<details><summary>inside the method</summary><div class=\"pair\">\n";
            for (const auto& [name, explained] : each.explanations) {
                html += "<figure>" + image(explained, name, " class=\"pixel\"") + "<figcaption>" +
                        escaped(name) + "</figcaption></figure>\n";
            }
            html += "</div></details>\n";
        }
        html += "</article>\n";
    }
    return html + "</div>\n</section>\n";
}

constexpr const char* style = R"(
:root { color-scheme: light dark; --paper: #fbfaf7; --ink: #1f2328; --soft: #5d6670; --rule: #d9d6cf;
  --card: #ffffff; --c0: #7b8794; --c1: #2f7dc0; --c2: #c4532d; --c3: #9a6cc0; --c4: #3f8f4f;
  --c5: #b88a00; --c6: #c2417c; --c7: #2a9d9d; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181b; --ink: #e6e4df; --soft: #9aa3ad;
  --rule: #33383e; --card: #1d2024; --c0: #9aa7b4; --c1: #63aeea; --c2: #f0845c; --c3: #bf9be0;
  --c4: #6fc283; --c5: #e0b84a; --c6: #ec7fb0; --c7: #5fcaca; } }
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
.dot { display: inline-block; width: .7em; height: .7em; border-radius: 50%; margin-right: .45em; }
)";

std::string colour_rules() {
    std::string css;
    for (std::size_t i = 0; i < colours; ++i) {
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

std::string html_of(const results& all, const std::vector<view_pictures>& views) {
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
        table(all);
    for (const not_applicable& each : all.left_out) {
        html += "<p>" + escaped(each.method) + " does not apply to " + escaped(each.scene) +
                ", light " + escaped(each.light) + ": " + escaped(each.reason) + ".</p>\n";
    }
    for (const view_pictures& view : views) {
        html += view_section(all, view);
    }
    return html + "</main></body>\n</html>\n";
}

} // namespace lab
