#version 430 core
// Shadow test by volumes: in shadow is what lies in any. A count below 0 is no number of volumes: the
// rasteriser moved a corner across a pixel's centre.
layout(local_size_x = 16, local_size_y = 8) in;
#include "lab/light.glsl"
#include "lab/view_sample.glsl"
layout(r8ui, binding = 0) uniform writeonly uimage2D shadow_mask;
layout(r32f, binding = 1) uniform readonly image2D volumes;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ws_view_size();
    if (pixel.x >= size.x || pixel.y >= size.y) {
        return;
    }
    vec4 world = texelFetch(g_position, pixel, 0);
    vec3 normal = texelFetch(g_normal, pixel, 0).xyz;
    bool is_lit = world.w != 0.0 && lit_cosine(world.xyz, normal) > 0.0 &&
                  imageLoad(volumes, pixel).r <= 0.0;
    imageStore(shadow_mask, pixel, uvec4(is_lit ? 0u : 1u));
}
