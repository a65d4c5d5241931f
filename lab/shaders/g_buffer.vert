#version 430 core
// G-buffer: world position and face normal of what the camera sees.
layout(location = 0) in vec3 position;
uniform mat4 camera;
out vec3 world;

void main()
{
    world = position;
    gl_Position = camera * vec4(position, 1.0);
}
