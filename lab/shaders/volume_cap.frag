#version 430 core
// Counts an end of a volume: no end lies before what is seen. Far ends are at infinity, near ends
// are the very triangles among which the G-buffer kept the nearest, so the surface that is seen
// counts as just before its own volume. No depths are compared, and none can be equal by accident.
layout(std430, binding = 2) readonly buffer facing_light { int facing[]; };
uniform bool far_end;
layout(location = 0) out float count;

void main()
{
    // on the way from the eye to infinity, through outward faces into the volume and through the
    // others out of it
    bool enters = gl_FrontFacing != far_end;
    count = float(enters ? -facing[gl_PrimitiveID] : facing[gl_PrimitiveID]);
}
