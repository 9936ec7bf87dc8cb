// A cache of shading samples (Liktor & Dachsbacher 2012): which sample has the entry of the same triangle and shading pixel.
//
// A word of it is one more than the index of a sample, whose SPID is the key: SPIDs are all written before, so that an entry is
// there at once and no thread waits for another. What finds no room where it may stand takes the place of something
// else, which is then shaded once more where it is needed again.
//
// The including shader declares `deep`, `spids`, `counters[]`, `reach` and IS_COUNTED, after reach.glsl, space.glsl and
// counters.glsl.
#ifndef DEEP_SHADING_CACHE_GLSL
#define DEEP_SHADING_CACHE_GLSL

#include "sampling/sobol.glsl"

layout(constant_id = 99) const uint CACHE_ENTRIES = 1;

layout(std430, set = 0, binding = 33) coherent buffer Cache { uint cache[]; };
READS_WORDS(cached, cache)
SWAPS_WORDS(swap_cached, cache)
REPLACES_WORDS(replace_cached, cache)

// Places that a shading sample may stand at, in a row.
const uint CACHE_WAYS = 8u;

uvec2 spid_of(uint index) {
    return texelFetch(spids, ivec3(sample_place(deep, index)), 0).xy;
}

// The sample that has the entry of `spid`: `own`, the asking one, if no sample had it.
uint memoised(uvec2 spid, uint own) {
    uint first = mixed(spid.y * 0x9e3779b1u ^ mixed(spid.x)) % CACHE_ENTRIES;
    for (uint way = 0u; way < CACHE_WAYS; way++) {
        uint at = (first + way) % CACHE_ENTRIES;
        uint found = cached(at);
        if (found == 0u) {
            found = swap_cached(at, 0u, own + 1u);
        }
        if (found == 0u) {
            return own;
        }
        if (spid_of(found - 1u) == spid) {
            return found - 1u;
        }
    }
    replace_cached((first + mixed(own) % CACHE_WAYS) % CACHE_ENTRIES, own + 1u);
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_FORGOTTEN], 1u);
    }
    return own;
}

#endif
