// Whether a sample lies in a triangle, which it is tested against because the polygon around the triangle's whole way has
// reached its pixel; and what it sees then (section 4.2). Pass: src/techniques/deep_shading/visibility/stochastic.rs.
// variants: ALPHA=opaque|tested VERTEX=plain|extended DEPTH=none|shading COUNT=off|on
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/place.glsl"
#include "techniques/deep_shading/scaled.glsl"
#include "techniques/deep_shading/counting.glsl"
#include "techniques/deep_shading/visibility/covers.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/polygon_in.glsl"
#include "techniques/deep_shading/own_samples.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

#include "techniques/deep_shading/visibility/hit.glsl"
#include "techniques/deep_shading/visibility/place_alpha.glsl"

// As in sample.frag.
layout(location = 0) out uvec2 out_spid;
#ifdef DEPTH_SHADING
layout(location = 1) out uint out_shading_depth;
#endif

void main() {
    // A layer has one sample a pixel, in its middle: the tuple's shift has put it there.
    vec2 at = gl_FragCoord.xy;
    uvec3 sample_at = uvec3(uvec2(at), params.tuple);
    uvec2 pixel = pixel_of_sample(sample_at);
    TupleBlock tuple = turned_tuple(tuples[frame.sample_index * deep.tuple_count + params.tuple], turns_of(pixel));
    vec3 weights;
    float depth;
    bool has_hit = is_hit(swept_triangle(frame.width_px, frame.height_px), tuple, pixel, at, weights, depth);
    count_tests();
    if (!has_hit) {
        discard;
    }
#ifdef ALPHA_TESTED
    place_alpha(hit_place(tuple, at, weights), 3u * (in_primitive - params.primitive_offset));
    if (!is_seen(base_color_at(params.material).a, uvec2(at), tuple_number(deep, frame.sample_index, params.tuple))) {
        discard;
    }
#endif
    gl_FragDepth = depth;
    vec4 canonical_corners[3];
    for (uint corner = 0u; corner < 3u; corner++) {
        canonical_corners[corner] = canonical_of(open_corner(corner), close_corner(corner));
    }
    vec4 canonical = canonical_between(canonical_corners, placed_weights(tuple, at));
    out_spid = uvec2(in_primitive, shading_pixel(deep, scaled(canonical, in_primitive)));
#ifdef DEPTH_SHADING
    out_shading_depth = shading_depth(canonical);
#endif
}
