// The C++ snippet of the README, in a program: eight samples in one corner of the map.
#include <warpshadow/warp_build.hpp>

#include <cstdint>
#include <vector>

int main() {
    const std::vector<glm::vec2> samples(8, glm::vec2(0.1f, 0.2f));
    const glm::vec2 p(0.1f, 0.2f);

    // [snippet]
    // samples: what the camera sees and the light may reach, in the unit square of the map
    const int size = 512;
    std::vector<std::uint32_t> counts(size * size);
    std::vector<std::uint64_t> scratch(size);
    std::vector<float> rows(size * (size + 1)), columns(size * (size + 1));

    const auto warp = warpshadow::build_warp<float, float>(samples, {.window = 0.7f, .floor = 0.3f},
                                                           {size, counts, scratch, rows, columns});

    const glm::vec2 texel = warpshadow::warp(warp.rows, warp.columns, p); // where p is in the map
    const glm::mat2 growth = warpshadow::jacobian(warp.rows, warp.columns, p);
    // [snippet]

    // Many samples near p: the map grows there, and p is found again.
    const glm::vec2 back = warpshadow::unwarp(warp.rows, warp.columns, texel);
    const bool found = glm::abs(back.x - p.x) < 1e-5f && glm::abs(back.y - p.y) < 1e-5f;
    return found && growth[0][0] > 2.0f && growth[1][1] > 2.0f ? 0 : 1;
}
