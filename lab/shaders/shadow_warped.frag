#version 430 core
// The depth of the triangle's plane at the place that this texel stands for: exact, whatever the
// rasteriser interpolates. COVERAGE: and only where that place lies in the triangle.
layout(binding = 4) uniform sampler2D centres;
flat in vec2 anchor;
flat in vec2 depth_slope;
flat in vec3 depth_bounds;
#ifdef COVERAGE
#include "lab/triangle_sides.glsl"
flat in vec4 others;
#endif

void main()
{
    vec2 p = texelFetch(centres, ivec2(gl_FragCoord.xy), 0).xy;
#ifdef COVERAGE
    vec2 p0 = anchor, p1 = others.xy, p2 = others.zw;
    if (!is_inside(side(p1 - p0, end_of(p0, p1), p), side(p2 - p1, end_of(p1, p2), p),
                   side(p0 - p2, end_of(p2, p0), p))) {
        discard;
    }
#endif
    float depth = depth_bounds.x + dot(depth_slope, p - anchor);
    gl_FragDepth = clamp(depth, depth_bounds.y, depth_bounds.z);
}
