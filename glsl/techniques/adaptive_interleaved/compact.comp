// The list of the tiles that refine, those with most iterations first, and the dispatch over it. A tile a thread, a block of
// tiles a workgroup.
// Pass: src/techniques/adaptive_interleaved/compact.rs.
#version 460
#include "techniques/adaptive_interleaved/lanes.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push { AdaptiveParams params; };
layout(std430, set = 0, binding = 8) readonly buffer Guidance { uint guidance[]; };
layout(std430, set = 0, binding = 9) buffer Bins { BinsBlock bins; };
layout(std430, set = 0, binding = 10) writeonly buffer Tiles { uint tiles[]; };

// Tiles are listed block by block of these sides, so that those that follow each other in the list are near each other: their
// rays meet the same surfaces.
const uint BLOCK_TILES = 8u;

void main() {
    uint block_columns = (params.tile_columns + BLOCK_TILES - 1u) / BLOCK_TILES;
    uint block = gl_WorkGroupID.x;
    uvec2 corner = uvec2(block % block_columns, block / block_columns) * BLOCK_TILES;
    uint place_in_block = gl_LocalInvocationID.x;
    uvec2 at = corner + uvec2(place_in_block % BLOCK_TILES, place_in_block / BLOCK_TILES);
    uint tile = at.y * params.tile_columns + at.x;
    if (at.x >= params.tile_columns || tile >= params.tile_count) {
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
