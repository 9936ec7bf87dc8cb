// The triangles of samples, drawn once more by the stages that drew them for visibility: what comes in of them, and where on its
// triangle a sample is. Pass: src/techniques/deep_shading/redraw.rs.
//
// After place.glsl and corners.glsl; with the axis VISIBILITY.
#ifndef DEEP_SHADING_REDRAW_GLSL
#define DEEP_SHADING_REDRAW_GLSL

layout(location = 1) flat in uint in_primitive;
#ifdef VISIBILITY_STOCHASTIC
#include "techniques/deep_shading/visibility/covers.glsl"

// Written by stochastic.vert.
layout(location = 2) flat in vec4 in_corners[3];
#else
layout(location = 2) in vec3 in_weights;
#endif
layout(location = 6) flat in uint in_tuple;

// Weights of the corners of `in_primitive` at a sample that sees it.
vec3 seen_weights() {
#ifdef VISIBILITY_STOCHASTIC
    // What the sample sees has passed the test.
    vec3 weights;
    bool is_front;
    covers(in_corners[0], in_corners[1], in_corners[2], gl_FragCoord.xy, weights, is_front);
    return weights;
#else
    return inside_weights(in_weights);
#endif
}

#endif
