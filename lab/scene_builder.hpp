// Shapes that the built-in scenes are made of.
#pragma once

#include "lab/scene.hpp"

#include <glm/glm.hpp>

#include <cstdint>

namespace lab {

/// Random numbers that are the same on every machine (PCG32).
class random_source {
  public:
    explicit random_source(std::uint64_t seed);
    std::uint32_t bits();
    float unit();                    ///< in [0, 1)
    float range(float lo, float hi); ///< in [lo, hi)
    int below(int count);            ///< in 0 … count - 1
    glm::vec3 direction();           ///< unit length, uniform over the sphere

  private:
    std::uint64_t state_;
};

/// Smooth noise in [-1, 1] with features of size 1; equal everywhere for equal arguments.
float value_noise(glm::vec3 p, std::uint32_t seed);

/// Collects triangles. Everything is added in the material and the frame that were set last.
class scene_builder {
  public:
    scene_builder(std::string_view name, unsigned seed);

    random_source random;

    /// Colour as in a picture editor, 0xRRGGBB.
    std::uint8_t add_material(std::uint32_t srgb, float variation = 0.0f);
    void use(std::uint8_t material);
    /// Origin and turn about the y axis (radians) of what is added next.
    void place(glm::vec3 origin, float yaw = 0.0f);

    void triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c);
    void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d);
    void box(glm::vec3 lo, glm::vec3 hi);
    /// A box along a segment, `across` wide and `up` high, for beams and rails.
    void beam(glm::vec3 from, glm::vec3 to, float across, float up);
    /// A cone frustum; without caps it is an open tube.
    void tube(glm::vec3 from, glm::vec3 to, float radius_from, float radius_to, int sides,
              bool caps = true);
    void ellipsoid(glm::vec3 centre, glm::vec3 radii, int sides, float roughness = 0.0f);
    /// A torus about `axis`.
    void ring(glm::vec3 centre, glm::vec3 axis, float radius, float thickness, int segments,
              int sides);
    /// A pointed leaf of two triangles, folded a little along its length.
    void leaf(glm::vec3 base, glm::vec3 direction, glm::vec3 side, float length, float width);
    /// `count` leaves in a ball.
    void leaf_cluster(glm::vec3 centre, float radius, int count, float size);

    /// A broad-leaved tree.
    struct tree {
        float height;
        int levels;      ///< of branching
        int leaves;      ///< per twig
        float leaf_size; ///< metres
        std::uint8_t bark;
        std::uint8_t leaf;
    };
    void broad_tree(glm::vec3 foot, const tree& shape);
    void conifer(glm::vec3 foot, float height, int tiers, int points, std::uint8_t bark,
                 std::uint8_t needles);

    /// Cameras and lights in the order of their numbers.
    void add_camera(glm::dvec3 eye, glm::dvec3 target, double fov_y_degrees);
    void add_sun(glm::dvec3 direction);
    void add_spot(glm::dvec3 position, glm::dvec3 target, double angle_degrees);

    scene take();

  private:
    void branch(glm::vec3 from, glm::vec3 direction, float length, float radius, int level,
                const tree& shape);
    [[nodiscard]] glm::vec3 placed(glm::vec3 p) const;
    /// What is added next is another object, to be culled by itself.
    void begin_part();

    scene scene_;
    std::uint8_t material_ = 0;
    bool in_tree_ = false; ///< bark and leaves are one object
    glm::vec3 origin_{0.0f};
    float cosine_ = 1.0f;
    float sine_ = 0.0f;
};

/// The box of the positions, in double.
warpshadow::box3<double> box_of(std::span<const glm::vec3> positions);

scene build_outdoor(unsigned seed);
scene build_colonnade(unsigned seed);
scene build_interior(unsigned seed);
scene build_leaves(unsigned seed);

} // namespace lab
