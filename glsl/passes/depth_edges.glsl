// Compute pass: edges of a light's depth image (`mark_depth_edges` on the host).
//
// Dispatch one invocation per texel; writes 1 where a neighbour's depth differs by more than the
// bias, else 0. Include warpshadow/importance_functions.glsl before, and define WS_DEPTH_SAMPLER as
// sampler2DArray to read layer 0 of an array.
#ifndef WS_BINDING_EDGES
#define WS_BINDING_EDGES 0
#endif
#ifndef WS_BINDING_DEPTHS
#define WS_BINDING_DEPTHS 0
#endif
#ifdef WS_DEPTH_LAYER
#define WS_DEPTH_SAMPLER sampler2DArray
#define WS_DEPTH_AT(texel) ivec3(texel, WS_DEPTH_LAYER)
#else
#define WS_DEPTH_SAMPLER sampler2D
#define WS_DEPTH_AT(texel) texel
#endif

layout(local_size_x = 16, local_size_y = 8) in;

layout(r8ui, binding = WS_BINDING_EDGES) uniform writeonly uimage2D ws_edges;
layout(binding = WS_BINDING_DEPTHS) uniform WS_DEPTH_SAMPLER ws_depths;

uniform float ws_edge_bias; // difference of depths that is no edge yet

float ws_depth_beside(ivec2 texel, ivec2 last)
{
    // what is outside repeats the border, and so differs by nothing new
    return texelFetch(ws_depths, WS_DEPTH_AT(clamp(texel, ivec2(0), last)), 0).r;
}

void main()
{
    ivec2 last = textureSize(ws_depths, 0).xy - 1;
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x > last.x || at.y > last.y) {
        return;
    }
    vec4 ring0 = vec4(ws_depth_beside(at + ivec2(-1, -1), last),
                      ws_depth_beside(at + ivec2(0, -1), last),
                      ws_depth_beside(at + ivec2(1, -1), last),
                      ws_depth_beside(at + ivec2(-1, 0), last));
    vec4 ring1 = vec4(ws_depth_beside(at + ivec2(1, 0), last),
                      ws_depth_beside(at + ivec2(-1, 1), last),
                      ws_depth_beside(at + ivec2(0, 1), last),
                      ws_depth_beside(at + ivec2(1, 1), last));
    bool edge = ws_depth_edge(ws_depth_beside(at, last), ring0, ring1, ws_edge_bias);
    imageStore(ws_edges, at, uvec4(edge ? 1u : 0u));
}
