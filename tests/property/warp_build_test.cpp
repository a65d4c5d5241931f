// Properties of warpshadow/warp_build.hpp.
//
// A node is computed in double: v = 2^-53. With x = k / cells and q = (F - x) / (1 - floor), the
// roundings are: x (v x), the count before and the total if beyond 2^53 (2v |q|), the fraction
// (v / total), difference and quotient (2v |q|), 1 - floor and the product (2v |q|), the sum (v F).
// That is at most v (6 |q| + x + F + 1 / total) <= 9v. Then the node is rounded to what is stored.
#include "warp_oracle.hpp"

#include <warpshadow/warp_build.hpp>

#include <catch2/catch.hpp>
#include <glm/vec2.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

using namespace warpshadow;
using namespace warp_test;

namespace {

const double node_error = 9.0 * 0x1p-53;

template <typename T> using points = std::vector<glm::vec<2, T>>;

template <typename T> std::span<const glm::vec<2, T>> span_of(const points<T>& p) {
    return p;
}

/// Tables of one axis with memory of exactly their size.
template <typename T, typename Node> struct built_axis {
    std::vector<std::uint64_t> scratch;
    std::vector<Node> nodes;
    int cells;
    int rows;
    build_result<T> result;

    built_axis(const owned_counts& counts, const build_options<T>& options)
        : scratch(static_cast<std::size_t>(counts.width)),
          nodes((static_cast<std::size_t>(counts.width) + 1) *
                static_cast<std::size_t>(counts.height)),
          cells(counts.width), rows(counts.height),
          result(build_axis<T, Node>(counts.view(), options, scratch,
                                     table_span<T, Node>{nodes, cells, rows})) {}

    [[nodiscard]] Node at(int row, int k) const {
        return nodes[static_cast<std::size_t>(row) * (static_cast<std::size_t>(cells) + 1) +
                     static_cast<std::size_t>(k)];
    }
    [[nodiscard]] table_view<T, Node> view() const { return {nodes, cells, rows}; }
};

/// Stored value of 1.
template <typename Node> constexpr Node one() {
    return std::is_integral_v<Node> ? std::numeric_limits<Node>::max() : Node(1);
}

/// Half the spacing of stored numbers around a value of [0, 1], in units of [0, 1].
template <typename Node> double half_step(double value) {
    if constexpr (std::is_integral_v<Node>) {
        return 0.5 / static_cast<double>(one<Node>());
    } else if constexpr (std::is_same_v<Node, float>) {
        int exponent = 0;
        std::frexp(value, &exponent);
        return value > 0.0 ? std::ldexp(1.0, exponent - 25) : 0.0;
    } else {
        return 0.0; // the last sum is in double already
    }
}

template <typename Node> rational stored_value(Node node) {
    if constexpr (std::is_integral_v<Node>) {
        return rational(integer(node), integer(one<Node>()));
    } else {
        return rational(node);
    }
}

/// F(k / cells) from the exact count before k.
rational exact_node(const integer& before, const integer& total, int k, int cells,
                    const rational& floor) {
    const rational x(k, cells);
    return total == 0 ? x : floor * x + (1 - floor) * rational(before, total);
}

/// Sums of the rows within `radius` of `centre`, added one by one.
std::vector<integer> direct_sums(const owned_counts& c, int centre, int radius) {
    std::vector<integer> sums(static_cast<std::size_t>(c.width), 0);
    for (int y = 0; y < c.height; ++y) {
        for (int i = 0; i < c.width && std::abs(y - centre) <= radius; ++i) {
            sums[static_cast<std::size_t>(i)] += c.at(i, y);
        }
    }
    return sums;
}

/// Whether every function starts at 0, ends at 1 and increases from node to node.
template <typename T, typename Node> std::string fault_of(const built_axis<T, Node>& axis) {
    for (int row = 0; row < axis.rows; ++row) {
        const Node* f = axis.nodes.data() +
                        static_cast<std::size_t>(row) * (static_cast<std::size_t>(axis.cells) + 1);
        if (f[0] != Node(0) || f[axis.cells] != one<Node>()) {
            return "an end is not exact";
        }
        for (int k = 0; k < axis.cells; ++k) {
            if (!(f[k + 1] > f[k])) {
                return "no increase at node " + std::to_string(k) + " of row " +
                       std::to_string(row);
            }
        }
    }
    return {};
}

/// View samples of a scene: a ground seen in perspective, some dense objects, a little noise.
template <typename T> points<T> scene_samples(dice& d, int count) {
    points<T> samples;
    samples.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        double u = d.unit();
        double v = d.unit();
        const int kind = d.between(0, 9);
        if (kind < 6) {
            // distance along v falls off with the square: most samples are near the eye
            const double depth = 0.02 / (0.02 + 0.98 * v);
            u = 0.5 + (u - 0.5) * (0.05 + 0.9 * depth);
            v = depth;
        } else if (kind < 9) {
            u = 0.3 + 0.05 * (kind - 6) + 0.02 * (u - 0.5);
            v = 0.2 + 0.2 * (kind - 6) + 0.03 * (v - 0.5);
        }
        samples.push_back({static_cast<T>(u), static_cast<T>(v)});
    }
    return samples;
}

/// Both tables of a warp and their memory, exactly as large as needed.
template <typename T, typename Node = T> struct built_warp {
    std::vector<std::uint32_t> counts;
    std::vector<std::uint64_t> scratch;
    std::vector<Node> row_nodes;
    std::vector<Node> column_nodes;
    warp_result<T, Node> result;

    built_warp(const points<T>& samples, int size, const build_options<T>& options) {
        const auto n = static_cast<std::size_t>(size);
        counts.resize(n * n);
        scratch.resize(n);
        row_nodes.resize(n * (n + 1));
        column_nodes.resize(n * (n + 1));
        result = build_warp<T, Node>(
            samples, options, warp_memory<T, Node>{size, counts, scratch, row_nodes, column_nodes});
    }
};

template <typename T> build_options<T> options_of(double window, double floor) {
    build_options<T> options;
    options.window = static_cast<T>(window);
    options.floor = static_cast<T>(floor);
    return options;
}

