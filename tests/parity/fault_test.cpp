// Faults planted in emitted GLSL must be seen by the replay, each of them.
//
// The texts are those of the generator's own examples, tests/generator/accepted; CMakeLists.txt
// plants the faults while it has them rewritten as C++.
#include "replay.hpp"

#include <accepted/numbers.hpp>
#include <accepted/references.hpp>
#include <accepted/vectors.hpp>

#include "no_fault_numbers.hpp"
#include "no_fault_references.hpp"
#include "no_fault_vectors.hpp"

#include "dropped_conversion.hpp"
#include "dropped_parentheses.hpp"
#include "forgotten_out.hpp"
#include "inout_became_out.hpp"
#include "literal_became_int.hpp"
#include "operator_precedence.hpp"
#include "swapped_arguments.hpp"
#include "wrong_literal.hpp"
#include "wrong_operator.hpp"

#include <iostream>

namespace {

int failures = 0;

void expect(const char* what, bool good) {
    std::cout << (good ? "seen: " : "NOT SEEN: ") << what << '\n';
    failures += good ? 0 : 1;
}

const std::vector<parity::variable> two_numbers{{"x", "float", 0, ""}, {"y", "float", 0, ""}};

} // namespace

// The comparison of one function with its twin in two namespaces: equal without, different with.
#define WS_FAULT(fault, twin, variables, result, parameters, host)                                 \
    {                                                                                              \
        const auto without = check.compare<result>(                                                \
            #host, variables, static_cast<std::tuple<WS_STRIP parameters>*>(nullptr),              \
            [](auto&... a) { return fixture::host(a...); },                                        \
            [](auto&... a) { return twin::ws_##host(a...); });                                     \
        const auto with = check.compare<result>(                                                   \
            #host, variables, static_cast<std::tuple<WS_STRIP parameters>*>(nullptr),              \
            [](auto&... a) { return fixture::host(a...); },                                        \
            [](auto&... a) { return fault::ws_##host(a...); });                                    \
        expect("no fault in " #host, without == 0);                                                \
        expect(#fault " in " #host, with != 0);                                                    \
    }

int main() {
    parity::replay_check check(parity::input_count(10'000));
    const std::vector<parity::variable> precedence_variables{{"a", "float", 0, ""},
                                                             {"b", "float", 0, ""},
                                                             {"c", "float", 0, ""},
                                                             {"i", "int", 0, ""},
                                                             {"j", "int", 0, ""}};
    const std::vector<parity::variable> conversion_variables{
        {"i", "int", 0, ""}, {"u", "uint", 0, ""}, {"b", "bool", 0, ""}, {"small", "float", 0, ""}};
    const std::vector<parity::variable> three_numbers{
        {"x", "float", 0, ""}, {"y", "float", 0, ""}, {"rest", "float", 0, "out"}};

    WS_FAULT(operator_precedence, no_fault_vectors, precedence_variables, float,
             (float, float, float, int, int), precedence)
    WS_FAULT(dropped_parentheses, no_fault_vectors, precedence_variables, float,
             (float, float, float, int, int), precedence)
    WS_FAULT(literal_became_int, no_fault_numbers, two_numbers, float, (float), quadrature)
    WS_FAULT(wrong_literal, no_fault_numbers, two_numbers, float, (float), literals)
    WS_FAULT(swapped_arguments, no_fault_numbers, two_numbers, float, (float, float), functions)
    WS_FAULT(dropped_conversion, no_fault_numbers, conversion_variables, float,
             (int, unsigned, bool, float), conversions)
    WS_FAULT(inout_became_out, no_fault_references, two_numbers, void, (float, float), exchange)
    WS_FAULT(forgotten_out, no_fault_references, three_numbers, float, (float, float, float),
             divide)
    WS_FAULT(wrong_operator, no_fault_references, three_numbers, float, (float, float, float),
             divide)
    return failures == 0 ? 0 : 1;
}
