#version 430 core
// Pixels of the image that a texel covers at each view sample, see warpshadow/metric.hpp.
layout(local_size_x = 16, local_size_y = 8) in;
#include "warpshadow/warp.glsl"
#include "warpshadow/bias.glsl"
#include "warpshadow/metric.glsl"
#include "lab/light.glsl"
#include "lab/view_sample.glsl"
// x, y, z: along u, along v, largest, on the receiver; w: largest where the surface does not count
layout(rgba32f, binding = 0) uniform writeonly image2D extents;
uniform sampler2DArray shadow_map; // one layer per map
#ifdef WARPED
layout(binding = 2) uniform sampler2D warp_rows;
layout(binding = 3) uniform sampler2D warp_columns;
#endif
uniform mat4 camera; // clip space from the world
uniform float most;
uniform float least_cosine; // of samples that count

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ws_view_size();
    if (pixel.x >= size.x || pixel.y >= size.y) {
        return;
    }
    vec4 world = texelFetch(g_position, pixel, 0);
    vec3 normal = texelFetch(g_normal, pixel, 0).xyz;
    int map = map_of(world.xyz);
#ifdef WARPED
    if (map != map_index) {
        return;
    }
#endif
    if (world.w == 0.0 || lit_cosine(world.xyz, normal) <= least_cosine) {
        return;
    }
    mat4 matrix = light_maps[map].matrix;
    mat2 jacobian = mat2(1.0);
#ifdef WARPED
    vec4 clip = matrix * vec4(world.xyz, 1.0);
    jacobian = ws_jacobian(warp_rows, warp_columns, clip.xy / clip.w * 0.5 + 0.5);
#endif
    ws_texel_axes axes = ws_texel_axes_at(matrix, jacobian, world.xyz,
                                          1.0 / vec2(textureSize(shadow_map, 0).xy));
    ws_image_gradients image = ws_image_gradients_at(camera, world.xyz, vec2(size));
    ws_texel_extent surface = ws_surface_extent(axes, image, normal, most);
    ws_texel_extent facing = ws_facing_extent(axes, image, most);
    imageStore(extents, pixel, vec4(surface.u, surface.v, surface.largest, facing.largest));
}
