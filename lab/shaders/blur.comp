#version 430 core
#include "lab/light.glsl"
#define OWN_VIEW_SAMPLE
#include "lab/view_sample.glsl"
layout(binding = 4) uniform sampler2D light_share;
uniform vec4 view_depth_plane;

bool ws_view_sample(ivec2 pixel, out vec2 p)
{
    p = vec2(0.0);
    return false;
}

bool ws_blur_sample(ivec2 pixel, out float light, out float depth)
{
    vec4 world = texelFetch(g_position, pixel, 0);
    light = texelFetch(light_share, pixel, 0).r;
    depth = dot(view_depth_plane, vec4(world.xyz, 1.0));
    return world.w != 0.0 && lit_cosine(world.xyz, texelFetch(g_normal, pixel, 0).xyz) > 0.0;
}
#include "passes/eye_blur.glsl"
