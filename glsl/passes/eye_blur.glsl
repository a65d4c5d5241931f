// Compute pass: blurs the shadows in the picture, less with increasing depth (Scherzer 2005, §4.3).
//
// One iteration is two dispatches, one invocation per view sample each: ws_blur_axis (1, 0), then
// (0, 1), with the image written by the one read by the other. A sample is mixed with its two
// neighbours by the weights s/4, 1 - s/2, s/4; after n iterations the variance is n·s/2 pixels², with
//
//     s = 1 up to ws_blur_full_depth, (ws_blur_full_depth / depth)² beyond:
//
// beyond that depth the blur has one width in the scene, and distant shadows keep their details.
// Shadows do not cross silhouettes: see ws_blur_joins. Declare before the include:
//   ivec2 ws_view_size();                                        // samples along x and y
//   bool ws_blur_sample(ivec2 pixel, out float light, out float depth);
// `light` is what is blurred, 0..1; `depth` the distance along the view axis, positive. False for
// background and for what does not face the light: it gives nothing and gets 0.
layout(local_size_x = 16, local_size_y = 8) in;

#ifndef WS_BINDING_BLURRED
#define WS_BINDING_BLURRED 0
#endif

layout(r32f, binding = WS_BINDING_BLURRED) uniform writeonly image2D ws_blurred;
uniform ivec2 ws_blur_axis;
uniform float ws_blur_full_depth; // positive; very large: the same blur everywhere
uniform float ws_blur_edge;       // how far from a plane is an edge, as a share of the depth: 0.01

// 1 / depth of a sample, which is affine over the picture of a plane; 0 where there is none.
float ws_blur_nearness(ivec2 pixel)
{
    ivec2 size = ws_view_size();
    float light;
    float depth;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y ||
        !ws_blur_sample(pixel, light, depth)) {
        return 0.0;
    }
    return 1.0 / depth;
}

// Whether samples b and c lie on one surface, of four a b c d in a row: the step from b to c
// continues that before it or that after it. The order may be reversed, so no sample takes from a
// neighbour that does not take from it.
bool ws_blur_joins(float a, float b, float c, float d)
{
    float allowed = ws_blur_edge * min(b, c);
    bool before = a > 0.0 && abs((c - b) - (b - a)) <= allowed;
    bool after = d > 0.0 && abs((d - c) - (c - b)) <= allowed;
    return b > 0.0 && c > 0.0 && (before || after);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ws_view_size();
    if (pixel.x >= size.x || pixel.y >= size.y) {
        return;
    }
    float light = 0.0;
    float depth = 1.0;
    if (ws_blur_sample(pixel, light, depth)) {
        float near_2 = ws_blur_nearness(pixel - 2 * ws_blur_axis);
        float near_1 = ws_blur_nearness(pixel - ws_blur_axis);
        float here = 1.0 / depth;
        float next_1 = ws_blur_nearness(pixel + ws_blur_axis);
        float next_2 = ws_blur_nearness(pixel + 2 * ws_blur_axis);
        float share = min(ws_blur_full_depth / depth, 1.0);
        float weight = 0.25 * share * share;
        float own = light;
        float neighbour;
        float unused;
        if (ws_blur_joins(near_2, near_1, here, next_1)) {
            ws_blur_sample(pixel - ws_blur_axis, neighbour, unused);
            light += weight * (neighbour - own);
        }
        if (ws_blur_joins(near_1, here, next_1, next_2)) {
            ws_blur_sample(pixel + ws_blur_axis, neighbour, unused);
            light += weight * (neighbour - own);
        }
    } else {
        light = 0.0;
    }
    imageStore(ws_blurred, pixel, vec4(light));
}
