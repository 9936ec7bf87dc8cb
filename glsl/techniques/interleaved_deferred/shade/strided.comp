// One subset over the un-split G-buffer, read at the pattern's stride: neighbouring threads share a light list and
// nothing is copied. All subsets in one dispatch, workgroups numbered by subset (`--split remap`, later practice), or a
// dispatch a subset (`--split indirect`, Segovia 2006, section 3.1). With the pattern 1x1 it is plain deferred shading of
// all lights (`--split none`). Pass: src/techniques/interleaved_deferred/shade/strided.rs.
// variants: POSITION=half|unorm16|depth|float VPL_SHADOW=none|tested VPL_BRDF=lambert|ggx
#version 460
#include "techniques/interleaved_deferred/shade/of_frame.glsl"
#include "techniques/interleaved_deferred/shade/listed.glsl"

layout(std430, set = 0, binding = 6) writeonly buffer Irradiance { uvec2 irradiance[]; };

// The pixel that stands at a place of the subset's list, row after row of its sub-buffer.
uvec2 pixel_at(uint subset, uint place) {
    uvec2 inside = uvec2(place % params.mapping.sub_width_px, place / params.mapping.sub_width_px);
    return pixel_of_texel(params.mapping, uvec3(inside, subset));
}

// z: subsets from params.subset_first on.
void main() {
    uint subset = params.subset_first + gl_GlobalInvocationID.z;
    uvec2 last = uvec2(params.mapping.width_px, params.mapping.height_px) - 1u;
    for (uint i = 0u; i < TEXELS; i++) {
        uvec2 pixel = pixel_at(subset, listed(i));
        bool exists = is_in_frame(params.mapping, pixel);
        pixel = min(pixel, last);
        set_point_of_frame(i, exists, pixel, place_of_pixel(pixel));
    }
    shade_points(subsets[subset]);
    for (uint i = 0u; i < TEXELS; i++) {
        uvec2 pixel = pixel_at(subset, listed(i));
        if (is_in_frame(params.mapping, pixel)) {
            irradiance[pixel.y * row_pitch(params.mapping) + pixel.x] = point_irradiance[i];
        }
    }
}
