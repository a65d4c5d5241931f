#version 430 core
// Shadow pass, second step: halves an edge of every triangle that waits. Dispatched until none does.
layout(local_size_x = 64) in;
#include "lab/triangles.glsl"
layout(std430, binding = 8) buffer waiting_triangles { map_triangle waiting_list[]; };
layout(std430, binding = 9) buffer next_triangles { map_triangle next_list[]; };
uniform int list;        // which of the two lists is read
uniform bool last_round; // draw what is left, cut or not

void put(map_triangle t)
{
    t.edge = edge_to_cut(t);
    if (t.edge < 0) {
        emit_ready(t);
        return;
    }
    if (!last_round) {
        uint slot = atomicAdd(waiting[1 - list], 1u);
        if (slot < uint(next_list.length())) {
            next_list[slot] = t;
            return;
        }
        atomicAdd(crowded, 1u);
    }
    atomicAdd(uncut, 1u);
    emit_ready(t);
}

void main()
{
    uint count = min(waiting[list], uint(waiting_list.length()));
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) {
        map_triangle t = waiting_list[i];
        // turn it to p0 p1; depth0 belongs to the corner that was p0
        vec2 anchor = t.p0;
        if (t.edge == 1) {
            vec2 p0 = t.p0;
            t.p0 = t.p1;
            t.p1 = t.p2;
            t.p2 = p0;
        } else if (t.edge == 2) {
            vec2 p2 = t.p2;
            t.p2 = t.p1;
            t.p1 = t.p0;
            t.p0 = p2;
        }
        precise vec2 middle = (t.p0 + t.p1) * 0.5;
        map_triangle left = t;
        map_triangle right = t;
        left.p1 = middle;
        right.p0 = middle;
        left.depth0 = t.depth0 + dot(t.depth_slope, left.p0 - anchor);
        right.depth0 = t.depth0 + dot(t.depth_slope, right.p0 - anchor);
        put(left);
        put(right);
    }
}
