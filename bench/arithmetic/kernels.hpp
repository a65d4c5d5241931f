// Kernels of one build: see measure.hpp. ARITHMETIC_BUILD is portable or native.
#pragma once

#include "inputs.hpp"
#include "measure.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace arithmetic::ARITHMETIC_BUILD {

void add_warp(entries& to);
void add_table_build(entries& to);
void add_planar(entries& to);
void add_light(entries& to);
void add_volumes(entries& to);
void add_fragments(entries& to);

/// Adds an entry that keeps one result for each of `count` inputs.
/// @param each  result of input i
/// @param error of input i's result
template <typename Each, typename Error>
void add_each(entries& to, std::string kernel, std::string envelope, std::string variant,
              std::size_t count, Each each, Error error) {
    using result = decltype(each(std::size_t{0}));
    auto results = std::make_shared<std::vector<result>>(count);
    to.add({std::move(kernel), std::move(envelope), std::move(variant), double(count),
            [count, results, each] {
                for (std::size_t i = 0; i < count; ++i) {
                    (*results)[i] = each(i);
                }
            },
            [count, results, error] {
                std::vector<double> errors(count);
                for (std::size_t i = 0; i < count; ++i) {
                    errors[i] = error(i, (*results)[i]);
                }
                return errors;
            }});
}

} // namespace arithmetic::ARITHMETIC_BUILD
