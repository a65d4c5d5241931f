// Culling for point lights against peers, prepared volumes on both sides: frustum pairs against
// Bullet and libccd, the mask of six cube faces against six points-and-edges tests.
//
// Run with --benchmark_enable_random_interleaving=true --benchmark_repetitions=9. The pairs are
// those of tests/frustum_pairs.hpp, "random" and "view and cube face"; each benchmark cycles
// through the pairs that meet (hit) or that do not (miss), decided by the library in double.
#include "frustum_pairs.hpp"
#include "scalar_culling.hpp"

#include <warpshadow/casters.hpp>
#include <warpshadow/cube.hpp>
#include <warpshadow/cull.hpp>
#include <warpshadow/paraboloid.hpp>

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <benchmark/benchmark.h>
#include <ccd/ccd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace {

using namespace warpshadow;

constexpr std::size_t set_size = 1024;

using scalar_frustum = scalar_culling::prepared<double>;
using scalar_culling::scalar_intersects;

template <typename T> scalar_frustum make_scalar(const frustum<T>& f, const glm::dvec3& origin) {
    return scalar_culling::prepare<double>(f, origin);
}

/// A pair in the form that each library wants it in.
struct prepared_pair {
    frustum<float> frusta[2];
    cull_volume volumes[2];
    scalar_frustum scalar[2];
    std::array<std::array<ccd_vec3_t, 8>, 2> ccd;
    std::unique_ptr<btConvexHullShape> bullet[2];
    bool meets;
};

std::vector<prepared_pair> make_pairs(std::size_t kind, bool meets) {
    frustum_pairs::random random(2026);
    std::vector<prepared_pair> pairs;
    while (pairs.size() < set_size) {
        const auto p = frustum_pairs::make_pair<float>(kind, random);
        if (intersects(p.a, p.b).intersects != meets) {
            continue;
        }
        prepared_pair each;
        each.meets = meets;
        const frustum<float>* source[2] = {&p.a, &p.b};
        for (std::size_t k = 0; k < 2; ++k) {
            each.frusta[k] = *source[k];
            each.volumes[k] = make_cull_volume(*source[k]);
            each.scalar[k] = make_scalar(*source[k], glm::dvec3(p.a.eye));
            each.bullet[k] = std::make_unique<btConvexHullShape>();
            each.bullet[k]->setMargin(0);
            for (std::size_t i = 0; i < 8; ++i) {
                const glm::dvec3& c = each.scalar[k].corners[i];
                ccdVec3Set(&each.ccd[k][i], c.x, c.y, c.z);
                each.bullet[k]->addPoint(btVector3(btScalar(c.x), btScalar(c.y), btScalar(c.z)),
                                         false);
            }
            each.bullet[k]->recalcLocalAabb();
        }
        pairs.push_back(std::move(each));
    }
    return pairs;
}

const std::vector<prepared_pair>& pairs_of(std::size_t kind, bool meets) {
    static const std::vector<prepared_pair> sets[4] = {make_pairs(0, false), make_pairs(0, true),
                                                       make_pairs(1, false), make_pairs(1, true)};
    return sets[2 * kind + (meets ? 1 : 0)];
}

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
    const auto& points = *static_cast<const std::array<ccd_vec3_t, 8>*>(object);
    const ccd_vec3_t* best = &points[0];
    ccd_real_t most = ccdVec3Dot(best, direction);
    for (std::size_t i = 1; i < 8; ++i) {
        const ccd_real_t s = ccdVec3Dot(&points[i], direction);
        if (s > most) {
            most = s;
            best = &points[i];
        }
    }
    ccdVec3Copy(out, best);
}

void centre(const void* object, ccd_vec3_t* out) {
    const auto& points = *static_cast<const std::array<ccd_vec3_t, 8>*>(object);
    ccdVec3Set(out, 0, 0, 0);
    for (const ccd_vec3_t& p : points) {
        ccdVec3Add(out, &p);
    }
    ccdVec3Scale(out, ccd_real_t(0.125));
}

ccd_t ccd_settings() {
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = support;
    ccd.support2 = support;
    ccd.center1 = centre;
    ccd.center2 = centre;
    ccd.max_iterations = 100;
    return ccd;
}

