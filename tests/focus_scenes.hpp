// Scenes for the tests of focus and fit: random ones, and a plain one to vary.
#pragma once

#include "camera.hpp"

#include <warpshadow/focus.hpp>

#include <glm/vec3.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace focus_test {

using namespace warpshadow;
using namespace camera_test;
using d3 = glm::dvec3;

template <typename T> constexpr T infinity = std::numeric_limits<T>::infinity();

template <typename T> box3<T> box_at(const d3& centre, const d3& half) {
    return {glm::vec<3, T>(centre - half), glm::vec<3, T>(centre + half)};
}

template <typename T> frustum<T> camera_at(const d3& eye, const d3& forward, T near, T far) {
    return make_frustum(glm::vec<3, T>(eye), glm::vec<3, T>(forward),
                        glm::vec<3, T>(T(0), T(1), T(0)),
                        perspective_volume(T(1), T(1.5), near, far))
        .value;
}

/// A camera, a light and boxes that mostly have something to do with each other.
template <typename T> focus_input<T> any_scene() {
    const double s = log_between<double>(1e-3, 1e3);
    const d3 eye(any_direction<double>(0.01 * s, 1000.0 * s));
    view_volume<T> volume = any_volume<T>(coin() && coin(), 10.0);
    if (volume.orthographic) {
        const double size = 3.0 * s;
        volume.left = T(-size * between<double>(0.1, 1.0));
        volume.right = T(size * between<double>(0.1, 1.0));
        volume.bottom = T(-size * between<double>(0.1, 1.0));
        volume.top = T(size * between<double>(0.1, 1.0));
    }
    volume.near_distance = T(s * log_between<double>(0.01, 1.0));
    volume.far_distance = coin() ? infinity<T> : T(s * log_between<double>(2.0, 100.0));
    focus_input<T> scene;
    scene.camera = make_frustum(glm::vec<3, T>(eye), any_direction<T>(0.1, 10.0),
                                any_direction<T>(0.1, 10.0), volume)
                       .value;
    const auto any_box = [&](double away) {
        const d3 centre = eye + d3(scene.camera.forward) * (s * between<double>(0.0, 10.0)) +
                          d3(any_direction<double>(1e-3 * s, away * s));
        d3 half(s * log_between<double>(0.1, 30.0), s * log_between<double>(0.1, 30.0),
                s * log_between<double>(0.1, 30.0));
        if (coin() && coin()) {
            half.y = 0.0;
        }
        return box_at<T>(centre, half);
    };
    scene.receivers = any_box(2.0);
    scene.casters = any_box(10.0);
    const d3 towards(d3(scene.receivers.lo) * 0.5 + d3(scene.receivers.hi) * 0.5);
    const glm::vec<3, T> position(towards + d3(any_direction<double>(0.1 * s, 60.0 * s)));
    switch (*rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 3))) {
    case 0:
        scene.source = sun(any_direction<T>(1e-3, 1e3));
        break;
    case 1:
        scene.source = spot_light(position, glm::vec<3, T>(towards), between<T>(0.1, 3.1));
        break;
    default:
        scene.source = point_light(position);
        break;
    }
    return scene;
}

/// The ground before a camera that looks along +z and a little down, sun from above.
template <typename T> focus_input<T> plain_scene() {
    focus_input<T> scene;
    scene.camera = camera_at<T>(d3(0.0, 2.0, 0.0), d3(0.0, -0.25, 1.0), T(0.5), T(100));
    scene.source = sun(glm::vec<3, T>(T(0.5), T(-1), T(0.25)));
    scene.receivers = {glm::vec<3, T>(T(-20), T(0), T(-20)), glm::vec<3, T>(T(20), T(4), T(40))};
    scene.casters = {glm::vec<3, T>(T(-20), T(0), T(-20)), glm::vec<3, T>(T(20), T(8), T(40))};
    return scene;
}

/// Largest coordinate of the bodies and the caster box, relative to the eye.
template <typename T> double size_of(const focus_input<T>& scene, const focus_result& r) {
    double size = r.volume.extent;
    for (glm::length_t k = 0; k < 3; ++k) {
        size = std::max({size, std::abs(double(scene.casters.lo[k]) - r.eye[k]),
                         std::abs(double(scene.casters.hi[k]) - r.eye[k])});
    }
    return size;
}

/// Any numbers, mixed with usable ones so that not all is refused at the door.
template <typename T> focus_input<T> any_nonsense() {
    focus_input<T> scene;
    scene.camera = {any_numbers<T>(),
                    any_numbers<T>(),
                    any_numbers<T>(),
                    any_numbers<T>(),
                    {any_number<T>(), any_number<T>(), any_number<T>(), any_number<T>(),
                     any_number<T>(), any_number<T>(), coin()}};
    if (coin()) {
        scene.camera = plain_scene<T>().camera;
    }
    scene.receivers = {any_numbers<T>(), any_numbers<T>()};
    scene.casters = {any_numbers<T>(), any_numbers<T>()};
    if (coin()) {
        scene.receivers = plain_scene<T>().receivers;
    }
    if (coin()) {
        scene.casters = plain_scene<T>().casters;
    }
    scene.source = {static_cast<light_kind>(*rc::gen::inRange(0, 3)), any_numbers<T>(),
                    any_numbers<T>(), any_number<T>()};
    return scene;
}

/// All lengths of a scene times a factor.
template <typename T> focus_input<T> scaled(focus_input<T> scene, T factor) {
    scene.camera.eye *= factor;
    scene.camera.volume.near_distance *= factor;
    scene.camera.volume.far_distance *= factor;
    if (scene.camera.volume.orthographic) {
        scene.camera.volume.left *= factor;
        scene.camera.volume.right *= factor;
        scene.camera.volume.bottom *= factor;
        scene.camera.volume.top *= factor;
    }
    for (box3<T>* box : {&scene.casters, &scene.receivers}) {
        box->lo *= factor;
        box->hi *= factor;
    }
    scene.source.position *= factor;
    return scene;
}

} // namespace focus_test
