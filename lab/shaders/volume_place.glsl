// Where corners of shadow volumes lie, at the light's end and at the other, which is at infinity.
#include "lab/light.glsl"
uniform mat4 camera;         // clip space from the world
uniform float near_distance; // of the camera

// From the light through a point.
vec3 away_from_light(vec3 world)
{
    return light_position.w * world - light_position.xyz;
}

// The camera's projection with its far plane at infinity. Its near plane stays: what it cuts off is
// nearer than anything seen, and hence not counted.
vec4 clip_place(vec4 world)
{
    precise vec4 clip = camera * world;
    clip.z = clip.w - 2.0 * near_distance * world.w;
    return clip;
}
