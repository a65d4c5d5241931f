// Speed of building and evaluating warp tables on the CPU, beside a plain copy of the map, a plain
// bilinear look-up and a bisection of the same run.
//
// Run with --benchmark_enable_random_interleaving=true --benchmark_repetitions=7 and compare the
// medians within one run.
#include "warp_inputs.hpp"

#include <warpshadow/unwarp_guide.hpp>
#include <warpshadow/warp.hpp>
#include <warpshadow/warp_build.hpp>
#include <warpshadow/warp_points.hpp>

#include <benchmark/benchmark.h>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace ws = warpshadow;

namespace {

// Inputs -----------------------------------------------------------------------------------------

const std::vector<std::uint32_t>& counts_of(int size) {
    static std::map<int, std::vector<std::uint32_t>> made;
    std::vector<std::uint32_t>& counts = made[size];
    if (counts.empty()) {
        counts = warp_inputs::view_counts(size);
    }
    return counts;
}

ws::count_view view_of(int size) {
    return {counts_of(size), size, size};
}

/// Both tables of a warp.
struct built {
    explicit built(int size) : rows(nodes_of(size)), columns(nodes_of(size)), cells(size) {
        build(view_of(size), rows);
        // the second axis of a transposed view: as uneven as a real one
        const std::vector<std::uint32_t> turned = warp_inputs::turned(counts_of(size), size);
        build({turned, size, size}, columns);
        row_cells.resize(ws::guide_size(size, size));
        column_cells.resize(row_cells.size());
        ws::build_guide(row_table(), {row_cells, size, size});
        ws::build_guide(column_table(), {column_cells, size, size});
    }
    static std::vector<float> nodes_of(int size) {
        return std::vector<float>(static_cast<std::size_t>(size) *
                                  (static_cast<std::size_t>(size) + 1));
    }
    static void build(const ws::count_view& counts, std::vector<float>& nodes) {
        const ws::build_options<float> options;
        std::vector<std::uint64_t> scratch(ws::scratch_size(counts.width, options));
        ws::build_axis<float, float>(counts, options, scratch,
                                     {nodes, counts.width, counts.height});
    }
    [[nodiscard]] ws::table_view<float> row_table() const { return {rows, cells, cells}; }
    [[nodiscard]] ws::table_view<float> column_table() const { return {columns, cells, cells}; }
    [[nodiscard]] ws::guide_view row_guide() const { return {row_cells, cells, cells}; }
    [[nodiscard]] ws::guide_view column_guide() const { return {column_cells, cells, cells}; }

