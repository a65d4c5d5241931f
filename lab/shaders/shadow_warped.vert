#version 430 core
// Shadow pass with warp tables: each corner of a cut triangle is warped.
#include "lab/triangle_layout.glsl"
#include "warpshadow/warp.glsl"
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
layout(std430, binding = 7) readonly buffer ready_triangles { map_triangle ready[]; };
flat out vec2 anchor;
flat out vec2 depth_slope;
flat out vec3 depth_bounds; // at the anchor, least, largest

void main()
{
    map_triangle t = ready[gl_VertexID / 3];
    int corner = gl_VertexID % 3;
    vec2 p = corner == 0 ? t.p0 : corner == 1 ? t.p1 : t.p2;
    anchor = t.p0;
    depth_slope = t.depth_slope;
    depth_bounds = vec3(t.depth0, t.depth_lo, t.depth_hi);
    gl_Position = vec4(ws_warp(warp_rows, warp_columns, p) * 2.0 - 1.0, 0.0, 1.0);
}
