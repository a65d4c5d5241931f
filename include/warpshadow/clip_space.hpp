// Clip-space conventions: what NDC means to an API, and where it lies in map space.
#pragma once

#include <warpshadow/status.hpp>

#include <glm/vec2.hpp>

namespace warpshadow {

/// NDC depth between the two clip planes.
enum class depth_range { minus_one_to_one, zero_to_one };

/// What an API, an engine or a shader means by clip space; every function that needs it takes it.
struct clip_space {
    depth_range depth = depth_range::minus_one_to_one;
    bool reversed_z = false;   ///< the near plane has the larger depth
    bool infinite_far = false; ///< perspective projections have no far plane
    bool left_handed = false;  ///< view space looks along +z instead of -z
    bool y_down = false;       ///< NDC y points down in the image

    /// The same with near and far depth exchanged.
    constexpr clip_space reversed() const {
        clip_space other = *this;
        other.reversed_z = !reversed_z;
        return other;
    }

    /// The same with the far plane at infinity.
    constexpr clip_space infinite() const {
        clip_space other = *this;
        other.infinite_far = true;
        return other;
    }

    friend constexpr bool operator==(const clip_space&, const clip_space&) = default;
};

/// Conventions of the common APIs; `clip::vulkan.reversed().infinite()` and so on for the rest.
namespace clip {
/// OpenGL: right-handed view space, depth -1..1, y up.
inline constexpr clip_space opengl{};
/// Vulkan: right-handed view space, depth 0..1, y down.
inline constexpr clip_space vulkan{depth_range::zero_to_one, false, false, false, true};
/// Direct3D: left-handed view space, depth 0..1, y up.
inline constexpr clip_space d3d{depth_range::zero_to_one, false, false, true, false};
} // namespace clip

/// NDC depth of the near plane.
template <typename T> constexpr T near_depth(clip_space clip) {
    const T lowest = clip.depth == depth_range::zero_to_one ? T(0) : T(-1);
    return clip.reversed_z ? T(1) : lowest;
}

/// NDC depth of the far plane.
template <typename T> constexpr T far_depth(clip_space clip) {
    const T lowest = clip.depth == depth_range::zero_to_one ? T(0) : T(-1);
    return clip.reversed_z ? lowest : T(1);
}

/// Map position of an NDC position: (0, 0) left and bottom, (1, 1) right and top of the image.
///
/// The same point of the scene has the same map position in every convention. A component that is
/// not finite stays so, for the counters to reject.
template <typename T> glm::vec<2, T> map_from_ndc(glm::vec<2, T> ndc, clip_space clip) {
    const T y = clip.y_down ? -ndc.y : ndc.y;
    return glm::vec<2, T>(T(0.5) * ndc.x + T(0.5), T(0.5) * y + T(0.5));
}

/// NDC position of a map position; the inverse of `map_from_ndc`.
template <typename T> glm::vec<2, T> ndc_from_map(glm::vec<2, T> position, clip_space clip) {
    const T x = T(2) * position.x - T(1);
    const T y = T(2) * position.y - T(1);
    return glm::vec<2, T>(x, clip.y_down ? -y : y);
}

} // namespace warpshadow
