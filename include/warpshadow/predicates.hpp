// On which side of a line a point lies: exact for every finite input.
#pragma once

#include <warpshadow/detail/power_of_two.hpp>
#include <warpshadow/status.hpp>

#include <glm/vec2.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace warpshadow {

namespace detail {

/// Sum of products of doubles, held as one long integer in units of 2^-2148.
///
/// Every finite double is an integer of 53 bits times a power of two no smaller than 2^-1074, so
/// every product lands on a grid that 132 digits of 32 bits span. Integers neither round nor
/// overflow here, and no compiler setting (contraction, flush to zero) can change them. A digit
/// collects less than 2^35 per product before the carries are resolved, in `sign`.
class exact_sum {
  public:
    /// Adds a·b, or subtracts it if `subtract`.
    /// Precondition: a and b are finite.
    constexpr void add_product(double a, double b, bool subtract) {
        const parts p = split(a);
        const parts q = split(b);
        const int exponent = p.exponent + q.exponent;
        const int shift = exponent & 31;
        const std::uint64_t low = (p.significand & digit_mask) << shift;
        const std::uint64_t high = ((p.significand >> 32) << shift) + (low >> 32);
        const std::uint64_t left[3] = {low & digit_mask, high & digit_mask, high >> 32};
        const std::uint64_t right[2] = {q.significand & digit_mask, q.significand >> 32};
        const std::int64_t unit = (p.negative != q.negative) != subtract ? -1 : 1;
        const auto first = static_cast<std::size_t>(exponent >> 5);
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 2; ++j) {
                const std::uint64_t product = left[i] * right[j];
                digits_[first + i + j] += unit * static_cast<std::int64_t>(product & digit_mask);
                digits_[first + i + j + 1] += unit * static_cast<std::int64_t>(product >> 32);
            }
        }
        first_ = first < first_ ? first : first_;
        last_ = first + 4 > last_ ? first + 4 : last_;
    }

    /// -1, 0 or 1.
    constexpr int sign() const {
        std::int64_t carry = 0;
        std::int64_t rest = 0;
        for (std::size_t k = first_; k <= last_; ++k) {
            const std::int64_t value = digits_[k] + carry;
            carry = value >> 32; // rounds down, so every remaining digit is non-negative
            rest |= value & static_cast<std::int64_t>(digit_mask);
        }
        if (carry != 0) {
            return carry < 0 ? -1 : 1;
        }
        return rest != 0 ? 1 : 0;
    }

  private:
    static constexpr std::uint64_t digit_mask = 0xffffffffu;

    struct parts {
        std::uint64_t significand; // value = ±significand · 2^(exponent - 1074)
        int exponent;
        bool negative;
    };

    static constexpr parts split(double x) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const auto biased = static_cast<int>((bits >> 52) & 0x7ffu);
        const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
        const bool normal = biased != 0;
        return {normal ? fraction | (std::uint64_t{1} << 52) : fraction, normal ? biased - 1 : 0,
                (bits >> 63) != 0};
    }

    std::array<std::int64_t, 136> digits_{};
    std::size_t first_ = 135;
    std::size_t last_ = 0;
};

/// The orientation when rounding could have changed its sign.
inline int orient2d_exact(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    for (const double x : {a.x, a.y, b.x, b.y, c.x, c.y}) {
        if (!std::isfinite(x)) {
            return 0;
        }
    }
    // Equal points and points on one horizontal or vertical line are the common exact zeros.
    if (a == b || a == c || b == c || (a.x == b.x && b.x == c.x) || (a.y == b.y && b.y == c.y)) {
        return 0;
    }
    exact_sum sum; // (a - c) × (b - c), multiplied out: the square terms in c cancel
    sum.add_product(a.x, b.y, false);
    sum.add_product(a.x, c.y, true);
    sum.add_product(c.x, b.y, true);
    sum.add_product(a.y, b.x, true);
    sum.add_product(a.y, c.x, false);
    sum.add_product(c.y, b.x, false);
    return sum.sign();
}

} // namespace detail

/// Side of the line from a to b on which c lies: 1 left (a, b, c run counter-clockwise), -1 right,
/// 0 exactly on it.
///
/// Exact for every finite float and every finite double, subnormal numbers included, with or
/// without contraction of a·b+c. A point with a NaN or an infinity gives 0.
///
/// Two products of differences decide unless their difference could be rounding error, at most
/// (3 + 16 u) u (|l| + |r|) with u = 2^-53 (Shewchuk 1997, bound A) as long as nothing
/// underflows; the rest is decided by the exact sum of six products.
template <typename T>
int orient2d(const glm::vec<2, T>& a, const glm::vec<2, T>& b, const glm::vec<2, T>& c) {
    const glm::dvec2 p(a);
    const glm::dvec2 q(b);
    const glm::dvec2 r(c);
    const double left = (p.x - r.x) * (q.y - r.y);
    const double right = (p.y - r.y) * (q.x - r.x);
    const double determinant = left - right;
    // 2^-1018 is beyond what underflow of the two products can add; infinite products fail the
    // comparison, as does NaN.
    const double bound = 0x1p-51 * (std::abs(left) + std::abs(right)) + 0x1p-1018;
    if (determinant > bound) {
        return 1;
    }
    if (determinant < -bound) {
        return -1;
    }
    return detail::orient2d_exact(p, q, r);
}

/// Step of the grid on which coordinates that span `extent` are snapped: a power of two, more than
/// extent·2^-27 and at most extent·2^-25.
///
/// Points on such a grid differ by at most 2^26 + 1 steps, so that the products inside an
/// orientation are integers below 2^53 times step²: `orient2d_snapped` is then exact.
/// @param extent largest coordinate minus smallest, over both axes
/// @return       0 if extent is NaN, infinite or below 2^-970: `snap` then changes nothing
inline double snap_step(double extent) {
    if (!(extent >= 0x1p-970) || !std::isfinite(extent)) {
        return 0.0;
    }
    const int exponent = detail::exponent_of(extent);
    const bool exact_power = extent == detail::power_of_two(exponent);
    return detail::power_of_two((exact_power ? exponent : exponent + 1) - 26);
}

/// The point of the grid of `step` that is nearest to p.
///
/// Moves each coordinate by step/2 at most; with `snap_step(extent)` that is extent·2^-26, or
/// 1.2e-4 texel in a map of 8192 texels.
inline glm::dvec2 snap(const glm::dvec2& p, double step) {
    if (!(step > 0.0)) {
        return p;
    }
    const double per_unit = 1.0 / step; // exact: step is a power of two
    return {std::nearbyint(p.x * per_unit) * step, std::nearbyint(p.y * per_unit) * step};
}

/// `orient2d` for snapped points: no filter, no fallback.
/// Precondition: the coordinates are multiples of one step 2^k, -500 <= k <= 440.
/// Precondition: coordinates differ by at most 2^26.5 steps.
///
/// Exact under these conditions: the differences and both products are, and the one rounding left
/// cannot change a sign.
inline int orient2d_snapped(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    return left > right ? 1 : (left < right ? -1 : 0);
}

} // namespace warpshadow
