// Compute pass: share of the common function with which an axis keeps its shear limit
// (`build_options::shear` and `measure_band` on the host).
//
// Dispatch one work group per pair of neighbouring rows. The common function is what build_axis.glsl
// makes of one row with a window of all rows. The buffer starts as 0: floats that are not negative
// order as their bits do. Nodes are floats here: the share is that of the host to about
// rows · 2^-20 / shear, and the limit holds to as much.
#ifndef WS_BINDING_TABLE
#define WS_BINDING_TABLE 1
#endif
#ifndef WS_BINDING_COMMON
#define WS_BINDING_COMMON 2
#endif
#ifndef WS_BINDING_MIX
#define WS_BINDING_MIX 0
#endif
#define WS_SHEAR_GROUP 64 // lanes of a pair
// Define WS_TABLE_FORMAT r16 for tables that are stored as UNORM16.
#ifndef WS_TABLE_FORMAT
#define WS_TABLE_FORMAT r32f
#endif

layout(local_size_x = WS_SHEAR_GROUP) in;

layout(WS_TABLE_FORMAT, binding = WS_BINDING_TABLE) uniform readonly image2D ws_table;
layout(WS_TABLE_FORMAT, binding = WS_BINDING_COMMON) uniform readonly image2D ws_common;

layout(std430, binding = WS_BINDING_MIX) coherent buffer ws_mix_buffer
{
    uint ws_mix_bits;
};

uniform float ws_shear; // the limit, not negative

shared uint ws_group_mix;

void main()
{
    int row = int(gl_WorkGroupID.x);
    int lane = int(gl_LocalInvocationID.x);
    ivec2 nodes = imageSize(ws_table);
    if (lane == 0) {
        ws_group_mix = 0u;
    }
    barrier();
    float slope = ws_shear * float(nodes.x - 1);
    float most = 0.0;
    for (int k = 1 + lane; k < nodes.x; k += WS_SHEAR_GROUP) {
        vec2 before = vec2(imageLoad(ws_table, ivec2(k - 1, row)).r,
                           imageLoad(ws_table, ivec2(k - 1, row + 1)).r);
        vec2 at = vec2(imageLoad(ws_table, ivec2(k, row)).r,
                       imageLoad(ws_table, ivec2(k, row + 1)).r);
        vec2 steps = at - before;
        float difference = max(abs(before.y - before.x), abs(at.y - at.x));
        float over = float(nodes.y) * difference - slope * min(steps.x, steps.y);
        if (over > 0.0) {
            float relief = slope * (imageLoad(ws_common, ivec2(k, 0)).r -
                                    imageLoad(ws_common, ivec2(k - 1, 0)).r);
            most = max(most, over / (over + relief));
        }
    }
    if (most > 0.0) {
        atomicMax(ws_group_mix, floatBitsToUint(most));
    }
    barrier();
    if (lane == 0 && ws_group_mix > 0u) {
        atomicMax(ws_mix_bits, ws_group_mix);
    }
}
