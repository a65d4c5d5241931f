#version 430 core
// Shadow pass, first step: projects, clips and sorts the scene's triangles.
layout(local_size_x = 64) in;
#include "lab/light.glsl"
#include "lab/triangles.glsl"
layout(std430, binding = 0) readonly buffer positions { float position[]; };
layout(std430, binding = 1) readonly buffer indices { uint index[]; };
layout(std430, binding = 2) readonly buffer face_normals { vec4 face_normal[]; };
layout(std430, binding = 8) writeonly buffer waiting_triangles { waiting_piece waiting_list[]; };
layout(std430, binding = 10) writeonly buffer source_triangles { source_triangle source[]; };
uniform uint triangle_count;

vec3 vertex(uint i)
{
    return vec3(position[3u * i], position[3u * i + 1u], position[3u * i + 2u]);
}

const float thinnest = 2.4e-7; // four roundings of a map coordinate
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

void sort(uint id)
{
    bvec3 below[3], above[3];
    for (int i = 0; i < 3; ++i) {
        vec4 c = light_matrix * vec4(vertex(index[3u * id + uint(i)]), 1.0);
        polygon[i] = c;
        below[i] = lessThan(c.xyz, vec3(-c.w));
        above[i] = greaterThan(c.xyz, vec3(c.w));
    }
    for (int axis = 0; axis < 3; ++axis) {
        if ((below[0][axis] && below[1][axis] && below[2][axis]) ||
            (above[0][axis] && above[1][axis] && above[2][axis])) {
            return;
        }
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
        map[i] = polygon[i].xyz / polygon[i].w * 0.5 + 0.5;
        depth_lo = min(depth_lo, map[i].z);
        depth_hi = max(depth_hi, map[i].z);
    }
    // the plane of the triangle in clip space; its depth as a function of the map
    vec3 normal = face_normal[id].xyz;
    vec3 corner = vertex(index[3u * id]);
    vec4 plane = light_normal * vec4(normal, -dot(normal, corner));
    if (plane.z == 0.0) {
        return; // seen edge-on: covers nothing
    }
    source_triangle t;
    t.padding = 0u;
    t.depth_slope = -plane.xy / plane.z;
    t.depth_lo = depth_lo;
    t.depth_hi = depth_hi;
    for (int i = 1; i + 1 < corners; ++i) {
        t.p0 = map[0].xy;
        t.p1 = map[i].xy;
        t.p2 = map[i + 1].xy;
        t.depth0 = map[0].z;
        // as thin as the rounding of its corners: seen edge-on, it covers no texel
        vec2 a = t.p1 - t.p0, b = t.p2 - t.p0, c = t.p2 - t.p1;
        float height = abs(a.x * b.y - a.y * b.x) / max(length(a), max(length(b), length(c)));
        if (!(height > thinnest)) {
            continue;
        }
        uint slot = atomicAdd(sources, 1u);
        if (slot >= uint(source.length())) {
            atomicAdd(lost, 1u);
            continue;
        }
        source[slot] = t;
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
    }
}

void main()
{
    for (uint id = gl_GlobalInvocationID.x; id < triangle_count;
         id += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        sort(id);
    }
}
