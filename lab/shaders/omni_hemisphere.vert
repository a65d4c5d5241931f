#version 430 core
// One hemisphere's paraboloid map.
#include "warpshadow/paraboloid.glsl"
layout(location = 0) in vec3 position; // relative to the light, in its frame
layout(location = 1) in vec4 triangle_plane;
layout(location = 2) in vec2 triangle_reach;
uniform int side;
uniform float overlap;
flat out vec4 plane;
flat out vec2 reach;

void main()
{
    plane = triangle_plane;
    reach = triangle_reach;
    gl_Position = vec4(ws_paraboloid_uv(position, side), 0.0, 1.0);
    // of the direction: along the map it changes evenly, whatever the distances of the corners
    float away = ws_paraboloid_distance(position);
    gl_ClipDistance[0] = ws_paraboloid_clip(away > 0.0 ? position / away : position, side, overlap);
}
