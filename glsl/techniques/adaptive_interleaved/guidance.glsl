// How many further iterations a tile needs, from what its pixels found out in the initial pass: getAdaptiveGuidance,
// refinementConditions and getIterations of Dubla 2009, Listings 1 to 3. Twin:
// src/techniques/adaptive_interleaved/sampler.rs.
//
// The including shader has the axis COMPONENT.
#ifndef ADAPTIVE_INTERLEAVED_GUIDANCE_GLSL
#define ADAPTIVE_INTERLEAVED_GUIDANCE_GLSL

#include "techniques/adaptive_interleaved/tile.glsl"

// Quotients are off by a few units in their last place, and another number of iterations would be another picture: what
// is this near below a whole number counts as it.
const float ROUNDING_GRACE = 0.0009765625;

bool refines(float refine) {
#if defined(COMPONENT_SS)
    // Wholly lit and wholly dark tiles have no penumbra.
    return refine > 0.0 && refine < 1.0;
#else
    return refine > 0.0;
#endif
}

// `information`: summed over the tile's pixels with a surface, of which there are `surface_count`.
uint further_iterations(AdaptiveParams params, float information, uint surface_count) {
    if (surface_count == 0u) {
        return 0u;
    }
    uint left = params.most - params.base;
    if (params.refines_all != 0u) {
        return left;
    }
    float refine = information / float(surface_count);
    uint wanted = uint(refine * float(params.most) + ROUNDING_GRACE);
    return refines(refine) ? min(wanted, left) : 0u;
}

#endif
