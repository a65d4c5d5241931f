// Properties of edge_walk.hpp, tessellation.hpp, warped_hull.hpp and warped_box.hpp: no warped edge
// departs from its chord by more than the bound, cutting by the rules keeps what was asked for, and
// no part of a warped triangle lies outside its hull.
//
// The oracle evaluates the stored nodes in long double, piece by piece, and shares no code with the
// library.
#include "warp_oracle.hpp"

#include <warpshadow/edge_walk.hpp>
#include <warpshadow/tessellation.hpp>
#include <warpshadow/warp_build.hpp>
#include <warpshadow/warped_box.hpp>
#include <warpshadow/warped_hull.hpp>

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

    warp_tables(int c0, int r0, int c1, int r1) : rows(c0, r0), columns(c1, r1) {}

    [[nodiscard]] real2 warped(real2 p) const {
        const real u = rows.value(p.y, p.x);
        return {u, columns.value(u, p.y)};
    }
    /// What rounding of positions makes of warped places: u and v by the steepest functions, and v
    /// by the steps from function to function times the error of u.
    [[nodiscard]] real rounding() const {
        const real u = static_cast<real>(roundoff<T>());
        const real of_u = u * (16 + 8 * rows.cells + 8 * rows.rows);
        return (of_u + u * 8 * columns.cells) * (1 + columns.rows);
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
    return tables;
}

template <typename T> glm::vec<2, T> any_point(dice& d) {
    return {static_cast<T>(d.unit()), static_cast<T>(d.unit())};
}

template <typename T> real wide(T x) {
    return static_cast<real>(x);
}

template <typename T> real2 wide(glm::vec<2, T> p) {
    return {static_cast<real>(p.x), static_cast<real>(p.y)};
}

/// Places of a warped edge, at equal steps and on both sides of all kinks of the unwarped map.
template <typename T, typename Use>
void along_edge(const warp_tables<T>& t, glm::vec<2, T> from, glm::vec<2, T> to, int steps,
                Use use) {
    const real2 a = wide(from);
    const real dx = wide(to.x) - a.x;
    const real dy = wide(to.y) - a.y;
    const auto try_at = [&](real s) {
        if (s >= 0 && s <= 1) {
            use(t.warped({a.x + s * dx, a.y + s * dy}));
        }
    };
    for (int i = 0; i <= steps; ++i) {
        try_at(static_cast<real>(i) / steps);
    }
    for (int k = 1; k < t.rows.cells && dx != 0; ++k) {
        try_at((static_cast<real>(k) / t.rows.cells - a.x) / dx);
    }
    for (int k = 0; k < t.rows.rows && dy != 0; ++k) {
        try_at(((k + real(0.5)) / t.rows.rows - a.y) / dy);
    }
    for (int k = 1; k < t.columns.cells && dy != 0; ++k) {
        try_at((static_cast<real>(k) / t.columns.cells - a.y) / dy);
    }
}

/// Largest distance found between a warped edge and the line through its warped ends.
template <typename T>
real edge_error(const warp_tables<T>& t, glm::vec<2, T> a, glm::vec<2, T> b, int steps) {
    const real2 from = t.warped(wide(a));
    const real2 to = t.warped(wide(b));
    const real length = std::hypot(to.x - from.x, to.y - from.y);
    real most = 0;
    along_edge(t, a, b, steps, [&](real2 q) {
        if (length > 0) {
            most = std::max(most, std::abs((to.x - from.x) * (q.y - from.y) -
                                           (to.y - from.y) * (q.x - from.x)) /
                                      length);
        }
    });
    return most;
}

