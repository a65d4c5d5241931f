// What the passes that draw triangles count; lab::triangle_counts mirrors it.
layout(std430, binding = 6) buffer triangle_counts
{
    uint vertex_count;   // of the triangles to draw: the first word of an indirect draw
    uint instance_count;
    uint first_vertex;
    uint base_instance;
    uint waiting[2];     // pieces to cut, in either list
    uint sources;        // triangles that are left after clipping; with exact, those too large for
                         // the pass that sorts
    uint lost;           // triangles for which there was no room
    uint crowded;        // pieces that could not wait for want of room
    uint uncut;          // pieces drawn although an edge asked for another cut
    uint crossing;       // triangles that cross the bounds of the map
    uint pairs;          // of triangle and block of texels
    uint larger[2];      // triangles too large to be drawn by the pass that sorts, after either run
};
