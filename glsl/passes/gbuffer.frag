// G-buffer creation (BC). Segovia 2006, section 4.1. Pass: src/passes/gbuffer.rs.
// variants: POSITION=half|unorm16|depth|float EMISSIVE=off|on ALPHA=opaque|mask VERTEX=plain|extended
#version 460
#include "passes/gbuffer.glsl"
#include "shading/extras.glsl"
#include "resident.glsl"

struct GBufferParams {
    // The draw's. Lavapipe reads a storage buffer lane by lane: from one, the pass takes 5 to 7 % longer.
    MaterialBlock material;
};

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(push_constant) uniform Push { GBufferParams params; };
#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif

#include "shading/material.glsl"

layout(location = 0) out uvec2 out_normal;
layout(location = 1) out uvec2 out_color;
#ifdef EMISSIVE_ON
layout(location = 2) out uvec2 out_emissive;
#define POSITION_LOCATION 3
#else
#define POSITION_LOCATION 2
#endif
#if defined(POSITION_FLOAT)
layout(location = POSITION_LOCATION) out uvec4 out_position;
#elif !defined(POSITION_DEPTH)
layout(location = POSITION_LOCATION) out uvec2 out_position;
#endif

void main() {
    MaterialBlock material = params.material;
    vec4 base_color = base_color_at(material);
#ifdef ALPHA_MASK
    if (base_color.a < material.alpha_cutoff) {
        discard;
    }
#endif
#ifdef EMISSIVE_ON
    vec3 emitted = emissive_at(material);
    uint extras = 0u;
    if (SURFACE_EXTRAS != 0u) {
        extras = extras_at(material);
        if ((material.flags & MATERIAL_UNLIT) != 0u) {
            // A black surface that mirrors nothing, whose emission is the colour.
            emitted = base_color.rgb;
            base_color.rgb = vec3(0.0);
        }
    }
    out_emissive = pack_halves(emitted, extras);
#endif
    vec2 metallic_roughness = metallic_roughness_at(material);
    out_normal = pack_normal(normal_at(material, to_eye(frame, in_position_ws)), metallic_roughness.y, metallic_roughness.x);
    out_color = pack_halves(base_color.rgb, in_material & 0xffffu);
#if defined(POSITION_FLOAT)
    out_position = uvec4(floatBitsToUint(in_position_ws), 0u);
#elif defined(POSITION_HALF)
    out_position = pack_halves(clamp(in_position_ws, -HALF_MAX, HALF_MAX), 0u);
#elif defined(POSITION_UNORM16)
    out_position = pack_unorm16(frame, in_position_ws);
#endif
}
