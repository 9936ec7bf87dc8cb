// MASK surfaces in a shadow map: what alpha cuts out lets light through. Pass: src/passes/shadow_maps/mod.rs.
// variants: VERTEX=plain|extended
#version 460
#include "passes/shadow_maps_params.glsl"

#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif

#include "shading/material.glsl"

void main() {
    if (base_color_at(params.material).a < params.material.alpha_cutoff) {
        discard;
    }
}
