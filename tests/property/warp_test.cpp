// Properties of warpshadow/warp.hpp, on tables made here: no builder is involved.
//
// The oracle evaluates the stored nodes with a hundred digits. u is the unit roundoff of T. Error
// bounds, for a table of `cells` cells and `rows` rows, F' the slope of a function and `step` the
// difference of neighbouring functions at a node, both near the point in question:
//
// * Position across the rows: one product and one difference of size `rows`, so 2u rows; a function
//   changes by `step` per row, so this moves a value by at most 2u rows step.
// * A blended node: one difference, one product, one sum of size 1: 3u.
// * The offset at a node: k / cells, and the difference: 2u. Between the nodes: a difference, a
//   product and a sum: 3u. The position along the axis is rounded once, which moves x by u x.
// * x plus the offset: u.
//
// Together: |warp - exact| <= 9u + u x |F' - 1| + 2u rows step along the first axis. The second one
// adds its own, and what the error of the first changes in the choice of the function.
//
// Forward and inverse use the same blended nodes. Given these, the forward evaluation is off by 6u
// and by u x in the position; the inverse is off by 9u: 2u for offsets at the nodes, 3u for the
// three roundings of the share t, 3u for the interpolation and u for the final sum. Hence
//
//     |F⁻¹(F(x)) - x| <= 7u / F' + 10u        in the map,
//     |F(F⁻¹(X)) - X| <= 7u + 10u F'          in the warped map.
//
// Neither is small in units of u for both small and large slopes, whatever the algorithm: the
// number that is passed from one function to the other is itself rounded by u.
#include "warp_oracle.hpp"

#include <warpshadow/warp.hpp>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

using real = boost::multiprecision::cpp_bin_float_100;
using real2 = std::array<real, 2>;

double as_double(const real& x) {
    return static_cast<double>(x);
}

/// A table and its memory, which has exactly the size of the table.
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
    [[nodiscard]] double node(int row, int k) const {
        return static_cast<double>(
            nodes[static_cast<std::size_t>(row) * (static_cast<std::size_t>(cells) + 1) +
                  static_cast<std::size_t>(k)]);
    }
    [[nodiscard]] table_view<T> view() const { return {nodes, cells, rows}; }
};

/// Fills one function from densities of its cells, mixed with the uniform one by `floor`.
template <typename T>
void set_function(owned_table<T>& table, int row, const std::vector<double>& density,
                  double floor) {
    double total = 0.0;
    for (const double x : density) {
        total += x;
    }
    double before = 0.0;
    for (int k = 0; k <= table.cells; ++k) {
        const double x = double(k) / double(table.cells);
        const double share = total > 0.0 ? std::min(before / total, 1.0) : x;
        table.at(row, k) = static_cast<T>(x + (1.0 - floor) * (share - x));
        before += k < table.cells ? density[static_cast<std::size_t>(k)] : 0.0;
    }
    table.at(row, 0) = T(0);
    table.at(row, table.cells) = T(1);
}

template <typename T> owned_table<T> identity_table(int cells, int rows) {
    owned_table<T> table(cells, rows);
    for (int row = 0; row < rows; ++row) {
        for (int k = 0; k <= cells; ++k) {
            table.at(row, k) = T(k) / T(cells);
        }
    }
    return table;
}

/// Tables from tame to wild: identity, smooth, noise, spikes, opposite neighbours, equal rows.
template <typename T> owned_table<T> any_table(dice& d, int cells, int rows, double floor) {
    const int kind = d.between(0, 5);
    if (kind == 0) {
        return identity_table<T>(cells, rows);
    }
    owned_table<T> table(cells, rows);
    std::vector<double> density(static_cast<std::size_t>(cells));
    const double centre = d.unit();
    const double drift = d.between(-1.0, 1.0);
    for (int row = 0; row < rows; ++row) {
        const double at = centre + drift * double(row) / double(rows);
        if (kind != 5 || row == 0) {
            std::fill(density.begin(), density.end(), 0.0);
            switch (kind) {
            case 1: // a hill that wanders from row to row
                for (int i = 0; i < cells; ++i) {
                    const double x = (i + 0.5) / cells - at;
                    density[static_cast<std::size_t>(i)] = std::exp(-20.0 * x * x);
                }
                break;
            case 2: // noise
                for (double& x : density) {
                    x = d.unit();
                }
                break;
            case 3: // everything in one cell, another one in each row; some rows empty
                density[static_cast<std::size_t>(d.between(0, cells - 1))] = d.between(0, 2);
                break;
            case 4: // neighbours that pull to opposite ends
                density[static_cast<std::size_t>(row % 2 == 0 ? cells / 20
                                                              : cells - 1 - cells / 20)] = 1.0;
                break;
            default: // orders of magnitude, the same in all rows
                for (double& x : density) {
                    x = std::exp2(d.between(-20.0, 20.0));
                }
                break;
            }
        }
        set_function(table, row, density, floor);
    }
    return table;
}

/// A density floor that T can store strictly, down to one thousandth.
template <typename T> double any_floor(dice& d, int cells) {
    const double least = cells * static_cast<double>(std::numeric_limits<T>::epsilon());
    return std::max(4.0 * least, std::exp2(d.between(-10.0, 0.0)));
}

// ---------------------------------------------------------------------------------- exact oracle