template <typename T, typename Node> struct stored {
    using type = T;
    using node = Node;
};

using float_in_float = stored<float, float>;
using float_in_16_bits = stored<float, std::uint16_t>;
using double_in_float = stored<double, float>;
using double_in_double = stored<double, double>;
using double_in_16_bits = stored<double, std::uint16_t>;

} // namespace

// -------------------------------------------------------------------------------- values of nodes

TEMPLATE_TEST_CASE("a node is the exact value rounded once, for counts up to 2^32 - 1", "",
                   float_in_float, float_in_16_bits, double_in_float, double_in_double,
                   double_in_16_bits) {
    using T = typename TestType::type;
    using Node = typename TestType::node;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(4096);
        const int height = d.size(std::clamp(20000 / width, 1, 40));
        const owned_counts c = any_counts(d, width, height);
        const build_options<T> options = options_of<T>(d.between(0.0, 2.0), d.unit());
        const built_axis<T, Node> axis(c, options);
        RC_ASSERT(!any(axis.result.flags,
                       status::invalid_input | status::out_of_range | status::buffer_too_small));
        const int radius = window_radius(options.window, height);
        const rational floor_used = rational(axis.result.floor);
        for (int i = 0; i < 4; ++i) {
            const int row = d.between(0, height - 1);
            const std::vector<integer> sums = direct_sums(c, row, radius);
            integer total = 0;
            for (const integer& n : sums) {
                total += n;
            }
            const int stride = std::max(1, width / 40);
            integer before = 0;
            for (int k = 0; k <= width; ++k) {
                if (k % stride == 0 || k == width) {
                    const rational exact = exact_node(before, total, k, width, floor_used);
                    const double allowed = half_step<Node>(static_cast<double>(exact)) + node_error;
                    RC_ASSERT(abs(stored_value(axis.at(row, k)) - exact) <= rational(allowed));
                }
                if (k < width) {
                    before += sums[static_cast<std::size_t>(k)];
                }
            }
        }
    }));
}

TEMPLATE_TEST_CASE("J34: one cell of 2^25 among ones: every node within 2e-4 texel", "", float,
                   double) {
    using T = TestType;
    for (const int heavy : {0, 1, 2048, 4095}) {
        owned_counts c(4096, 1);
        std::fill(c.counts.begin(), c.counts.end(), 1u);
        c.at(heavy, 0) = 1u << 25;
        const built_axis<T, T> axis(c, options_of<T>(0.0, 0.02));
        const integer total = (1 << 25) + 4095;
        double largest = 0.0;
        for (int k = 0; k <= 4096; ++k) {
            const integer before = k > heavy ? integer((1 << 25) + k - 1) : integer(k);
            const rational exact = exact_node(before, total, k, 4096, rational(axis.result.floor));
            largest = std::max(largest,
                               static_cast<double>(abs(rational(axis.at(0, k)) - exact)) * 4096.0);
        }
        INFO("largest error in texels: " << largest);
        REQUIRE(largest <= 2e-4);
    }
}

TEMPLATE_TEST_CASE("J33: warp_node in 32 bits is exact before its roundings, as a shader needs it",
                   "", float, double) {
    using T = TestType;
    const double u = roundoff<T>();
    REQUIRE(rc::check([u] {
        dice d = any_dice();
        const int cells = d.coin() ? 32768 : d.size(32768);
        const int k = d.between(0, cells);
        std::uint32_t total = d.coin() ? largest_count : static_cast<std::uint32_t>(d.bits());
        total >>= d.coin() ? 0 : d.between(0, 31);
        const std::uint32_t before =
            k == 0 ? 0u
            : k == cells || total == 0
                ? total
                : static_cast<std::uint32_t>(d.bits() % (std::uint64_t(total) + 1));
        const T floor = static_cast<T>(d.unit());
        const T node = warp_node<T, std::uint32_t>(before, total, k, cells, floor);
        const rational exact = exact_node(before, total, k, cells, rational(floor));
        // the bound at the head of this file, with u in place of v
        RC_ASSERT(abs(rational(node) - exact) <= rational(9.0 * u));
        // the same in 64 bits
        RC_ASSERT((node == warp_node<T, std::uint64_t>(before, total, k, cells, floor)));
    }));
}

// ------------------------------------------------------------------------------------- uniform

TEMPLATE_TEST_CASE("peers 25: uniform counts give k / w and warp(p) == p to the bit, w = 1 to 4096",
                   "", float, double) {
    using T = TestType;
    dice d(42);
    const std::uint32_t counts[] = {
        1u, 2u, 3u, 7u, 1u << 24, (1u << 24) + 1, 1u << 25, largest_count - 1, largest_count};
    for (int width = 1; width <= 4096; ++width) {
        const int which = d.between(0, 11);
        const std::uint32_t count =
            which < 9 ? counts[which] : static_cast<std::uint32_t>(d.bits());
        const int height = width <= 64 ? d.between(1, 5) : 1;
        owned_counts c(width, height);
        std::fill(c.counts.begin(), c.counts.end(), count);
        const built_axis<T, T> axis(c, options_of<T>(d.unit(), d.between(0.01, 1.0)));
        bool exact = true;
        for (int row = 0; row < height; ++row) {
            for (int k = 0; k <= width; ++k) {
                exact = exact && axis.at(row, k) == T(k) / T(width);
            }
        }
        CAPTURE(width, count);
        REQUIRE(exact);
        for (int i = 0; i < 4; ++i) {
            const glm::vec<2, T> p(static_cast<T>(d.unit()), static_cast<T>(d.unit()));
            REQUIRE(warp(axis.view(), axis.view(), p) == p);
            REQUIRE(unwarp(axis.view(), axis.view(), p) == p);
        }
    }
}

TEMPLATE_TEST_CASE("uniform samples give the identity through build_warp", "", float, double) {
    using T = TestType;
    for (const int size : {1, 2, 3, 5, 16, 100}) {
        points<T> samples;
        for (int j = 0; j < size; ++j) {
            for (int i = 0; i < size; ++i) {
                samples.push_back({(T(i) + T(0.5)) / T(size), (T(j) + T(0.5)) / T(size)});
            }
        }
        const built_warp<T> built(samples, size, build_options<T>{});
        CAPTURE(size);
        REQUIRE(built.result.flags == status::ok);
        dice d(3);
        for (int i = 0; i < 100; ++i) {
            const glm::vec<2, T> p(static_cast<T>(d.unit()), static_cast<T>(d.unit()));
            REQUIRE(warp(built.result.rows, built.result.columns, p) == p);
        }
    }
}

