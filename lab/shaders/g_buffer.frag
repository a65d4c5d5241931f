#version 430 core
in vec3 world;
uniform vec3 eye;
layout(std430, binding = 0) readonly buffer face_normals { vec4 face_normal[]; };
layout(location = 0) out vec4 out_position;
layout(location = 1) out vec4 out_normal;

void main()
{
    vec3 normal = face_normal[gl_PrimitiveID].xyz;
    // surfaces have two sides: the one that is seen counts
    if (dot(normal, eye - world) < 0.0) {
        normal = -normal;
    }
    out_position = vec4(world, 1.0);
    out_normal = vec4(normal, 0.0);
}