/// F(x) of the function at a position across the rows, from the stored nodes, exactly.
template <typename T>
real exact_value(const owned_table<T>& table, const real& across, const real& x) {
    if (x <= 0 || x >= 1) {
        return x;
    }
    real position = across * table.rows - real(0.5);
    position = std::clamp(position, real(0), real(table.rows - 1));
    const int row0 = static_cast<int>(floor(position));
    const int row1 = std::min(row0 + 1, table.rows - 1);
    const real weight = position - row0;
    const int cell = static_cast<int>(floor(x * table.cells));
    const real share = x * table.cells - cell;
    const auto node = [&](int k) {
        return (1 - weight) * real(table.node(row0, k)) + weight * real(table.node(row1, k));
    };
    return (1 - share) * node(cell) + share * node(cell + 1);
}

template <typename T>
real2 exact_warp(const owned_table<T>& rows, const owned_table<T>& columns, const real2& p) {
    const real u = exact_value(rows, p[1], p[0]);
    return {u, exact_value(columns, u, p[1])};
}

template <typename T> real2 exact(const glm::vec<2, T>& p) {
    return {real(p.x), real(p.y)};
}

// ------------------------------------------------------------------------------------ bounds

/// Slopes and differences of neighbouring functions near a point.
struct surroundings {
    double least_slope = std::numeric_limits<double>::infinity();
    double largest_slope = 0.0;
    double excess = 0.0; ///< largest |F' - 1|
    double shear = 0.0;  ///< rows times the largest difference of neighbouring functions at a node
};

/// @param reach uncertainty of the position across the rows, in rows
template <typename T>
surroundings near_point(const owned_table<T>& table, double across, double x, double reach = 0.0) {
    surroundings s;
    const double position =
        std::clamp(across * table.rows - 0.5, 0.0, static_cast<double>(table.rows - 1));
    const int row_from = std::max(0, static_cast<int>(std::floor(position - reach)) - 1);
    const int row_to = std::min(table.rows - 1, static_cast<int>(std::floor(position + reach)) + 2);
    const int cell =
        std::clamp(static_cast<int>(std::clamp(x, 0.0, 1.0) * table.cells), 0, table.cells - 1);
    const int cell_from = std::max(0, cell - 1);
    const int cell_to = std::min(table.cells - 1, cell + 1);
    for (int row = row_from; row <= row_to; ++row) {
        for (int k = cell_from; k <= cell_to; ++k) {
            const double slope = (table.node(row, k + 1) - table.node(row, k)) * table.cells;
            s.least_slope = std::min(s.least_slope, slope);
            s.largest_slope = std::max(s.largest_slope, slope);
            s.excess = std::max(s.excess, std::abs(slope - 1.0));
        }
        for (int k = cell_from; k <= cell_to + 1 && row < row_to; ++k) {
            s.shear = std::max(s.shear,
                               std::abs(table.node(row + 1, k) - table.node(row, k)) * table.rows);
        }
    }
    return s;
}

/// Over the whole table.
template <typename T> surroundings everywhere(const owned_table<T>& table) {
    surroundings s;
    for (int row = 0; row < table.rows; ++row) {
        for (int k = 0; k <= table.cells; ++k) {
            if (k < table.cells) {
                const double slope = (table.node(row, k + 1) - table.node(row, k)) * table.cells;
                s.least_slope = std::min(s.least_slope, slope);
                s.largest_slope = std::max(s.largest_slope, slope);
                s.excess = std::max(s.excess, std::abs(slope - 1.0));
            }
            if (row + 1 < table.rows) {
                s.shear = std::max(s.shear, std::abs(table.node(row + 1, k) - table.node(row, k)) *
                                                table.rows);
            }
        }
    }
    return s;
}

/// Bound of one axis as derived at the head of this file.
template <typename T> double axis_error(const surroundings& s, double x) {
    return roundoff<T>() * (9.0 + std::clamp(x, 0.0, 1.0) * s.excess + 2.0 * s.shear);
}

template <typename T> struct warp_errors { double u, v; };

/// Bounds of both coordinates of `warp`; `moved` is an error of p itself.
template <typename T>
warp_errors<T> warp_error(const owned_table<T>& rows, const owned_table<T>& columns,
                          glm::vec<2, T> p, glm::vec<2, T> warped, double moved = 0.0) {
    const surroundings sr = near_point(rows, double(p.y), double(p.x));
    const double u = axis_error<T>(sr, double(p.x)) +
                     moved * (sr.largest_slope + sr.excess + sr.shear) +
                     roundoff<T>() * std::max(0.0, std::abs(double(p.x)) - 1.0);
    const surroundings sc =
        near_point(columns, double(warped.x), double(p.y), double(columns.rows) * u);
    const double v = axis_error<T>(sc, double(p.y)) + sc.shear * u +
                     moved * (sc.largest_slope + sc.excess) +
                     roundoff<T>() * std::max(0.0, std::abs(double(p.y)) - 1.0);
    return {u, v};
}

// --------------------------------------------------------------------------------- points

template <typename T> glm::vec<2, T> any_point(dice& d) {
    return glm::vec<2, T>(static_cast<T>(d.unit()), static_cast<T>(d.unit()));
}