/// How far a place lies outside a hull.
template <typename T> real outside(const warped_hull<T>& hull, real2 q) {
    const auto corner = [&](int i) { return wide(hull.corner[i % hull.corners]); };
    real area = 0;
    for (int i = 0; i < hull.corners; ++i) {
        area += corner(i).x * corner(i + 1).y - corner(i).y * corner(i + 1).x;
    }
    real most = 0;
    for (int i = 0; i < hull.corners; ++i) {
        const real2 a = corner(i);
        const real2 b = corner(i + 1);
        const real length = std::hypot(b.x - a.x, b.y - a.y);
        const real side = (b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x);
        if (length > 0) {
            most = std::max(most, (area < 0 ? side : -side) / length);
        }
    }
    return most;
}

/// A point near another, all distances being about as likely.
template <typename T> glm::vec<2, T> near_point(dice& d, glm::vec<2, T> a, T scale) {
    return glm::clamp(a + scale * (any_point<T>(d) - any_point<T>(d)), T(0), T(1));
}

template <typename T> T any_scale(dice& d) {
    return static_cast<T>(std::exp2(-d.between(0.0, 12.0)));
}

/// A table that is a straight line along each axis.
template <typename T> warp_tables<T> straight_tables(int cells) {
    warp_tables<T> t(cells, cells, cells, cells);
    for (owned_table<T>* table : {&t.rows, &t.columns}) {
        for (int row = 0; row < cells; ++row) {
            for (int k = 0; k <= cells; ++k) {
                table->at(row, k) = T(k) / T(cells);
            }
        }
    }
    return t;
}

} // namespace

TEMPLATE_TEST_CASE("no warped edge departs from its chord by more than the bound", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const warp_tables<T> t = any_tables<T>(d);
        const table_view<T> rows = t.rows.view(), columns = t.columns.view();
        for (int i = 0; i < 8; ++i) {
            const glm::vec<2, T> a = any_point<T>(d);
            glm::vec<2, T> b = near_point(d, a, any_scale<T>(d));
            if (d.between(0, 3) == 0) {
                (d.coin() ? b.x : b.y) = d.coin() ? a.x : a.y;
                b = glm::clamp(b, T(0), T(1));
            }
            const T bound = edge_deviation(rows, columns, a, b, T(9));
            RC_ASSERT(bound == edge_deviation(rows, columns, b, a, T(9)));
            RC_ASSERT(bound >= T(0));
            // a chord much shorter than its rounding has no direction
            const real2 from = t.warped(wide(a)), to = t.warped(wide(b));
            const real length = std::hypot(to.x - from.x, to.y - from.y);
            if (length > 0) {
                const real turn = t.rounding() / length;
                RC_ASSERT(edge_error(t, a, b, 17) <=
                          wide(bound) + t.rounding() + turn * (wide(bound) + length));
            }
            const T allowed = static_cast<T>(std::exp2(-d.between(7.0, 11.0)));
            RC_ASSERT(edge_needs_cut(rows, columns, a, b, allowed) == (bound > allowed));
        }
    }));
}

TEMPLATE_TEST_CASE("the bound of an edge is no more than four times what it does on smooth tables",
                   "", float, double) {
    using T = TestType;
    warp_tables<T> t(64, 64, 64, 64);
    for (owned_table<T>* table : {&t.rows, &t.columns}) {
        for (int row = 0; row < 64; ++row) {
            for (int k = 0; k <= 64; ++k) {
                const double x = k / 64.0;
                const double share = 0.2 + 0.4 * (row + 0.5) / 64.0;
                table->at(row, k) = static_cast<T>(
                    x + share * std::sin(2.0 * 3.14159265358979 * x) / (2.0 * 3.14159265358979));
            }
        }
    }
    dice d(3);
    int counted = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::vec<2, T> a = any_point<T>(d);
        const glm::vec<2, T> b = near_point(d, a, T(0.5));
        const real found = edge_error(t, a, b, 65);
        if (found > real(0.002)) {
            ++counted;
            CHECK(wide(edge_deviation(t.rows.view(), t.columns.view(), a, b, T(9))) <= 4 * found);
        }
    }
    CHECK(counted > 50);
}

