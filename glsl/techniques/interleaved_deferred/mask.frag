// Writes which subset each pixel belongs to, for the splits that choose pixels by a test (Segovia 2006, section 3.1).
// Pass: src/techniques/interleaved_deferred/mask.rs.
//   stencil  a draw a bit of the subset's number, its instance: where the bit is set, the stencil's bit becomes 1
//   depth    one draw: the subset's number in 4096ths, each of them a float and each another. The test compares bits with
//            those of fullscreen.vert: a product is rounded right on every device, and a quotient need not be
// variants: MASK=stencil|depth
#version 460
#include "techniques/interleaved_deferred/mapping.glsl"

layout(push_constant) uniform Push { MappingParams mapping; };

#ifdef MASK_STENCIL
layout(location = 0) flat in uint in_instance;

void main() {
    if ((subset_of(mapping, uvec2(gl_FragCoord.xy)) >> in_instance & 1u) == 0u) {
        discard;
    }
}
#else
void main() {
    gl_FragDepth = float(subset_of(mapping, uvec2(gl_FragCoord.xy))) * (1.0 / 4096.0);
}
#endif