/// A coordinate on a cell edge, a row centre, the border, or a step beside it.
template <typename T> T any_seam(dice& d, int cells, int rows) {
    T x = T(0);
    switch (d.between(0, 3)) {
    case 0:
        x = T(d.between(0, cells)) / T(cells);
        break;
    case 1:
        x = (T(d.between(0, rows - 1)) + T(0.5)) / T(rows);
        break;
    case 2:
        x = T(d.between(0, 1));
        break;
    default:
        return static_cast<T>(d.between(-1.0, 2.0));
    }
    const int beside = d.between(-1, 1);
    return beside == 0 ? x : std::nextafter(x, T(beside) * T(4));
}

template <typename T> bool finite(const glm::vec<2, T>& p) {
    return std::isfinite(p.x) && std::isfinite(p.y);
}

template <typename T> bool same_bits(T a, T b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

} // namespace

// -------------------------------------------------------------------------------- identity, ends

TEMPLATE_TEST_CASE("J31, peers 25: tables of the identity give back p to the bit", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(4096);
        const owned_table<T> rows = identity_table<T>(cells, d.size(8));
        const owned_table<T> columns = identity_table<T>(d.size(4096), d.size(8));
        for (int i = 0; i < 100; ++i) {
            const glm::vec<2, T> p(any_seam<T>(d, cells, 8), any_seam<T>(d, cells, 8));
            const glm::vec<2, T> q = warp(rows.view(), columns.view(), p);
            RC_ASSERT(q == p);
            RC_ASSERT(warp_floor(rows.view(), columns.view(), p) == p);
            RC_ASSERT(unwarp(rows.view(), columns.view(), p) == p);
            RC_ASSERT(unwarp_floor(rows.view(), columns.view(), p) == p);
        }
    }));
}

TEMPLATE_TEST_CASE("J38, J42: ends are fixed to the bit and the outside does not move", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(4096);
        const owned_table<T> rows = any_table<T>(d, cells, d.size(8), any_floor<T>(d, cells));
        const owned_table<T> columns = any_table<T>(d, cells, d.size(8), any_floor<T>(d, cells));
        const T ends[] = {T(0),
                          T(1),
                          std::nextafter(T(1), T(2)),
                          std::nextafter(T(0), T(-1)),
                          T(-0.5),
                          T(1.5),
                          T(-1e6),
                          T(1e6)};
        for (const T end : ends) {
            const T other = static_cast<T>(d.between(-0.5, 1.5));
            for (const auto& map :
                 {&warp<T, T>, &unwarp<T, T>, &warp_floor<T, T>, &unwarp_floor<T, T>}) {
                RC_ASSERT(map(rows.view(), columns.view(), {end, other}).x == end);
                RC_ASSERT(map(rows.view(), columns.view(), {other, end}).y == end);
                RC_ASSERT(map(rows.view(), columns.view(), {end, end}) ==
                          (glm::vec<2, T>(end, end)));
            }
            RC_ASSERT(axis_offset(rows.view(), blend_rows(other, rows.rows), end) == T(0));
            RC_ASSERT(axis_inverse_offset(rows.view(), blend_rows(other, rows.rows), end) == T(0));
        }
        // J42 just inside: the offset is no larger than the distance to the end allows
        const T below = std::nextafter(T(1), T(0));
        const double gap = 1.0 - double(below);
        const surroundings s = near_point(rows, 0.5, 1.0);
        const double offset =
            double(axis_offset(rows.view(), blend_rows(T(0.5), rows.rows), below));
        // the position is rounded once, hence twice the gap; 6u for offsets and interpolation
        RC_ASSERT(std::abs(offset) <= 2.0 * gap * s.excess + 6.0 * roundoff<T>());
    }));
}

// ------------------------------------------------------------------------------ against the oracle

TEMPLATE_TEST_CASE("warp equals the hundred-digit evaluation within its derived bound", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(4096);
        const owned_table<T> rows = any_table<T>(d, cells, d.size(16), any_floor<T>(d, cells));
        const owned_table<T> columns =
            any_table<T>(d, d.size(4096), d.size(64), any_floor<T>(d, 4096));
        for (int i = 0; i < 8; ++i) {
            const glm::vec<2, T> p = d.coin() ? any_point<T>(d)
                                              : glm::vec<2, T>(any_seam<T>(d, cells, columns.rows),
                                                               any_seam<T>(d, cells, rows.rows));
            const glm::vec<2, T> q = warp(rows.view(), columns.view(), p);
            const real2 expected = exact_warp(rows, columns, exact(p));
            const warp_errors<T> bound = warp_error(rows, columns, p, q);
            RC_ASSERT(std::abs(as_double(real(q.x) - expected[0])) <= bound.u);
            RC_ASSERT(std::abs(as_double(real(q.y) - expected[1])) <= bound.v);
        }
    }));
}

