// A sample's test against the triangle of a polygon: whether it lies in it and sees a side that is drawn (section 4.2).
//
// Nearly all tests miss: what only a hit needs stands apart from them.
//
// After scene_buffers.glsl, counting.glsl, triangle.glsl, polygon_in.glsl and covers.glsl.
#ifndef DEEP_SHADING_HIT_GLSL
#define DEEP_SHADING_HIT_GLSL

#include "techniques/deep_shading/visibility/reduced.glsl"

// 1: by reduced.glsl; 0: corners are placed in full before each test.
layout(constant_id = 108) const uint HAS_REDUCED_TEST = 0;

// Counts of this invocation: all invocations add to the same words.
uint tests_done = 0u;
uint tests_hit = 0u;

// After the last test, before the invocation is dropped. More than a word counts: the second has what the first was carried
// over.
void count_tests() {
#ifdef COUNT_ON
    if (tests_done > 0u) {
        uint before = atomicAdd(counters[COUNTED_TESTS], tests_done);
        if (before + tests_done < before) {
            atomicAdd(counters[COUNTED_TESTS_CARRIED], 1u);
        }
    }
    if (tests_hit > 0u) {
        atomicAdd(counters[COUNTED_TESTS_HIT], tests_hit);
    }
#endif
}

// The triangle in the layer of the sample's tuple, as the sample sees it.
void place_corners(TupleBlock tuple, out vec4 corners[3]) {
    for (uint corner = 0u; corner < 3u; corner++) {
        corners[corner] = layer_corner(open_corner(corner), close_corner(corner), tuple);
    }
}

// `count_tests` counts it later. `swept`: swept_triangle; `tuple`: the sample's own; `pixel`: the frame's, `at`: the sample in its
// layer. Where it is true, `weights` are the corners' and `depth` the sample's.
bool is_hit(Swept swept, TupleBlock tuple, uvec2 pixel, vec2 at, out vec3 weights, out float depth) {
    tests_done++;
    vec3 areas;
    vec2 depth_and_w;
    if (HAS_REDUCED_TEST != 0u) {
        areas = reduced_areas(swept, tuple, vec2(pixel));
        weights = covered_weights(areas);
        depth_and_w = reduced_depth(swept, tuple, weights);
    } else {
        vec4 corners[3];
        place_corners(tuple, corners);
        areas = areas_of(from_sample(corners[0], at), from_sample(corners[1], at), from_sample(corners[2], at));
        weights = covered_weights(areas);
        depth_and_w = covered_depth(corners[0], corners[1], corners[2], weights);
    }
    precise float area = areas.x + areas.y + areas.z;
    depth = depth_and_w.x / depth_and_w.y;
    if (!is_inside(areas) || area == 0.0 || !is_between_planes(depth_and_w)) {
        return false;
    }
    tests_hit++;
    bool is_seen_front = (area < 0.0) != ((params.flags & DRAWN_MIRRORED) != 0u);
    return is_seen_front || (params.flags & DRAWN_DOUBLE_SIDED) != 0u;
}

// Weights of the corners where the sample sees the triangle, by the full test: whichever has found it, it is shaded in one place.
vec3 placed_weights(TupleBlock tuple, vec2 at) {
    vec4 corners[3];
    place_corners(tuple, corners);
    return covered_weights(
        areas_of(from_sample(corners[0], at), from_sample(corners[1], at), from_sample(corners[2], at)));
}

// Where the sample has hit such a triangle, with rates of the layer's pixels.
Place hit_place(TupleBlock tuple, vec2 at, vec3 weights) {
    vec4 corners[3];
    place_corners(tuple, corners);
    vec3 w = vec3(corners[0].w, corners[1].w, corners[2].w);
    return place_of(
        from_sample(corners[0], at), from_sample(corners[1], at), from_sample(corners[2], at), w, weights, vec2(0.0));
}

#endif
