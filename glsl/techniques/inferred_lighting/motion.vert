// The vertex stage of the geometry pass with motion vectors: where each vertex is, and where it was a moment before. Kircher
// 2009, section 2.1. Pass: src/techniques/inferred_lighting/motion.rs.
// variants: VERTEX=plain|extended
#version 460
#include "passes/mesh_vertex.glsl"

struct EarlierCameraBlock {
    mat4 clip_from_world;
};

layout(std430, set = 0, binding = 50) readonly buffer EarlierCamera { EarlierCameraBlock earlier_camera; };
layout(std430, set = 0, binding = 51) readonly buffer EarlierDraws { mat4 earlier_world_from_object[]; };
// Three numbers a vertex, in object space.
layout(std430, set = 0, binding = 52) readonly buffer EarlierPositions { float earlier_positions[]; };

layout(location = 7) out vec4 out_clip;
layout(location = 8) out vec4 out_earlier_clip;

void main() {
    write_vertex();
    uint first = 3u * uint(gl_VertexIndex);
    vec3 earlier = vec3(earlier_positions[first], earlier_positions[first + 1u], earlier_positions[first + 2u]);
    vec4 earlier_ws = earlier_world_from_object[gl_InstanceIndex] * vec4(earlier, 1.0);
    // What stands still has a difference of exactly 0. One formula of the same numbers is not enough on an H200, whose
    // compiler may take the first from `write_vertex`, which need not be precise.
    bool rests = earlier == position && earlier_camera.clip_from_world == frame.clip_from_world
        && earlier_world_from_object[gl_InstanceIndex] == draws[gl_InstanceIndex].world_from_object;
    precise vec4 now_clip = frame.clip_from_world * (draws[gl_InstanceIndex].world_from_object * vec4(position, 1.0));
    precise vec4 earlier_clip = earlier_camera.clip_from_world * earlier_ws;
    out_clip = now_clip;
    out_earlier_clip = rests ? now_clip : earlier_clip;
}
