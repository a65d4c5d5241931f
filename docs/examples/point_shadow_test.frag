// The GLSL snippet of docs/point-lights.md; a test puts #version and paraboloid.glsl before it.
uniform sampler2DArray maps; // front, back: distances over the far distance
uniform mat3 from_world;     // to the frame of the light
uniform vec3 light;
uniform float far_distance;
uniform float bias;
in vec3 world;
out vec4 colour;

void main()
{
    // [snippet]
    vec3 p = from_world * (world - light);
    ws_paraboloid_point at = ws_paraboloid_lookup(p);
    float stored = texture(maps, vec3(ws_paraboloid_map(at.uv), max(at.side, 0))).r;
    bool lit = ws_paraboloid_depth(p, 0.0, far_distance) <= stored + bias;
    // [snippet]
    colour = vec4(lit ? 1.0 : 0.0);
}
