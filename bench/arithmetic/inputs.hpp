// Inputs of the kernels by envelope, with the truth in 106 bits out of 100 digits or rationals.
//
// No header of Boost comes in here: the truth is made in a library of its own, which is compiled
// once. Every envelope has fixed seeds.
#pragma once

#include "describe.hpp"
#include "measure.hpp"

#include <warpshadow/frustum.hpp>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace arithmetic {

// Warp tables ------------------------------------------------------------------------------------

/// Importance of both axes, and points with their exact images under the map that it stands for:
/// sums in integers, nothing rounded. How a table stores its nodes is part of the error.
struct warp_case {
    std::string envelope;
    int cells;
    double floor; ///< a power of two, the same in float
    int radius;
    std::vector<std::uint32_t> row_counts, column_counts;
    std::vector<glm::vec2> points; ///< of the map
    std::vector<wide2> warped;
    std::vector<glm::vec2> images; ///< of the warped map
    std::vector<wide2> unwarped;
};
const std::vector<warp_case>& warp_cases();

/// Importance and exact nodes of some functions of the first axis.
struct build_case {
    std::string envelope;
    int cells;
    double floor;
    int radius;
    std::vector<std::uint32_t> counts;
    std::vector<int> rows;   ///< functions that are compared
    std::vector<wide> nodes; ///< cells + 1 of each of them
};
const std::vector<build_case>& build_cases();

// Points in the plane ----------------------------------------------------------------------------

template <typename T> struct orientation_case {
    std::string envelope;
    std::vector<std::array<glm::vec<2, T>, 3>> triples;
    std::vector<int> signs;
};
const std::vector<orientation_case<float>>& orientation_cases();
const std::vector<orientation_case<double>>& wide_orientation_cases();

struct planar_case {
    std::string envelope;
    std::vector<std::vector<glm::vec2>> sets;
};
const std::vector<planar_case>& planar_cases();

/// Whether these are the vertices of the exact hull of set `i`, in any rotation.
bool hull_is_exact(const planar_case& in, std::size_t i, const std::vector<glm::dvec2>& hull);

/// By how much a rectangle is too large or leaves a point outside, in texels of a map as wide as
/// the set's diameter.
double rectangle_error(const planar_case& in, std::size_t i, const glm::dvec2& centre,
                       const glm::dvec2& axis, const glm::dvec2& half_extents);

// Light matrices ---------------------------------------------------------------------------------

struct near_case {
    std::string envelope;
    std::vector<glm::vec3> light, view; ///< unit vectors, rounded
    std::vector<float> z0, extent;
    std::vector<wide> inverse_near; ///< 1 / n, the sine being |view × light| of these numbers
};
const std::vector<near_case>& near_cases();

template <typename T> struct light_scene {
    warpshadow::frustum<T> camera;
    glm::vec<3, T> direction;
    std::vector<glm::vec<3, T>> body;   ///< relative to the eye
    std::vector<glm::vec<3, T>> points; ///< body and points inside it, to be put on the map
    std::vector<wide2> ndc;             ///< where they belong
    std::vector<wide> along;            ///< and along the axis of the warp, 0 to 1 over the body
};
template <typename T> struct light_case {
    std::string envelope;
    std::vector<light_scene<T>> scenes;
};
const std::vector<light_case<float>>& light_cases();
const std::vector<light_case<double>>& wide_light_cases();

// Volumes ----------------------------------------------------------------------------------------

struct pair_case {
    std::string envelope;
    std::vector<std::array<warpshadow::frustum<float>, 2>> pairs;
    std::vector<bool> meet;
};
const std::vector<pair_case>& pair_cases();

struct face_case {
    std::string envelope;
    std::vector<glm::vec3> lights;
    std::vector<warpshadow::frustum<float>> views;
    std::vector<std::uint32_t> masks; ///< faces whose pyramid meets or touches the view
};
const std::vector<face_case>& face_cases();

/// The axes of a view are orthonormal to a rounding of T, hence one set for each type.
template <typename T> struct body_case {
    std::string envelope;
    std::vector<warpshadow::frustum<T>> views; ///< eye at the origin
    std::vector<warpshadow::box3<T>> boxes;
};
const std::vector<body_case<float>>& body_cases();
const std::vector<body_case<double>>& wide_body_cases();

/// Largest distance from a vertex of the exact body to the nearest of `vertices`, or the other way
/// round, in texels of a map as wide as the body.
double body_error(const body_case<float>& in, std::size_t i,
                  const std::vector<glm::dvec3>& vertices);
double body_error(const body_case<double>& in, std::size_t i,
                  const std::vector<glm::dvec3>& vertices);

// Fragments --------------------------------------------------------------------------------------

struct paraboloid_case {
    std::string envelope;
    std::vector<glm::vec3> directions; ///< of the front map
    std::vector<wide2> uv;
};
const std::vector<paraboloid_case>& paraboloid_cases();

struct bias_case {
    std::string envelope;
    std::vector<glm::vec3> normals;
    std::vector<glm::mat2> jacobians;
    std::vector<wide> bias; ///< of the nearest texel, nothing clamped
};
const std::vector<bias_case>& bias_cases();

} // namespace arithmetic
