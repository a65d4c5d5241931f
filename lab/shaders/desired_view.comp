#version 430 core
#define FULL_MAP
#define WS_BINDING_DESIRED_VIEW 5
#include "lab/light.glsl"
#include "lab/view_sample.glsl"
#include "passes/desired_view.glsl"
