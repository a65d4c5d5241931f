#version 430 core
// Both hemispheres in one pass: the geometry shader projects.
layout(location = 0) in vec3 position; // relative to the light, in its frame
layout(location = 1) in vec4 triangle_plane;
layout(location = 2) in vec2 triangle_reach;
layout(location = 3) in uint sides; // of the object, one bit each
out vec3 place;
flat out vec4 own_plane;
flat out vec2 own_reach;
flat out uint wanted;

void main()
{
    place = position;
    own_plane = triangle_plane;
    own_reach = triangle_reach;
    wanted = sides;
}
