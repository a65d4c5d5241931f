// Compute pass: percentage closer filtering over the 2 × 2 texels around each view sample.
//
// The comparisons are weighted, not the depths (Reeves et al. 1987): bilinear, so that the shadow
// has no jump anywhere in the map. Dispatch one invocation per view sample. Declare before the
// include:
//   ivec2 ws_view_size();                        // samples along x and y
//   ivec2 ws_map_size();                         // texels along x and y
//   bool ws_receiver(ivec2 pixel, out vec2 p);   // does it face the light? and its place in the
//                                                // map as it is drawn, 0..1
//   float ws_texel_light(ivec2 pixel, ivec2 texel); // 1 lit, 0 in shadow, by this texel alone
// The last compares with a bias for taps up to half a texel beyond the sample's own: radius ½ in
// `ws_bias_settings`. Taps beyond the border repeat its texels. Where the sample does not face the
// light the image keeps what it held: several dispatches, one per map, may share it. Clear it first.
layout(local_size_x = 16, local_size_y = 8) in;

#ifndef WS_BINDING_LIGHT
#define WS_BINDING_LIGHT 0
#endif

layout(r32f, binding = WS_BINDING_LIGHT) uniform writeonly image2D ws_light; // share of the light

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ws_view_size();
    if (pixel.x >= size.x || pixel.y >= size.y) {
        return;
    }
    vec2 p;
    if (ws_receiver(pixel, p)) {
        ivec2 last = ws_map_size() - 1;
        vec2 corner = p * vec2(last + 1) - 0.5;
        ivec2 first = ivec2(floor(corner));
        vec2 weight = corner - vec2(first);
        ivec2 lo = clamp(first, ivec2(0), last);
        ivec2 hi = clamp(first + 1, ivec2(0), last);
        float below = mix(ws_texel_light(pixel, lo), ws_texel_light(pixel, ivec2(hi.x, lo.y)),
                          weight.x);
        float above = mix(ws_texel_light(pixel, ivec2(lo.x, hi.y)), ws_texel_light(pixel, hi),
                          weight.x);
        imageStore(ws_light, pixel, vec4(mix(below, above, weight.y)));
    }
}
