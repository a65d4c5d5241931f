// Compute pass: one importance per column and one per row of a map (`collapse` on the host).
//
// Dispatch one invocation per column or row, whichever are more. Row 0 of the result takes the
// columns, row 1 the rows. Define WS_COLLAPSE_LARGEST for the largest cell of a line instead of the
// sum, which the caller keeps below 2^32 (`ws_weight_steps` on the host).
#ifndef WS_BINDING_COUNTS
#define WS_BINDING_COUNTS 0
#endif
#ifndef WS_BINDING_LINES
#define WS_BINDING_LINES 1
#endif

layout(local_size_x = 32) in;

layout(r32ui, binding = WS_BINDING_COUNTS) uniform readonly uimage2D ws_counts;
layout(r32ui, binding = WS_BINDING_LINES) uniform writeonly uimage2D ws_lines;

uint ws_joined(uint a, uint b)
{
#ifdef WS_COLLAPSE_LARGEST
    return max(a, b);
#else
    return a + b;
#endif
}

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    ivec2 cells = imageSize(ws_counts);
    uint line = 0u;
    if (i < cells.x) {
        for (int j = 0; j < cells.y; ++j) {
            line = ws_joined(line, imageLoad(ws_counts, ivec2(i, j)).r);
        }
        imageStore(ws_lines, ivec2(i, 0), uvec4(line));
    }
    line = 0u;
    if (i < cells.y) {
        for (int j = 0; j < cells.x; ++j) {
            line = ws_joined(line, imageLoad(ws_counts, ivec2(j, i)).r);
        }
        imageStore(ws_lines, ivec2(i, 1), uvec4(line));
    }
}
