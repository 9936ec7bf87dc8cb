// Where gathers end: a buffer in frame order, which the filter reads. Two pixels of a row lie in one uvec4.
#ifndef INTERLEAVED_DEFERRED_FRAME_ORDER_GLSL
#define INTERLEAVED_DEFERRED_FRAME_ORDER_GLSL

#include "techniques/interleaved_deferred/mapping.glsl"

#ifdef COPY_PULL
layout(std430, set = 0, binding = 16) writeonly buffer Irradiance { uvec4 pair[]; } irradiance;

// The second pixel may lie in the padding of the row, which nothing reads.
void store_pixels(MappingParams mapping, uvec2 first, uvec2 words, uvec2 second_words) {
    irradiance.pair[(first.y * row_pitch(mapping) + first.x) / 2u] = uvec4(words, second_words);
}
#else
layout(std430, set = 0, binding = 16) writeonly buffer Irradiance { uvec2 texel[]; } irradiance;

// Padding is left out.
void store_pixel(MappingParams mapping, uvec2 pixel, uvec2 words) {
    if (is_in_frame(mapping, pixel)) {
        irradiance.texel[pixel.y * row_pitch(mapping) + pixel.x] = words;
    }
}
#endif

#endif
