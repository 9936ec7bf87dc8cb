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

// What the texels of a tile found together: the component's own, or with --until-error the sum and the squares of their
// luminances.
struct TileFound {
    uint texel_count;
    Found found;
    float sum;
    float squares;
};

const TileFound TILE_UNKNOWN = TileFound(0u, NOTHING_FOUND, 0.0, 0.0);

void add_word(AdaptiveParams params, uint word, inout TileFound tile) {
    if (word == NOT_ESTIMATED) {
        return;
    }
    tile.texel_count++;
    if (params.until_error > 0.0) {
        precise float luminance = uintBitsToFloat(word);
        precise float sum = tile.sum + luminance;
        precise float squares = tile.squares + luminance * luminance;
        tile.sum = sum;
        tile.squares = squares;
    } else {
        add_found(params, word, tile.found);
    }
}

// Iterations after which the mean of a tile's texels is as good as --until-error says, by the variance of what they had
// from the initial pass: errors of means fall as the root of what they are made of.
float iterations_until_error(AdaptiveParams params, TileFound tile) {
    float count = float(tile.texel_count);
    if (tile.texel_count < 2u) {
        return float(params.most);
    }
    precise float mean = tile.sum / count;
    precise float variance = max(tile.squares / count - mean * mean, 0.0) * (count / (count - 1.0));
    precise float bound = params.until_error * mean;
    return bound > 0.0 ? float(params.base) * variance / (count * bound * bound) : 0.0;
}

uint further_iterations(AdaptiveParams params, TileFound tile) {
    if (tile.texel_count == 0u) {
        return 0u;
    }
    uint left = params.most - params.base;
    if (params.refines_all != 0u) {
        return left;
    }
    if (params.until_error > 0.0) {
        float needed = min(iterations_until_error(params, tile), float(params.most));
        return min(uint(max(ceil(needed - ROUNDING_GRACE) - float(params.base), 0.0)), left);
    }
    float refine = refine_of(params, tile.found, tile.texel_count);
    uint wanted = uint(refine * float(params.most) + ROUNDING_GRACE);
    return refines(refine) ? min(wanted, left) : 0u;
}

#endif
