// Properties of warpshadow/bend_table.hpp and tessellation.hpp: no warped edge and no triangle
// departs from straight lines by more than the bound, and cutting by the rules keeps what was asked
// for.
//
// The oracle evaluates the stored nodes in long double, piece by piece, and shares no code with the
// library. `slack` is what the rounding of D may take from the bound: a second difference is one of
// two first differences, each rounded by u / 2 of a number up to 1, so eight times u in D at most
// for the factors met here, and u (n² + 1) in D f(n); the sums and products that follow are a few u
// of the result, and ends and points of an edge are rounded by u each.
#include "warp_oracle.hpp"

#include <warpshadow/bend_table.hpp>
#include <warpshadow/tessellation.hpp>
#include <warpshadow/warp_build.hpp>

#include <catch2/catch.hpp>
#include <glm/vec2.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

using real = long double;
struct real2 {
    real x, y;
};

template <typename T> struct owned_table {
    int cells;
    int rows;
    std::vector<T> nodes;

    owned_table(int c, int r)
        : cells(c), rows(r),
          nodes((static_cast<std::size_t>(c) + 1) * static_cast<std::size_t>(r)) {}
    T& at(int row, int k) {
        return nodes[static_cast<std::size_t>(row) * (static_cast<std::size_t>(cells) + 1) +
                     static_cast<std::size_t>(k)];
    }
    [[nodiscard]] real node(int row, int k) const {
        return static_cast<real>(
            nodes[static_cast<std::size_t>(row) * (static_cast<std::size_t>(cells) + 1) +
                  static_cast<std::size_t>(k)]);
    }
    [[nodiscard]] table_view<T> view() const { return {nodes, cells, rows}; }

    [[nodiscard]] real value(real across, real x) const {
        const real place = std::clamp<real>(across * rows - real(0.5), 0, rows - 1);
        const int row = std::min(static_cast<int>(place), std::max(rows - 2, 0));
        const int next = std::min(row + 1, rows - 1);
        const real weight = place - row;
        const int k = std::clamp(static_cast<int>(x * cells), 0, cells - 1);
        const real share = x * cells - k;
        const real low = node(row, k) + share * (node(row, k + 1) - node(row, k));
        const real high = node(next, k) + share * (node(next, k + 1) - node(next, k));
        return low + weight * (high - low);
    }
};

template <typename T> struct warp_tables {
    owned_table<T> rows, columns;
    std::vector<T> memory;
    table_view<T> bends;

    warp_tables(int c0, int r0, int c1, int r1) : rows(c0, r0), columns(c1, r1) {}

    [[nodiscard]] real2 warped(real2 p) const {
        const real u = rows.value(p.y, p.x);
        return {u, columns.value(u, p.y)};
    }
    void build(int blocks) {
        memory.assign(bend_nodes(blocks), std::numeric_limits<T>::quiet_NaN());
        // the last row has one number and the unit; nothing else is left unset that is read
        REQUIRE(build_bends(rows.view(), columns.view(), blocks, std::span<T>(memory), bends) ==
                status::ok);
    }
};

/// Functions of one axis: of the identity, smooth, with few large kinks, or random.
template <typename T> void fill(owned_table<T>& table, dice& d) {
    const int kind = d.between(0, 4);
    if (kind == 4) { // as built from counts
        const owned_counts counts = any_counts(d, table.cells, table.rows);
        build_options<double> options;
        options.window = d.between(0.02, 1.0);
        options.floor = d.between(0.05, 0.5);
        std::vector<double> nodes(table.nodes.size());
        std::vector<std::uint64_t> sums(static_cast<std::size_t>(table.cells));
        for (int row = 0; row < table.rows; ++row) {
            const int radius = window_radius(options.window, table.rows);
            double total = 0.0;
            std::vector<double> before{0.0};
            for (int k = 0; k < table.cells; ++k) {
                for (int i = std::max(row - radius, 0); i <= std::min(row + radius, table.rows - 1);
                     ++i) {
                    total += counts.at(k, i);
                }
                before.push_back(total);
            }
            for (int k = 0; k <= table.cells; ++k) {
                const double x = static_cast<double>(k) / table.cells;
                const double f = total > 0.0 ? before[static_cast<std::size_t>(k)] / total : x;
                table.at(row, k) = static_cast<T>(x + (1.0 - options.floor) * (f - x));
            }
        }
        return;
    }
    const double centre = d.between(0.0, 1.0);
    const double drift = d.between(-1.0, 1.0);
    const double width = d.between(0.02, 0.5);
    const double floor = d.between(0.02, 0.8);
    for (int row = 0; row < table.rows; ++row) {
        std::vector<double> sum{0.0};
        for (int k = 0; k < table.cells; ++k) {
            const double x = (k + 0.5) / table.cells;
            const double c = centre + drift * (row + 0.5) / table.rows;
            double density = 1.0;
            if (kind == 1) {
                density = floor + std::exp(-(x - c) * (x - c) / (width * width));
            } else if (kind == 2) {
                density = std::abs(x - c) < width ? 1.0 : floor;
            } else if (kind == 3) {
                density = floor + d.unit();
            }
            sum.push_back(sum.back() + density);
        }
        for (int k = 0; k <= table.cells; ++k) {
            table.at(row, k) = static_cast<T>(sum[static_cast<std::size_t>(k)] / sum.back());
        }
        table.at(row, table.cells) = T(1);
    }
}

