#version 430 core
// The distance of the triangle's plane along the ray that this texel stands for: exact, whatever
// the rasteriser interpolates.
#include "lab/half_map.glsl"
#include "warpshadow/paraboloid.glsl"
layout(binding = 4) uniform sampler2D centres;
uniform float far_distance;
flat in vec4 plane;
flat in vec2 reach;

void main()
{
    vec3 ray = half_ray(texelFetch(centres, ivec2(gl_FragCoord.xy), 0).xy);
    float along = dot(plane.xyz, ray);
    float away = along != 0.0 ? plane.w / along : -1.0;
    // a ray past the triangle, by as much as its edges are off the arcs, may miss the plane
    away = away < 0.0 ? reach.y : clamp(away, reach.x, reach.y);
    gl_FragDepth = ws_paraboloid_depth(ray * away, 0.0, far_distance);
}
