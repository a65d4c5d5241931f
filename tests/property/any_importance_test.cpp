// Whatever importance a functor returns, at every option: the tables that are built from it
// increase strictly from 0 to 1, and the warp of any point is finite.
#include <warpshadow/importance.hpp>
#include <warpshadow/rectilinear.hpp>
#include <warpshadow/second_axis.hpp>
#include <warpshadow/warp.hpp>
#include <warpshadow/warp_build.hpp>

#include <catch2/catch.hpp>
#include <glm/vec2.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

using namespace warpshadow;

namespace {

template <typename T> struct sample {
    glm::vec<2, T> p;
    T importance;
};

std::uint64_t below(std::mt19937_64& random, std::uint64_t count) {
    return random() % count;
}

/// Numbers that no arithmetic is safe from, and ordinary ones.
template <typename T> T any_number(std::mt19937_64& random) {
    using limits = std::numeric_limits<T>;
    const T special[] = {limits::quiet_NaN(),
                         limits::infinity(),
                         -limits::infinity(),
                         limits::max(),
                         limits::lowest(),
                         limits::denorm_min(),
                         T(0),
                         T(-0.0),
                         T(-1),
                         T(1),
                         T(1e9),
                         T(2.5)};
    const std::size_t i = below(random, 2 * std::size(special));
    return i < std::size(special) ? special[i]
                                  : static_cast<T>(random() >> 11) * static_cast<T>(0x1p-53);
}

template <typename T> std::vector<sample<T>> any_samples(std::mt19937_64& random) {
    std::vector<sample<T>> samples(below(random, 80));
    for (sample<T>& s : samples) {
        s.p = {any_number<T>(random), any_number<T>(random)};
        s.importance = any_number<T>(random);
    }
    return samples;
}

template <typename T, typename Node> std::string fault_of(const table_view<T, Node>& table) {
    for (int row = 0; row < table.rows; ++row) {
        if (table_node(table, row, 0) != T(0) || table_node(table, row, table.cells) != T(1)) {
            return "an end of row " + std::to_string(row) + " is not exact";
        }
        for (int k = 0; k < table.cells; ++k) {
            if (!(table_node(table, row, k + 1) > table_node(table, row, k))) {
                return "no increase at node " + std::to_string(k) + " of row " +
                       std::to_string(row);
            }
        }
    }
    return {};
}

template <typename T> std::vector<glm::vec<2, T>> any_points(std::mt19937_64& random) {
    std::vector<glm::vec<2, T>> points;
    for (int i = 0; i < 20; ++i) {
        glm::vec<2, T> p(any_number<T>(random), any_number<T>(random));
        points.emplace_back(std::isfinite(p.x) ? p.x : T(0.5), std::isfinite(p.y) ? p.y : T(0.5));
    }
    return points;
}

template <typename T, typename Node>
void check_points(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                  std::mt19937_64& random) {
    for (const glm::vec<2, T>& p : any_points<T>(random)) {
        const glm::vec<2, T> q = warp(rows, columns, p);
        const glm::vec<2, T> back = unwarp(rows, columns, p);
        REQUIRE((std::isfinite(q.x) && std::isfinite(q.y)));
        REQUIRE((std::isfinite(back.x) && std::isfinite(back.y)));
    }
}

/// All shapes, rules and orders; window, radius, floor and shear of any kind, NaN included.
template <typename T, typename Node> void check_all(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    for (int turn = 0; turn < 60; ++turn) {
        const std::vector<sample<T>> samples = any_samples<T>(random);
        const std::span<const sample<T>> seen(samples);
        const int width = 1 + static_cast<int>(below(random, turn % 8 == 0 ? 300 : 20));
        const int height = 1 + static_cast<int>(below(random, 20));
        const T steps = turn % 3 == 0 ? any_number<T>(random) : T(1000);
        const auto importance = [](const sample<T>& s) { return s.importance; };
        for (const cell_rule rule : {cell_rule::sum, cell_rule::largest}) {
            for (const window_shape shape :
                 {window_shape::box, window_shape::tent, window_shape::gaussian}) {
                build_options<T> options;
                options.shape = shape;
                options.window = any_number<T>(random);
                options.floor = any_number<T>(random);
                options.radius = turn % 2 == 0 ? -1 : static_cast<int>(random());
                options.shear = turn % 4 == 0 ? any_number<T>(random) : options.shear;
                CAPTURE(seed, turn, width, height, static_cast<int>(rule), static_cast<int>(shape),
                        options.window, options.floor, options.radius, options.shear, steps);
                const auto w = static_cast<std::size_t>(width);
                const auto h = static_cast<std::size_t>(height);
                std::vector<std::uint32_t> counts(w * h);
                std::vector<std::uint64_t> scratch(scratch_size(width, options));
                std::vector<Node> row_nodes((w + 1) * h);
                const count_map map{counts, width, height};
                const splat_result first = splat_weighted(seen, importance, steps, rule, map);
                REQUIRE(first.counted + first.rejected == samples.size());
                const table_span<T, Node> rows{row_nodes, width, height};
                REQUIRE(!any(build_axis<T, Node>(map, options, scratch, rows).flags,
                             status::buffer_too_small));
                REQUIRE(fault_of<T, Node>(rows) == "");

                std::vector<std::uint32_t> second_counts(w * h);
                std::vector<Node> column_nodes((w + 1) * h);
                const count_map turned{second_counts, width, height};
                splat_columns_weighted(seen, table_view<T, Node>(rows), importance, steps, rule,
                                       turned);
                const table_span<T, Node> columns{column_nodes, width, height};
                build_axis<T, Node>(turned, options, scratch, columns);
                REQUIRE(fault_of<T, Node>(columns) == "");
                check_points<T, Node>(rows, columns, random);

                rectilinear_options<T> lines;
                lines.collapse = rule;
                lines.shape = shape;
                lines.width = any_number<T>(random);
                lines.floor = options.floor;
                std::vector<std::uint64_t> line_scratch(rectilinear_scratch(width, height));
                std::vector<Node> u_nodes(w + 1);
                std::vector<Node> v_nodes(h + 1);
                const table_span<T, Node> u{u_nodes, width, 1};
                const table_span<T, Node> v{v_nodes, height, 1};
                build_rectilinear<T, Node>(map, lines, line_scratch, u, v);
                REQUIRE(fault_of<T, Node>(u) == "");
                REQUIRE(fault_of<T, Node>(v) == "");
                check_points<T, Node>(u, v, random);
            }
        }
    }
}

} // namespace

TEST_CASE("peers 23 to 27: any importance at any options: increasing, exact ends, finite") {
    // another seed: --rng-seed
    const std::uint64_t seed = Catch::rngSeed() + 1;
    SECTION("float") {
        check_all<float, float>(seed);
    }
    SECTION("16 bits") {
        check_all<float, std::uint16_t>(seed);
    }
    SECTION("double") {
        check_all<double, double>(seed);
    }
}
