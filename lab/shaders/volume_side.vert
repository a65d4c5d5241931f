#version 430 core
// The sides of shadow volumes: from an edge to infinity, where sunlight meets in one point.
#include "lab/volume_place.glsl"
#include "lab/volume_sides.glsl"
layout(std430, binding = 0) readonly buffer positions { float position[]; };
flat out vec3 normal; // to the outside of the volume
flat out vec3 corner;
flat out float weight;
out float finite;

vec3 vertex(uint i)
{
    return vec3(position[3u * i], position[3u * i + 1u], position[3u * i + 2u]);
}

void main()
{
    int vertices = light_position.w == 0.0 ? 3 : 6;
    volume_side side = sides[gl_VertexID / vertices];
    vec3 from = vertex(side.from);
    vec3 to = vertex(side.to);
    // to, from, from at infinity; to, from at infinity, to at infinity
    int i = gl_VertexID % vertices;
    vec3 end = i == 1 || i == 2 || i == 4 ? from : to;
    bool at_infinity = i == 2 || i >= 4;
    gl_Position = clip_place(at_infinity ? vec4(away_from_light(end), 0.0) : vec4(end, 1.0));
    finite = at_infinity ? 0.0 : 1.0;
    normal = cross(from - to, away_from_light(from));
    corner = from;
    weight = float(side.weight);
}
