// A pixel of the un-split G-buffer as splits move it. Padding holds no surface: its normal has all bits 0.
#ifndef INTERLEAVED_DEFERRED_SURFACE_OF_FRAME_GLSL
#define INTERLEAVED_DEFERRED_SURFACE_OF_FRAME_GLSL

#include "passes/gbuffer_read.glsl"
#ifdef HAS_COLOR
#include "techniques/interleaved_deferred/material_of_frame.glsl"
#endif

SurfaceTexel surface_of_frame(MappingParams mapping, uvec2 pixel) {
    uvec2 held = min(pixel, uvec2(mapping.width_px, mapping.height_px) - 1u);
    SurfaceTexel texel;
    texel.position = position_words(held);
    texel.normal = is_in_frame(mapping, pixel) ? normal_words(held) : uvec2(0u);
#ifdef HAS_COLOR
    texel.color = color_words(held);
#endif
    return texel;
}

#endif
