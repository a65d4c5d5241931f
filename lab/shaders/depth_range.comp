#version 430 core
// Least and largest view depth of the lit view samples, as shares of the farthest.
#define WS_BINDING_DESIRED_VIEW 5
#include "lab/light.glsl"
#define OWN_VIEW_SAMPLE
#include "lab/view_sample.glsl"
uniform vec4 share_of_far; // depth plane over the far distance

bool ws_view_sample(ivec2 pixel, out vec2 p)
{
    vec4 world = texelFetch(g_position, pixel, 0);
    p = vec2(dot(share_of_far, vec4(world.xyz, 1.0)));
    return world.w != 0.0 && lit_cosine(world.xyz, texelFetch(g_normal, pixel, 0).xyz) > 0.0;
}
#include "passes/desired_view.glsl"
