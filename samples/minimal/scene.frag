// The depth of the shadow map, or the picture with its shadows.
in vec3 world;
in vec3 in_map;
uniform bool into_map;
uniform vec3 to_sun; // unit length
uniform sampler2D rows, columns, shadow_map;
out vec4 colour;

// Depth of the plane that p lies on, at another place of the map. The rasteriser interpolates
// between warped corners; the plane is what the corners really span.
float plane_depth(vec3 p, vec2 place)
{
    vec3 dx = dFdx(p), dy = dFdy(p);
    float area = dx.x * dy.y - dx.y * dy.x;
    vec2 slope = vec2(dx.z * dy.y - dy.z * dx.y, dy.z * dx.x - dx.z * dy.x);
    float rise = area != 0.0 ? dot(slope, place - p.xy) / area : 0.0;
    return p.z + clamp(rise, -0.02, 0.02);
}

void main()
{
    vec2 size = vec2(textureSize(rows, 0).y); // of the map
    vec2 texel = into_map ? gl_FragCoord.xy : floor(ws_warp(rows, columns, in_map.xy) * size) + 0.5;
    float depth = plane_depth(in_map, ws_unwarp(rows, columns, texel / size));
    gl_FragDepth = into_map ? depth : gl_FragCoord.z;

    vec3 normal = normalize(cross(dFdx(world), dFdy(world)));
    float lit = depth - 1e-4 <= texture(shadow_map, texel / size).r ? max(dot(normal, to_sun), 0.0) : 0.0;
    vec3 surface = world.y < 0.01 ? vec3(0.55, 0.6, 0.45) : vec3(0.8, 0.7, 0.6);
    colour = vec4(pow(surface * (0.25 + 0.75 * lit), vec3(1.0 / 1.8)), 1.0);
}
