// The list of the tiles that refine, those with most iterations first, and the dispatch over it. A tile a thread.
// Pass: src/techniques/adaptive_interleaved/compact.rs.
#version 460
#include "techniques/adaptive_interleaved/lanes.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push { AdaptiveParams params; };
layout(std430, set = 0, binding = 8) readonly buffer Guidance { uint guidance[]; };
layout(std430, set = 0, binding = 9) buffer Bins { BinsBlock bins; };
layout(std430, set = 0, binding = 10) writeonly buffer Tiles { uint tiles[]; };

void main() {
    uint tile = gl_GlobalInvocationID.x;
    if (tile >= params.tile_count) {
        return;
    }
    if (tile == 0u) {
        uint refined_count = 0u;
        for (uint further = 1u; further < BIN_COUNT; further++) {
            refined_count += bins.counts[further];
        }
        uint group_count = refine_group_count(params, refined_count);
        bins.refined_count = refined_count;
        bins.groups[0] = min(group_count, REFINE_ROW);
        bins.groups[1] = (group_count + REFINE_ROW - 1u) / REFINE_ROW;
        bins.groups[2] = 1u;
    }
    uint own = guidance[tile];
    if (own > 0u) {
        uint place = atomicAdd(bins.placed[own], 1u);
        for (uint further = own + 1u; further < BIN_COUNT; further++) {
            place += bins.counts[further];
        }
        tiles[place] = tile;
    }
}
