// One of a material's entries, by a thread of its own: which it is, and what its surface says there.
//
// With DRAW_OF_TRIANGLE, after buffer_addresses.glsl and before anything that reads surfaces; with the axes of surface.glsl.
#ifndef DEEP_SHADING_ENTRY_GLSL
#define DEEP_SHADING_ENTRY_GLSL

#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/ranges.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/counters.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/own_samples.glsl"
#include "techniques/deep_shading/entries/waiting.glsl"

layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
#define ORDER_ACCESS readonly
#define ORDER_FUNCTION READS_WORDS
#include "techniques/deep_shading/entries/order.glsl"

// As in shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(local_size_x = ENTRY_THREADS) in;

struct EntryParams {
    MaterialBlock material;
    // Its index, which its span has.
    uint index;
};

layout(push_constant) uniform Push { EntryParams own; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock seen_frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };
layout(std430, set = 0, binding = 46) readonly buffer EntrySpans { EntrySpanBlock entry_spans[]; };

const uint NO_PLACE = 0xffffffffu;

// The place of a thread's i-th entry among colours; NO_PLACE: it has fewer. They follow each other, and so mostly lie side by side.
uint own_place(uint i) {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint index = (group * ENTRY_THREADS + gl_LocalInvocationIndex) * TEXELS + i;
    EntrySpanBlock span = entry_spans[own.index];
    return index < span.count ? ordered_entry(span.first + index) : NO_PLACE;
}

// Weights of the corners of `triangle`, of the index buffer, where a sample sees it: the same whatever has found out that it does.
vec3 seen_weights(uint triangle, uint index) {
    uvec3 at = sample_place(deep, index);
    TupleBlock tuple = turned_tuple(tuples[seen_frame.sample_index * deep.tuple_count + at.z], at);
    Seen seen[6];
    see_triangle(triangle, seen);
    vec4 corners[3];
    for (uint corner = 0u; corner < 3u; corner++) {
        corners[corner] = layer_corner(seen[corner], seen[corner + 3u], tuple);
    }
    // The rasteriser moves corners a little: where what it covers lies beside them, the triangle's nearest place.
    return place_at(corners[0], corners[1], corners[2], vec2(at.xy) + 0.5).weights;
}

// Writes what is interpolated elsewhere.
void stand_on_entry(uvec2 entry) {
    params.material = own.material;
    uint primitive = entry_primitive(entry);
    uint triangle = find_draw(primitive);
    bool has_weights = is_stray(entry);
    vec3 weights = vec3(1.0, 0.0, 0.0);
    // A loop, and no branch: software drivers run a branch that no lane takes, and strays are few.
    for (bool is_missing = has_weights; is_missing; is_missing = false) {
        weights = seen_weights(triangle, entry.x);
    }
    uint pixel = has_weights ? NO_SHADING_PIXEL : entry.x;
    stand_in(primitive, uvec2(pixel & 0xffffu, pixel >> 16), has_weights, weights);
}

#endif
