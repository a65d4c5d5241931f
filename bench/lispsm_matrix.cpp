// Time of one warped light matrix from a body of 12 vertices, of the fit of a projective warp from
// a histogram, and of the same LiSPSM steps written naively with GLM.
#include <warpshadow/lispsm.hpp>
#include <warpshadow/projective.hpp>

#include <benchmark/benchmark.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace {

template <typename T> struct input {
    warpshadow::frustum<T> camera;
    warpshadow::light<T> source;
    std::vector<glm::vec<3, T>> body; ///< relative to the eye
};

/// A view over flat ground: its frustum cut by a slab, 12 vertices.
template <typename T> input<T> make_input() {
    using vec3 = glm::vec<3, T>;
    input<T> in{warpshadow::make_frustum<T>(
                    vec3(T(3), T(2), T(1)), vec3(T(0.2), T(-0.1), T(-1)), vec3(T(0), T(1), T(0)),
                    warpshadow::perspective_volume<T>(T(1.0472), T(1.5), T(0.5), T(300)))
                    .value,
                warpshadow::sun(vec3(T(0.4), T(-1), T(0.3))),
                {}};
    const auto corners = warpshadow::frustum_corners(in.camera);
    for (std::size_t i = 0; i < 4; ++i) {
        const vec3 a(corners[i]);
        const vec3 b(corners[i + 4]);
        for (const T t : {T(0), T(0.4), T(0.9)}) {
            in.body.push_back(a + t * (b - a));
        }
    }
    return in;
}

/// The same steps as they are usually written: two lookAt and a projection, side planes from their
/// product, points multiplied by whole matrices, n_opt, fade on ln(f / n), fit by bounds.
template <typename T> glm::mat<4, 4, T> naive_lispsm(const input<T>& in) {
    using vec3 = glm::vec<3, T>;
    using vec4 = glm::vec<4, T>;
    using mat4 = glm::mat<4, 4, T>;
    const vec3 eye = in.camera.eye;
    const vec3 light = glm::normalize(in.source.direction);
    const vec3 view = glm::normalize(in.camera.forward);
    const T cosine = glm::dot(light, view);
    const T sine = std::sqrt(T(1) - cosine * cosine);
    const vec3 left = glm::cross(light, view);
    const vec3 up = glm::normalize(glm::cross(left, light));
    const mat4 light_view = glm::lookAt(eye, eye + light, up);
    const mat4 camera_view = glm::lookAt(eye, eye + view, in.camera.up);

    const T largest = std::numeric_limits<T>::max();
    vec3 lo(largest);
    vec3 hi(-largest);
    T z0 = largest;
    for (const vec3& p : in.body) {
        const vec4 world(eye + p, T(1));
        const vec4 q = light_view * world;
        lo = glm::min(lo, vec3(q));
        hi = glm::max(hi, vec3(q));
        z0 = std::min(z0, -(camera_view * world).z);
    }
    const T d = hi.y - lo.y;
    const T z1 = z0 + d * sine;
    T n = (z0 + std::sqrt(z0 * z1)) / sine;

    const auto& volume = in.camera.volume;
    const mat4 projection =
        glm::perspective(T(2) * std::atan(volume.top), volume.right / volume.top,
                         volume.near_distance, volume.far_distance);
    const mat4 view_projection = glm::transpose(projection * camera_view);
    T ahead = T(-1);
    T behind = T(-1);
    for (int i = 0; i < 4; ++i) {
        const vec4 side = view_projection[i / 2] * T(i % 2 == 0 ? 1 : -1);
        const vec3 outward = -glm::normalize(vec3(view_projection[3] + side));
        ahead = std::max(ahead, glm::dot(outward, light));
        behind = std::max(behind, glm::dot(outward, -light));
    }
    const T fade = glm::smoothstep(T(0), std::sin(glm::radians(T(12))), std::min(ahead, behind));
    const T rho = fade * std::log((n + d) / n);
    n = d / (std::exp(rho) - T(1));
    const T f = n + d;
    // P along y of light space, its near plane at the body
    const vec3 centre((lo.x + hi.x) * T(0.5), lo.y - n, (lo.z + hi.z) * T(0.5));
    mat4 p(T(0));
    p[0][0] = T(1);
    p[1][1] = (f + n) / (f - n);
    p[3][1] = T(-2) * f * n / (f - n);
    p[2][2] = T(1);
    p[1][3] = T(1);
    const mat4 warped = p * glm::translate(mat4(T(1)), -centre) * light_view;

    lo = vec3(largest);
    hi = vec3(-largest);
    for (const vec3& point : in.body) {
        const vec4 q = warped * vec4(eye + point, T(1));
        const vec3 ndc = vec3(q) / q.w;
        lo = glm::min(lo, ndc);
        hi = glm::max(hi, ndc);
    }
    const mat4 fit = glm::ortho(lo.x, hi.x, lo.y, hi.y, -hi.z, -lo.z);
    return fit * warped;
}

template <typename T> void lispsm_matrix(benchmark::State& state) {
    const input<T> in = make_input<T>();
    for (auto _ : state) {
        benchmark::DoNotOptimize(in.body.data());
        auto result =
            warpshadow::lispsm<T>(in.camera, in.source, in.body, warpshadow::clip::opengl);
        benchmark::DoNotOptimize(result);
    }
}

template <typename T> void naive_glm_matrix(benchmark::State& state) {
    const input<T> in = make_input<T>();
    for (auto _ : state) {
        benchmark::DoNotOptimize(in.body.data());
        auto result = naive_lispsm(in);
        benchmark::DoNotOptimize(result);
    }
}

/// Samples of a view over a plane, counted in 64 × 64 cells.
std::vector<std::uint32_t> make_histogram(float height, float distance) {
    std::vector<std::uint32_t> counts(64 * 64);
    std::vector<glm::vec2> points;
    for (int i = 0; i < 512; ++i) {
        for (int j = 0; j < 512; ++j) {
            const float x = 0.577f * ((static_cast<float>(i) + 0.5f) / 256.0f - 1.0f);
            const float y = 0.577f * ((static_cast<float>(j) + 0.5f) / 256.0f - 1.0f) - 0.1f;
            const float k = y < 0.0f ? height / -y : distance + 1.0f;
            if (k < distance) {
                points.push_back(
                    glm::vec2(0.5f + 0.5f * x * k / (0.577f * distance), k / distance));
            }
        }
    }
    warpshadow::splat<float>(points, warpshadow::count_map{counts, 64, 64});
    return counts;
}

void projective_fit(benchmark::State& state) {
    // low above the ground: few cells; high: half of them
    const auto counts = make_histogram(static_cast<float>(state.range(0)), 100.0f);
    for (auto _ : state) {
        auto result = warpshadow::fit_projective<float>(warpshadow::count_view(counts, 64, 64));
        benchmark::DoNotOptimize(result);
    }
    state.counters["cells"] = static_cast<double>(
        std::count_if(counts.begin(), counts.end(), [](std::uint32_t c) { return c > 0; }));
}

BENCHMARK(lispsm_matrix<float>);
BENCHMARK(naive_glm_matrix<float>);
BENCHMARK(lispsm_matrix<double>);
BENCHMARK(naive_glm_matrix<double>);
BENCHMARK(projective_fit)->Arg(2)->Arg(40)->Unit(benchmark::kMicrosecond);

} // namespace

BENCHMARK_MAIN();
