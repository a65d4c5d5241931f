// What becomes of a part of a triangle: it is drawn, or one of its edges is cut.
#include "lab/triangle_counts.glsl"
#include "lab/triangle_layout.glsl"
#include "warpshadow/warp.glsl"
#include "warpshadow/edge_walk.glsl"
#include "warpshadow/tessellation.glsl"
#if RASTER == RASTER_HULL
#include "warpshadow/warped_hull.glsl"
uniform float map_texels;   // along a side
uniform float excess_floor; // what a hull may cover in vain, in units of the map
uniform float excess_share; // and that much more per unit of what it holds
#endif
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;

layout(std430, binding = 7) writeonly buffer ready_triangles { ready_piece ready[]; };

uniform float longest;      // edges above this are cut without further questions, in map units
uniform float deviation;    // allowed distance of a warped edge from its chord, in map units

void emit(vec2 q0, vec2 q1, vec2 q2, uint source)
{
    uint slot = atomicAdd(vertex_count, 3u) / 3u;
    if (slot < uint(ready.length())) {
        ready[slot] = ready_piece(q0, q1, q2, source, 0u);
    } else {
        atomicAdd(lost, 1u);
    }
}

int longest_edge(vec3 lengths)
{
    float most = max(lengths.x, max(lengths.y, lengths.z));
    return most == lengths.x ? 0 : most == lengths.y ? 1 : 2;
}

vec3 edge_lengths(waiting_piece t)
{
    return vec3(distance(t.p0, t.p1), distance(t.p1, t.p2), distance(t.p2, t.p0));
}

#if RASTER == RASTER_RULE || RASTER == RASTER_BOUND
// The answer depends on the edge alone, and not on its direction: triangles on both sides cut alike.
bool needs_cut(vec2 a, vec2 b)
{
    if (distance(a, b) > longest) {
        return true;
    }
#if RASTER == RASTER_BOUND
    return ws_edge_needs_cut(warp_rows, warp_columns, a, b, deviation);
#else
    return false;
#endif
}

#endif

// Draws the piece, or names the edge to cut: the longest of those that need it. What is not asked is
// not compiled: a vector of invocations takes all ways, and the processor's compiler skips none.
#if RASTER == RASTER_HULL
bool asks_for_cut(inout waiting_piece t, bool last)
{
    vec3 lengths = edge_lengths(t);
    t.edge = longest_edge(lengths);
    if (!last && lengths[t.edge] > longest) {
        return true;
    }
    ws_warped_hull hull = ws_hull_of_triangle(warp_rows, warp_columns, t.p0, t.p1, t.p2,
                                              0.0625 / map_texels);
    if (!last && hull.excess > excess_floor + excess_share * (hull.area - hull.excess)) {
        return true;
    }
    // a hull between the centres of texels draws nothing
    vec2 lo = min(min(hull.corner[0], hull.corner[1]), min(hull.corner[2], hull.corner[3]));
    vec2 hi = max(max(hull.corner[0], hull.corner[1]), max(hull.corner[2], hull.corner[3]));
    if (any(lessThan(floor(hi * map_texels - 0.5), ceil(lo * map_texels - 0.5)))) {
        return false;
    }
    emit(hull.corner[0], hull.corner[1], hull.corner[2], t.source);
    if (hull.corners == 4) {
        emit(hull.corner[0], hull.corner[2], hull.corner[3], t.source);
    }
    return false;
}
#else
bool asks_for_cut(inout waiting_piece t, bool last)
{
#if RASTER == RASTER_RULE || RASTER == RASTER_BOUND
    vec3 lengths = edge_lengths(t) *
                   vec3(needs_cut(t.p0, t.p1), needs_cut(t.p1, t.p2), needs_cut(t.p2, t.p0));
    t.edge = longest_edge(lengths);
    if (lengths[t.edge] > 0.0) {
        if (!last) {
            return true;
        }
        atomicAdd(uncut, 1u);
    }
#endif
    emit(ws_warp(warp_rows, warp_columns, t.p0), ws_warp(warp_rows, warp_columns, t.p1),
         ws_warp(warp_rows, warp_columns, t.p2), t.source);
    return false;
}
#endif
