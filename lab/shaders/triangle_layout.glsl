// Triangles of the shadow pass in map space.
//
// Set-up clips to the light's volume, where w > 0, and divides: what is left lies in the unit
// square and may be cut and warped without a thought of perspective. Depth is affine there.
struct source_triangle {
    vec2 p0, p1, p2;     // corners in the unwarped map
    vec2 depth_slope;    // d(depth)/d(map)
    float depth0;        // depth at p0
    float depth_lo;      // least depth of the three corners of the whole triangle
    float depth_hi;      // largest
    uint padding;
};

// A part of one, before the warp.
struct waiting_piece {
    vec2 p0, p1, p2;
    uint source;
    int edge; // the one to cut: 0 for p0 p1, 1 for p1 p2, 2 for p2 p0
};

// What is drawn for a part, after the warp.
struct ready_piece {
    vec2 q0, q1, q2;
    uint source;
    uint padding;
};

// Texels along a side of a block: what is large is drawn block by block.
const int block_side = 8;
