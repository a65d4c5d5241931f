// What a view sample weighs by the importance functions.
uniform ws_importance_options functions;
uniform float steps;
uniform vec4 view_depth; // distance along the direction of view is dot(view_depth, vec4(p, 1))
uniform vec3 eye;
#ifdef LIGHT_EDGES
layout(binding = 8) uniform usampler2D light_edges; // over the map, see passes/depth_edges.glsl
#endif

uint ws_sample_weight(ivec2 pixel, vec2 p)
{
    vec3 world = texelFetch(g_position, pixel, 0).xyz;
    vec3 normal = texelFetch(g_normal, pixel, 0).xyz;
    ws_seen_point point;
    point.p = p;
    point.eye_distance = dot(view_depth, vec4(world, 1.0));
    point.view_cosine = dot(normal, normalize(eye - world));
    point.light_cosine = lit_cosine(world, normal);
#ifdef LIGHT_EDGES
    ivec2 size = textureSize(light_edges, 0);
    point.edge = texelFetch(light_edges, clamp(ivec2(p * vec2(size)), ivec2(0), size - 1), 0).r != 0u;
#else
    point.edge = false;
#endif
    return ws_weight_in_steps(ws_view_importance(point, functions), steps);
}
