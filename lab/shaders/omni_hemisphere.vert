#version 430 core
// One hemisphere's paraboloid map.
#include "lab/half_corner.glsl"
layout(location = 0) in vec3 position; // relative to the light, in its frame
layout(location = 1) in vec4 triangle_plane;
layout(location = 2) in vec2 triangle_reach;
uniform int side;
flat out vec4 plane;
flat out vec2 reach;
flat out int seen_from; // the side

void main()
{
    plane = triangle_plane;
    reach = triangle_reach;
    seen_from = side;
    gl_Position = half_corner(position, side);
    gl_ClipDistance[0] = half_clip(position, side);
}
