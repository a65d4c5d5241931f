// Random count maps, random tables and exact oracles, shared by the tests of importance and warp.
#pragma once

#include <warpshadow/importance.hpp>

#include <boost/multiprecision/cpp_int.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace warp_test {

using rational = boost::multiprecision::cpp_rational;
using integer = boost::multiprecision::cpp_int;

/// Unit roundoff: half an ulp of 1.
template <typename T> constexpr double roundoff() {
    return 0.5 * static_cast<double>(std::numeric_limits<T>::epsilon());
}

/// A random source that RapidCheck seeds, so that a failure is repeated by RC_PARAMS alone.
///
/// Maps of millions of numbers cannot be shrunk in useful time; one seed makes them cheap.
class dice {
  public:
    explicit dice(std::uint64_t seed) : engine_(seed) {}

    std::uint64_t bits() { return engine_(); }

    /// An integer from lo to hi, both included.
    int between(int lo, int hi) {
        const auto span = static_cast<std::uint64_t>(std::int64_t(hi) - std::int64_t(lo) + 1);
        return static_cast<int>(std::int64_t(lo) + static_cast<std::int64_t>(bits() % span));
    }

    /// A multiple of 2^-53 in [0, 1).
    double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

    double between(double lo, double hi) { return lo + (hi - lo) * unit(); }

    bool coin() { return (bits() & 1u) != 0; }

    /// Number of cells of a map: 1 to `largest`, all orders of magnitude alike, extremes often.
    int size(int largest) {
        const int special[] = {1, 2, 3, 5, 127, 1000, 2047, 4095, 4096};
        if (between(0, 3) == 0) {
            return std::min(largest, special[between(0, 8)]);
        }
        const double log = between(0.0, std::log2(static_cast<double>(largest) + 1.0));
        return std::clamp(static_cast<int>(std::exp2(log)), 1, largest);
    }

  private:
    std::mt19937_64 engine_;
};

inline dice any_dice() {
    return dice(
        *rc::gen::noShrink(rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint64_t>())));
}

/// A count map and its memory, which has exactly the size of the map.
struct owned_counts {
    int width;
    int height;
    std::vector<std::uint32_t> counts;

    owned_counts(int w, int h)
        : width(w), height(h), counts(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

    std::uint32_t& at(int i, int j) {
        return counts[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(i)];
    }
    [[nodiscard]] std::uint32_t at(int i, int j) const {
        return counts[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(i)];
    }
    warpshadow::count_map map() { return {counts, width, height}; }
    [[nodiscard]] warpshadow::count_view view() const {
        return warpshadow::count_view(counts, width, height);
    }
};

inline constexpr std::uint32_t largest_count = std::numeric_limits<std::uint32_t>::max();

/// Counts of one of the kinds that a scene, or an enemy, may produce.
inline owned_counts any_counts(dice& d, int width, int height) {
    owned_counts c(width, height);
    const int kind = d.between(0, 9);
    const auto any_cell = [&]() -> std::uint32_t& {
        return c.at(d.between(0, width - 1), d.between(0, height - 1));
    };
    switch (kind) {
    case 0: // uniform
        std::fill(c.counts.begin(), c.counts.end(),
                  d.coin() ? largest_count : static_cast<std::uint32_t>(d.bits()));
        break;
    case 1: // nothing at all
        break;
    case 2: // one sample
        any_cell() = 1;
        break;
    case 3: // all samples in one cell
        any_cell() = d.coin() ? largest_count : static_cast<std::uint32_t>(d.bits());
        break;
    case 4: // a few samples, most rows empty
        for (int i = 0; i < 20; ++i) {
            ++any_cell();
        }
        break;
    case 5: // small numbers everywhere
        for (std::uint32_t& n : c.counts) {
            n = static_cast<std::uint32_t>(d.between(0, 9));
        }
        break;
    case 6: // all orders of magnitude
        for (std::uint32_t& n : c.counts) {
            n = static_cast<std::uint32_t>(d.bits()) >> d.between(0, 31);
        }
        break;
    case 7: // one heavy cell among ones
        std::fill(c.counts.begin(), c.counts.end(), 1u);
        any_cell() = 1u << 25;
        break;
    case 8: // full counters and empty ones
        for (std::uint32_t& n : c.counts) {
            n = d.coin() ? largest_count : 0u;
        }
        break;
    default: // everything on the border
        for (int i = 0; i < width; ++i) {
            c.at(i, d.coin() ? 0 : height - 1) = static_cast<std::uint32_t>(d.between(0, 1000));
        }
        for (int j = 0; j < height; ++j) {
            c.at(d.coin() ? 0 : width - 1, j) = static_cast<std::uint32_t>(d.between(0, 1000));
        }
        break;
    }
    return c;
}

/// A coordinate that no arithmetic is safe from, or an ordinary one of [0, 1].
template <typename T> T any_coordinate(dice& d) {
    using limits = std::numeric_limits<T>;
    const T special[] = {T(0),
                         T(-0.0),
                         T(1),
                         T(0.5),
                         T(-1e-9),
                         T(1e-9),
                         std::nextafter(T(1), T(2)),
                         std::nextafter(T(1), T(0)),
                         limits::denorm_min(),
                         -limits::denorm_min(),
                         limits::min(),
                         limits::max(),
                         limits::lowest(),
                         limits::infinity(),
                         -limits::infinity(),
                         limits::quiet_NaN(),
                         T(-3),
                         T(17)};
    const int count = static_cast<int>(std::size(special));
    const int i = d.between(0, 2 * count);
    return i < count ? special[i] : static_cast<T>(d.unit());
}

} // namespace warp_test
