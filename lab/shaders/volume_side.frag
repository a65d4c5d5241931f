#version 430 core
// Counts a side of a volume where it lies behind what is seen.
//
// Depths decide where they differ by more than rounding: they go on from one side to the next, as
// the rasteriser's pixels do. Closer, eye and sample must be on the same side of the plane, which is
// far finer, but means nothing for sides that the rasteriser sees from the edge.
uniform sampler2D g_position;
uniform mat4 camera;
uniform float near_distance;
flat in vec3 normal;
flat in vec3 corner;
flat in float weight;
in float finite; // 1, and 0 at infinity: with w, depth
layout(location = 0) out float count;

// Four roundings of 1 / w, which is interpolated from the near plane on.
const float rounding = 4.8e-7;

void main()
{
    vec3 seen = texelFetch(g_position, ivec2(gl_FragCoord.xy), 0).xyz;
    float behind = 1.0 / (camera * vec4(seen, 1.0)).w - finite * gl_FragCoord.w;
    float outside = dot(normal, seen - corner);
    if (abs(behind) * near_distance <= rounding) {
        behind = gl_FrontFacing ? outside : -outside;
    }
    if (!(behind > 0.0)) {
        discard;
    }
    count = gl_FrontFacing ? -weight : weight;
}
