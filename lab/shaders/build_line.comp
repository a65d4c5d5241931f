#version 430 core
#include "warpshadow/warp_build.glsl"
#include "passes/build_line.glsl"
