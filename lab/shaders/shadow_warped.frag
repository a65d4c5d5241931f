#version 430 core
// The depth of the triangle's plane at the place that this texel stands for: exact, whatever the
// rasteriser interpolates.
layout(binding = 4) uniform sampler2D centres;
flat in vec2 anchor;
flat in vec2 depth_slope;
flat in vec3 depth_bounds;

void main()
{
    vec2 p = texelFetch(centres, ivec2(gl_FragCoord.xy), 0).xy;
    float depth = depth_bounds.x + dot(depth_slope, p - anchor);
    gl_FragDepth = clamp(depth, depth_bounds.y, depth_bounds.z);
}
