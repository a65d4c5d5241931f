#version 430 core
// The depths that triangles left texel by texel, as a map.
layout(binding = 9) uniform usampler2D map_depths;

void main()
{
    gl_FragDepth = uintBitsToFloat(texelFetch(map_depths, ivec2(gl_FragCoord.xy), 0).x);
}
