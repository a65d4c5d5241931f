// Tessellation-control stage: factors for which the outline of a warped triangle departs from the
// curve by no more than is allowed (`edge_segments` on the host).
//
// Patches of three corners, each with its place in the unwarped map and its depth there: clipped to
// the map and divided by w. The answer for an edge depends on the edge alone, to the bit, so patches
// on both sides cut it alike. Draw with tessellation_evaluation.glsl. Include
// warpshadow/warp.glsl, edge_walk.glsl and tessellation.glsl before.
#ifndef WS_BINDING_ROWS
#define WS_BINDING_ROWS 0
#endif
#ifndef WS_BINDING_COLUMNS
#define WS_BINDING_COLUMNS 1
#endif

layout(vertices = 3) out;

layout(binding = WS_BINDING_ROWS) uniform sampler2D ws_rows;
layout(binding = WS_BINDING_COLUMNS) uniform sampler2D ws_columns;

uniform float ws_allowed;      // deviation in units of the map, above 0
uniform int ws_most_segments;  // a power of two, up to gl_MaxTessGenLevel

in vec3 ws_map_place[];
out vec3 ws_corner[];

void main()
{
    ws_corner[gl_InvocationID] = ws_map_place[gl_InvocationID];
    // outer level i is that of the edge opposite to corner i
    vec2 a = ws_map_place[(gl_InvocationID + 1) % 3].xy;
    vec2 b = ws_map_place[(gl_InvocationID + 2) % 3].xy;
    gl_TessLevelOuter[gl_InvocationID] =
        float(ws_edge_segments(ws_rows, ws_columns, a, b, ws_allowed, ws_most_segments));
    barrier();
    if (gl_InvocationID == 0) {
        gl_TessLevelInner[0] = max(gl_TessLevelOuter[0],
                                   max(gl_TessLevelOuter[1], gl_TessLevelOuter[2]));
    }
}
