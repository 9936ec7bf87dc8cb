// The colour that the filter does not see: irradiance of a Lambert surface is multiplied by its albedo after the filter (Segovia
// 2006, section 4.5); what a glossy one sends is divided by this colour before it, and multiplied after it.
#ifndef INTERLEAVED_DEFERRED_DEMODULATION_GLSL
#define INTERLEAVED_DEFERRED_DEMODULATION_GLSL

#include "shading/brdf.glsl"

// What a surface sends on of all that it receives, its mirror part at normal incidence. Never 0, because a black surface mirrors at
// grazing angles: its mirror part counts as a common dielectric's at least.
vec3 modulus_of(Surface surface) {
    return albedo_of(surface) + max(f0_of(surface), vec3(DEFAULT_DIELECTRIC_F0));
}

#endif
