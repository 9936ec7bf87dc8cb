// A triangle for each of several tuples, each into its tuple's layer (section 4.2, Interleave-ReplicateGS). Pass:
// src/techniques/deep_shading/visibility/replicate.rs. TUPLES: at most so many, from the draw's on.
// variants: VERTEX=plain|extended TUPLES=8|16
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"

layout(triangles) in;
#ifdef TUPLES_8
const uint TUPLES = 8u;
layout(triangle_strip, max_vertices = 24) out;
#else
const uint TUPLES = 16u;
layout(triangle_strip, max_vertices = 48) out;
#endif

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

// As replicate.vert has them.
layout(location = 0) in vec4 in_canonical[];
layout(location = 1) flat in uint in_primitive[];
layout(location = 2) in vec4 in_close_clip[];
layout(location = 3) in vec2 in_uv[];
layout(location = 6) in vec2 in_depths[];

// As sample.vert has them.
layout(location = 0) out vec4 out_canonical;
layout(location = 1) flat out uint out_primitive;
layout(location = 3) out vec2 out_uv;
layout(location = 6) flat out uint out_tuple;

#ifdef VERTEX_EXTENDED
layout(location = 4) in vec4 in_color[];
layout(location = 5) in vec2 in_uv_1[];
layout(location = 4) out vec4 out_color;
layout(location = 5) out vec2 out_uv_1;
#endif

invariant gl_Position;

void main() {
    uint end = min(params.tuple + TUPLES, deep.tuple_count);
    for (uint tuple = params.tuple; tuple < end; tuple++) {
        TupleBlock place = tuples[frame.sample_index * deep.tuple_count + tuple];
        for (uint index = 0u; index < 3u; index++) {
            Seen open = Seen(gl_in[index].gl_Position, in_depths[index].x);
            gl_Position = clip_of(open, Seen(in_close_clip[index], in_depths[index].y), place);
            gl_Layer = int(tuple);
            out_canonical = in_canonical[index];
            out_primitive = in_primitive[0];
            out_uv = in_uv[index];
#ifdef VERTEX_EXTENDED
            out_color = in_color[index];
            out_uv_1 = in_uv_1[index];
#endif
            out_tuple = tuple;
            EmitVertex();
        }
        EndPrimitive();
    }
}
