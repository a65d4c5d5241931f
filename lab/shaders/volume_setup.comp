#version 430 core
// Shadow volumes, first step: which side of each triangle the light sees. Both the caps and the
// sides go by this one answer, so that rounding opens no volume.
layout(local_size_x = 64) in;
#include "lab/light.glsl"
layout(std430, binding = 0) readonly buffer positions { float position[]; };
layout(std430, binding = 1) readonly buffer indices { uint index[]; };
layout(std430, binding = 2) writeonly buffer facing_light { int facing[]; };
uniform uint triangle_count;

vec3 corner(uint i)
{
    uint at = 3u * index[i];
    return vec3(position[at], position[at + 1u], position[at + 2u]);
}

void main()
{
    for (uint id = gl_GlobalInvocationID.x; id < triangle_count;
         id += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        vec3 a = corner(3u * id);
        vec3 normal = cross(corner(3u * id + 1u) - a, corner(3u * id + 2u) - a);
        facing[id] = int(sign(dot(normal, light_position.xyz - light_position.w * a)));
    }
}
