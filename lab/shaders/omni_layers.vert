#version 430 core
// All faces of a point light's cube in one pass: the geometry shader projects.
layout(location = 0) in vec3 position;
layout(location = 1) in uint faces; // of the object, one bit each
out vec3 world;
flat out uint wanted;

void main()
{
    world = position;
    wanted = faces;
}
