// All three steps of one component in one dispatch: each tile iterates as often as it must, its texels a thread each,
// as many whole tiles as a workgroup holds. Dubla 2009, Listing 1. Pass: src/techniques/adaptive_interleaved/fused.rs.
// variants: POSITION=half|unorm16|depth|float COMPONENT=id|ss|pm|ao
#version 460
#include "techniques/adaptive_interleaved/bins.glsl"
#include "techniques/adaptive_interleaved/estimate.glsl"
#include "techniques/adaptive_interleaved/guidance.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 8) writeonly buffer Guidance { uint guidance[]; };

shared uint found[REFINE_LANES];

void main() {
    uint size = tile_size(params);
    uint tiles_per_group = REFINE_LANES / size;
    uint group = gl_WorkGroupID.y * REFINE_ROW + gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationIndex;
    uint tile = group * tiles_per_group + lane / size;
    uint slot = lane % size;
    bool has_tile = lane < tiles_per_group * size && tile < params.tile_count;
    uvec2 texel = texel_of(params, tile, slot);
    bool is_own = has_tile && has_texel(params, texel);
    Point point;
    Estimate estimate = NO_ESTIMATE;
    found[lane] = NOT_ESTIMATED;
    if (is_own) {
        point = point_at(texel);
        estimate = initial_estimate(point, slot);
        found[lane] = found_by(point, slot, estimate);
    }
    barrier();
    TileFound of_tile = TILE_UNKNOWN;
    uint first = lane - slot;
    for (uint other = first; other < min(first + size, REFINE_LANES); other++) {
        add_word(params, found[other], of_tile);
    }
    if (!is_own) {
        return;
    }
    uint further = further_iterations(params, of_tile);
    uint end = params.base + further;
    if (is_estimated(point)) {
        iterate(point, slot, params.base, end, estimate);
    }
    write_mean(index_of(params, texel), estimate, end);
    if (slot == 0u) {
        guidance[tile] = further;
    }
}