// --------------------------------------------------------------------------- monotone, exact ends

TEMPLATE_TEST_CASE(
    "J30, J37: ends exact and strictly increasing at the reported floor, all w to 4096", "",
    float_in_float, double_in_double, double_in_16_bits) {
    using T = typename TestType::type;
    using Node = typename TestType::node;
    dice d(4711);
    for (int width = 1; width <= 4096; ++width) {
        const owned_counts c = any_counts(d, width, 1);
        // 0 asks for the smallest floor there is; the extremes often
        const double floor = d.between(0, 2) == 0 ? d.unit() : 0.0;
        const built_axis<T, Node> axis(c, options_of<T>(0.0, floor));
        const std::string fault = fault_of(axis);
        CAPTURE(width, axis.result.floor, fault);
        REQUIRE(fault.empty());
        REQUIRE(double(axis.result.floor) >= floor * (1.0 - 1e-7));
        REQUIRE(any(axis.result.flags, status::floor_raised) ==
                (static_cast<T>(floor) < smallest_floor<T, Node>(width)));
    }
}

TEMPLATE_TEST_CASE("maps of many rows: ends exact and strictly increasing, every window", "",
                   float_in_float, float_in_16_bits, double_in_float, double_in_double,
                   double_in_16_bits) {
    using T = typename TestType::type;
    using Node = typename TestType::node;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(4096);
        const int height = d.size(std::clamp(16384 / width, 1, 4096));
        const owned_counts c = any_counts(d, width, height);
        const built_axis<T, Node> axis(
            c, options_of<T>(d.between(0.0, 2.0), d.coin() ? 0.0 : d.unit()));
        RC_ASSERT(fault_of(axis) == std::string());
    }));
}

// Two spikes at the ends leave a long flat part between them, where only the floor is left and the
// rounding of the nodes has every chance to undo it.
TEMPLATE_TEST_CASE("smallest_floor: stored functions still increase where no sample is", "",
                   float_in_float, float_in_16_bits, double_in_float, double_in_double,
                   double_in_16_bits) {
    using T = typename TestType::type;
    using Node = typename TestType::node;
    dice d(99);
    for (int i = 0; i < 3000; ++i) {
        const int width = i % 16 == 0 ? d.size(4096) : d.between(2, 300);
        owned_counts c(width, 1);
        c.at(0, 0) = static_cast<std::uint32_t>(d.between(1, 9));
        c.at(width - 1, 0) = static_cast<std::uint32_t>(d.between(1, 9));
        c.at(d.between(0, width - 1), 0) +=
            d.coin() ? static_cast<std::uint32_t>(d.bits() >> 33) : 0u;
        const built_axis<T, Node> axis(c, options_of<T>(0.0, 0.0));
        const std::string fault = fault_of(axis);
        CAPTURE(width, c.at(0, 0), c.at(width - 1, 0), fault);
        REQUIRE(axis.result.flags == status::floor_raised);
        REQUIRE(axis.result.floor == smallest_floor<T, Node>(width));
        REQUIRE(fault.empty());
    }
}

TEMPLATE_TEST_CASE("J32, J30: a single sample, and all samples in one cell", "", float, double) {
    using T = TestType;
    for (const int width : {1, 2, 3, 1000, 4095, 4096}) {
        for (const std::uint32_t n : {1u, 4096u, largest_count}) {
            for (const int where : {0, width / 2, width - 1}) {
                owned_counts c(width, 1);
                c.at(where, 0) = n;
                const built_axis<T, T> axis(c, options_of<T>(0.0, 0.25));
                CAPTURE(width, n, where);
                REQUIRE(fault_of(axis) == std::string());
                REQUIRE(axis.result.floor == T(0.25));
                // floor / w everywhere, and the whole rest in the one cell
                for (int k = 0; k < width; ++k) {
                    const double step = double(axis.at(0, k + 1)) - double(axis.at(0, k));
                    const double expected = 0.25 / width + (k == where ? 0.75 : 0.0);
                    // two nodes in [0, 1], each within half a step of storage
                    REQUIRE(std::abs(step - expected) <= 2.0 * (half_step<T>(1.0) + node_error));
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE("peers 27: floor 1 is the identity, floor 0 is raised", "", float, double) {
    using T = TestType;
    dice d(5);
    for (int i = 0; i < 50; ++i) {
        const int width = d.size(500);
        const owned_counts c = any_counts(d, width, d.size(5));
        const built_axis<T, T> identity(c, options_of<T>(0.3, 1.0));
        for (int row = 0; row < c.height; ++row) {
            for (int k = 0; k <= width; ++k) {
                REQUIRE(identity.at(row, k) == T(k) / T(width));
            }
        }
        const built_axis<T, T> raised(c, options_of<T>(0.3, 0.0));
        REQUIRE(raised.result.floor == smallest_floor<T, T>(width));
        REQUIRE(any(raised.result.flags, status::floor_raised));
    }
}

// -------------------------------------------------------------------------- empty rows, empty maps

TEMPLATE_TEST_CASE(
    "J31, peers 23, peers 26: rows without a sample and an empty map are the identity", "", float,
    double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(300);
        const int height = d.size(40);
        owned_counts c = any_counts(d, width, height);
        for (int y = 0; y < height; ++y) {
            for (int i = 0; i < width && y % 3 != 0; ++i) {
                c.at(i, y) = 0;
            }
        }
        const int radius = d.between(0, 1);
        // a window of 2 radius / height covers exactly that radius
        const built_axis<T, T> axis(c, options_of<T>((2.0 * radius + 0.5) / height, d.unit()));
        RC_ASSERT(window_radius(static_cast<T>((2.0 * radius + 0.5) / height), height) == radius);
        integer samples = 0;
        int empty = 0;
        for (int y = 0; y < height; ++y) {
            integer total = 0;
            for (const integer& n : direct_sums(c, y, radius)) {
                total += n;
            }
            for (int i = 0; i < width; ++i) {
                samples += c.at(i, y);
            }
            if (total == 0) {
                ++empty;
                for (int k = 0; k <= width; ++k) {
                    RC_ASSERT(axis.at(y, k) == T(k) / T(width));
                }
            }
        }
        RC_ASSERT(axis.result.empty_rows == empty);
        RC_ASSERT(integer(axis.result.samples) == samples);
        RC_ASSERT(any(axis.result.flags, status::empty_importance) == (samples == 0));
        RC_ASSERT(any(axis.result.flags, status::empty_rows) == (samples != 0 && empty != 0));
    }));
    const built_warp<T> nothing({}, 37, build_options<T>{});
    REQUIRE(nothing.result.flags == status::empty_importance);
    const glm::vec<2, T> p(T(0.3), T(0.71));
    REQUIRE(warp(nothing.result.rows, nothing.result.columns, p) == p);
}

TEMPLATE_TEST_CASE("J37: maps of one row, of one column, and of one cell", "", float, double) {
    using T = TestType;
    dice d(8);
    for (const int n : {1, 2, 3, 1000, 4096}) {
        CAPTURE(n);
        const owned_counts row = any_counts(d, n, 1);
        REQUIRE(fault_of(built_axis<T, T>(row, options_of<T>(2.0, 0.1))) == std::string());
        const owned_counts column = any_counts(d, 1, n);
        const built_axis<T, T> one_cell(column, options_of<T>(0.1, 0.1));
        // a function of one cell can only be the identity
        for (int y = 0; y < n; ++y) {
            REQUIRE(one_cell.at(y, 0) == T(0));
            REQUIRE(one_cell.at(y, 1) == T(1));
        }
        const glm::vec<2, T> p(T(0.3), T(0.6));
        REQUIRE(warp(one_cell.view(), one_cell.view(), p) == p);
    }
}

TEMPLATE_TEST_CASE("J40: a window over all rows gives one function, the rectilinear limit", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int width = d.size(200);
        const owned_counts c = any_counts(d, width, d.size(60));
        const built_axis<T, T> axis(c, options_of<T>(2.0, d.unit()));
        for (int row = 1; row < c.height; ++row) {
            for (int k = 0; k <= width; ++k) {
                RC_ASSERT(axis.at(row, k) == axis.at(0, k));
            }
        }
        RC_ASSERT(fault_of(axis) == std::string());
    }));
}

