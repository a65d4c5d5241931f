// Triangles of the shadow pass in map space, with the depth of their plane.
//
// Set-up clips to the light's volume, where w > 0, and divides: what is left lies in the unit
// square and may be cut and warped without a thought of perspective. Depth is affine there.
struct map_triangle {
    vec2 p0, p1, p2;     // corners in the unwarped map
    vec2 depth_slope;    // d(depth)/d(map)
    float depth0;        // depth at p0
    float depth_lo;      // least depth of the three corners of the whole triangle
    float depth_hi;      // largest
    int edge;            // the one to cut, while the triangle waits
};

