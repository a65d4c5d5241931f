#version 430 core
// Shadow pass with tables, second step: which blocks of texels a large triangle may cover. Pairs are
// counted also where there is no room for them. An invocation takes every so many rows of blocks:
// llvmpipe leaves a loop after 65,535 rounds without a word.
layout(local_size_x = 64) in;
#include "lab/triangle_counts.glsl"
#include "lab/triangle_layout.glsl"
#include "warpshadow/warp.glsl"
#include "warpshadow/warped_box.glsl"
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
layout(binding = 5) uniform sampler2D block_bounds;
layout(std430, binding = 0) readonly buffer source_triangles { source_triangle source[]; };
layout(std430, binding = 1) writeonly buffer block_pairs { uvec2 pair[]; }; // source, block
uniform uint first_source;
uniform uint source_count;
uniform uint strips;
uniform float map_texels;  // along a side
uniform int block_columns; // blocks along a side

// Many roundings of what decides whether a place is in a triangle.
const float rounding = 2e-6;

// Least and largest that the side of an edge is over a box, with its rounding.
vec2 sides_of_box(vec2 a, vec2 b, vec2 centre, vec2 reach)
{
    vec2 across = vec2(a.y - b.y, b.x - a.x);
    float middle = dot(across, centre - a);
    float spread = dot(abs(across), reach);
    return vec2(middle - spread, middle + spread);
}

bool may_cover(source_triangle t, vec4 box)
{
    vec2 centre = (box.xy + box.zw) * 0.5;
    vec2 reach = (box.zw - box.xy) * 0.5 + rounding;
    vec2 a = sides_of_box(t.p0, t.p1, centre, reach);
    vec2 b = sides_of_box(t.p1, t.p2, centre, reach);
    vec2 c = sides_of_box(t.p2, t.p0, centre, reach);
    // the inside is on the same side of all edges, whichever that is
    return min(a.y, min(b.y, c.y)) >= 0.0 || max(a.x, max(b.x, c.x)) <= 0.0;
}

void spread(uint id, int strip)
{
    source_triangle t = source[id];
    ws_map_box box = ws_warp_box(warp_rows, warp_columns,
                                 ws_map_box(min(t.p0, min(t.p1, t.p2)), max(t.p0, max(t.p1, t.p2))));
    ivec2 most = ivec2(map_texels) - 1;
    ivec2 first = clamp(ivec2(ceil(box.lo * map_texels - 0.5625)), ivec2(0), most) / block_side;
    ivec2 last = clamp(ivec2(floor(box.hi * map_texels - 0.4375)), ivec2(0), most) / block_side;
    ivec2 at = ivec2(first.x, first.y + strip);
    while (at.y <= last.y) {
        if (may_cover(t, texelFetch(block_bounds, at, 0))) {
            uint slot = atomicAdd(pairs, 1u);
            if (slot < uint(pair.length())) {
                pair[slot] = uvec2(id, at.y * block_columns + at.x);
            }
        }
        at = at.x >= last.x ? ivec2(first.x, at.y + int(strips)) : ivec2(at.x + 1, at.y);
    }
}

void main()
{
    for (uint i = gl_GlobalInvocationID.x; i < source_count * strips;
         i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        spread(first_source + i / strips, int(i % strips));
    }
}
