#version 430 core
// A hemisphere's map with tables: each corner of a piece is projected and warped.
#include "lab/half_layout.glsl"
#include "lab/half_map.glsl"
#include "warpshadow/warp.glsl"
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
layout(std430, binding = 2) readonly buffer face_normals { vec4 face_normal[]; };
layout(std430, binding = 7) readonly buffer ready_pieces { half_piece ready[]; };
flat out vec4 plane; // dot(plane.xyz, p) = plane.w on the triangle
flat out vec2 reach; // its least and largest distance from the light

void main()
{
    half_piece t = ready[gl_VertexID / 3];
    int corner = gl_VertexID % 3;
    vec3 p = corner == 0 ? t.p0 : corner == 1 ? t.p1 : t.p2;
    vec3 normal = face_normal[t.triangle & triangle_bits].xyz;
    plane = vec4(normal, dot(normal, t.p0));
    reach = vec2(t.nearest, t.farthest);
    gl_Position = vec4(ws_warp(warp_rows, warp_columns, half_place(p)) * 2.0 - 1.0, 0.0, 1.0);
}
