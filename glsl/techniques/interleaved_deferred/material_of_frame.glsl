// What splits move, and shading reads, of a pixel's material beside its normal's spare bits.
#ifndef INTERLEAVED_DEFERRED_MATERIAL_OF_FRAME_GLSL
#define INTERLEAVED_DEFERRED_MATERIAL_OF_FRAME_GLSL

#include "shading/extras.glsl"

layout(set = 0, binding = 42) uniform usampler2D gbuffer_color;
// Read where SURFACE_EXTRAS is 1 only, elsewhere the same as gbuffer_color.
layout(set = 0, binding = 43) uniform usampler2D gbuffer_emissive;

// Base colour in half floats, as in the G-buffer; in the fourth 16 bits the material's id, or, where any material of the scene has
// some, what few materials say (shading/extras.glsl).
uvec2 color_words(uvec2 pixel) {
    uvec2 words = texelFetch(gbuffer_color, ivec2(pixel), 0).rg;
    if (SURFACE_EXTRAS != 0u) {
        uint extras = texelFetch(gbuffer_emissive, ivec2(pixel), 0).g >> 16;
        words.y = (words.y & 0xffffu) | (extras << 16);
    }
    return words;
}

#endif
