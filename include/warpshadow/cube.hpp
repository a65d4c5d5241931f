// Cube maps of point lights: face cameras, face and texel look-up, and which faces matter.
//
// Faces are numbered +x, -x, +y, -y, +z, -z, 0 to 5, and mask bit i stands for face i. The axes of
// each face are those of every API (OpenGL 4.6 §8.13, Vulkan 1.3 §16.5.3, Direct3D 11): with the
// major axis m, s and t run along -z and -y on +x, z and -y on -x, x and z on +y, x and -z on -y,
// x and -y on +z, -x and -y on -z. Texel row 0 is at t = 0.
//
// When faces can be skipped: a face matters if its pyramid meets the view frustum. All six pyramids
// share the light as apex, so with the light inside the view frustum all six matter and culling
// faces gains nothing; it gains where the light is outside, the more the narrower the view. Masks
// of several views of one map are joined by OR. A map that outlives the frame, or that a probe or a
// mirror reads, takes part in `update::one_shot`. A face that is skipped must be cleared or left
// unread.
#pragma once

#include <warpshadow/cull.hpp>
#include <warpshadow/detail/frustum_support.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/status.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace warpshadow {

/// A direction on a cube map.
template <typename T> struct cube_point {
    int face;          ///< 0 to 5, or -1 for no direction
    glm::vec<2, T> uv; ///< (s, t) in [0, 1]; (0, 0) with face -1
};

/// Face and position of a direction of any length.
///
/// The largest component decides; of equal ones x goes before y, and y before z, whatever the
/// hardware does. Zero and non-finite directions give face -1 (on a device that does not honour
/// NaN, a NaN may give any face, with uv in [0, 1]).
/// uv is within 2 ulp of 1 of the exact position.
template <typename T> cube_point<T> cube_lookup(const glm::vec<3, T>& direction) {
    cube_point<T> result;
    result.face = -1;
    result.uv = glm::vec<2, T>(T(0), T(0));
    glm::vec<3, T> size = glm::abs(direction);
    T largest = std::numeric_limits<T>::max();
    T major = size.z;
    T s = direction.z < T(0) ? -direction.x : direction.x;
    T t = -direction.y;
    int face = direction.z < T(0) ? 5 : 4;
    if (size.x >= size.y && size.x >= size.z) {
        major = size.x;
        s = direction.x < T(0) ? direction.z : -direction.z;
        t = -direction.y;
        face = direction.x < T(0) ? 1 : 0;
    } else if (size.y >= size.z) {
        major = size.y;
        s = direction.x;
        t = direction.y < T(0) ? -direction.z : direction.z;
        face = direction.y < T(0) ? 3 : 2;
    }
    if (major > T(0) && size.x <= largest && size.y <= largest && size.z <= largest) {
        result.face = face;
        result.uv =
            glm::clamp(glm::vec<2, T>(T(0.5) + T(0.5) * (s / major), T(0.5) + T(0.5) * (t / major)),
                       T(0), T(1));
    }
    return result;
}

/// Direction of a position on a face: the major component is 1 or -1.
///
/// `face`: 0 to 5; anything else gives the zero vector.
/// `uv`: (s, t) in [0, 1]; positions outside continue the plane of the face.
template <typename T> glm::vec<3, T> cube_direction(int face, const glm::vec<2, T>& uv) {
    T s = T(2) * uv.x - T(1);
    T t = T(2) * uv.y - T(1);
    glm::vec<3, T> direction(T(0), T(0), T(0));
    if (face == 0) {
        direction = glm::vec<3, T>(T(1), -t, -s);
    } else if (face == 1) {
        direction = glm::vec<3, T>(T(-1), -t, s);
    } else if (face == 2) {
        direction = glm::vec<3, T>(s, T(1), t);
    } else if (face == 3) {
        direction = glm::vec<3, T>(s, T(-1), -t);
    } else if (face == 4) {
        direction = glm::vec<3, T>(s, -t, T(1));
    } else if (face == 5) {
        direction = glm::vec<3, T>(-s, -t, T(-1));
    }
    return direction;
}

/// Texel that holds a position on a face: columns along s, rows along t.
///
/// `uv`: from `cube_lookup`; outside of [0, 1] the nearest texel, so that uv = 1 gives the last.
/// `size`: texels along a side, 1 to 2^20.
template <typename T> glm::vec<2, int> cube_texel(const glm::vec<2, T>& uv, int size) {
    // bounded before the conversion, which is undefined for what an int cannot hold
    T column = uv.x > T(0) ? glm::min(uv.x, T(1)) * T(size) : T(0);
    T row = uv.y > T(0) ? glm::min(uv.y, T(1)) * T(size) : T(0);
    return glm::vec<2, int>(glm::min(int(column), size - 1), glm::min(int(row), size - 1));
}

