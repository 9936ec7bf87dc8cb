// Points that are shaded where they lie in the frame: no split has moved them.
#ifndef INTERLEAVED_DEFERRED_OF_FRAME_GLSL
#define INTERLEAVED_DEFERRED_OF_FRAME_GLSL

#include "passes/gbuffer_read.glsl"
#include "techniques/interleaved_deferred/shade/irradiance.glsl"
#ifdef VPL_BRDF_GGX
#include "techniques/interleaved_deferred/material_of_frame.glsl"
#endif

// The i-th point is the surface at a pixel; none where `exists` is false. `place`: as `first_hidden_word`.
void set_point_of_frame(uint i, bool exists, uvec2 pixel, uint place) {
    uvec2 normal = normal_words(pixel);
    set_point(i, exists, normal, position_words(pixel), pixel, place);
#ifdef VPL_BRDF_GGX
    set_material(i, normal, color_words(pixel));
#endif
}

#endif
