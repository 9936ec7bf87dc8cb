// Whether a sample sees a surface with an alpha: MASK by its threshold, BLEND by as many samples as alpha says.
//
// The including shader includes shading/material.glsl with MATERIAL_PLACE and has `params`, `deep` and in_uv's varyings.
#ifndef DEEP_SHADING_ALPHA_GLSL
#define DEEP_SHADING_ALPHA_GLSL

#include "sampling/sobol.glsl"

// 0 to 1 without 1, another for each sample, draw and run: layers over each other must not let the same samples pass.
// A product with a power of two is exact on every device, and the same in each shader that asks; a quotient need not be.
float alpha_threshold(uvec2 at, uint tuple, uint draw) {
    uint bits = mixed(at.x * 0x9e3779b1u ^ at.y * 0x85ebca77u ^ tuple * 0xc2b2ae3du ^ draw * 0x27d4eb2fu);
    return float(bits >> 8) * (1.0 / 16777216.0);
}

bool is_seen(float alpha, uvec2 at, uint tuple) {
    if ((params.flags & DRAWN_BLENDED) != 0u) {
        return alpha > alpha_threshold(at, tuple, params.draw);
    }
    return alpha >= params.material.alpha_cutoff;
}

#endif
