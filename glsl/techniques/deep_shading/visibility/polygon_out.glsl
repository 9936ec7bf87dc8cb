// What stochastic rasterisation draws of a triangle, and what its fragments know of it: a polygon in a tuple's layer with the
// corners as that tuple sees them, or one in the frame with the corners at both ends of the exposure, from which fragments
// place each of a pixel's samples.
//
// After bound.glsl and triangle.glsl; the including shader has the axis TESTS and declares `frame` and `tuples[]`.
#ifndef DEEP_SHADING_POLYGON_OUT_GLSL
#define DEEP_SHADING_POLYGON_OUT_GLSL

layout(location = 1) flat out uint out_primitive;
#ifdef TESTS_LOOP
// Clip space when the shutter opens, and closes; and metres before the eye.
layout(location = 2) flat out vec4 out_open[3];
layout(location = 5) flat out vec4 out_close[3];
layout(location = 8) flat out vec3 out_open_depth;
layout(location = 9) flat out vec3 out_close_depth;

// Samples lie anywhere in their pixel; the rest is for rounding.
const float HALF_PIXEL = 0.53125;
#else
// xy: homogeneous pixels of the layer; zw: depth and w.
layout(location = 2) flat out vec4 out_corners[3];
layout(location = 6) flat out uint out_tuple;
// In canonical shading space.
layout(location = 7) flat out vec4 out_canonical_corners[3];
#endif

// A triangle, and where it is drawn.
struct Polygon {
    Seen seen[6];
    TupleBlock tuple;
    // Pixels of what it is drawn into.
    vec2 size_px;
    Bound bound;
#ifndef TESTS_LOOP
    vec4 corners[3];
    vec4 canonical_corners[3];
#endif
};

// `triangle`: of the index buffer.
Polygon polygon_of(uint triangle) {
    Polygon polygon;
    see_triangle(triangle, polygon.seen);
    polygon.tuple = tuples[frame.sample_index * deep.tuple_count + params.tuple];
#ifdef TESTS_LOOP
    // Polygon over the whole frame: the tuple is the first of its eye.
    polygon.tuple = TupleBlock(vec2(1.0), vec2(0.0), vec2(0.0), 0.0, polygon.tuple.eye);
    polygon.size_px = vec2(frame.width_px, frame.height_px);
    polygon.bound = bound_of(polygon.seen, polygon.tuple, polygon.size_px, HALF_PIXEL);
#else
    polygon.size_px = vec2(deep.layer_width_px, deep.layer_height_px);
    polygon.bound = bound_of(polygon.seen, polygon.tuple, polygon.size_px, 0.0);
    for (uint corner = 0u; corner < 3u; corner++) {
        Seen open = polygon.seen[corner];
        Seen close = polygon.seen[corner + 3u];
        polygon.corners[corner] = layer_corner(open, close, polygon.tuple);
        polygon.canonical_corners[corner] = canonical_of(open, close);
    }
#endif
    return polygon;
}

// What fragments know of it.
void put_out(uint triangle, Polygon polygon) {
    out_primitive = params.primitive_offset + triangle;
#ifdef TESTS_LOOP
    Seen seen[6] = polygon.seen;
    for (uint corner = 0u; corner < 3u; corner++) {
        out_open[corner] = seen[corner].clip;
        out_close[corner] = seen[corner + 3u].clip;
    }
    out_open_depth = vec3(seen[0].depth, seen[1].depth, seen[2].depth);
    out_close_depth = vec3(seen[3].depth, seen[4].depth, seen[5].depth);
#else
    out_corners = polygon.corners;
    out_tuple = params.tuple;
    out_canonical_corners = polygon.canonical_corners;
#endif
}

// A corner of it in clip space.
vec4 corner_position(Polygon polygon, uint corner) {
    return vec4(polygon.bound.corners[corner] * 2.0 / polygon.size_px - 1.0, 0.5, 1.0);
}

#endif
