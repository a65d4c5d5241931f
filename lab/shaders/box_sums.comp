#version 430 core
#include "passes/box_sums.glsl"
