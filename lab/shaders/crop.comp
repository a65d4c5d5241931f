#version 430 core
// One invocation: crops the light's matrix to the desired view (`crop_matrix` on the host).
#include "lab/light.glsl"
#include "warpshadow/fit.glsl"
layout(local_size_x = 1) in;
layout(std430, binding = 5) readonly buffer desired_view { uint desired_lo[2]; uint desired_hi[2]; };
uniform float margin;

void main()
{
    vec2 lo = vec2(0.0);
    vec2 hi = vec2(1.0);
    if (desired_lo[0] <= desired_hi[0]) {
        ws_widen_side(uintBitsToFloat(desired_lo[0]), uintBitsToFloat(desired_hi[0]), margin, lo.x, hi.x);
        ws_widen_side(uintBitsToFloat(desired_lo[1]), uintBitsToFloat(desired_hi[1]), margin, lo.y, hi.y);
    }
    light_matrix = ws_cropped(light_full, lo, hi);
    light_normal = transpose(inverse(light_matrix));
}
