#version 430 core
// Points on one face of a virtual light's cube.
layout(location = 0) in vec3 position;
uniform mat3 from_world; // to the axes of the light
uniform vec3 light;
uniform mat4 face;       // clip space from the axes of the light

void main()
{
    gl_Position = face * vec4(from_world * (position - light), 1.0);
}