TEMPLATE_TEST_CASE("floor variant: the function of the row that holds the point, and that alone",
                   "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(512);
        owned_table<T> rows = any_table<T>(d, cells, d.size(16), any_floor<T>(d, cells));
        const owned_table<T> columns = identity_table<T>(cells, rows.rows);
        const glm::vec<2, T> p = any_point<T>(d);
        const glm::vec<2, T> q = warp_floor(rows.view(), columns.view(), p);
        RC_ASSERT(q.y == p.y);
        // spoil every row but those that p lies in up to rounding: nothing changes
        const double position = double(p.y) * rows.rows;
        for (int row = 0; row < rows.rows; ++row) {
            if (row < std::floor(position * (1.0 - 2.0 * roundoff<T>())) ||
                row > std::floor(position * (1.0 + 2.0 * roundoff<T>()))) {
                for (int k = 0; k <= cells; ++k) {
                    rows.at(row, k) = T(0.25);
                }
            }
        }
        RC_ASSERT(warp_floor(rows.view(), columns.view(), p) == q);
        // at the centre of a row both variants hold the same function
        const int row = d.between(0, rows.rows - 1);
        const T centre = (T(row) + T(0.5)) / T(rows.rows);
        const row_blend<T> one = floor_row(centre, rows.rows);
        RC_ASSERT(one.row0 == row);
        RC_ASSERT(one.row1 == row);
        const row_blend<T> blend = blend_rows(centre, rows.rows);
        const double position_error = 2.0 * roundoff<T>() * rows.rows;
        const double from_row = std::abs(blend.row0 + double(blend.weight) - row);
        RC_ASSERT(from_row <= position_error);
        if (blend.row0 == row && blend.weight == T(0)) {
            RC_ASSERT(same_bits(axis_offset(rows.view(), one, p.x),
                                axis_offset(rows.view(), blend, p.x)));
        }
    }));
    // rows at a power of two have exact centres: the same bits, all of them
    dice d(1);
    const owned_table<T> table = any_table<T>(d, 100, 8, 0.1);
    for (int row = 0; row < 8; ++row) {
        const T centre = (T(row) + T(0.5)) / T(8);
        for (int i = 0; i <= 1000; ++i) {
            const T x = T(i) / T(1000);
            REQUIRE(same_bits(axis_offset(table.view(), floor_row(centre, 8), x),
                              axis_offset(table.view(), blend_rows(centre, 8), x)));
        }
    }
}

// -------------------------------------------------------------------------------------- round trip

TEMPLATE_TEST_CASE("unwarp after warp: back at p within the conditioned bound", "", float, double) {
    using T = TestType;
    const double u = roundoff<T>();
    REQUIRE(rc::check([u] {
        dice d = any_dice();
        const int cells = d.size(4096);
        const owned_table<T> rows = any_table<T>(d, cells, d.size(32), any_floor<T>(d, cells));
        const owned_table<T> columns = any_table<T>(d, cells, d.size(32), any_floor<T>(d, cells));
        for (int i = 0; i < 50; ++i) {
            const glm::vec<2, T> p = any_point<T>(d);
            const glm::vec<2, T> q = warp(rows.view(), columns.view(), p);
            const glm::vec<2, T> back = unwarp(rows.view(), columns.view(), q);
            // the same column functions, to the bit, in both directions
            const surroundings sc = near_point(columns, double(q.x), double(p.y));
            const double error_v = u * (7.0 / sc.least_slope + 10.0);
            RC_ASSERT(std::abs(double(back.y) - double(p.y)) <= error_v);
            // row functions chosen by v, which is off by error_v; its position is rounded twice,
            // and the nodes of both choices are rounded apart
            const surroundings sr = near_point(rows, double(p.y), double(p.x), error_v * rows.rows);
            const double value = sr.shear * (error_v + 4.0 * u) + 6.0 * u;
            const double error_u = (7.0 * u + value) / sr.least_slope + 10.0 * u;
            RC_ASSERT(std::abs(double(back.x) - double(p.x)) <= error_u);

            const glm::vec<2, T> flat = warp_floor(rows.view(), columns.view(), p);
            const glm::vec<2, T> back_flat = unwarp_floor(rows.view(), columns.view(), flat);
            RC_ASSERT(
                std::abs(double(back_flat.y) - double(p.y)) <=
                u * (7.0 / near_point(columns, double(flat.x), double(p.y)).least_slope + 10.0));
            // a v on the border of two rows may come back in the neighbour
            if (floor_row(back_flat.y, rows.rows).row0 == floor_row(p.y, rows.rows).row0) {
                RC_ASSERT(std::abs(double(back_flat.x) - double(p.x)) <=
                          u * (7.0 / sr.least_slope + 10.0));
            }
        }
    }));
}

TEMPLATE_TEST_CASE("warp after unwarp: back at q within the conditioned bound", "", float, double) {
    using T = TestType;
    const double u = roundoff<T>();
    REQUIRE(rc::check([u] {
        dice d = any_dice();
        const int cells = d.size(4096);
        const owned_table<T> rows = any_table<T>(d, cells, d.size(32), any_floor<T>(d, cells));
        const owned_table<T> columns = any_table<T>(d, cells, d.size(32), any_floor<T>(d, cells));
        for (int i = 0; i < 50; ++i) {
            const glm::vec<2, T> q = any_point<T>(d);
            const glm::vec<2, T> p = unwarp(rows.view(), columns.view(), q);
            const glm::vec<2, T> back = warp(rows.view(), columns.view(), p);
            const surroundings sr = near_point(rows, double(p.y), double(p.x));
            const double error_u = u * (7.0 + 10.0 * sr.largest_slope);
            RC_ASSERT(std::abs(double(back.x) - double(q.x)) <= error_u);
            const surroundings sc =
                near_point(columns, double(q.x), double(p.y), error_u * columns.rows);
            const double error_v =
                u * (7.0 + 10.0 * sc.largest_slope) + sc.shear * (error_u + 4.0 * u) + 6.0 * u;
            RC_ASSERT(std::abs(double(back.y) - double(q.y)) <= error_v);
        }
    }));
}

