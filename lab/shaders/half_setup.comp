#version 430 core
// A hemisphere's map with tables, first step: sorts the scene's triangles.
layout(local_size_x = 64) in;
#include "lab/half_pieces.glsl"
layout(std430, binding = 0) readonly buffer positions { float position[]; };
layout(std430, binding = 1) readonly buffer indices { uint index[]; };
layout(std430, binding = 2) readonly buffer face_normals { vec4 face_normal[]; };
layout(std430, binding = 3) writeonly buffer waiting_pieces { half_piece waiting_list[]; };
uniform uint triangle_count;

vec3 corner(uint i)
{
    uint at = 3u * index[i];
    return vec3(position[at], position[at + 1u], position[at + 2u]) - light_position.xyz;
}

float distance_to_edge(vec3 a, vec3 b)
{
    vec3 along = b - a;
    float square = dot(along, along);
    return length(a + (square > 0.0 ? clamp(-dot(a, along) / square, 0.0, 1.0) : 0.0) * along);
}

// Least distance of a triangle from the light.
float nearest_of(half_piece t, vec3 normal)
{
    float away = dot(normal, t.p0);
    vec3 foot = away * normal;
    bool inside = dot(cross(t.p1 - t.p0, foot - t.p0), normal) >= 0.0 &&
                  dot(cross(t.p2 - t.p1, foot - t.p1), normal) >= 0.0 &&
                  dot(cross(t.p0 - t.p2, foot - t.p2), normal) >= 0.0;
    float edges = min(distance_to_edge(t.p0, t.p1),
                      min(distance_to_edge(t.p1, t.p2), distance_to_edge(t.p2, t.p0)));
    return inside ? min(abs(away), edges) : edges;
}

void sort(uint id)
{
    half_piece t;
    t.p0 = corner(3u * id);
    t.p1 = corner(3u * id + 1u);
    t.p2 = corner(3u * id + 2u);
    if (is_off(t)) {
        return;
    }
    t.nearest = nearest_of(t, face_normal[id].xyz);
    t.farthest = max(length(t.p0), max(length(t.p1), length(t.p2)));
    uint edge = edge_to_cut(t);
    t.triangle = id | edge << 30u;
    if (edge == 3u) {
        emit_ready(t);
        return;
    }
    uint slot = atomicAdd(waiting[0], 1u);
    if (slot < uint(waiting_list.length())) {
        waiting_list[slot] = t;
    } else {
        atomicAdd(crowded, 1u);
        atomicAdd(uncut, 1u);
        emit_ready(t);
    }
}

void main()
{
    for (uint id = gl_GlobalInvocationID.x; id < triangle_count;
         id += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        sort(id);
    }
}
