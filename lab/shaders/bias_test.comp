#version 430 core
// Shadow test with a bias: as shadow_test.comp, for those who want to see what biases do.
layout(local_size_x = 16, local_size_y = 8) in;
#include "lab/receiver.glsl"
#ifdef MEASURE
layout(rgba32f, binding = 0) uniform writeonly image2D measured; // bias_sample of lab/bias.hpp
#else
layout(r8ui, binding = 0) uniform writeonly uimage2D shadow_mask;
#endif

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ws_view_size();
    if (pixel.x >= size.x || pixel.y >= size.y) {
        return;
    }
    map_receiver r;
    bool faces = receiver_at(pixel, r);
#ifdef WARPED
    if (r.map != map_index) {
        return;
    }
#endif
    ivec2 texel = faces ? texel_of(r.q) : ivec2(0);
#ifdef MEASURE
    vec4 found = vec4(0.0, 0.0, 0.0, -1.0);
    if (faces) {
        float stored = texel_depth(r, texel);
        found = vec4(r.depth - stored, r.bias, r.recede,
                     stored < plane_depth(r, texel) ? 1.0 : 0.0);
    }
    imageStore(measured, pixel, found);
#else
    imageStore(shadow_mask, pixel, uvec4(!faces || is_dark(r, texel) ? 1u : 0u));
#endif
}
