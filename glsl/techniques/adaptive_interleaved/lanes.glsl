// Which texel a thread has: in the picture's order, or slot by slot (--ray-order).
//
// Texels of one slot have the same samples: threads of neighbouring tiles that have them side by side send rays from near
// places to the same light, as the sub-buffers of Segovia 2006 would, and nothing is copied for it.
#ifndef ADAPTIVE_INTERLEAVED_LANES_GLSL
#define ADAPTIVE_INTERLEAVED_LANES_GLSL

#include "techniques/adaptive_interleaved/bins.glsl"
#include "techniques/adaptive_interleaved/tile.glsl"

// 1: threads that lie together have the same slot; 0: they have a tile.
layout(constant_id = 8) const uint BY_SLOT = 0;

// The texel of a thread over all of them: as many threads in a row as its tiles have, cut or not. It may lie beyond the
// component.
uvec2 texel_of_thread(AdaptiveParams params, uvec2 thread) {
    if (BY_SLOT == 0u) {
        return thread;
    }
    return uvec2(thread.x % params.tile_columns * params.tile_x + thread.x / params.tile_columns, thread.y);
}

// x: place in the list of the tile that a thread of the refinement has, y: the slot. A workgroup has whole tiles one after
// the other, or one slot of as many tiles as it has threads.
uvec2 listed_and_slot(AdaptiveParams params, uint thread) {
    uint size = tile_size(params);
    if (BY_SLOT == 0u) {
        return uvec2(thread / size, thread % size);
    }
    uint group = thread / REFINE_LANES;
    return uvec2(group / size * REFINE_LANES + thread % REFINE_LANES, group % size);
}

// Workgroups for so many tiles.
uint refine_group_count(AdaptiveParams params, uint tile_count) {
    uint size = tile_size(params);
    if (BY_SLOT == 0u) {
        return (tile_count * size + REFINE_LANES - 1u) / REFINE_LANES;
    }
    return (tile_count + REFINE_LANES - 1u) / REFINE_LANES * size;
}

#endif
