#version 430 core
#include "passes/column_sums.glsl"
