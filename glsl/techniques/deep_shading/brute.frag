// Samples shaded where they are seen, each by itself: the oracle of the lists (--lists none), and what they leave out.
// Pass: src/techniques/deep_shading/brute.rs.
// variants: SAMPLES=all|linked|compact|direct VERTEX=plain|extended SHADOWS=traced|mapped VISIBILITY=interleaved|stochastic
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/redraw.glsl"
#include "techniques/deep_shading/counters.glsl"

// As in shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
#ifdef SAMPLES_DIRECT
layout(std430, set = 0, binding = 24) readonly buffer Addresses { uint addresses[]; };
READS_WORDS(address_of, addresses)
#else
layout(set = 0, binding = 27) uniform usampler2DArray spids;
#endif
layout(std430, set = 0, binding = 22) writeonly buffer Colors { uvec2 colors[]; };
WRITES_PAIRS(set_color, colors)
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
#ifndef SAMPLES_ALL
layout(std430, set = 0, binding = 21) readonly buffer Nodes { uvec2 nodes[]; };
READS_PAIRS(node_of, nodes)
#endif
#if defined(SAMPLES_LINKED) || defined(SAMPLES_COMPACT)
layout(std430, set = 0, binding = 20) readonly buffer Begins { uint begins[]; };
READS_WORDS(begin_of, begins)
#ifdef SAMPLES_COMPACT
layout(std430, set = 0, binding = 23) readonly buffer Linear { uint linear[]; };
READS_WORDS(row_id, linear)
#define LISTS_COMPACT
#endif
#include "techniques/deep_shading/nodes.glsl"
#endif

void main() {
    uvec3 at = uvec3(gl_FragCoord.xy, in_tuple);
    // As in shade.frag.
    if (at.x >= deep.layer_width_px || at.y >= deep.layer_height_px) {
        return;
    }
    uint own = sample_index(deep, at);
#ifdef SAMPLES_DIRECT
    // What the host's lists do not have: its node lies where its colour does, and says what it sees.
    uint address = address_of(own);
    if (address == NO_ADDRESS || (address & ADDRESS_STRAY) == 0u) {
        return;
    }
    own = address & ~ADDRESS_STRAY;
    uvec2 spid = node_of(own);
#else
    uvec2 spid = texelFetch(spids, ivec3(at), 0).xy;
#endif
    if (spid.x != in_primitive) {
        return;
    }
    bool is_outside = spid.y == NO_SHADING_PIXEL;
    uvec2 pixel = uvec2(spid.y & 0xffffu, spid.y >> 16);
#if defined(SAMPLES_LINKED) || defined(SAMPLES_COMPACT)
    // Nearly always no list was full, and none is asked.
    if (!is_outside && (counters[COUNTED_CROWDED] == 0u ||
                        color_index(pixel.y * deep.shading_width_px + pixel.x, spid.x) != NO_COLOR)) {
        return;
    }
    own = node_of(own).x;
#endif
    set_color(own, color_on(in_primitive, pixel, is_outside, seen_weights()));
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_SHADED], 1u);
    }
}
