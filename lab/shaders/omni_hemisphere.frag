#version 430 core
// The distance of the triangle's plane along the ray of this texel's centre: exact, whatever the
// rasteriser interpolates.
#include "warpshadow/paraboloid.glsl"
uniform float far_distance;
uniform float map_size; // texels
flat in vec4 plane;
flat in vec2 reach;
flat in int seen_from; // the side

void main()
{
    vec3 ray = ws_paraboloid_unproject(gl_FragCoord.xy * (2.0 / map_size) - 1.0, seen_from);
    float along = dot(plane.xyz, ray);
    float away = along != 0.0 ? plane.w / along : -1.0;
    // a ray past the triangle, by as much as its edges are off the arcs, may miss the plane
    away = away < 0.0 ? reach.y : clamp(away, reach.x, reach.y);
    gl_FragDepth = ws_paraboloid_depth(ray * away, 0.0, far_distance);
}
