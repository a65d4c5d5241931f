#include "lab/warp_arguments.hpp"

#include "lab/numbers.hpp"
#include "lab/scene.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string_view>

namespace lab {

namespace ws = warpshadow;

namespace {

constexpr int largest_table = 4096;

/// A number in a range, or a line that names the option and the range.
float number_in(const std::string& text, const char* option, float least, float largest) {
    const std::optional<float> value = lab::number_in(std::string_view(text), least, largest);
    if (!value) {
        char range[64];
        std::snprintf(range, sizeof range, "%g to %g", static_cast<double>(least),
                      static_cast<double>(largest));
        throw bad_input(std::string(option) + " wants a number, " + range + ", not '" + text + "'");
    }
    return *value;
}

int whole_in(const std::string& text, const char* option, int least, int largest) {
    const std::optional<int> value = lab::number_in(std::string_view(text), least, largest);
    if (!value) {
        throw bad_input(std::string(option) + " wants a whole number, " + std::to_string(least) +
                        " to " + std::to_string(largest) + ", not '" + text + "'");
    }
    return *value;
}

ws::cell_rule rule_of(const std::string& text, const char* option) {
    if (text == "sum") {
        return ws::cell_rule::sum;
    }
    if (text == "max") {
        return ws::cell_rule::largest;
    }
    throw bad_input(std::string(option) + " wants sum or max, not '" + text + "'");
}

ws::window_shape shape_of(const std::string& text) {
    if (text == "box") {
        return ws::window_shape::box;
    }
    if (text == "tent") {
        return ws::window_shape::tent;
    }
    if (text == "gaussian") {
        return ws::window_shape::gaussian;
    }
    throw bad_input("--smooth wants box, tent or gaussian, not '" + text + "'");
}

/// The functions that are named; those that are not are off.
void take_importance(const std::vector<std::string>& given, warp_wishes& wishes) {
    wishes.distance = wishes.edge = wishes.normal = wishes.add = false;
    for (const std::string& each : given) {
        std::size_t begin = 0;
        while (begin <= each.size()) {
            const std::size_t end = std::min(each.find(',', begin), each.size());
            const std::string_view name = std::string_view(each).substr(begin, end - begin);
            begin = end + 1;
            if (name == "distance") {
                wishes.distance = true;
            } else if (name == "edges" || name == "ends") {
                const edge_kind kind =
                    name == "ends" ? edge_kind::shadow_end : edge_kind::discontinuity;
                if (wishes.edges.value_or(kind) != kind) {
                    throw bad_input("--importance takes either edges or ends, not both");
                }
                wishes.edge = true;
                wishes.edges = kind;
            } else if (name == "normal") {
                wishes.normal = true;
            } else if (name == "sum") {
                wishes.add = true;
            } else if (name != "desired-view" && name != "product") {
                throw bad_input("--importance wants desired-view, distance, edges or ends, normal, "
                                "and sum or product, not '" +
                                std::string(name) + "'");
            }
        }
    }
}

} // namespace

void add_warp_arguments(CLI::App& app, warp_arguments& given) {
    const auto add = [&](const char* name, auto& to, const char* about) {
        app.add_option(name, to, about)->group(table_group);
    };
    app.add_option("--importance", given.importance,
                   "Importance functions, comma-separated: desired-view (always), distance, edges "
                   "of the light's depths (rtw-forward, rtw-hybrid and notw-hybrid) or ends of "
                   "shadows (the latter two), normal; product or sum of them (each method's own, "
                   "see below)")
        ->allow_extra_args(false)
        ->group(table_group);
    add("--tables", given.tables,
        "Most cells of a table along a side, no more than the map has texels (128)");
    add("--tables-format", given.format,
        "How tables are stored: r32f, or unorm16 in half the memory (r32f)");
    add("--window", given.window, "Smoothing across functions, as a share of their number, 0 to 2");
    add("--smooth", given.smooth,
        "Weights of that window: box, tent (a box twice) or gaussian (three times), the latter two "
        "and three times as wide (box)");
    add("--floor", given.floor, "Least density of texels, as a share of the mean, 0 to 1");
    add("--shear", given.shear,
        "Limit of what a function changes from row to row, as a multiple of its slope, 0 or more; "
        "notw is mixed with its mean functions until it keeps it (none)");
    add("--order", given.order, "Axis that is warped first: u or v (u)");
    app.add_flag(
           "--align", given.align,
           "Turn the map of a sun or a spot to the principal axis of its importance (not after "
           "another warp)")
        ->group(table_group);
    add("--power", given.power,
        "Power of the importance of a row's window, or of a line, above 0 to 2");
    add("--subset", given.subset,
        "Count one view sample of each block of so many by so many pixels (1)");
    add("--cells", given.cells, "What a cell makes of several samples: sum or max");
    add("--collapse", given.collapse, "What a line of rtw makes of its cells: sum or max");
    add("--sigma", given.sigma,
        "Standard deviation of rtw's Gaussian, as a share of the map, 0 to 1");
    add("--edge-share", given.edge_share,
        "What a sample counts in notw-edges away from the ends of shadows, 0 or more");
}

warp_wishes warp_wishes_of(const warp_arguments& given) {
    warp_wishes wishes;
    if (!given.importance.empty()) {
        take_importance(given.importance, wishes);
    }
    const auto number = [](std::optional<float>& target, const std::string& text,
                           const char* option, float least, float largest) {
        if (!text.empty()) {
            target = number_in(text, option, least, largest);
        }
    };
    number(wishes.window, given.window, "--window", 0.0f, 2.0f);
    number(wishes.floor, given.floor, "--floor", 0.0f, 1.0f);
    number(wishes.shear, given.shear, "--shear", 0.0f, 1000.0f);
    number(wishes.power, given.power, "--power", 0.001f, 2.0f);
    number(wishes.width, given.sigma, "--sigma", 0.0f, 1.0f);
    number(wishes.share, given.edge_share, "--edge-share", 0.0f, 1000.0f);
    if (given.align) {
        wishes.align = true;
    }
    if (!given.tables.empty()) {
        wishes.tables = whole_in(given.tables, "--tables", 1, largest_table);
    }
    if (!given.subset.empty()) {
        wishes.every = whole_in(given.subset, "--subset", 1, 64);
    }
    if (!given.cells.empty()) {
        wishes.cells = rule_of(given.cells, "--cells");
    }
    if (!given.collapse.empty()) {
        wishes.collapse = rule_of(given.collapse, "--collapse");
    }
    if (!given.smooth.empty()) {
        wishes.shape = shape_of(given.smooth);
    }
    if (!given.format.empty()) {
        if (given.format != "r32f" && given.format != "unorm16") {
            throw bad_input("--tables-format wants r32f or unorm16, not '" + given.format + "'");
        }
        wishes.format = given.format == "unorm16" ? table_format::unorm16 : table_format::r32f;
    }
    if (!given.order.empty()) {
        if (given.order != "u" && given.order != "v") {
            throw bad_input("--order wants u or v, not '" + given.order + "'");
        }
        wishes.v_first = given.order == "v";
    }
    return wishes;
}

} // namespace lab
