// The second C++ snippet of docs/point-lights.md, in a program: one hemisphere of two is seen.
#include <warpshadow/paraboloid.hpp>

#include <array>
#include <cstdint>
#include <span>

int main() {
    const glm::vec3 light(0.0f, 3.0f, 8.0f);
    const glm::vec3 axis(0.0f, 0.0f, 1.0f);
    const std::array views{
        warpshadow::make_frustum(glm::vec3(0.0f, 2.0f, 5.0f), glm::vec3(0.0f, -0.1f, -1.0f),
                                 glm::vec3(0.0f, 1.0f, 0.0f),
                                 warpshadow::perspective_volume(1.0f, 1.5f, 0.1f, 50.0f))
            .value};
    const warpshadow::box3<float> box{{-1.0f, 0.0f, -4.0f}, {1.0f, 2.0f, -2.0f}};
    const glm::vec3 a(-1.0f, -3.0f, -2.0f);
    const glm::vec3 b(1.0f, -3.0f, -2.0f);

    // [snippet]
    // axis: of the front hemisphere; a, b: ends of an edge, relative to the light and in its frame
    const std::uint32_t sides =
        warpshadow::side_mask(light, axis, std::span<const warpshadow::frustum<float>>(views)).mask;
    const std::uint32_t drawn_to = sides & warpshadow::caster_sides(light, axis, box).mask;
    const float chord = warpshadow::longest_chord(0.5f, 1024.0f); // half a texel of a 1024 map
    const float parts = warpshadow::paraboloid_segments(a, b, 1, chord); // to cut the edge into
    // [snippet]

    return sides == 2u && drawn_to == 2u && parts > 1.0f ? 0 : 1;
}
