// The sides of the shadow volumes: the edges where volumes of neighbours do not cancel.
struct volume_side
{
    uint from;
    uint to;
    int weight; // volumes to the left of the edge, as the light sees them, less those to the right
};

layout(std430, binding = 3) buffer volume_sides { volume_side sides[]; };