/// Runs `test` over a set and counts the answers that differ from the expected one.
template <typename Test> void run(benchmark::State& state, const Test& test) {
    const auto& pairs = pairs_of(static_cast<std::size_t>(state.range(0)), state.range(1) != 0);
    std::size_t i = 0;
    std::int64_t differ = 0;
    for (auto _ : state) {
        const prepared_pair& p = pairs[i];
        const bool answer = test(p);
        benchmark::DoNotOptimize(answer);
        differ += answer != p.meets ? 1 : 0;
        i = (i + 1) % set_size;
    }
    state.counters["differ"] =
        static_cast<double>(differ) / static_cast<double>(state.iterations());
    state.SetLabel(state.range(1) != 0 ? "hit" : "miss");
}

void pair_warpshadow(benchmark::State& state) {
    run(state,
        [](const prepared_pair& p) { return intersects(p.volumes[0], p.volumes[1]).intersects; });
}

void pair_warpshadow_from_frusta(benchmark::State& state) {
    run(state,
        [](const prepared_pair& p) { return intersects(p.frusta[0], p.frusta[1]).intersects; });
}

void pair_separating_axis(benchmark::State& state) {
    run(state, [](const prepared_pair& p) {
        return !(separating_axis(p.volumes[0], p.volumes[1]).gap > 0.0);
    });
}

void pair_scalar(benchmark::State& state) {
    run(state, [](const prepared_pair& p) { return scalar_intersects(p.scalar[0], p.scalar[1]); });
}

void pair_bullet_gjk(benchmark::State& state) {
    const btTransform identity = btTransform::getIdentity();
    run(state, [&](const prepared_pair& p) {
        btGjkEpaSolver2::sResults results;
        return !btGjkEpaSolver2::Distance(p.bullet[0].get(), identity, p.bullet[1].get(), identity,
                                          btVector3(1, 0, 0), results);
    });
}

void pair_bullet_detector(benchmark::State& state) {
    btDiscreteCollisionDetectorInterface::ClosestPointInput input;
    input.m_transformA.setIdentity();
    input.m_transformB.setIdentity();
    run(state, [&](const prepared_pair& p) {
        btVoronoiSimplexSolver simplex;
        btGjkPairDetector detector(p.bullet[0].get(), p.bullet[1].get(), &simplex, nullptr);
        btPointCollector result;
        detector.getClosestPoints(input, result, nullptr);
        return !result.m_hasResult || result.m_distance <= 0;
    });
}

void pair_libccd_gjk(benchmark::State& state) {
    const ccd_t ccd = ccd_settings();
    run(state,
        [&](const prepared_pair& p) { return ccdGJKIntersect(&p.ccd[0], &p.ccd[1], &ccd) != 0; });
}

void pair_libccd_mpr(benchmark::State& state) {
    const ccd_t ccd = ccd_settings();
    run(state,
        [&](const prepared_pair& p) { return ccdMPRIntersect(&p.ccd[0], &p.ccd[1], &ccd) != 0; });
}

void with_sets(benchmark::internal::Benchmark* b) {
    b->ArgNames({"faces", "hit"})->Args({0, 0})->Args({0, 1})->Args({1, 0})->Args({1, 1});
}

BENCHMARK(pair_warpshadow)->Apply(with_sets);
BENCHMARK(pair_warpshadow_from_frusta)->Apply(with_sets);
BENCHMARK(pair_separating_axis)->Apply(with_sets);
BENCHMARK(pair_scalar)->Apply(with_sets);
BENCHMARK(pair_bullet_gjk)->Apply(with_sets);
BENCHMARK(pair_bullet_detector)->Apply(with_sets);
BENCHMARK(pair_libccd_gjk)->Apply(with_sets);
BENCHMARK(pair_libccd_mpr)->Apply(with_sets);

/// A light and a view; the light's faces are prepared for the tests that can use that.
struct light_and_view {
    glm::vec3 light;
    frustum<float> view;
    scalar_frustum scalar_view;
    std::array<scalar_frustum, 6> scalar_faces;
    cull_volume volume;
    std::array<cull_volume, 6> faces;
};

const std::vector<light_and_view>& lights() {
    static const std::vector<light_and_view> set = [] {
        frustum_pairs::random random(7);
        std::vector<light_and_view> made(set_size);
        for (light_and_view& each : made) {
            each.light = random.in_cube<float>(20.0);
            each.view = frustum_pairs::any_view<float>(random, 20.0, 0.05, 1.0, 5.0, 30.0);
            each.scalar_view = make_scalar(each.view, glm::dvec3(each.light));
            each.volume = make_cull_volume(each.view);
            for (int face = 0; face < 6; ++face) {
                const auto f = face_camera(each.light, face, cube_api::opengl, 0.01f, 100.0f).value;
                each.scalar_faces[static_cast<std::size_t>(face)] =
                    make_scalar(f, glm::dvec3(each.light));
                each.faces[static_cast<std::size_t>(face)] = make_cull_volume(f);
            }
        }
        return made;
    }();
    return set;
}

