// All kernels of one build.
#include "kernels.hpp"

#include <warpshadow/detail/lanes.hpp>

#include <string>

namespace arithmetic::ARITHMETIC_BUILD {

void add_kernels(entries& to) {
    to.begin_build(ARITHMETIC_FLAGS, warpshadow::detail::native_lanes);
    add_warp(to);
    add_table_build(to);
    add_planar(to);
    add_light(to);
    add_fragments(to);
    add_volumes(to);
}

} // namespace arithmetic::ARITHMETIC_BUILD
