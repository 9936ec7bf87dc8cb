// Guidance that sees more than its own tile (--guidance-of): a tile is refined as far as the tiles around it ask for, or as
// the tiles of other components over the same pixels do. A tile a thread. Not the paper's, which keeps guidance local so
// that tiles may be computed one by one (section 4.1). Pass: src/techniques/adaptive_interleaved/spread.rs.
#version 460
#include "techniques/adaptive_interleaved/bins.glsl"

// Components beside a tile's own, at most.
const uint MOST_OTHERS = 3u;

struct SpreadParams {
    uint tile_columns;
    uint tile_rows;
    // Pixels of the frame that a tile covers.
    uint tile_width_px;
    uint tile_height_px;
    // Further iterations at most.
    uint left;
    // 1: the eight tiles around a tile count.
    uint has_neighbours;
    // Components whose tiles count, and of each as much as of the own one.
    uint other_count;
    uint other_columns[3];
    uint other_rows[3];
    uint other_width_px[3];
    uint other_height_px[3];
};

layout(local_size_x = 64) in;

layout(push_constant) uniform Push { SpreadParams params; };
// What tiles ask for by themselves: the component's, and those of others.
layout(std430, set = 0, binding = 3) readonly buffer OwnGuidance { uint own_guidance[]; };
layout(std430, set = 0, binding = 4) readonly buffer OtherGuidance0 { uint other_guidance_0[]; };
layout(std430, set = 0, binding = 5) readonly buffer OtherGuidance1 { uint other_guidance_1[]; };
layout(std430, set = 0, binding = 6) readonly buffer OtherGuidance2 { uint other_guidance_2[]; };
layout(std430, set = 0, binding = 8) writeonly buffer Guidance { uint guidance[]; };
layout(std430, set = 0, binding = 9) buffer Bins { BinsBlock bins; };

uint other_asks(uint other, uint tile) {
    return other == 0u ? other_guidance_0[tile] : other == 1u ? other_guidance_1[tile] : other_guidance_2[tile];
}

// The most that tiles of another component ask for over the pixels of a tile.
uint most_of_other(uint other, uvec2 tile) {
    uvec2 size = uvec2(params.tile_width_px, params.tile_height_px);
    uvec2 other_size = uvec2(params.other_width_px[other], params.other_height_px[other]);
    uvec2 count = uvec2(params.other_columns[other], params.other_rows[other]);
    uvec2 first = tile * size / other_size;
    uvec2 last = min(((tile + 1u) * size - 1u) / other_size, count - 1u);
    uint most = 0u;
    for (uint y = first.y; y <= last.y; y++) {
        for (uint x = first.x; x <= last.x; x++) {
            most = max(most, other_asks(other, y * count.x + x));
        }
    }
    return most;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= params.tile_columns * params.tile_rows) {
        return;
    }
    uvec2 tile = uvec2(index % params.tile_columns, index / params.tile_columns);
    uint most = own_guidance[index];
    if (params.has_neighbours != 0u) {
        uvec2 first = max(tile, uvec2(1u)) - 1u;
        uvec2 last = min(tile + 1u, uvec2(params.tile_columns, params.tile_rows) - 1u);
        for (uint y = first.y; y <= last.y; y++) {
            for (uint x = first.x; x <= last.x; x++) {
                most = max(most, own_guidance[y * params.tile_columns + x]);
            }
        }
    }
    for (uint other = 0u; other < params.other_count; other++) {
        most = max(most, most_of_other(other, tile));
    }
    uint further = min(most, params.left);
    guidance[index] = further;
    if (further > 0u) {
        atomicAdd(bins.counts[further], 1u);
    }
}
