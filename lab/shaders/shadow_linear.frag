#version 430 core
// The light's own depth per fragment.
#include "warpshadow/warp.glsl"
#include "warpshadow/bias.glsl"
#include "lab/linear_depth.glsl"
in vec3 world;

void main()
{
    float warp_w = 1.0 / (gl_FragCoord.w * dot(linear_light, vec4(world, 1.0)));
    gl_FragDepth = linear_of(gl_FragCoord.z * 2.0 - 1.0, warp_w);
}
