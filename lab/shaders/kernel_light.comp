#version 430 core
// Share of the light that reaches each view sample, by a kernel of fixed size.
layout(local_size_x = 16, local_size_y = 8) in;
#include "lab/receiver.glsl"
layout(r32f, binding = 0) uniform writeonly image2D light_share;

vec2 place_of(map_receiver r, vec2 tap)
{
    if (kernel_kind == KERNEL_TEXELS) {
        return ws_tap_in_texels(r.q, tap, kernel_radius, 1.0 / vec2(textureSize(shadow_map, 0).xy));
    }
#ifdef WARPED
    if (kernel_kind == KERNEL_LIGHT) {
        return ws_tap_in_light(warp_rows, warp_columns, r.p.xy, tap, r.radii);
    }
#endif
    return ws_tap_by_jacobian(r.q, r.jacobian, tap, r.radii);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ws_view_size();
    map_receiver r;
    // other dispatches answer for other maps: what does not face this one's light keeps its value
    if (pixel.x >= size.x || pixel.y >= size.y || !receiver_at(pixel, r)) {
        return;
    }
    int across = ws_kernel_taps(r.reach, MOST_TAPS);
    int lit = 0;
    for (int i = 0; i < across * across; ++i) {
        vec2 place = place_of(r, ws_kernel_tap(i, across, vec2(0.0)));
        lit += is_dark(r, texel_of(place)) ? 0 : 1;
    }
    imageStore(light_share, pixel, vec4(float(lit) / float(across * across)));
}
