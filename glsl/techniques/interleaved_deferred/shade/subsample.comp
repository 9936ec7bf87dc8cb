// Sub-sampling: all lights at the middle pixel of each n x m cell (Segovia 2006, section 5.4, what figures 6 and 7
// compare with). Pass: src/techniques/interleaved_deferred/shade/subsample.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer_read.glsl"
#include "techniques/interleaved_deferred/shade/irradiance.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(std430, set = 0, binding = 6) writeonly buffer Irradiance { uvec2 irradiance[]; };

void main() {
    uvec2 cell = gl_GlobalInvocationID.xy;
    if (cell.x >= params.mapping.sub_width_px || cell.y >= params.mapping.sub_height_px) {
        return;
    }
    uvec2 pattern = uvec2(params.mapping.pattern_x, params.mapping.pattern_y);
    uvec2 last = uvec2(params.mapping.width_px, params.mapping.height_px) - 1u;
    uvec2 pixel = min(cell * pattern + pattern / 2u, last);
    uint texel = cell.y * params.mapping.sub_width_px + cell.x;
    uvec2 normal_bits = normal_words(pixel);
    if (!has_surface(normal_bits)) {
        irradiance[texel] = uvec2(0u);
        return;
    }
    vec3 position_ws = unpack_position(frame, position_words(pixel), pixel);
    irradiance[texel] = shade_subset(subsets[0], position_ws, unpack_normal(normal_bits));
}
