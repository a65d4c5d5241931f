#version 430 core
// One face of a point light's cube. The product is precise, so that the layered pass has the same
// bits.
#include "lab/light.glsl"
layout(location = 0) in vec3 position;

void main()
{
    precise vec4 clip = light_matrix * vec4(position, 1.0);
    gl_Position = clip;
}
