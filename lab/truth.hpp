// Ray tracing on the CPU: ground truth of shadows, and what pictures need besides.
#pragma once

#include "lab/methods.hpp"
#include "lab/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lab {

/// Answers of the ray tracer, one per view sample, and how long they took.
struct traced_shadows {
    std::vector<std::uint8_t> shadowed;
    double ms;
};

/// Embree's acceleration structure of one scene. All cores trace.
class ray_tracer {
  public:
    /// The scene outlives it.
    explicit ray_tracer(const scene& world);
    ~ray_tracer();
    ray_tracer(const ray_tracer&) = delete;
    ray_tracer& operator=(const ray_tracer&) = delete;

    /// Whether the way from each view sample to the light is blocked.
    ///
    /// Rays start off the face, towards the viewer, by `origin_offset()`. Samples that do not
    /// face the light are in shadow without a ray; the background never is.
    [[nodiscard]] traced_shadows shadows(const g_buffer_samples& samples,
                                         const light_view& light) const;

    /// Where the ways between pairs of points first meet the scene: the share of each way, exact
    /// for the plane of the triangle that is met, or 2 where nothing is.
    [[nodiscard]] std::vector<double> first_hits(std::span<const glm::dvec3> from,
                                                 std::span<const glm::dvec3> to) const;

    /// Memory that the acceleration structure takes.
    [[nodiscard]] std::size_t bytes() const;

    /// The smaller of 1e-5 of the scene's diagonal and 0.2 mm.
    [[nodiscard]] double origin_offset() const;

    /// Index of the triangle that each sample lies on; 0 for background.
    [[nodiscard]] std::vector<std::uint32_t> seen_triangles(const g_buffer_samples& samples,
                                                            const camera_view& camera) const;

    /// Share of the hemisphere above each sample that is open within `reach`, for pictures.
    [[nodiscard]] std::vector<float> openness(const g_buffer_samples& samples, float reach) const;

  private:
    struct state;
    std::unique_ptr<state> state_;
};

} // namespace lab
