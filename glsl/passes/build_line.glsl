// Compute pass: the one function of an axis from a line of importance (`build_rectilinear` on the
// host, with a Gaussian).
//
// Dispatch one work group per axis: group 0 takes row 0 of the lines of collapse.glsl and writes the
// table of u, group 1 row 1 and that of v. The line goes on mirrored beyond its ends. What is
// smoothed is rounded to whole numbers of a sum near 2^30, which are summed exactly. Include
// warpshadow/warp_build.glsl before.
#ifndef WS_BINDING_LINES
#define WS_BINDING_LINES 0
#endif
#ifndef WS_BINDING_TABLE_U
#define WS_BINDING_TABLE_U 1
#endif
#ifndef WS_BINDING_TABLE_V
#define WS_BINDING_TABLE_V 2
#endif
#define WS_LINE_GROUP 64    // lanes of a line
#define WS_LINE_CELLS 4096  // longest line
// Define WS_TABLE_FORMAT r16 for tables that are stored as UNORM16.
#ifndef WS_TABLE_FORMAT
#define WS_TABLE_FORMAT r32f
#endif

layout(local_size_x = WS_LINE_GROUP) in;

layout(r32ui, binding = WS_BINDING_LINES) uniform readonly uimage2D ws_lines;
layout(WS_TABLE_FORMAT, binding = WS_BINDING_TABLE_U) uniform writeonly image2D ws_table_u;
layout(WS_TABLE_FORMAT, binding = WS_BINDING_TABLE_V) uniform writeonly image2D ws_table_v;

uniform ivec2 ws_cells; // of the lines of u and of v, at most WS_LINE_CELLS
uniform float ws_width; // standard deviation of the Gaussian in cells, 0 for none
uniform float ws_floor; // density floor
uniform float ws_power; // of the importance of a line, positive

shared float ws_line[WS_LINE_CELLS];
shared float ws_sums[WS_LINE_GROUP];
shared uint ws_partial[WS_LINE_GROUP];

void main()
{
    int axis = int(gl_WorkGroupID.x);
    int lane = int(gl_LocalInvocationID.x);
    int cells = ws_cells[axis];
    int per_lane = (cells + WS_LINE_GROUP - 1) / WS_LINE_GROUP;
    int first = min(lane * per_lane, cells);
    int end = min(first + per_lane, cells);

    float sum = 0.0;
    for (int i = first; i < end; ++i) {
        ws_line[i] = float(imageLoad(ws_lines, ivec2(i, axis)).r);
        ws_line[i] = ws_line[i] > 0.0 ? pow(ws_line[i], ws_power) : 0.0;
        sum += ws_line[i];
    }
    ws_sums[lane] = sum;
    barrier();
    sum = 0.0;
    for (int i = 0; i < WS_LINE_GROUP; ++i) {
        sum += ws_sums[i];
    }
    // a mirrored line as wide as the Gaussian is level already
    float width = min(ws_width, float(cells));
    int reach = width > 0.0 ? int(4.9 * width) + 1 : 0;
    float weights = 1.0;
    for (int d = 1; d <= reach; ++d) {
        float x = float(d) / width;
        weights += 2.0 * exp(-0.5 * x * x);
    }
    float scale = sum > 0.0 ? 1073741824.0 / sum / weights : 0.0;
    uint smooth_cells[WS_LINE_CELLS / WS_LINE_GROUP]; // the lane's own
    uint part = 0u;
    for (int i = first; i < end; ++i) {
        float smoothed = ws_line[i];
        for (int d = 1; d <= reach; ++d) {
            float x = float(d) / width;
            int behind = (i - d + 6 * cells) % (2 * cells); // of a number that is not negative
            int ahead = (i + d) % (2 * cells);
            behind = behind < cells ? behind : 2 * cells - 1 - behind;
            ahead = ahead < cells ? ahead : 2 * cells - 1 - ahead;
            smoothed += exp(-0.5 * x * x) * (ws_line[behind] + ws_line[ahead]);
        }
        smooth_cells[i - first] = uint(smoothed * scale + 0.5);
        part += smooth_cells[i - first];
    }
    ws_partial[lane] = part;
    barrier();
    uint before = 0u;
    uint total = 0u;
    for (int i = 0; i < WS_LINE_GROUP; ++i) {
        before += i < lane ? ws_partial[i] : 0u;
        total += ws_partial[i];
    }
    for (int k = first; k < end; ++k) {
        vec4 node = vec4(ws_warp_node(before, total, k, cells, ws_floor));
        if (axis == 0) {
            imageStore(ws_table_u, ivec2(k, 0), node);
        } else {
            imageStore(ws_table_v, ivec2(k, 0), node);
        }
        before += smooth_cells[k - first];
    }
    if (lane == 0) {
        vec4 node = vec4(ws_warp_node(total, total, cells, cells, ws_floor));
        if (axis == 0) {
            imageStore(ws_table_u, ivec2(cells, 0), node);
        } else {
            imageStore(ws_table_v, ivec2(cells, 0), node);
        }
    }
}
