// What rasterisers do to corners before they draw by them.
#ifndef DEEP_SHADING_SNAP_GLSL
#define DEEP_SHADING_SNAP_GLSL

// They snap them to 2^-SUB_PIXEL_BITS of a pixel.
layout(constant_id = 100) const uint SUB_PIXEL_BITS = 8;

// By how much what must hold them is drawn too large, pixels: four of those steps, of which snapping may take away half a one.
float snap_px() {
    return 4.0 / float(1u << SUB_PIXEL_BITS);
}

#endif
