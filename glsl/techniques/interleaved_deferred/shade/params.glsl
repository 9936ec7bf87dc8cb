// Parameters of shading, for every stage that shades.
#ifndef INTERLEAVED_DEFERRED_SHADE_PARAMS_GLSL
#define INTERLEAVED_DEFERRED_SHADE_PARAMS_GLSL

#include "techniques/interleaved_deferred/mapping.glsl"

struct ShadeParams {
    MappingParams mapping;
    // Square of --vpl-clamp, in square metres.
    float least_squared;
    // Sub-buffers of a cluster: (n * m) / (i * j), a whole number.
    float cluster_size;
    // i * j of --direct-pattern, the weight of a punctual light; a virtual point light weighs cluster_size times as much,
    // n * m. So the mean over a pattern is the sum over all lights.
    float weight;
    // First subset of this dispatch; 0 where a dispatch has them all.
    uint subset_first;
    // Words of `hidden` that a point has, where virtual lights are tested.
    uint words_a_point;
    uint _unused[3];
};

#endif
