#version 430 core
#include "warpshadow/importance.glsl"
#include "passes/weigh_cells.glsl"
