// Virtual point lights that solid surfaces hide, by a shadow ray from each point to each light that would light it.
// Pass: src/techniques/interleaved_deferred/vpl_shadow/rays.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer_read.glsl"
#include "bvh.glsl"
#include "techniques/interleaved_deferred/vpl_shadow/find.glsl"

layout(std430, set = 0, binding = 4) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 5) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };

#include "bvh_walk.glsl"
#include "shading/vpl_shadow.glsl"

bool is_hidden(uint vpl_index, VplBlock vpl, vec3 position_ws, vec3 normal_ws) {
    return is_hidden_from(vpl, position_ws, normal_ws);
}

void main() {
    find_hidden();
}
