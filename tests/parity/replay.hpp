// Host side of the replay: what GLSL rewritten as C++ needs to compile, and the comparison.
#pragma once

#include "harness.hpp"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/integer.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

namespace replay_support {

/// Arrays of GLSL are values.
template <typename T, int N> struct replay_array {
    T values[std::size_t(N)];
    T& operator[](int i) { return values[i]; }
    const T& operator[](int i) const { return values[i]; }
    T& operator[](std::size_t i) { return values[i]; }
    const T& operator[](std::size_t i) const { return values[i]; }
};

/// What an `out` parameter holds before it is written: a value that nobody mistakes for a result.
inline void replay_poison(float& x) {
    x = -9.876543e21f;
}
inline void replay_poison(int& x) {
    x = -987654321;
}
inline void replay_poison(unsigned& x) {
    x = 0xdeadbeefu;
}
inline void replay_poison(bool&) {}
template <glm::length_t L, typename T> void replay_poison(glm::vec<L, T>& v) {
    for (glm::length_t i = 0; i < L; ++i) {
        replay_poison(v[i]);
    }
}
template <typename T, int N> void replay_poison(replay_array<T, N>& values) {
    for (T& each : values.values) {
        replay_poison(each);
    }
}
/// A struct: every float of it, since structs of the list consist of 32-bit scalars.
template <typename Struct> void replay_poison(Struct& value) {
    static_assert(std::is_trivially_copyable_v<Struct> && sizeof(Struct) % sizeof(float) == 0);
    std::array<float, sizeof(Struct) / sizeof(float)> filler;
    filler.fill(-9.876543e21f);
    value = std::bit_cast<Struct>(filler);
}

} // namespace replay_support

#define WS_TABLE_ACCESS_HOOK
#define WS_TABLE warpshadow::table_view<float>
#define WS_TABLE_CELLS(table) (table).cells
#define WS_TABLE_ROWS(table) (table).rows
#define WS_TABLE_NODE(table, row, k)                                                               \
    (table).nodes[static_cast<std::size_t>(row) * (static_cast<std::size_t>((table).cells) + 1) +  \
                  static_cast<std::size_t>(k)]

namespace parity {

template <typename T, int N>
struct is_array<replay_support::replay_array<T, N>> : std::true_type {};
template <typename E>
requires std::is_enum_v<E>
struct twin<E> {
    using type = std::conditional_t<std::is_signed_v<std::underlying_type_t<E>>, int, unsigned>;
};
template <typename T, std::size_t N> struct twin<std::array<T, N>> {
    using type = replay_support::replay_array<twin_of<T>, static_cast<int>(N)>;
};

/// Counts the inputs for which two functions differ in any bit of what they return or write.
class replay_check {
  public:
    explicit replay_check(std::size_t count) : count_(count), tables_(seed()) {}

    template <typename Result, typename... Parameters, typename Host, typename Replay>
    std::size_t compare(std::string_view name, const std::vector<variable>& variables,
                        std::tuple<Parameters...>*, Host host, Replay replayed) {
        generator from(seed() ^ std::hash<std::string_view>{}(name));
        std::size_t different = 0;
        for (std::size_t n = 0; n < count_; ++n) {
            std::tuple<Parameters...> inputs;
            std::size_t index = 0;
            std::apply([&](auto&... value) { (input(value, from, name, variables[index++]), ...); },
                       inputs);
            std::tuple<Parameters...> host_arguments = inputs;
            std::tuple<twin_of<Parameters>...> replay_arguments;
            copy(inputs, replay_arguments, std::index_sequence_for<Parameters...>());
            bool same = true;
            const auto check = [&](auto& a, auto& b, std::string_view) {
                if constexpr (std::is_same_v<std::remove_cvref_t<decltype(a)>, float>) {
                    same = same && same_bits(a, b);
                } else {
                    same = same && bits(a) == bits(b);
                }
            };
            if constexpr (std::is_void_v<Result>) {
                std::apply(host, host_arguments);
                std::apply(replayed, replay_arguments);
            } else {
                Result a = std::apply(host, host_arguments);
                auto b = std::apply(replayed, replay_arguments);
                each_scalar(a, b, "", check);
            }
            visit_pairs(host_arguments, replay_arguments, check,
                        std::index_sequence_for<Parameters...>());
            if (!same) {
                ++different;
                if (different == 1) {
                    report(name, variables, inputs);
                }
            }
        }
        return different;
    }

  private:
    template <typename Value>
    void input(Value& value, generator& from, std::string_view function, const variable& which) {
        if constexpr (is_table<Value>::value) {
            value = tables_.view<float>(from.below(tables_.tables.size()));
        } else {
            fill(value, from, function, which.name, inputs_are::anything);
        }
    }

    template <typename A, typename B> static void assign(const A& a, B& b) {
        if constexpr (is_table<A>::value) {
            b = a;
        } else {
            each_scalar(a, b, "", [](const auto& x, auto& y, std::string_view) {
                y = static_cast<std::remove_reference_t<decltype(y)>>(x);
            });
        }
    }

    template <typename A, typename B, std::size_t... I>
    static void copy(const A& a, B& b, std::index_sequence<I...>) {
        (assign(std::get<I>(a), std::get<I>(b)), ...);
    }

    template <typename A, typename B, typename Visit, std::size_t... I>
    static void visit_pairs(A& a, B& b, Visit&& visit, std::index_sequence<I...>) {
        (each_scalar(std::get<I>(a), std::get<I>(b), "", visit), ...);
    }

    template <typename Inputs>
    static void report(std::string_view name, const std::vector<variable>& variables,
                       const Inputs& inputs) {
        std::string text(name);
        std::size_t index = 0;
        std::apply(
            [&](const auto&... value) {
                ((text += "\n  " + std::string(variables[index].name) + ": " + describe(value),
                  ++index),
                 ...);
            },
            inputs);
        std::fprintf(stderr, "differs: %s\n", text.c_str());
    }

    std::size_t count_;
    table_set tables_;
};

} // namespace parity
