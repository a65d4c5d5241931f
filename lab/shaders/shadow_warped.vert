#version 430 core
// Shadow pass with warp tables: what was made ready for the rasteriser, with the triangle it is of.
#include "lab/triangle_layout.glsl"
layout(std430, binding = 7) readonly buffer ready_triangles { ready_piece ready[]; };
layout(std430, binding = 0) readonly buffer source_triangles { source_triangle source[]; };
#ifndef INTERPOLATED
flat out vec2 anchor;
flat out vec2 depth_slope;
flat out vec3 depth_bounds; // at the anchor, least, largest
#ifdef COVERAGE
flat out vec4 others; // the other two corners
#endif
#endif

void main()
{
    ready_piece piece = ready[gl_VertexID / 3];
    source_triangle t = source[piece.source];
    int corner = gl_VertexID % 3;
    vec2 q = corner == 0 ? piece.q0 : corner == 1 ? piece.q1 : piece.q2;
#ifdef INTERPOLATED
    // the piece is the whole triangle
    vec2 p = corner == 0 ? t.p0 : corner == 1 ? t.p1 : t.p2;
    float depth = t.depth0 + dot(t.depth_slope, p - t.p0);
    gl_Position = vec4(vec3(q, clamp(depth, t.depth_lo, t.depth_hi)) * 2.0 - 1.0, 1.0);
#else
    anchor = t.p0;
    depth_slope = t.depth_slope;
    depth_bounds = vec3(t.depth0, t.depth_lo, t.depth_hi);
#ifdef COVERAGE
    others = vec4(t.p1, t.p2);
#endif
    gl_Position = vec4(q * 2.0 - 1.0, 0.0, 1.0);
#endif
}
