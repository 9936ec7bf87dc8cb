// The refinement of one component: a texel of a listed tile a thread. Dubla 2009, Listing 1, lines 14 to 19.
// Pass: src/techniques/adaptive_interleaved/refine.rs.
// variants: POSITION=half|unorm16|depth|float COMPONENT=id|ss|pm|ao
#version 460
#include "techniques/adaptive_interleaved/estimate.glsl"
#include "techniques/adaptive_interleaved/lanes.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 3) readonly buffer Estimates { uvec4 estimates[]; };
layout(std430, set = 0, binding = 8) readonly buffer Guidance { uint guidance[]; };
layout(std430, set = 0, binding = 9) readonly buffer Bins { BinsBlock bins; };
layout(std430, set = 0, binding = 10) readonly buffer Tiles { uint tiles[]; };

void main() {
    uint group = gl_WorkGroupID.y * REFINE_ROW + gl_WorkGroupID.x;
    uvec2 own = listed_and_slot(params, group * REFINE_LANES + gl_LocalInvocationIndex);
    if (own.x >= bins.refined_count) {
        return;
    }
    uint tile = tiles[own.x];
    uint slot = own.y;
    uvec2 texel = texel_of(params, tile, slot);
    if (!has_texel(params, texel)) {
        return;
    }
    Point point = point_at(texel);
    if (!is_estimated(point)) {
        return;
    }
    uint index = index_of(params, texel);
    Estimate estimate = NO_ESTIMATE;
    estimate.sum = uintBitsToFloat(estimates[index].rgb);
    estimate.ray_count = rays[index];
    uint end = params.base + guidance[tile];
    iterate(point, slot, params.base, end, estimate);
    write_mean(index, estimate, end);
}
