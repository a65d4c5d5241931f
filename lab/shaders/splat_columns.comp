#version 430 core
#define WS_SPLAT_COLUMNS
#define WS_BINDING_ROWS 2
#include "lab/light.glsl"
#include "lab/view_sample.glsl"
#include "warpshadow/importance.glsl"
#include "warpshadow/warp.glsl"
#include "passes/splat.glsl"
