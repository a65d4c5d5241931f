#version 430 core
// Mixes the functions of a table with the identity.
layout(local_size_x = 16, local_size_y = 8) in;
#include "warpshadow/warp.glsl"
#include "warpshadow/warp_strength.glsl"
layout(TABLE_FORMAT, binding = 0) uniform image2D table;
uniform float share;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(table);
    if (at.x < size.x && at.y < size.y) {
        float node = imageLoad(table, at).r;
        imageStore(table, at, vec4(ws_weakened_node(node, at.x, size.x - 1, share)));
    }
}
