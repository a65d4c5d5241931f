// The emitted GLSL, compiled as C++, gives the same bits as the library's template<float>.
//
// WARPSHADOW_PARITY_COUNT inputs per function (a million), from WARPSHADOW_PARITY_SEED.
#include "replay.hpp"

#include "shared_headers.hpp"
#include <warpshadow/glsl.hpp>

#include "replayed.hpp" // generated from glsl/warpshadow/warpshadow.glsl

#include <iostream>
#include <set>

namespace parity {

using T = float;

#define WS_VARIABLE(name, type, array, direction) visit(a.name, b.name, #name);
#define WS_STRUCT(glsl_name, cpp_type, variables)                                                  \
    template <> struct members<WS_STRIP cpp_type> {                                                \
        template <typename A, typename B, typename Visit>                                          \
        static void each(A& a, B& b, Visit visit) {                                                \
            variables                                                                              \
        }                                                                                          \
    };                                                                                             \
    template <> struct twin<WS_STRIP cpp_type> { using type = replay::glsl_name; };
#define WS_PLAIN_STRUCT WS_STRUCT
#define WS_FUNCTION(...)
#include "shared_list.inc"
#undef WS_FUNCTION
#undef WS_PLAIN_STRUCT
#undef WS_STRUCT
#undef WS_VARIABLE

} // namespace parity

int main() {
    using T = float;
    const std::size_t count = parity::input_count(1'000'000);
    parity::replay_check check(count);
    int functions = 0;
    int failures = 0;
    std::set<std::string_view> names;
    const auto judge = [&](std::string_view name, std::size_t different) {
        ++functions;
        names.insert(name);
        if (different != 0) {
            ++failures;
            std::cerr << "FAILED " << name << ": " << different << " of " << count
                      << " inputs differ\n";
        }
    };

#define WS_STRUCT(...)
#define WS_PLAIN_STRUCT(...)
#define WS_VARIABLE(name, type, array, direction) {#name, #type, array, direction},
#define WS_FUNCTION(glsl_name, cpp_name, cpp_result, cpp_parameters, glsl_result, variables)       \
    judge(#glsl_name,                                                                              \
          check.compare<WS_STRIP cpp_result>(                                                      \
              #glsl_name, {variables}, static_cast<std::tuple<WS_STRIP cpp_parameters>*>(nullptr), \
              [](auto&... arguments) { return WS_STRIP cpp_name(arguments...); },                  \
              [](auto&... arguments) { return replay::glsl_name(arguments...); }));
#include "shared_list.inc"

    // every emitted function was replayed; methods are reached through the functions that call them
    for (const std::string_view name : warpshadow::glsl::functions()) {
        bool is_method = false;
        for (const warpshadow::glsl::detail::piece& each : warpshadow::glsl::detail::pieces) {
            is_method = is_method ||
                        (each.name == name && each.text.find(" self") != std::string_view::npos);
        }
        if (!is_method && names.count(name) == 0) {
            ++failures;
            std::cerr << "FAILED " << name << " is emitted and not replayed\n";
        }
    }
    std::cout << functions << " functions, " << count << " inputs each, " << failures
              << " failures\n";
    return failures == 0 && functions > 0 ? 0 : 1;
}
