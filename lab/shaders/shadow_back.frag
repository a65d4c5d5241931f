#version 430 core
// Faces that look away from the light alone, by their winding.
#include "lab/light.glsl"
in vec3 world;
layout(std430, binding = 0) readonly buffer face_normals { vec4 face_normal[]; };

void main()
{
    if (dot(face_normal[gl_PrimitiveID].xyz, towards_light(world)) >= 0.0) {
        discard;
    }
}
