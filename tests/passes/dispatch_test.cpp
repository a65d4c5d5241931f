// Compute programs over more things than OpenGL promises to take groups for.
#include "gl/context.hpp"
#include "gl/objects.hpp"
#include "passes/compute_pass.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

TEST_CASE("a program over many things comes once to each") {
    const gl::headless_context context;
    const gl::program count = pass(R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer visit_buffer { uint visits[]; };
uniform uint things;
void main()
{
    for (uint id = gl_GlobalInvocationID.x; id < things;
         id += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        atomicAdd(visits[id], 1u);
    }
}
)");
    for (const std::size_t things :
         {std::size_t{1}, std::size_t{65535}, std::size_t{65536}, std::size_t{150000}}) {
        const std::vector<std::uint32_t> none(things + 1);
        const gl::buffer visits{std::span<const std::uint32_t>(none)};
        visits.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        count.set("things", static_cast<unsigned>(things));
        count.dispatch_over(things);
        gl::wait_for_writes();
        gl::check("many things");
        const std::vector<std::uint32_t> seen = visits.read<std::uint32_t>();
        CHECK(std::all_of(seen.begin(), seen.end() - 1, [](std::uint32_t n) { return n == 1; }));
        CHECK(seen.back() == 0);
    }
}
