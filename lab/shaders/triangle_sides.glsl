// Whether a place lies in a triangle, in the unwarped map.

// The end from which the side of an edge is asked. The same for both triangles on the edge, so that
// none of both can miss what the other does not take.
vec2 end_of(vec2 a, vec2 b)
{
    return b.x < a.x || (b.x == a.x && b.y < a.y) ? b : a;
}

// On which side of an edge p lies; the other direction gives the same bits with the other sign.
float side(vec2 along, vec2 end, vec2 p)
{
    precise float area = along.x * (p.y - end.y) - along.y * (p.x - end.x);
    return area;
}

// On the same side of all edges, whichever that is.
bool is_inside(float side0, float side1, float side2)
{
    return min(side0, min(side1, side2)) >= 0.0 || max(side0, max(side1, side2)) <= 0.0;
}
