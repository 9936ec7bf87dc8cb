// Each sub-buffer shaded with its own lights: one light list for neighbouring threads. Segovia 2006, section 4.3 (SNSM).
// Pass: src/techniques/interleaved_deferred/shade/sub_buffers.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer.glsl"
#include "techniques/interleaved_deferred/shade/irradiance.glsl"

layout(std430, set = 0, binding = 7) readonly buffer SplitPosition { POSITION_WORDS split_position[]; };
layout(std430, set = 0, binding = 8) readonly buffer SplitNormal { uvec2 split_normal[]; };

// x: texels of a sub-buffer, row after row; z: sub-buffers.
void main() {
    uvec3 id = gl_GlobalInvocationID;
    uint sub_texels = params.mapping.sub_width_px * params.mapping.sub_height_px;
    if (id.x >= sub_texels) {
        return;
    }
    uint texel = id.z * sub_texels + id.x;
    uvec2 normal_bits = split_normal[texel];
    if (!has_surface(normal_bits)) {
        irradiance[texel] = uvec2(0u);
        return;
    }
    uvec2 inside = uvec2(id.x % params.mapping.sub_width_px, id.x / params.mapping.sub_width_px);
    uvec2 pixel = pixel_of(params.mapping, id.z, inside);
    vec3 position_ws = unpack_position(frame, split_position[texel], pixel);
    irradiance[texel] = shade_subset(subsets[id.z], position_ws, unpack_normal(normal_bits));
}
