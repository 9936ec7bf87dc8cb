// Samples find their shading samples in a cache; for one that finds none an entry waits to be made.
// Pass: src/techniques/deep_shading/indirect/memoise.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/counters.glsl"
#include "techniques/deep_shading/entries/waiting.glsl"
#include "techniques/deep_shading/indirect/pointers.glsl"

// As in shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(set = 0, binding = 27) uniform usampler2DArray spids;
layout(std430, set = 0, binding = 22) writeonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(std430, set = 0, binding = 34) writeonly buffer Pointers { uint pointers[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
WRITES_PAIRS(set_color, colors)
WRITES_WORDS(set_pointer, pointers)

#include "techniques/deep_shading/indirect/cache.glsl"

void main() {
    // A pixel's tuples side by side: what one has found is still there when the next one asks.
    uvec2 thread = gl_GlobalInvocationID.xy;
    uvec3 at = uvec3(thread.x / deep.tuple_count, thread.y, thread.x % deep.tuple_count);
    if (at.x >= deep.layer_width_px) {
        return;
    }
    uint own = sample_index(deep, at);
    uvec2 spid = texelFetch(spids, ivec3(at), 0).xy;
    if (spid.x == NO_PRIMITIVE) {
        set_pointer(own, 0u);
        return;
    }
    uint owner = own;
    if (spid.y != NO_SHADING_PIXEL) {
        owner = memoised(spid, own);
    } else if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_STRAYS], 1u);
    }
    if (owner != own) {
        set_pointer(own, owner + 1u);
        return;
    }
    uint entry = atomicAdd(counters[COUNTED_COLORS], 1u);
    set_pointer(own, POINTER_OWNS | entry);
    set_color(entry, entry_of_sample(spid, own));
}