TEMPLATE_TEST_CASE("J36: neighbours that pull to opposite ends still round-trip", "", float,
                   double) {
    using T = TestType;
    owned_table<T> rows(128, 2);
    std::vector<double> density(128, 0.0);
    density[6] = 1.0; // x = 0.05
    set_function(rows, 0, density, 0.2);
    density[6] = 0.0;
    density[121] = 1.0; // x = 0.95
    set_function(rows, 1, density, 0.2);
    const owned_table<T> columns = rows;
    double largest = 0.0;
    for (int j = 0; j <= 500; ++j) {
        for (int i = 0; i <= 500; ++i) {
            const glm::vec<2, T> p(T(i) / T(500), T(j) / T(500));
            const glm::vec<2, T> back =
                unwarp(rows.view(), columns.view(), warp(rows.view(), columns.view(), p));
            largest = std::max(largest, std::abs(double(back.x) - double(p.x)) * 128.0);
            largest = std::max(largest, std::abs(double(back.y) - double(p.y)) * 128.0);
        }
    }
    INFO("largest error in texels: " << largest);
    REQUIRE(largest <= (std::is_same_v<T, float> ? 1e-3 : 1e-9));
}

// -------------------------------------------------------------------------------- continuity

TEMPLATE_TEST_CASE("the blended map is continuous across rows, borders and beyond the square", "",
                   float, double) {
    using T = TestType;
    const double u = roundoff<T>();
    REQUIRE(rc::check([u] {
        dice d = any_dice();
        const int cells = d.size(256);
        const owned_table<T> rows = any_table<T>(d, cells, d.size(64), any_floor<T>(d, cells));
        const owned_table<T> columns = any_table<T>(d, cells, d.size(64), any_floor<T>(d, cells));
        const surroundings sr = everywhere(rows);
        const surroundings sc = everywhere(columns);
        const double lipschitz_u = std::max(1.0, sr.largest_slope);
        const double lipschitz_v = std::max(1.0, sc.largest_slope);
        for (int i = 0; i < 40; ++i) {
            const glm::vec<2, T> p(any_seam<T>(d, cells, columns.rows),
                                   any_seam<T>(d, cells, rows.rows));
            // from one step of T to a thousandth of the map
            const double step = std::exp2(d.between(-60.0, -10.0));
            glm::vec<2, T> q(static_cast<T>(double(p.x) + d.between(-step, step)),
                             static_cast<T>(double(p.y) + d.between(-step, step)));
            q.x = d.coin() ? std::nextafter(p.x, d.coin() ? T(9) : T(-9)) : q.x;
            q.y = d.coin() ? std::nextafter(p.y, d.coin() ? T(9) : T(-9)) : q.y;
            const glm::vec<2, T> wp = warp(rows.view(), columns.view(), p);
            const glm::vec<2, T> wq = warp(rows.view(), columns.view(), q);
            const double du = std::abs(double(p.x) - double(q.x));
            const double dv = std::abs(double(p.y) - double(q.y));
            // rounding of both evaluations, with the largest slopes of the tables
            const double size =
                2.0 * std::max(1.0, std::max(std::abs(double(p.x)), std::abs(double(p.y))));
            const double error_u = size * u * (9.0 + sr.excess + 2.0 * sr.shear);
            const double change_u = lipschitz_u * du + sr.shear * dv + error_u;
            RC_ASSERT(std::abs(double(wp.x) - double(wq.x)) <= change_u);
            const double error_v = size * u * (9.0 + sc.excess + 2.0 * sc.shear);
            RC_ASSERT(std::abs(double(wp.y) - double(wq.y)) <=
                      lipschitz_v * dv + sc.shear * change_u + error_v);
        }
    }));
    // The floor variant fails the same test: it tears at the border of two rows by their
    // difference.
    owned_table<T> rows(4, 2);
    set_function(rows, 0, {1.0, 0.0, 0.0, 0.0}, 0.2);
    set_function(rows, 1, {0.0, 0.0, 0.0, 1.0}, 0.2);
    const owned_table<T> columns = identity_table<T>(4, 2);
    const T below = std::nextafter(T(0.5), T(0));
    const auto jump = [&](auto map) {
        return std::abs(double(map(rows.view(), columns.view(), {T(0.5), below}).x) -
                        double(map(rows.view(), columns.view(), {T(0.5), T(0.5)}).x));
    };
    REQUIRE(jump(&warp_floor<T, T>) == Approx(0.8));
    REQUIRE(jump(&warp<T, T>) <= 20.0 * u);
}

