#include "lab/report_parts.hpp"

#include "lab/plot.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

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

} // namespace

std::string png_image(const png_file& source, const std::string& what, const std::string& more) {
    return "<img" + more + " alt=\"" + escaped(what) + "\" width=\"" +
           std::to_string(source.width) + "\" height=\"" + std::to_string(source.height) +
           "\" loading=\"lazy\" src=\"data:image/png;base64," + base64(source.bytes) + "\">";
}

std::string cell(const std::string& text, bool number) {
    const std::string shown = text == "-" ? "–" : escaped(text);
    return (number ? "<td class=\"n\">" : "<td>") + shown + "</td>";
}

std::string label_of(const run_record& run) {
    return run.bias ? method_text(run) + " " + *run.bias : method_text(run);
}

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

std::string dot_of(const results& all, const std::string& method) {
    return "<i class=\"dot c" + std::to_string(rank_of(all, method) % plot_colours) + "\"></i>";
}

} // namespace lab
