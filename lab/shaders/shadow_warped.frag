#version 430 core
// The depth of the triangle's plane at the place that this texel stands for: exact, whatever the
// rasteriser interpolates. COVERAGE: and only where that place lies in the triangle.
layout(binding = 4) uniform sampler2D centres;
flat in vec2 anchor;
flat in vec2 depth_slope;
flat in vec3 depth_bounds;
#ifdef COVERAGE
flat in vec4 others;

// On which side of an edge p lies. From the same end for both triangles on the edge, so that none of
// both can miss what the other does not take.
float side(vec2 a, vec2 b, vec2 p)
{
    bool swapped = b.x < a.x || (b.x == a.x && b.y < a.y);
    vec2 from = swapped ? b : a;
    vec2 along = swapped ? a - b : b - a;
    precise float area = along.x * (p.y - from.y) - along.y * (p.x - from.x);
    return swapped ? -area : area;
}
#endif

void main()
{
    vec2 p = texelFetch(centres, ivec2(gl_FragCoord.xy), 0).xy;
#ifdef COVERAGE
    vec3 sides = vec3(side(anchor, others.xy, p), side(others.xy, others.zw, p),
                      side(others.zw, anchor, p));
    if (any(lessThan(sides, vec3(0.0))) && any(greaterThan(sides, vec3(0.0)))) {
        discard;
    }
#endif
    float depth = depth_bounds.x + dot(depth_slope, p - anchor);
    gl_FragDepth = clamp(depth, depth_bounds.y, depth_bounds.z);
}
