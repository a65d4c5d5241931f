#version 430 core
// Shadow volumes, second step: the silhouette (Kim et al. 2008). Every triangle, turned towards the
// light, throws a volume of its own; along an edge the sides of opposite sense cancel, and what is
// left is one side that counts as often as it has to. This holds for any heap of triangles.
layout(local_size_x = 64) in;
#include "lab/volume_sides.glsl"
layout(std430, binding = 2) readonly buffer facing_light { int facing[]; };
layout(std430, binding = 5) readonly buffer volume_edges { uvec4 edges[]; }; // of lab/volume_edges.hpp
layout(std430, binding = 6) readonly buffer edge_triangles { uint runs[]; };
layout(std430, binding = 7) buffer draw_arguments
{
    uint vertex_count;
    uint instance_count;
    uint first_vertex;
    uint base_instance;
};
uniform uint edge_count;
uniform uint vertices_per_side;

void find_side(uvec4 edge)
{
    int weight = 0;
    for (uint i = edge.z; i < edge.z + edge.w; ++i) {
        int turned = facing[runs[i] >> 1];
        weight += (runs[i] & 1u) == 0u ? turned : -turned;
    }
    if (weight != 0) {
        uint slot = atomicAdd(vertex_count, vertices_per_side) / vertices_per_side;
        sides[slot] = volume_side(edge.x, edge.y, weight);
    }
}

void main()
{
    for (uint id = gl_GlobalInvocationID.x; id < edge_count;
         id += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        find_side(edges[id]);
    }
}
