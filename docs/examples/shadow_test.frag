// The GLSL snippet of the README, in a shader; goes after `#version` and glsl/warpshadow/warp.glsl.

// [snippet]
uniform sampler2D rows, columns; // the tables as R32F textures
uniform sampler2DShadow shadow_map;

float lit(vec4 a, float bias) // a: light matrix * world position
{
    vec3 p = a.xyz / a.w * 0.5 + 0.5;
    return texture(shadow_map, vec3(ws_warp(rows, columns, p.xy), p.z - bias));
}
// [snippet]

in vec4 light_position;
out vec4 colour;

void main()
{
    colour = vec4(vec3(lit(light_position, 0.001)), 1.0);
}
