#version 430 core
#include "passes/shear_mix.glsl"
