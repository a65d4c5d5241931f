// A user's program: builds a warp from no samples, which is the identity, and looks a point up.
#include <warpshadow/warp_build.hpp>

#include <cstdint>
#include <vector>

int main() {
    const int size = 8;
    std::vector<std::uint32_t> counts(8 * 8);
    std::vector<std::uint64_t> scratch(8);
    std::vector<float> rows(8 * 9);
    std::vector<float> columns(8 * 9);
    const auto warp =
        warpshadow::build_warp<float, float>({}, {}, {size, counts, scratch, rows, columns});
    const glm::vec2 p(0.3f, 0.7f);
    const bool same = warpshadow::warp(warp.rows, warp.columns, p) == p;
    return same && any(warp.flags, warpshadow::status::empty_importance) ? 0 : 1;
}
