// What a pixel's samples of one layer are together, and how that is stored.
#ifndef DEEP_SHADING_RECONSTRUCT_LAYER_MEAN_GLSL
#define DEEP_SHADING_RECONSTRUCT_LAYER_MEAN_GLSL

#include "techniques/deep_shading/reconstruct/blur.glsl"

// Pairs of words that a mean takes: half floats of red and green, blue and the number of samples; of the support; and a depth.
const uint MEAN_PAIRS = 3u;

struct LayerMean {
    float count;
    vec3 radiance;
    vec3 support;
    // The least, metres.
    float depth;
};

LayerMean no_mean() {
    return LayerMean(0.0, vec3(0.0), vec3(0.0), NO_DEPTH);
}

// Where the first pair of a layer's mean lies: pixel by pixel, row by row.
uint mean_entry(uvec2 frame_px, uvec2 pixel, uint layer) {
    return ((pixel.y * frame_px.x + pixel.x) * LAYER_COUNT + layer) * MEAN_PAIRS;
}

uvec2[MEAN_PAIRS] packed_mean(LayerMean mean) {
    return uvec2[](uvec2(packHalf2x16(mean.radiance.rg), packHalf2x16(vec2(mean.radiance.b, mean.count))),
        uvec2(packHalf2x16(mean.support.xy), packHalf2x16(vec2(mean.support.z, 0.0))),
        uvec2(floatBitsToUint(mean.depth), 0u));
}

// How many samples it is the mean of, by its first pair.
float count_of_mean(uvec2 first) {
    return unpackHalf2x16(first.y).y;
}

LayerMean unpacked_mean(uvec2 first, uvec2 second, uvec2 third) {
    vec3 radiance = vec3(unpackHalf2x16(first.x), unpackHalf2x16(first.y).x);
    vec3 support = vec3(unpackHalf2x16(second.x), unpackHalf2x16(second.y).x);
    return LayerMean(count_of_mean(first), radiance, support, uintBitsToFloat(third.x));
}

#endif
