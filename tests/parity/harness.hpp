// Compares functions of the library with their GLSL: what both comparisons, on the host and on a
// device, have in common. Values are walked scalar by scalar, structs by their lists of members.
#pragma once

#include <warpshadow/warp.hpp>

#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#define WS_STRIP(...) __VA_ARGS__

namespace parity {

/// A parameter or member as the list of shared functions names it.
struct variable {
    std::string_view name;
    std::string_view type;
    int array;
    std::string_view direction;
};

/// Specialised for each struct of the list: `each(a, b, visit)` calls visit(a.m, b.m, "m").
template <typename Struct> struct members;

/// Specialised for each struct of the list: its twin on the other side.
template <typename Host> struct twin { using type = Host; };

template <typename Host> using twin_of = typename twin<Host>::type;

template <typename V> struct is_table : std::false_type {};
template <typename T, typename N> struct is_table<warpshadow::table_view<T, N>> : std::true_type {};

template <typename V> struct is_vector : std::false_type {};
template <glm::length_t L, typename T>
struct is_vector<glm::vec<L, T, glm::defaultp>> : std::true_type {};

template <typename V> struct is_matrix : std::false_type {};
template <glm::length_t C, glm::length_t R, typename T>
struct is_matrix<glm::mat<C, R, T, glm::defaultp>> : std::true_type {};

template <typename V, typename = void> struct is_array : std::false_type {};
template <typename V, std::size_t N> struct is_array<std::array<V, N>> : std::true_type {};
template <typename V, std::size_t N> struct is_array<V[N]> : std::true_type {};

/// Calls visit(scalar of a, scalar of b, name of the innermost member) for all scalars.
template <typename A, typename B, typename Visit>
void each_scalar(A& a, B& b, std::string_view name, Visit&& visit) {
    using value = std::remove_const_t<A>;
    if constexpr (std::is_arithmetic_v<value> || std::is_enum_v<value>) {
        visit(a, b, name);
    } else if constexpr (is_vector<value>::value || is_matrix<value>::value) {
        for (glm::length_t i = 0; i < a.length(); ++i) {
            each_scalar(a[i], b[i], name, visit);
        }
    } else if constexpr (is_array<value>::value) {
        for (std::size_t i = 0; i < std::size(a); ++i) {
            each_scalar(a[i], b[i], name, visit);
        }
    } else if constexpr (is_table<value>::value) {
        // handed over as a whole
    } else {
        members<value>::each(a, b, [&](auto& x, auto& y, std::string_view member) {
            each_scalar(x, y, member, visit);
        });
    }
}

/// Bits of a scalar as 32 of them.
template <typename V> std::uint32_t bits(V value) {
    if constexpr (std::is_same_v<V, float>) {
        return std::bit_cast<std::uint32_t>(value);
    } else if constexpr (std::is_enum_v<V>) {
        return static_cast<std::uint32_t>(value);
    } else {
        return static_cast<std::uint32_t>(value);
    }
}

/// NaN is one class; everything else is compared to the bit.
inline bool same_bits(float a, float b) {
    return (std::isnan(a) && std::isnan(b)) || bits(a) == bits(b);
}

/// Whole numbers that a function takes.
struct whole_range {
    std::int64_t lowest;
    std::int64_t highest;
};

/// Range of an int, uint or enumeration by the names of function, parameter and member.
///
/// The functions divide by, index by and loop over these numbers; their doc comments say what they
/// may be. Anything that is not named here is 1 to 64.
whole_range range_of(std::string_view function, std::string_view parameter,
                     std::string_view member);

/// Interval that a float must be in for the function to make sense, as its doc comment says:
/// (0, 0) for none. The replay ignores it, since both sides must agree whatever comes in; on a
/// device a division by zero or a NaN may give anything.
struct float_range {
    float lowest;
    float highest;
};
float_range float_range_of(std::string_view function, std::string_view parameter,
                           std::string_view member);

/// A seeded source of inputs that are hard on purpose.
class generator {
  public:
    explicit generator(std::uint64_t seed) : engine_(seed) {}

    /// Floats of all magnitudes, special values, and repetitions of what came before.
    float number() {
        const std::uint32_t choice = below(100);
        float result = 0.0f;
        if (choice < 30) {
            result = uniform(-0.25f, 1.25f);
        } else if (choice < 50) {
            result = signed_power(-20.0f, 20.0f);
        } else if (choice < 65) {
            result = signed_power(-140.0f, 127.0f);
        } else if (choice < 80) {
            result = static_cast<float>(static_cast<int>(below(41)) - 20) * 0.25f;
        } else if (choice < 90) {
            // the value before, or its neighbour
            result = last_;
            const std::uint32_t step = below(3);
            if (step != 0) {
                result = std::nextafter(result, step == 1 ? 3.0e38f : -3.0e38f);
            }
        } else {
            static constexpr std::array<float, 14> special{
                0.0f,
                -0.0f,
                1.0f,
                -1.0f,
                0.5f,
                std::numeric_limits<float>::max(),
                std::numeric_limits<float>::lowest(),
                std::numeric_limits<float>::min(),
                std::numeric_limits<float>::epsilon(),
                std::numeric_limits<float>::denorm_min(),
                1.0f - 0.5f * std::numeric_limits<float>::epsilon(),
                std::numeric_limits<float>::infinity(),
                -std::numeric_limits<float>::infinity(),
                std::numeric_limits<float>::quiet_NaN()};
            result = special[below(special.size())];
        }
        last_ = result;
        return result;
    }

