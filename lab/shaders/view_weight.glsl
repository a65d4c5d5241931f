// What a view sample weighs by the importance functions.
uniform ws_importance_options functions;
uniform float steps;
uniform vec4 view_depth; // distance along the direction of view is dot(view_depth, vec4(p, 1))
uniform vec3 eye;
#if defined(SHADOW_ENDS)
#define WS_BINDING_DEPTHS 7
#define WS_DEPTH_LAYER 0
#include "lab/plane_depth.glsl"
#include "passes/shadow_end.glsl"
#elif defined(LIGHT_EDGES)
layout(binding = 8) uniform usampler2D light_edges; // over the map, see passes/depth_edges.glsl
#endif

// How much of a shadow's edge passes the sample, as the light's image tells it for the axis that is
// splatted.
float seen_edge(vec2 p, vec3 world, vec3 normal)
{
#if defined(SHADOW_ENDS)
    vec4 clip = light_matrix * vec4(world, 1.0);
    vec3 plane = ws_map_normal(light_normal, vec4(normal, -dot(normal, world)));
    vec2 end = ws_shadow_end_in_image(vec3(p, clip.z / clip.w * 0.5 + 0.5), plane, plane_rounding(plane));
#if defined(EITHER_AXIS)
    return length(end); // of a unit vector, where a shadow ends
#elif defined(WS_SPLAT_COLUMNS)
    return end.y;
#else
    return end.x;
#endif
#elif defined(LIGHT_EDGES)
    ivec2 size = textureSize(light_edges, 0);
    ivec2 texel = clamp(ivec2(p * vec2(size)), ivec2(0), size - 1);
    return texelFetch(light_edges, texel, 0).r != 0u ? 1.0 : 0.0;
#else
    return 0.0;
#endif
}

uint ws_sample_weight(ivec2 pixel, vec2 p)
{
    vec3 world = texelFetch(g_position, pixel, 0).xyz;
    vec3 normal = texelFetch(g_normal, pixel, 0).xyz;
    ws_seen_point point;
    point.p = p;
    point.eye_distance = dot(view_depth, vec4(world, 1.0));
    point.view_cosine = dot(normal, normalize(eye - world));
    point.light_cosine = lit_cosine(world, normal);
    point.edge = seen_edge(p, world, normal);
    return ws_weight_in_steps(ws_view_importance(point, functions), steps);
}
