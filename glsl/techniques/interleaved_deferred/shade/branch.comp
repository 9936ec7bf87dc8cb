// One pass over the un-split G-buffer, each pixel looping over its own subset (Segovia 2006, section 3.1, dynamic
// branching). With the pattern 1x1 it is plain deferred shading of all lights (`--split none`).
// Pass: src/techniques/interleaved_deferred/shade/branch.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer_read.glsl"
#include "techniques/interleaved_deferred/shade/irradiance.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(std430, set = 0, binding = 6) writeonly buffer Irradiance { uvec2 irradiance[]; };

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.mapping.width_px || pixel.y >= params.mapping.height_px) {
        return;
    }
    uint texel = pixel.y * row_pitch(params.mapping) + pixel.x;
    uvec2 normal_bits = normal_words(pixel);
    if (!has_surface(normal_bits)) {
        irradiance[texel] = uvec2(0u);
        return;
    }
    vec3 position_ws = unpack_position(frame, position_words(pixel), pixel);
    SubsetBlock subset = subsets[subset_of(params.mapping, pixel)];
    irradiance[texel] = shade_subset(subset, position_ws, unpack_normal(normal_bits));
}
