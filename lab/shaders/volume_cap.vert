#version 430 core
// A triangle as the near end of its volume, or as the far end.
#include "lab/volume_place.glsl"
layout(location = 0) in vec3 position;
uniform bool far_end;

void main()
{
    gl_Position = clip_place(far_end ? vec4(away_from_light(position), 0.0) : vec4(position, 1.0));
}
