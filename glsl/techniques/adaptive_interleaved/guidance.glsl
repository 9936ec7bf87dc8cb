// How many further iterations a tile needs, from what its texels found in the initial pass: getAdaptiveGuidance,
// refinementConditions and getIterations of Dubla 2009, Listings 1 to 4. Twin:
// src/techniques/adaptive_interleaved/sampler.rs.
//
// The including shader has the axis COMPONENT.
#ifndef ADAPTIVE_INTERLEAVED_GUIDANCE_GLSL
#define ADAPTIVE_INTERLEAVED_GUIDANCE_GLSL

#include "techniques/adaptive_interleaved/tile.glsl"
#include "techniques/adaptive_interleaved/component.glsl"

// Quotients are off by a few units in their last place, and another number of iterations would be another picture: what
// is this near below a whole number counts as it.
const float ROUNDING_GRACE = 0.0009765625;

// What the texels of a tile found together.
struct TileFound {
    uint texel_count;
    Found found;
};

const TileFound TILE_UNKNOWN = TileFound(0u, NOTHING_FOUND);

void add_word(AdaptiveParams params, uint word, inout TileFound tile) {
    if (word != NOT_ESTIMATED) {
        add_found(params, word, tile.found);
        tile.texel_count++;
    }
}

uint further_iterations(AdaptiveParams params, TileFound tile) {
    if (tile.texel_count == 0u) {
        return 0u;
    }
    uint left = params.most - params.base;
    if (params.refines_all != 0u) {
        return left;
    }
    float refine = refine_of(params, tile.found, tile.texel_count);
    uint wanted = uint(refine * float(params.most) + ROUNDING_GRACE);
    return refines(refine) ? min(wanted, left) : 0u;
}

#endif
