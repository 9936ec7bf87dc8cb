// What deep shading reads of the scene, by vertex fetches of its own: the id of a triangle must lead to its corners.
#ifndef DEEP_SHADING_SCENE_BUFFERS_GLSL
#define DEEP_SHADING_SCENE_BUFFERS_GLSL

#include "resident.glsl"
#include "techniques/deep_shading/space.glsl"

// The draw is mirrored: its front faces are clockwise.
const uint DRAWN_MIRRORED = 1u;
// BLEND: seen by as many samples as alpha says.
const uint DRAWN_BLENDED = 2u;
// Backs are drawn too.
const uint DRAWN_DOUBLE_SIDED = 4u;

struct DrawnParams {
    MaterialBlock material;
    uint draw;
    // Index of its mesh's first vertex.
    uint vertex_offset;
    // The id of a triangle is its place among all indices, a third of it, plus this (modulo 2^32).
    uint primitive_offset;
    uint tuple;
    // DRAWN_ bits.
    uint flags;
    // The number of a triangle in the order of draws is its place among all indices, a third of it, plus this (modulo 2^32).
    uint order_offset;
    // The place of the first triangle that is drawn among all.
    uint first_triangle;
    uint _unused;
};

#ifdef DRAW_OF_TRIANGLE
// The shader finds out which draw a triangle is of.
DrawnParams params;
#else
layout(push_constant) uniform Push { DrawnParams params; };
#endif
layout(std430, set = 0, binding = 1) readonly buffer Draws { DrawBlock draws[]; };
layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 31) readonly buffer Indices { uint indices[]; };
layout(std430, set = 0, binding = 32) readonly buffer Positions { float positions[]; };
layout(std430, set = 0, binding = 14) readonly buffer ClosePositions { float close_positions[]; };
layout(std430, set = 0, binding = 16) readonly buffer CloseDraws { DrawBlock close_draws[]; };

#include "techniques/deep_shading/corners.glsl"

#endif
