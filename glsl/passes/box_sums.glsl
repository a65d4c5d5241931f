// Compute pass: one more box over the rows of a map, from running sums to running sums.
//
// A tent is two boxes, the bell of a Gaussian three (`window_shape` on the host). The last of them is
// the window of build_axis.glsl; each one before takes a dispatch of this pass, one invocation per
// column. Reads the sums of column_sums.glsl, or of this pass, and writes those of the box's own sums,
// divided by a power of two so that what the next window holds of a row stays below 2^32
// (`window_shift` on the host). Running sums may wrap: their differences do not mind.
#ifndef WS_BINDING_SUMS
#define WS_BINDING_SUMS 0
#endif
#ifndef WS_BINDING_BOX_SUMS
#define WS_BINDING_BOX_SUMS 1
#endif

layout(local_size_x = 32) in;

layout(r32ui, binding = WS_BINDING_SUMS) uniform readonly uimage2D ws_sums;
layout(r32ui, binding = WS_BINDING_BOX_SUMS) uniform writeonly uimage2D ws_box_sums;

uniform int ws_radius; // half-width of the box, from ws_window_radius
uniform int ws_shift;  // exponent of the power of two

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    ivec2 cells = imageSize(ws_sums);
    if (i >= cells.x) {
        return;
    }
    uint sum = 0u;
    for (int j = 0; j < cells.y; ++j) {
        uint box = imageLoad(ws_sums, ivec2(i, min(j + ws_radius, cells.y - 1))).r;
        if (j > ws_radius) {
            box -= imageLoad(ws_sums, ivec2(i, j - ws_radius - 1)).r;
        }
        sum += box >> ws_shift;
        imageStore(ws_box_sums, ivec2(i, j), uvec4(sum));
    }
}
