// Corners of the scene's triangles as the light sees them. All passes that sort triangles get the
// same bits of a corner: an edge between two of them is the same for both, whichever pass each takes.
#include "lab/light.glsl"
layout(binding = 6) uniform samplerBuffer positions;
layout(binding = 7) uniform usamplerBuffer indices;
layout(binding = 8) uniform samplerBuffer face_normals;

const float thinnest = 2.4e-7; // four roundings of a map coordinate

vec3 corner_in_world(uint triangle, int i)
{
    return texelFetch(positions, int(texelFetch(indices, int(triangle))[i])).xyz;
}

vec4 in_clip_space(vec3 world)
{
    precise vec4 clip = light_matrix * vec4(world, 1.0);
    return clip;
}

vec3 in_map(vec4 clip)
{
    precise vec3 map = clip.xyz / clip.w * 0.5 + 0.5;
    return map;
}

const int off_map = 0;
const int crossing_bounds = 1;
const int within_bounds = 2;

// Of a triangle, to the bounds of the map and the near side of the light's volume.
int place_of(vec4 c0, vec4 c1, vec4 c2)
{
    vec3 x = vec3(c0.x, c1.x, c2.x), y = vec3(c0.y, c1.y, c2.y), z = vec3(c0.z, c1.z, c2.z);
    vec3 w = vec3(c0.w, c1.w, c2.w);
    if (all(lessThan(x, -w)) || all(lessThan(y, -w)) || all(lessThan(z, -w)) ||
        all(greaterThan(x, w)) || all(greaterThan(y, w)) || all(greaterThan(z, w))) {
        return off_map;
    }
    // what is beyond the far side has the largest depth
    bool crosses = any(lessThan(x, -w)) || any(lessThan(y, -w)) || any(lessThan(z, -w)) ||
                   any(greaterThan(x, w)) || any(greaterThan(y, w));
    return crosses ? crossing_bounds : within_bounds;
}

// As thin as the rounding of its corners: seen edge-on, it covers no texel.
bool is_thin(vec2 p0, vec2 p1, vec2 p2)
{
    vec2 a = p1 - p0, b = p2 - p0, c = p2 - p1;
    float height = abs(a.x * b.y - a.y * b.x) / max(length(a), max(length(b), length(c)));
    return !(height > thinnest);
}

// The plane of a triangle in clip space: its depth is a function of the map.
vec4 clip_plane(uint triangle, vec3 corner)
{
    vec3 normal = texelFetch(face_normals, int(triangle)).xyz;
    return light_normal * vec4(normal, -dot(normal, corner));
}
