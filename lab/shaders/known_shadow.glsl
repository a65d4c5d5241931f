// Whether a view sample was in shadow when its place was last seen: class 1, else 0.
layout(binding = 6) uniform usampler2D known_shadows; // 1 in shadow
uniform mat4 known_camera; // of that view: clip space from the world
uniform bool any_known;

int ws_sample_class(ivec2 pixel, vec2 p)
{
    vec4 clip = known_camera * vec4(texelFetch(g_position, pixel, 0).xyz, 1.0);
    if (!any_known || clip.w <= 0.0 || any(greaterThanEqual(abs(clip.xy), vec2(clip.w)))) {
        return 0;
    }
    ivec2 size = textureSize(known_shadows, 0);
    ivec2 seen = clamp(ivec2((clip.xy / clip.w * 0.5 + 0.5) * vec2(size)), ivec2(0), size - 1);
    return texelFetch(known_shadows, seen, 0).r == 1u ? 1 : 0;
}
