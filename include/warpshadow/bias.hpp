// Depth bias from the texel's footprint: no acne, at no more than that takes.
//
// A shadow map holds the depth of a texel's centre. The receiver lies elsewhere in the texel, so
// on a slope its own stored depth may be nearer to the light than itself. How much is known: the
// receiver's plane, in map space, over the texel's footprint. Projections and warps keep planes
// planes, or have a Jacobian; so one formula serves them all,
//
//     bias = (radius + ½) · (|∇z·J⁻¹e1| / width + |∇z·J⁻¹e2| / height) + rounding.
//
// The classics of Scherzer 2005, §4.2 are here for comparison. Map space: u and v in 0..1, depth
// as it is stored, growing away from the light (with reversed depth take 1 - depth).
#pragma once

#include <warpshadow/clip_space.hpp>
#include <warpshadow/detail/finite.hpp>
#include <warpshadow/status.hpp>
#include <warpshadow/warp.hpp>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <limits>

namespace warpshadow {

/// What a bias has to cover.
template <typename T> struct bias_settings {
    glm::vec<2, T> texel; ///< 1 / width and 1 / height of the map
    T radius;    ///< reach of the filter in texels: 0 for the nearest texel, ½ for 2 × 2 bilinear
                 ///< taps, r for taps up to r texels away
    T quantum;   ///< rounding of the stored and of the computed depth together
    T deviation; ///< distance in the map, before the warp, between what is drawn and what
                 ///< is meant: the error bound of a subdivision; else 0
    T slope_ratio; ///< largest ratio of neighbouring slopes in a warp table; else 1
    T largest;     ///< clamp: beyond it a shadow would visibly leave its caster
};

/// A bias, in units of stored depth, to be subtracted from the receiver's depth.
template <typename T> struct depth_bias {
    T value;       ///< 0 ≤ value ≤ largest
    bool aliasing; ///< the receiver is so nearly parallel to the light that the clamp fired
};

/// Settings for a map of this size: nearest texel, exact tables, clamped at 1/16 of the depth.
///
/// @param size    width and height in texels, positive
/// @param quantum rounding of stored and computed depth, see `depth_quantum`
template <typename T> bias_settings<T> settings_for(glm::vec<2, T> size, T quantum) {
    bias_settings<T> settings;
    settings.texel = glm::vec<2, T>(T(1) / size.x, T(1) / size.y);
    settings.radius = T(0);
    settings.quantum = quantum;
    settings.deviation = T(0);
    settings.slope_ratio = T(1);
    settings.largest = T(0.0625);
    return settings;
}

/// Step of a fixed-point depth buffer; a float buffer of depth 0..1 is within the step of 24 bits.
///
/// @param bits 1 to 32
template <typename T> T depth_quantum(int bits) {
    return T(1) / (glm::exp2(T(bits)) - T(1));
}

/// Normal, in map space and of any length, of a receiver from two tangents of it.
///
/// In a fragment shader the tangents are dFdx and dFdy of the position in the map.
/// @param dx,dy differences of (u, v, depth) along the receiver
template <typename T> glm::vec<3, T> map_normal(glm::vec<3, T> dx, glm::vec<3, T> dy) {
    return glm::cross(dx, dy);
}

/// Normal, in map space and of any length, of a receiver from its plane in the scene.
///
/// @param planes matrix of `map_planes`
/// @param plane  (n, d) with dot(n, p) + d = 0 on the receiver, in the light matrix's space
template <typename T>
glm::vec<3, T> map_normal(const glm::mat<4, 4, T>& planes, glm::vec<4, T> plane) {
    glm::vec<4, T> q = planes * plane;
    return glm::vec<3, T>(q.x, q.y, q.z);
}

/// Normal after a warp of the map: the same receiver in warped map space.
///
/// @param normal   in map space before the warp, any length
/// @param jacobian of the warp at the receiver, column 0 is the derivative by u
/// @return         scaled by the determinant: no division, so nothing can overflow by it
template <typename T>
glm::vec<3, T> warped_normal(glm::vec<3, T> normal, const glm::mat<2, 2, T>& jacobian) {
    T det = jacobian[0][0] * jacobian[1][1] - jacobian[1][0] * jacobian[0][1];
    return glm::vec<3, T>(normal.x * jacobian[1][1] - normal.y * jacobian[0][1],
                          normal.y * jacobian[0][0] - normal.x * jacobian[1][0], normal.z * det);
}

/// rise / |normal_z| + minimum, clamped: the end of every bias.
///
/// @param rise    depth gained over the footprint times |normal_z|
/// @param normal_z depth component of the normal that `rise` was made with
/// @param minimum what is added whatever the slope is
/// @param largest clamp
template <typename T> depth_bias<T> clamped_bias(T rise, T normal_z, T minimum, T largest) {
    depth_bias<T> result;
    result.value = largest;
    result.aliasing = true;
    // multiplied, not divided, before it is known to fit: an edge-on receiver has normal_z = 0
    T most = std::numeric_limits<T>::max();
    T height = glm::abs(normal_z);
    if (height > T(0) && height <= most && rise <= most && rise <= (largest - minimum) * height) {
        result.value = rise / height + minimum;
        result.aliasing = false;
    }
    return result;
}

/// Bias from the texel's footprint: no acne on planes, and no less would do.
///
/// Exact where the map of the texel is linear: every projection of this library (leave the
/// Jacobian the identity, the matrix has it all: depth is affine over a warped map too) and the
/// inside of a table's cell. For a texel that spans several cells of a table set `slope_ratio`, or
/// use `corner_bias`.
/// A receiver parallel to the light has an infinite slope: the clamp, `aliasing`. So have a NaN
/// and a Jacobian that is not invertible.
/// @param normal   of the receiver in map space before the warp, any length
/// @param jacobian of the warp at the receiver; the identity without
/// @param settings what to cover
template <typename T>
depth_bias<T> footprint_bias(glm::vec<3, T> normal, const glm::mat<2, 2, T>& jacobian,
                             const bias_settings<T>& settings) {
    glm::vec<3, T> n = warped_normal(normal, jacobian);
    T rise = (settings.radius + T(0.5)) * settings.slope_ratio *
             (glm::abs(n.x) * settings.texel.x + glm::abs(n.y) * settings.texel.y);
    T det = jacobian[0][0] * jacobian[1][1] - jacobian[1][0] * jacobian[0][1];
    T strayed =
        settings.deviation * glm::abs(det) * glm::sqrt(normal.x * normal.x + normal.y * normal.y);
    return clamped_bias(rise + strayed, n.z, settings.quantum, settings.largest);
}

/// Bias from the footprint's corners, unwarped: for tables whose kinks lie inside a texel.
///
/// No acne at the nearest texel, and what the texel needs is exceeded only where its outline is
/// bent outwards. With a filter the outermost taps count; a kink between them is not seen: for
/// certainty compare each tap by `plane_depth_step`. Five inverse warps, nine with a filter,
/// instead of one Jacobian. `slope_ratio` does not matter.
/// @param rows,columns tables of the warp
/// @param normal       of the receiver in map space before the warp, any length
/// @param p            the receiver's position in map space before the warp
/// @param settings     what to cover
template <typename T, typename Node>
depth_bias<T> corner_bias(const table_view<T, Node>& rows, const table_view<T, Node>& columns,
                          glm::vec<3, T> normal, glm::vec<2, T> p,
                          const bias_settings<T>& settings) {
    glm::vec<2, T> size = T(1) / settings.texel;
    glm::vec<2, T> centre = (glm::floor(warp(rows, columns, p) * size) + T(0.5)) * settings.texel;
    // depths of the receiver's plane over that of p, times |normal.z|; 0 is p itself, so that no
    // kink of the tables can make it deeper than the texel
    T facing = normal.z > T(0) ? T(-1) : T(1);
    glm::vec<2, T> from = unwarp(rows, columns, centre) - p;
    T deepest = T(0);                                                // over the texel
    T shallowest = facing * (normal.x * from.x + normal.y * from.y); // over the taps
    for (int i = 0; i < 4; ++i) {
        glm::vec<2, T> side =
            glm::vec<2, T>(i == 0 || i == 2 ? T(-0.5) : T(0.5), i < 2 ? T(-0.5) : T(0.5));
        glm::vec<2, T> corner = unwarp(rows, columns, centre + side * settings.texel) - p;
        deepest = glm::max(deepest, facing * (normal.x * corner.x + normal.y * corner.y));
        if (settings.radius > T(0)) {
            T reach = T(2) * settings.radius;
            glm::vec<2, T> tap = unwarp(rows, columns, centre + side * reach * settings.texel) - p;
            shallowest = glm::min(shallowest, facing * (normal.x * tap.x + normal.y * tap.y));
        }
    }
    T rise = glm::max(deepest - shallowest, T(0));
    T strayed = settings.deviation * glm::sqrt(normal.x * normal.x + normal.y * normal.y);
    return clamped_bias(rise + strayed, normal.z, settings.quantum, settings.largest);
}

/// Depth of the receiver's plane at `to` over that at `from`: compare at the texel's centre itself.
///
/// The bias that needs no footprint: `to` is the centre of the texel, unwarped, and the result is
/// added to the receiver's depth before the comparison. Clamped to ±largest; edge-on 0.
/// @param normal   of the receiver in map space before the warp, any length
/// @param from,to  positions in map space before the warp
/// @param largest  clamp
template <typename T>
T plane_depth_step(glm::vec<3, T> normal, glm::vec<2, T> from, glm::vec<2, T> to, T largest) {
    T step = -(normal.x * (to.x - from.x) + normal.y * (to.y - from.y));
    if (glm::abs(step) <= largest * glm::abs(normal.z) && glm::abs(normal.z) > T(0)) {
        return step / normal.z;
    }
    return T(0);
}

/// Constant bias: the same everywhere, hence far too much in most places.
///
/// @param units   number of steps
/// @param quantum step of the depth buffer, see `depth_quantum`
template <typename T> T constant_bias(T units, T quantum) {
    return units * quantum;
}

/// Slope-scale bias as graphics APIs have it: factor · max(|∂z/∂x|, |∂z/∂y|) per texel + constant.
///
/// @param normal   of the receiver in the map as it is drawn (after a warp), any length
/// @param settings `texel` and `largest` count
/// @param factor   `polygon_offset_factor` is never too little
/// @param constant added whatever the slope is
template <typename T>
depth_bias<T> slope_scale_bias(glm::vec<3, T> normal, const bias_settings<T>& settings, T factor,
                               T constant) {
    T rise = factor *
             glm::max(glm::abs(normal.x) * settings.texel.x, glm::abs(normal.y) * settings.texel.y);
    return clamped_bias(rise, normal.z, constant, settings.largest);
}

/// Smallest slope factor without acne: half the sum of two slopes is at most the larger of them.
///
/// @param radius reach of the filter in texels, 0 for the nearest texel
template <typename T> T polygon_offset_factor(T radius) {
    return T(2) * radius + T(1);
}

/// Bias that is still needed if the map holds back faces (Wang and Molnar 1994).
///
/// A lit receiver finds its own back face, `thickness` behind it: only what the footprint exceeds
/// that by is missing. Receivers that face away are dark by their normal. Thin and open casters
/// gain nothing, and light leaks in where a back face meets a wall.
/// @param footprint bias of `footprint_bias`
/// @param thickness depth of the solid along the light ray, in units of stored depth, 0 or more
template <typename T> T back_face_bias(T footprint, T thickness) {
    return glm::max(footprint - thickness, T(0));
}

/// Linear depth of a fragment under a warped light matrix: the light's own depth, undistorted.
///
/// Per fragment it is exact: write it as the depth.
/// @param depth NDC depth z / w of the fragment
/// @param w     the warp's w: clip w, for a light with a position over the light's own w
/// @param warp  `depth_scale`, `depth_shift` and `depth_centre` of a `lispsm_result`; for
///              `projective_matrix` (1, c, c) with c of `projective_depth`; the scale is not 0
template <typename T> T linear_depth(T depth, T w, glm::vec<3, T> warp) {
    return (depth - warp.y) * w / warp.x + warp.z;
}

/// Clip z that makes the light's own depth of a vertex come out of the division by w.
///
/// Exact at vertices alone: in between depth is off by up to `linear_depth_error` of the triangle's
/// depth range. Ask `linear_depth_allowed` first.
/// @param light_depth depth of the vertex under the unwarped light
/// @param w           clip w of the vertex, positive
template <typename T> T linear_depth_vertex(T light_depth, T w) {
    return light_depth * w;
}

/// Largest error of linear depth per vertex, as a share of the depth range of an edge:
/// (sqrt(q) - 1) / (sqrt(q) + 1) for the ratio q of w at its ends; 1 if one of them is not
/// positive.
template <typename T> T linear_depth_error(T w0, T w1) {
    T error = T(1);
    if (w0 > T(0) && w1 > T(0)) {
        T a = glm::sqrt(w0);
        T b = glm::sqrt(w1);
        error = glm::abs(a - b) / (a + b);
    }
    return error;
}

/// Whether linear depth per vertex stays within `tolerance` of an edge's depth range.
///
/// False: write `linear_depth` per fragment, or keep the hyperbolic depth of the matrix.
/// @param w0,w1     clip w at the ends of the edge, or the least and largest of a mesh
/// @param tolerance 0 to 1
template <typename T> bool linear_depth_allowed(T w0, T w1, T tolerance) {
    return linear_depth_error(w0, w1) <= tolerance;
}

/// One step of a texel in the scene, across the light ray.
template <typename T> struct texel_axes {
    glm::vec<3, T> u; ///< along the map's u, at fixed v
    glm::vec<3, T> v; ///< along the map's v, at fixed u
};

/// What a texel spans in the scene at a point, in the plane perpendicular to its light ray.
///
/// Zero for a matrix that has no image plane there. In double for matrices far from the origin.
/// @param light    clip space from the scene, warps included
/// @param jacobian of a table warp at the point; the identity without
/// @param p        position in the light matrix's space, clip w > 0
/// @param texel    1 / width and 1 / height of the map
template <typename T>
texel_axes<T> texel_axes_at(const glm::mat<4, 4, T>& light, const glm::mat<2, 2, T>& jacobian,
                            glm::vec<3, T> p, glm::vec<2, T> texel) {
    texel_axes<T> axes;
    axes.u = glm::vec<3, T>(T(0));
    axes.v = glm::vec<3, T>(T(0));
    glm::vec<4, T> clip = light * glm::vec<4, T>(p.x, p.y, p.z, T(1));
    glm::vec<3, T> row_x = glm::vec<3, T>(light[0][0], light[1][0], light[2][0]);
    glm::vec<3, T> row_y = glm::vec<3, T>(light[0][1], light[1][1], light[2][1]);
    glm::vec<3, T> row_w = glm::vec<3, T>(light[0][3], light[1][3], light[2][3]);
    // gradients of u and v, times 2 w²; a light ray is where both vanish
    glm::vec<3, T> du = row_x * clip.w - row_w * clip.x;
    glm::vec<3, T> dv = row_y * clip.w - row_w * clip.y;
    T det = jacobian[0][0] * jacobian[1][1] - jacobian[1][0] * jacobian[0][1];
    T area = glm::dot(du, du) * glm::dot(dv, dv) - glm::dot(du, dv) * glm::dot(du, dv);
    if (area > T(0) && det != T(0)) {
        T size = T(2) * clip.w * clip.w / (area * det);
        glm::vec<3, T> u = du * glm::dot(dv, dv) - dv * glm::dot(du, dv);
        glm::vec<3, T> v = dv * glm::dot(du, du) - du * glm::dot(du, dv);
        axes.u = (u * jacobian[1][1] - v * jacobian[0][1]) * (size * texel.x);
        axes.v = (v * jacobian[0][0] - u * jacobian[1][0]) * (size * texel.y);
    }
    return axes;
}

/// Distance to move a receiver along its normal so that it leaves its footprint: the same bias, in
/// the scene, and bounded at grazing light.
///
/// As a depth along the light ray it is the footprint bias exactly: offset / cosine.
/// @param normal unit normal of the receiver
/// @param axes   of the texel at the receiver
/// @param radius reach of the filter in texels, 0 for the nearest texel
template <typename T> T normal_offset(glm::vec<3, T> normal, const texel_axes<T>& axes, T radius) {
    return (radius + T(0.5)) *
           (glm::abs(glm::dot(normal, axes.u)) + glm::abs(glm::dot(normal, axes.v)));
}

/// Radii, in texels along u and v, of a filter with a fixed size in the scene.
///
/// @param axes   of the texel at the receiver, not zero
/// @param radius in the scene
template <typename T> glm::vec<2, T> filter_radii(const texel_axes<T>& axes, T radius) {
    return glm::vec<2, T>(radius / glm::length(axes.u), radius / glm::length(axes.v));
}

/// Matrix for the planes of receivers and what had to be done to get it.
template <typename T> struct plane_matrix_result {
    glm::mat<4, 4, T> matrix;
    status flags;
};

/// Matrix that carries planes (n, d) of the scene to map space with depth 0..1 from the light.
///
/// The inverse transpose of the light matrix with the map's scale and shift, in double and rounded
/// once; for `map_normal`. Reversed depth is turned round. A light matrix without an inverse gives
/// the identity and `not_invertible`.
/// @param light clip space from the scene, warps by matrices included
/// @param clip  the convention of `light`
template <typename T>
plane_matrix_result<T> map_planes(const glm::mat<4, 4, T>& light, clip_space clip) {
    const glm::mat<4, 4, double> m(light);
    const double sign = clip.reversed_z ? -1.0 : 1.0;
    const double scale = clip.depth == depth_range::zero_to_one ? 1.0 : 0.5;
    // depth from the light: z or ½z + ½, or one minus that
    const double lift = scale < 1.0 ? 0.5 : 0.0;
    const double shift = clip.reversed_z ? 1.0 - lift : lift;
    glm::mat<4, 4, double> map(0.0);
    for (glm::length_t column = 0; column < 4; ++column) {
        const glm::vec<4, double>& c = m[column];
        const double y = clip.y_down ? -c.y : c.y;
        map[column] = glm::vec<4, double>(0.5 * (c.x + c.w), 0.5 * (y + c.w),
                                          scale * sign * c.z + shift * c.w, c.w);
    }
    const glm::mat<4, 4, double> planes = glm::transpose(glm::inverse(map));
    if (!detail::fits<T>(planes)) {
        return plane_matrix_result<T>{glm::mat<4, 4, T>(T(1)), status::not_invertible};
    }
    return plane_matrix_result<T>{glm::mat<4, 4, T>(planes), status::ok};
}

} // namespace warpshadow
