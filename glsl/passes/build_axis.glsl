// Compute pass: functions of one axis from running column sums (`build_axis` on the host).
//
// Dispatch one work group per row. Reads the sums of column_sums.glsl, takes the window of 2r + 1
// rows around its own as a difference, scans it, and writes the w + 1 nodes of its function.
// Include warpshadow/warp_build.glsl before.
//
// Define WS_BUILD_POWER to raise what a window counts to a power; include warpshadow/importance.glsl
// before, too. An error that falls with the density of texels, summed over samples, is least when
// the density goes with the root of their number: a power of ½ where each axis errs by itself. The
// caller keeps the sum of a row, which is largest where all cells count alike, below 2^32 steps.
#ifndef WS_BINDING_SUMS
#define WS_BINDING_SUMS 0
#endif
#ifndef WS_BINDING_TABLE
#define WS_BINDING_TABLE 1
#endif
// Define WS_TABLE_FORMAT r16 for tables that are stored as UNORM16.
#ifndef WS_TABLE_FORMAT
#define WS_TABLE_FORMAT r32f
#endif
#define WS_BUILD_GROUP 64 // lanes of a row
#define WS_BUILD_BLOCK 8  // lanes whose sums are added up by one of them

layout(local_size_x = WS_BUILD_GROUP) in;

layout(r32ui, binding = WS_BINDING_SUMS) uniform readonly uimage2D ws_sums;
layout(WS_TABLE_FORMAT, binding = WS_BINDING_TABLE) uniform writeonly image2D ws_table;

uniform int ws_radius;  // half-width of the window, from ws_window_radius
uniform float ws_floor; // density floor
#ifdef WS_BUILD_POWER
uniform float ws_power;       // positive
uniform float ws_power_steps; // steps in an importance of 1, see `ws_weight_in_steps`
#endif

shared uint ws_partial[WS_BUILD_GROUP];
shared uint ws_blocks[WS_BUILD_GROUP / WS_BUILD_BLOCK];

uint ws_window_count(int i, int row, int last)
{
    uint count = imageLoad(ws_sums, ivec2(i, min(row + ws_radius, last))).r;
    if (row > ws_radius) {
        count -= imageLoad(ws_sums, ivec2(i, row - ws_radius - 1)).r;
    }
#ifdef WS_BUILD_POWER
    float weight = count > 0u ? pow(float(count), ws_power) : 0.0;
    return ws_weight_in_steps(weight, ws_power_steps);
#else
    return count;
#endif
}

void main()
{
    ivec2 cells = imageSize(ws_sums);
    int row = int(gl_WorkGroupID.x);
    int lane = int(gl_LocalInvocationID.x);
    int per_lane = (cells.x + WS_BUILD_GROUP - 1) / WS_BUILD_GROUP;
    int first = min(lane * per_lane, cells.x);
    int end = min(first + per_lane, cells.x);

    uint sum = 0u;
    for (int i = first; i < end; ++i) {
        sum += ws_window_count(i, row, cells.y - 1);
    }
    ws_partial[lane] = sum;
    barrier();
    // two levels, two barriers: reading a few sums more costs less than waiting at every doubling
    if (lane < WS_BUILD_GROUP / WS_BUILD_BLOCK) {
        uint block = 0u;
        for (int i = 0; i < WS_BUILD_BLOCK; ++i) {
            block += ws_partial[lane * WS_BUILD_BLOCK + i];
        }
        ws_blocks[lane] = block;
    }
    barrier();
    uint before = 0u;
    uint total = 0u;
    int own = lane / WS_BUILD_BLOCK;
    for (int i = 0; i < WS_BUILD_GROUP / WS_BUILD_BLOCK; ++i) {
        before += i < own ? ws_blocks[i] : 0u;
        total += ws_blocks[i];
    }
    for (int i = own * WS_BUILD_BLOCK; i < (own + 1) * WS_BUILD_BLOCK; ++i) {
        before += i < lane ? ws_partial[i] : 0u;
    }

    for (int k = first; k < end; ++k) {
        imageStore(ws_table, ivec2(k, row),
                   vec4(ws_warp_node(before, total, k, cells.x, ws_floor)));
        before += ws_window_count(k, row, cells.y - 1);
    }
    if (lane == 0) {
        imageStore(ws_table, ivec2(cells.x, row),
                   vec4(ws_warp_node(total, total, cells.x, cells.x, ws_floor)));
    }
}
