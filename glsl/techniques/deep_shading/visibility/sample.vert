// A corner of a triangle as one tuple sees it, and where it is in shading space. Pass:
// src/techniques/deep_shading/visibility/sample.rs. TUPLE: given by the draw, or the instance; LAYER: not written, or
// written by a later stage, or here; VERTICES: looked up here, for each corner, or given by the index that is drawn, so that
// triangles share them.
// variants: VERTEX=plain|extended TUPLE=pushed|instance LAYER=none|vertex VERTICES=fetched|indexed
#version 460
#ifdef LAYER_VERTEX
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/attributes.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

// xy: homogeneous pixels of shading space; zw: depth and w of its clip space.
layout(location = 0) out vec4 out_canonical;
#ifdef VERTICES_FETCHED
layout(location = 1) flat out uint out_primitive;
// Weights of the triangle's corners.
layout(location = 2) out vec3 out_weights;
#endif
layout(location = 3) out vec2 out_uv;
#ifdef VERTEX_EXTENDED
layout(location = 4) out vec4 out_color;
layout(location = 5) out vec2 out_uv_1;
#endif
layout(location = 6) flat out uint out_tuple;

// Several pipelines place triangles of one tuple: they must agree on depth to the bit.
invariant gl_Position;

void main() {
#ifdef TUPLE_INSTANCE
    uint tuple = uint(gl_InstanceIndex);
#else
    uint tuple = params.tuple;
#endif
#ifdef VERTICES_FETCHED
    uint corner = uint(gl_VertexIndex);
    uint vertex = vertex_of(corner);
    out_primitive = params.primitive_offset + corner / 3u;
    uint place = corner % 3u;
    out_weights = vec3(place == 0u, place == 1u, place == 2u);
#else
    uint vertex = uint(gl_VertexIndex);
#endif
    Seen open = seen_open(vertex);
    Seen close = open;
    if (IS_MOVING != 0u) {
        close = seen_close(vertex);
    }
    gl_Position = clip_of(open, close, tuples[frame.sample_index * deep.tuple_count + tuple]);
#ifdef LAYER_VERTEX
    gl_Layer = int(tuple);
#endif
    out_canonical = canonical_of(open, close);
    out_uv = uv_at(vertex);
#ifdef VERTEX_EXTENDED
    out_color = color_at(vertex);
    out_uv_1 = uv_1_at(vertex);
#endif
    out_tuple = tuple;
}
