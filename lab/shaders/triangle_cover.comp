#version 430 core
// Shadow pass with tables, third step: draws large triangles into the blocks that they may cover.
layout(local_size_x = 64) in;
#include "lab/triangle_layout.glsl"
#include "lab/texel_depths.glsl"
layout(std430, binding = 0) readonly buffer source_triangles { source_triangle source[]; };
layout(std430, binding = 1) readonly buffer block_pairs { uvec2 pair[]; }; // source, block
uniform uint pair_count;
uniform int block_columns; // blocks along a side

void main()
{
    for (uint i = gl_GlobalInvocationID.x; i < pair_count;
         i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        int block = int(pair[i].y);
        ivec2 first = block_side * ivec2(block % block_columns, block / block_columns);
        ivec2 last = min(first + block_side, textureSize(centres, 0)) - 1;
        draw_texels(source[pair[i].x], first, last);
    }
}
