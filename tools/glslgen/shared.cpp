// What is shared between C++ and GLSL: explicit instantiations for float, and by using-declarations
// what is no template. The generator adds whatever these need.
#include <warpshadow/bias.hpp>
#include <warpshadow/cascades.hpp>
#include <warpshadow/clip_space.hpp>
#include <warpshadow/conventions.hpp>
#include <warpshadow/cube.hpp>
#include <warpshadow/filter.hpp>
#include <warpshadow/fit.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/importance_functions.hpp>
#include <warpshadow/metric.hpp>
#include <warpshadow/paraboloid.hpp>
#include <warpshadow/projective.hpp>
#include <warpshadow/status.hpp>
#include <warpshadow/tessellation.hpp>
#include <warpshadow/warp.hpp>
#include <warpshadow/warp_build.hpp>
#include <warpshadow/warp_strength.hpp>
#include <warpshadow/warped_box.hpp>
#include <warpshadow/warped_hull.hpp>

using ivec2 = glm::vec<2, int>;
using vec2 = glm::vec<2, float>;
using vec3 = glm::vec<3, float>;
using vec4 = glm::vec<4, float>;
using mat2 = glm::mat<2, 2, float>;
using mat3 = glm::mat<3, 3, float>;
using mat4 = glm::mat<4, 4, float>;
using table = warpshadow::table_view<float>;
using settings = warpshadow::bias_settings<float>;
using bias = warpshadow::depth_bias<float>;
using axes = warpshadow::texel_axes<float>;
using volume = warpshadow::view_volume<float>;
using seen = warpshadow::seen_point<float>;
using gradients = warpshadow::image_gradients<float>;
using extent = warpshadow::texel_extent<float>;
using functions = warpshadow::importance_options<float>;

// status
using warpshadow::any;
using warpshadow::status;

// clip_space, conventions
using warpshadow::clip_space;
using warpshadow::clip::d3d;
using warpshadow::clip::opengl;
using warpshadow::clip::vulkan;
template float warpshadow::near_depth<float>(clip_space);
template float warpshadow::far_depth<float>(clip_space);
template vec2 warpshadow::map_from_ndc<float>(vec2, clip_space);
template vec2 warpshadow::ndc_from_map<float>(vec2, clip_space);
template float warpshadow::eye_depth_from_ndc<float>(float, const volume&, clip_space);
template float warpshadow::ndc_from_eye_depth<float>(float, const volume&, clip_space);

// fit
template bool warpshadow::widen_side<float>(float, float, float, float&, float&);
template vec2 warpshadow::crop<float>(const warpshadow::map_rect<float>&, vec2);
template mat4 warpshadow::cropped<float>(const mat4&, vec2, vec2);

// importance
template int warpshadow::cell_of<float>(float, int);
template unsigned warpshadow::weight_in_steps<float>(float, float);
template unsigned warpshadow::blended_count<unsigned>(unsigned, unsigned, unsigned);

// importance_functions
template float warpshadow::desired_view_importance<float>(vec4, float, float);
template float warpshadow::depth_importance<float>(float, float, float);
template float warpshadow::distance_importance<float>(float, float, float);
template bool warpshadow::depth_edge<float>(float, vec4, vec4, float);
template vec2 warpshadow::shadow_end<float>(vec3, vec3, vec3);
template float warpshadow::edge_importance<float>(float, float);
template float warpshadow::normal_importance<float>(float, float);
template float warpshadow::lit_importance<float>(float, float);
template float warpshadow::view_importance<float>(const seen&, const functions&);
template float warpshadow::forward_importance<float>(vec4, float, float, float, float,
                                                     const functions&);

// warp
template warpshadow::row_blend<float> warpshadow::blend_rows<float>(float, int);
template warpshadow::row_blend<float> warpshadow::floor_row<float>(float, int);
template vec2 warpshadow::warp_offset<float, float>(const table&, const table&, vec2);
template vec2 warpshadow::warp<float, float>(const table&, const table&, vec2);
template vec2 warpshadow::unwarp<float, float>(const table&, const table&, vec2);
template float warpshadow::axis_inverse_offset_near<float, float>(
    const table&, const warpshadow::row_blend<float>&, float, int&);
template vec2 warpshadow::warp_floor<float, float>(const table&, const table&, vec2);
template vec2 warpshadow::unwarp_floor<float, float>(const table&, const table&, vec2);
template mat2 warpshadow::jacobian<float, float>(const table&, const table&, vec2);
template vec4 warpshadow::warp_clip<float, float>(const table&, const table&, vec4);

// edge_walk, warped_box, warped_hull, tessellation
template warpshadow::map_box<float>
warpshadow::warp_box<float, float>(const table&, const table&, const warpshadow::map_box<float>&);
template float warpshadow::edge_deviation<float, float>(const table&, const table&, vec2, vec2,
                                                        float);