// -------------------------------------------------------------------------------- sixteen bits

TEMPLATE_TEST_CASE("J39: sixteen bits: the floor is raised, the error stays under 1/16 texel", "",
                   float, double) {
    using T = TestType;
    dice d(17);
    for (const int width : {1, 2, 1000, 2048, 4095, 4096, 8192}) {
        const owned_counts c = any_counts(d, width, 3);
        const built_axis<T, std::uint16_t> coarse(c, options_of<T>(0.5, 0.001));
        CAPTURE(width);
        REQUIRE(coarse.result.floor >= T(width) / T(65535));
        REQUIRE(any(coarse.result.flags, status::floor_raised) == (width > 65));
        REQUIRE(fault_of(coarse) == std::string());
        // the same functions in double
        build_options<double> same = options_of<double>(0.5, 0.0);
        same.floor = double(coarse.result.floor);
        const built_axis<double, double> fine(c, same);
        double largest = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const double across = d.unit();
            const double x = d.unit();
            const double exact = x + axis_offset(fine.view(), blend_rows(across, fine.rows), x);
            const auto xt = static_cast<T>(x);
            const double rounded =
                double(xt) +
                double(axis_offset(coarse.view(), blend_rows(static_cast<T>(across), coarse.rows),
                                   xt));
            largest = std::max(largest, std::abs(rounded - exact) * width);
        }
        INFO("largest error in texels: " << largest);
        if (width <= 4096 && std::is_same_v<T, double>) {
            // half a step of 1/65535
            REQUIRE(largest <= 0.5 / 65535.0 * width * (1.0 + 1e-6));
            REQUIRE(largest <= 1.0 / 16.0);
        }
        if (std::is_same_v<T, float>) {
            // x itself is rounded by up to 2^-25, which the steepest cell of slope w magnifies
            REQUIRE(largest <= (0.5 / 65535.0 + 0x1p-25 * (width + 32.0)) * width);
        }
    }
    // no floor below 1 is left: the identity, in the steps there are
    REQUIRE(smallest_floor<T, std::uint16_t>(65536) > T(1));
    const owned_counts wide = any_counts(d, 65536, 1);
    const built_axis<T, std::uint16_t> flat(wide, options_of<T>(0.0, 0.2));
    REQUIRE(flat.result.floor == T(1));
    REQUIRE(any(flat.result.flags, status::floor_raised));
    REQUIRE(flat.at(0, 0) == 0);
    REQUIRE(flat.at(0, 65536) == 65535);
    bool monotone = true;
    for (int k = 0; k < 65536; ++k) {
        monotone = monotone && flat.at(0, k + 1) >= flat.at(0, k);
    }
    REQUIRE(monotone);
}

// -------------------------------------------------------------------------------- options, status

