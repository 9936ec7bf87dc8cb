// Samples shaded where they are seen, each by itself: the oracle of the lists (--lists none), and what they leave out.
// Pass: src/techniques/deep_shading/brute.rs.
// variants: SAMPLES=all|strays|direct VERTEX=plain|extended SHADOWS=traced|mapped VISIBILITY=interleaved|stochastic
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/counters.glsl"

// As in shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(location = 1) flat in uint in_primitive;
#ifdef VISIBILITY_STOCHASTIC
// Of stochastic.vert.
layout(location = 2) flat in vec4 in_corners[3];
#else
layout(location = 2) in vec3 in_weights;
#endif
layout(location = 6) flat in uint in_tuple;

#ifdef SAMPLES_DIRECT
layout(std430, set = 0, binding = 24) readonly buffer Addresses { uint addresses[]; };
#else
layout(set = 0, binding = 27) uniform usampler2DArray spids;
#endif
layout(std430, set = 0, binding = 22) writeonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
#if defined(SAMPLES_STRAYS) || defined(SAMPLES_DIRECT)
layout(std430, set = 0, binding = 21) readonly buffer Nodes { uvec2 nodes[]; };
#endif

void main() {
    uvec3 at = uvec3(gl_FragCoord.xy, in_tuple);
    uint own = sample_index(deep, at);
#ifdef SAMPLES_DIRECT
    // Strays of the host's lists: their nodes lie where their colours do.
    uint address = addresses[own];
    if (address == NO_ADDRESS || (address & ADDRESS_STRAY) == 0u) {
        discard;
    }
    own = address & ~ADDRESS_STRAY;
    if (nodes[own].x != in_primitive) {
        discard;
    }
    uvec2 spid = uvec2(in_primitive, NO_SHADING_PIXEL);
#else
    uvec2 spid = texelFetch(spids, ivec3(at), 0).xy;
    if (spid.x != in_primitive) {
        discard;
    }
#endif
    bool is_stray = spid.y == NO_SHADING_PIXEL;
#ifdef SAMPLES_STRAYS
    if (!is_stray) {
        discard;
    }
    own = nodes[own].x;
#endif
#ifdef VISIBILITY_STOCHASTIC
    // What the sample sees has passed the test: its weights are inside.
    vec3 weights = place_at(in_corners[0], in_corners[1], in_corners[2], gl_FragCoord.xy).weights;
#else
    vec3 weights = inside_weights(in_weights);
#endif
    colors[own] = color_on(in_primitive, uvec2(spid.y & 0xffffu, spid.y >> 16), is_stray, weights);
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_SHADED], 1u);
    }
}
