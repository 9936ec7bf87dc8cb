// What vertices carry beside their places. After scene_buffers.glsl.
#ifndef DEEP_SHADING_ATTRIBUTES_GLSL
#define DEEP_SHADING_ATTRIBUTES_GLSL

// Nine floats a vertex: normal, tangent with handedness, texture coordinates (src/resident/mod.rs, VertexAttributes).
layout(std430, set = 0, binding = 12) readonly buffer Attributes { float attributes[]; };
#ifdef VERTEX_EXTENDED
// Six: colour, second coordinates.
layout(std430, set = 0, binding = 13) readonly buffer ExtendedAttributes { float extended_attributes[]; };
#endif

const uint ATTRIBUTE_FLOATS = 9u;
const uint EXTENDED_FLOATS = 6u;

vec2 uv_at(uint vertex) {
    uint at = ATTRIBUTE_FLOATS * vertex + 7u;
    return vec2(attributes[at], attributes[at + 1u]);
}

#ifdef VERTEX_EXTENDED
vec4 color_at(uint vertex) {
    uint at = EXTENDED_FLOATS * vertex;
    return vec4(
        extended_attributes[at], extended_attributes[at + 1u], extended_attributes[at + 2u], extended_attributes[at + 3u]);
}

vec2 uv_1_at(uint vertex) {
    uint at = EXTENDED_FLOATS * vertex + 4u;
    return vec2(extended_attributes[at], extended_attributes[at + 1u]);
}
#endif

#endif
