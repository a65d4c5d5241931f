#include "lab/half_layout.glsl"
#include "lab/half_map.glsl"
#include "lab/triangle_counts.glsl"
#include "warpshadow/warp.glsl"
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
layout(std430, binding = 7) writeonly buffer ready_pieces { half_piece ready[]; };

// As in triangles.glsl, but that the places between the ends of an edge are on an arc, and that more
// of them are tried. The answer depends on the edge alone: triangles on both sides cut it alike.
uniform float longest;   // edges above this are always cut, in map units
uniform float shortest;  // edges below this are never cut
uniform float deviation; // allowed distance of the curve from the line, in map units
uniform float overlap;   // sine of the angle behind the horizon that is drawn

// Where the bisector of the angle at the light meets the edge; the same bits for both directions.
vec3 middle_of(vec3 a, vec3 b)
{
    float wa = length(b);
    float wb = length(a);
    precise vec3 sum = wa * a + wb * b;
    return wa + wb > 0.0 ? sum / (wa + wb) : a;
}

// Whether places and the arcs between them, of at most that length, lie beyond one side of the map,
// by so many times what an arc may bulge.
bool off_map(vec2 lo, vec2 hi, float edge, float bulges)
{
    vec2 scale = half_scale();
    float chord = 2.0 * edge / min(scale.x, scale.y);
    vec2 margin = bulges * 0.125 * chord * chord * scale; // at least the chord's error, which is in radii
    return chord < 2.0 && (any(lessThan(hi, -margin)) || any(greaterThan(lo, 1.0 + margin)));
}

// Whether the curve is farther than that from the line at this share of its length.
bool bends(vec3 p, float share, vec2 from, vec2 to, float allowed)
{
    vec2 q = ws_warp(warp_rows, warp_columns, half_place(p));
    return distance(q, (1.0 - share) * from + share * to) > allowed;
}

bool needs_cut(vec3 a, vec3 b)
{
    // What is behind is a convex cone. Edges are left alone only well beyond what is drawn, here and
    // beside the map: where triangles near such an edge are drawn, they are cut without end.
    bool a_shows = half_shows(a, 2.0 * overlap);
    bool b_shows = half_shows(b, 2.0 * overlap);
    if (!a_shows && !b_shows) {
        return false;
    }
    vec2 place_a = half_place(a);
    vec2 place_b = half_place(b);
    float edge = distance(place_a, place_b);
    if (edge <= shortest ||
        (a_shows && b_shows && off_map(min(place_a, place_b), max(place_a, place_b), edge, 4.0))) {
        return false;
    }
    if (edge > longest) {
        return true;
    }
    // a part may bend as much as the whole where the bend is a kink: shorter edges are allowed more,
    // else triangles beside an edge that is just straight enough would be cut without end
    float allowed = deviation * min(0.6 + 0.1 * log2(longest / edge), 1.0);
    vec3 m = middle_of(a, b);
    vec2 from = ws_warp(warp_rows, warp_columns, place_a);
    vec2 to = ws_warp(warp_rows, warp_columns, place_b);
    if (bends(m, 0.5, from, to, allowed)) {
        return true;
    }
    // over two cells and less, the middle tells all
    float cells = edge * float(WS_TABLE_CELLS(warp_rows));
    if (cells <= 2.0) {
        return false;
    }
    vec3 near_a = middle_of(a, m);
    vec3 near_b = middle_of(m, b);
    if (bends(near_a, 0.25, from, to, allowed) || bends(near_b, 0.75, from, to, allowed)) {
        return true;
    }
    return cells > 4.0 && (bends(middle_of(a, near_a), 0.125, from, to, allowed) ||
                           bends(middle_of(near_a, m), 0.375, from, to, allowed) ||
                           bends(middle_of(m, near_b), 0.625, from, to, allowed) ||
                           bends(middle_of(near_b, b), 0.875, from, to, allowed));
}

float edge_length(vec3 a, vec3 b)
{
    return distance(half_place(a), half_place(b));
}

// Edge to cut: 0 for p0 p1, 1 for p1 p2, 2 for p2 p0, the longest of those that need it; 3 for none.
uint edge_to_cut(half_piece t)
{
    vec3 edges = vec3(needs_cut(t.p0, t.p1) ? edge_length(t.p0, t.p1) : 0.0,
                      needs_cut(t.p1, t.p2) ? edge_length(t.p1, t.p2) : 0.0,
                      needs_cut(t.p2, t.p0) ? edge_length(t.p2, t.p0) : 0.0);
    float most = max(edges.x, max(edges.y, edges.z));
    return most == 0.0 ? 3u : most == edges.x ? 0u : most == edges.y ? 1u : 2u;
}

// Whether nothing of a piece is on the map.
bool is_off(half_piece t)
{
    bvec3 shows = bvec3(half_shows(t.p0, overlap), half_shows(t.p1, overlap),
                        half_shows(t.p2, overlap));
    if (!any(shows)) {
        return true;
    }
    vec2 a = half_place(t.p0), b = half_place(t.p1), c = half_place(t.p2);
    float edge = max(distance(a, b), max(distance(b, c), distance(c, a)));
    return all(shows) && off_map(min(a, min(b, c)), max(a, max(b, c)), edge, 1.0);
}

void emit_ready(half_piece t)
{
    uint slot = atomicAdd(vertex_count, 3u) / 3u;
    if (slot < uint(ready.length())) {
        ready[slot] = t;
    } else {
        atomicAdd(lost, 1u);
    }
}
