// Where on its triangle a sample is that a tuple draws, by either kind of visibility. Pass:
// src/techniques/deep_shading/baseline/mod.rs.
//
// After scene_buffers.glsl, place.glsl and counting.glsl; with the axes ALPHA and VISIBILITY.
#ifndef DEEP_SHADING_SAMPLE_PLACE_GLSL
#define DEEP_SHADING_SAMPLE_PLACE_GLSL

#if defined(VISIBILITY_STOCHASTIC) || defined(ALPHA_TESTED)
// surface.glsl calls the middle of the exposure `frame`.
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock run; };
#endif
#ifdef VISIBILITY_STOCHASTIC
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/polygon_in.glsl"
#include "techniques/deep_shading/own_samples.glsl"
#include "techniques/deep_shading/visibility/covers.glsl"

layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

#include "techniques/deep_shading/visibility/hit.glsl"
#else
layout(location = 1) flat in uint in_primitive;
layout(location = 2) in vec3 in_weights;

#include "techniques/deep_shading/drawn_place.glsl"

#ifdef ALPHA_OPAQUE
// What writes into buffers, as counting does, is else tested after it has run.
layout(early_fragment_tests) in;
#endif
#endif
#ifdef ALPHA_TESTED
#include "techniques/deep_shading/alpha.glsl"
#endif

// Whether the sample has hit the triangle. `place`: with rates of a pixel of the frame. Writes the depth that the shader says.
bool is_placed(out Place place) {
#ifdef VISIBILITY_STOCHASTIC
    uvec2 pixel = pixel_of_sample(uvec3(gl_FragCoord.xy, params.tuple));
    TupleBlock tuple = turned_tuple(tuples[run.sample_index * deep.tuple_count + params.tuple], turns_of(pixel));
    vec3 weights;
    float depth;
    bool has_hit = is_hit(swept_triangle(run.width_px, run.height_px), tuple, pixel, gl_FragCoord.xy, weights, depth);
    count_tests();
    if (!has_hit) {
        return false;
    }
    place = hit_place(tuple, gl_FragCoord.xy, weights);
    gl_FragDepth = depth;
#else
    place = drawn_place();
    place.weights = inside_weights(place.weights);
#endif
    // A layer's pixels are a table apart.
    place.right /= float(deep.table_width_px);
    place.down /= float(deep.table_height_px);
    return true;
}

#ifdef ALPHA_TESTED
// Ends what the sample does not see of a surface with this alpha.
void require_seen(float alpha) {
    if (!is_seen(alpha, uvec2(gl_FragCoord.xy), tuple_number(deep, run.sample_index, params.tuple))) {
        discard;
    }
}
#endif

#endif
