// Compute pass: where the centre of each texel of the warped map lies in the unwarped map.
//
// Dispatch one invocation per texel. Both the shadow pass (depth of a triangle's plane at the exact
// place) and the shadow test (the receiver's plane at the same place) read it, so neither needs a
// search per fragment. Include warpshadow/warp.glsl before.
#ifndef WS_BINDING_CENTRES
#define WS_BINDING_CENTRES 0
#endif
#ifndef WS_BINDING_ROWS
#define WS_BINDING_ROWS 0
#endif
#ifndef WS_BINDING_COLUMNS
#define WS_BINDING_COLUMNS 1
#endif

layout(local_size_x = 16, local_size_y = 8) in;

layout(rg32f, binding = WS_BINDING_CENTRES) uniform writeonly image2D ws_centres;
layout(binding = WS_BINDING_ROWS) uniform sampler2D ws_rows;
layout(binding = WS_BINDING_COLUMNS) uniform sampler2D ws_columns;

void main()
{
    ivec2 size = imageSize(ws_centres);
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x < size.x && texel.y < size.y) {
        vec2 q = (vec2(texel) + 0.5) / vec2(size);
        imageStore(ws_centres, texel, vec4(ws_unwarp(ws_rows, ws_columns, q), 0.0, 0.0));
    }
}
