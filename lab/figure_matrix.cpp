#include "lab/figure_matrix.hpp"

#include "lab/plot.hpp"
#include "lab/report_parts.hpp"

namespace lab {

png_file write_figure_picture(const options& wanted, const scene& world, const camera_view& camera,
                              const light_view& light, report_folder& folder,
                              const std::string& kind, const picture& source) {
    png_file file = png_of(source);
    folder.write(
        picture_name({wanted.preset, world.name, "c" + camera.label, "l" + light.label, kind}),
        file.bytes);
    return file;
}

std::string matrix_section(const results& all, const figure_pictures& seen,
                           const matrix_texts& texts) {
    const figure_record& record = all.figures[seen.figure];
    std::string html =
        "<section class=\"figure\" style=\"--cell: " + std::to_string(texts.cell_pixels) +
        "px\">\n<h2>" + escaped(record.scene) + ", after " + texts.source + "</h2>\n<p>camera " +
        escaped(seen.camera_text) + "<br>light " + escaped(seen.light_text) + "</p>\n<p>" +
        texts.explanation + "</p>\n<figure class=\"reference\">" +
        png_image(seen.reference, record.scene + ", ray traced") +
        "<figcaption>ray traced</figcaption></figure>\n";
    std::string row;
    for (std::size_t i = 0; i < record.cells.size(); ++i) {
        const figure_record::cell& cell = record.cells[i];
        if (cell.row != row) {
            html += (row.empty() ? "" : "</div>\n");
            html += "<h3>" + escaped(cell.row) + "</h3>\n<div class=\"matrix\">\n";
            row = cell.row;
        }
        const std::string name = cell.row + ", " + cell.column;
        html += "<figure>" + png_image(seen.cells[i], name) +
                (seen.maps.empty() ? "" : png_image(seen.maps[i], name + ", the map")) +
                "<figcaption><b>" + escaped(cell.column) +
                "</b>: " + texts.caption(cell, all.runs[cell.run]) + "</figcaption></figure>\n";
    }
    return html + (row.empty() ? "" : "</div>\n") + "</section>\n";
}

} // namespace lab
