#version 430 core
// Importance of the view samples (of the light's texels with FORWARD), for either axis.
#define WS_BINDING_ROWS 2
#include "lab/light.glsl"
#include "warpshadow/importance.glsl"
#include "warpshadow/importance_functions.glsl"
#include "warpshadow/warp.glsl"
#ifdef FORWARD
#include "lab/light_sample.glsl"
#else
#include "lab/view_sample.glsl"
#ifdef WS_SPLAT_WEIGHTED
#include "lab/view_weight.glsl"
#endif
#ifdef WS_SPLAT_CLASSES
#include "lab/known_shadow.glsl"
#endif
#endif
#include "passes/splat.glsl"
