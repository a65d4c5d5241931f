// The headers that tools/glslgen/shared.cpp shares functions of.
#pragma once

#include <warpshadow/bias.hpp>
#include <warpshadow/cascades.hpp>
#include <warpshadow/clip_space.hpp>
#include <warpshadow/conventions.hpp>
#include <warpshadow/cube.hpp>
#include <warpshadow/filter.hpp>
#include <warpshadow/fit.hpp>
#include <warpshadow/importance.hpp>
#include <warpshadow/importance_functions.hpp>
#include <warpshadow/metric.hpp>
#include <warpshadow/paraboloid.hpp>
#include <warpshadow/projective.hpp>
#include <warpshadow/status.hpp>
#include <warpshadow/tessellation.hpp>
#include <warpshadow/warp.hpp>
#include <warpshadow/warp_build.hpp>
#include <warpshadow/warp_strength.hpp>
#include <warpshadow/warped_box.hpp>
#include <warpshadow/warped_hull.hpp>
