#include "lab/report_paths.hpp"

#include "lab/plot.hpp"
#include "lab/report_parts.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace lab {

std::string path_section(const results& all, const path_pictures& seen,
                         const std::string& heading) {
    const path_record& first = all.paths[seen.first];
    std::string html =
        "<section>\n" + heading + "\n<p>" + std::to_string(first.frames.size()) +
        " frames from camera " + escaped(seen.camera_text) + "<br>light " +
        escaped(seen.light_text) +
        "</p>\n<div class=\"scroll\"><table class=\"runs\">\n<thead><tr><th>method</th>"
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
        html += "<tr><td>" + dot_of(all, path.method) + escaped(path.method) + "</td>" +
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
        html += "<figure>" + png_image(picture, caption) + "<figcaption>" + escaped(caption) +
                "</figcaption></figure>\n";
    }
    return html + "</div>\n</section>\n";
}

} // namespace lab