template <typename Mask> void run_mask(benchmark::State& state, const Mask& mask) {
    const auto& set = lights();
    std::size_t i = 0;
    for (auto _ : state) {
        const std::uint32_t faces = mask(set[i]);
        benchmark::DoNotOptimize(faces);
        i = (i + 1) % set_size;
    }
    std::size_t faces = 0;
    for (const light_and_view& each : set) {
        for (std::uint32_t m = mask(each); m != 0; m &= m - 1) {
            ++faces;
        }
    }
    state.counters["faces"] = static_cast<double>(faces) / static_cast<double>(set_size);
}

void six_faces_warpshadow(benchmark::State& state) {
    run_mask(state,
             [](const light_and_view& each) { return face_mask(each.light, each.view).mask; });
}

void six_faces_warpshadow_refined(benchmark::State& state) {
    face_options options;
    options.refined = true;
    run_mask(state, [&](const light_and_view& each) {
        return face_mask(each.light, each.view, options).mask;
    });
}

void six_faces_scalar(benchmark::State& state) {
    run_mask(state, [](const light_and_view& each) {
        std::uint32_t mask = 0;
        for (std::size_t face = 0; face < 6; ++face) {
            mask |= (scalar_intersects(each.scalar_view, each.scalar_faces[face]) ? 1u : 0u)
                    << face;
        }
        return mask;
    });
}

void six_faces_pair_tests(benchmark::State& state) {
    run_mask(state, [](const light_and_view& each) {
        std::uint32_t mask = 0;
        for (std::size_t face = 0; face < 6; ++face) {
            mask |= (intersects(each.volume, each.faces[face]).intersects ? 1u : 0u) << face;
        }
        return mask;
    });
}

BENCHMARK(six_faces_warpshadow);
BENCHMARK(six_faces_warpshadow_refined);
BENCHMARK(six_faces_scalar);
BENCHMARK(six_faces_pair_tests);

void casters_faces_boxes(benchmark::State& state) {
    frustum_pairs::random random(9);
    std::vector<box3<float>> boxes(4096);
    for (auto& box : boxes) {
        box.lo = random.in_cube<float>(20.0);
        box.hi = box.lo + glm::vec3(1.0f);
    }
    std::vector<std::uint8_t> masks(boxes.size());
    for (auto _ : state) {
        benchmark::DoNotOptimize(caster_faces(glm::vec3(0.0f), std::span<const box3<float>>(boxes),
                                              15.0f, std::span<std::uint8_t>(masks)));
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(boxes.size()));
}

void casters_into_view(benchmark::State& state) {
    frustum_pairs::random random(9);
    std::vector<box3<float>> boxes(4096);
    for (auto& box : boxes) {
        box.lo = random.in_cube<float>(20.0);
        box.hi = box.lo + glm::vec3(1.0f);
    }
    const auto view = frustum_pairs::any_view<float>(random, 5.0, 0.05, 1.0, 20.0, 30.0);
    const caster_filter filter = make_caster_filter(glm::vec3(12.0f, 9.0f, 3.0f), view);
    std::size_t i = 0;
    std::int64_t kept = 0;
    for (auto _ : state) {
        const bool answer = casts_into_view(filter, boxes[i]);
        benchmark::DoNotOptimize(answer);
        kept += answer ? 1 : 0;
        i = (i + 1) % boxes.size();
    }
    state.counters["kept"] = static_cast<double>(kept) / static_cast<double>(state.iterations());
}

void casters_make_filter(benchmark::State& state) {
    frustum_pairs::random random(9);
    const auto view = frustum_pairs::any_view<float>(random, 5.0, 0.05, 1.0, 20.0, 30.0);
    for (auto _ : state) {
        benchmark::DoNotOptimize(make_caster_filter(glm::vec3(12.0f, 9.0f, 3.0f), view));
    }
}

BENCHMARK(casters_faces_boxes);
BENCHMARK(casters_into_view);
BENCHMARK(casters_make_filter);

} // namespace

BENCHMARK_MAIN();
