#version 430 core
// Sum of the texels' sides at one view sample of each block of 4 x 4, in steps of 1 / 256.
layout(local_size_x = 8, local_size_y = 8) in;
#include "lab/light.glsl"
#include "lab/view_sample.glsl"
#include "warpshadow/warp.glsl"
#include "warpshadow/warp_strength.glsl"
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
layout(std430, binding = 5) buffer side_sums { uint side_sum; uint side_count; };

shared uint group_sum;
shared uint group_count;

void main()
{
    if (gl_LocalInvocationIndex == 0u) {
        group_sum = 0u;
        group_count = 0u;
    }
    barrier();
    ivec2 size = ws_view_size();
    ivec2 pixel = min(ivec2(gl_GlobalInvocationID.xy) * 4 + 1, size - 1);
    vec2 p;
    if (all(lessThan(ivec2(gl_GlobalInvocationID.xy) * 4, size)) && ws_view_sample(pixel, p)) {
        float side = min(ws_texel_side(warp_rows, warp_columns, p), 16.0);
        atomicAdd(group_sum, uint(side * 256.0 + 0.5));
        atomicAdd(group_count, 1u);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        atomicAdd(side_sum, group_sum);
        atomicAdd(side_count, group_count);
    }
}
