// The texels of the light's depth image as samples: forward analysis.
uniform ws_importance_options functions;
uniform float steps;
uniform mat4 camera; // clip space from the world
layout(binding = 7) uniform sampler2DArray light_depths;
#ifdef LIGHT_EDGES
layout(binding = 8) uniform usampler2D light_edges;
#endif

ivec2 ws_view_size()
{
    return textureSize(light_depths, 0).xy;
}

vec4 camera_clip(ivec2 texel, out vec2 p)
{
    p = (vec2(texel) + 0.5) / vec2(ws_view_size());
    float depth = texelFetch(light_depths, ivec3(texel, 0), 0).r;
    vec4 world = transpose(light_normal) * vec4(vec3(p, depth) * 2.0 - 1.0, 1.0);
    return depth < 1.0 ? camera * (world / world.w) : vec4(0.0);
}

bool ws_view_sample(ivec2 texel, out vec2 p)
{
    return ws_desired_view_importance(camera_clip(texel, p), -1.0, 1.0) > 0.0;
}

uint ws_sample_weight(ivec2 texel, vec2 p)
{
    vec2 centre;
    float edge = 0.0;
#ifdef LIGHT_EDGES
    edge = texelFetch(light_edges, texel, 0).r != 0u ? 1.0 : 0.0;
#endif
    float weight =
        ws_forward_importance(camera_clip(texel, centre), -1.0, 1.0, edge, 0.0, functions);
    return ws_weight_in_steps(weight, steps);
}
