// Tessellation-evaluation stage: warps what tessellation_control.glsl has cut.
//
// Places are interpolated in the unwarped map, where edges are straight and pieces equal. Include
// warpshadow/warp.glsl before.
#ifndef WS_BINDING_ROWS
#define WS_BINDING_ROWS 0
#endif
#ifndef WS_BINDING_COLUMNS
#define WS_BINDING_COLUMNS 1
#endif

layout(triangles, equal_spacing, ccw) in;

layout(binding = WS_BINDING_ROWS) uniform sampler2D ws_rows;
layout(binding = WS_BINDING_COLUMNS) uniform sampler2D ws_columns;

in vec3 ws_corner[];

void main()
{
    // precise: on an edge both patches must add the same two products to the same sum
    precise vec3 p = gl_TessCoord.x * ws_corner[0] + gl_TessCoord.y * ws_corner[1] +
                     gl_TessCoord.z * ws_corner[2];
    gl_Position = vec4(vec3(ws_warp(ws_rows, ws_columns, p.xy), p.z) * 2.0 - 1.0, 1.0);
#ifdef WS_AFTER_WARP
    WS_AFTER_WARP // statements of yours
#endif
}
