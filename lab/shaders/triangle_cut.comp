#version 430 core
// Shadow pass, second step: halves an edge of every piece that waits. Dispatched until none does.
layout(local_size_x = 64) in;
#include "lab/triangles.glsl"
layout(std430, binding = 3) buffer waiting_triangles { waiting_piece waiting_list[]; };
layout(std430, binding = 5) buffer next_triangles { waiting_piece next_list[]; };
uniform int list;        // which of the two lists is read
uniform bool last_round; // draw what is left, cut or not

void put(waiting_piece t)
{
    if (!asks_for_cut(t, last_round)) {
        return;
    }
    uint slot = atomicAdd(waiting[1 - list], 1u);
    if (slot < uint(next_list.length())) {
        next_list[slot] = t;
        return;
    }
    atomicAdd(crowded, 1u);
    asks_for_cut(t, true);
}

waiting_piece half_of(waiting_piece t, bool second)
{
    // turn the edge to p0 p1
    vec2 p0 = t.edge == 0 ? t.p0 : t.edge == 1 ? t.p1 : t.p2;
    vec2 p1 = t.edge == 0 ? t.p1 : t.edge == 1 ? t.p2 : t.p0;
    vec2 p2 = t.edge == 0 ? t.p2 : t.edge == 1 ? t.p0 : t.p1;
    precise vec2 middle = (p0 + p1) * 0.5;
    return waiting_piece(second ? middle : p0, second ? p1 : middle, p2, t.source, 0);
}

void main()
{
    uint count = min(waiting[list], uint(waiting_list.length()));
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) {
        waiting_piece t = waiting_list[i];
        // one call in a loop: the compiler copies what it calls
#if RASTER == RASTER_HULL
        // hulls need not agree from triangle to triangle: their pieces are halved twice at once
        for (int part = 0; part < 4; ++part) {
            waiting_piece piece = half_of(t, (part & 1) != 0);
            piece.edge = longest_edge(edge_lengths(piece));
            put(half_of(piece, (part & 2) != 0));
        }
#else
        for (int part = 0; part < 2; ++part) {
            put(half_of(t, part == 1));
        }
#endif
    }
}
