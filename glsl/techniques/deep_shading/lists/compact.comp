// Each list sorted and without what stands in it again; the first ids in a row (section 4.3). A thread has a list to itself.
// Pass: src/techniques/deep_shading/lists/compact.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/counters.glsl"
#include "techniques/deep_shading/entries/waiting.glsl"

// As in insert.comp.
layout(constant_id = 104) const uint HAS_LIST_ENTRIES = 0;

// Squares: colours that are given out one after the other lie side by side, which lights may leave out together
// (entries/shade.comp).
layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 20) buffer Begins { uint begins[]; };
layout(std430, set = 0, binding = 21) buffer Nodes { uvec2 nodes[]; };
layout(std430, set = 0, binding = 22) writeonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 23) buffer Linear { uint linear[]; };
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };

READS_WORDS(begin_of, begins)
WRITES_WORDS(set_begin, begins)
READS_PAIRS(node_of, nodes)
WRITES_PAIRS(set_node, nodes)
WRITES_SECONDS(set_next, nodes)
WRITES_PAIRS(set_color, colors)
READS_WORDS(row_id, linear)
WRITES_WORDS(set_row_id, linear)

#define LISTS_COMPACT
#include "techniques/deep_shading/nodes.glsl"

#include "techniques/deep_shading/lists/sorted.glsl"

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= deep.shading_width_px || at.y >= deep.shading_height_px) {
        return;
    }
    uint pixel = at.y * deep.shading_width_px + at.x;
    uint list = begin_of(pixel);
    if (list == 0u) {
        return;
    }
    if (node_of(list - 1u).y != 0u) {
        list = sorted(list);
    }
    uint count = 0u;
    uint last = LINEAR_END;
    uint rest = 0u;
    uint tail = 0u;
    for (uint node = list; node != 0u;) {
        uvec2 held = node_of(node - 1u);
        if (held.x != last) {
            last = held.x;
            if (count < LINEAR_COUNT) {
                set_row_id(pixel * LINEAR_COUNT + count, held.x);
            } else {
                if (tail == 0u) {
                    rest = node;
                } else {
                    set_next(tail - 1u, node);
                }
                tail = node;
            }
            count++;
        }
        node = held.y;
    }
    if (tail != 0u) {
        set_next(tail - 1u, 0u);
    }
    if (count < LINEAR_COUNT) {
        set_row_id(pixel * LINEAR_COUNT + count, LINEAR_END);
    }
    uint first = atomicAdd(counters[COUNTED_COLORS], count);
    uint packed_pixel = at.x | at.y << 16;
    uint next = rest;
    for (uint color = 0u; color < count; color++) {
        uint primitive = 0u;
        if (color < LINEAR_COUNT) {
            primitive = row_id(pixel * LINEAR_COUNT + color);
        } else {
            uvec2 held = node_of(next - 1u);
            primitive = held.x;
            next = held.y;
        }
        set_color(first + color, HAS_LIST_ENTRIES != 0u ? entry_in_list(packed_pixel, primitive) : NO_ENTRY);
    }
    // Its id lies in the row: the node can carry what belongs to the list.
    set_node(list - 1u, uvec2(first, rest));
    set_begin(pixel, list);
}
