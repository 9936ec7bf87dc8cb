// From what a sample sees to its colour, by following links. After space.glsl and nodes.glsl.
#ifndef DEEP_SHADING_SPID_GLSL
#define DEEP_SHADING_SPID_GLSL

// `own`: the sample's index. NO_COLOR where the list has lost it.
uint color_of(uvec2 spid, uint own) {
    if (spid.y == NO_SHADING_PIXEL) {
        return nodes[own].x;
    }
    return color_index((spid.y >> 16) * deep.shading_width_px + (spid.y & 0xffffu), spid.x);
}

#endif