/// Direction of the centre of a texel; `cube_lookup` and `cube_texel` lead back to it.
///
/// `face`: 0 to 5; anything else gives the zero vector.
/// `texel`: column and row. `size`: texels along a side, 1 to 2^20.
template <typename T>
glm::vec<3, T> cube_texel_direction(int face, const glm::vec<2, int>& texel, int size) {
    return cube_direction(
        face, glm::vec<2, T>((T(texel.x) + T(0.5)) / T(size), (T(texel.y) + T(0.5)) / T(size)));
}

/// Distance of a position relative to the light along the axis of its face: what a face camera
/// projects to depth.
template <typename T> T cube_distance(const glm::vec<3, T>& position) {
    return glm::max(glm::max(glm::abs(position.x), glm::abs(position.y)), glm::abs(position.z));
}

/// Where an API's rasteriser puts NDC y in a texture.
enum class cube_api {
    opengl,  ///< row 0 at y = -1, y up
    vulkan,  ///< row 0 at y = -1, y down
    direct3d ///< row 0 at y = 1, y up
};

/// Camera that renders one face of a cube map.
///
/// `light`: world space.
/// `face`: 0 to 5; anything else is taken as 0, `out_of_range`.
/// `api`: where the image goes; the clip space of `view_matrix` and `projection_matrix` has its
/// `y_down` set for vulkan and not for the others. Depth range, reversal, handedness are free.
/// `near_distance`, `far_distance`: along the axis of the face, positive; repaired as by
/// `make_projection`. Far may be infinity.
/// `slope`: 1 for the face alone; 1 + 2 b / size adds b texels of border around it. Below 1 or not
/// finite: 1, `out_of_range`.
///
/// In opengl right x up = -forward, as in any camera of a right-handed world. In vulkan and
/// direct3d it is +forward: the image is mirrored, as these cube maps are left-handed, and front
/// faces wind the other way round.
template <typename T>
frustum_result<T> face_camera(const glm::vec<3, T>& light, int face, cube_api api, T near_distance,
                              T far_distance, T slope = T(1)) {
    frustum_result<T> result{};
    if (face < 0 || face > 5) {
        face = 0;
        result.flags |= status::out_of_range;
    }
    if (!(slope >= T(1) && slope <= std::numeric_limits<T>::max())) {
        slope = T(1);
        result.flags |= status::out_of_range;
    }
    const projection_result<T> projection = make_projection(
        view_volume<T>{-slope, slope, -slope, slope, near_distance, far_distance, false},
        clip_space{});
    const glm::vec<3, T> middle = cube_direction(face, glm::vec<2, T>(T(0.5), T(0.5)));
    const glm::vec<3, T> s = cube_direction(face, glm::vec<2, T>(T(1), T(0.5))) - middle;
    const glm::vec<3, T> t = cube_direction(face, glm::vec<2, T>(T(0.5), T(1))) - middle;
    result.value =
        frustum<T>{light, s, api == cube_api::opengl ? t : -t, middle, projection.volume};
    result.flags |= projection.flags;
    return result;
}

/// All six faces.
inline constexpr std::uint32_t all_faces = 0x3fu;

/// How long a cube map lives.
enum class cube_update {
    every_frame, ///< rendered for the views given, and read by these alone
    one_shot     ///< kept for later, or read by others: no face may be skipped
};

/// Options of `face_mask`.
struct face_options {
    cube_update update = cube_update::every_frame;
    /// Also test the pyramids that are left by `intersects`: exact, at the price of that test each.
    bool refined = false;
    /// Drop faces that a view touches without entering. A view sees nothing of them but what lies
    /// on its own boundary; with filters that reach across edges leave it off, or set `slope`.
    bool open = false;
    /// Half width of a pyramid at distance 1, from 1: as in `face_camera`, for filters that read
    /// beyond the edge.
    double slope = 1.0;
    /// Distance that the light reaches; may be infinity.
    double range = std::numeric_limits<double>::infinity();
};

