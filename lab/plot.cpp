#include "lab/plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lab {
namespace {

constexpr double width = 640.0;

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

/// A linear axis.
struct linear_axis {
    double lo;
    double hi;
    double from;
    double to;

    [[nodiscard]] double at(double value) const {
        return from + (value - lo) / (hi - lo) * (to - from);
    }
};

/// Four to eight round numbers that span the values.
std::vector<double> round_numbers(double lo, double hi) {
    if (!(hi > lo)) {
        hi = lo + std::max(std::abs(lo), 1.0);
    }
    const double decade = std::pow(10.0, std::floor(std::log10(hi - lo)));
    double step = decade;
    for (const double share : {0.1, 0.2, 0.5, 1.0}) {
        if ((hi - lo) / (share * decade) <= 6.0) {
            step = share * decade;
            break;
        }
    }
    std::vector<double> result;
    for (double n = std::floor(lo / step + 1e-9);; n += 1.0) {
        result.push_back(n * step);
        if (n * step >= hi - 1e-9 * step) {
            return result;
        }
    }
}

/// The text of one plot, grown element by element.
class drawing {
  public:
    drawing(double height, const std::string& about)
        : svg_("<svg class=\"plot\" viewBox=\"0 0 640 " + fixed(height, 0) +
               "\" role=\"img\" aria-label=\"" + escaped(about) + "\">\n") {}

    void text(double x, double y, const std::string& what, const std::string& more) {
        svg_ += "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" " + more + ">" +
                escaped(what) + "</text>\n";
    }
    void upwards(double x, double y, const std::string& what) {
        svg_ += "<text transform=\"translate(" + fixed(x, 0) + " " + fixed(y, 1) +
                ") rotate(-90)\" text-anchor=\"middle\">" + escaped(what) + "</text>\n";
    }
    void line(double x0, double y0, double x1, double y1, const std::string& kind) {
        svg_ += "<line class=\"" + kind + "\" x1=\"" + fixed(x0, 1) + "\" y1=\"" + fixed(y0, 1) +
                "\" x2=\"" + fixed(x1, 1) + "\" y2=\"" + fixed(y1, 1) + "\"/>\n";
    }
    void polyline(const std::string& points, const std::string& kind) {
        svg_ += "<polyline class=\"" + kind + "\" points=\"" + points + "\"/>\n";
    }
    void circle(double x, double y, const std::string& kind, const std::string& about) {
        svg_ += "<circle class=\"" + kind + "\" cx=\"" + fixed(x, 1) + "\" cy=\"" + fixed(y, 1) +
                "\" r=\"5\"><title>" + escaped(about) + "</title></circle>\n";
    }
    /// A name to the right of a point, moved up until it hides no other, or down if there is no
    /// room above.
    void name(double x, double y, const std::string& what, const std::string& colour) {
        constexpr double step = 13.5;
        const double wanted = y;
        while (hides_a_name(x, y)) {
            y -= step;
        }
        if (y < step) {
            for (y = wanted; hides_a_name(x, y);) {
                y += step;
            }
        }
        names_.emplace_back(x, y);
        text(x, y, what, "class=\"name " + colour + "\"");
    }
    [[nodiscard]] std::string done() const { return svg_ + "</svg>\n"; }

  private:
    [[nodiscard]] bool hides_a_name(double x, double y) const {
        return std::any_of(names_.begin(), names_.end(), [&](const auto& other) {
            return std::abs(other.first - x) < 80.0 && std::abs(other.second - y) < 13.0;
        });
    }

    std::string svg_;
    std::vector<std::pair<double, double>> names_; // where names stand already
};

std::string colour_class(std::size_t colour) {
    return "c" + std::to_string(colour % plot_colours);
}

} // namespace

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