template warpshadow::warped_hull<float>
warpshadow::hull_of_triangle<float, float>(const table&, const table&, vec2, vec2, vec2, float);
template bool warpshadow::edge_needs_cut<float, float>(const table&, const table&, vec2, vec2,
                                                       float);
template int warpshadow::edge_segments<float, float>(const table&, const table&, vec2, vec2, float,
                                                     int);

// warp_strength
template float warpshadow::texel_side<float, float>(const table&, const table&, vec2);
template float warpshadow::weakening<float>(float);
template float warpshadow::weakened_node<float>(float, int, int, float);

// warp_build
template float warpshadow::warp_node<float, unsigned>(unsigned, unsigned, int, int, float);

// bias
template settings warpshadow::settings_for<float>(vec2, float);
template float warpshadow::depth_quantum<float>(int);
template vec3 warpshadow::map_normal<float>(vec3, vec3);
template vec3 warpshadow::map_normal<float>(const mat4&, vec4);
template vec3 warpshadow::warped_normal<float>(vec3, const mat2&);
template bias warpshadow::footprint_bias<float>(vec3, const mat2&, const settings&);
template bias warpshadow::corner_bias<float, float>(const table&, const table&, vec3, vec2,
                                                    const settings&);
template float warpshadow::plane_depth_step<float>(vec3, vec2, vec2, float);
template float warpshadow::constant_bias<float>(float, float);
template bias warpshadow::slope_scale_bias<float>(vec3, const settings&, float, float);
template float warpshadow::polygon_offset_factor<float>(float);
template float warpshadow::back_face_bias<float>(float, float);
template float warpshadow::linear_depth<float>(float, float, vec3);
template float warpshadow::linear_depth_vertex<float>(float, float);
template bool warpshadow::linear_depth_allowed<float>(float, float, float);
template axes warpshadow::texel_axes_at<float>(const mat4&, const mat2&, vec3, vec2);
template float warpshadow::normal_offset<float>(vec3, const axes&, float);
template vec2 warpshadow::filter_radii<float>(const axes&, float);

// filter
template vec2 warpshadow::kernel_tap<float>(int, int, vec2);
template float warpshadow::kernel_weight<float>(vec2, float);
template int warpshadow::kernel_taps<float>(vec2, int);
template vec2 warpshadow::kernel_radii<float>(const axes&, float, float);
template vec2 warpshadow::tap_in_texels<float>(vec2, vec2, float, vec2);
template vec2 warpshadow::tap_in_light<float, float>(const table&, const table&, vec2, vec2, vec2);
template vec2 warpshadow::tap_by_jacobian<float>(vec2, const mat2&, vec2, vec2);
template vec2 warpshadow::kernel_reach<float>(const mat2&, vec2, vec2);

// cube
template warpshadow::cube_point<float> warpshadow::cube_lookup<float>(const vec3&);
template vec3 warpshadow::cube_direction<float>(int, const vec2&);
template ivec2 warpshadow::cube_texel<float>(const vec2&, int);
template vec3 warpshadow::cube_texel_direction<float>(int, const ivec2&, int);
template float warpshadow::cube_distance<float>(const vec3&);

// paraboloid
template float warpshadow::paraboloid_distance<float>(const vec3&);
template float warpshadow::paraboloid_depth<float>(const vec3&, float, float);
template vec2 warpshadow::paraboloid_uv<float>(const vec3&, int);
template warpshadow::paraboloid_point<float> warpshadow::paraboloid_lookup<float>(const vec3&);
template vec3 warpshadow::paraboloid_unproject<float>(const vec2&, int);
template vec2 warpshadow::paraboloid_map<float>(const vec2&);
template float warpshadow::paraboloid_clip<float>(const vec3&, int, float);
template float warpshadow::chord_error<float>(float);
template float warpshadow::longest_chord<float>(float, float);
template float warpshadow::paraboloid_segments<float>(const vec3&, const vec3&, int, float);

// projective
template vec2 warpshadow::fitted_position<float>(const mat3&, vec2);

// cascades
template float warpshadow::split_distance<float>(float, float, int, int, float);
template int warpshadow::cascade_of<float>(float, vec4);
template float warpshadow::cascade_blend<float>(float, float, float);

// metric
template gradients warpshadow::image_gradients_at<float>(const mat4&, vec3, vec2);
template float warpshadow::largest_stretch<float>(vec3, vec3);
template extent warpshadow::facing_extent<float>(const axes&, const gradients&, float);
template extent warpshadow::surface_extent<float>(const axes&, const gradients&, vec3, float);
