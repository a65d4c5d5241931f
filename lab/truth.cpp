#include "lab/truth.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>
#include <thread>

namespace lab {
namespace {

/// Calls `work(first, last)` for blocks of indices on all cores.
template <typename Work> void in_parallel(std::size_t count, Work work) {
    constexpr std::size_t block = 4096;
    std::atomic<std::size_t> next{0};
    const auto run = [&] {
        for (std::size_t first = next.fetch_add(block); first < count;
             first = next.fetch_add(block)) {
            work(first, std::min(count, first + block));
        }
    };
    std::vector<std::jthread> helpers;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) {
        helpers.emplace_back(run);
    }
    run();
}

RTCRay make_ray(glm::vec3 origin, glm::vec3 direction, float reach) {
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tnear = 0.0f;
    ray.tfar = reach;
    ray.mask = 0xffffffffu;
    return ray;
}

bool is_surface(const g_buffer_samples& samples, std::size_t i) {
    return samples.position[i].w > 0.5f;
}

} // namespace

struct ray_tracer::state {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    const lab::scene* world = nullptr;
    double diagonal = 0.0;
    std::atomic<std::ptrdiff_t> bytes{0};

    state() = default;
    state(const state&) = delete;
    state& operator=(const state&) = delete;
    ~state() {
        if (scene != nullptr) {
            rtcReleaseScene(scene);
        }
        if (device != nullptr) {
            rtcReleaseDevice(device);
        }
    }

    [[nodiscard]] bool blocked(glm::vec3 origin, glm::vec3 direction, float reach) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay ray = make_ray(origin, direction, reach);
        rtcOccluded1(scene, &context, &ray);
        return ray.tfar < 0.0f;
    }
};

ray_tracer::ray_tracer(const scene& world) : state_(std::make_unique<state>()) {
    state_->world = &world;
    state_->diagonal = glm::length(world.box.hi - world.box.lo);
    state_->device = rtcNewDevice(nullptr);
    if (state_->device == nullptr) {
        throw std::runtime_error("Embree gives no device");
    }
    rtcSetDeviceMemoryMonitorFunction(
        state_->device,
        [](void* counter, ssize_t bytes, bool /*after*/) {
            *static_cast<std::atomic<std::ptrdiff_t>*>(counter) += bytes;
            return true;
        },
        &state_->bytes);
    state_->scene = rtcNewScene(state_->device);
    rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree owns the buffers: it reads 16 bytes at the last vertex
    void* positions =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(glm::vec3), world.positions.size());
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              sizeof(glm::uvec3), world.triangles.size());
    if (positions == nullptr || triangles == nullptr) {
        rtcReleaseGeometry(geometry);
        throw std::runtime_error("Embree cannot hold the scene");
    }
    std::memcpy(positions, world.positions.data(), world.positions.size() * sizeof(glm::vec3));
    std::memcpy(triangles, world.triangles.data(), world.triangles.size() * sizeof(glm::uvec3));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(state_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(state_->scene);
    if (rtcGetDeviceError(state_->device) != RTC_ERROR_NONE) {
        throw std::runtime_error("Embree cannot build its acceleration structure");
    }
}

ray_tracer::~ray_tracer() = default;

std::size_t ray_tracer::bytes() const {
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, state_->bytes.load()));
}

double ray_tracer::origin_offset() const {
    return std::min(1e-5 * state_->diagonal, 2e-4);
}

traced_shadows ray_tracer::shadows(const g_buffer_samples& samples, const light_view& light) const {
    using warpshadow::light_kind;
    traced_shadows result;
    result.shadowed.assign(samples.position.size(), 0);
    const auto offset = static_cast<float>(origin_offset());
    const bool sun = light.light.kind == light_kind::directional;
    const glm::vec3 towards_sun(-glm::normalize(light.light.direction));
    const auto begin = std::chrono::steady_clock::now();
    in_parallel(samples.position.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!is_surface(samples, i)) {
                continue;
            }
            if (!(samples.n_dot_l[i] > 0.0f)) {
                result.shadowed[i] = 1;
                continue;
            }
            const glm::vec3 origin = glm::vec3(samples.position[i]) + offset * samples.normal[i];
            const bool blocked =
                sun ? state_->blocked(origin, towards_sun, INFINITY)
                    : state_->blocked(origin, glm::vec3(light.light.position) - origin, 1.0f);
            result.shadowed[i] = blocked ? 1 : 0;
        }
    });
    result.ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

