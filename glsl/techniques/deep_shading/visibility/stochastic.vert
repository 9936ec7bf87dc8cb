// A polygon around all that a triangle covers while the shutter is open, and the triangle as the layer's tuple sees it. Pass:
// src/techniques/deep_shading/visibility/stochastic.rs.
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/bound.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

layout(location = 1) flat out uint out_primitive;
// xy: homogeneous pixels of the layer; zw: depth and w.
layout(location = 2) flat out vec4 out_corners[3];
layout(location = 6) flat out uint out_tuple;
// In canonical shading space.
layout(location = 7) flat out vec4 out_canonical_corners[3];

// Samples that one pass over the polygons has seen must be found by the next.
invariant gl_Position;

void main() {
    uint vertex_count = 3u * (BOUND_STILL_SIDES - 2u);
    if (IS_MOVING != 0u) {
        vertex_count = 3u * (BOUND_MOST_SIDES - 2u);
    }
    uint vertex = uint(gl_VertexIndex) % vertex_count;
    uint triangle = uint(gl_VertexIndex) / vertex_count;
    TupleBlock tuple = tuples[frame.sample_index * deep.tuple_count + params.tuple];
    vec2 layer = vec2(deep.layer_width_px, deep.layer_height_px);
    Seen seen[6];
    see_triangle(triangle, seen);
    for (uint corner = 0u; corner < 3u; corner++) {
        out_corners[corner] = layer_corner(seen[corner], seen[corner + 3u], tuple);
        out_canonical_corners[corner] = canonical_of(seen[corner], seen[corner + 3u]);
    }
    out_primitive = params.primitive_offset + triangle;
    out_tuple = params.tuple;
    Bound bound = bound_of(seen, tuple, layer);
    // A fan; what it has too many of is of one point.
    uint place = vertex % 3u == 0u ? 0u : vertex / 3u + vertex % 3u;
    gl_Position = bound.count == 0u ? vec4(0.0, 0.0, 0.5, 1.0) : vec4(
        bound.corners[min(place, bound.count - 1u)] * 2.0 / layer - 1.0, 0.5, 1.0);
}
