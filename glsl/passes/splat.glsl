// Compute pass: counts the view samples per cell (`splat` and `splat_columns` on the host).
//
// Dispatch one invocation per view sample. Declare before the include:
//   bool ws_view_sample(ivec2 pixel, out vec2 p);  // lit-facing? and its map position
//   ivec2 ws_view_size();                          // samples along x and y
// Define WS_SPLAT_COLUMNS for the second axis: samples are moved by the functions of the rows and
// the map is transposed; include warpshadow/warp.glsl then. The image is cleared by the caller.
//
// Define WS_SPLAT_SUBSET to count one pixel of each block of ws_every × ws_every, at a place that
// moves from block to block, so that every column and every row of pixels has its turn. Dispatch
// one invocation per block then.
//
// Fewer atomics, the same counts:
//   WS_SPLAT_MERGED  one invocation per 2 × 2 samples (or blocks): it adds up equal cells first
//   WS_SPLAT_BALLOT  equal cells are added up across a subgroup; needs GL_ARB_shader_ballot and
//                    GL_ARB_gpu_shader_int64, enabled before
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

#ifdef WS_SPLAT_SUBSET
uniform int ws_every; // pixels along a side of a block, positive
#endif

// Cell of one sample, or of the one that stands for a block; -1 in x for none.
ivec2 ws_sample_cell(ivec2 pixel, ivec2 cells)
{
#ifdef WS_SPLAT_SUBSET
    pixel = pixel * ws_every + ivec2(uvec2(pixel.yx) % uint(ws_every));
#endif
    ivec2 size = ws_view_size();
    vec2 p;
    if (pixel.x >= size.x || pixel.y >= size.y || !ws_view_sample(pixel, p)) {
        return ivec2(-1);
    }
#ifdef WS_SPLAT_COLUMNS
    int i = ws_cell_of(p.y, cells.x);
    if (i < 0 || ws_cell_of(p.x, 1) < 0) {
        return ivec2(-1);
    }
    float warped = p.x + ws_axis_offset(ws_rows, ws_blend_rows(p.y, WS_TABLE_ROWS(ws_rows)), p.x);
    return ivec2(i, ws_cell_of(clamp(warped, 0.0, 1.0), cells.y));
#else
    int i = ws_cell_of(p.x, cells.x);
    int j = ws_cell_of(p.y, cells.y);
    return i < 0 || j < 0 ? ivec2(-1) : ivec2(i, j);
#endif
}

void main()
{
    ivec2 cells = imageSize(ws_counts);
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
#if defined(WS_SPLAT_MERGED)
    ivec2 cell = ws_sample_cell(at * 2, cells); // waits to be added, and how often
    uint count = 1u;
    for (int t = 1; t < 4; ++t) {
        // around the square: neighbours follow each other
        ivec2 next = ws_sample_cell(at * 2 + ivec2(t < 3 ? 1 : 0, t / 2), cells);
        if (next != cell) {
            if (cell.x >= 0) {
                imageAtomicAdd(ws_counts, cell, count);
            }
            cell = next;
            count = 0u;
        }
        ++count;
    }
    if (cell.x >= 0) {
        imageAtomicAdd(ws_counts, cell, count);
    }
#elif defined(WS_SPLAT_BALLOT)
    ivec2 cell = ws_sample_cell(at, cells);
    int index = cell.x < 0 ? -1 : cell.y * cells.x + cell.x;
    for (;;) {
        int leader = readFirstInvocationARB(index);
        uvec2 same = unpackUint2x32(ballotARB(index == leader));
        if (index == leader) {
            uint lowest = same.x != 0u ? uint(findLSB(same.x)) : 32u + uint(findLSB(same.y));
            if (index >= 0 && gl_SubGroupInvocationARB == lowest) {
                imageAtomicAdd(ws_counts, cell, uint(bitCount(same.x) + bitCount(same.y)));
            }
            break;
        }
    }
#else
    ivec2 cell = ws_sample_cell(at, cells);
    if (cell.x >= 0) {
        imageAtomicAdd(ws_counts, cell, 1u);
    }
#endif
}