std::vector<double> ray_tracer::first_hits(std::span<const glm::dvec3> from,
                                           std::span<const glm::dvec3> to) const {
    std::vector<double> result(from.size(), 2.0);
    const scene& world = *state_->world;
    in_parallel(from.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const glm::dvec3 way = to[i] - from[i];
            RTCRayHit hit{};
            hit.ray = make_ray(glm::vec3(from[i]), glm::vec3(way), 1.0f);
            hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            rtcIntersect1(state_->scene, &context, &hit);
            if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
                continue;
            }
            const glm::uvec3& t = world.triangles[hit.hit.primID];
            const glm::dvec3 a(world.positions[t.x]);
            const glm::dvec3 normal = glm::cross(glm::dvec3(world.positions[t.y]) - a,
                                                 glm::dvec3(world.positions[t.z]) - a);
            const double slope = glm::dot(normal, way);
            result[i] = slope != 0.0 ? glm::dot(normal, a - from[i]) / slope
                                     : static_cast<double>(hit.ray.tfar);
        }
    });
    return result;
}

std::vector<std::uint32_t> ray_tracer::seen_triangles(const g_buffer_samples& samples,
                                                      const camera_view& camera) const {
    std::vector<std::uint32_t> result(samples.position.size(), 0);
    const glm::vec3 eye(camera.eye);
    in_parallel(samples.position.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!is_surface(samples, i)) {
                continue;
            }
            // from just in front of the surface to just behind it: the eye may see through
            // what is nearer than the near plane
            const glm::vec3 ray = glm::vec3(samples.position[i]) - eye;
            RTCRayHit hit{};
            hit.ray = make_ray(eye, ray, 1.02f);
            hit.ray.tnear = 0.995f;
            hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            rtcIntersect1(state_->scene, &context, &hit);
            if (hit.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
                result[i] = hit.hit.primID;
            }
        }
    });
    return result;
}

std::vector<float> ray_tracer::openness(const g_buffer_samples& samples, float reach) const {
    // 4 × 4 pixels take turns in 16 sets of directions; a 4 × 4 mean over the same surface then
    // sees them all
    constexpr int rays = 8;
    const int width = samples.size.x;
    const int height = samples.size.y;
    std::vector<float> noisy(samples.position.size(), 1.0f);
    const auto offset = static_cast<float>(origin_offset());
    in_parallel(samples.position.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!is_surface(samples, i)) {
                continue;
            }
            const int x = static_cast<int>(i) % width;
            const int y = static_cast<int>(i) / width;
            const int set = (x & 3) * 4 + (y & 3);
            const glm::vec3 n = samples.normal[i];
            const glm::vec3 u = glm::normalize(
                glm::cross(std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), n));
            const glm::vec3 v = glm::cross(n, u);
            const glm::vec3 origin = glm::vec3(samples.position[i]) + offset * n;
            int open = 0;
            for (int k = 0; k < rays; ++k) {
                const int index = k * 16 + (set * 7) % 16;
                const float radius2 = (static_cast<float>(index) + 0.5f) / (16.0f * rays);
                const float angle = 2.399963f * static_cast<float>(index); // golden angle
                const float radius = std::sqrt(radius2);
                const glm::vec3 d = radius * (std::cos(angle) * u + std::sin(angle) * v) +
                                    std::sqrt(1.0f - radius2) * n;
                open += state_->blocked(origin, d, reach) ? 0 : 1;
            }
            noisy[i] = static_cast<float>(open) / rays;
        }
    });
    std::vector<float> result(noisy.size(), 1.0f);
    in_parallel(noisy.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!is_surface(samples, i)) {
                continue;
            }
            const int x = static_cast<int>(i) % width;
            const int y = static_cast<int>(i) / width;
            const glm::vec3 here(samples.position[i]);
            float sum = 0.0f;
            float weights = 0.0f;
            for (int dy = -2; dy < 2; ++dy) {
                for (int dx = -2; dx < 2; ++dx) {
                    if (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height) {
                        continue;
                    }
                    const auto j = static_cast<std::size_t>((y + dy) * width + x + dx);
                    const glm::vec3 away = glm::vec3(samples.position[j]) - here;
                    const bool same =
                        is_surface(samples, j) &&
                        glm::dot(samples.normal[i], samples.normal[j]) > 0.9f &&
                        std::abs(glm::dot(away, samples.normal[i])) <= 0.1f * glm::length(away);
                    if (same || (dx == 0 && dy == 0)) {
                        sum += noisy[j];
                        weights += 1.0f;
                    }
                }
            }
            result[i] = sum / weights;
        }
    });
    return result;
}

} // namespace lab
