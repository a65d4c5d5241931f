// The light and its maps as every pass sees them: the matrices live in a buffer, so that the desired
// view can crop them on the device without a round trip.
#include "warpshadow/cube.glsl"

struct light_map
{
    mat4 full;   // clip from world, before the crop
    mat4 matrix; // clip from world, cropped to the desired view
    mat4 normal; // inverse transpose of matrix: planes from world to clip
};

layout(std430, binding = 4) buffer light_buffer
{
    vec4 light_position; // xyz and w = 1, or the direction towards the sun and w = 0
    vec4 light_axis;     // xyz the spot's axis, w the cosine of half its angle; others (0, 0, 0, -2)
    ivec4 light_choice;  // x: map_choice, y: number of maps
    vec4 depth_plane;    // view depth of a world position is dot(plane, vec4(p, 1)); of hemispheres
                         // the axis of the front
    vec4 splits[2];      // view depths at which the next map begins
    light_map light_maps[];
};

uniform int map_index; // the map that this pass is about

#define light_full light_maps[map_index].full
#define light_matrix light_maps[map_index].matrix
#define light_normal light_maps[map_index].normal

vec3 towards_light(vec3 world)
{
    return normalize(light_position.xyz - light_position.w * world);
}

// n·l of a view sample, or 0 outside the cone of a spot light
float lit_cosine(vec3 world, vec3 normal)
{
    vec3 l = towards_light(world);
    return dot(-l, light_axis.xyz) >= light_axis.w ? dot(normal, l) : 0.0;
}

// What the matrices take. With its distance d as a fourth coordinate, a place relative to the light
// has the paraboloid projection (x, y) / (d + s z), which is that of a matrix: it crops like one.
vec4 light_coordinates(vec3 world)
{
    vec3 p = world - light_position.xyz;
    return light_choice.x == 3 ? vec4(p, length(p)) : vec4(world, 1.0);
}

// The map in which a point is looked up.
int map_of(vec3 world)
{
    if (light_choice.x == 1) {
        return max(ws_cube_lookup(world - light_position.xyz).face, 0);
    }
    if (light_choice.x == 3) {
        return dot(depth_plane.xyz, world - light_position.xyz) >= 0.0 ? 0 : 1;
    }
    int map = 0;
    if (light_choice.x == 2) {
        float depth = dot(depth_plane, vec4(world, 1.0));
        for (int i = 0; i + 1 < light_choice.y; ++i) {
            map += depth >= splits[i / 4][i % 4] ? 1 : 0;
        }
    }
    return map;
}
