#version 430 core
#define WS_DEPTH_LAYER 0
#define WS_BINDING_DEPTHS 7
#include "warpshadow/importance_functions.glsl"
#include "passes/depth_edges.glsl"