template <typename T> warp_tables<T> any_tables(dice& d) {
    const bool same = d.coin();
    const int c0 = d.between(1, 96), r0 = same ? c0 : d.between(1, 96);
    const int c1 = same ? c0 : d.between(1, 96), r1 = same ? c0 : d.between(1, 96);
    warp_tables<T> tables(c0, r0, c1, r1);
    fill(tables.rows, d);
    fill(tables.columns, d);
    tables.build(2 << d.between(0, 5));
    return tables;
}

template <typename T> glm::vec<2, T> any_point(dice& d) {
    return {static_cast<T>(d.unit()), static_cast<T>(d.unit())};
}

template <typename T>
real distance_at(const warp_tables<T>& t, const std::array<real2, 3>& corner,
                 const std::array<real, 3>& share) {
    real2 flat{0, 0}, p{0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        const real2 q = t.warped(corner[i]);
        flat.x += share[i] * q.x;
        flat.y += share[i] * q.y;
        p.x += share[i] * corner[i].x;
        p.y += share[i] * corner[i].y;
    }
    const real2 exact = t.warped(p);
    return std::hypot(exact.x - flat.x, exact.y - flat.y);
}

template <typename T> real wide(T x) {
    return static_cast<real>(x);
}

template <typename T> real2 wide(glm::vec<2, T> p) {
    return {static_cast<real>(p.x), static_cast<real>(p.y)};
}

/// Largest deviation found along an edge, at equal steps and at kinks.
template <typename T>
real edge_error(const warp_tables<T>& t, glm::vec<2, T> a, glm::vec<2, T> b, int steps) {
    real most = 0;
    const std::array<real2, 3> corner{wide(a), wide(b), wide(a)};
    const auto try_at = [&](real s) {
        if (s > 0 && s < 1) {
            most = std::max(most, distance_at(t, corner, {1 - s, s, 0}));
        }
    };
    for (int i = 1; i < steps; ++i) {
        try_at(static_cast<real>(i) / steps);
    }
    const real dx = corner[1].x - corner[0].x;
    const real dy = corner[1].y - corner[0].y;
    for (int k = 1; k < t.rows.cells && dx != 0; ++k) {
        try_at((static_cast<real>(k) / t.rows.cells - corner[0].x) / dx);
    }
    for (int k = 0; k < t.rows.rows && dy != 0; ++k) {
        try_at(((k + real(0.5)) / t.rows.rows - corner[0].y) / dy);
    }
    for (int k = 1; k < t.columns.cells && dy != 0; ++k) {
        try_at((static_cast<real>(k) / t.columns.cells - corner[0].y) / dy);
    }
    return most;
}

template <typename T>
real triangle_error(const warp_tables<T>& t, const std::array<glm::vec<2, T>, 3>& p, dice& d,
                    int tries) {
    const std::array<real2, 3> corner{wide(p[0]), wide(p[1]), wide(p[2])};
    real most = 0;
    for (int i = 0; i < tries; ++i) {
        real a = wide(d.unit()), b = wide(d.unit());
        if (a + b > 1) {
            a = 1 - a;
            b = 1 - b;
        }
        most = std::max(most, distance_at(t, corner, {a, b, 1 - a - b}));
    }
    return most;
}