TEMPLATE_TEST_CASE("pieces of an edge keep what was asked for", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const warp_tables<T> t = any_tables<T>(d);
        const table_view<T> rows = t.rows.view(), columns = t.columns.view();
        const T allowed = static_cast<T>(std::exp2(-d.between(7.0, 10.0)));
        const glm::vec<2, T> a = any_point<T>(d), b = near_point(d, a, any_scale<T>(d));
        const int limit = 1 << d.between(0, 6);
        const int n = edge_segments(rows, columns, a, b, allowed, limit);
        RC_ASSERT(n == edge_segments(rows, columns, b, a, allowed, limit));
        RC_ASSERT(n >= 1 && n <= limit && (n & (n - 1)) == 0);
        const T left = split_deviation(rows, columns, a, b, n, T(9));
        RC_ASSERT(left == split_deviation(rows, columns, b, a, n, T(9)));
        RC_ASSERT(left <= allowed || n == limit);
        RC_ASSERT(n == 1 || split_deviation(rows, columns, a, b, n / 2, T(9)) > allowed);
    }));
}

TEMPLATE_TEST_CASE("no part of a warped triangle lies outside its hull", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const warp_tables<T> t = any_tables<T>(d);
        for (int i = 0; i < 4; ++i) {
            const glm::vec<2, T> a = any_point<T>(d);
            const T scale = any_scale<T>(d);
            std::array<glm::vec<2, T>, 3> p{a, near_point(d, a, scale), near_point(d, a, scale)};
            const int kind = d.between(0, 9);
            if (kind == 0) { // a sliver
                p[2] = p[0] + static_cast<T>(d.unit()) * (p[1] - p[0]);
            } else if (kind == 1) { // two corners in one
                p[static_cast<std::size_t>(d.between(1, 2))] = p[0];
            } else if (kind == 2) {
                p[1] = p[2] = p[0];
            }
            const T margin = d.coin() ? T(0) : T(1.0 / 4096.0);
            const warped_hull<T> hull =
                hull_of_triangle(t.rows.view(), t.columns.view(), p[0], p[1], p[2], margin);
            RC_ASSERT(hull.corners == 3 || hull.corners == 4);
            RC_ASSERT(hull.area >= T(0) && hull.excess <= hull.area);
            // the corners of a triangle lie where two lines meet at a sine of 0.02 or above
            const real rounding = 64 * t.rounding();
            for (std::size_t k = 0; k < 3; ++k) {
                along_edge(t, p[k], p[(k + 1) % 3], 9,
                           [&](real2 q) { RC_ASSERT(outside(hull, q) <= rounding); });
            }
            for (int k = 0; k < 10; ++k) {
                real x = wide(d.unit()), y = wide(d.unit());
                if (x + y > 1) {
                    x = 1 - x;
                    y = 1 - y;
                }
                const real2 p0 = wide(p[0]), p1 = wide(p[1]), p2 = wide(p[2]);
                const real2 inside{p0.x + x * (p1.x - p0.x) + y * (p2.x - p0.x),
                                   p0.y + x * (p1.y - p0.y) + y * (p2.y - p0.y)};
                RC_ASSERT(outside(hull, t.warped(inside)) <= rounding);
            }
        }
    }));
}

