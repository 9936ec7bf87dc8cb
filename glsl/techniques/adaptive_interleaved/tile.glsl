// Tiles of texels, and what every pass of adaptive interleaved sampling knows of one component. Dubla 2009, section 3.
// Twin of the arithmetic: src/techniques/adaptive_interleaved/sampler.rs.
#ifndef ADAPTIVE_INTERLEAVED_TILE_GLSL
#define ADAPTIVE_INTERLEAVED_TILE_GLSL

#include "shading/medium_box.glsl"

struct AdaptiveParams {
    MediumBlock medium;
    // Texels of the component: the frame's pixels, or each scale-th of them in both directions.
    uint width;
    uint height;
    uint scale;
    // Size of a tile in texels, N x M.
    uint tile_x;
    uint tile_y;
    // Tiles in a row of the component, and in all of it; those at its right and lower edge may be cut.
    uint tile_columns;
    uint tile_count;
    // Iterations of the initial pass, and at most with those of the refinement.
    uint base;
    uint most;
    // 1: every tile refines to the most (--mode max).
    uint refines_all;
    // 1: each light guides by itself (--ss-guidance each).
    uint guides_each;
    // Virtual point lights, or area lights.
    uint source_count;
    // Punctual lights.
    uint light_count;
    // Square of --vpl-clamp, in square metres.
    float least_squared;
    // Metres that a march along a ray advances, and from a light within which its place is in the light's halo.
    float march_step;
    float halo;
    uint seed;
    // Relative standard error of a tile's mean at which it needs no more (--until-error); 0: what its rays met guides.
    float until_error;
};

// What a texel that is not estimated has found in the initial pass; that of others is a component's own word.
const uint NOT_ESTIMATED = 0xffffffffu;

uint tile_size(AdaptiveParams params) {
    return params.tile_x * params.tile_y;
}

// The place of a texel in its tile, row-major: which of the sampler's samples are its own.
uint slot_of(AdaptiveParams params, uvec2 texel) {
    return texel.y % params.tile_y * params.tile_x + texel.x % params.tile_x;
}

bool has_texel(AdaptiveParams params, uvec2 texel) {
    return texel.x < params.width && texel.y < params.height;
}

// Its place in the component's buffers.
uint index_of(AdaptiveParams params, uvec2 texel) {
    return texel.y * params.width + texel.x;
}

// It may lie beyond the component.
uvec2 texel_of(AdaptiveParams params, uint tile, uint slot) {
    uvec2 corner = uvec2(tile % params.tile_columns, tile / params.tile_columns) * uvec2(params.tile_x, params.tile_y);
    return corner + uvec2(slot % params.tile_x, slot / params.tile_x);
}

#endif
