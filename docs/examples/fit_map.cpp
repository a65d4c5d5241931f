// The C++ snippet of docs/geometry.md, in a program: a camera over the ground, and a box in the
// sky.
#include <warpshadow/focus.hpp>
#include <warpshadow/shadow_frustum.hpp>

#include <glm/vec3.hpp>

int main() {
    const auto camera =
        warpshadow::make_frustum(glm::vec3(0.0f, 2.0f, 0.0f), glm::vec3(0.0f, -0.2f, -1.0f),
                                 glm::vec3(0.0f, 1.0f, 0.0f),
                                 warpshadow::perspective_volume(1.0f, 1.5f, 0.1f, 100.0f))
            .value;
    const auto light = warpshadow::sun(glm::vec3(0.5f, -1.0f, 0.2f));
    const warpshadow::box3<float> casters{glm::vec3(-90.0f, 0.0f, -90.0f),
                                          glm::vec3(90.0f, 20.0f, 90.0f)};
    const warpshadow::box3<float> receivers{glm::vec3(-90.0f, 0.0f, -90.0f),
                                            glm::vec3(90.0f, 1.0f, 90.0f)};
    const warpshadow::box3<float> tree{glm::vec3(-4.0f, 0.0f, -20.0f),
                                       glm::vec3(-2.0f, 9.0f, -18.0f)};
    const warpshadow::box3<float> behind{glm::vec3(60.0f, 0.0f, 60.0f),
                                         glm::vec3(62.0f, 9.0f, 62.0f)};
    warpshadow::fit_state state;

    // [snippet]
    // boxes around what casts and what receives shadows; `state` is kept from frame to frame
    const auto seen = warpshadow::focus<float>({camera, light, casters, receivers});
    const auto fit =
        warpshadow::minimal_shadow_frustum<float>(seen,
                                                  {.frame = warpshadow::fit_frame::rotated_minimal,
                                                   .clip = warpshadow::clip::vulkan,
                                                   .map_size = {2048, 2048},
                                                   .margin = 1.0f, // texels, for a filter of 3 x 3
                                                   .origin = camera.eye},
                                                  state);

    // fit.matrix: positions relative to the eye to clip space; fit.wasted_area: what it leaves
    // unused
    const bool draw_tree = warpshadow::may_cast(seen.volume, tree).may_cast;
    // [snippet]

    const bool draw_behind = warpshadow::may_cast(seen.volume, behind).may_cast;
    return fit.flags == warpshadow::status::ok && fit.wasted_area < 0.6f && draw_tree &&
                   !draw_behind
               ? 0
               : 1;
}
