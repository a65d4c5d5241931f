// The view samples as the passes of glsl/passes ask for them.
uniform sampler2D g_position;
uniform sampler2D g_normal;

ivec2 ws_view_size()
{
    return textureSize(g_position, 0);
}

bool lit_sample(ivec2 pixel, mat4 clip_from_world, out vec2 p)
{
    p = vec2(0.0);
    vec4 world = texelFetch(g_position, pixel, 0);
    if (world.w == 0.0 || map_of(world.xyz) != map_index ||
        lit_cosine(world.xyz, texelFetch(g_normal, pixel, 0).xyz) <= 0.0) {
        return false;
    }
    vec4 clip = clip_from_world * light_coordinates(world.xyz);
    p = clip.xy / clip.w * 0.5 + 0.5;
    return clip.w > 0.0;
}

#ifndef OWN_VIEW_SAMPLE
bool ws_view_sample(ivec2 pixel, out vec2 p)
{
#ifdef FULL_MAP
    return lit_sample(pixel, light_full, p);
#else
    return lit_sample(pixel, light_matrix, p);
#endif
}
#endif
