// From what a sample sees to its colour, by following links. After space.glsl and nodes.glsl.
#ifndef DEEP_SHADING_SPID_GLSL
#define DEEP_SHADING_SPID_GLSL

// `own`: the sample's index. What no list has keeps the place of its colour in its node.
uint color_of(uvec2 spid, uint own) {
    uint color = NO_COLOR;
    if (spid.y != NO_SHADING_PIXEL) {
        color = color_index((spid.y >> 16) * deep.shading_width_px + (spid.y & 0xffffu), spid.x);
    }
    return color == NO_COLOR ? node_of(own).x : color;
}

#endif
