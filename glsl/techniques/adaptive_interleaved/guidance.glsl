// How many further iterations a tile needs, from what its texels found in the initial pass: getAdaptiveGuidance,
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

// What the texels of a tile found together.
struct TileFound {
    uint surface_count;
    // Sum of their numbers, where a word is one.
    float sum;
    // Bits that any of them has, and that all have, and how many are missing in all of them together.
    uint any;
    uint all;
    uint missing_count;
};

const TileFound NOTHING_FOUND = TileFound(0u, 0.0, 0u, 0xffffffffu, 0u);

// The bits that lights have.
uint light_bits(AdaptiveParams params) {
    return (1u << min(params.source_count + params.light_count, LIGHT_BITS)) - 1u;
}

void add_found(AdaptiveParams params, uint word, inout TileFound found) {
    if (word == NO_SURFACE) {
        return;
    }
    found.surface_count++;
    if (params.guides_each != 0u) {
        found.any |= word;
        found.all &= word;
        found.missing_count += bitCount(~word & light_bits(params));
    } else {
        precise float sum = found.sum + uintBitsToFloat(word);
        found.sum = sum;
    }
}

// The mean of the numbers; with a bit for each light the part that is hidden of those lights alone that some texels
// meet and others do not.
float refine_of(AdaptiveParams params, TileFound found) {
    if (params.guides_each == 0u) {
        return found.sum / float(found.surface_count);
    }
    uint bits = light_bits(params);
    uint parted_count = bitCount(found.any & ~found.all & bits);
    uint missing_count = found.missing_count - bitCount(~found.any & bits) * found.surface_count;
    return parted_count > 0u ? float(missing_count) / float(parted_count * found.surface_count) : 0.0;
}

bool refines(float refine) {
#if defined(COMPONENT_SS)
    // Wholly lit and wholly dark tiles have no penumbra.
    return refine > 0.0 && refine < 1.0;
#else
    return refine > 0.0;
#endif
}

uint further_iterations(AdaptiveParams params, TileFound found) {
    if (found.surface_count == 0u) {
        return 0u;
    }
    uint left = params.most - params.base;
    if (params.refines_all != 0u) {
        return left;
    }
    float refine = refine_of(params, found);
    uint wanted = uint(refine * float(params.most) + ROUNDING_GRACE);
    return refines(refine) ? min(wanted, left) : 0u;
}

#endif