/// Rounding that a bound for n cells may lack; see the head of this file.
template <typename T> real slack(T n, T bound) {
    const real u = wide(roundoff<T>());
    return u * (static_cast<real>(n) * static_cast<real>(n) + 1) +
           32 * u * (1 + static_cast<real>(bound));
}

/// Cuts a triangle by `edge_needs_cut`, as the shadow pass does; collects the pieces.
template <typename T>
void cut(const warp_tables<T>& t, const std::array<glm::vec<2, T>, 3>& whole, T allowed,
         std::vector<std::array<glm::vec<2, T>, 3>>& pieces, int depth = 0) {
    REQUIRE(depth < 64);
    int longest = -1;
    T most = T(0);
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec<2, T> a = whole[i], b = whole[(i + 1) % 3];
        if (edge_needs_cut(t.bends, a, b, allowed) && bend_length(a, b) > most) {
            most = bend_length(a, b);
            longest = static_cast<int>(i);
        }
    }
    if (longest < 0) {
        pieces.push_back(whole);
        return;
    }
    const auto i = static_cast<std::size_t>(longest);
    const glm::vec<2, T> a = whole[i], b = whole[(i + 1) % 3], c = whole[(i + 2) % 3];
    const glm::vec<2, T> middle = (a + b) * T(0.5);
    cut(t, {a, middle, c}, allowed, pieces, depth + 1);
    cut(t, {middle, b, c}, allowed, pieces, depth + 1);
}

} // namespace

TEMPLATE_TEST_CASE("no edge and no triangle departs by more than the bound", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const warp_tables<T> t = any_tables<T>(d);
        for (int i = 0; i < 6; ++i) {
            const glm::vec<2, T> a = any_point<T>(d);
            // edges of all lengths: the bound is one only up to bend_margin
            const T scale = static_cast<T>(std::exp2(-d.between(0.0, 12.0)));
            const auto nearby = [&] {
                return glm::clamp(a + scale * (any_point<T>(d) - any_point<T>(d)), T(0), T(1));
            };
            glm::vec<2, T> b = nearby();
            if (d.between(0, 3) == 0) {
                (d.coin() ? b.x : b.y) = d.coin() ? a.x : a.y;
                b = glm::clamp(b, T(0), T(1));
            }
            const T bound = edge_deviation(t.bends, a, b);
            RC_ASSERT(bound == edge_deviation(t.bends, b, a));
            RC_ASSERT(bound >= T(0));
            const T n = bend_length(a, b) * bend_cells_per_map(t.bends);
            if (bound <= bend_margin<T>) {
                RC_ASSERT(edge_error(t, a, b, 9) <= wide(bound) + slack(n, bound));
            }
            std::array<glm::vec<2, T>, 3> triangle{a, b, nearby()};
            T most = T(0), longest = T(0);
            for (std::size_t k = 0; k < 3; ++k) {
                const T length = bend_length(triangle[k], triangle[(k + 1) % 3]);
                if (length >= longest) {
                    longest = length;
                    most = edge_deviation(t.bends, triangle[k], triangle[(k + 1) % 3]);
                }
            }
            if (most <= bend_margin<T>) {
                RC_ASSERT(triangle_error(t, triangle, d, 20) <=
                          wide(most) + slack(longest * bend_cells_per_map(t.bends), most));
            }
        }
    }));
}

