// Sets of points in the plane on which hulls and rectangles are known to go wrong, by class.
//
// Used by the tests of hull and calipers and by the table of failures in bench/.
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

namespace point_sets {

template <typename T> using points = std::vector<glm::vec<2, T>>;

/// A class of point sets: one set per seed.
struct kind {
    std::string_view name;
    bool finite; ///< false: each set holds a NaN or an infinity
    bool cited;  ///< true: points from a bug report, the same for every seed
};

inline constexpr std::array<kind, 25> kinds{{
    {"random", true, false},
    {"exactly collinear", true, false},
    {"rounded collinear", true, false},
    {"one to three points, all equal", true, false},
    {"every point five times", true, false},
    {"sliver 1e-5 to 1e-8", true, false},
    {"offset 1e6", true, false},
    {"offset 1e8", true, false},
    {"three almost collinear", true, false},
    {"regular polygons", true, false},
    {"rotated rectangles", true, false},
    {"rectangles jittered by ulps", true, false},
    {"integer grid 6x6", true, false},
    {"integer contour", true, false},
    {"a few ulps off a line", true, false},
    {"mixed scales", true, false},
    {"tiny 1e-22", true, false},
    {"huge 1e20", true, false},
    {"end of the range", true, false},
    {"one NaN", false, false},
    {"one infinity", false, false},
    {"opencv 21482", true, true},
    {"opencv 11915 24583 27667", true, true},
    {"shapely 1670, jts 907", true, true},
    {"R3Det 79", true, true},
}};

namespace detail {

template <typename T> glm::vec<2, T> rounded(double x, double y) {
    // Through memory of type T, one by one: see tests/compiler on rounding of adjacent values.
    volatile T a = static_cast<T>(x);
    volatile T b = static_cast<T>(y);
    return {a, b};
}

template <typename T> T some_ulps(T x, int ulps) {
    for (; ulps > 0; --ulps) {
        x = std::nextafter(x, std::numeric_limits<T>::max());
    }
    for (; ulps < 0; ++ulps) {
        x = std::nextafter(x, std::numeric_limits<T>::lowest());
    }
    return x;
}

} // namespace detail

/// One set of a class. The same class and seed give the same set.
template <typename T> points<T> make(std::string_view name, std::uint64_t seed) {
    using detail::rounded;
    std::mt19937_64 bits(seed * 0x9e3779b97f4a7c15u + 1);
    const auto real = [&](double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(bits() >> 11) * 0x1p-53);
    };
    const auto whole = [&](int lo, int hi) {
        return lo + static_cast<int>(bits() % static_cast<std::uint64_t>(hi - lo + 1));
    };
    points<T> set;
    const auto add = [&](double x, double y) { set.push_back(rounded<T>(x, y)); };
    const auto add_random = [&](int count, double scale, double at_x, double at_y) {
        const double shear = real(-1.0, 1.0);
        const double flat = real(0.1, 1.0);
        for (int i = 0; i < count; ++i) {
            const double x = real(-1.0, 1.0);
            const double y = flat * real(-1.0, 1.0) + shear * x;
            add(at_x + scale * x, at_y + scale * y);
        }
    };
    const auto add_rectangle = [&](double x, double y, double angle, double a, double b) {
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        for (const auto& [i, j] : {std::array{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            add(x + c * a * i - s * b * j, y + s * a * i + c * b * j);
        }
    };

    if (name == "random") {
        add_random(whole(3, 24), 10.0, 0.0, 0.0);
    } else if (name == "exactly collinear") {
        // Multiples of a short vector: exact at float too.
        const int x = whole(-31, 31);
        const int y = whole(-31, 31);
        const double unit = std::ldexp(1.0, whole(-8, 8));
        const int count = whole(2, 24);
        for (int i = 0; i < count; ++i) {
            const int k = whole(-1000, 1000);
            add(unit * (k * x + 7), unit * (k * y - 3));
        }
    } else if (name == "rounded collinear") {
        const double x = real(-10.0, 10.0);
        const double y = real(-10.0, 10.0);
        const double angle = real(0.0, 2.0 * std::numbers::pi);
        const int count = whole(2, 24);
        for (int i = 0; i < count; ++i) {
            const double t = real(-10.0, 10.0);
            add(x + t * std::cos(angle), y + t * std::sin(angle));
        }
    } else if (name == "one to three points, all equal") {
        const int distinct = whole(1, 3);
        const int copies = whole(1, 4);
        add_random(distinct, 10.0, 0.0, 0.0);
        const points<T> once = set;
        for (int i = 1; i < copies; ++i) {
            set.insert(set.end(), once.begin(), once.end());
        }
    } else if (name == "every point five times") {
        add_random(whole(3, 10), 10.0, 0.0, 0.0);
        const points<T> once = set;
        for (int i = 1; i < 5; ++i) {
            set.insert(set.end(), once.begin(), once.end());
        }
    } else if (name == "sliver 1e-5 to 1e-8") {
        const double width = std::pow(10.0, real(-8.0, -5.0));
        const double angle = real(0.0, 2.0 * std::numbers::pi);
        const int count = whole(4, 16);
        for (int i = 0; i < count; ++i) {
            const double t = real(-1.0, 1.0);
            const double s = width * real(-1.0, 1.0);
            add(t * std::cos(angle) - s * std::sin(angle),
                t * std::sin(angle) + s * std::cos(angle));
        }
    } else if (name == "offset 1e6" || name == "offset 1e8") {
        const double offset = name == "offset 1e6" ? 1e6 : 1e8;
        add_random(whole(4, 20), 100.0, offset * real(0.5, 1.0), offset * real(-1.0, -0.5));
    } else if (name == "three almost collinear") {
        const double x = real(-10.0, 10.0);
        const double y = real(-10.0, 10.0);
        for (const double t : {0.0, real(0.1, 0.9), 1.0}) {
            add(x * (2.0 * t - 1.0) + 1.0, y * (2.0 * t - 1.0) - 2.0);
        }
        T& moved = set[static_cast<std::size_t>(whole(0, 2))].y;
        moved = detail::some_ulps(moved, whole(-2, 2));
    } else if (name == "regular polygons") {
        const int corners = whole(3, 64);
        const double turn = real(0.0, 2.0 * std::numbers::pi);
        const double radius = real(0.5, 20.0);
        for (int i = 0; i < corners; ++i) {
            const double angle = turn + 2.0 * std::numbers::pi * i / corners;
            add(radius * std::cos(angle), radius * std::sin(angle));
        }
    } else if (name == "rotated rectangles") {
        add_rectangle(real(-5.0, 5.0), real(-5.0, 5.0), real(0.0, 2.0 * std::numbers::pi),
                      real(0.1, 5.0), real(0.1, 5.0));
    } else if (name == "rectangles jittered by ulps") {
        // Points along the sides too, so that sides are chains of almost collinear points.
        const double angle = whole(0, 1) == 0 ? 0.0 : real(0.0, 2.0 * std::numbers::pi);
        const double a = real(0.5, 5.0);
        const double b = real(0.5, 5.0);
        const double x = real(-5.0, 5.0);
        const double y = real(-5.0, 5.0);
        add_rectangle(x, y, angle, a, b);
        const points<T> corners = set;
        for (std::size_t i = 0; i < 4; ++i) {
            for (int k = whole(0, 3); k > 0; --k) {
                const double t = real(0.0, 1.0);
                const glm::vec<2, T>& p = corners[i];
                const glm::vec<2, T>& q = corners[(i + 1) % 4];
                add((1.0 - t) * double(p.x) + t * double(q.x),
                    (1.0 - t) * double(p.y) + t * double(q.y));
            }
            set.push_back(corners[i]);
        }
        for (glm::vec<2, T>& p : set) {
            p.x = detail::some_ulps(p.x, whole(-2, 2));
            p.y = detail::some_ulps(p.y, whole(-2, 2));
        }
    } else if (name == "integer grid 6x6") {
        const int count = whole(3, 30);
        for (int i = 0; i < count; ++i) {
            add(whole(0, 5), whole(0, 5));
        }
    } else if (name == "integer contour") {
        // The pixels along the outline of an ellipse, as an image library meets them.
        const double a = real(3.0, 60.0);
        const double b = real(3.0, 60.0);
        const double angle = real(0.0, std::numbers::pi);
        const int count = whole(8, 40);
        for (int i = 0; i < count; ++i) {
            const double t = 2.0 * std::numbers::pi * i / count;
            const double x = a * std::cos(t);
            const double y = b * std::sin(t);
            add(std::floor(x * std::cos(angle) - y * std::sin(angle) + 100.5),
                std::floor(x * std::sin(angle) + y * std::cos(angle) + 100.5));
        }
    } else if (name == "a few ulps off a line") {
        const double x = real(-500.0, 500.0);
        const double y = real(-500.0, 500.0);
        const double slope = real(-2.0, 2.0);
        const int count = whole(4, 8);
        for (int i = 0; i < count; ++i) {
            const double t = real(-500.0, 500.0);
            add(x + t, y + slope * t);
            T& moved = set.back().y;
            moved = detail::some_ulps(moved, whole(-3, 3));
        }
    } else if (name == "mixed scales") {
        const int count = whole(3, 16);
        for (int i = 0; i < count; ++i) {
            add(std::ldexp(real(-1.0, 1.0), whole(-40, 10)),
                std::ldexp(real(-1.0, 1.0), whole(-40, 10)));
        }
    } else if (name == "tiny 1e-22") {
        add_random(whole(3, 20), 1e-22, 0.0, 0.0);
    } else if (name == "huge 1e20") {
        add_random(whole(3, 20), 1e20, 0.0, 0.0);
    } else if (name == "end of the range") {
        // Squares of these lengths neither fit T nor, for T = double, any type at hand.
        const bool small = whole(0, 1) == 0;
        const bool single = std::numeric_limits<T>::digits == 24;
        const double scale = small ? (single ? 1e-37 : 1e-300) : (single ? 1e38 : 1e307);
        add_random(whole(3, 20), scale, 0.0, 0.0);
    } else if (name == "one NaN" || name == "one infinity") {
        add_random(whole(4, 20), 10.0, 0.0, 0.0);
        T bad = std::numeric_limits<T>::quiet_NaN();
        if (name == "one infinity") {
            bad = whole(0, 1) == 0 ? std::numeric_limits<T>::infinity()
                                   : -std::numeric_limits<T>::infinity();
        }
        glm::vec<2, T>& p =
            set[static_cast<std::size_t>(whole(0, static_cast<int>(set.size()) - 1))];
        (whole(0, 1) == 0 ? p.x : p.y) = bad;
    } else if (name == "opencv 21482") {
        for (const auto& [x, y] : {std::array{188.8991, 12.400669},
                                   {80.64467, -49.644814},
                                   {469.59897, 173.28242},
                                   {690.4597, 299.86768}}) {
            set.push_back(
                {static_cast<T>(static_cast<float>(x)), static_cast<T>(static_cast<float>(y))});
        }
    } else if (name == "opencv 11915 24583 27667") {
        static constexpr int first[][2] = {{7826, 5663}, {4190, 5685}, {882, 5699}, {879, 5390},
                                           {871, 2696},  {865, 558},   {870, 140},  {7369, 119},
                                           {7797, 119},  {7825, 5314}, {7826, 5598}};
        static constexpr int second[][2] = {{16, 8},  {14, 10}, {13, 10}, {10, 13}, {9, 13},
                                            {7, 15},  {6, 15},  {5, 16},  {5, 43},  {9, 39},
                                            {10, 39}, {14, 35}, {15, 35}, {17, 33}, {17, 8}};
        static constexpr int third[][2] = {
            {8, 112},   {8, 123},   {7, 124},   {4, 124},   {4, 179},   {7, 179},
            {8, 180},   {8, 219},   {215, 219}, {215, 172}, {216, 171}, {219, 171},
            {219, 148}, {216, 148}, {215, 147}, {215, 112}, {128, 112}, {128, 115},
            {127, 116}, {64, 116},  {63, 115},  {63, 112}};
        static constexpr int fourth[][2] = {
            {60, 4},    {60, 7},   {59, 8},   {8, 8},    {8, 71},   {7, 72},   {4, 72},   {4, 111},
            {215, 111}, {215, 84}, {216, 83}, {219, 83}, {219, 52}, {216, 52}, {215, 51}, {215, 12},
            {216, 11},  {219, 11}, {219, 8},  {216, 8},  {215, 7},  {215, 4}};
        const auto all = [&](const auto& list) {
            for (const auto& p : list) {
                add(p[0], p[1]);
            }
        };
        switch (seed % 4) {
        case 0:
            all(first);
            break;
        case 1:
            all(second);
            break;
        case 2:
            all(third);
            break;
        default:
            all(fourth);
            break;
        }
    } else if (name == "shapely 1670, jts 907") {
        static constexpr int shapely[][2] = {{1, 1}, {1, 5}, {3, 6}, {4, 2}, {5, 5}};
        static constexpr int jts[][2] = {{150, 300}, {200, 300}, {300, 300}, {300, 250},
                                         {280, 120}, {210, 100}, {100, 100}, {100, 240}};
        if (seed % 2 == 0) {
            for (const auto& p : shapely) {
                add(p[0], p[1]);
            }
        } else {
            for (const auto& p : jts) {
                add(p[0], p[1]);
            }
        }
    } else if (name == "R3Det 79") {
        static constexpr int corners[][2] = {
            {1468923, -1091448}, {2028236, -1430127}, {-1515439, -915387}, {1696596, -1424113}};
        for (const auto& p : corners) {
            add(p[0], p[1]);
        }
    }
    return set;
}

/// How many sets of a class a test looks at: 25, or the environment's WARPSHADOW_SETS; of cited
/// points all there are, 4 at most.
inline std::uint64_t sets_of(const kind& k, std::uint64_t wanted = 25) {
    const char* const asked = std::getenv("WARPSHADOW_SETS");
    const std::uint64_t sets = asked != nullptr ? std::strtoull(asked, nullptr, 10) : wanted;
    return k.cited ? 4 : sets;
}

} // namespace point_sets