TEMPLATE_TEST_CASE("options that are no options: clamped or replaced by the default, and reported",
                   "", float, double) {
    using T = TestType;
    using limits = std::numeric_limits<T>;
    dice d(23);
    const owned_counts c = [&] {
        owned_counts counts(50, 20);
        for (std::uint32_t& n : counts.counts) {
            n = static_cast<std::uint32_t>(d.between(1, 100));
        }
        return counts;
    }();
    const auto build = [&](T window, T floor) {
        build_options<T> options;
        options.window = window;
        options.floor = floor;
        return built_axis<T, T>(c, options);
    };
    const T window = build_options<T>{}.window;
    const T floor = build_options<T>{}.floor;
    const built_axis<T, T> plain = build(window, floor);
    REQUIRE(plain.result.flags == status::ok);
    REQUIRE(plain.result.floor == floor);
    REQUIRE(plain.result.empty_rows == 0);

    const auto expect = [&](const built_axis<T, T>& actual, const built_axis<T, T>& same,
                            status flags) {
        REQUIRE(actual.nodes == same.nodes);
        REQUIRE(actual.result.floor == same.result.floor);
        REQUIRE(actual.result.flags == flags);
        REQUIRE(actual.result.samples == same.result.samples);
    };
    expect(build(window, limits::quiet_NaN()), plain, status::invalid_input);
    expect(build(limits::quiet_NaN(), floor), plain, status::invalid_input);
    expect(build(limits::quiet_NaN(), limits::quiet_NaN()), plain, status::invalid_input);
    const built_axis<T, T> one_floor = build(window, T(1));
    REQUIRE(one_floor.result.flags == status::ok);
    expect(build(window, T(1.5)), one_floor, status::out_of_range);
    expect(build(window, limits::infinity()), one_floor, status::out_of_range);
    const built_axis<T, T> least = build(window, T(0));
    REQUIRE(least.result.flags == status::floor_raised);
    expect(build(window, T(-0.0)), least, status::floor_raised);
    expect(build(window, T(-0.1)), least, status::out_of_range | status::floor_raised);
    expect(build(window, -limits::infinity()), least, status::out_of_range | status::floor_raised);
    const built_axis<T, T> narrow = build(T(0), floor);
    REQUIRE(narrow.result.flags == status::ok);
    expect(build(T(-0.5), floor), narrow, status::out_of_range);
    expect(build(-limits::infinity(), floor), narrow, status::out_of_range);
    const built_axis<T, T> wide = build(T(2), floor);
    REQUIRE(wide.result.flags == status::ok);
    expect(build(T(2.5), floor), wide, status::out_of_range);
    expect(build(limits::infinity(), floor), wide, status::out_of_range);
    REQUIRE(narrow.nodes != wide.nodes);
    REQUIRE(narrow.nodes != plain.nodes);
}

TEMPLATE_TEST_CASE("build_axis: a size that does not match: buffer_too_small, nothing written", "",
                   float, double) {
    using T = TestType;
    std::vector<std::uint32_t> counts(12, 1u);
    const auto attempt = [&](const count_view& view, std::size_t scratch_size, int cells, int rows,
                             std::size_t node_count) {
        std::vector<std::uint64_t> scratch(scratch_size, 77u);
        std::vector<T> nodes(node_count, T(77));
        const build_result<T> result =
            build_axis<T, T>(view, build_options<T>{}, scratch, table_span<T>{nodes, cells, rows});
        const bool untouched = std::count(nodes.begin(), nodes.end(), T(77)) ==
                                   static_cast<std::ptrdiff_t>(nodes.size()) &&
                               std::count(scratch.begin(), scratch.end(), 77u) ==
                                   static_cast<std::ptrdiff_t>(scratch.size());
        if (result.flags == status::buffer_too_small) {
            REQUIRE(untouched);
            REQUIRE(result.samples == 0);
            REQUIRE(result.empty_rows == 0);
            REQUIRE(result.floor == T(0));
            return false;
        }
        REQUIRE_FALSE(untouched);
        return true;
    };
    REQUIRE(attempt({counts, 4, 3}, 4, 4, 3, 15));
    REQUIRE_FALSE(attempt({counts, 4, 3}, 3, 4, 3, 15));
    REQUIRE_FALSE(attempt({counts, 4, 3}, 4, 4, 3, 14));
    REQUIRE_FALSE(attempt({counts, 4, 3}, 4, 3, 3, 15));
    REQUIRE_FALSE(attempt({counts, 4, 3}, 4, 4, 2, 15));
    REQUIRE_FALSE(attempt({counts, 4, 4}, 4, 4, 4, 20));
    REQUIRE_FALSE(attempt({counts, 0, 3}, 4, 0, 3, 15));
    REQUIRE_FALSE(attempt({counts, 4, 0}, 4, 4, 0, 15));
    REQUIRE_FALSE(attempt({counts, -1, -1}, 4, -1, -1, 15));
    REQUIRE_FALSE(attempt({counts, -4, 3}, 4, -4, 3, 15));
    const int huge = std::numeric_limits<int>::max();
    REQUIRE_FALSE(attempt({counts, huge, huge}, 4, huge, huge, 15));
    REQUIRE_FALSE(attempt({}, 4, 0, 0, 15));

    // what lies behind the table is not touched
    std::vector<std::uint64_t> scratch(6, 77u);
    std::vector<T> nodes(17, T(77));
    build_axis<T, T>(count_view(counts, 4, 3), build_options<T>{}, scratch,
                     table_span<T>{nodes, 4, 3});
    REQUIRE(nodes[14] == T(1));
    REQUIRE(nodes[15] == T(77));
    REQUIRE(nodes[16] == T(77));
    REQUIRE(scratch[4] == 77u);
}

TEMPLATE_TEST_CASE("build_warp: too little memory: nothing written, and the result is the identity",
                   "", float, double) {
    using T = TestType;
    const points<T> samples(9, glm::vec<2, T>(T(0.1), T(0.2)));
    const auto attempt = [&](int size, std::size_t n_counts, std::size_t n_scratch,
                             std::size_t n_rows, std::size_t n_columns) {
        std::vector<std::uint32_t> counts(n_counts, 77u);
        std::vector<std::uint64_t> scratch(n_scratch, 77u);
        std::vector<T> rows(n_rows, T(77));
        std::vector<T> columns(n_columns, T(77));
        const warp_result<T> result = build_warp<T, T>(
            samples, build_options<T>{}, warp_memory<T>{size, counts, scratch, rows, columns});
        const auto all = [](const auto& memory) {
            return std::count(memory.begin(), memory.end(), 77) ==
                   static_cast<std::ptrdiff_t>(memory.size());
        };
        if (result.flags == status::buffer_too_small) {
            REQUIRE(all(counts));
            REQUIRE(all(scratch));
            REQUIRE(all(rows));
            REQUIRE(all(columns));
            REQUIRE(result.splat.counted == 0);
            const glm::vec<2, T> p(T(0.3), T(0.7));
            REQUIRE(warp(result.rows, result.columns, p) == p);
            REQUIRE(unwarp(result.rows, result.columns, p) == p);
            return false;
        }
        REQUIRE_FALSE(all(rows));
        REQUIRE_FALSE(all(columns));
        return true;
    };
    REQUIRE(attempt(4, 16, 4, 20, 20));
    REQUIRE_FALSE(attempt(4, 15, 4, 20, 20));
    REQUIRE_FALSE(attempt(4, 16, 3, 20, 20));
    REQUIRE_FALSE(attempt(4, 16, 4, 19, 20));
    REQUIRE_FALSE(attempt(4, 16, 4, 20, 19));
    REQUIRE_FALSE(attempt(0, 16, 4, 20, 20));
    REQUIRE_FALSE(attempt(-4, 16, 4, 20, 20));
    REQUIRE_FALSE(attempt(std::numeric_limits<int>::max(), 16, 4, 20, 20));
    REQUIRE_FALSE(attempt(std::numeric_limits<int>::min(), 16, 4, 20, 20));
    // sixteen bits: the identity has their own 1
    const warp_result<T, std::uint16_t> coarse{};
    REQUIRE(warp(coarse.rows, coarse.columns, {T(0.3), T(0.7)}) == glm::vec<2, T>(T(0.3), T(0.7)));
}

