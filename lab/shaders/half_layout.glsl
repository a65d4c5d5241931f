// Pieces of triangles for a hemisphere's map with tables, in space: edges are arcs until they are cut.
struct half_piece {
    vec3 p0;        // corners relative to the light, in the axes of the world
    uint triangle;  // index into the scene, and in the upper two bits the edge to cut
    vec3 p1;
    float nearest;  // least distance of the whole triangle from the light
    vec3 p2;
    float farthest; // largest
};

const uint triangle_bits = 0x3fffffffu;
