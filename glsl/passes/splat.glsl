// Compute pass: counts the view samples per cell (`splat` and `splat_columns` on the host).
//
// Dispatch one invocation per view sample. Declare before the include:
//   bool ws_view_sample(ivec2 pixel, out vec2 p);  // lit-facing? and its map position
//   ivec2 ws_view_size();                          // samples along x and y
// Define WS_SPLAT_COLUMNS for the second axis: samples are moved by the functions of the rows and
// the map is transposed; include warpshadow/warp.glsl then. The image is cleared by the caller.
#ifndef WS_BINDING_COUNTS
#define WS_BINDING_COUNTS 0
#endif
#ifndef WS_BINDING_ROWS
#define WS_BINDING_ROWS 0
#endif

layout(local_size_x = 16, local_size_y = 8) in;

layout(r32ui, binding = WS_BINDING_COUNTS) uniform coherent uimage2D ws_counts;

#ifdef WS_SPLAT_COLUMNS
layout(binding = WS_BINDING_ROWS) uniform sampler2D ws_rows;
#endif

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ws_view_size();
    vec2 p;
    if (pixel.x >= size.x || pixel.y >= size.y || !ws_view_sample(pixel, p)) {
        return;
    }
    ivec2 cells = imageSize(ws_counts);
#ifdef WS_SPLAT_COLUMNS
    int i = ws_cell_of(p.y, cells.x);
    if (i < 0 || ws_cell_of(p.x, 1) < 0) {
        return;
    }
    float warped = p.x + ws_axis_offset(ws_rows, ws_blend_rows(p.y, WS_TABLE_ROWS(ws_rows)), p.x);
    int j = ws_cell_of(clamp(warped, 0.0, 1.0), cells.y);
#else
    int i = ws_cell_of(p.x, cells.x);
    int j = ws_cell_of(p.y, cells.y);
    if (i < 0 || j < 0) {
        return;
    }
#endif
    imageAtomicAdd(ws_counts, ivec2(i, j), 1u);
}
