// Each sub-buffer shaded with its own lights: one light list for neighbouring threads. Segovia 2006, section 4.3 (SNSM).
// Pass: src/techniques/interleaved_deferred/shade/sub_buffers.rs.
// variants: POSITION=half|unorm16|depth|float STORAGE=buffer|image|layers VPL_SHADOW=none|tested VPL_BRDF=lambert|ggx
#version 460
#include "passes/gbuffer.glsl"
#define READS_SURFACE
#define WRITES_IRRADIANCE
#include "techniques/interleaved_deferred/shade/of_sub_buffer.glsl"
#include "techniques/interleaved_deferred/shade/listed.glsl"

uvec3 texel_at(uint place) {
    return uvec3(place % params.mapping.sub_width_px, place / params.mapping.sub_width_px, gl_GlobalInvocationID.z);
}

// Texels of a sub-buffer, row after row; z: sub-buffers.
void main() {
    for (uint i = 0u; i < TEXELS; i++) {
        uvec3 texel = texel_at(listed(i));
        bool exists = is_in_sub_buffer(params.mapping, texel);
        PLACE place = place_of_texel(params.mapping, exists ? texel : uvec3(0u, 0u, texel.z));
        set_point_of_sub_buffer(i, exists, place, texel);
    }
    shade_points(subsets[gl_GlobalInvocationID.z]);
    for (uint i = 0u; i < TEXELS; i++) {
        uvec3 texel = texel_at(listed(i));
        if (is_in_sub_buffer(params.mapping, texel)) {
            store_irradiance(place_of_texel(params.mapping, texel), point_irradiance[i]);
        }
    }
}
