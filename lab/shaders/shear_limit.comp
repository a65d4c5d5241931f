#version 430 core
#include "passes/shear_limit.glsl"
