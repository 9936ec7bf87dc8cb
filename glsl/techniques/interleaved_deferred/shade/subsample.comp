// Sub-sampling: all lights at the middle pixel of each n x m cell (Segovia 2006, section 5.4, what figures 6 and 7
// compare with). Pass: src/techniques/interleaved_deferred/shade/subsample.rs.
// variants: POSITION=half|unorm16|depth|float VPL_SHADOW=none|tested VPL_BRDF=lambert|ggx
#version 460
#include "techniques/interleaved_deferred/shade/of_frame.glsl"
#include "techniques/interleaved_deferred/shade/listed.glsl"

layout(std430, set = 0, binding = 6) writeonly buffer Irradiance { uvec2 irradiance[]; };

void main() {
    uint cell_count = params.mapping.sub_width_px * params.mapping.sub_height_px;
    for (uint i = 0u; i < TEXELS; i++) {
        uint cell = listed(i);
        uvec2 at = uvec2(cell % params.mapping.sub_width_px, cell / params.mapping.sub_width_px);
        uvec2 pixel = middle_of_cell(params.mapping, at);
        set_point_of_frame(i, cell < cell_count, pixel, cell);
    }
    shade_points(subsets[0]);
    for (uint i = 0u; i < TEXELS; i++) {
        if (listed(i) < cell_count) {
            irradiance[listed(i)] = point_irradiance[i];
        }
    }
}
