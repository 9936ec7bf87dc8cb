// A pixel of the un-split G-buffer as splits move it. Padding holds no surface: its normal has all bits 0.
#ifndef INTERLEAVED_DEFERRED_SURFACE_OF_FRAME_GLSL
#define INTERLEAVED_DEFERRED_SURFACE_OF_FRAME_GLSL

#include "passes/gbuffer_read.glsl"

SurfaceTexel surface_of_frame(MappingParams mapping, uvec2 pixel) {
    uvec2 held = min(pixel, uvec2(mapping.width_px, mapping.height_px) - 1u);
    uvec2 normal = normal_words(held);
    return SurfaceTexel(position_words(held), is_in_frame(mapping, pixel) ? normal : uvec2(0u));
}

#endif
