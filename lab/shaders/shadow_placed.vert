#version 430 core
// As shadow_plain.vert, with the place in the world for the fragments.
#include "lab/light.glsl"
layout(location = 0) in vec3 position;
out vec3 world;

void main()
{
    world = position;
    gl_Position = light_matrix * vec4(position, 1.0);
}