TEMPLATE_TEST_CASE("pieces of an edge and of a triangle keep what was asked for", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const warp_tables<T> t = any_tables<T>(d);
        const T allowed = static_cast<T>(std::exp2(-d.between(7.0, 11.0)));
        const glm::vec<2, T> a = any_point<T>(d), b = any_point<T>(d);
        const int n = edge_segments(t.bends, a, b, allowed, 4096);
        RC_ASSERT(n == edge_segments(t.bends, b, a, allowed, 4096));
        RC_ASSERT(n >= 1 && n <= 4096);
        const T left = split_deviation(t.bends, a, b, n);
        if (n < 4096) {
            // a division, a root and a rounding up: a few u
            RC_ASSERT(left <= allowed * (T(1) + T(16) * std::numeric_limits<T>::epsilon()));
            for (int k = 0; k < std::min(n, 24); ++k) {
                const auto at = [&](int i) { return a + (b - a) * (T(i) / T(n)); };
                const T cells = bend_length(at(k), at(k + 1)) * bend_cells_per_map(t.bends);
                RC_ASSERT(edge_error(t, at(k), at(k + 1), 5) <=
                          wide(allowed) + slack(cells, allowed));
            }
        }
        const glm::vec<2, T> c =
            glm::clamp(a + T(0.1) * (any_point<T>(d) - any_point<T>(d)), T(0), T(1));
        const glm::vec<2, T> e =
            glm::clamp(a + T(0.1) * (any_point<T>(d) - any_point<T>(d)), T(0), T(1));
        int most = 0;
        for (const auto& [from, to] : {std::pair{a, c}, std::pair{c, e}, std::pair{e, a}}) {
            most = std::max(most, edge_segments(t.bends, from, to, allowed, 4096));
        }
        if (most > 24) {
            return; // thousands of pieces say no more than hundreds
        }
        std::vector<std::array<glm::vec<2, T>, 3>> pieces;
        cut(t, {a, c, e}, allowed, pieces);
        real area = 0;
        const auto area_of = [](const std::array<glm::vec<2, T>, 3>& p) {
            return ((wide(p[1].x) - wide(p[0].x)) * (wide(p[2].y) - wide(p[0].y)) -
                    (wide(p[1].y) - wide(p[0].y)) * (wide(p[2].x) - wide(p[0].x))) /
                   2;
        };
        for (const auto& piece : pieces) {
            area += area_of(piece);
            T longest = T(0);
            for (std::size_t k = 0; k < 3; ++k) {
                longest = std::max(longest, bend_length(piece[k], piece[(k + 1) % 3]));
            }
            RC_ASSERT(triangle_error(t, piece, d, 3) <=
                      wide(allowed) + slack(longest * bend_cells_per_map(t.bends), allowed));
        }
        // middles are rounded by u; each piece's area by u times its size
        RC_ASSERT(std::abs(area - area_of({a, c, e})) <=
                  4 * wide(roundoff<T>()) * static_cast<real>(pieces.size() + 1));
    }));
}

TEMPLATE_TEST_CASE("the measured deviation is met, symmetric and below the bound", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const warp_tables<T> t = any_tables<T>(d);
        const table_view<T> rows = t.rows.view(), columns = t.columns.view();
        for (int i = 0; i < 8; ++i) {
            const glm::vec<2, T> a = any_point<T>(d);
            const T scale = static_cast<T>(std::exp2(-d.between(0.0, 10.0)));
            const glm::vec<2, T> b =
                glm::clamp(a + scale * (any_point<T>(d) - any_point<T>(d)), T(0), T(1));
            const T found = measured_deviation(rows, columns, a, b, T(1));
            RC_ASSERT(found == measured_deviation(rows, columns, b, a, T(1)));
            // a search that may stop early finds no more
            RC_ASSERT(measured_deviation(rows, columns, a, b, T(0)) <= found);
            // points tried are multiples of 1/16; warped points are off by what warp_test derives:
            // 9u per axis and the steps between rows and nodes, all below 1 here
            const real u = wide(roundoff<T>());
            const real rounding = u * (64 + 8 * (t.rows.rows + t.columns.rows + t.rows.cells));
            const std::array<real2, 3> corner{wide(a), wide(b), wide(a)};
            real most = 0;
            for (int k = 1; k < 16; ++k) {
                const real share = static_cast<real>(k) / 16;
                most = std::max(most, distance_at(t, corner, {1 - share, share, 0}));
            }
            // the second axis multiplies errors of the first by its shear, up to the row count
            RC_ASSERT(wide(found) <= most + rounding * (1 + t.columns.rows));
            const T bound = edge_deviation(t.bends, a, b);
            const T n = bend_length(a, b) * bend_cells_per_map(t.bends);
            if (bound <= bend_margin<T>) {
                RC_ASSERT(wide(found) <=
                          wide(bound) + slack(n, bound) + rounding * (1 + t.columns.rows));
            }
            const T allowed = static_cast<T>(std::exp2(-d.between(7.0, 11.0)));
            const bool departs = edge_departs(rows, columns, t.bends, a, b, allowed);
            RC_ASSERT(departs == (edge_needs_cut(t.bends, a, b, allowed) &&
                                  measured_deviation(rows, columns, a, b, allowed) > allowed));
        }
    }));
}

