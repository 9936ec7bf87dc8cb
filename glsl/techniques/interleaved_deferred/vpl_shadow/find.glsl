// What every way of looking for hidden lights has: a thread has a word of a point's lights, of which it asks about those that would
// light the point. The including shader then defines `is_hidden` and ends with `main`.
#ifndef INTERLEAVED_DEFERRED_FIND_GLSL
#define INTERLEAVED_DEFERRED_FIND_GLSL

#include "loops.glsl"
#include "shading/light.glsl"
#include "shading/subset.glsl"
#include "techniques/interleaved_deferred/vpl_shadow/points.glsl"

layout(push_constant) uniform Push { HiddenParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Vpls { VplBlock vpls[]; };
layout(std430, set = 0, binding = 3) readonly buffer Subsets { SubsetBlock subsets[]; };
layout(std430, set = 0, binding = 7) buffer Hidden { uint hidden[]; };

// Whether something stands between a surface and a virtual light, by its number in the list.
bool is_hidden(uint vpl_index, VplBlock vpl, vec3 position_ws, vec3 normal_ws);

void find_hidden() {
    HiddenPoint point = hidden_point(params);
    if (!point.exists) {
        return;
    }
    uvec2 normal = normal_words(point.pixel);
    vec3 normal_ws = unpack_normal(normal);
    vec3 position_ws = unpack_position(frame, position_words(point.pixel), point.pixel);
    SubsetBlock subset = subsets[point.subset];
    uint first = subset.vpl_first + point.word * LIGHTS_A_WORD;
    uint end = min(min(first + LIGHTS_A_WORD, subset.vpl_first + subset.vpl_count), params.light_end);
    // Points without a surface have no position from which a light could be seen.
    end = has_surface(normal) ? end : 0u;
    uint bits = 0u;
    uint vpl_index = max(first, params.light_first);
    for (; vpl_index < end; vpl_index++) {
        VplBlock vpl = vpls[vpl_index];
        bool lights = vpl_irradiance(vpl, position_ws, normal_ws, params.least_squared) != vec3(0.0);
        if (lights && is_hidden(vpl_index, vpl, position_ws, normal_ws)) {
            bits |= 1u << (vpl_index - first);
        }
    }
    expect_done(vpl_index >= end);
    if (loops_were_cut) {
        atomicMax(hidden[0], 1u);
    }
    // The word's other lights may be another dispatch's.
    hidden[point.at] |= bits;
}

#endif
