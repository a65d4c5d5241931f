// The light as every pass sees it: its matrix lives in a buffer, so that the desired view can crop
// it on the device without a round trip.
layout(std430, binding = 4) buffer light_buffer
{
    mat4 light_full;         // clip from world, before the crop
    mat4 light_matrix;       // clip from world, cropped to the desired view
    mat4 light_normal;       // inverse transpose of light_matrix: planes from world to clip
    vec4 light_position;     // xyz and w = 1, or the direction towards the sun and w = 0
    vec4 light_axis;         // xyz the spot's axis, w the cosine of half its angle; sun: (0, 0, 0, -2)
    vec4 light_rect;         // lo.xy, hi.xy of the crop in the full map
};

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
