#version 430 core
#define WS_BINDING_ROWS 2
#define WS_BINDING_COLUMNS 3
#include "warpshadow/warp.glsl"
#include "passes/unwarp_centres.glsl"
