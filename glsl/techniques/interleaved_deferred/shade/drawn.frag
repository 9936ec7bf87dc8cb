// Each sub-buffer with its own lights, drawn: a viewport on it, or a quad (Segovia 2006, section 4.3).
// Pass: src/techniques/interleaved_deferred/shade/drawn.rs.
// variants: POSITION=half|unorm16|depth|float VPL_SHADOW=none|tested VPL_BRDF=lambert|ggx
#version 460
#include "passes/gbuffer.glsl"
#define STORAGE_IMAGE
#define READS_SURFACE
#include "techniques/interleaved_deferred/shade/of_sub_buffer.glsl"

layout(location = 0) flat in uint in_instance;
layout(location = 0) out uvec2 out_irradiance;

void main() {
    uvec2 at = uvec2(gl_FragCoord.xy);
    // The draw's sub-buffer, not the texel's: one that is drawn elsewhere would show.
    uvec2 sub_size = uvec2(params.mapping.sub_width_px, params.mapping.sub_height_px);
    uvec3 texel = uvec3(at - place_in_pattern(params.mapping, in_instance) * sub_size, in_instance);
    set_point_of_sub_buffer(0u, true, ivec2(at), texel);
    shade_points(subsets[in_instance]);
    out_irradiance = point_irradiance[0];
}