TEMPLATE_TEST_CASE("peers 27: the map is one to one: lines keep their order, no two points meet",
                   "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(64);
        const double floor = d.between(0.05, 1.0);
        const owned_table<T> rows = any_table<T>(d, cells, d.size(32), floor);
        const owned_table<T> columns = any_table<T>(d, cells, d.size(32), floor);
        // A step of 1/500 moves F by at least floor/500 = 1e-4, far above its rounding of
        // (9 + 64 + 2 * 32) u = 8e-6.
        const T line = static_cast<T>(d.unit());
        const row_blend<T> row = blend_rows(line, rows.rows);
        const row_blend<T> column = blend_rows(line, columns.rows);
        T last_u = T(-1);
        T last_v = T(-1);
        T last_x = T(-1);
        for (int i = 0; i <= 500; ++i) {
            const T x = T(i) / T(500);
            const T u = warp(rows.view(), columns.view(), {x, line}).x;
            RC_ASSERT(u > last_u);
            last_u = u;
            const T v = x + axis_offset(columns.view(), column, x);
            RC_ASSERT(v > last_v);
            last_v = v;
            // the inverse is a function of the same kind; its slope is at least 1 / (largest slope)
            const T back = x + axis_inverse_offset(rows.view(), row, x);
            RC_ASSERT(back >= last_x);
            last_x = back;
        }
        std::vector<std::pair<T, T>> images;
        for (int j = 0; j <= 40; ++j) {
            for (int i = 0; i <= 40; ++i) {
                const glm::vec<2, T> q =
                    warp(rows.view(), columns.view(), {T(i) / T(40), T(j) / T(40)});
                images.emplace_back(q.x, q.y);
                RC_ASSERT(q.x >= T(0) && q.x <= T(1) && q.y >= T(0) && q.y <= T(1));
            }
        }
        std::sort(images.begin(), images.end());
        RC_ASSERT(std::adjacent_find(images.begin(), images.end()) == images.end());
    }));
}

// ---------------------------------------------------------------------------------- Jacobian

TEMPLATE_TEST_CASE("jacobian equals finite differences of the exact map", "", float, double) {
    using T = TestType;
    const double u = roundoff<T>();
    REQUIRE(rc::check([u] {
        dice d = any_dice();
        const int cells = d.size(256);
        const double least_density = std::max(0.02, any_floor<T>(d, cells));
        const owned_table<T> rows = any_table<T>(d, cells, d.size(32), least_density);
        const owned_table<T> columns = any_table<T>(d, d.size(256), d.size(32), least_density);
        const glm::vec<2, T> p(static_cast<T>(d.between(-0.1, 1.1)),
                               static_cast<T>(d.between(-0.1, 1.1)));
        const real2 x = exact(p);
        const real2 w = exact_warp(rows, columns, x);
        // keep clear of the kinks, where the two sides differ: the roundings of T must not cross
        // one
        const auto clear = [](const real& position) {
            const real fraction = position - floor(position);
            return fraction > real(0.01) && fraction < real(0.99);
        };
        RC_PRE(clear(x[0] * rows.cells));
        RC_PRE(clear(x[1] * columns.cells));
        RC_PRE(clear(x[1] * rows.rows - real(0.5)));
        RC_PRE(clear(w[0] * columns.rows - real(0.5)));

        // Within a patch U and V are quadratic at most along either axis, so that central
        // differences have no error but that of a hundred digits.
        const real h("1e-30");
        real difference[2][2]; // [column][row], as in GLM
        for (std::size_t axis = 0; axis < 2; ++axis) {
            real2 ahead = x;
            real2 behind = x;
            ahead[axis] += h;
            behind[axis] -= h;
            const real2 wa = exact_warp(rows, columns, ahead);
            const real2 wb = exact_warp(rows, columns, behind);
            for (std::size_t i = 0; i < 2; ++i) {
                difference[axis][i] = (wa[i] - wb[i]) / (2 * h);
            }
        }

        // Slopes: two blended nodes (3u and the position across), their difference, the product.
        // Shears: two offsets at one function (9u and the position along), difference, product.
        const glm::vec<2, T> q = warp(rows.view(), columns.view(), p);
        const double moved = warp_error(rows, columns, p, q).u;
        const surroundings sr = near_point(rows, double(p.y), double(p.x));
        const surroundings sc = near_point(columns, double(q.x), double(p.y));
        const double in = 1.01; // terms of second order
        const double slope_u = in * u * (rows.cells * (7.0 + 4.0 * sr.shear) + sr.largest_slope);
        const double slope_v =
            in * (u * (columns.cells * (7.0 + 4.0 * sc.shear) + sc.largest_slope) +
                  2.0 * columns.cells * sc.shear * moved);
        const double shear_u = in * u * (rows.rows * (18.0 + 2.0 * sr.excess) + sr.shear);
        const double shear_v = in * u * (columns.rows * (18.0 + 2.0 * sc.excess) + sc.shear);

        const glm::mat<2, 2, T> j = jacobian(rows.view(), columns.view(), p);
        const double largest_u = std::max(1.0, sr.largest_slope);
        const double product_u =
            in * (sc.shear * slope_u + largest_u * shear_v + u * sc.shear * largest_u);
        const double product_v = in * (sc.shear * shear_u + sr.shear * shear_v +
                                       2.0 * u * (sc.shear * sr.shear + sc.largest_slope));
        const double e00 = std::abs(as_double(real(j[0][0]) - difference[0][0]));
        const double e01 = std::abs(as_double(real(j[0][1]) - difference[0][1]));
        const double e10 = std::abs(as_double(real(j[1][0]) - difference[1][0]));
        const double e11 = std::abs(as_double(real(j[1][1]) - difference[1][1]));
        RC_ASSERT(e00 <= slope_u);
        RC_ASSERT(e10 <= shear_u);
        RC_ASSERT(e01 <= product_u);
        RC_ASSERT(e11 <= slope_v + product_v);

        // The determinant is the product of the slopes: at least the product of their smallest.
        const real det = real(j[0][0]) * real(j[1][1]) - real(j[1][0]) * real(j[0][1]);
        const double rounding =
            in * (slope_u * std::abs(double(j[1][1])) + (slope_v + product_v) * largest_u +
                  shear_u * std::abs(double(j[0][1])) + product_u * std::abs(double(j[1][0])));
        const double least = std::min(1.0, sr.least_slope) * std::min(1.0, sc.least_slope);
        RC_ASSERT(as_double(det) >= least - rounding);
        RC_ASSERT(as_double(difference[0][0] * difference[1][1] -
                            difference[1][0] * difference[0][1]) >= least * (1.0 - 1e-12));
        // footprints: what a step along either axis of the map covers is never nothing
        RC_ASSERT(j[0][0] > T(0));
        RC_CLASSIFY(rounding < least);
        if (rounding < least) {
            RC_ASSERT(det > 0);
        }
    }));
}

