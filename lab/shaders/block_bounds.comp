#version 430 core
// Where the centres of a block of texels lie before the warp: a box for each block of the map.
layout(local_size_x = 8, local_size_y = 8) in;
#include "lab/triangle_layout.glsl"
layout(binding = 4) uniform sampler2D centres;
layout(binding = 1, rgba32f) uniform writeonly image2D block_bounds;

void main()
{
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    ivec2 last = textureSize(centres, 0) - 1;
    if (any(greaterThan(block * block_side, last))) {
        return;
    }
    vec2 lo = vec2(1.0);
    vec2 hi = vec2(0.0);
    for (int i = 0; i < block_side * block_side; ++i) {
        ivec2 at = min(block * block_side + ivec2(i % block_side, i / block_side), last);
        vec2 p = texelFetch(centres, at, 0).xy;
        lo = min(lo, p);
        hi = max(hi, p);
    }
    imageStore(block_bounds, block, vec4(lo, hi));
}
