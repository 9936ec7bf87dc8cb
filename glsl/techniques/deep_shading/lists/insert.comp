// Each sample's triangle into the list of its shading pixel, where it is not yet (section 4.3; appendix A, pass 2).
// Pass: src/techniques/deep_shading/lists/insert.rs.
// variants: ZMAX=off|on ADDRESSES=off|on MARKS=off|on
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/counters.glsl"
#include "techniques/deep_shading/entries/waiting.glsl"

// 1: nodes inserted meanwhile are not checked, so a triangle may be listed twice, as in the paper.
layout(constant_id = 92) const uint TOLERATES_DUPLICATES = 0;
// 1: colours are given out by compaction, those of strays from their end on.
layout(constant_id = 93) const uint IS_COMPACTED = 0;

// 1: a compute shader shades what lists have, which waits for it (entries/waiting.glsl).
layout(constant_id = 104) const uint HAS_LIST_ENTRIES = 0;

// As in shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

// 0: the driver takes a memory barrier for one of the whole workgroup, whose threads come here as often as they please; its
// stores come in order without (src/caps/quirks.rs, `Identity::barriers_end_threads`).
layout(constant_id = 95) const uint HAS_FENCES = 1;

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(set = 0, binding = 27) uniform usampler2DArray spids;
layout(std430, set = 0, binding = 20) coherent buffer Begins { uint begins[]; };
layout(std430, set = 0, binding = 21) coherent buffer Nodes { uvec2 nodes[]; };
layout(std430, set = 0, binding = 22) writeonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
#ifdef ADDRESSES_ON
layout(std430, set = 0, binding = 24) writeonly buffer Addresses { uint addresses[]; };
WRITES_WORDS(set_address, addresses)
#endif
#ifdef ZMAX_ON
layout(set = 0, binding = 28) uniform usampler2DArray shading_depths;
layout(std430, set = 0, binding = 25) buffer ZMax { uint zmax[]; };
LOWERS_WORDS(lower_zmax, zmax)
#endif
#ifdef MARKS_ON
layout(std430, set = 0, binding = 44) buffer Marks { uint marks[]; };
#include "techniques/deep_shading/lists/marks.glsl"
#endif

READS_WORDS(begin_of, begins)
SWAPS_WORDS(swap_begin, begins)
READS_PAIRS(node_of, nodes)
WRITES_PAIRS(set_node, nodes)
WRITES_PAIRS(set_color, colors)

// Whether the sample's own node is used, in a list or not.
bool has_written = false;

// Triangles that a list holds at most. A thousand in one pixel are nothing to reuse any more, and what walks and sorts a list
// stays short whatever is seen there: a sample that finds its list full is shaded by itself.
const uint LIST_MOST = 1024u;

// What was written before a head is there before it, and what is read behind a head is as its writer left it.
void fence() {
    if (HAS_FENCES != 0u) {
        memoryBarrierBuffer();
    }
}

// Returns the node that holds `primitive`: `own`, or one that was there; NO_PRIMITIVE where the list is full.
uint insert(uint pixel, uint primitive, uint own) {
    // From `known` on the list does not hold it.
    uint known = 0u;
    uint head = begin_of(pixel);
    fence();
    uint holder = NO_PRIMITIVE;
    uint length = 0u;
    while (holder == NO_PRIMITIVE && length < LIST_MOST) {
        uint at = head;
        while (at != known && holder == NO_PRIMITIVE) {
            uvec2 node = node_of(at - 1u);
            holder = node.x == primitive ? at - 1u : NO_PRIMITIVE;
            at = node.y;
            length++;
        }
        if (holder == NO_PRIMITIVE && length < LIST_MOST) {
            set_node(own, uvec2(primitive, head));
            has_written = true;
            fence();
            uint found = swap_begin(pixel, head, own + 1u);
            fence();
            holder = found == head ? own : NO_PRIMITIVE;
            // Lost the compare-exchange: only nodes newer than the head that was read need checking.
            known = TOLERATES_DUPLICATES != 0u ? found : head;
            head = found;
        }
    }
    return holder;
}

void main() {
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= deep.layer_width_px) {
        return;
    }
    uvec2 spid = texelFetch(spids, ivec3(at), 0).xy;
    uint own = sample_index(deep, at);
    if (spid.x == NO_PRIMITIVE) {
        if (IS_COMPACTED == 0u) {
            set_color(own, NO_ENTRY);
        }
        return;
    }
    uint color = NO_PRIMITIVE;
    if (spid.y != NO_SHADING_PIXEL) {
        uint pixel = (spid.y >> 16) * deep.shading_width_px + (spid.y & 0xffffu);
        color = insert(pixel, spid.x, own);
        if (IS_COMPACTED == 0u) {
            bool waits = HAS_LIST_ENTRIES != 0u && color == own;
            set_color(own, waits ? entry_in_list(spid.y, spid.x) : NO_ENTRY);
        }
        if (color == NO_PRIMITIVE) {
            atomicAdd(counters[COUNTED_CROWDED], 1u);
        }
#ifdef MARKS_ON
        // Most samples see what others have seen: what a thread reads may be old, and then it sets the bit again.
        if (!is_marked(spid.x)) {
            atomicOr(marks[mark_word(spid.x)], mark_bit(spid.x));
        }
#endif
#ifdef ZMAX_ON
        lower_zmax(pixel, texelFetch(shading_depths, ivec3(at), 0).x);
#endif
    }
    if (color == NO_PRIMITIVE) {
        color = own;
        uint stray = atomicAdd(counters[COUNTED_STRAYS], 1u);
        if (IS_COMPACTED != 0u) {
            color = sample_total(deep) - 1u - stray;
        }
        // Its node serves no list: it says where the colour is.
        set_node(own, uvec2(color, 0u));
        has_written = true;
        set_color(color, entry_of_sample(spid, own));
    }
#ifdef ADDRESSES_ON
    set_address(own, color);
#endif
    if (IS_COUNTED != 0u && has_written) {
        atomicAdd(counters[COUNTED_NODES], 1u);
    }
}