// -------------------------------------------------------------------------------- build_warp

TEMPLATE_TEST_CASE("build_warp knows no order of samples and reports what it met", "", float,
                   double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int size = d.size(100);
        points<T> samples = scene_samples<T>(d, d.between(0, 500));
        const std::size_t good = samples.size();
        const int bad = d.between(0, 3);
        for (int i = 0; i < bad; ++i) {
            samples.push_back({T(0.5), std::numeric_limits<T>::quiet_NaN()});
        }
        const build_options<T> options = options_of<T>(d.between(0.0, 1.0), d.between(0.01, 1.0));
        const built_warp<T> first(samples, size, options);
        std::shuffle(samples.begin(), samples.end(), std::mt19937_64(d.bits()));
        const built_warp<T> second(samples, size, options);
        const bool same =
            first.row_nodes == second.row_nodes && first.column_nodes == second.column_nodes;
        RC_ASSERT(same);
        RC_ASSERT(first.result.splat.counted == good);
        RC_ASSERT(first.result.splat.rejected == static_cast<std::uint64_t>(bad));
        RC_ASSERT(any(first.result.flags, status::samples_rejected) == (bad != 0));
        RC_ASSERT(any(first.result.flags, status::empty_importance) == (good == 0));
        RC_ASSERT(!any(first.result.flags, status::invalid_input | status::out_of_range |
                                               status::count_overflow | status::floor_raised));
        RC_ASSERT(first.result.rows.nodes.data() == first.row_nodes.data());
        RC_ASSERT(first.result.columns.cells == size);
        RC_ASSERT(first.result.columns.rows == size);
    }));
}

TEMPLATE_TEST_CASE(
    "build_warp is splat, build_axis, splat_columns, build_axis, whatever memory held", "", float,
    double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int size = d.size(80);
        const points<T> samples = scene_samples<T>(d, d.between(1, 400));
        const build_options<T> options = options_of<T>(d.between(0.0, 1.0), d.between(0.01, 1.0));
        const auto n = static_cast<std::size_t>(size);
        std::vector<std::uint32_t> counts(n * n, 123u);
        std::vector<std::uint64_t> scratch(n, 456u);
        std::vector<T> row_nodes(n * (n + 1), T(7));
        std::vector<T> column_nodes(n * (n + 1), T(7));
        build_warp<T, T>(samples, options,
                         warp_memory<T>{size, counts, scratch, row_nodes, column_nodes});

        owned_counts by_row(size, size);
        splat(span_of(samples), by_row.map());
        const built_axis<T, T> rows(by_row, options);
        owned_counts by_column(size, size);
        splat_columns<T, T>(span_of(samples), rows.view(), by_column.map());
        const built_axis<T, T> columns(by_column, options);
        const bool same = row_nodes == rows.nodes && column_nodes == columns.nodes;
        RC_ASSERT(same);
    }));
}

TEMPLATE_TEST_CASE("any samples at all: the warp of a finite point is finite and in the square", "",
                   float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int size = d.size(60);
        points<T> samples;
        for (int i = 0; i < 60; ++i) {
            samples.push_back({any_coordinate<T>(d), any_coordinate<T>(d)});
        }
        const built_warp<T> built(samples, size,
                                  options_of<T>(d.between(0.0, 2.0), d.between(0.001, 1.0)));
        for (int i = 0; i < 60; ++i) {
            const glm::vec<2, T> p(any_coordinate<T>(d), any_coordinate<T>(d));
            const glm::vec<2, T> q = warp(built.result.rows, built.result.columns, p);
            RC_ASSERT(std::isfinite(p.x) == std::isfinite(q.x));
            RC_ASSERT(std::isfinite(p.y) == std::isfinite(q.y));
            if (p.x >= T(0) && p.x <= T(1)) {
                RC_ASSERT(q.x >= T(0));
                RC_ASSERT(q.x <= T(1) + std::numeric_limits<T>::epsilon());
            }
        }
    }));
}

