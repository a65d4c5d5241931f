// What is measured: entries, each a variant of a kernel on the inputs of one envelope.
//
// Kernels are compiled twice, for any machine and for this one, as libraries that hide all but one
// function each: inline functions of one build are then never taken for those of the other.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace arithmetic {

/// A true value in two doubles, 106 bits: errors of results in double can be told from it.
struct wide {
    double hi, lo;
};

/// How far off a result is; with its sign.
inline double off(double result, const wide& truth) {
    return (result - truth.hi) - truth.lo;
}

/// The same in ulps of float at the truth, whatever the type of the result.
inline double float_ulps(double result, const wide& truth) {
    return 0x1p23 * off(result, truth) / truth.hi;
}

struct wide2 {
    wide x, y;
};

/// A decision that is judged: wrong ones are either harmless or not.
inline constexpr double kept_in_vain = 1.0;
inline constexpr double missed = -1.0;

/// One variant on the inputs of one envelope.
struct entry {
    std::string kernel, envelope, variant;
    double calls;                                ///< per round
    std::function<void()> round;                 ///< all inputs once; this is timed
    std::function<std::vector<double>()> errors; ///< of the results of the last round, by input
    std::size_t build = 0;                       ///< filled in by `entries::add`
};

/// How kernels were compiled.
struct build {
    std::string flags;
    std::size_t lanes; ///< doubles that are worked on at once
};

/// All entries, in the order in which they are added.
class entries {
  public:
    void begin_build(std::string flags, std::size_t lanes) {
        builds_.push_back({std::move(flags), lanes});
    }
    void add(entry each) {
        each.build = builds_.size() - 1;
        all_.push_back(std::move(each));
    }
    [[nodiscard]] const std::vector<build>& builds() const { return builds_; }
    [[nodiscard]] const std::vector<entry>& all() const { return all_; }

  private:
    std::vector<build> builds_;
    std::vector<entry> all_;
};

} // namespace arithmetic

/// The one function of each build.
#define ARITHMETIC_EXPORT __attribute__((visibility("default")))

namespace arithmetic::portable {
ARITHMETIC_EXPORT void add_kernels(entries& to);
}
namespace arithmetic::native {
ARITHMETIC_EXPORT void add_kernels(entries& to);
}
