// Whether a sample lies in a triangle, which it is tested against because the polygon around the triangle's whole way has
// reached its pixel; and what it sees then (section 4.2). Pass: src/techniques/deep_shading/visibility/stochastic.rs.
// variants: ALPHA=opaque|tested VERTEX=plain|extended DEPTH=none|shading COUNT=off|on
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/place.glsl"
#include "techniques/deep_shading/counting.glsl"
#include "techniques/deep_shading/visibility/covers.glsl"

layout(location = 1) flat in uint in_primitive;
layout(location = 2) flat in vec4 in_corners[3];
layout(location = 7) flat in vec4 in_canonical_corners[3];

#include "techniques/deep_shading/visibility/hit.glsl"

#ifdef ALPHA_TESTED
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
#endif
#include "techniques/deep_shading/visibility/place_alpha.glsl"

// As in sample.frag.
layout(location = 0) out uvec2 out_spid;
#ifdef DEPTH_SHADING
layout(location = 1) out uint out_shading_depth;
#endif

void main() {
    // A layer has one sample a pixel, in its middle: the tuple's shift has put it there.
    vec2 at = gl_FragCoord.xy;
    vec3 weights;
    bool has_hit = is_hit(in_corners, at, weights);
    count_tests();
    if (!has_hit) {
        discard;
    }
#ifdef ALPHA_TESTED
    place_alpha(hit_place(in_corners, at, weights), 3u * (in_primitive - params.primitive_offset));
    if (!is_seen(base_color_at(params.material).a, uvec2(at), tuple_number(deep, frame.sample_index, params.tuple))) {
        discard;
    }
#endif
    gl_FragDepth = hit_depth(in_corners, weights);
    vec4 canonical = canonical_between(in_canonical_corners, weights);
    out_spid = uvec2(in_primitive, shading_pixel(deep, canonical));
#ifdef DEPTH_SHADING
    out_shading_depth = shading_depth(canonical);
#endif
}
