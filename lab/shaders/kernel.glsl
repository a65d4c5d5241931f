// Kernels of percentage closer filtering, of fixed size in texels or in the scene.
#include "warpshadow/filter.glsl"
uniform int kernel_kind;     // shadow_filter of lab/bias.hpp
uniform float kernel_radius; // half its side, in texels or in scene units

#define KERNEL_TEXELS 3
#define KERNEL_LIGHT 4
#define MOST_TAPS 33 // along a side; a larger kernel has them farther apart than texels

// Half the sides of the kernel at a place of the scene, in map space before the warp; of a kernel in
// texels 0.
vec2 kernel_in_map(mat4 matrix, vec3 world)
{
    if (kernel_kind == KERNEL_TEXELS) {
        return vec2(0.0);
    }
    return ws_kernel_radii(ws_texel_axes_at(matrix, mat2(1.0), world, vec2(1.0)), kernel_radius, 1.0);
}

// The same in texels of the map as it is drawn.
vec2 kernel_in_texels(mat2 jacobian, vec2 radii, vec2 texel)
{
    return kernel_kind == KERNEL_TEXELS ? vec2(kernel_radius)
                                        : ws_kernel_reach(jacobian, radii, texel);
}
