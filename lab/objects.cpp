#include "lab/objects.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>

namespace lab {

namespace ws = warpshadow;

namespace {

class splitter {
  public:
    splitter(const scene& world, scene_objects& result) : world_(world), result_(result) {
        centres_.reserve(world.triangles.size());
        for (const glm::uvec3& t : world.triangles) {
            centres_.push_back(
                (world.positions[t.x] + world.positions[t.y] + world.positions[t.z]) / 3.0f);
        }
        order_.resize(world.triangles.size());
        std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    }

    void split(std::size_t first, std::size_t count) {
        const std::span<std::uint32_t> part = std::span(order_).subspan(first, count);
        if (count <= largest_object) {
            add(part, first);
            return;
        }
        glm::vec3 lo = centres_[part.front()];
        glm::vec3 hi = lo;
        for (const std::uint32_t i : part) {
            lo = glm::min(lo, centres_[i]);
            hi = glm::max(hi, centres_[i]);
        }
        const glm::vec3 size = hi - lo;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t half = count / 2;
        std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(half), part.end(),
                         [&](std::uint32_t a, std::uint32_t b) {
                             const float p = centres_[a][axis];
                             const float q = centres_[b][axis];
                             return p != q ? p < q : a < b; // the same on every machine
                         });
        split(first, half);
        split(first + half, count - half);
    }

  private:
    void add(std::span<const std::uint32_t> part, std::size_t first) {
        glm::vec3 lo = world_.positions[world_.triangles[part.front()].x];
        glm::vec3 hi = lo;
        for (const std::uint32_t i : part) {
            const glm::uvec3 t = world_.triangles[i];
            result_.triangles.push_back(t);
            for (glm::length_t k = 0; k < 3; ++k) {
                lo = glm::min(lo, world_.positions[t[k]]);
                hi = glm::max(hi, world_.positions[t[k]]);
            }
        }
        result_.ranges.push_back({first, part.size()});
        result_.boxes.push_back({glm::dvec3(lo), glm::dvec3(hi)});
    }

    const scene& world_;
    scene_objects& result_;
    std::vector<glm::vec3> centres_;
    std::vector<std::uint32_t> order_;
};

} // namespace

scene_objects make_objects(const scene& world) {
    scene_objects result;
    result.triangles.reserve(world.triangles.size());
    splitter split(world, result);
    std::vector<std::size_t> begins = world.parts;
    begins.insert(begins.begin(), 0);
    begins.push_back(world.triangles.size());
    for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
        if (begins[i] < begins[i + 1]) {
            split.split(begins[i], begins[i + 1] - begins[i]);
        }
    }
    return result;
}

} // namespace lab
