// Depth of a receiver's plane at a place of the map, less the rounding of the comparison: a texel
// that holds less there holds another surface, before that plane.
#include "warpshadow/warp.glsl"
#include "warpshadow/bias.glsl"

// rounding of position, matrix and depth, about 2^-21 of the map and of the depth range
const float rounding = 4.8e-7;

// `plane`: normal in map space; edge-on to the light there is no slope to follow, and the place's
// own depth serves.
float plane_depth_at(vec3 plane, vec3 p, vec2 place)
{
    return p.z + ws_plane_depth_step(plane, p.xy, place, 1.0);
}

float plane_rounding(vec3 plane)
{
    return rounding * (1.0 + (abs(plane.x) + abs(plane.y)) / abs(plane.z));
}
