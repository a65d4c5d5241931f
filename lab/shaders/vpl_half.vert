#version 430 core
// Points on one paraboloid of a virtual light. A point has no edges that would bend.
#include "warpshadow/paraboloid.glsl"
layout(location = 0) in vec3 position;
uniform mat3 from_world; // to the axes of the light
uniform vec3 light;
uniform float reach;
uniform int side;

void main()
{
    vec3 p = from_world * (position - light);
    gl_Position = vec4(ws_paraboloid_uv(p, side), ws_paraboloid_depth(p, 0.0, reach) * 2.0 - 1.0, 1.0);
    gl_ClipDistance[0] = ws_paraboloid_clip(p, side, 0.0);
}
