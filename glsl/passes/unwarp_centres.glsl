// Compute pass: where the centre of each texel of the warped map lies in the unwarped map.
//
// Both the shadow pass (depth of a triangle's plane at the exact place) and the shadow test (the
// receiver's plane at the same place) read it, so neither needs a search per fragment. Each
// invocation walks down WS_CENTRES_STRIP texels of a column: neighbours are found in neighbouring
// cells, so a few look-ups each are enough. Dispatch one invocation per column and strip; those
// beyond the map return at once. Include warpshadow/warp.glsl before.
#ifndef WS_BINDING_CENTRES
#define WS_BINDING_CENTRES 0
#endif
#ifndef WS_BINDING_ROWS
#define WS_BINDING_ROWS 0
#endif
#ifndef WS_BINDING_COLUMNS
#define WS_BINDING_COLUMNS 1
#endif
#ifndef WS_CENTRES_STRIP
#define WS_CENTRES_STRIP 16
#endif

layout(local_size_x = 64) in;

layout(rg32f, binding = WS_BINDING_CENTRES) uniform writeonly image2D ws_centres;
layout(binding = WS_BINDING_ROWS) uniform sampler2D ws_rows;
layout(binding = WS_BINDING_COLUMNS) uniform sampler2D ws_columns;

void main()
{
    ivec2 size = imageSize(ws_centres);
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, WS_CENTRES_STRIP);
    if (texel.x >= size.x || texel.y >= size.y) {
        return;
    }
    vec2 q = (vec2(texel) + 0.5) / vec2(size);
    ws_row_blend column = ws_blend_rows(q.x, WS_TABLE_ROWS(ws_columns));
    // the start is where the identity would have it
    int row_cell = int(q.x * float(WS_TABLE_CELLS(ws_rows)));
    int column_cell = int(q.y * float(WS_TABLE_CELLS(ws_columns)));
    int last = min(texel.y + WS_CENTRES_STRIP, size.y);
    for (; texel.y < last; ++texel.y) {
        q.y = (float(texel.y) + 0.5) / float(size.y);
        int cell = column_cell;
        float v = q.y + ws_axis_inverse_offset_near(ws_columns, column, q.y, column_cell);
        ws_row_blend row = ws_blend_rows(v, WS_TABLE_ROWS(ws_rows));
        float u = q.x + ws_axis_inverse_offset_near(ws_rows, row, q.x, row_cell);
        imageStore(ws_centres, texel, vec4(u, v, 0.0, 0.0));
        // the next centre is about as far from here as this one from the last
        column_cell += max(column_cell - cell - 1, 0);
    }
}
