// Compute pass: mixes the common function into all rows, by the share that shear_limit.glsl found.
//
// Dispatch one invocation per node. 0 and 1 stay what they are.
#ifndef WS_BINDING_TABLE
#define WS_BINDING_TABLE 1
#endif
#ifndef WS_BINDING_COMMON
#define WS_BINDING_COMMON 2
#endif
#ifndef WS_BINDING_MIX
#define WS_BINDING_MIX 0
#endif
// Define WS_TABLE_FORMAT r16 for tables that are stored as UNORM16.
#ifndef WS_TABLE_FORMAT
#define WS_TABLE_FORMAT r32f
#endif

layout(local_size_x = 16, local_size_y = 8) in;

layout(WS_TABLE_FORMAT, binding = WS_BINDING_TABLE) uniform image2D ws_table;
layout(WS_TABLE_FORMAT, binding = WS_BINDING_COMMON) uniform readonly image2D ws_common;

layout(std430, binding = WS_BINDING_MIX) readonly buffer ws_mix_buffer
{
    uint ws_mix_bits;
};

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 nodes = imageSize(ws_table);
    if (at.x >= nodes.x || at.y >= nodes.y) {
        return;
    }
    float node = imageLoad(ws_table, at).r;
    float common_node = imageLoad(ws_common, ivec2(at.x, 0)).r;
    imageStore(ws_table, at, vec4(node + uintBitsToFloat(ws_mix_bits) * (common_node - node)));
}