// ------------------------------------------------------------------------------------- clip space

TEMPLATE_TEST_CASE("warp_clip is warp of the projected point, carried back to clip space", "",
                   float, double) {
    using T = TestType;
    const double u = roundoff<T>();
    REQUIRE(rc::check([u] {
        dice d = any_dice();
        const int cells = d.size(1024);
        const owned_table<T> rows = any_table<T>(d, cells, d.size(16), any_floor<T>(d, cells));
        const owned_table<T> columns = any_table<T>(d, cells, d.size(16), any_floor<T>(d, cells));
        for (int i = 0; i < 10; ++i) {
            const double w = std::exp2(d.between(-30.0, 30.0));
            const glm::vec<4, T> a(static_cast<T>(w * d.between(-1.2, 1.2)),
                                   static_cast<T>(w * d.between(-1.2, 1.2)),
                                   static_cast<T>(w * d.unit()), static_cast<T>(w));
            const glm::vec<4, T> p = warp_clip(rows.view(), columns.view(), a);
            RC_ASSERT(same_bits(p.z, a.z));
            RC_ASSERT(same_bits(p.w, a.w));
            const real2 b = {real(a.x) / real(a.w) / 2 + real(0.5),
                             real(a.y) / real(a.w) / 2 + real(0.5)};
            const real2 expected = exact_warp(rows, columns, b);
            // The quotient, the half and the sum are rounded to 2u of the map. Back in clip space
            // three roundings of at most w follow, which are 3u of NDC.
            const glm::vec<2, T> bt(static_cast<T>(b[0]), static_cast<T>(b[1]));
            const glm::vec<2, T> qt(static_cast<T>(expected[0]), static_cast<T>(expected[1]));
            const warp_errors<T> bound = warp_error(rows, columns, bt, qt, 3.0 * u);
            const real x = real(p.x) / real(a.w);
            const real y = real(p.y) / real(a.w);
            RC_ASSERT(std::abs(as_double(x - (2 * expected[0] - 1))) <= 2.0 * bound.u + 4.0 * u);
            RC_ASSERT(std::abs(as_double(y - (2 * expected[1] - 1))) <= 2.0 * bound.v + 4.0 * u);

            // homogeneous: a power of two changes nothing but the scale
            const T scale = static_cast<T>(std::ldexp(1.0, d.between(-20, 20)));
            const glm::vec<4, T> scaled = warp_clip(rows.view(), columns.view(), a * scale);
            RC_ASSERT(scaled == p * scale);
        }
    }));
}

