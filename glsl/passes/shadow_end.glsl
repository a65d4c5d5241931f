// Where the light's depth image says that a shadow may end at a point (`shadow_end_at` on the host).
//
// Not a pass but what a weight of splat.glsl may ask: the component of the axis that is splatted goes
// to `ws_edge_importance`. Include warpshadow/importance_functions.glsl, warpshadow/warp.glsl and
// warpshadow/bias.glsl before, and define WS_DEPTH_LAYER as in depth_edges.glsl to read one layer of
// an array. The depth image's unit is not the one that splat.glsl reads the rows from.
#ifndef WS_BINDING_DEPTHS
#define WS_BINDING_DEPTHS 1
#endif
#ifdef WS_DEPTH_LAYER
#define WS_DEPTH_SAMPLER sampler2DArray
#define WS_DEPTH_AT(texel) ivec3(texel, WS_DEPTH_LAYER)
#else
#define WS_DEPTH_SAMPLER sampler2D
#define WS_DEPTH_AT(texel) texel
#endif

layout(binding = WS_BINDING_DEPTHS) uniform WS_DEPTH_SAMPLER ws_depths;

// p: position in the map before a warp, and depth; normal: of its surface in map space; bias: what a
// texel may lie before that plane and still be the same surface
vec2 ws_shadow_end_in_image(vec3 p, vec3 normal, float bias)
{
    ivec2 size = textureSize(ws_depths, 0).xy;
    if (any(isnan(p.xy)) || any(isinf(p.xy))) {
        return vec2(0.0);
    }
    ivec2 corner = min(ivec2(floor(clamp(p.xy, 0.0, 1.0) * vec2(size))), size - 1);
    vec3 lit[3];
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            ivec2 texel = clamp(corner + ivec2(x, y) - 1, ivec2(0), size - 1);
            vec2 centre = (vec2(texel) + 0.5) / vec2(size);
            float plane = p.z + ws_plane_depth_step(normal, p.xy, centre, 1.0);
            lit[y][x] = texelFetch(ws_depths, WS_DEPTH_AT(texel), 0).r < plane - bias ? 0.0 : 1.0;
        }
    }
    return ws_shadow_end(lit[0], lit[1], lit[2]);
}
