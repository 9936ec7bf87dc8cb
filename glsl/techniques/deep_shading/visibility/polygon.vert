// A triangle's number, for the geometry shader that puts a polygon around its blur. Pass:
// src/techniques/deep_shading/visibility/polygon.rs.
#version 460

layout(location = 0) flat out uint out_triangle;

void main() {
    out_triangle = uint(gl_VertexIndex) / 3u;
    gl_Position = vec4(0.0, 0.0, 0.5, 1.0);
}
