// Plots as SVG, for pages that bring their own style sheet.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lab {

/// Classes "c0" to "c11" of the style sheet are the colours of series.
inline constexpr std::size_t plot_colours = 12;

/// Text that may stand in HTML, attributes included.
std::string escaped(std::string_view text);

/// A number with so many digits after the point.
std::string fixed(double value, int digits);

/// Three digits, without an exponent where that is readable.
std::string short_number(double value);

/// One measurement: a point with a span along x.
struct plot_point {
    double x;
    double x_lo;
    double x_hi;
    double y;          ///< 0 has a place of its own below the axis
    std::string mark;  ///< written beside the point where a series has several
    std::string about; ///< shown when the pointer rests on it
};

/// Points of one colour, joined by a line.
struct plot_series {
    std::string name;
    std::size_t colour;
    std::vector<plot_point> points;
};

/// Both axes logarithmic; the empty text for no points.
/// @param front points that no other beats, by x: drawn as the border of what can be had
std::string scatter_plot(const std::vector<plot_series>& series, const std::string& x_name,
                         const std::string& y_name,
                         const std::vector<std::pair<double, double>>& front = {});

/// One value per frame; frames without a value leave a gap.
struct frame_series {
    std::string name;
    std::size_t colour;
    std::vector<std::optional<double>> values;
};

/// Values over frames, both axes linear; the empty text if no series has a value.
std::string frame_plot(const std::vector<frame_series>& series, const std::string& y_name);

} // namespace lab