std::string scatter_plot(const std::vector<plot_series>& series, const std::string& x_name,
                         const std::string& y_name,
                         const std::vector<std::pair<double, double>>& front) {
    std::vector<double> xs;
    std::vector<double> ys;
    for (const plot_series& each : series) {
        for (const plot_point& p : each.points) {
            xs.insert(xs.end(), {p.x_lo, p.x_hi});
            if (p.y > 0.0) {
                ys.push_back(p.y);
            }
        }
    }
    if (xs.empty()) {
        return {};
    }
    const double height = 400.0;
    const double bottom = height - 52.0;
    const log_axis x = axis_over(xs, 64.0, width - 92.0);
    const log_axis y = axis_over(ys, bottom - 30.0, 18.0);
    const auto y_of = [&](double value) { return value > 0.0 ? y.at(value) : bottom - 8.0; };

    drawing svg(height, y_name + " against " + x_name);
    for (const double tick : ticks_between(x.lo, x.hi)) {
        svg.line(x.at(tick), 18.0, x.at(tick), bottom, "grid");
        svg.text(x.at(tick), bottom + 18.0, short_number(tick), "text-anchor=\"middle\"");
    }
    for (const double tick : ticks_between(y.lo, y.hi)) {
        svg.line(64.0, y.at(tick), width - 92.0, y.at(tick), "grid");
        svg.text(58.0, y.at(tick) + 4.0, short_number(tick), "text-anchor=\"end\"");
    }
    svg.line(64.0, bottom, width - 92.0, bottom, "axis");
    svg.line(64.0, 18.0, 64.0, bottom, "axis");
    svg.text(58.0, bottom - 4.0, "0", "text-anchor=\"end\"");
    svg.text(0.5 * (64.0 + width - 92.0), height - 10.0, x_name, "text-anchor=\"middle\"");
    svg.upwards(16.0, 0.5 * bottom + 9.0, y_name);

    std::string steps;
    for (std::size_t i = 0; i < front.size(); ++i) {
        const auto corner = [&](double at, double value) {
            steps += (steps.empty() ? "" : " ") + fixed(x.at(at), 1) + "," + fixed(y_of(value), 1);
        };
        if (i > 0) {
            corner(front[i].first, front[i - 1].second);
        }
        corner(front[i].first, front[i].second);
    }
    if (front.size() > 1) {
        svg.polyline(steps, "front");
    }

    for (const plot_series& each : series) {
        const std::string colour = colour_class(each.colour);
        for (std::size_t i = 0; i < each.points.size(); ++i) {
            const plot_point& p = each.points[i];
            if (i > 0) {
                const plot_point& last = each.points[i - 1];
                svg.line(x.at(last.x), y_of(last.y), x.at(p.x), y_of(p.y), "series " + colour);
            }
            svg.line(x.at(p.x_lo), y_of(p.y), x.at(p.x_hi), y_of(p.y), "span " + colour);
            svg.circle(x.at(p.x), y_of(p.y), colour, p.about);
            if (each.points.size() > 1) {
                svg.text(x.at(p.x), y_of(p.y) - 9.0, p.mark,
                         "class=\"small\" text-anchor=\"middle\"");
            }
        }
        const plot_point& end = each.points.back();
        svg.name(std::max(x.at(end.x), x.at(end.x_hi)) + 9.0, y_of(end.y) + 4.0, each.name, colour);
    }
    return svg.done();
}

std::string frame_plot(const std::vector<frame_series>& series, const std::string& y_name) {
    double lo = 0.0; // a plot that hides zero hides how much there is
    double hi = 0.0;
    std::size_t frames = 0;
    bool any = false;
    for (const frame_series& each : series) {
        frames = std::max(frames, each.values.size());
        for (const std::optional<double>& value : each.values) {
            if (value) {
                lo = std::min(lo, *value);
                hi = std::max(hi, *value);
                any = true;
            }
        }
    }
    if (!any || frames < 2) {
        return {};
    }
    const double height = 220.0;
    const double bottom = height - 40.0;
    const std::vector<double> y_ticks = round_numbers(lo, hi);
    const std::vector<double> x_ticks = round_numbers(0.0, static_cast<double>(frames - 1));
    const linear_axis x{0.0, static_cast<double>(frames - 1), 64.0, width - 92.0};
    const linear_axis y{y_ticks.front(), y_ticks.back(), bottom, 14.0};

    drawing svg(height, y_name + " over frames");
    for (const double tick : x_ticks) {
        if (tick <= x.hi) {
            svg.line(x.at(tick), 14.0, x.at(tick), bottom, "grid");
            svg.text(x.at(tick), bottom + 16.0, short_number(tick), "text-anchor=\"middle\"");
        }
    }
    for (const double tick : y_ticks) {
        svg.line(64.0, y.at(tick), width - 92.0, y.at(tick), "grid");
        svg.text(58.0, y.at(tick) + 4.0, short_number(tick), "text-anchor=\"end\"");
    }
    svg.line(64.0, bottom, width - 92.0, bottom, "axis");
    svg.text(0.5 * (64.0 + width - 92.0), height - 6.0, "frame", "text-anchor=\"middle\"");
    svg.upwards(14.0, 0.5 * (14.0 + bottom), y_name);
    for (const frame_series& each : series) {
        const std::string kind = "series open " + colour_class(each.colour);
        std::string points;
        double end = 0.0;
        for (std::size_t i = 0; i < each.values.size(); ++i) {
            if (!each.values[i]) {
                if (!points.empty()) {
                    svg.polyline(points, kind);
                }
                points.clear();
                continue;
            }
            end = y.at(*each.values[i]);
            points += (points.empty() ? "" : " ") + fixed(x.at(static_cast<double>(i)), 1) + "," +
                      fixed(end, 1);
        }
        if (!points.empty()) {
            svg.polyline(points, kind);
            svg.name(x.to + 6.0, end + 4.0, each.name, colour_class(each.colour));
        }
    }
    return svg.done();
}

} // namespace lab
