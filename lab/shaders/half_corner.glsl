// A corner of a cut triangle on one hemisphere's map.
#include "warpshadow/paraboloid.glsl"
uniform float overlap;

vec4 half_corner(vec3 position, int side)
{
    precise vec4 clip = vec4(ws_paraboloid_uv(position, side), 0.0, 1.0);
    return clip;
}

// Of the direction: along the map it changes evenly, whatever the distances of the corners.
float half_clip(vec3 position, int side)
{
    float away = ws_paraboloid_distance(position);
    return ws_paraboloid_clip(away > 0.0 ? position / away : position, side, overlap);
}
