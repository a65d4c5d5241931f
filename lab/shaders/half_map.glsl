// One hemisphere's paraboloid map, cropped: places relative to the light in it, and rays back.
// See `light_coordinates`: the matrix takes the place and its distance, which z keeps.
#include "lab/light.glsl"

vec3 matrix_row(mat4 m, int row)
{
    return vec3(m[0][row], m[1][row], m[2][row]);
}

// Far outside for the pole behind, where the direction is arbitrary.
vec2 half_place(vec3 p)
{
    vec4 clip = light_matrix * vec4(p, length(p));
    float w = max(clip.w, clip.z * 9.5367432e-7);
    return w > 0.0 ? clip.xy / w * 0.5 + 0.5 : vec2(0.5);
}

// Radii of the disc over half the map, along both sides.
vec2 half_scale()
{
    vec3 along = matrix_row(light_full, 3);
    vec2 shift = light_matrix[3].xy;
    return vec2(dot(matrix_row(light_matrix, 0) - shift.x * along, matrix_row(light_full, 0)),
                dot(matrix_row(light_matrix, 1) - shift.y * along, matrix_row(light_full, 1)));
}

// Direction that a place stands for, of length 1 and in the axes of the world.
vec3 half_ray(vec2 place)
{
    vec2 uv = (place * 2.0 - 1.0 - light_matrix[3].xy) / half_scale();
    float square = dot(uv, uv);
    return (2.0 * uv.x * matrix_row(light_full, 0) + 2.0 * uv.y * matrix_row(light_full, 1) +
            (1.0 - square) * matrix_row(light_full, 3)) / (1.0 + square);
}

// Whether a place is before the horizon, or less than that sine behind it.
bool half_shows(vec3 p, float overlap)
{
    return dot(matrix_row(light_full, 3), p) + overlap * length(p) >= 0.0;
}
