#version 430 core
#include "warpshadow/importance.glsl"
#include "warpshadow/warp_build.glsl"
#include "passes/build_axis.glsl"
