// How warp tables are made: importance, collapse, smoothing, size.
#pragma once

#include <warpshadow/build_options.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/importance_functions.hpp>
#include <warpshadow/rectilinear.hpp>

#include <optional>

namespace lab {

/// From where importance is judged (Rosen 2012, §4.1).
enum class analysis {
    backward, ///< the view samples
    forward,  ///< the texels of a depth image of the light
    hybrid    ///< the view samples, with the shadow edges of the light's depth image
};

/// What an edge is to hybrid analysis.
enum class edge_kind {
    discontinuity, ///< of the depths in the light's image, as published
    shadow_end     ///< nine shadow tests in that image disagree; for either axis by itself
};

/// Which shadows count more at their ends, besides the importance functions.
enum class known_shadows {
    none,       ///< no shadow is known yet
    last_frame, ///< what the last frame showed, where its camera saw the same place
    truth       ///< the ray tracer's: the bound of what knowing them can give
};

/// How the nodes of tables are stored on the device.
enum class table_format {
    r32f,   ///< float
    unorm16 ///< [0, 1] in steps of 1/65535
};

/// How the tables of one method are made.
struct warp_options {
    analysis from = analysis::backward;
    warpshadow::importance_options<float> functions =
        {}; ///< but for near and far, which are the camera's
    warpshadow::cell_rule cells = warpshadow::cell_rule::sum; ///< several samples in a cell
    edge_kind edges = edge_kind::discontinuity;
    known_shadows shadows = known_shadows::none;
    float share = 1.0f; ///< with known shadows: what a sample counts away from their ends
    float power = 1.0f; ///< of what a window counts, or a line: below 1, less goes to the most seen
    bool rectilinear = false;
    warpshadow::cell_rule collapse = warpshadow::cell_rule::sum; ///< of rectilinear tables
    float width = 0.0f; ///< of their Gaussian, standard deviation as a share of the cells
    warpshadow::build_options<float> build = {};
    int tables = 128; ///< most cells along a side; no more than the map has texels
    table_format format = table_format::r32f;
    int every = 1;      ///< one view sample of each block of so many squared counts
    bool align = false; ///< the map is turned to the principal axis of its importance
};

/// What the command line says about all methods with tables.
struct warp_wishes {
    std::optional<bool> distance, edge, normal, add;
    std::optional<edge_kind> edges;
    std::optional<warpshadow::cell_rule> cells, collapse;
    std::optional<float> window, floor, width, share, power, shear;
    std::optional<warpshadow::window_shape> shape;
    std::optional<bool> v_first, align;
    std::optional<int> tables, every;
    std::optional<table_format> format;

    /// The options of a method with these in their place.
    [[nodiscard]] warp_options over(warp_options options) const {
        const auto take = [](auto& target, const auto& wish) { target = wish.value_or(target); };
        take(options.functions.distance, distance);
        take(options.functions.edge, edge);
        take(options.functions.normal, normal);
        take(options.edges, edges);
        take(options.functions.add, add);
        take(options.cells, cells);
        take(options.collapse, collapse);
        take(options.build.window, window);
        take(options.build.floor, floor);
        take(options.build.shear, shear);
        take(options.build.shape, shape);
        take(options.build.v_first, v_first);
        take(options.width, width);
        take(options.share, share);
        take(options.power, power);
        take(options.tables, tables);
        take(options.every, every);
        take(options.format, format);
        take(options.align, align);
        return options;
    }
};

} // namespace lab
