// Compute pass: importance of each cell from its lit and its dark view samples.
//
// A shadow ends in a cell where some samples are lit and some are dark; the fewer of them tell how
// much of the cell that concerns. The importance is, in steps (`ws_weight_in_steps`),
//
//     share · (lit + dark) + min(lit, dark).
//
// Dispatch one invocation per cell. Counts come from splat.glsl with two classes: the dark samples
// above the lit ones. Include warpshadow/importance.glsl before.
#ifndef WS_BINDING_CLASSES
#define WS_BINDING_CLASSES 0
#endif
#ifndef WS_BINDING_IMPORTANCE
#define WS_BINDING_IMPORTANCE 1
#endif

layout(local_size_x = 16, local_size_y = 8) in;

layout(r32ui, binding = WS_BINDING_CLASSES) uniform readonly uimage2D ws_classes;
layout(r32ui, binding = WS_BINDING_IMPORTANCE) uniform writeonly uimage2D ws_importance;

uniform float ws_share; // what a sample counts where no shadow ends, not negative
uniform float ws_steps; // steps in an importance of 1, positive

void main()
{
    ivec2 cells = imageSize(ws_importance);
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (cell.x >= cells.x || cell.y >= cells.y) {
        return;
    }
    float lit = float(imageLoad(ws_classes, cell).r);
    float dark = float(imageLoad(ws_classes, cell + ivec2(0, cells.y)).r);
    float weight = ws_share * (lit + dark) + min(lit, dark);
    imageStore(ws_importance, cell, uvec4(ws_weight_in_steps(weight, ws_steps)));
}
