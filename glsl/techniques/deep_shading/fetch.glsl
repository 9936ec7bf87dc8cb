// A sample's colour: through the address buffer, by following links, or from the sample's own place; of a baseline from the
// layers that it drew (section 3.2; appendix A, pass 4).
//
// After reach.glsl and space.glsl; the including shader has the axis FETCH and declares `deep`.
#ifndef DEEP_SHADING_FETCH_GLSL
#define DEEP_SHADING_FETCH_GLSL

#include "nan.glsl"

#if defined(FETCH_LAYERS) || defined(FETCH_PASSES)
layout(set = 0, binding = 27) uniform sampler2DArray drawn;
#elif defined(FETCH_MULTISAMPLED)
// As in msaa.frag.
layout(constant_id = 98) const uint PASS_SAMPLES = 1;

layout(set = 0, binding = 27) uniform sampler2DMSArray drawn;
#else
#ifndef FETCH_DIRECT
layout(set = 0, binding = 27) uniform usampler2DArray spids;
#endif
layout(std430, set = 0, binding = 22) readonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
READS_PAIRS(kept_color, colors)
// 1: a sample without a colour makes its pixel NaN, which fails the picture.
layout(constant_id = 102) const uint MISSING_FAILS = 0;
#endif
#if defined(FETCH_ADDRESS) || defined(FETCH_DIRECT)
layout(std430, set = 0, binding = 24) readonly buffer Addresses { uint addresses[]; };
READS_WORDS(address_of, addresses)
#endif
#ifdef FETCH_POINTER
layout(std430, set = 0, binding = 34) readonly buffer Pointers { uint pointers[]; };
READS_WORDS(pointer_of, pointers)
#include "techniques/deep_shading/indirect/pointers.glsl"
#endif
#if defined(FETCH_LINKED) || defined(FETCH_COMPACT)
layout(std430, set = 0, binding = 20) readonly buffer Begins { uint begins[]; };
layout(std430, set = 0, binding = 21) readonly buffer Nodes { uvec2 nodes[]; };
READS_WORDS(begin_of, begins)
READS_PAIRS(node_of, nodes)
#ifdef FETCH_COMPACT
layout(std430, set = 0, binding = 23) readonly buffer Linear { uint linear[]; };
READS_WORDS(row_id, linear)
#define LISTS_COMPACT
#endif
#include "techniques/deep_shading/nodes.glsl"
#include "techniques/deep_shading/spid.glsl"
#endif

// A sample of a pixel, whose first has the tuple `first`. Alpha: 1 where something was shaded, 0 where that is missing, -1 where
// it sees nothing.
vec4 sample_at(uvec2 pixel, uint first, uint index) {
    uvec3 at = uvec3(pixel / uvec2(deep.table_width_px, deep.table_height_px), first + index);
#if defined(FETCH_LAYERS) || defined(FETCH_PASSES) || defined(FETCH_MULTISAMPLED)
#if defined(FETCH_LAYERS)
    vec4 texel = texelFetch(drawn, ivec3(at), 0);
#elif defined(FETCH_PASSES)
    vec4 texel = texelFetch(drawn, ivec3(pixel, index), 0);
#else
    vec4 texel = texelFetch(drawn, ivec3(pixel, index / PASS_SAMPLES), int(index % PASS_SAMPLES));
#endif
    return texel.a == 0.0 ? vec4(0.0, 0.0, 0.0, -1.0) : texel;
#else
    uint own = sample_index(deep, at);
#ifdef FETCH_DIRECT
    bool is_empty = address_of(own) == NO_ADDRESS;
#else
    uvec2 spid = texelFetch(spids, ivec3(at), 0).xy;
    bool is_empty = spid.x == NO_PRIMITIVE;
#endif
    if (is_empty) {
        return vec4(0.0, 0.0, 0.0, -1.0);
    }
#if defined(FETCH_OWN)
    uint where = own;
#elif defined(FETCH_ADDRESS) || defined(FETCH_DIRECT)
    uint where = address_of(own);
#elif defined(FETCH_POINTER)
    uint pointer = pointer_of(own);
    if (pointer != 0u && (pointer & POINTER_OWNS) == 0u) {
        pointer = pointer_of(pointer - 1u);
    }
    // A sample without an entry has no colour.
    uint where = pointer == 0u ? NO_PRIMITIVE : pointer & ~POINTER_OWNS;
#else
    uint where = color_of(spid, own);
#endif
    uvec2 words = where < sample_total(deep) ? kept_color(where) : uvec2(0u);
    vec4 color = vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y));
    if (color.a == 0.0) {
        // What it holds else is an entry that waits, or none.
        color.rgb = vec3(MISSING_FAILS != 0u ? no_number() : 0.0);
    }
    return color;
#endif
}

#endif