TEMPLATE_TEST_CASE("J41: warp_clip gives back what has no place in the map", "", float, double) {
    using T = TestType;
    using limits = std::numeric_limits<T>;
    dice d(7);
    const owned_table<T> rows = any_table<T>(d, 33, 5, 0.1);
    const owned_table<T> columns = any_table<T>(d, 17, 3, 0.1);
    const T weights[] = {T(0),
                         T(-0.0),
                         T(1e-45),
                         T(-1e-45),
                         T(-1),
                         limits::infinity(),
                         -limits::infinity(),
                         limits::quiet_NaN(),
                         limits::denorm_min(),
                         limits::lowest()};
    for (const T w : weights) {
        CAPTURE(w);
        const glm::vec<4, T> a(T(0.37), T(-0.21), T(0.5), w);
        const glm::vec<4, T> p = warp_clip(rows.view(), columns.view(), a);
        REQUIRE(std::memcmp(&p, &a, sizeof a) == 0);
    }
    // no NaN or infinity where none came in, no index out of its table whatever comes in
    const T numbers[] = {T(0),
                         T(-0.0),
                         T(0.37),
                         T(-1),
                         T(1),
                         std::nextafter(T(1), T(2)),
                         limits::denorm_min(),
                         limits::min(),
                         limits::max(),
                         limits::lowest(),
                         limits::max() / T(2),
                         limits::infinity(),
                         -limits::infinity(),
                         limits::quiet_NaN()};
    for (const T x : numbers) {
        for (const T y : numbers) {
            for (const T w : numbers) {
                CAPTURE(x, y, w);
                const glm::vec<4, T> a(x, y, T(0.5), w);
                const glm::vec<4, T> p = warp_clip(rows.view(), columns.view(), a);
                if (std::isfinite(x) && std::isfinite(y) && std::isfinite(w)) {
                    REQUIRE(std::isfinite(p.x));
                    REQUIRE(std::isfinite(p.y));
                } else {
                    REQUIRE(std::memcmp(&p, &a, sizeof a) == 0);
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE("the largest w does not overflow", "", float, double) {
    using T = TestType;
    const T largest = std::numeric_limits<T>::max();
    // everything between 0.05 and 0.1: a point at 0.1 moves by 0.8 of the map
    owned_table<T> table(20, 1);
    std::vector<double> density(20, 0.0);
    density[1] = 1.0;
    set_function(table, 0, density, 0.1);
    for (const T w : {largest, largest / T(2), std::nextafter(largest / T(2), T(0))}) {
        const glm::vec<4, T> p =
            warp_clip(table.view(), table.view(), {T(-0.8) * w, T(-0.8) * w, T(0), w});
        REQUIRE(std::isfinite(p.x));
        REQUIRE(std::isfinite(p.y));
    }
}

TEMPLATE_TEST_CASE("J42: at the border of the map warp_clip does not move, inside it moves little",
                   "", float, double) {
    using T = TestType;
    dice d(11);
    for (int i = 0; i < 200; ++i) {
        const owned_table<T> rows = any_table<T>(d, d.size(300), d.size(9), 0.1);
        const owned_table<T> columns = any_table<T>(d, d.size(300), d.size(9), 0.1);
        for (const T w : {T(1), T(3), T(0.1)}) {
            const T other = w * static_cast<T>(d.between(-1.0, 1.0));
            for (const T edge : {T(1), T(-1), std::nextafter(T(1), T(2)),
                                 std::nextafter(T(-1), T(-2)), T(2), T(-2)}) {
                const T x = edge * w;
                const glm::vec<4, T> p =
                    warp_clip(rows.view(), columns.view(), {x, other, T(0), w});
                const glm::vec<4, T> q =
                    warp_clip(rows.view(), columns.view(), {other, x, T(0), w});
                // x = edge · w is rounded, so that x / w may lie one step inside the border
                const double inside = 2.0 * roundoff<T>() * double(w);
                const double slope =
                    std::max(1.0, std::max(everywhere(rows).excess, everywhere(columns).excess));
                const double bound = w == T(1) ? 0.0 : (2.0 * slope + 16.0) * inside;
                REQUIRE(std::abs(double(p.x) - double(x)) <= bound);
                REQUIRE(std::abs(double(q.y) - double(x)) <= bound);
            }
        }
    }
}

// -------------------------------------------------------------------------------------- totality

TEMPLATE_TEST_CASE("J37: any table and any point: indices stay inside, finite in is finite out", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int special[] = {1, 2, 3, 1000};
        const int cells = d.coin() ? special[d.between(0, 3)] : d.size(64);
        const owned_table<T> rows = any_table<T>(d, cells, d.size(8), any_floor<T>(d, cells));
        const owned_table<T> columns = any_table<T>(d, d.size(64), d.size(8), any_floor<T>(d, 64));
        for (int i = 0; i < 40; ++i) {
            const glm::vec<2, T> p(any_coordinate<T>(d), any_coordinate<T>(d));
            const glm::vec<2, T> results[] = {warp(rows.view(), columns.view(), p),
                                              unwarp(rows.view(), columns.view(), p),
                                              warp_floor(rows.view(), columns.view(), p),
                                              unwarp_floor(rows.view(), columns.view(), p)};
            for (const glm::vec<2, T>& q : results) {
                if (finite(p)) {
                    RC_ASSERT(finite(q));
                }
                // a coordinate that is not finite comes back as it is
                RC_ASSERT(std::isfinite(p.x) || same_bits(q.x, p.x) || std::isnan(p.x));
                RC_ASSERT(std::isnan(p.x) == std::isnan(q.x));
                RC_ASSERT(std::isnan(p.y) == std::isnan(q.y));
            }
            RC_ASSERT(finite(warp_offset(rows.view(), columns.view(), p)));
            const glm::mat<2, 2, T> j = jacobian(rows.view(), columns.view(), p);
            RC_ASSERT(finite(j[0]));
            RC_ASSERT(finite(j[1]));
            const row_blend<T> blend = blend_rows(p.x, rows.rows);
            RC_ASSERT(blend.row0 >= 0);
            RC_ASSERT(blend.row1 >= blend.row0);
            RC_ASSERT(blend.row1 < rows.rows);
            RC_ASSERT(blend.weight >= T(0));
            RC_ASSERT(blend.weight < T(1));
            const row_blend<T> one = floor_row(p.x, rows.rows);
            RC_ASSERT(one.row0 >= 0);
            RC_ASSERT(one.row0 < rows.rows);
        }
    }));
}

TEMPLATE_TEST_CASE("tables that do not increase still give finite answers", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        owned_table<T> rows(d.size(32), d.size(4));
        owned_table<T> columns(d.size(32), d.size(4));
        for (owned_table<T>* table : {&rows, &columns}) {
            for (T& node : table->nodes) {
                node = static_cast<T>(d.between(0, 4)) / T(4); // many equal ones
            }
        }
        for (int i = 0; i < 40; ++i) {
            const glm::vec<2, T> p(static_cast<T>(d.between(-0.5, 1.5)),
                                   static_cast<T>(d.between(-0.5, 1.5)));
            RC_ASSERT(finite(warp(rows.view(), columns.view(), p)));
            RC_ASSERT(finite(unwarp(rows.view(), columns.view(), p)));
        }
    }));
}
