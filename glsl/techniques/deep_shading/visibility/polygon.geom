// A polygon around all that a triangle covers while the shutter is open, made once for all of its corners (section 4.2): what
// stochastic.vert makes for each corner. Pass: src/techniques/deep_shading/visibility/polygon.rs.
// variants: TESTS=layer|loop
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/hull.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/bound.glsl"
#include "techniques/deep_shading/own_samples.glsl"

layout(triangles) in;
// BOUND_MOST_SIDES.
layout(triangle_strip, max_vertices = 12) out;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

layout(location = 0) flat in uint in_triangle[];

#include "techniques/deep_shading/visibility/polygon_out.glsl"

// As of stochastic.vert.
invariant gl_Position;

void main() {
    uint triangle = in_triangle[0];
    Polygon polygon = polygon_of(triangle);
    uint count = polygon.bound.count;
    for (uint place = 0u; place < count; place++) {
        put_out(triangle, polygon);
        gl_Position = corner_position(polygon, strip_corner(place, count));
        EmitVertex();
    }
    EndPrimitive();
}
