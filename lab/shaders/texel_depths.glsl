// Draws a triangle into a map with tables, texel by texel: a texel holds the depth of the triangle's
// plane at the place that the texel's centre has before the warp, if that place lies in the triangle.
// No rasteriser, hence no straight edges. The least depth of all is kept by its bits: a minimum is
// the same in whatever order invocations come to it, also where depths are equal.
#include "lab/triangle_sides.glsl"
layout(binding = 4) uniform sampler2D centres;
layout(r32ui, binding = 0) uniform uimage2D map_depths; // bits; storage blocks may be too small

// first and last: corners of a box of texels that holds all that it covers
void draw_texels(source_triangle t, ivec2 first, ivec2 last)
{
    // outside of the loop by hand: not all compilers move it
    vec2 along0 = t.p1 - t.p0, along1 = t.p2 - t.p1, along2 = t.p0 - t.p2;
    vec2 end0 = end_of(t.p0, t.p1), end1 = end_of(t.p1, t.p2), end2 = end_of(t.p2, t.p0);
    float depth_lo = max(t.depth_lo, 0.0);
    float depth_hi = min(t.depth_hi, 1.0);
    ivec2 at = first;
    while (at.y <= last.y) {
        vec2 p = texelFetch(centres, at, 0).xy;
        float side0 = side(along0, end0, p);
        float side1 = side(along1, end1, p);
        float side2 = side(along2, end2, p);
        if (is_inside(side0, side1, side2)) {
            float depth = clamp(t.depth0 + dot(t.depth_slope, p - t.p0), depth_lo, depth_hi);
            imageAtomicMin(map_depths, at, floatBitsToUint(depth));
        }
        at = at.x >= last.x ? ivec2(first.x, at.y + 1) : ivec2(at.x + 1, at.y);
    }
}