    /// Floats that a well-conditioned use would give: the unit square and some way around it.
    float ordinary() { return uniform(-0.5f, 1.5f); }

    /// Numbers inside an interval; of positive ones, evenly over its powers of two.
    float within(float_range range) {
        if (range.lowest <= 0.0f) {
            return uniform(range.lowest, range.highest);
        }
        return std::exp2(uniform(std::log2(range.lowest), std::log2(range.highest)));
    }

    std::int64_t whole(whole_range range) {
        const auto span = static_cast<std::uint64_t>(range.highest - range.lowest) + 1;
        return range.lowest + static_cast<std::int64_t>(engine_() % span);
    }

    std::uint32_t below(std::size_t count) { return static_cast<std::uint32_t>(engine_() % count); }

  private:
    float uniform(float lo, float hi) {
        const auto fraction = static_cast<float>(engine_() >> 40) * 0x1p-24f;
        return lo + fraction * (hi - lo);
    }
    float signed_power(float lo, float hi) {
        const float magnitude = std::exp2(uniform(lo, hi));
        return (engine_() & 1u) != 0 ? magnitude : -magnitude;
    }

    std::mt19937_64 engine_;
    float last_ = 0.0f;
};

/// Warp tables of several sizes: increasing functions, 4 to 16 cells and 4 to 12 rows.
struct table_set {
    struct table {
        std::vector<float> nodes;
        std::vector<double> wide_nodes; ///< the same numbers
        int cells;
        int rows;
    };
    std::vector<table> tables;

    explicit table_set(std::uint64_t seed) {
        std::mt19937_64 engine(seed);
        for (int i = 0; i < 8; ++i) {
            table made{
                {}, {}, 4 + static_cast<int>(engine() % 13), 4 + static_cast<int>(engine() % 9)};
            for (int row = 0; row < made.rows; ++row) {
                std::vector<double> sums(static_cast<std::size_t>(made.cells) + 1, 0.0);
                for (std::size_t k = 1; k < sums.size(); ++k) {
                    sums[k] = sums[k - 1] + 0.1 + static_cast<double>(engine() % 1000) / 250.0;
                }
                for (const double sum : sums) {
                    // table 0 is the identity
                    const double node = i == 0
                                            ? static_cast<double>(&sum - sums.data()) / made.cells
                                            : sum / sums.back();
                    made.nodes.push_back(static_cast<float>(node));
                }
            }
            made.wide_nodes.assign(made.nodes.begin(), made.nodes.end());
            tables.push_back(std::move(made));
        }
    }

    template <typename T> warpshadow::table_view<T> view(std::size_t which) const {
        const table& from = tables[which];
        if constexpr (std::is_same_v<T, float>) {
            return {from.nodes, from.cells, from.rows};
        } else {
            return {from.wide_nodes, from.cells, from.rows};
        }
    }
};

/// Number of inputs per function: WARPSHADOW_PARITY_COUNT, or the given one.
inline std::size_t input_count(std::size_t otherwise) {
    const char* text = std::getenv("WARPSHADOW_PARITY_COUNT");
    const long long asked = text != nullptr ? std::atoll(text) : 0;
    return asked > 0 ? static_cast<std::size_t>(asked) : otherwise;
}

/// Seed of all inputs: WARPSHADOW_PARITY_SEED, or 1.
inline std::uint64_t seed() {
    const char* text = std::getenv("WARPSHADOW_PARITY_SEED");
    const long long asked = text != nullptr ? std::atoll(text) : 0;
    return asked > 0 ? static_cast<std::uint64_t>(asked) : 1;
}

/// How inputs are chosen.
enum class inputs_are {
    anything, ///< all floats there are
    valid,    ///< all floats that the function is for
    ordinary, ///< in and around the unit square
};

/// Fills a value from the generator.
template <typename Value>
void fill(Value& value, generator& from, std::string_view function, std::string_view parameter,
          inputs_are which) {
    each_scalar(value, value, "", [&](auto& scalar, auto&, std::string_view member) {
        using kind = std::remove_reference_t<decltype(scalar)>;
        if constexpr (std::is_same_v<kind, bool>) {
            scalar = from.below(2) != 0;
        } else if constexpr (std::is_floating_point_v<kind>) {
            const float_range range = float_range_of(function, parameter, member);
            if (which != inputs_are::anything && range.highest > 0.0f) {
                scalar = from.within(range);
            } else {
                scalar = which == inputs_are::ordinary ? from.ordinary() : from.number();
            }
        } else {
            scalar = static_cast<kind>(from.whole(range_of(function, parameter, member)));
        }
    });
}

/// A scalar for a message, with as many digits as tell it apart.
template <typename V> std::string text_of(V value) {
    std::array<char, 64> buffer{};
    if constexpr (std::is_floating_point_v<V>) {
        std::snprintf(buffer.data(), buffer.size(), "%.9g (%a)", static_cast<double>(value),
                      static_cast<double>(value));
    } else {
        std::snprintf(buffer.data(), buffer.size(), "%lld", static_cast<long long>(value));
    }
    return buffer.data();
}

template <typename Value> std::string describe(const Value& value) {
    std::string text;
    each_scalar(value, value, "", [&](const auto& scalar, const auto&, std::string_view member) {
        text += text.empty() ? "" : ", ";
        text += member.empty() ? "" : std::string(member) + "=";
        text += text_of(scalar);
    });
    return text.empty() ? "(table)" : text;
}

} // namespace parity
