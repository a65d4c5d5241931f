#version 430 core
#include "lab/light.glsl"
#include "lab/view_sample.glsl"
#include "warpshadow/importance.glsl"
#include "passes/splat.glsl"