    std::vector<float> rows;
    std::vector<float> columns;
    std::vector<std::uint16_t> row_cells;
    std::vector<std::uint16_t> column_cells;
    int cells;
};

const built& tables_of(int size) {
    static std::map<int, built> made;
    return made.try_emplace(size, size).first->second;
}

enum class order { coherent, random };

constexpr std::size_t point_count = std::size_t(1) << 18;

/// Points of the map: those of a surface in the order of its pixels, or anywhere.
const std::vector<glm::vec2>& points_of(order kind) {
    static std::map<order, std::vector<glm::vec2>> made;
    std::vector<glm::vec2>& points = made[kind];
    if (points.empty()) {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> unit(0.0f, 1.0f);
        for (std::size_t i = 0; i < point_count; ++i) {
            if (kind == order::random) {
                const float u = unit(random);
                points.emplace_back(u, unit(random));
            } else {
                const float x = static_cast<float>(i % 512) / 512.0f;
                const float y = static_cast<float>(i / 512) / 512.0f;
                const float depth = 0.05f / (0.05f + 0.95f * y);
                points.emplace_back(0.5f + (x - 0.5f) * (0.1f + 0.9f * depth), depth);
            }
        }
    }
    return points;
}

// Building ---------------------------------------------------------------------------------------

/// What no build can be faster than: every count read, and a float written for it.
void copy_map(benchmark::State& state) {
    const auto size = static_cast<int>(state.range(0));
    const std::vector<std::uint32_t>& counts = counts_of(size);
    std::vector<float> to(counts.size());
    for (auto _ : state) {
        // signed, which SSE2 has an instruction for, and vectors, which -O2 does not find
        typedef std::int32_t whole __attribute__((vector_size(32)));
        typedef float real __attribute__((vector_size(32)));
        for (std::size_t i = 0; i < counts.size(); i += 8) {
            whole from;
            std::memcpy(&from, counts.data() + i, sizeof from);
            const real converted = __builtin_convertvector(from, real);
            std::memcpy(to.data() + i, &converted, sizeof converted);
        }
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(counts.size()));
}

void build_map(benchmark::State& state, ws::build_options<float> options) {
    const auto size = static_cast<int>(state.range(0));
    const ws::count_view counts = view_of(size);
    std::vector<std::uint64_t> scratch(ws::scratch_size(size, options));
    std::vector<float> nodes = built::nodes_of(size);
    const ws::table_span<float> out{nodes, size, size};
    for (auto _ : state) {
        benchmark::DoNotOptimize(ws::build_axis<float, float>(counts, options, scratch, out));
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * size * size);
}

/// The published way.
void build_plain(benchmark::State& state, int radius) {
    const auto size = static_cast<int>(state.range(0));
    const std::vector<std::uint32_t>& counts = counts_of(size);
    warp_inputs::plain_builder builder(size);
    std::vector<float> nodes = built::nodes_of(size);
    for (auto _ : state) {
        builder.build(counts, radius, 0.3f, nodes);
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * size * size);
}

ws::build_options<float> with_radius(int radius) {
    ws::build_options<float> options;
    options.radius = radius;
    return options;
}

// Evaluation -------------------------------------------------------------------------------------

/// The node of a table as a texture unit would read it: the plain way.
float bilinear(const std::vector<float>& nodes, int cells, float x, float across) {
    const float row =
        std::clamp(across * static_cast<float>(cells) - 0.5f, 0.0f, static_cast<float>(cells - 1));
    const float column = std::clamp(x * static_cast<float>(cells), 0.0f, static_cast<float>(cells));
    const int j0 = static_cast<int>(std::floor(row));
    const int i0 = std::min(static_cast<int>(std::floor(column)), cells - 1);
    const int j1 = std::min(j0 + 1, cells - 1);
    const float s = row - static_cast<float>(j0);
    const float t = column - static_cast<float>(i0);
    const auto at = [&](int i, int j) {
        return nodes[static_cast<std::size_t>(j) * (static_cast<std::size_t>(cells) + 1) +
                     static_cast<std::size_t>(i)];
    };
    return glm::mix(glm::mix(at(i0, j0), at(i0 + 1, j0), t),
                    glm::mix(at(i0, j1), at(i0 + 1, j1), t), s);
}

glm::vec2 bilinear_warp(const built& tables, glm::vec2 p) {
    const float u = bilinear(tables.rows, tables.cells, p.x, p.y);
    return {u, bilinear(tables.columns, tables.cells, p.y, u)};
}

template <typename Each> void each_point(benchmark::State& state, order kind, Each each) {
    const built& tables = tables_of(static_cast<int>(state.range(0)));
    const std::vector<glm::vec2>& points = points_of(kind);
    std::vector<glm::vec2> to(points.size());
    for (auto _ : state) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            to[i] = each(tables, points[i]);
        }
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

void warp_bilinear(benchmark::State& state, order kind) {
    each_point(state, kind, bilinear_warp);
}

void warp_each(benchmark::State& state, order kind) {
    each_point(state, kind, [](const built& t, glm::vec2 p) {
        return ws::warp(t.row_table(), t.column_table(), p);
    });
}

void unwarp_each(benchmark::State& state, order kind) {
    each_point(state, kind, [](const built& t, glm::vec2 p) {
        return ws::unwarp(t.row_table(), t.column_table(), p);
    });
}

template <typename Batch> void all_points(benchmark::State& state, order kind, Batch batch) {
    const built& tables = tables_of(static_cast<int>(state.range(0)));
    const std::vector<glm::vec2>& points = points_of(kind);
    std::vector<glm::vec2> to(points.size());
    for (auto _ : state) {
        batch(tables, std::span<const glm::vec2>(points), std::span<glm::vec2>(to));
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

void warp_batch(benchmark::State& state, order kind) {
    all_points(state, kind, [](const built& t, auto from, auto to) {
        ws::warp_points(t.row_table(), t.column_table(), from, to);
    });
}

void unwarp_batch(benchmark::State& state, order kind) {
    all_points(state, kind, [](const built& t, auto from, auto to) {
        ws::unwarp_points(t.row_table(), t.column_table(), t.row_guide(), t.column_guide(), from,
                          to);
    });
}

void build_guides(benchmark::State& state) {
    const auto size = static_cast<int>(state.range(0));
    const built& tables = tables_of(size);
    std::vector<std::uint16_t> cells(ws::guide_size(size, size));
    for (auto _ : state) {
        benchmark::DoNotOptimize(ws::build_guide(tables.row_table(), {cells, size, size}));
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * size * size);
}

void register_all() {
    const auto sized = [](benchmark::internal::Benchmark* b) {
        b->Arg(512)->Arg(1024)->Arg(2048)->Unit(benchmark::kMicrosecond);
    };
    sized(benchmark::RegisterBenchmark("copy", copy_map));
    sized(benchmark::RegisterBenchmark("build/window", build_map, ws::build_options<float>{}));
    sized(benchmark::RegisterBenchmark("build/radius20", build_map, with_radius(20)));
    sized(benchmark::RegisterBenchmark("build/plain20", build_plain, 20));
    sized(benchmark::RegisterBenchmark("guide", build_guides));
    for (const order kind : {order::coherent, order::random}) {
        const std::string name = kind == order::coherent ? "coherent" : "random";
        const auto one = [&](const std::string& what, auto work) {
            benchmark::RegisterBenchmark((what + "/" + name).c_str(), work, kind)
                ->Arg(512)
                ->Arg(1024)
                ->Unit(benchmark::kMicrosecond);
        };
        one("warp/bilinear", warp_bilinear);
        one("warp/each", warp_each);
        one("warp/points", warp_batch);
        one("unwarp/bisection", unwarp_each);
        one("unwarp/points", unwarp_batch);
    }
}

} // namespace

int main(int argc, char** argv) {
    register_all();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return 1;
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
