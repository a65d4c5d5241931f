// One vertex shader for both passes: into the shadow map, warped, or onto the screen.
layout(location = 0) in vec3 position;
uniform mat4 light, camera; // clip from world
uniform bool into_map;
uniform sampler2D rows, columns; // the warp tables
out vec3 world;
out vec3 in_map; // place in the map before the warp, and depth

void main()
{
    world = position;
    vec4 clip = light * vec4(position, 1.0);
    in_map = clip.xyz / clip.w * 0.5 + 0.5; // sunlight: w is 1
    gl_Position = into_map ? ws_warp_clip(rows, columns, clip) : camera * vec4(position, 1.0);
}
