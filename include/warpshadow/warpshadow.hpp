// Everything but glsl.hpp, which allocates strings and is wanted by programs that build shaders.
#pragma once

#include <warpshadow/bias.hpp>
#include <warpshadow/calipers.hpp>
#include <warpshadow/casters.hpp>
#include <warpshadow/clip_space.hpp>
#include <warpshadow/conventions.hpp>
#include <warpshadow/cube.hpp>
#include <warpshadow/cull.hpp>
#include <warpshadow/fit.hpp>
#include <warpshadow/focus.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/hull.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/lispsm.hpp>
#include <warpshadow/paraboloid.hpp>
#include <warpshadow/polytope.hpp>
#include <warpshadow/predicates.hpp>
#include <warpshadow/projective.hpp>
#include <warpshadow/shadow_frustum.hpp>
#include <warpshadow/smoothing.hpp>
#include <warpshadow/stable_fit.hpp>
#include <warpshadow/status.hpp>
#include <warpshadow/warp.hpp>
#include <warpshadow/warp_build.hpp>
