// View samples as receivers of a shadow map, and every way to compare their depth with a texel's.
//
// A texel holds what the map was drawn with: the depth of the matrix, or with LINEAR the light's own
// depth, brought to 0..1. WARPED: the map has tables.
#include "lab/light.glsl"
#include "lab/view_sample.glsl"
#include "lab/plane_depth.glsl"
uniform sampler2DArray shadow_map; // one layer per map
#ifdef WARPED
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
layout(binding = 4) uniform sampler2D centres;
#endif
uniform int bias_kind;     // of lab/bias.hpp
uniform vec2 bias_value;   // the constant; or the slope's factor and what is added
uniform float bias_radius; // reach of the filter in texels
#ifdef LINEAR
#include "lab/linear_depth.glsl"
#endif
#ifdef KERNEL
#include "lab/kernel.glsl"
#endif

struct map_receiver {
    int map;
    vec3 p;         // map position before a warp, depth of the matrix
    vec2 q;         // position in the map as it is drawn
    vec3 plane;     // normal in the space of p
    float depth;    // as a texel would hold it
    float gain;     // of its rounding
    float warp_w;   // LINEAR: the warp's own w; 1 / w is affine over the map
    vec2 inverse_w_slope;
    float bias;     // in units of depth, to be subtracted
    float recede;   // the bias along the light ray, in sides of a texel
#ifdef KERNEL
    mat2 jacobian;
    vec2 radii; // half the sides of the kernel before the warp
    vec2 reach; // and in texels of the map as it is drawn
#endif
};

// Texel in which a place of the map lies.
ivec2 texel_of(vec2 q)
{
    ivec2 size = textureSize(shadow_map, 0).xy;
    return clamp(ivec2(q * vec2(size)), ivec2(0), size - 1);
}

float texel_depth(map_receiver r, ivec2 texel)
{
    return texelFetch(shadow_map, ivec3(texel, r.map), 0).r;
}

// Depth of the receiver's plane at the centre of a texel, less the rounding, as the map holds it.
float plane_depth(map_receiver r, ivec2 texel)
{
#ifdef WARPED
    vec2 centre = texelFetch(centres, texel, 0).xy;
#else
    vec2 centre = (vec2(texel) + 0.5) / vec2(textureSize(shadow_map, 0).xy);
#endif
    float depth = plane_depth_at(r.plane, r.p, centre);
#ifdef LINEAR
    float inverse_w = 1.0 / r.warp_w + dot(r.inverse_w_slope, centre - r.p.xy);
    depth = linear_of(depth * 2.0 - 1.0, 1.0 / inverse_w);
#endif
    return depth - plane_rounding(r.plane) * r.gain;
}

bool is_dark(map_receiver r, ivec2 texel)
{
    float depth = bias_kind == 0 ? plane_depth(r, texel) : r.depth - r.bias;
    return texel_depth(r, texel) < depth;
}

