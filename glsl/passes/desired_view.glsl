// Compute pass: bounds of the view samples in map space (`desired_view` on the host).
//
// Dispatch one invocation per 4 × 4 view samples. Declare before the include:
//   bool ws_view_sample(ivec2 pixel, out vec2 p);  // lit-facing? and its map position
//   ivec2 ws_view_size();                          // samples along x and y
// The buffer starts as { 0x7f800000, 0x7f800000, 0, 0 }: +infinity, +infinity, 0, 0. Floats that are
// not negative order as their bits do, so integer atomics find the extremes.
#ifndef WS_BINDING_DESIRED_VIEW
#define WS_BINDING_DESIRED_VIEW 0
#endif

layout(local_size_x = 16, local_size_y = 4) in;

layout(std430, binding = WS_BINDING_DESIRED_VIEW) coherent buffer ws_desired_view_buffer
{
    uint ws_desired_lo[2];
    uint ws_desired_hi[2];
};

shared uint ws_group_lo[2];
shared uint ws_group_hi[2];

void main()
{
    if (gl_LocalInvocationIndex == 0u) {
        ws_group_lo[0] = ws_group_lo[1] = 0x7f800000u;
        ws_group_hi[0] = ws_group_hi[1] = 0u;
    }
    barrier();

    ivec2 size = ws_view_size();
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * 4;
    vec2 lo = vec2(2.0);
    vec2 hi = vec2(-1.0);
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            ivec2 pixel = first + ivec2(i, j);
            vec2 p;
            if (pixel.x < size.x && pixel.y < size.y && ws_view_sample(pixel, p) &&
                all(greaterThanEqual(p, vec2(0.0))) && all(lessThanEqual(p, vec2(1.0)))) {
                lo = min(lo, p);
                hi = max(hi, p);
            }
        }
    }
    // abs clears the sign of a negative zero, whose bits are large
    uvec2 least = floatBitsToUint(abs(lo));
    uvec2 largest = floatBitsToUint(abs(hi));
    // Bounds only ever widen: what does not widen those that are read here, however old, never will.
    // After the first groups hardly any invocation has an atomic to do.
    if (lo.x <= hi.x && (least.x < ws_desired_lo[0] || least.y < ws_desired_lo[1] ||
                         largest.x > ws_desired_hi[0] || largest.y > ws_desired_hi[1])) {
        atomicMin(ws_group_lo[0], least.x);
        atomicMin(ws_group_lo[1], least.y);
        atomicMax(ws_group_hi[0], largest.x);
        atomicMax(ws_group_hi[1], largest.y);
    }
    barrier();

    if (gl_LocalInvocationIndex == 0u && ws_group_lo[0] <= ws_group_hi[0]) {
        atomicMin(ws_desired_lo[0], ws_group_lo[0]);
        atomicMin(ws_desired_lo[1], ws_group_lo[1]);
        atomicMax(ws_desired_hi[0], ws_group_hi[0]);
        atomicMax(ws_desired_hi[1], ws_group_hi[1]);
    }
}
