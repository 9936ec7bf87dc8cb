// What each sample of a layer sees, from what is nearest to it: the triangle's id, and its shading point. Pass:
// src/techniques/deep_shading/visibility/spids.rs.
// variants: DEPTH=none|shading
#version 460
#define DRAW_OF_TRIANGLE
#define NUMBERED_IN_ORDER
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/place.glsl"
#include "techniques/deep_shading/scaled.glsl"
#include "techniques/deep_shading/ranges.glsl"
#include "techniques/deep_shading/visibility/covers.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/nearest.glsl"
#include "techniques/deep_shading/own_samples.glsl"

// The layer: its tuple.
layout(location = 0) flat in uint in_instance;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };
layout(std430, set = 0, binding = 20) readonly buffer Nearest { uvec2 nearest[]; };

// As in sample.frag.
layout(location = 0) out uvec2 out_spid;
#ifdef DEPTH_SHADING
layout(location = 1) out uint out_shading_depth;
#endif

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uvec2 words = nearest[sample_index(deep, uvec3(pixel, in_instance))];
    out_spid = uvec2(NO_PRIMITIVE, NO_SHADING_PIXEL);
#ifdef DEPTH_SHADING
    out_shading_depth = NEAREST_DEPTH;
#endif
    if (is_nothing(words)) {
        return;
    }
    uint triangle = find_draw(nearest_order(words));
    TupleBlock shared_tuple = tuples[frame.sample_index * deep.tuple_count + in_instance];
    TupleBlock tuple = turned_tuple(shared_tuple, uvec3(pixel, in_instance));
    Seen seen[6];
    see_triangle(triangle, seen);
    vec4 corners[3];
    vec4 canonical_corners[3];
    for (uint corner = 0u; corner < 3u; corner++) {
        corners[corner] = layer_corner(seen[corner], seen[corner + 3u], tuple);
        canonical_corners[corner] = canonical_of(seen[corner], seen[corner + 3u]);
    }
    vec2 at = gl_FragCoord.xy;
    vec3 areas = areas_of(from_sample(corners[0], at), from_sample(corners[1], at), from_sample(corners[2], at));
    vec3 weights = covered_weights(areas);
    vec4 canonical = canonical_between(canonical_corners, weights);
    uint primitive = triangle + params.primitive_offset;
    out_spid = uvec2(primitive, shading_pixel(deep, scaled(canonical, primitive)));
#ifdef DEPTH_SHADING
    out_shading_depth = shading_depth(canonical);
#endif
}
