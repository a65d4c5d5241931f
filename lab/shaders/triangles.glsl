#include "lab/triangle_layout.glsl"
#include "warpshadow/warp.glsl"
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;

layout(std430, binding = 6) buffer triangle_counts
{
    uint vertex_count;   // of the triangles to draw: the first word of an indirect draw
    uint instance_count;
    uint first_vertex;
    uint base_instance;
    uint waiting[2];     // triangles to cut, in either list
    uint lost;           // triangles for which there was no room
    uint crowded;        // triangles that could not wait for want of room
    uint uncut;          // triangles drawn although an edge asked for another cut
};
layout(std430, binding = 7) writeonly buffer ready_triangles { map_triangle ready[]; };

// Straight edges of the unwarped map are curves in the warped one. An edge is cut when it is long,
// or when the curve leaves the straight line by more than is allowed at a quarter, a half or three
// quarters of its length. The answer depends on the edge alone, and not on its direction:
// triangles on both sides cut it alike.
uniform float longest;   // edges above this are always cut, in map units
uniform float shortest;  // edges below this are never cut
uniform float deviation; // allowed distance of the curve from the line, in map units

bool needs_cut(vec2 a, vec2 b)
{
    float edge = distance(a, b);
    if (edge <= shortest) {
        return false;
    }
    if (edge > longest) {
        return true;
    }
    vec2 from = ws_warp(warp_rows, warp_columns, a);
    vec2 to = ws_warp(warp_rows, warp_columns, b);
    vec2 middle = ws_warp(warp_rows, warp_columns, 0.5 * (a + b));
    if (distance(middle, 0.5 * (from + to)) > deviation) {
        return true;
    }
    // over two cells and less, the middle tells all
    if (edge * float(WS_TABLE_CELLS(warp_rows)) <= 2.0) {
        return false;
    }
    vec2 near_a = ws_warp(warp_rows, warp_columns, 0.25 * (3.0 * a + b));
    vec2 near_b = ws_warp(warp_rows, warp_columns, 0.25 * (a + 3.0 * b));
    return distance(near_a, 0.25 * (3.0 * from + to)) > deviation ||
           distance(near_b, 0.25 * (from + 3.0 * to)) > deviation;
}

// Edge to cut: 0 for p0 p1, 1 for p1 p2, 2 for p2 p0, the longest of those that need it; else -1.
int edge_to_cut(map_triangle t)
{
    vec3 edges = vec3(needs_cut(t.p0, t.p1) ? distance(t.p0, t.p1) : 0.0,
                      needs_cut(t.p1, t.p2) ? distance(t.p1, t.p2) : 0.0,
                      needs_cut(t.p2, t.p0) ? distance(t.p2, t.p0) : 0.0);
    float most = max(edges.x, max(edges.y, edges.z));
    return most == 0.0 ? -1 : most == edges.x ? 0 : most == edges.y ? 1 : 2;
}

void emit_ready(map_triangle t)
{
    uint slot = atomicAdd(vertex_count, 3u) / 3u;
    if (slot < uint(ready.length())) {
        ready[slot] = t;
    } else {
        atomicAdd(lost, 1u);
    }
}
