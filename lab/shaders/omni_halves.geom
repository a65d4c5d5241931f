#version 430 core
// Sends a triangle to the hemispheres that its object is wanted in, one invocation per side.
#include "lab/half_corner.glsl"
layout(triangles, invocations = 2) in;
layout(triangle_strip, max_vertices = 3) out;
in vec3 place[];
flat in vec4 own_plane[];
flat in vec2 own_reach[];
flat in uint wanted[];
flat out vec4 plane;
flat out vec2 reach;
flat out int seen_from; // the side

void main()
{
    int side = gl_InvocationID;
    if ((wanted[0] >> uint(side) & 1u) == 0u) {
        return;
    }
    for (int i = 0; i < 3; ++i) {
        gl_Layer = side;
        gl_Position = half_corner(place[i], side);
        gl_ClipDistance[0] = half_clip(place[i], side);
        plane = own_plane[i];
        reach = own_reach[i];
        seen_from = side;
        EmitVertex();
    }
    EndPrimitive();
}
