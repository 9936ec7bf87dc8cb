// A sample's test against a triangle as its tuple sees it: whether it lies in it and sees a side that is drawn (section 4.2).
//
// Nearly all tests miss: what only a hit needs stands apart from them.
//
// After scene_buffers.glsl, counting.glsl and covers.glsl.
#ifndef DEEP_SHADING_HIT_GLSL
#define DEEP_SHADING_HIT_GLSL

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

// `count_tests` counts it later. `corners`: as `covers` takes them, of the layer; `at`: the sample in it. `weights` are the
// corners' where it is true.
bool is_hit(vec4 corners[3], vec2 at, out vec3 weights) {
    tests_done++;
    bool is_front;
    if (!covers(corners[0], corners[1], corners[2], at, weights, is_front)) {
        return false;
    }
    tests_hit++;
    bool is_seen_front = is_front != ((params.flags & DRAWN_MIRRORED) != 0u);
    return is_seen_front || (params.flags & DRAWN_DOUBLE_SIDED) != 0u;
}

// Where the sample has hit such a triangle, with rates of the layer's pixels.
Place hit_place(vec4 corners[3], vec2 at, vec3 weights) {
    vec3 w = vec3(corners[0].w, corners[1].w, corners[2].w);
    return place_of(
        from_sample(corners[0], at), from_sample(corners[1], at), from_sample(corners[2], at), w, weights, vec2(0.0));
}

// What a sample's depth is at a place of such a triangle.
float hit_depth(vec4 corners[3], vec3 weights) {
    vec2 depth = covered_depth(corners[0], corners[1], corners[2], weights);
    return depth.x / depth.y;
}

#endif
