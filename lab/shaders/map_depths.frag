#version 430 core
// The depths that triangles left texel by texel, as a map.
layout(binding = 9) uniform samplerBuffer map_depths;
uniform int map_texels;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    gl_FragDepth = texelFetch(map_depths, at.y * map_texels + at.x).x;
}
