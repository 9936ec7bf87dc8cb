// Guidance by the mean of what the texels of a tile found: Dubla 2009, Listings 2 and 3.
#ifndef ADAPTIVE_INTERLEAVED_MEAN_GUIDANCE_GLSL
#define ADAPTIVE_INTERLEAVED_MEAN_GUIDANCE_GLSL

// The sum of the texels' numbers.
struct Found {
    float sum;
};

const Found NOTHING_FOUND = Found(0.0);

void add_found(AdaptiveParams params, uint word, inout Found found) {
    precise float sum = found.sum + uintBitsToFloat(word);
    found.sum = sum;
}

float refine_of(AdaptiveParams params, Found found, uint texel_count) {
    return found.sum / float(texel_count);
}

#endif
