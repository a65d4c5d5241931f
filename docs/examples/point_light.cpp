// The C++ snippets of docs/point-lights.md, in a program: a light behind the camera's back.
#include <warpshadow/casters.hpp>
#include <warpshadow/cube.hpp>
#include <warpshadow/paraboloid.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <span>

int main() {
    const glm::vec3 light(0.0f, 3.0f, 8.0f);
    const std::array views{
        warpshadow::make_frustum(glm::vec3(0.0f, 2.0f, 5.0f), glm::vec3(0.0f, -0.1f, -1.0f),
                                 glm::vec3(0.0f, 1.0f, 0.0f),
                                 warpshadow::perspective_volume(1.0f, 1.5f, 0.1f, 50.0f))
            .value};
    const std::array boxes{warpshadow::box3<float>{{-1.0f, 0.0f, -4.0f}, {1.0f, 2.0f, -2.0f}},
                           warpshadow::box3<float>{{-1.0f, 0.0f, 20.0f}, {1.0f, 2.0f, 22.0f}}};
    std::array<std::uint8_t, 2> masks{};
    int drawn = 0;
    const auto draw = [&](int, std::size_t) { ++drawn; };

    // [snippet]
    // views: of all cameras that this frame shows; boxes: bounds of the casters, world space
    warpshadow::face_options options;
    options.refined = true;
    const std::uint32_t needed =
        warpshadow::face_mask(light, std::span<const warpshadow::frustum<float>>(views), options)
            .mask;
    const float range = std::numeric_limits<float>::infinity(); // how far the light reaches
    warpshadow::caster_faces(light, std::span<const warpshadow::box3<float>>(boxes), range,
                             std::span<std::uint8_t>(masks));
    for (int face = 0; face < 6; ++face) {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if ((needed & masks[i]) >> face & 1u) {
                draw(face, i); // with the camera of face_camera(light, face, ...)
            }
        }
    }
    // [snippet]

    const std::uint32_t sides =
        warpshadow::side_mask(light, glm::vec3(0.0f, 0.0f, 1.0f),
                              std::span<const warpshadow::frustum<float>>(views))
            .mask;
    // the view is before the light, in -z: one face, the back, and one box
    return needed == 1u << 5 && sides == 2u && drawn == 1 ? 0 : 1;
}