TEMPLATE_TEST_CASE("J45: linear tables are never cut", "", float, double) {
    using T = TestType;
    warp_tables<T> t(64, 64, 64, 64);
    for (owned_table<T>* table : {&t.rows, &t.columns}) {
        for (int row = 0; row < 64; ++row) {
            for (int k = 0; k <= 64; ++k) {
                table->at(row, k) = T(k) / T(64);
            }
        }
    }
    t.build(32);
    CHECK(edge_deviation(t.bends, glm::vec<2, T>(0), glm::vec<2, T>(1)) == T(0));
    CHECK(edge_segments(t.bends, glm::vec<2, T>(0), glm::vec<2, T>(1), T(1e-6), 64) == 1);
    CHECK_FALSE(edge_needs_cut(t.bends, glm::vec<2, T>(0), glm::vec<2, T>(1), T(1e-6)));
}

TEMPLATE_TEST_CASE("J44: one kink under an edge shorter than a cell", "", float, double) {
    using T = TestType;
    // slopes 0.15 and 3.85 meet in the middle of a table of two cells: J = 3.7, h = 1/2
    const int cells = 2;
    warp_tables<T> t(cells, 1, cells, 1);
    for (int k = 0; k <= cells; ++k) {
        t.rows.at(0, k) = k == 1 ? T(0.075) : T(k) / T(cells);
        t.columns.at(0, k) = T(k) / T(cells);
    }
    t.build(2);
    const T jump = T(2) * (T(1) - T(2) * T(0.075));
    const glm::vec<2, T> a(T(0.49), T(0.5)), b(T(0.51), T(0.5));
    // the bound is J L / 4, in the middle attained: units are the coarsest direction, one row here,
    // so it is twice that for two cells
    const T exact = jump * T(2) * (b.x - a.x) / T(4);
    CHECK(edge_deviation(t.bends, a, b) >= exact / T(2) * T(0.999));
    CHECK(edge_error(t, a, b, 2) <= wide(edge_deviation(t.bends, a, b)));
    const int n = edge_segments(t.bends, a, b, T(0.5 / 1024), 4096);
    CHECK(n > 1);
    for (int k = 0; k < n; ++k) {
        const auto at = [&](int i) { return a + (b - a) * (T(i) / T(n)); };
        CHECK(edge_error(t, at(k), at(k + 1), 9) <= wide(0.5 / 1024 * 1.0001));
    }
}

TEMPLATE_TEST_CASE("a cap on the pieces is answered with what it reaches", "", float, double) {
    using T = TestType;
    dice d(7);
    warp_tables<T> t(64, 64, 64, 64);
    while (true) {
        fill(t.rows, d);
        t.columns = t.rows;
        t.build(16);
        if (edge_segments(t.bends, glm::vec<2, T>(0), glm::vec<2, T>(1), T(1e-4), 1000) > 8) {
            break;
        }
    }
    const glm::vec<2, T> a(0), b(1);
    CHECK(edge_segments(t.bends, a, b, T(1e-4), 8) == 8);
    CHECK(split_deviation(t.bends, a, b, 8) > T(1e-4));
    CHECK(edge_segments(t.bends, a, b, std::numeric_limits<T>::denorm_min(), 8) == 8);
    CHECK(edge_segments(t.bends, a, a, T(1e-4), 8) == 1);
}

TEST_CASE("memory and sizes that do not fit are refused") {
    const std::array<float, 4> nodes{0.0f, 0.5f, 0.75f, 1.0f};
    const table_view<float> table{nodes, 3, 1};
    std::vector<float> memory(bend_nodes(8));
    table_view<float> bends;
    CHECK(build_bends(table, table, 8, std::span<float>(memory), bends) == status::ok);
    CHECK(bends.rows == 15);
    for (const int blocks : {-1, 0, 1, 3, 12, 128, 16}) {
        CHECK(build_bends(table, table, blocks, std::span<float>(memory), bends) ==
              status::buffer_too_small);
        CHECK(bends.nodes.empty());
    }
    CHECK(build_bends(table_view<float>{nodes, 4, 1}, table, 8, std::span<float>(memory), bends) ==
          status::buffer_too_small);
}
