// Powers of two and binary exponents by bit pattern: exact, branch-free, free of libm.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace warpshadow::detail {

/// 2^exponent.
/// Precondition: -1022 <= exponent <= 1023.
constexpr double power_of_two(int exponent) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

/// Largest e with 2^e <= |x|, kept inside -1000..1000 so that 2^e, 2^-e and their products with x
/// are normal numbers; zero and subnormal x give -1000.
constexpr int exponent_of(double x) {
    const auto biased = static_cast<int>((std::bit_cast<std::uint64_t>(x) >> 52) & 0x7ffu);
    return std::clamp(biased - 1023, -1000, 1000);
}

} // namespace warpshadow::detail