// False for background, for what does not face the light and for what another dispatch answers.
bool receiver_at(ivec2 pixel, out map_receiver r)
{
    vec4 world = texelFetch(g_position, pixel, 0);
    vec3 normal = texelFetch(g_normal, pixel, 0).xyz;
    r.map = map_of(world.xyz);
#ifdef WARPED
    if (r.map != map_index) {
        return false;
    }
#endif
    if (world.w == 0.0 || lit_cosine(world.xyz, normal) <= 0.0) {
        return false;
    }
    mat4 matrix = light_maps[r.map].matrix;
    vec4 clip = matrix * vec4(world.xyz, 1.0);
    r.p = clip.xyz / clip.w * 0.5 + 0.5;
    // clip space and map space differ by one factor on all axes: the normal is the same
    r.plane = ws_map_normal(light_maps[r.map].normal, vec4(normal, -dot(normal, world.xyz)));
    mat2 jacobian = mat2(1.0);
#ifdef WARPED
    r.q = ws_warp(warp_rows, warp_columns, r.p.xy);
    jacobian = ws_jacobian(warp_rows, warp_columns, r.p.xy);
#else
    r.q = r.p.xy;
#endif
    vec3 slope = r.plane;
    r.depth = r.p.z;
    r.gain = 1.0;
    vec3 ray = towards_light(world.xyz);
    vec4 along = matrix * vec4(ray, 0.0);
    float per_length = 0.5 * (along.z * clip.w - clip.z * along.w) / (clip.w * clip.w);
#ifdef LINEAR
    float own_w = dot(linear_light, vec4(world.xyz, 1.0));
    float warp_w = clip.w / own_w;
    r.warp_w = warp_w;
    // normal is the inverse transpose: from clip space back to the world, then the light's own w
    r.inverse_w_slope = 2.0 * (light_maps[r.map].normal * linear_light).xy;
    r.depth = linear_of(clip.z / clip.w, warp_w);
    r.gain = max(2.0 * abs(warp_w * linear_range.x / linear_warp.x), 1.0);
    // linear depth is a quotient of clip z and w by the light's own w; two tangents of the receiver
    // carry it to the map
    vec2 of_clip = vec2(1.0, -linear_warp.y) * (linear_range.x / linear_warp.x) / own_w;
    vec3 of_place = linear_light.xyz * (dot(of_clip, clip.zw) / own_w);
    per_length = dot(of_clip, along.zw) - dot(of_place, ray);
    vec3 across = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 tangents[2];
    tangents[0] = normalize(cross(across, normal));
    tangents[1] = cross(normal, tangents[0]);
    vec3 steps[2];
    for (int i = 0; i < 2; ++i) {
        vec4 d = matrix * vec4(tangents[i], 0.0);
        steps[i] = vec3(0.5 * (d.xy * clip.w - clip.xy * d.w) / (clip.w * clip.w),
                        dot(of_clip, d.zw) - dot(of_place, tangents[i]));
    }
    slope = ws_map_normal(steps[0], steps[1]);
#endif
    vec2 size = vec2(textureSize(shadow_map, 0).xy);
    float radius = bias_radius;
#ifdef KERNEL
    r.jacobian = jacobian;
    r.radii = kernel_in_map(matrix, world.xyz);
    r.reach = kernel_in_texels(jacobian, r.radii, 1.0 / size);
    radius = max(r.reach.x, r.reach.y);
#endif
    ws_bias_settings settings = ws_settings_for(size, rounding * r.gain);
    settings.radius = radius;
    settings.largest = 1.0; // what a bias takes is to be seen, not hidden
    settings.deviation = 1.4143 * rounding * r.gain;
#ifdef LINEAR
    // over the texel the depth of a plane changes by its slope here times the ratio of 1 / w here
    // and there
    vec2 per_texel = abs(r.inverse_w_slope) * settings.texel;
    float drift = (radius + 0.5) * (per_texel.x + per_texel.y) * abs(warp_w);
    settings.slope_ratio = 1.0 / max(1.0 - drift, 1e-3);
#endif
    if (bias_kind == 2) {
        r.bias = bias_value.x;
    } else if (bias_kind == 3) {
        r.bias = ws_slope_scale_bias(ws_warped_normal(slope, jacobian), settings, bias_value.x,
                                     ws_constant_bias(bias_value.y, rounding * r.gain)).value;
    } else if (bias_kind == 4) {
#ifdef WARPED
        r.bias = ws_corner_bias(warp_rows, warp_columns, slope, r.p.xy, settings).value;
#else
        r.bias = ws_footprint_bias(slope, jacobian, settings).value;
#endif
    } else {
        r.bias = 0.0;
    }
    ws_texel_axes axes = ws_texel_axes_at(matrix, jacobian, world.xyz, 1.0 / size);
    r.recede = r.bias / (abs(per_length) * sqrt(length(cross(axes.u, axes.v))));
    return true;
}
