// The un-split G-buffer as compute and fragment shaders read it: four images behind samplers that never filter.
// The including shader has the axis POSITION. The bindings are those of src/passes/gbuffer.rs, `GBuffer::bound`.
#ifndef PASSES_GBUFFER_READ_GLSL
#define PASSES_GBUFFER_READ_GLSL

#include "passes/gbuffer.glsl"

#ifdef POSITION_DEPTH
layout(set = 0, binding = 40) uniform sampler2D gbuffer_position;
#else
layout(set = 0, binding = 40) uniform usampler2D gbuffer_position;
#endif
layout(set = 0, binding = 41) uniform usampler2D gbuffer_normal;

POSITION_WORDS position_words(uvec2 pixel) {
#if defined(POSITION_DEPTH)
    return floatBitsToUint(texelFetch(gbuffer_position, ivec2(pixel), 0).r);
#elif defined(POSITION_FLOAT)
    return texelFetch(gbuffer_position, ivec2(pixel), 0);
#else
    return texelFetch(gbuffer_position, ivec2(pixel), 0).rg;
#endif
}

uvec2 normal_words(uvec2 pixel) {
    return texelFetch(gbuffer_normal, ivec2(pixel), 0).rg;
}

#endif
