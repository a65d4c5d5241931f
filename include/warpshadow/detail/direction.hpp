// Unit vectors and orthonormal frames from directions of any length, in double.
#pragma once

#include <warpshadow/detail/finite.hpp>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace warpshadow::detail {

using dvec3 = glm::vec<3, double>;

/// Largest magnitude among the components.
inline double max_abs(const dvec3& v) {
    return std::fmax(std::abs(v.x), std::fmax(std::abs(v.y), std::abs(v.z)));
}

/// `v` scaled by a power of two so that its largest component lies in [1/2, 1).
///
/// `v` has finite components, not all zero.
inline dvec3 scaled_to_one(const dvec3& v) {
    int exponent = 0;
    std::frexp(max_abs(v), &exponent);
    return dvec3(std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent),
                 std::ldexp(v.z, -exponent));
}

/// Whether `v` is a direction: finite and not the zero vector.
inline bool is_direction(const dvec3& v) {
    return all_finite(v) && max_abs(v) > 0.0;
}

/// Unit vector along `v`; scaling `v` by a power of two changes no bit of it.
///
/// `v` has finite components, not all zero.
inline dvec3 unit(const dvec3& v) {
    const dvec3 s = scaled_to_one(v);
    return s / std::sqrt(glm::dot(s, s));
}

/// Orthonormal axes with right x up = -forward.
struct frame {
    dvec3 right, up, forward;
};

/// Frame of the unit vector `f`: (+x, -z, -y) carried along the great circle from -y to f.
///
/// Continuous in f but for f = +y, where no continuous frame exists once it is chosen elsewhere
/// (hairy ball theorem). Frisvad 2012, "Building an Orthonormal Basis from a 3D Unit Vector Without
/// Normalization", without the loss of accuracy that Duff et al. 2017 found near its singularity.
inline frame frame_from_unit(const dvec3& f) {
    dvec3 right(1.0, 0.0, 0.0);
    if (f.y <= 0.0) {
        const double k = f.x / (1.0 - f.y);
        right = dvec3(1.0 - f.x * k, f.x, -f.z * k);
    } else {
        // 1 - f.y cancels: it is (x^2 + z^2) / (1 + f.y), and only ratios of x and z are needed
        const double largest = std::fmax(std::abs(f.x), std::abs(f.z));
        if (largest > 0.0) {
            const double x = f.x / largest;
            const double z = f.z / largest;
            const double k = (1.0 + f.y) * x / (x * x + z * z);
            right = dvec3(1.0 - x * k, f.x, -z * k);
        }
    }
    return frame{right, glm::cross(right, f), f};
}

/// The same with z instead of y as the vertical axis: the jump is at f = +z.
inline frame frame_from_unit_z_up(const dvec3& f) {
    const frame y_up = frame_from_unit(dvec3(f.x, f.z, -f.y));
    const dvec3& r = y_up.right;
    const dvec3& u = y_up.up;
    return frame{dvec3(r.x, -r.z, r.y), dvec3(u.x, -u.z, u.y), f};
}

/// Frame that looks along the unit vector `f` with the direction `up_hint` upwards.
///
/// @param[out] result the frame, untouched if the answer is false
/// @return whether the two span a plane: their angle is above 2^-40 rad
inline bool frame_from_up(const dvec3& f, const dvec3& up_hint, frame& result) {
    const dvec3 side = glm::cross(f, unit(up_hint));
    if (!(glm::dot(side, side) > 0x1p-80)) {
        return false;
    }
    dvec3 right = unit(side);
    // once more: a hint nearly parallel to f leaves an error along f
    right = unit(right - f * glm::dot(right, f));
    result = frame{right, glm::cross(right, f), f};
    return true;
}

} // namespace warpshadow::detail
