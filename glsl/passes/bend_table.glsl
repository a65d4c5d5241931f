// Compute pass: the bend table of a pair of warp tables (`build_bends` on the host).
//
// The table is an r32f texture of ws_blocks x (2 ws_blocks - 1) texels, ws_blocks a power of two, 64
// by default. Dispatch once per level, 0 to log2(ws_blocks), (ws_blocks >> level) invocations along
// x and y, with a barrier for texture fetches after each. Include warpshadow/bend_table.glsl
// before.
#ifndef WS_BINDING_BENDS_IMAGE
#define WS_BINDING_BENDS_IMAGE 0
#endif
#ifndef WS_BINDING_BENDS
#define WS_BINDING_BENDS 2
#endif
#ifndef WS_BINDING_ROWS
#define WS_BINDING_ROWS 0
#endif
#ifndef WS_BINDING_COLUMNS
#define WS_BINDING_COLUMNS 1
#endif

layout(local_size_x = 8, local_size_y = 8) in;

layout(r32f, binding = WS_BINDING_BENDS_IMAGE) uniform writeonly image2D ws_bends_image;
layout(binding = WS_BINDING_BENDS) uniform sampler2D ws_bends; // the same texture
layout(binding = WS_BINDING_ROWS) uniform sampler2D ws_rows;
layout(binding = WS_BINDING_COLUMNS) uniform sampler2D ws_columns;

uniform int ws_level;

void main()
{
    int blocks = imageSize(ws_bends_image).x;
    int across = blocks >> ws_level;
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= across || at.y >= across) {
        return;
    }
    float bend = ws_level == 0
                     ? ws_bend_of_block(ws_rows, ws_columns, blocks, at.x, at.y)
                     : ws_bend_of_surroundings(ws_bends, blocks, ws_level, at.x, at.y);
    int row = ws_bend_level_row(blocks, ws_level);
    imageStore(ws_bends_image, ivec2(at.x, row + at.y), vec4(bend));
    if (across == 1) {
        imageStore(ws_bends_image, ivec2(1, row), vec4(float(ws_bend_unit(ws_rows, ws_columns))));
    }
}
