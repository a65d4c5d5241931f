// Compute pass: running sums down the columns of a count map, in place.
//
// Afterwards row y holds the sums of rows 0 to y, and the sum of any window of rows is one
// difference: smoothing costs the same for every window. Dispatch one invocation per column.
#ifndef WS_BINDING_COUNTS
#define WS_BINDING_COUNTS 0
#endif

layout(local_size_x = 32) in;

layout(r32ui, binding = WS_BINDING_COUNTS) uniform uimage2D ws_counts;

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    ivec2 cells = imageSize(ws_counts);
    if (i >= cells.x) {
        return;
    }
    uint sum = 0u;
    for (int j = 0; j < cells.y; ++j) {
        sum += imageLoad(ws_counts, ivec2(i, j)).r;
        imageStore(ws_counts, ivec2(i, j), uvec4(sum));
    }
}
