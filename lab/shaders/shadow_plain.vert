#version 430 core
// Shadow pass without a warp: one matrix.
#include "lab/light.glsl"
layout(location = 0) in vec3 position;

void main()
{
    gl_Position = light_matrix * vec4(position, 1.0);
}
