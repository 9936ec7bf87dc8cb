// A corner of a triangle as all tuples share it: what replicate.geom places for each of them. Pass:
// src/techniques/deep_shading/visibility/replicate.rs.
// variants: VERTEX=plain|extended
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/attributes.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"

layout(location = 0) out vec4 out_canonical;
layout(location = 1) flat out uint out_primitive;
layout(location = 2) out vec4 out_close_clip;
layout(location = 3) out vec2 out_uv;
#ifdef VERTEX_EXTENDED
layout(location = 4) out vec4 out_color;
layout(location = 5) out vec2 out_uv_1;
#endif
layout(location = 6) out vec2 out_depths;

// As in sample.vert.
invariant gl_Position;

void main() {
    uint corner = uint(gl_VertexIndex);
    uint vertex = vertex_of(corner);
    Seen open = seen_open(vertex);
    Seen close = open;
    if (IS_MOVING != 0u) {
        close = seen_close(vertex);
    }
    gl_Position = open.clip;
    out_close_clip = close.clip;
    out_depths = vec2(open.depth, close.depth);
    out_canonical = canonical_of(open, close);
    out_primitive = params.primitive_offset + corner / 3u;
    out_uv = uv_at(vertex);
#ifdef VERTEX_EXTENDED
    out_color = color_at(vertex);
    out_uv_1 = uv_1_at(vertex);
#endif
}
