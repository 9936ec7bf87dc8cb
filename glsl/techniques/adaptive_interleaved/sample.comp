// The initial pass of one component, a texel a thread. Dubla 2009, Listing 1, lines 1 to 7.
// Pass: src/techniques/adaptive_interleaved/sample.rs.
// variants: POSITION=half|unorm16|depth|float COMPONENT=id|ss|pm|ao
#version 460
#include "techniques/adaptive_interleaved/estimate.glsl"
#include "techniques/adaptive_interleaved/lanes.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

// Sum of the iterations as bits; w: what guides.
layout(std430, set = 0, binding = 3) writeonly buffer Estimates { uvec4 estimates[]; };

void main() {
    uvec2 texel = texel_of_thread(params, gl_GlobalInvocationID.xy);
    if (!has_texel(params, texel)) {
        return;
    }
    Point point = point_at(texel);
    uint slot = slot_of(params, texel);
    Estimate estimate = initial_estimate(point, slot);
    uint index = index_of(params, texel);
    // The refinement adds to it: what a driver has cut short stays no number.
    estimates[index] = uvec4(floatBitsToUint(nan_if_cut(estimate.sum)), found_by(point, slot, estimate));
    write_mean(index, estimate, params.base);
}
