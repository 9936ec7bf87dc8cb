// A corner of a triangle as one tuple sees it, and where it is in shading space. Pass:
// src/techniques/deep_shading/visibility/sample.rs.
// variants: VERTEX=plain|extended
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/attributes.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

// xy: homogeneous pixels of shading space; zw: depth and w of its clip space.
layout(location = 0) out vec4 out_canonical;
layout(location = 1) flat out uint out_primitive;
// Of the triangle's corners.
layout(location = 2) out vec3 out_weights;
layout(location = 3) out vec2 out_uv;
#ifdef VERTEX_EXTENDED
layout(location = 4) out vec4 out_color;
layout(location = 5) out vec2 out_uv_1;
#endif

// The passes over one tuple must agree on depth to the bit.
invariant gl_Position;

void main() {
    uint corner = uint(gl_VertexIndex);
    uint vertex = vertex_of(corner);
    TupleBlock tuple = tuples[frame.sample_index * deep.tuple_count + params.tuple];
    vec4 open = open_ws(vertex);
    vec4 clip = deep.open_clip_from_world * open;
    float depth = dot(deep.open_depth.xyz, open.xyz) + deep.open_depth.w;
    vec4 canonical = clip;
    if (IS_MOVING != 0u) {
        vec4 close = close_ws(vertex);
        vec4 close_clip = deep.close_clip_from_world * close;
        canonical = 0.5 * clip + 0.5 * close_clip;
        clip = mix(clip, close_clip, tuple.time);
        depth = mix(depth, dot(deep.close_depth.xyz, close.xyz) + deep.close_depth.w, tuple.time);
    }
    if (HAS_LENS != 0u) {
        // A thin lens: what lies in the plane in focus stays where it is.
        clip.xy += deep.lens * tuple.lens * (depth * deep.inverse_focus - 1.0);
    }
    clip.xy = clip.xy * tuple.scale + clip.w * tuple.shift;
    gl_Position = clip;
    out_canonical = vec4(shading_from_clip(deep, canonical), canonical.zw);
    out_primitive = params.primitive_offset + corner / 3u;
    uint place = corner % 3u;
    out_weights = vec3(place == 0u, place == 1u, place == 2u);
    out_uv = uv_at(vertex);
#ifdef VERTEX_EXTENDED
    out_color = color_at(vertex);
    out_uv_1 = uv_1_at(vertex);
#endif
}
