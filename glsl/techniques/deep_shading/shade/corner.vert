// A corner of a triangle in canonical shading space, clip space of its frame. Pass:
// src/techniques/deep_shading/shade/corner.rs. Appendix A, pass 3.
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"

layout(location = 0) flat out uint out_primitive;

void main() {
    uint corner = uint(gl_VertexIndex);
    vec4 clip = canonical_clip(vertex_of(corner));
    out_primitive = params.primitive_offset + corner / 3u;
    vec2 extent = vec2(deep.shading_width_px, deep.shading_height_px);
    gl_Position = vec4(shading_from_clip(deep, clip) * 2.0 / extent - clip.w, clip.zw);
}
