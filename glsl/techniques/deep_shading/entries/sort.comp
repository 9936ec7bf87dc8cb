// Entries by their materials, in two steps: how many each has, and a place of the order for each. Which of a material's entries
// comes first is left to chance: a colour depends on its entry alone. Pass: src/techniques/deep_shading/entries/sort.rs.
// variants: STEP=count|place
#version 460
#define DRAW_OF_TRIANGLE
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/ranges.glsl"
#include "techniques/deep_shading/counters.glsl"
#include "techniques/deep_shading/entries/waiting.glsl"

#define ORDER_ACCESS writeonly
#define ORDER_FUNCTION WRITES_WORDS
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
#include "techniques/deep_shading/entries/order.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 22) readonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(std430, set = 0, binding = 46) buffer EntrySpans { EntrySpanBlock entry_spans[]; };

READS_PAIRS(waiting_at, colors)

// Where colours lie: anywhere, one place a sample; in a row; or in a row, with those of strays from the end on.
const uint COLORS_ANYWHERE = 0u;
const uint COLORS_IN_ROW = 1u;
const uint COLORS_IN_TWO_ROWS = 2u;
layout(constant_id = 103) const uint COLOR_PLACES = 0;

// Whether something has been written there in this frame.
bool is_used(uint place) {
    bool is_in_row = place < counters[COUNTED_COLORS];
    bool is_in_second = place >= sample_total(deep) - counters[COUNTED_STRAYS];
    return COLOR_PLACES == COLORS_ANYWHERE || is_in_row || (COLOR_PLACES == COLORS_IN_TWO_ROWS && is_in_second);
}

void main() {
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= deep.layer_width_px) {
        return;
    }
    uint place = sample_index(deep, at);
    uvec2 entry = is_used(place) ? waiting_at(place) : NO_ENTRY;
    if (!is_entry(entry)) {
        return;
    }
    find_draw(entry_primitive(entry));
    uint material = draws[params.draw].material;
#ifdef STEP_COUNT
    atomicAdd(entry_spans[material].count, 1u);
#else
    ordered_entry(entry_spans[material].first + atomicAdd(entry_spans[material].placed, 1u), place);
#endif
}
