#version 430 core
// Squares of two triangles each that cover a map: llvmpipe leaves out parts of triangles that are
// larger than a few thousand texels.
uniform int squares; // along a side

void main()
{
    const ivec2 corners[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0),
                                     ivec2(1, 1));
    int square = gl_VertexID / 6;
    ivec2 corner = ivec2(square % squares, square / squares) + corners[gl_VertexID % 6];
    gl_Position = vec4(vec2(corner) / float(squares) * 2.0 - 1.0, 0.0, 1.0);
}