TEMPLATE_TEST_CASE("no part of a warped box lies outside the box around it", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const warp_tables<T> t = any_tables<T>(d);
        for (int i = 0; i < 4; ++i) {
            const glm::vec<2, T> a = any_point<T>(d);
            const glm::vec<2, T> b = d.between(0, 9) == 0 ? a : near_point(d, a, any_scale<T>(d));
            const map_box<T> box{glm::min(a, b), glm::max(a, b)};
            const map_box<T> warped = warp_box(t.rows.view(), t.columns.view(), box);
            const real rounding = 64 * t.rounding();
            real least = 1;
            real most = 0;
            const auto holds = [&](real2 q) {
                RC_ASSERT(q.x >= wide(warped.lo.x) - rounding);
                RC_ASSERT(q.x <= wide(warped.hi.x) + rounding);
                RC_ASSERT(q.y >= wide(warped.lo.y) - rounding);
                RC_ASSERT(q.y <= wide(warped.hi.y) + rounding);
                least = std::min(least, q.x);
                most = std::max(most, q.x);
            };
            const std::array<glm::vec<2, T>, 4> corner{box.lo, glm::vec<2, T>(box.hi.x, box.lo.y),
                                                       box.hi, glm::vec<2, T>(box.lo.x, box.hi.y)};
            for (std::size_t k = 0; k < 4; ++k) {
                along_edge(t, corner[k], corner[(k + 1) % 4], 9, holds);
            }
            // along u nothing is given away: the sides reach both ends
            RC_ASSERT(least <= wide(warped.lo.x) + rounding);
            RC_ASSERT(most >= wide(warped.hi.x) - rounding);
            // along v nothing but that all U is taken to occur with all v: between the rows of the
            // columns' table the ends lie at rows or at the ends of the range
            glm::vec<2, T> v(T(1), T(0));
            for (int row = -1; row <= table_rows(t.columns.view()); ++row) {
                const T at = std::clamp((T(row) + T(0.5)) / T(table_rows(t.columns.view())),
                                        warped.lo.x, warped.hi.x);
                v.x = std::min(v.x, axis_range(t.columns.view(), at, at, box.lo.y, box.lo.y).x);
                v.y = std::max(v.y, axis_range(t.columns.view(), at, at, box.hi.y, box.hi.y).y);
            }
            RC_ASSERT(std::abs(wide(v.x) - wide(warped.lo.y)) <= rounding);
            RC_ASSERT(std::abs(wide(v.y) - wide(warped.hi.y)) <= rounding);
        }
    }));
}

TEMPLATE_TEST_CASE("J45: linear tables are never cut, and hulls are the triangles", "", float,
                   double) {
    using T = TestType;
    const warp_tables<T> t = straight_tables<T>(64);
    const table_view<T> rows = t.rows.view(), columns = t.columns.view();
    const glm::vec<2, T> a(0), b(1), c(T(1), T(0));
    const T some = T(64) * std::numeric_limits<T>::epsilon();
    CHECK(edge_deviation(rows, columns, a, b, T(9)) <= some);
    CHECK(edge_segments(rows, columns, a, b, T(1e-6), 64) == 1);
    CHECK_FALSE(edge_needs_cut(rows, columns, a, b, T(1e-6)));
    const warped_hull<T> hull = hull_of_triangle(rows, columns, a, b, c, T(0));
    CHECK(hull.corners == 3);
    CHECK(hull.excess <= some);
    CHECK(std::abs(hull.area - T(0.5)) <= some);
}

TEMPLATE_TEST_CASE("J44: one kink under an edge shorter than a cell", "", float, double) {
    using T = TestType;
    // slopes 0.15 and 1.85 meet in the middle of a table of two cells
    warp_tables<T> t = straight_tables<T>(2);
    for (int row = 0; row < 2; ++row) {
        t.rows.at(row, 1) = T(0.075);
    }
    const table_view<T> rows = t.rows.view(), columns = t.columns.view();
    const glm::vec<2, T> a(T(0.49), T(0.5)), b(T(0.51), T(0.51));
    const T bound = edge_deviation(rows, columns, a, b, T(9));
    const real found = edge_error(t, a, b, 2);
    CHECK(found > real(0.001));
    // the kink is walked to: nothing is lost
    CHECK(wide(bound) >= found * real(0.9999));
    CHECK(wide(bound) <= found * real(1.0001));
    // along the axis points move, and the line stays a line
    CHECK(edge_deviation(rows, columns, a, glm::vec<2, T>(b.x, a.y), T(9)) <=
          T(8) * std::numeric_limits<T>::epsilon());
    CHECK(edge_segments(rows, columns, a, b, T(0.5 / 1024), 64) == 2);
}

