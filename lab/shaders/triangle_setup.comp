#version 430 core
// Shadow pass: projects triangles, clips them and sorts what is left; with TEXELS, only writes it.
// LISTED: those of a list, and not all. CLIPPED: those that cross the bounds of the map, which else
// are put on the list.
layout(local_size_x = 64) in;
#include "lab/triangle_corners.glsl"
#include "lab/triangle_counts.glsl"
#include "lab/triangle_layout.glsl"
#ifndef TEXELS
#include "lab/triangles.glsl"
layout(std430, binding = 3) writeonly buffer waiting_triangles { waiting_piece waiting_list[]; };
#endif
layout(std430, binding = 0) writeonly buffer source_triangles { source_triangle source[]; };
#ifdef LISTED
layout(std430, binding = 1) readonly buffer listed_triangles { uint listed[]; };
#else
layout(std430, binding = 1) writeonly buffer crossing_triangles { uint crossing_list[]; };
#endif
uniform uint triangle_count;

void put(source_triangle t)
{
    if (is_thin(t.p0, t.p1, t.p2)) {
        return;
    }
    uint slot = atomicAdd(sources, 1u);
    if (slot >= uint(source.length())) {
        atomicAdd(lost, 1u);
        return;
    }
    source[slot] = t;
#ifdef TEXELS
    atomicAdd(vertex_count, 3u);
#else
    waiting_piece piece = waiting_piece(t.p0, t.p1, t.p2, slot, 0);
    if (asks_for_cut(piece, false)) {
        uint place = atomicAdd(waiting[0], 1u);
        if (place < uint(waiting_list.length())) {
            waiting_list[place] = piece;
        } else {
            atomicAdd(crowded, 1u);
            asks_for_cut(piece, true);
        }
    }
#endif
}

#ifdef CLIPPED
const int capacity = 9; // a triangle cut by six planes
vec4 polygon[capacity];
int corners;

// Keeps what has dot(plane, v) >= 0. New corners come from the symmetric formula, which gives
// both triangles of a shared edge the same bits.
void clip(vec4 plane)
{
    vec4 kept[capacity];
    int n = 0;
    for (int i = 0; i < corners; ++i) {
        vec4 a = polygon[i];
        vec4 b = polygon[i + 1 < corners ? i + 1 : 0];
        float da = dot(plane, a);
        float db = dot(plane, b);
        if (da >= 0.0 && n < capacity) {
            kept[n++] = a;
        }
        if (((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) && n < capacity) {
            float wa = abs(db);
            float wb = abs(da);
            precise vec4 cut = (wa * a + wb * b) / (wa + wb);
            kept[n++] = cut;
        }
    }
    corners = n;
    for (int i = 0; i < n; ++i) {
        polygon[i] = kept[i];
    }
}

void set_up(uint id)
{
    bvec3 below[3], above[3];
    for (int i = 0; i < 3; ++i) {
        vec4 c = in_clip_space(corner_in_world(id, i));
        polygon[i] = c;
        below[i] = lessThan(c.xyz, vec3(-c.w));
        above[i] = greaterThan(c.xyz, vec3(c.w));
    }
    corners = 3;
    // the near plane first: it leaves w > 0
    if (below[0].z || below[1].z || below[2].z) {
        clip(vec4(0.0, 0.0, 1.0, 1.0));
    }
    if (below[0].x || below[1].x || below[2].x) {
        clip(vec4(1.0, 0.0, 0.0, 1.0));
    }
    if (above[0].x || above[1].x || above[2].x) {
        clip(vec4(-1.0, 0.0, 0.0, 1.0));
    }
    if (below[0].y || below[1].y || below[2].y) {
        clip(vec4(0.0, 1.0, 0.0, 1.0));
    }
    if (above[0].y || above[1].y || above[2].y) {
        clip(vec4(0.0, -1.0, 0.0, 1.0));
    }
    if (corners < 3) {
        return;
    }

    vec3 map[capacity];
    float depth_lo = 1.0;
    float depth_hi = 0.0;
    for (int i = 0; i < corners; ++i) {
        map[i] = in_map(polygon[i]);
        depth_lo = min(depth_lo, map[i].z);
        depth_hi = max(depth_hi, map[i].z);
    }
    vec4 plane = clip_plane(id, corner_in_world(id, 0));
    if (plane.z == 0.0) {
        return; // seen edge-on: covers nothing
    }
    source_triangle t;
    t.padding = 0u;
    t.depth_slope = -plane.xy / plane.z;
    t.depth_lo = depth_lo;
    t.depth_hi = depth_hi;
    t.p0 = map[0].xy;
    t.depth0 = map[0].z;
    for (int i = 1; i + 1 < corners; ++i) {
        t.p1 = map[i].xy;
        t.p2 = map[i + 1].xy;
        put(t);
    }
}
#else
void set_up(uint id)
{
    vec3 corner = corner_in_world(id, 0);
    vec4 c0 = in_clip_space(corner);
    vec4 c1 = in_clip_space(corner_in_world(id, 1));
    vec4 c2 = in_clip_space(corner_in_world(id, 2));
#ifndef LISTED
    int place = place_of(c0, c1, c2);
    if (place == crossing_bounds) {
        crossing_list[atomicAdd(crossing, 1u)] = id;
    }
    if (place != within_bounds) {
        return;
    }
#endif
    vec3 m0 = in_map(c0);
    vec3 m1 = in_map(c1);
    vec3 m2 = in_map(c2);
    vec4 plane = clip_plane(id, corner);
    if (plane.z == 0.0) {
        return; // seen edge-on: covers nothing
    }
    put(source_triangle(m0.xy, m1.xy, m2.xy, -plane.xy / plane.z, m0.z,
                        min(1.0, min(m0.z, min(m1.z, m2.z))), max(m0.z, max(m1.z, m2.z)), 0u));
}
#endif

void main()
{
    for (uint i = gl_GlobalInvocationID.x; i < triangle_count;
         i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
#ifdef LISTED
        set_up(listed[i]);
#else
        set_up(i);
#endif
    }
}
