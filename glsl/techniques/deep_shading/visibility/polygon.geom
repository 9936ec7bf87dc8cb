// A polygon around all that a triangle covers while the shutter is open, made once for all of its corners (section 4.2), and
// the triangle as the layer's tuple sees it: what stochastic.vert makes for each corner. Pass:
// src/techniques/deep_shading/visibility/polygon.rs.
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/hull.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/bound.glsl"

layout(triangles) in;
// BOUND_MOST_SIDES.
layout(triangle_strip, max_vertices = 12) out;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

layout(location = 0) flat in uint in_triangle[];

// As of stochastic.vert.
layout(location = 1) flat out uint out_primitive;
layout(location = 2) flat out vec4 out_corners[3];
layout(location = 6) flat out uint out_tuple;
layout(location = 7) flat out vec4 out_canonical_corners[3];
invariant gl_Position;

void main() {
    uint triangle = in_triangle[0];
    TupleBlock tuple = tuples[frame.sample_index * deep.tuple_count + params.tuple];
    vec2 layer = vec2(deep.layer_width_px, deep.layer_height_px);
    Seen seen[6];
    see_triangle(triangle, seen);
    Bound bound = bound_of(seen, tuple, layer);
    vec4 corners[3];
    vec4 canonical_corners[3];
    for (uint corner = 0u; corner < 3u; corner++) {
        corners[corner] = layer_corner(seen[corner], seen[corner + 3u], tuple);
        canonical_corners[corner] = canonical_of(seen[corner], seen[corner + 3u]);
    }
    for (uint place = 0u; place < bound.count; place++) {
        out_primitive = params.primitive_offset + triangle;
        out_corners = corners;
        out_tuple = params.tuple;
        out_canonical_corners = canonical_corners;
        gl_Position = vec4(bound.corners[strip_corner(place, bound.count)] * 2.0 / layer - 1.0, 0.5, 1.0);
        EmitVertex();
    }
    EndPrimitive();
}
