// What stochastic rasterisation draws of a triangle, and what its fragments know of it (polygon_in.glsl): a polygon in a tuple's
// layer, or one in the frame, with the corners at both ends of the exposure, from which fragments place them for each sample.
//
// After bound.glsl, triangle.glsl and own_samples.glsl; the including shader has the axis TESTS and declares `frame` and `tuples[]`.
#ifndef DEEP_SHADING_POLYGON_OUT_GLSL
#define DEEP_SHADING_POLYGON_OUT_GLSL

layout(location = 1) flat out uint out_primitive;
// Clip space when the shutter opens, and closes; and metres before the eye.
layout(location = 2) flat out vec4 out_open[3];
layout(location = 5) flat out vec4 out_close[3];
layout(location = 8) flat out vec3 out_open_depth;
layout(location = 9) flat out vec3 out_close_depth;

// Samples lie anywhere in their pixel; the rest is for rounding.
const float HALF_PIXEL = 0.53125;

// A triangle, and where it is drawn.
struct Polygon {
    Seen seen[6];
    // Pixels of what it is drawn into.
    vec2 size_px;
    Bound bound;
};

// `triangle`: of the index buffer.
Polygon polygon_of(uint triangle) {
    Polygon polygon;
    see_triangle(triangle, polygon.seen);
    TupleBlock tuple = tuples[frame.sample_index * deep.tuple_count + params.tuple];
#ifdef TESTS_LOOP
    // Polygon over the whole frame: the tuple is the first of its eye.
    tuple.scale = vec2(1.0);
    tuple.shift = vec2(0.0);
    polygon.size_px = vec2(frame.width_px, frame.height_px);
    polygon.bound = bound_of(polygon.seen, tuple, polygon.size_px, HALF_PIXEL);
#else
    polygon.size_px = vec2(deep.layer_width_px, deep.layer_height_px);
    float around_px = 0.0;
    if (HAS_OWN_SAMPLES != 0u) {
        // Around the middles of the pixels that the layer's samples lie in.
        vec2 table_px = vec2(deep.table_width_px, deep.table_height_px);
        tuple.shift -= 2.0 * (0.5 - tuple.place_px) / (table_px * polygon.size_px);
        around_px = HALF_PIXEL / min(table_px.x, table_px.y);
    }
    polygon.bound = bound_of(polygon.seen, tuple, polygon.size_px, around_px);
#endif
    return polygon;
}

// What fragments know of it.
void put_out(uint triangle, Polygon polygon) {
    out_primitive = params.primitive_offset + triangle;
    Seen seen[6] = polygon.seen;
    for (uint corner = 0u; corner < 3u; corner++) {
        out_open[corner] = seen[corner].clip;
        out_close[corner] = seen[corner + 3u].clip;
    }
    out_open_depth = vec3(seen[0].depth, seen[1].depth, seen[2].depth);
    out_close_depth = vec3(seen[3].depth, seen[4].depth, seen[5].depth);
}

// A corner of it in clip space.
vec4 corner_position(Polygon polygon, uint corner) {
    return vec4(polygon.bound.corners[corner] * 2.0 / polygon.size_px - 1.0, 0.5, 1.0);
}

#endif
