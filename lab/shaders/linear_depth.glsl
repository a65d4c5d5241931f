// The light's own depth, brought to 0..1, as map and shadow test make it.
uniform vec3 linear_warp;  // of ws_linear_depth
uniform vec4 linear_light; // the light's own w of a place in the world
uniform vec2 linear_range; // factor and shift to 0..1

// Depth in NDC and the warp's own w, which is clip w over the light's.
float linear_of(float ndc_depth, float warp_w)
{
    return ws_linear_depth(ndc_depth, warp_w, linear_warp) * linear_range.x + linear_range.y;
}
