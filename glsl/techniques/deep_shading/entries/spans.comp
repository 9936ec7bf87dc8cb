// Where each material's entries begin, and how many workgroups they take; between both steps of sort.comp.
// Pass: src/techniques/deep_shading/entries/spans.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/counters.glsl"

#define ORDER_ACCESS writeonly
#define ORDER_FUNCTION WRITES_WORDS
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
#include "techniques/deep_shading/entries/order.glsl"

// Materials of the scene: what is bound may be longer than their spans.
layout(constant_id = 106) const uint MATERIAL_COUNT = 1;

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(std430, set = 0, binding = 46) buffer EntrySpans { EntrySpanBlock entry_spans[]; };

// Every device dispatches as many side by side.
const uint MOST_GROUPS_X = 32768u;

void main() {
    uint material = gl_GlobalInvocationID.x;
    if (material >= MATERIAL_COUNT) {
        return;
    }
    uint count = entry_spans[material].count;
    uint entries = ENTRY_THREADS * TEXELS;
    uint groups = (count + entries - 1u) / entries;
    entry_spans[material].first = atomicAdd(counters[COUNTED_ORDERED], count);
    entry_spans[material].groups_x = min(groups, MOST_GROUPS_X);
    entry_spans[material].groups_y = (groups + MOST_GROUPS_X - 1u) / MOST_GROUPS_X;
    entry_spans[material].groups_z = 1u;
}