TEMPLATE_TEST_CASE("splat_columns puts a sample in the column of its warped u", "", float, double) {
    using T = TestType;
    REQUIRE(rc::check([] {
        dice d = any_dice();
        const int cells = d.size(200);
        const owned_counts c = any_counts(d, cells, d.size(20));
        const built_axis<T, T> axis(c, options_of<T>(d.unit(), d.between(0.05, 1.0)));
        const int width = d.size(50);
        const int height = d.size(50);
        owned_counts all(width, height);
        points<T> samples;
        for (int i = 0; i < 50; ++i) {
            const glm::vec<2, T> p =
                d.between(0, 5) == 0
                    ? glm::vec<2, T>(T(d.between(0, 1)), T(d.between(0, 1)))
                    : glm::vec<2, T>(static_cast<T>(d.unit()), static_cast<T>(d.unit()));
            samples.push_back(p);
            owned_counts single(width, height);
            const splat_result result =
                splat_columns<T, T>(std::span(&p, 1), axis.view(), single.map());
            RC_ASSERT(result.counted == 1u);
            RC_ASSERT(result.flags == status::ok);
            const auto found = std::find(single.counts.begin(), single.counts.end(), 1u);
            RC_ASSERT(found != single.counts.end());
            const auto cell = static_cast<int>(found - single.counts.begin());
            const int column = cell / width;
            // v alone chooses along the row; U chooses the row, in double from the same nodes
            RC_ASSERT(cell % width == cell_of(p.y, width));
            const double position =
                std::clamp(double(p.y) * axis.rows - 0.5, 0.0, double(axis.rows - 1));
            const int row0 = static_cast<int>(position);
            const int row1 = std::min(row0 + 1, axis.rows - 1);
            const double weight = position - row0;
            const int k = std::min(static_cast<int>(double(p.x) * cells), cells - 1);
            const double share = double(p.x) * cells - k;
            const auto node = [&](int n) {
                return (1.0 - weight) * double(axis.at(row0, n)) +
                       weight * double(axis.at(row1, n));
            };
            const double warped = (1.0 - share) * node(k) + share * node(k + 1);
            // rounding of T, with the slope of at most `cells` and steps of at most `rows`
            const double error = roundoff<T>() * (10.0 + cells + 2.0 * axis.rows) + 1e-13;
            RC_ASSERT(column >= std::floor(std::max(0.0, warped - error) * height) - 0.0);
            RC_ASSERT(column <=
                      std::min(double(height - 1), std::floor((warped + error) * height)));
        }
        const std::size_t inside = samples.size();
        samples.push_back({T(-1e-9), T(0.5)});
        samples.push_back({T(0.5), std::numeric_limits<T>::infinity()});
        samples.push_back({std::numeric_limits<T>::quiet_NaN(), T(0.5)});
        const splat_result result = splat_columns<T, T>(span_of(samples), axis.view(), all.map());
        RC_ASSERT(result.counted == inside);
        RC_ASSERT(result.rejected == 3u);
        RC_ASSERT(result.flags == status::samples_rejected);
        std::uint64_t sum = 0;
        for (const std::uint32_t n : all.counts) {
            sum += n;
        }
        RC_ASSERT(sum == inside);
    }));
}

TEMPLATE_TEST_CASE("splat_columns: guards of its map and its table, and the full counter", "",
                   float, double) {
    using T = TestType;
    const points<T> samples(3, glm::vec<2, T>(T(0.9), T(0.1)));
    const T nodes[] = {T(0), T(1)};
    const table_view<T> identity{nodes, 1, 1};
    std::vector<std::uint32_t> memory(6, 77u);
    const auto untouched = [&] { return memory == std::vector<std::uint32_t>(6, 77u); };
    for (const count_map& map : {count_map{memory, 7, 1}, count_map{memory, 0, 1},
                                 count_map{memory, 1, -1}, count_map{}}) {
        const splat_result result = splat_columns<T, T>(span_of(samples), identity, map);
        REQUIRE(result.flags == status::buffer_too_small);
        REQUIRE(result.rejected == 3);
        REQUIRE(result.counted == 0);
        REQUIRE(untouched());
    }
    for (const table_view<T>& table :
         {table_view<T>{}, table_view<T>{nodes, 0, 1}, table_view<T>{nodes, 1, 0},
          table_view<T>{nodes, 2, 1}, table_view<T>{nodes, 1, 2}, table_view<T>{nodes, -1, 1}}) {
        const splat_result result =
            splat_columns<T, T>(span_of(samples), table, count_map{memory, 2, 3});
        REQUIRE(result.flags == status::buffer_too_small);
        REQUIRE(result.rejected == 3);
        REQUIRE(untouched());
    }
    // transposed: row 2 of 3 is the column of u = 0.9, cell 0 of 2 that of v = 0.1
    std::fill(memory.begin(), memory.end(), 0u);
    memory[4] = largest_count - 1;
    const splat_result result =
        splat_columns<T, T>(span_of(samples), identity, count_map{memory, 2, 3});
    REQUIRE(result.flags == status::count_overflow);
    REQUIRE(memory == std::vector<std::uint32_t>{0u, 0u, 0u, 0u, largest_count, 0u});
}

// ---------------------------------------------------------------------------------- round trip
//
// What passes from `warp` to `unwarp` is a rounded number, off by up to u, and so is every number
// that comes back. With F' and G' the slopes of the row and column functions and X_v the shear of
// the row functions, that alone costs, in units of the map,
//
//     along v: c_v = u / G' + u,    along u: c_u = (u + X_v c_v) / F' + u.
//
// At w = 4096 and F' = 0.02 in float c_u is 0.01 texel before any shear: a thousandth of a texel
// is out of reach there, and so is a billionth in double where the shear is large as well. The
// bounds derived in warp_test.cpp are |error| <= 10 c_v and 14 c_u; `-s` prints what is measured.

