#version 430 core
// A hemisphere's map with tables, second step: cuts an edge of every piece that waits. Dispatched
// until none does.
layout(local_size_x = 64) in;
#include "lab/half_pieces.glsl"
layout(std430, binding = 3) buffer waiting_pieces { half_piece waiting_list[]; };
layout(std430, binding = 5) buffer next_pieces { half_piece next_list[]; };
uniform int list;        // which of the two lists is read
uniform bool last_round; // draw what is left, cut or not

void put(half_piece t)
{
    if (is_off(t)) {
        return;
    }
    uint edge = edge_to_cut(t);
    t.triangle = (t.triangle & triangle_bits) | edge << 30u;
    if (edge == 3u) {
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
        half_piece t = waiting_list[i];
        uint edge = t.triangle >> 30u;
        vec3 a = edge == 0u ? t.p0 : edge == 1u ? t.p1 : t.p2;
        vec3 b = edge == 0u ? t.p1 : edge == 1u ? t.p2 : t.p0;
        vec3 c = edge == 0u ? t.p2 : edge == 1u ? t.p0 : t.p1;
        vec3 middle = middle_of(a, b);
        t.p0 = a;
        t.p1 = middle;
        t.p2 = c;
        put(t);
        t.p0 = middle;
        t.p1 = b;
        put(t);
    }
}
