// Compute pass: adds up the view samples per cell (`splat`, `splat_weighted`, `splat_columns` and
// `splat_columns_weighted` on the host).
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
// Samples count 1 each, unless it is said what they weigh:
//   WS_SPLAT_WEIGHTED   declare uint ws_sample_weight(ivec2 pixel, vec2 p), see ws_weight_in_steps
//   WS_SPLAT_LARGEST    besides: a cell keeps the largest weight, not the sum
//   WS_SPLAT_CLASSES n  declare int ws_sample_class(ivec2 pixel, vec2 p), 0 to n - 1: each class
//                       has an image of its own, the next one above the last in one tall image
//
// Fewer atomics, the same counts:
//   WS_SPLAT_MERGED  one invocation per 2 × 2 samples (or blocks): it adds up equal cells first
//   WS_SPLAT_BALLOT  equal cells are added up across a subgroup; needs GL_ARB_shader_ballot and
//                    GL_ARB_gpu_shader_int64, enabled before; not for weights
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

#ifdef WS_SPLAT_CLASSES
#define WS_SPLAT_IMAGES WS_SPLAT_CLASSES
#else
#define WS_SPLAT_IMAGES 1
#endif

// Cell of one sample, or of the one that stands for a block, and what it weighs; -1 in x for none.
ivec2 ws_sample_cell(ivec2 pixel, ivec2 cells, out uint weight)
{
    weight = 0u;
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
    int j = ws_cell_of(clamp(warped, 0.0, 1.0), cells.y);
#else
    int i = ws_cell_of(p.x, cells.x);
    int j = ws_cell_of(p.y, cells.y);
    if (i < 0 || j < 0) {
        return ivec2(-1);
    }
#endif
#ifdef WS_SPLAT_WEIGHTED
    weight = ws_sample_weight(pixel, p);
#else
    weight = 1u;
#endif
#ifdef WS_SPLAT_CLASSES
    j += ws_sample_class(pixel, p) * cells.y;
#endif
    return ivec2(i, j);
}

void ws_add_to_cell(ivec2 cell, uint weight)
{
    if (cell.x >= 0) {
#ifdef WS_SPLAT_LARGEST
        imageAtomicMax(ws_counts, cell, weight);
#else
        imageAtomicAdd(ws_counts, cell, weight);
#endif
    }
}

void main()
{
    ivec2 cells = imageSize(ws_counts);
    cells.y /= WS_SPLAT_IMAGES;
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    uint weight;
#if defined(WS_SPLAT_MERGED)
    ivec2 cell = ws_sample_cell(at * 2, cells, weight); // waits to be added, and its weight
    for (int t = 1; t < 4; ++t) {
        // around the square: neighbours follow each other
        uint other;
        ivec2 next = ws_sample_cell(at * 2 + ivec2(t < 3 ? 1 : 0, t / 2), cells, other);
        if (next != cell) {
            ws_add_to_cell(cell, weight);
            cell = next;
            weight = other;
            continue;
        }
#ifdef WS_SPLAT_LARGEST
        weight = max(weight, other);
#else
        weight += other;
#endif
    }
    ws_add_to_cell(cell, weight);
#elif defined(WS_SPLAT_BALLOT)
    ivec2 cell = ws_sample_cell(at, cells, weight);
    int index = cell.x < 0 ? -1 : cell.y * imageSize(ws_counts).x + cell.x;
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
    ws_add_to_cell(ws_sample_cell(at, cells, weight), weight);
#endif
}
