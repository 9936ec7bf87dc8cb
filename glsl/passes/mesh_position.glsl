// Where a vertex of the scene is, from its position alone. Vertex stages only.
#ifndef PASSES_MESH_POSITION_GLSL
#define PASSES_MESH_POSITION_GLSL

#include "frame.glsl"
#include "resident.glsl"

layout(location = 0) in vec3 position;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Draws { DrawBlock draws[]; };

// Two passes over the same triangles must agree on depth to the bit.
invariant gl_Position;

vec4 vertex_position_ws() {
    // The first instance is the draw's index: no push constants between draws.
    return draws[gl_InstanceIndex].world_from_object * vec4(position, 1.0);
}

#endif
