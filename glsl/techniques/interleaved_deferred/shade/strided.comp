// One subset over the un-split G-buffer, read at the pattern's stride: neighbouring threads share a light list and
// nothing is copied. All subsets in one dispatch, workgroups numbered by subset (`--split remap`, later practice), or a
// dispatch a subset (`--split indirect`, Segovia 2006, section 3.1). Pass: src/techniques/interleaved_deferred/shade/strided.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer_read.glsl"
#include "techniques/interleaved_deferred/shade/irradiance.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(std430, set = 0, binding = 6) writeonly buffer Irradiance { uvec2 irradiance[]; };

// x: texels of a sub-buffer, row after row; z: subsets from params.subset_first on.
void main() {
    uvec3 id = gl_GlobalInvocationID;
    uint sub_texels = params.mapping.sub_width_px * params.mapping.sub_height_px;
    uint subset = params.subset_first + id.z;
    uvec2 inside = uvec2(id.x % params.mapping.sub_width_px, id.x / params.mapping.sub_width_px);
    uvec2 pixel = pixel_of_texel(params.mapping, uvec3(inside, subset));
    if (id.x >= sub_texels || pixel.x >= params.mapping.width_px || pixel.y >= params.mapping.height_px) {
        return;
    }
    uint texel = pixel.y * row_pitch(params.mapping) + pixel.x;
    uvec2 normal_bits = normal_words(pixel);
    if (!has_surface(normal_bits)) {
        irradiance[texel] = uvec2(0u);
        return;
    }
    vec3 position_ws = unpack_position(frame, position_words(pixel), pixel);
    irradiance[texel] = shade_subset(subsets[subset], position_ws, unpack_normal(normal_bits));
}
