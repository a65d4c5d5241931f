// What a function had to do to stay total: which guard fired, which fallback was taken.
#pragma once

#include <cstdint>

#if defined(__FAST_MATH__)
#error "warpshadow relies on IEEE arithmetic: compile without -ffast-math"
#endif

namespace warpshadow {

/// Guards that fired while a result was computed; a bit mask, `ok` when none did.
///
/// Every result that carries a status is finite and usable whatever the status says. The status
/// tells what the result means: each bit names one guard, and the doc comment of the function
/// says which fallback belongs to it.
enum class status : std::uint32_t {
    ok = 0u,
    invalid_input =
        1u << 0, ///< a NaN, an infinity where none is allowed, or a zero-length direction
    out_of_range = 1u << 1,       ///< a finite input outside its documented range was clamped
    buffer_too_small = 1u << 2,   ///< a caller's span does not hold the result; nothing was written
    samples_rejected = 1u << 3,   ///< some view samples were NaN or outside the map and not counted
    count_overflow = 1u << 4,     ///< a counter reached its largest value and stays there
    empty_importance = 1u << 5,   ///< no sample at all: the warp is the identity
    empty_rows = 1u << 6,         ///< some functions had no sample in reach: those are the identity
    floor_raised = 1u << 7,       ///< the density floor was raised to what the storage can hold
    not_invertible = 1u << 8,     ///< a matrix has no inverse: identity or the documented neutral
    degenerate_extent = 1u << 9,  ///< a body is a point, an edge or flat: its extent was widened
    unbounded = 1u << 10,         ///< infinite far plane and nothing that bounds the body
    empty_body = 1u << 11,        ///< view, light and scene have nothing in common
    near_clamped = 1u << 12,      ///< a near distance was zero or negative and was raised
    light_inside_body = 1u << 13, ///< no plane separates light and body: use an omnidirectional map
    up_replaced = 1u << 14,       ///< the up hint is parallel to the direction: another was taken
    stayed_uniform = 1u << 15,    ///< a warp was asked for and the uniform map was kept
    capacity_reached = 1u << 16,  ///< a fixed-capacity result was truncated conservatively
    bound_missed = 1u << 17,      ///< a cap kept the result from the bound that was asked for
    projection_aliasing = 1u << 18, ///< the receiver is parallel to the light: bias was clamped
    light_in_view =
        1u << 19, ///< the light or its opposite is inside the view cone: warps gain nothing
    no_perspective = 1u << 20 ///< an orthographic camera: there is no perspective to make up for
};

/// Union of two sets of guards.
constexpr status operator|(status a, status b) {
    return static_cast<status>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

/// Guards that are in both sets.
constexpr status operator&(status a, status b) {
    return static_cast<status>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}

/// Adds the guards of `b` to `a`.
constexpr status& operator|=(status& a, status b) {
    a = a | b;
    return a;
}

/// Whether `flags` holds at least one of the guards in `which`.
constexpr bool any(status flags, status which) {
    return (flags & which) != status::ok;
}

/// Name of a single guard as it is written in the source, or "unknown" for anything else.
constexpr const char* status_name(status guard) {
    switch (guard) {
    case status::ok:
        return "ok";
    case status::invalid_input:
        return "invalid_input";
    case status::out_of_range:
        return "out_of_range";
    case status::buffer_too_small:
        return "buffer_too_small";
    case status::samples_rejected:
        return "samples_rejected";
    case status::count_overflow:
        return "count_overflow";
    case status::empty_importance:
        return "empty_importance";
    case status::empty_rows:
        return "empty_rows";
    case status::floor_raised:
        return "floor_raised";
    case status::not_invertible:
        return "not_invertible";
    case status::degenerate_extent:
        return "degenerate_extent";
    case status::unbounded:
        return "unbounded";
    case status::empty_body:
        return "empty_body";
    case status::near_clamped:
        return "near_clamped";
    case status::light_inside_body:
        return "light_inside_body";
    case status::up_replaced:
        return "up_replaced";
    case status::stayed_uniform:
        return "stayed_uniform";
    case status::capacity_reached:
        return "capacity_reached";
    case status::bound_missed:
        return "bound_missed";
    case status::projection_aliasing:
        return "projection_aliasing";
    case status::light_in_view:
        return "light_in_view";
    case status::no_perspective:
        return "no_perspective";
    }
    return "unknown";
}

/// Number of guards that `status` knows; guard i is `status(1u << i)`.
inline constexpr int status_count = 21;

} // namespace warpshadow