namespace detail {

/// Faces that one view may need. Six functions, x + y to y - z, separate all pyramids: the signs of
/// their largest and smallest values over the corners are the twelve masks that decide all faces.
inline std::uint32_t faces_in_view(const frustum_terms& f, const face_options& options) {
    const double k = options.slope;
    const double closed = options.open ? -1.0 : 1.0;
    // of the planes of each pyramid, how far inside the view reaches; the least of them counts
    std::array<double, 6> inside;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<glm::length_t>(axis);
        const support_interval own =
            support(f, f.offset[a], f.right[a], f.up[a], f.forward[a], closed);
        inside[2 * axis] = glm::min(own.hi, options.range - own.lo);
        inside[2 * axis + 1] = glm::min(-own.lo, options.range + own.hi);
    }
    const auto least = [&inside](std::size_t face, double first, double second) {
        inside[face] = glm::min(inside[face], glm::min(first, second));
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const auto a = static_cast<glm::length_t>(i);
        const auto b = static_cast<glm::length_t>(j);
        const auto bounds = [&](double on_a, double on_b) {
            return support(f, on_a * f.offset[a] + on_b * f.offset[b],
                           on_a * f.right[a] + on_b * f.right[b], on_a * f.up[a] + on_b * f.up[b],
                           on_a * f.forward[a] + on_b * f.forward[b], closed * (1.0 + k));
        };
        const support_interval sum = bounds(k, 1.0);
        const support_interval difference = bounds(k, -1.0);
        least(2 * i, sum.hi, difference.hi);
        least(2 * i + 1, -sum.lo, -difference.lo);
        if (k == 1.0) {
            least(2 * j, sum.hi, -difference.lo);
            least(2 * j + 1, -sum.lo, difference.hi);
        } else {
            const support_interval other_sum = bounds(1.0, k);
            const support_interval other_difference = bounds(1.0, -k);
            least(2 * j, other_sum.hi, -other_difference.lo);
            least(2 * j + 1, -other_sum.lo, other_difference.hi);
        }
    }
    std::uint32_t needed = 0u;
    for (std::size_t face = 0; face < 6; ++face) {
        const bool in = options.open ? inside[face] > 0.0 : inside[face] >= 0.0;
        needed |= (in ? 1u : 0u) << face;
    }
    return needed;
}

} // namespace detail

/// Faces of a point light's cube map that a set of views needs.
///
/// `light`: world space. `views`: world space; `far_distance` may be infinity.
/// A face is left out only if its pyramid, apex at the light, is certainly apart from every view:
/// by the planes of the pyramids alone, nine functions of the view's parameters for all faces, or
/// exactly with `refined`. Touching counts unless `open`. No views: mask 0. With `one_shot`: all
/// faces. A NaN or infinity in the light or a view, or a slope below 1 or NaN: all faces,
/// `invalid_input`; magnitudes beyond 2^400: all faces, `out_of_range`.
template <typename T>
mask_result face_mask(const glm::vec<3, T>& light, std::span<const frustum<T>> views,
                      const face_options& options = face_options{}) {
    using detail::dvec3;
    const dvec3 position(light);
    mask_result result{0u, status::ok};
    const bool usable = options.slope >= 1.0 && options.slope <= 0x1p20 && options.range >= 0.0;
    if (options.update == cube_update::one_shot || !usable || !detail::all_finite(position)) {
        result.mask = all_faces;
        result.flags = usable && detail::all_finite(position) ? status::ok : status::invalid_input;
        return result;
    }
    for (const frustum<T>& view : views) {
        const detail::frustum_terms terms = detail::make_terms(view, position);
        result.flags |= terms.flags;
        std::uint32_t needed = terms.sound ? detail::faces_in_view(terms, options) : all_faces;
        // what other views need already is not worth a refined test
        needed &= ~result.mask;
        if (options.refined && needed != 0u) {
            const cull_volume volume = make_cull_volume(view);
            for (int face = 0; face < 6; ++face) {
                if ((needed >> face & 1u) == 0u) {
                    continue;
                }
                frustum<double> pyramid =
                    face_camera(position, face, cube_api::opengl, 1.0, 2.0, options.slope).value;
                pyramid.volume.near_distance = 0.0;
                pyramid.volume.far_distance = options.range;
                if (!intersects(make_cull_volume(pyramid), volume).intersects) {
                    needed &= ~(1u << face);
                }
            }
        }
        result.mask |= needed;
    }
    return result;
}

/// Faces of a point light's cube map that one view needs.
template <typename T>
mask_result face_mask(const glm::vec<3, T>& light, const frustum<T>& view,
                      const face_options& options = face_options{}) {
    return face_mask(light, std::span<const frustum<T>>(&view, 1), options);
}

} // namespace warpshadow
