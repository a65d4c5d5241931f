#version 430 core
#include "passes/collapse.glsl"
