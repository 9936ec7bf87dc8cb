// Corners of a grid of squares, made of their indices: nothing else is read. Pass: src/bench/device/triangles.rs.
#version 460
#include "bench/device/triangles.glsl"

void main() {
    uint index = uint(gl_VertexIndex);
    uint column = index & ((1u << TRIANGLES_COLUMN_BITS) - 1u);
    uint row = index >> TRIANGLES_COLUMN_BITS;
    gl_Position = vec4(params.origin_ndc + vec2(column, row) * params.step_ndc, 0.5, 1.0);
}
