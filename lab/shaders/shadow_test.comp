#version 430 core
// Deferred shadow test: the receiver's plane and the stored depth, compared on the same ray.
//
// The stored depth belongs to the texel's centre. Where that lies in the unwarped map, the plane of
// the receiver is evaluated: for a planar receiver the comparison is exact, with no bias but that of
// rounding. Every method takes this path, so that none is judged by its bias.
layout(local_size_x = 16, local_size_y = 8) in;
#include "lab/light.glsl"
#include "lab/view_sample.glsl"
#include "lab/plane_depth.glsl"
layout(r8ui, binding = 0) uniform writeonly uimage2D shadow_mask;
uniform sampler2DArray shadow_map; // one layer per map
#ifdef WARPED
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
layout(binding = 4) uniform sampler2D centres;
#endif

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ws_view_size();
    if (pixel.x >= size.x || pixel.y >= size.y) {
        return;
    }
    uint dark = 1u;
    vec4 world = texelFetch(g_position, pixel, 0);
    int map = map_of(world.xyz);
#ifdef WARPED
    if (map != map_index) {
        return;
    }
#endif
    vec3 normal = texelFetch(g_normal, pixel, 0).xyz;
    if (world.w != 0.0 && lit_cosine(world.xyz, normal) > 0.0) {
        vec4 clip = light_maps[map].matrix * vec4(world.xyz, 1.0);
        vec3 p = clip.xyz / clip.w * 0.5 + 0.5;
        ivec2 map_size = textureSize(shadow_map, 0).xy;
#ifdef WARPED
        vec2 q = ws_warp(warp_rows, warp_columns, p.xy);
        ivec2 texel = clamp(ivec2(q * vec2(map_size)), ivec2(0), map_size - 1);
        vec2 centre = texelFetch(centres, texel, 0).xy;
#else
        ivec2 texel = clamp(ivec2(p.xy * vec2(map_size)), ivec2(0), map_size - 1);
        vec2 centre = (vec2(texel) + 0.5) / vec2(map_size);
#endif
        // clip space and map space differ by one factor on all axes: the normal is the same
        vec3 plane = ws_map_normal(light_maps[map].normal, vec4(normal, -dot(normal, world.xyz)));
        float receiver = plane_depth_at(plane, p, centre) - plane_rounding(plane);
        dark = texelFetch(shadow_map, ivec3(texel, map), 0).r < receiver ? 1u : 0u;
    }
    imageStore(shadow_mask, pixel, uvec4(dark));
}
