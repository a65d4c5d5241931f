#version 430 core
// Share of the light that reaches each view sample, by 2 × 2 texels.
#include "lab/receiver.glsl"

map_receiver receiver;

bool ws_receiver(ivec2 pixel, out vec2 p)
{
    bool faces = receiver_at(pixel, receiver);
    p = faces ? receiver.q : vec2(0.0);
    return faces;
}

ivec2 ws_map_size()
{
    return textureSize(shadow_map, 0).xy;
}

float ws_texel_light(ivec2 pixel, ivec2 texel)
{
    return is_dark(receiver, texel) ? 0.0 : 1.0;
}
#include "passes/pcf.glsl"
