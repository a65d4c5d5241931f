#include "lab/accuracy_report.hpp"

#include "lab/accuracy.hpp"
#include "lab/plot.hpp"
#include "lab/report_parts.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace lab {
namespace {

using nlohmann::ordered_json;

constexpr std::array budgets{1.0, 1.25, 1.5, 2.0, 4.0, std::numeric_limits<double>::infinity()};

/// Methods whose quality others are asked to match.
const std::vector<std::string>& quality_targets() {
    static const std::vector<std::string> names{"fitted", "notw", "cube-notw"};
    return names;
}

/// Methods whose time others may take.
const std::vector<std::string>& time_targets() {
    static const std::vector<std::string> names{"sm", "cube6", "fitted", "notw", "cube-notw"};
    return names;
}

std::string budget_text(double budget) {
    return std::isinf(budget) ? "any time" : "≤&nbsp;" + short_number(budget) + "×";
}

std::string head(std::initializer_list<const char*> names, std::size_t texts) {
    std::string html = "<div class=\"scroll\"><table>\n<thead><tr>";
    std::size_t i = 0;
    for (const char* const name : names) {
        html += i++ < texts ? "<th>" : "<th class=\"n\">";
        html += name;
        html += "</th>";
    }
    return html + "</tr></thead>\n<tbody>\n";
}

std::string text_cell(const std::string& text) {
    return cell(text, false);
}

std::string times(double ratio) {
    return short_number(ratio) + "×";
}

std::string plural(const std::string& kind) {
    return kind == "point" ? "point lights" : kind + "s";
}

std::string answer(const results& all) {
    const std::vector<budget_choice> choices = choose_for_budgets(all.runs, all.matched, budgets);
    std::string html = "<h2>Which method to take</h2>\n<p>Fewest wrong pixels for a frame time, "
                       "that of <b>sm</b>, or "
                       "<b>cube6</b> for point lights, at " +
                       std::to_string(all.matched) +
                       "² being 1: from the G-buffer to the shadow test, over all cameras and "
                       "lights of a kind (geometric mean).</p>\n<div class=\"scroll\"><table "
                       "class=\"answer\">\n<thead><tr><th>scene</th><th>lights</th>";
    for (const double budget : budgets) {
        html += "<th>" + budget_text(budget) + "</th>";
    }
    html += "</tr></thead>\n<tbody>\n";
    for (std::size_t i = 0; i < choices.size();) {
        const budget_choice& first = choices[i];
        html += "<tr>" + text_cell(first.scene) + text_cell(plural(first.kind));
        for (const double budget : budgets) {
            const bool present = i < choices.size() && choices[i].scene == first.scene &&
                                 choices[i].kind == first.kind && choices[i].budget == budget;
            if (!present) {
                html += "<td>–</td>";
                continue;
            }
            const budget_choice& each = choices[i++];
            html += "<td><b>" + escaped(each.method) + "</b> " + std::to_string(each.map) +
                    "²<br><small>" + percent_text(each.wrong) + "&nbsp;%, " + times(each.time) +
                    "</small></td>";
        }
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::string score_table(const results& all) {
    std::vector<method_score> scores = score_methods(all.runs);
    std::stable_sort(scores.begin(), scores.end(), [](const auto& a, const auto& b) {
        return a.kind != b.kind ? a.kind < b.kind
               : a.map != b.map ? a.map < b.map
                                : a.wrong < b.wrong;
    });
    std::string html = "<h2>All scenes together</h2>\n<p>Ratios to sm, or cube6 for point "
                       "lights, at the same size, geometric means over the views; better and worse "
                       "count views.</p>\n" +
                       head({"lights", "method", "map", "views", "wrong", "frame time", "bytes",
                             "better", "worse"},
                            2);
    for (const method_score& each : scores) {
        html += "<tr>" + text_cell(plural(each.kind)) + text_cell(each.method) +
                cell(std::to_string(each.map)) + cell(std::to_string(each.views)) +
                cell(times(each.wrong)) + cell(times(each.time)) + cell(times(each.bytes)) +
                cell(std::to_string(each.better)) + cell(std::to_string(each.worse)) + "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::string variant_table(const results& all) {
    const std::vector<variant_score> scores = score_variants(all.runs);
    if (scores.empty()) {
        return {};
    }
    std::string html =
        "<h2>One thing at a time</h2>\n<p>Ratios to the same method with its defaults, at the same "
        "size, geometric means over the views. Light error: mean difference of filtered light and "
        "that of the ray tracer, to that of hard shadows, which is their share of wrong pixels; a "
        "filtered pixel is wrong when more than half of its light is. Set-up: time on the "
        "host.</p>\n" +
        head({"method", "with", "views", "wrong", "light error", "frame time", "bytes", "set-up"},
             2);
    for (const variant_score& each : scores) {
        html += "<tr>" + text_cell(each.method) + text_cell(each.variant) +
                cell(std::to_string(each.views)) + cell(times(each.wrong)) +
                cell(each.light_error ? times(*each.light_error) : "") + cell(times(each.time)) +
                cell(times(each.bytes)) + cell(times(each.set_up)) + "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

/// Rows of one method matched by others: the target with what it is matched in, then each match.
/// @param what text of the target's cell, after its name
/// @param ratios two cells of a match: text of run and target
template <typename What, typename Ratios>
std::string matched_rows(const results& all, const std::vector<matched_run>& matches, What what,
                         Ratios ratios) {
    std::string html;
    for (const matched_run& each : matches) {
        const run_record& target = all.runs[each.target];
        html += "<tr>" + text_cell(target.scene + ", " + target.camera + ", " + target.light) +
                "<td>" + escaped(target.method) + " " + std::to_string(target.map) +
                "²: " + what(target) + "</td>" + text_cell(each.method);
        if (!each.run) {
            html += cell("none") + cell("") + cell("") + cell("");
        } else {
            const run_record& run = all.runs[*each.run];
            html += cell(std::to_string(run.map)) + cell(percent_text(wrong_of(run)));
            for (const double ratio : ratios(run, target)) {
                html += cell(times(ratio));
            }
        }
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

double cost_ratio(const run_record& run, const run_record& to, cost of) {
    return cost_of(run, of) / cost_of(to, of);
}

std::string quality_table(const results& all) {
    return "<h2>What it takes to be as good</h2>\n<p>For each view, the cheapest measured size at "
           "which a method has no more wrong pixels than the first, and what its frame and its "
           "memory cost, to those of the first.</p>\n" +
           head({"view", "as good as", "method", "map", "wrong&nbsp;%", "frame time", "bytes"}, 3) +
           matched_rows(
               all, match_quality(all.runs, quality_targets(), all.matched),
               [](const run_record& target) { return percent_text(wrong_of(target)) + "&nbsp;%"; },
               [](const run_record& run, const run_record& target) {
                   return std::array{cost_ratio(run, target, cost::time),
                                     cost_ratio(run, target, cost::bytes)};
               });
}

std::string time_table(const results& all) {
    return "<h2>What the same time buys</h2>\n<p>For each view, the measured size with the fewest "
           "wrong pixels among those at which the frame of a method takes no longer than that of "
           "the first; wrong pixels and frame time to those of the first.</p>\n" +
           head({"view", "no longer than", "method", "map", "wrong&nbsp;%", "wrong", "frame time"},
                3) +
           matched_rows(
               all, match_time(all.runs, time_targets(), all.matched),
               [](const run_record& target) {
                   return ms_text(cost_of(target, cost::time)) + "&nbsp;ms";
               },
               [](const run_record& run, const run_record& target) {
                   return std::array{wrong_ratio(run, target), cost_ratio(run, target, cost::time)};
               });
}

/// What is matched, by what, and at which size.
ordered_json json_of(const matched_run& each, const results& all) {
    const run_record& target = all.runs[each.target];
    return {{"scene", target.scene},
            {"camera", target.camera},
            {"light", target.light},
            {"target", target.method},
            {"method", each.method},
            {"map", each.run ? ordered_json(all.runs[*each.run].map) : ordered_json(nullptr)}};
}

} // namespace

std::string accuracy_section(const results& all) {
    return "<div class=\"accuracy\">\n" + answer(all) + score_table(all) + variant_table(all) +
           "<details><summary>Equal quality, view by view</summary>\n" + quality_table(all) +
           "</details>\n<details><summary>Equal time, view by view</summary>\n" + time_table(all) +
           "</details>\n</div>\n";
}

ordered_json accuracy_json(const results& all) {
    ordered_json json;
    json["reference"] = {{"sun", reference_for("sun")},
                         {"spot", reference_for("spot")},
                         {"point", reference_for("point")}};
    json["map"] = all.matched;
    json["budgets"] = ordered_json::array();
    for (const budget_choice& each : choose_for_budgets(all.runs, all.matched, budgets)) {
        json["budgets"].push_back({{"scene", each.scene},
                                   {"light_kind", each.kind},
                                   {"budget", std::isinf(each.budget) ? ordered_json(nullptr)
                                                                      : ordered_json(each.budget)},
                                   {"method", each.method},
                                   {"map", each.map},
                                   {"wrong_pixel_ratio", each.wrong},
                                   {"frame_time", each.time}});
    }
    json["scores"] = ordered_json::array();
    for (const method_score& each : score_methods(all.runs)) {
        json["scores"].push_back({{"light_kind", each.kind},
                                  {"method", each.method},
                                  {"map", each.map},
                                  {"views", each.views},
                                  {"wrong", each.wrong},
                                  {"frame_time", each.time},
                                  {"bytes", each.bytes},
                                  {"better", each.better},
                                  {"worse", each.worse}});
    }
    json["variants"] = ordered_json::array();
    for (const variant_score& each : score_variants(all.runs)) {
        json["variants"].push_back(
            {{"method", each.method},
             {"variant", each.variant},
             {"views", each.views},
             {"wrong", each.wrong},
             {"light_error",
              each.light_error ? ordered_json(*each.light_error) : ordered_json(nullptr)},
             {"frame_time", each.time},
             {"bytes", each.bytes},
             {"cpu_setup", each.set_up}});
    }
    json["equal_quality"] = ordered_json::array();
    for (const matched_run& each : match_quality(all.runs, quality_targets(), all.matched)) {
        ordered_json entry = json_of(each, all);
        entry["frame_time"] = nullptr;
        entry["bytes"] = nullptr;
        if (each.run) {
            const run_record& target = all.runs[each.target];
            const run_record& run = all.runs[*each.run];
            entry["frame_time"] = cost_ratio(run, target, cost::time);
            entry["bytes"] = cost_ratio(run, target, cost::bytes);
        }
        json["equal_quality"].push_back(entry);
    }
    json["equal_time"] = ordered_json::array();
    for (const matched_run& each : match_time(all.runs, time_targets(), all.matched)) {
        ordered_json entry = json_of(each, all);
        entry["wrong"] = nullptr;
        entry["frame_time"] = nullptr;
        if (each.run) {
            const run_record& target = all.runs[each.target];
            const run_record& run = all.runs[*each.run];
            entry["wrong"] = wrong_ratio(run, target);
            entry["frame_time"] = cost_ratio(run, target, cost::time);
        }
        json["equal_time"].push_back(entry);
    }
    return json;
}

} // namespace lab
