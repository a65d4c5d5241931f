// LiSPSM as it is usually written with GLM, in plain arithmetic of T and in world space.
#pragma once

#include <warpshadow/frustum.hpp>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace naive_lispsm {

/// The same steps as they are usually written: two lookAt and a projection, side planes from their
/// product, points multiplied by whole matrices, n_opt, fade on ln(f / n), fit by bounds.
/// @param camera,direction,body as for `lispsm`: of the view, of the light, relative to the eye
/// @param faded by the angle between the light and the view cone; else at full strength always
template <typename T>
glm::mat<4, 4, T> matrix(const warpshadow::frustum<T>& camera, const glm::vec<3, T>& direction,
                         const std::vector<glm::vec<3, T>>& body, bool faded) {
    using vec3 = glm::vec<3, T>;
    using vec4 = glm::vec<4, T>;
    using mat4 = glm::mat<4, 4, T>;
    const vec3 eye = camera.eye;
    const vec3 light = glm::normalize(direction);
    const vec3 view = glm::normalize(camera.forward);
    const T cosine = glm::dot(light, view);
    const T sine = std::sqrt(T(1) - cosine * cosine);
    const vec3 left = glm::cross(light, view);
    const vec3 up = glm::normalize(glm::cross(left, light));
    const mat4 light_view = glm::lookAt(eye, eye + light, up);
    const mat4 camera_view = glm::lookAt(eye, eye + view, camera.up);

    const T largest = std::numeric_limits<T>::max();
    vec3 lo(largest);
    vec3 hi(-largest);
    T z0 = largest;
    for (const vec3& p : body) {
        const vec4 world(eye + p, T(1));
        const vec4 q = light_view * world;
        lo = glm::min(lo, vec3(q));
        hi = glm::max(hi, vec3(q));
        z0 = std::min(z0, -(camera_view * world).z);
    }
    const T d = hi.y - lo.y;
    const T z1 = z0 + d * sine;
    T n = (z0 + std::sqrt(z0 * z1)) / sine;

    const auto& volume = camera.volume;
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
    const T fade =
        faded ? glm::smoothstep(T(0), std::sin(glm::radians(T(12))), std::min(ahead, behind))
              : T(1);
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
    for (const vec3& point : body) {
        const vec4 q = warped * vec4(eye + point, T(1));
        const vec3 ndc = vec3(q) / q.w;
        lo = glm::min(lo, ndc);
        hi = glm::max(hi, ndc);
    }
    const mat4 fit = glm::ortho(lo.x, hi.x, lo.y, hi.y, -hi.z, -lo.z);
    return fit * warped;
}

} // namespace naive_lispsm
