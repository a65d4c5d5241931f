// The same surfaces in more triangles.
#pragma once

#include "lab/scene.hpp"

#include <cstddef>

namespace lab {

/// Cuts every triangle into k² equal ones, with the k that brings the number of corners, three a
/// triangle, closest to `corners`; edges of neighbours are cut at the same places. The name says
/// how many there are.
/// @throws bad_input when that takes more than 2^26 triangles.
void refine(scene& world, std::size_t corners);

} // namespace lab
