// The geometry pass: normal, DSF data and, where the light pass has it, specular power. Kircher 2009, sections 2.1, 3.1, 4.
// Pass: src/techniques/inferred_lighting/geometry.rs.
// variants: ALPHA=opaque|mask|blend EXTRAS=off|on PACKING=words|channels VERTEX=plain|extended
#version 460
#include "techniques/inferred_lighting/encoding.glsl"
#include "resident.glsl"

struct GeometryParams {
    // The draw's.
    MaterialBlock material;
    // Linear depth: the first step, and all of them.
    float first_depth_m;
    float depth_range_m;
    // BLEND: side of the stipple, and which of its texels are the draw's, row-major.
    uint stipple_side;
    uint stipple_layer;
};

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(push_constant) uniform Push { GeometryParams params; };
#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif

#include "shading/material.glsl"

// Targets have as many bits a texel all, in every packing (section 5.2).
#ifdef PACKING_WORDS
#define TARGET uint
#define target_of(word) (word)
#else
#define TARGET vec4
#define target_of(word) channels_of(word)
#endif

layout(location = 0) out TARGET out_normal;
layout(location = 1) out TARGET out_dsf;
#ifdef EXTRAS_ON
layout(location = 2) out TARGET out_extras;
#endif

// Below this a texel is taken for empty: no lit sample belongs there (section 6).
const float LEAST_ALPHA = 1.0 / 255.0;

void main() {
    MaterialBlock material = params.material;
#ifdef ALPHA_BLEND
    uvec2 cell = uvec2(gl_FragCoord.xy) % params.stipple_side;
    if (cell.y * params.stipple_side + cell.x != params.stipple_layer) {
        discard;
    }
    if (base_color_at(material).a < LEAST_ALPHA) {
        discard;
    }
#endif
#ifdef ALPHA_MASK
    if (base_color_at(material).a < material.alpha_cutoff) {
        discard;
    }
#endif
    out_normal = target_of(pack_view_normal(view_from_world(frame, normal_at(material))));
    float depth_m = linear_depth(frame, in_position_ws);
    out_dsf = target_of(pack_dsf(depth_m, vec2(params.first_depth_m, params.depth_range_m), in_ids.y));
#ifdef EXTRAS_ON
    out_extras = target_of(pack_extras_word(metallic_roughness_at(material).y, in_material));
#endif
}
