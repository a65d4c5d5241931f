#version 430 core
// Shadow pass with tables, first step: what may cover a few texels at most is drawn here, texel by
// texel. What is larger or crosses the bounds of the map is put on a list each. LISTED: the
// triangles of a list, and not all.
layout(local_size_x = 64) in;
#include "lab/triangle_corners.glsl"
#include "lab/triangle_counts.glsl"
#include "lab/triangle_layout.glsl"
#include "lab/texel_depths.glsl"
#include "warpshadow/warp.glsl"
#include "warpshadow/warped_box.glsl"
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
layout(std430, binding = 1) writeonly buffer large_triangles { uint large_list[]; };
#ifdef LISTED
layout(std430, binding = 2) readonly buffer listed_triangles { uint listed[]; };
#else
layout(std430, binding = 2) writeonly buffer crossing_triangles { uint crossing_list[]; };
#endif
uniform uint triangle_count;
uniform int list;         // for what is larger: 0 or 1
uniform float map_texels; // along a side
uniform float most_lines; // lines of the tables along a side of a triangle that is small
uniform int most_texels;  // that a small triangle may touch

void sort(uint id)
{
    vec3 corner = corner_in_world(id, 0);
    vec4 c0 = in_clip_space(corner);
    vec4 c1 = in_clip_space(corner_in_world(id, 1));
    vec4 c2 = in_clip_space(corner_in_world(id, 2));
#ifndef LISTED
    int place = place_of(c0, c1, c2);
    if (place == crossing_bounds) {
        crossing_list[atomicAdd(crossing, 1u)] = id;
    }
    if (place != within_bounds) {
        return;
    }
#endif
    vec3 m0 = in_map(c0);
    vec3 m1 = in_map(c1);
    vec3 m2 = in_map(c2);
    if (is_thin(m0.xy, m1.xy, m2.xy)) {
        return;
    }
    ws_map_box box = ws_map_box(min(m0.xy, min(m1.xy, m2.xy)), max(m0.xy, max(m1.xy, m2.xy)));
    vec2 size = (box.hi - box.lo) * float(WS_TABLE_CELLS(warp_rows));
    bool is_large = max(size.x, size.y) > most_lines;
    if (is_large) {
        box.hi = box.lo; // a vector of invocations takes the longest way of all
    }
    box = ws_warp_box(warp_rows, warp_columns, box);
    ivec2 first = ivec2(ceil(box.lo * map_texels - 0.5625));
    ivec2 last = ivec2(floor(box.hi * map_texels - 0.4375));
    first = max(first, 0);
    last = min(last, int(map_texels) - 1);
    ivec2 texels = last - first + 1;
    if (!is_large && (texels.x <= 0 || texels.y <= 0)) {
        return;
    }
    is_large = is_large || texels.x * texels.y > most_texels;
    if (is_large) {
        large_list[atomicAdd(larger[list], 1u)] = id;
        return;
    }
    vec4 plane = clip_plane(id, corner);
    if (plane.z == 0.0) {
        return; // seen edge-on: covers nothing
    }
    atomicAdd(vertex_count, 3u);
    draw_texels(source_triangle(m0.xy, m1.xy, m2.xy, -plane.xy / plane.z, m0.z,
                                min(m0.z, min(m1.z, m2.z)), max(m0.z, max(m1.z, m2.z)), 0u),
                first, last);
}

void main()
{
    for (uint i = gl_GlobalInvocationID.x; i < triangle_count;
         i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
#ifdef LISTED
        sort(listed[i]);
#else
        sort(i);
#endif
    }
}
