#version 430 core
// Shadow test against paraboloids: the distances of the receiver's plane and of the caster, along
// the ray of the texel's centre; as in shadow_test.comp no bias but that of rounding.
layout(local_size_x = 16, local_size_y = 8) in;
#define OWN_VIEW_SAMPLE
#include "lab/half_map.glsl"
#include "lab/view_sample.glsl"
#include "warpshadow/paraboloid.glsl"
layout(r8ui, binding = 0) uniform writeonly uimage2D shadow_mask;
uniform sampler2DArray shadow_map; // front, back
#ifdef WARPED
#include "warpshadow/warp.glsl"
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
layout(binding = 4) uniform sampler2D centres;
#else
uniform mat3 from_world;           // to the frame of the light
#endif
uniform float far_distance;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ws_view_size();
    if (pixel.x >= size.x || pixel.y >= size.y) {
        return;
    }
    uint dark = 1u;
    vec4 world = texelFetch(g_position, pixel, 0);
#ifdef WARPED
    if (map_of(world.xyz) != map_index) {
        return;
    }
#endif
    vec3 normal = texelFetch(g_normal, pixel, 0).xyz;
    if (world.w != 0.0 && lit_cosine(world.xyz, normal) > 0.0) {
        vec2 map_size = vec2(textureSize(shadow_map, 0).xy);
#ifdef WARPED
        vec3 p = world.xyz - light_position.xyz;
        vec3 n = normal;
        int side = map_index;
        vec2 q = ws_warp(warp_rows, warp_columns, half_place(p));
        ivec2 texel = clamp(ivec2(q * map_size), ivec2(0), ivec2(map_size) - 1);
        vec3 ray = half_ray(texelFetch(centres, texel, 0).xy);
#else
        vec3 p = from_world * (world.xyz - light_position.xyz);
        vec3 n = from_world * normal;
        ws_paraboloid_point at = ws_paraboloid_lookup(p);
        int side = max(at.side, 0);
        ivec2 texel = clamp(ivec2(ws_paraboloid_map(at.uv) * map_size), ivec2(0),
                            ivec2(map_size) - 1);
        vec3 ray = ws_paraboloid_unproject((vec2(texel) + 0.5) * (2.0 / map_size) - 1.0, at.side);
#endif
        float own = ws_paraboloid_distance(p);
        float facing = -dot(n, ray);
        float away = facing > 0.0 ? -dot(n, p) / facing : -1.0;
        // edge-on to the light there is no slope to follow; the sample's own distance serves then
        if (!(away >= 0.0 && abs(away - own) <= far_distance)) {
            away = own;
        }
        float receiver = ws_paraboloid_depth(ray * away, 0.0, far_distance);
        // rounding of positions and planes, as shares of the far distance; larger where the plane
        // is seen at a flat angle
        float rounding = 4.8e-7 * (1.0 + receiver / max(facing, 1e-3));
        dark = texelFetch(shadow_map, ivec3(texel, side), 0).r < receiver - rounding ? 1u : 0u;
    }
    imageStore(shadow_mask, pixel, uvec4(dark));
}
