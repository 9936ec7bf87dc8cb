// A polygon around all that a triangle covers while the shutter is open, each of its corners made by itself: in a layer, with the
// triangle as the layer's tuple sees it (src/techniques/deep_shading/visibility/stochastic.rs), or in the frame, for all tuples of
// an eye (looped.rs).
// variants: TESTS=layer|loop
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/bound.glsl"
#include "techniques/deep_shading/own_samples.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

#include "techniques/deep_shading/visibility/polygon_out.glsl"

// Several pipelines place the polygons: they must agree on depth to the bit.
invariant gl_Position;

void main() {
    uint vertex_count = 3u * (BOUND_STILL_SIDES - 2u);
    if (IS_MOVING != 0u) {
        vertex_count = 3u * (BOUND_MOST_SIDES - 2u);
    }
    uint vertex = uint(gl_VertexIndex) % vertex_count;
    uint triangle = uint(gl_VertexIndex) / vertex_count;
    Polygon polygon = polygon_of(triangle);
    put_out(triangle, polygon);
    // A fan; what it has too many of is of one point.
    uint place = vertex % 3u == 0u ? 0u : vertex / 3u + vertex % 3u;
    uint count = polygon.bound.count;
    gl_Position = count == 0u ? vec4(0.0, 0.0, 0.5, 1.0) : corner_position(polygon, min(place, count - 1u));
}
