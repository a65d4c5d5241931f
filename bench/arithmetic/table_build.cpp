// Building the functions of one axis: sums over windows and along rows, and what they are stored
// as.
#include "kernels.hpp"
#include "warp_inputs.hpp"

#include <warpshadow/warp_build.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace ws = warpshadow;

namespace arithmetic::ARITHMETIC_BUILD {

namespace {

template <typename Node> double value_of(Node node) {
    if constexpr (std::is_integral_v<Node>) {
        return double(node) / double(std::numeric_limits<Node>::max());
    } else {
        return double(node);
    }
}

template <typename Node>
std::vector<double> errors_of(const build_case& in, const std::vector<Node>& nodes) {
    std::vector<double> errors;
    const auto stride = static_cast<std::size_t>(in.cells) + 1;
    for (std::size_t i = 0; i < in.nodes.size(); ++i) {
        const auto row = static_cast<std::size_t>(in.rows[i / stride]);
        const Node node = nodes[row * stride + i % stride];
        errors.push_back(map_size * off(value_of(node), in.nodes[i]));
    }
    return errors;
}

template <typename T, typename Node>
void add_library(entries& to, const build_case& in, const std::string& variant) {
    ws::build_options<T> options;
    options.floor = T(in.floor);
    options.radius = in.radius;
    const auto w = static_cast<std::size_t>(in.cells);
    const auto nodes = std::make_shared<std::vector<Node>>(w * (w + 1));
    const auto scratch =
        std::make_shared<std::vector<std::uint64_t>>(ws::scratch_size(in.cells, options));
    to.add({"table build", in.envelope, variant, double(w * w),
            [&in, options, nodes, scratch] {
                ws::build_axis<T, Node>(ws::count_view(in.counts, in.cells, in.cells), options,
                                        *scratch, {*nodes, in.cells, in.cells});
            },
            [&in, nodes] { return errors_of(in, *nodes); }});
}

} // namespace

void add_table_build(entries& to) {
    for (const build_case& in : build_cases()) {
        add_library<float, float>(to, in, "float");
        add_library<double, double>(to, in, "double");
        add_library<float, std::uint16_t>(to, in, "float, UNORM16 nodes");
        const auto w = static_cast<std::size_t>(in.cells);
        const auto nodes = std::make_shared<std::vector<float>>(w * (w + 1));
        const auto plain = std::make_shared<warp_inputs::plain_builder>(in.cells);
        to.add(
            {"table build", in.envelope, "plain: sums in float", double(w * w),
             [&in, nodes, plain] { plain->build(in.counts, in.radius, float(in.floor), *nodes); },
             [&in, nodes] { return errors_of(in, *nodes); }});
    }
}

} // namespace arithmetic::ARITHMETIC_BUILD