TEMPLATE_TEST_CASE("a cap on the pieces is answered with what it reaches", "", float, double) {
    using T = TestType;
    warp_tables<T> t = straight_tables<T>(2);
    for (int row = 0; row < 2; ++row) {
        t.rows.at(row, 1) = T(0.1);
    }
    const table_view<T> rows = t.rows.view(), columns = t.columns.view();
    const glm::vec<2, T> a(0), b(T(1), T(0.7));
    const T tiny = std::numeric_limits<T>::denorm_min();
    CHECK(edge_segments(rows, columns, a, b, tiny, 6) == 6);
    CHECK(split_deviation(rows, columns, a, b, 6, T(9)) > tiny);
    CHECK(edge_segments(rows, columns, a, a, T(1e-4), 8) == 1);
    CHECK(edge_segments(rows, columns, a, b, T(1e-4), 1) == 1);
}

TEMPLATE_TEST_CASE("positions that are no numbers are clamped to the map", "", float, double) {
    using T = TestType;
    const warp_tables<T> t = straight_tables<T>(8);
    const table_view<T> rows = t.rows.view(), columns = t.columns.view();
    const T nan = std::numeric_limits<T>::quiet_NaN();
    const T huge = std::numeric_limits<T>::max();
    for (const T x : {nan, huge, -huge, std::numeric_limits<T>::infinity(), T(2)}) {
        for (const T y : {nan, huge, T(0.5)}) {
            const glm::vec<2, T> p(x, y), q(y, x);
            CHECK(edge_deviation(rows, columns, p, q, T(9)) <= T(1));
            const warped_hull<T> hull =
                hull_of_triangle(rows, columns, p, q, glm::vec<2, T>(T(0.5), T(0.2)), T(0));
            CHECK(hull.area >= T(0));
            CHECK(hull.area <= T(4));
            const map_box<T> box = warp_box(rows, columns, map_box<T>{p, q});
            for (const T side : {box.lo.x, box.lo.y, box.hi.x, box.hi.y}) {
                CHECK(side >= T(0));
                CHECK(side <= T(1));
            }
        }
    }
}

TEMPLATE_TEST_CASE("a stretch between any positions ends, and so does a walk over any tables", "",
                   float, double) {
    using T = TestType;
    const warp_tables<T> t = straight_tables<T>(8);
    const T nan = std::numeric_limits<T>::quiet_NaN();
    const T huge = std::numeric_limits<T>::max();
    const std::array<T, 7> numbers{nan,     huge, -huge,  std::numeric_limits<T>::infinity(),
                                   T(0.25), T(1), T(-0.0)};
    const auto inside = [](const glm::vec<2, T>& p) {
        const T slack = T(8) * std::numeric_limits<T>::epsilon();
        return p.x >= -slack && p.x <= T(1) + slack && p.y >= -slack && p.y <= T(1) + slack;
    };
    for (const T x : numbers) {
        for (const T y : numbers) {
            const warped_stretch<T> stretch = warp_stretch(
                t.rows.view(), t.columns.view(), glm::vec<2, T>(x, y), glm::vec<2, T>(y, x));
            CHECK(inside(stretch.from));
            CHECK(inside(stretch.to));
            CHECK(stretch.bend.x >= T(0));
            CHECK(stretch.bend.y >= T(0));
        }
    }
    // a NaN was converted to the least of all rows, from which the walk went on to the last
    warp_tables<T> spoilt = straight_tables<T>(8);
    for (const T bad : {nan, huge, -huge}) {
        for (T& node : spoilt.rows.nodes) {
            node = bad;
        }
        const T deviation = edge_deviation(spoilt.rows.view(), spoilt.columns.view(),
                                           glm::vec<2, T>(T(0.1)), glm::vec<2, T>(T(0.9)), T(9));
        CHECK_FALSE(deviation < T(0));
    }
}
