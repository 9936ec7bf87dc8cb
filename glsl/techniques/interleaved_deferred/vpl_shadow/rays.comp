// Virtual point lights that solid surfaces hide, by a shadow ray from each point to each light that would light it. A thread has
// one word of lights, so that no walk of many lights is one thread's.
// Pass: src/techniques/interleaved_deferred/vpl_shadow/rays.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer_read.glsl"
#include "bvh.glsl"
#include "loops.glsl"
#include "shading/light.glsl"
#include "shading/subset.glsl"
#include "techniques/interleaved_deferred/vpl_shadow/points.glsl"

layout(push_constant) uniform Push { HiddenParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Vpls { VplBlock vpls[]; };
layout(std430, set = 0, binding = 3) readonly buffer Subsets { SubsetBlock subsets[]; };
layout(std430, set = 0, binding = 4) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 5) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
layout(std430, set = 0, binding = 7) buffer Hidden { uint hidden[]; };

#include "bvh_walk.glsl"
#include "shading/vpl_shadow.glsl"

void main() {
    HiddenPoint point = hidden_point(params);
    if (!point.exists) {
        return;
    }
    uvec2 normal = normal_words(point.pixel);
    vec3 normal_ws = unpack_normal(normal);
    vec3 position_ws = unpack_position(frame, position_words(point.pixel), point.pixel);
    SubsetBlock subset = subsets[point.subset];
    uint first = subset.vpl_first + point.word * LIGHTS_A_WORD;
    // Points without a surface have no position that a ray could start from.
    uint end = has_surface(normal) ? min(first + LIGHTS_A_WORD, subset.vpl_first + subset.vpl_count) : 0u;
    uint bits = 0u;
    uint vpl_index = first;
    for (; vpl_index < end; vpl_index++) {
        VplBlock vpl = vpls[vpl_index];
        bool lights = vpl_irradiance(vpl, position_ws, normal_ws, params.least_squared) != vec3(0.0);
        if (lights && is_hidden_from(vpl, position_ws, normal_ws)) {
            bits |= 1u << (vpl_index - first);
        }
    }
    expect_done(vpl_index >= end);
    if (loops_were_cut) {
        atomicMax(hidden[0], 1u);
    }
    hidden[point.at] = bits;
}
