// Time of one warped light matrix from a body of 12 vertices, of the fit of a projective warp from
// a histogram, and of the same LiSPSM steps written naively with GLM.
#include "naive_lispsm.hpp"

#include <warpshadow/lispsm.hpp>
#include <warpshadow/projective.hpp>

#include <benchmark/benchmark.h>

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
        auto result = naive_lispsm::matrix(in.camera, in.source.direction, in.body, true);
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
