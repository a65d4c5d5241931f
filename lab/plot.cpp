#include "lab/plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

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

/// A text's width where it is widest: bold, in a wide font.
double width_of(std::string_view what) {
    const auto characters = std::count_if(what.begin(), what.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; // the first byte of each
    });
    return 8.6 * static_cast<double>(characters);
}

/// The text of one plot, grown element by element.
class drawing {
  public:
    drawing(double height, const std::string& about)
        : height_(height),
          svg_("<div class=\"scroll\"><svg class=\"plot\" viewBox=\"0 0 640 " + fixed(height, 0) +
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
        taken_.push_back({x - 6.0, y - 6.0, x + 6.0, y + 6.0});
    }
    /// The number of a grid line, unless it would touch another.
    void tick(double x, double y, const std::string& what, const char* anchor) {
        const double w = width_of(what);
        const double left = anchor[0] == 'm' ? x - 0.5 * w : x - w;
        if (take({left - 3.0, y - 11.0, left + w + 3.0, y + 2.0})) {
            text(x, y, what, std::string("text-anchor=\"") + anchor + "\"");
        }
    }
    /// A name beside what lies between `left` and `right`, at the nearest height where it hides
    /// nothing.
    void name(double left, double right, double y, const std::string& what,
              const std::string& colour) {
        constexpr double step = 7.0;
        const double w = width_of(what) + 4.0;
        const auto put = [&](double from, double at, double moved, bool before) {
            if (std::abs(moved) > 2.0 * step) {
                line(before ? left : right, y, before ? left - 7.0 : right + 7.0, at, "lead");
            }
            text(before ? left - 9.0 : from, at + 4.0, what,
                 "class=\"name " + colour + (before ? "\" text-anchor=\"end\"" : "\""));
        };
        for (int k = 0; k < static_cast<int>(2.0 * height_ / step); ++k) {
            const double moved = (k % 2 == 0 ? 0.5 : -0.5) * step * (k + k % 2);
            const double at = y + moved;
            if (at < 10.0 || at > height_ - 6.0) {
                continue;
            }
            for (const bool before : {false, true}) {
                const double from = before ? left - 9.0 - w : right + 9.0;
                if (from >= 0.0 && from + w <= width &&
                    take({from, at - 7.0, from + w, at + 7.0})) {
                    put(from, at, moved, before);
                    return;
                }
            }
        }
        put(right + 9.0, y, 0.0, false); // no room anywhere
    }
    /// A few characters at a point, if there is room on any side.
    void mark(double x, double y, const std::string& what) {
        const double w = width_of(what);
        for (const auto& [dx, dy] :
             {std::pair(0.0, -9.0), std::pair(0.0, 18.0), std::pair(0.5 * w + 9.0, 4.0),
              std::pair(-0.5 * w - 9.0, 4.0)}) {
            const double left = x + dx - 0.5 * w;
            if (left >= 0.0 && left + w <= width && y + dy > 12.0 &&
                take({left, y + dy - 12.0, left + w, y + dy + 3.0})) {
                text(x + dx, y + dy, what, "class=\"small\" text-anchor=\"middle\"");
                return;
            }
        }
    }
    [[nodiscard]] std::string done() const { return svg_ + "</svg></div>\n"; }

  private:
    struct box {
        double left, top, right, bottom;
    };

    /// Makes a place the text's own, if nothing stands there.
    bool take(const box& wanted) {
        const bool free = std::none_of(taken_.begin(), taken_.end(), [&](const box& other) {
            return wanted.left < other.right && other.left < wanted.right &&
                   wanted.top < other.bottom && other.top < wanted.bottom;
        });
        if (free) {
            taken_.push_back(wanted);
        }
        return free;
    }

    double height_;
    std::string svg_;
    std::vector<box> taken_; // where texts and points are
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
        svg.tick(x.at(tick), bottom + 18.0, short_number(tick), "middle");
    }
    for (const double tick : ticks_between(y.lo, y.hi)) {
        svg.line(64.0, y.at(tick), width - 92.0, y.at(tick), "grid");
        svg.tick(58.0, y.at(tick) + 4.0, short_number(tick), "end");
    }
    svg.line(64.0, bottom, width - 92.0, bottom, "axis");
    svg.line(64.0, 18.0, 64.0, bottom, "axis");
    svg.tick(58.0, bottom - 4.0, "0", "end");
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
        }
    }
    for (const plot_series& each : series) { // when all points have their places
        const plot_point& end = each.points.back();
        svg.name(x.at(end.x) - 5.0, x.at(end.x) + 5.0, y_of(end.y), each.name,
                 colour_class(each.colour));
    }
    for (const plot_series& each : series) {
        for (std::size_t i = 0; each.points.size() > 1 && i < each.points.size(); ++i) {
            svg.mark(x.at(each.points[i].x), y_of(each.points[i].y), each.points[i].mark);
        }
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
    double names = 0.0; // room for them at the right
    for (const frame_series& each : series) {
        names = std::max(names, width_of(each.name));
    }
    const double right = width - std::clamp(names + 16.0, 92.0, 0.4 * width);
    const linear_axis x{0.0, static_cast<double>(frames - 1), 64.0, right};
    const linear_axis y{y_ticks.front(), y_ticks.back(), bottom, 14.0};

    drawing svg(height, y_name + " over frames");
    for (const double tick : x_ticks) {
        if (tick <= x.hi) {
            svg.line(x.at(tick), 14.0, x.at(tick), bottom, "grid");
            svg.tick(x.at(tick), bottom + 16.0, short_number(tick), "middle");
        }
    }
    for (const double tick : y_ticks) {
        svg.line(64.0, y.at(tick), right, y.at(tick), "grid");
        svg.tick(58.0, y.at(tick) + 4.0, short_number(tick), "end");
    }
    svg.line(64.0, bottom, right, bottom, "axis");
    svg.text(0.5 * (64.0 + right), height - 6.0, "frame", "text-anchor=\"middle\"");
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
            svg.name(0.0, x.to, end, each.name, colour_class(each.colour));
        }
    }
    return svg.done();
}

} // namespace lab
