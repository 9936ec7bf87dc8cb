// How long the lists are, after the frame: what is listed, what stands in a list again, the longest
// (--instrument; section 4.1). Pass: src/techniques/deep_shading/count.rs.
// variants: LISTS=linked|compact
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/counters.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 20) readonly buffer Begins { uint begins[]; };
layout(std430, set = 0, binding = 21) buffer Nodes { uvec2 nodes[]; };
#ifdef LISTS_COMPACT
layout(std430, set = 0, binding = 23) readonly buffer Linear { uint linear[]; };
#endif
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(std430, set = 0, binding = 30) writeonly buffer Lengths { uint lengths[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };

READS_WORDS(begin_of, begins)
READS_PAIRS(node_of, nodes)
#ifdef LISTS_COMPACT
READS_WORDS(row_id, linear)
#else
WRITES_SECONDS(set_next, nodes)
#endif
WRITES_WORDS(set_length, lengths)

#include "techniques/deep_shading/nodes.glsl"
#include "sampling/sobol.glsl"
#ifdef LISTS_LINKED
#include "techniques/deep_shading/lists/sorted.glsl"
#endif

uint digest_of(uint pixel, uint primitive) {
    return mixed(pixel * 0x9e3779b1u ^ mixed(primitive));
}

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= deep.shading_width_px) {
        return;
    }
    uint pixel = at.y * deep.shading_width_px + at.x;
    uint node = begin_of(pixel);
    uint listed = 0u;
    uint again = 0u;
    uint digest = 0u;
    bool is_listed = node != 0u;
#ifdef LISTS_COMPACT
    if (is_listed) {
        for (; listed < LINEAR_COUNT; listed++) {
            uint primitive = row_id(pixel * LINEAR_COUNT + listed);
            if (primitive == LINEAR_END) {
                break;
            }
            digest += digest_of(pixel, primitive);
        }
        node = listed == LINEAR_COUNT ? node_of(node - 1u).y : 0u;
        atomicAdd(counters[COUNTED_ROW_IDS], min(listed + 1u, LINEAR_COUNT));
    }
    bool overflows = node != 0u;
    for (; node != 0u; node = node_of(node - 1u).y) {
        digest += digest_of(pixel, node_of(node - 1u).x);
        listed++;
    }
#else
    bool overflows = false;
    uint last = NO_PRIMITIVE;
    // Nobody reads them any more in this frame.
    for (node = is_listed ? sorted(node) : 0u; node != 0u; node = node_of(node - 1u).y) {
        bool is_again = node_of(node - 1u).x == last;
        last = node_of(node - 1u).x;
        listed += is_again ? 0u : 1u;
        digest += is_again ? 0u : digest_of(pixel, last);
        again += is_again ? 1u : 0u;
    }
#endif
    set_length(pixel, listed);
    if (is_listed) {
        atomicAdd(counters[COUNTED_LISTED], listed);
        atomicAdd(counters[COUNTED_DIGEST], digest);
        atomicAdd(counters[COUNTED_PIXELS], 1u);
        atomicMax(counters[COUNTED_LONGEST], listed);
        if (again > 0u) {
            atomicAdd(counters[COUNTED_DUPLICATES], again);
        }
        if (overflows) {
            atomicAdd(counters[COUNTED_OVERFLOWS], 1u);
        }
    }
}