namespace {

/// Row and column functions with memory of their own; `functions` of either, `cells` each.
template <typename T> struct built_pair {
    owned_counts row_counts;
    built_axis<T, T> rows;
    owned_counts column_counts;
    built_axis<T, T> columns;

    built_pair(const points<T>& samples, int cells, int functions, const build_options<T>& options)
        : row_counts(counted(samples, cells, functions)), rows(row_counts, options),
          column_counts(counted_columns(samples, rows.view(), cells, functions)),
          columns(column_counts, options) {}

    static owned_counts counted(const points<T>& samples, int cells, int functions) {
        owned_counts c(cells, functions);
        splat(span_of(samples), c.map());
        return c;
    }
    static owned_counts counted_columns(const points<T>& samples, const table_view<T>& rows,
                                        int cells, int functions) {
        owned_counts c(cells, functions);
        splat_columns<T, T>(span_of(samples), rows, c.map());
        return c;
    }
};

/// Errors of the round trips, in texels.
struct round_trip {
    double warped = 0.0;         ///< |warp(unwarp(q)) - q|, q even over the warped map
    double map = 0.0;            ///< |unwarp(warp(p)) - p|, p even over the map
    double ratio = 0.0;          ///< largest ratio of that to what the rounding of warp(p) costs
    double samples = 0.0;        ///< |unwarp(warp(p)) - p|, p a view sample
    double share = 0.0;          ///< share of samples with at most a thousandth of a texel
    double dense = 0.0;          ///< share of samples where the warp enlarges both axes
    double dense_share = 0.0;    ///< share of these with at most a thousandth of a texel
    double warped_samples = 0.0; ///< |warp(unwarp(warp(p))) - warp(p)|, p a view sample
};

template <typename T> double distance(const glm::vec<2, T>& a, const glm::vec<2, T>& b) {
    return std::max(std::abs(double(a.x) - double(b.x)), std::abs(double(a.y) - double(b.y)));
}

/// What rounding alone costs at a point, in units of the map: the smallest slopes and the largest
/// shear of the cells and rows around it.
template <typename T>
double rounding_cost(const table_view<T>& rows, const table_view<T>& columns,
                     const glm::vec<2, T>& p) {
    const T u = p.x + axis_offset(rows, blend_rows(p.y, rows.rows), p.x);
    double slope_u = std::numeric_limits<double>::infinity();
    double slope_v = slope_u;
    double shear = 0.0;
    for (int j = -1; j <= 1; ++j) {
        const T y = p.y + T(j) / T(rows.rows);
        const T column = u + T(j) / T(columns.rows);
        for (int i = -1; i <= 1; ++i) {
            const T x = p.x + T(i) / T(rows.cells);
            const T v = p.y + T(i) / T(columns.cells);
            slope_u = std::min(slope_u, double(axis_slope(rows, blend_rows(y, rows.rows), x)));
            slope_v =
                std::min(slope_v, double(axis_slope(columns, blend_rows(column, columns.rows), v)));
            shear = std::max(shear, std::abs(double(axis_shear(rows, y, x))));
        }
    }
    const double cost_v = roundoff<T>() * (1.0 / slope_v + 1.0);
    return std::max(cost_v, (roundoff<T>() + shear * cost_v) / slope_u + roundoff<T>());
}

/// Whether the warp enlarges both axes at a point.
template <typename T>
bool enlarged(const table_view<T>& rows, const table_view<T>& columns, const glm::vec<2, T>& p) {
    const row_blend<T> row = blend_rows(p.y, rows.rows);
    const T u = p.x + axis_offset(rows, row, p.x);
    return axis_slope(rows, row, p.x) >= T(1) &&
           axis_slope(columns, blend_rows(u, columns.rows), p.y) >= T(1);
}

template <typename T>
round_trip measure(const table_view<T>& rows, const table_view<T>& columns,
                   const points<T>& samples, int count) {
    dice d(77);
    round_trip worst;
    int below = 0;
    int dense = 0;
    int dense_below = 0;
    const double size = rows.cells;
    for (int i = 0; i < count; ++i) {
        const glm::vec<2, T> p(static_cast<T>(d.unit()), static_cast<T>(d.unit()));
        const double error = distance(unwarp(rows, columns, warp(rows, columns, p)), p);
        worst.map = std::max(worst.map, error * size);
        worst.ratio = std::max(worst.ratio, error / rounding_cost(rows, columns, p));
        const double warped = distance(warp(rows, columns, unwarp(rows, columns, p)), p);
        worst.warped = std::max(worst.warped, warped * size);

        const std::size_t which = d.bits() % samples.size();
        const glm::vec<2, T> q = warp(rows, columns, samples[which]);
        const glm::vec<2, T> back = unwarp(rows, columns, q);
        const double sample_error = distance(back, samples[which]) * size;
        worst.samples = std::max(worst.samples, sample_error);
        const bool is_dense = enlarged(rows, columns, samples[which]);
        below += sample_error <= 1e-3 ? 1 : 0;
        dense += is_dense ? 1 : 0;
        dense_below += is_dense && sample_error <= 1e-3 ? 1 : 0;
        worst.warped_samples =
            std::max(worst.warped_samples, distance(warp(rows, columns, back), q) * size);
    }
    worst.share = double(below) / count;
    worst.dense = double(dense) / count;
    worst.dense_share = double(dense_below) / std::max(dense, 1);
    return worst;
}

std::string report(const round_trip& r) {
    std::ostringstream text;
    text << "texels, largest: map " << r.map << " (" << r.ratio
         << " times the cost of rounding), warped map " << r.warped << ", samples " << r.samples
         << ", warped samples " << r.warped_samples << "; at most a thousandth: " << r.share
         << " of the samples, " << r.dense_share << " of those where both axes are enlarged ("
         << r.dense << ")";
    return text.str();
}

const double cost_factor = 14.0;

} // namespace

TEST_CASE("round trip of a full map of 4096 functions of 4096 cells at floor 0.02") {
    dice d(2024);
    const points<float> samples = scene_samples<float>(d, 200000);
    const built_warp<float> built(samples, 4096, options_of<float>(0.12, 0.02));
    REQUIRE(built.result.flags == status::ok);
    const round_trip r = measure(built.result.rows, built.result.columns, samples, 10000);
    INFO(report(r));
    REQUIRE(r.ratio <= cost_factor);
    // of the samples where the warp gives more of the map than a uniform one
    REQUIRE(r.dense >= 0.5);
    REQUIRE(r.dense_share >= 0.99);
}

TEMPLATE_TEST_CASE("round trip at w = 4096: window and floor decide what is left", "", float,
                   double) {
    using T = TestType;
    dice d(2025);
    const points<T> samples = scene_samples<T>(d, 100000);
    for (const double window : {0.12, 0.5, 2.0}) {
        for (const double floor : {0.02, 0.2}) {
            const built_pair<T> built(samples, 4096, 128, options_of<T>(window, floor));
            const round_trip r = measure<T>(built.rows.view(), built.columns.view(), samples, 4000);
            CAPTURE(window, floor);
            INFO(report(r));
            REQUIRE(r.ratio <= cost_factor);
            REQUIRE(r.dense_share >= 0.99);
            if (std::is_same_v<T, double>) {
                REQUIRE(r.samples <= 1e-9);
                REQUIRE(r.warped <= 1e-9);
                // everywhere in the map with the default floor, and with one function for all rows
                REQUIRE((r.map <= 1e-9 || (floor < 0.2 && window < 2.0)));
            }
        }
    }
}
