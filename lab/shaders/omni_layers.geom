#version 430 core
// Sends a triangle to the faces that its object is wanted in, one invocation per face.
#include "lab/light.glsl"
layout(triangles, invocations = 6) in;
layout(triangle_strip, max_vertices = 3) out;
in vec3 world[];
flat in uint wanted[];

void main()
{
    int face = gl_InvocationID;
    if ((wanted[0] >> uint(face) & 1u) == 0u) {
        return;
    }
    for (int i = 0; i < 3; ++i) {
        precise vec4 clip = light_maps[face].matrix * vec4(world[i], 1.0);
        gl_Layer = face;
        gl_Position = clip;
        EmitVertex();
    }
    EndPrimitive();
}
