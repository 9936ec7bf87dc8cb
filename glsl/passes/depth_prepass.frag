// MASK surfaces in the depth pre-pass: what alpha cuts out has no depth. Pass: src/passes/depth_prepass.rs.
// variants: VERTEX=plain|extended SHADED=pixel|sample
#version 460
#include "resident.glsl"

struct DepthPrepassParams {
    // The draw's.
    MaterialBlock material;
};

layout(push_constant) uniform Push { DepthPrepassParams params; };
#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif

#include "shading/material.glsl"

void main() {
    if (base_color_at(params.material).a < params.material.alpha_cutoff) {
        discard;
    }
}
