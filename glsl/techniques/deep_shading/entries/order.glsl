// The order in which entries are shaded: one material after the other. Planned by src/techniques/deep_shading/entries/plan.rs.
//
// After buffer_addresses.glsl; the including shader declares `buffer_addresses` and defines ORDER_ACCESS, readonly or writeonly, and
// whichever of READS_WORDS and WRITES_WORDS goes with it as ORDER_FUNCTION.
#ifndef DEEP_SHADING_ORDER_GLSL
#define DEEP_SHADING_ORDER_GLSL

const uint ENTRY_THREADS = 64u;
// Entries that a thread takes one after the other.
layout(constant_id = 4) const uint TEXELS = 1;

// A material's part of the order, and what dispatches it.
struct EntrySpanBlock {
    // Workgroups; a device dispatches as many as it reads here.
    uint groups_x;
    uint groups_y;
    uint groups_z;
    uint first;
    uint count;
    // How many have their place.
    uint placed;
};

layout(std430, set = 0, binding = 45) ORDER_ACCESS buffer EntryOrder { uint entry_order[]; };

ORDER_FUNCTION(ordered_entry, entry_order)

#endif
